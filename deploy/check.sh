#!/bin/sh
# The whole gate: format, lints, programs, tests, licences. Says each step and its time, ends at the first failure.
#
# One profile, release, serves programs, tests and training, so that heavy dependencies are built once. From an empty
# target folder it takes under half an hour on two cores.
set -eu

cd -- "$(dirname -- "$0")/.."
began=$(date +%s)

# Tests that lack a browser or a Python write a line here; where everything has to run they fail instead (tests/needs).
mkdir -p target
AMPCO_SKIPPED=$PWD/target/skipped.txt
export AMPCO_SKIPPED
rm -f -- "$AMPCO_SKIPPED"
if [ "${CI:-}" = true ] && . deploy/needs.sh; then
    export AMPCO_NEEDS=all
fi

step() {
    name=$1
    shift
    printf '== %s: %s\n' "$name" "$*"
    start=$(date +%s)
    "$@"
    printf '== %s: passed in %s s\n\n' "$name" "$(($(date +%s) - start))"
}

step format cargo fmt --all --check
step lints cargo clippy --release --locked --workspace --all-targets -- -D warnings
# The system tests spawn the programs, which `cargo test` alone would not build.
step programs cargo build --release --locked --workspace
step tests cargo test --release --locked --workspace
# deny.toml is the one list; a test reads it too, so that the gate stands where cargo-deny is not installed.
if command -v cargo-deny >/dev/null 2>&1; then
    step licences cargo deny --locked check
else
    printf '== licences: checked by the tests; install cargo-deny to check advisories and sources as well\n\n'
fi

if [ -s "$AMPCO_SKIPPED" ]; then
    printf 'Skipped on this machine: %s\n' "$(wc -l < "$AMPCO_SKIPPED")"
    cat -- "$AMPCO_SKIPPED"
    printf '\n'
fi
printf 'All passed in %s s.\n' "$(($(date +%s) - began))"

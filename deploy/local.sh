#!/bin/sh
# Builds the programs in release mode and trains: every argument goes to `ampco train`.
#
#   deploy/local.sh                                  the default preset, until Ctrl-C
#   deploy/local.sh --preset smoke --run try         everything once, in seconds
#   deploy/local.sh --run walk --minutes 20          twenty minutes, in runs/walk of the present folder
#   deploy/local.sh --run walk --resume              on from its last checkpoint
#   deploy/local.sh --no-pictures                    without play.html and curves.svg at the end
#   deploy/local.sh --help                           all options
#
# It may be called from any folder. Nothing is downloaded but the crates that Cargo.lock names.
set -eu

root=$(CDPATH='' cd -- "$(dirname -- "$0")/.." && pwd)

# Where cargo builds; a relative folder is meant from where the script was called.
target=${CARGO_TARGET_DIR:-$root/target}
case $target in
/*) ;;
*) target=$PWD/$target ;;
esac

# In the repository's folder, because rustup looks for rust-toolchain.toml from there on.
(
    cd -- "$root"
    CARGO_TARGET_DIR=$target cargo build --quiet --release --locked --workspace
)

# exec: Ctrl-C and SIGTERM reach the supervisor itself, and its exit status is ours.
exec "$target/release/ampco" train "$@"

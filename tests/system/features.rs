//! Programs and tests are built from the same libraries.
//!
//! Cargo joins the features that a workspace's crates ask for. A dependency of tests alone that
//! switches on one more feature of a library deep down has that library, and everything above it,
//! built a second time: burn once was, for minutes, until a disk was full.

use crate::harness::{finish, repository};
use std::collections::BTreeSet;
use std::process::Command;

/// Every package that is built when these kinds of dependencies are followed, with its features; in
/// two ways if programs and build scripts ask for different ones.
fn built(edges: &str) -> BTreeSet<String> {
    let mut command = Command::new(env!("CARGO"));
    command
        .current_dir(repository())
        .args(["tree", "--workspace", "--edges", edges])
        .args(["--prefix", "none", "--format", "{p}\t{f}\t"])
        .args(["--locked", "--offline"]);
    let (success, out, err) = finish(command);
    assert!(success, "{err}");
    // A package met before is marked.
    out.lines()
        .filter_map(|line| line.rsplit_once('\t'))
        .map(|(package, _mark)| package.to_owned())
        .collect()
}

#[test]
fn tests_ask_no_library_of_the_programs_for_more_features() {
    let programs = built("normal,build");
    assert!(programs.len() > 100, "only {} packages", programs.len());
    let tests = built("normal,build,dev");
    let twice: Vec<_> = programs.difference(&tests).cloned().collect();
    assert!(
        twice.is_empty(),
        "these are built again for the tests, with more features:\n{}\n`cargo tree --workspace --invert NAME \
         --edges features` says who asks: choose another dependency for tests, or ask for the \
         same features in Cargo.toml",
        twice.join("\n")
    );
}

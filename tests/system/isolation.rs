//! Runs beside each other, and users beside each other.

use std::fs;
use std::os::unix::fs::{MetadataExt, PermissionsExt};
use std::os::unix::process::CommandExt;
use std::path::Path;
use std::process::Command;

use protocol::Domain;
use rustix::process::Signal;

use crate::harness::{
    Alone, Process, Runs, enclosed, finish, has_no_namespaces, metrics, until_iteration,
    without_timing,
};

/// A user that is not us; nobody on most systems.
const OTHER: u32 = 65_534;

#[test]
fn runs_side_by_side_are_what_each_is_alone() {
    let runs = Runs::new();
    let patience = ["--set", "run.deadlines.directive_seconds=60"];
    let train = |name: &str, seed: &str| {
        let arguments = ["--actors", "2", "--iterations", "12", "--set", seed];
        runs.train(name, &[&arguments[..], &patience].concat())
    };
    // Two of one seed and one of another, at the same time: a message that strayed would show.
    let mut groups = [
        train("one", "seed=7"),
        train("twin", "seed=7"),
        train("other", "seed=8"),
    ];
    for group in &mut groups {
        assert!(group.end().success(), "{}", group.stderr.text());
    }
    let lines = |name: &str| -> Vec<_> {
        let lines = metrics(&runs.run(name));
        lines.into_iter().map(without_timing).collect()
    };
    assert_eq!(lines("one").len(), 12);
    assert_eq!(lines("one"), lines("twin"));
    assert_ne!(lines("one"), lines("other"));
}

#[test]
fn a_second_scheduler_of_a_run_is_refused() {
    let run = Alone::new(1);
    let _first = run.start("ampco-scheduler", &[]);
    let _learner = run.start("ampco-learner", &[]);
    let _actor = run.start("ampco-actor", &["--index", "0"]);
    until_iteration(run.path(), 1);
    let mut second = run.start("ampco-scheduler", &[]);
    assert!(!second.end().success());
    let said = second.stderr.text();
    assert!(said.contains("already has a scheduler"), "{said}");
}

#[test]
fn everything_in_memory_is_for_its_user_alone() {
    let runs = Runs::new();
    let run = runs.run("mine");
    let mut group = runs.train("mine", &["--actors", "1"]);
    until_iteration(&run, 2);
    let domain = Domain::for_run(&run).expect("a domain");
    let mode = |path: &Path| fs::metadata(path).expect("there").permissions().mode() & 0o777;
    let user = domain.root().parent().expect("a folder per user");
    assert_eq!((mode(user), mode(domain.root())), (0o700, 0o700));
    let segments: Vec<_> = domain
        .leftovers()
        .expect("readable")
        .into_iter()
        .filter(|path| path.starts_with("/dev/shm"))
        .collect();
    assert!(segments.len() > 4, "{segments:?}");
    for segment in &segments {
        assert_eq!(mode(segment) & 0o077, 0, "{}", segment.display());
    }
    if fs::metadata(&run).expect("there").uid() == 0 {
        // Only root can try what another user could do.
        let tries = |program: &str, path: &Path| {
            let mut command = Command::new(program);
            command.arg(path).uid(OTHER).gid(OTHER);
            finish(command).0
        };
        assert!(!tries("cat", &segments[0]), "another user reads our memory");
        assert!(!tries("ls", user), "another user sees our runs");
    }
    group.signal(Signal::TERM);
    assert!(group.end().success(), "{}", group.stderr.text());
}

/// Somebody was quicker to make our folder in /tmp, where everyone may; ours is then elsewhere.
const SQUATTED: &str = r#"
mkdir -m 755 /tmp/ampco-0
exec "$AMPCO" train --preset smoke --run squatted --runs-dir /tmp/runs --iterations 1
"#;

#[test]
fn a_folder_that_others_can_enter_is_refused() {
    let place = Runs::new();
    let mut process = Process::start(enclosed(place.path(), SQUATTED));
    let status = process.end();
    let said = process.stderr.text();
    if has_no_namespaces(&said) {
        return;
    }
    assert_eq!(status.code(), Some(1), "{said}");
    assert!(
        said.contains("/tmp/ampco-0") && said.contains("700"),
        "{said}"
    );
}

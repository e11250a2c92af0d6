//! The end of a run is something to look at.

use std::fs;
use std::process::Command;

use rustix::process::Signal;

use crate::harness::{Process, Runs, program, until_iteration};

/// `ampco train` of the run `look` with further arguments.
fn train(runs: &Runs, arguments: &[&str]) -> Process {
    let mut command = Command::new(program("ampco"));
    command
        .args(["train", "--run", "look", "--actors", "1", "--runs-dir"])
        .arg(runs.path())
        .args(arguments);
    Process::start(command)
}

/// What it said until its good end.
fn said(mut train: Process) -> String {
    let status = train.end();
    let said = train.stderr.text();
    assert!(status.success(), "{said}");
    said
}

#[test]
fn a_run_ends_with_a_page_and_curves_and_says_where() {
    let runs = Runs::new();
    let (page, curves) = (
        runs.run("look").join("play.html"),
        runs.run("look").join("curves.svg"),
    );
    let smoke = ["--preset", "smoke", "--iterations"];
    said(train(
        &runs,
        &[&smoke[..], &["1", "--no-pictures"]].concat(),
    ));
    assert!(!page.exists() && !curves.exists());

    let words = said(train(&runs, &["--resume", "--iterations", "2"]));
    for path in [&page, &curves] {
        assert!(words.contains(&*path.display().to_string()), "{words}");
    }
    let html = fs::read_to_string(&page).expect("a page");
    // The default task walks straight on at 0.4 to 1.2 m/s.
    assert!(html.contains("look, 0.4 m/s, then 0.8 m/s, then 1.2 m/s"));
    assert!(html.contains("iteration 2") && html.trim_end().ends_with("</html>"));
    let svg = fs::read_to_string(&curves).expect("curves");
    assert!(svg.starts_with("<svg") && svg.trim_end().ends_with("</svg>"));

    // After Ctrl-C as well. What cannot be drawn is said, and takes nothing from the run.
    fs::remove_file(&page).expect("removed");
    fs::create_dir(&page).expect("in the way");
    fs::remove_file(&curves).expect("removed");
    let endless = train(&runs, &["--resume", "--iterations", "0"]);
    until_iteration(&runs.run("look"), 3);
    endless.signal(Signal::INT);
    let words = said(endless);
    assert!(words.contains("play.html is not drawn"), "{words}");
    assert!(curves.exists(), "{words}");
}

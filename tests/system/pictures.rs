//! The end of a run is something to look at.

use std::fs;
use std::process::Command;

use crate::harness::{Runs, finish, program};

/// `ampco train` of two iterations with further arguments; what it said.
fn train(runs: &Runs, arguments: &[&str]) -> String {
    let mut command = Command::new(program("ampco"));
    command
        .args(["train", "--run", "look", "--actors", "1", "--runs-dir"])
        .arg(runs.path())
        .args(arguments);
    let (success, _, said) = finish(command);
    assert!(success, "{said}");
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
    let said = train(&runs, &[&smoke[..], &["1", "--no-pictures"]].concat());
    assert!(!page.exists() && !curves.exists(), "{said}");

    let said = train(&runs, &["--resume", "--iterations", "2"]);
    for path in [&page, &curves] {
        assert!(said.contains(&*path.display().to_string()), "{said}");
    }
    let html = fs::read_to_string(&page).expect("a page");
    // The default task walks straight on at 0.4 to 1.2 m/s.
    assert!(html.contains("look, 0.4 m/s, then 0.8 m/s, then 1.2 m/s"));
    assert!(html.contains("iteration 2") && html.trim_end().ends_with("</html>"));
    let svg = fs::read_to_string(&curves).expect("curves");
    assert!(svg.starts_with("<svg") && svg.trim_end().ends_with("</svg>"));

    // What cannot be drawn is said, and takes nothing from the run.
    fs::remove_file(&page).expect("removed");
    fs::create_dir(&page).expect("in the way");
    let said = train(&runs, &["--resume", "--iterations", "3"]);
    assert!(said.contains("play.html is not drawn"), "{said}");
    assert!(said.contains(&*curves.display().to_string()), "{said}");
}

//! Runs in a row: stopped in the middle, gone on with, each beginning where the one before ended.

use std::fs;
use std::process::Command;

use rustix::process::Signal;

use crate::harness::{Process, Runs, metrics, program, until_iteration};

const TWO: &str = "title = \"Two\"\n\
    [[stages]]\nname = \"first\"\non = \"smoke\"\niterations = 6\n\
    [[stages]]\nname = \"second\"\niterations = 40\nppo.epochs = 1\n";

#[test]
fn stages_go_on_where_they_were_stopped_and_begin_where_the_one_before_ended() {
    let place = Runs::new();
    let file = place.run("two.toml");
    fs::write(&file, TWO).expect("a file of stages");
    let stages = |more: &[&str]| {
        let mut command = Command::new(program("ampco"));
        command.arg("stages").arg(&file).args(more);
        command.args(["--run", "x", "--runs-dir"]).arg(place.path());
        Process::start(command)
    };
    let (first, second) = (place.run("x-first"), place.run("x-second"));

    let mut began = stages(&[]);
    until_iteration(&second, 3);
    began.signal(Signal::INT);
    assert!(began.end().success(), "{}", began.stderr.text());
    assert!(began.stderr.text().contains("the same command goes on"));
    assert_eq!(metrics(&first).len(), 6);
    let early = metrics(&second)[2].clone();
    assert!(metrics(&second).len() < 40, "it was stopped before its end");
    let config = fs::read_to_string(second.join("config.toml")).expect("its configuration");
    let from = first.join("checkpoints/00000006");
    let from = format!("from = \"{}\"", from.display());
    assert!(
        config.contains(&from) && config.contains("epochs = 1"),
        "{config}"
    );

    let mut other = stages(&["--set", "seed=2"]);
    assert_eq!(other.end().code(), Some(2));
    let said = other.stderr.text();
    assert!(
        said.contains("run x-first was made with `seed = 1`"),
        "{said}"
    );

    let mut resumed = stages(&[]);
    assert!(resumed.end().success(), "{}", resumed.stderr.text());
    let said = resumed.stderr.text();
    assert!(said.contains("x-first has its 6 iterations"), "{said}");
    assert!(said.contains("2 stages done"), "{said}");
    // The lines from before the stop are still there, times included: nothing was begun anew.
    assert_eq!((metrics(&second).len(), &metrics(&second)[2]), (40, &early));
}

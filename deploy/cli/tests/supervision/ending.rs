//! How a group ends: by itself, when it is asked to, against those that do not obey.

use rustix::process::Signal;

use crate::stage::{DEAF, OBEDIENT, Stage};

/// A learner that does three iterations of 128 samples and is done.
const BRIEF: &str = "ready\nfor i in 1 2 3; do echo \"{\\\"iteration\\\": $i, \\\"samples\\\": $((i * 128))}\" \
                     >> $run/metrics.jsonl; done\n";

#[test]
fn a_learner_that_is_done_ends_the_group() {
    let learner = format!("{BRIEF}mkdir -p $run/checkpoints/00000003\nexit 0\n");
    let stage = Stage::new(OBEDIENT, &learner, OBEDIENT);
    let (status, said) = stage.train(&[]).end();
    assert_eq!(status, Some(0), "{said}");
    assert!(said.contains("run play complete"), "{said}");
    assert!(said.contains("at iteration 3, 384 samples"), "{said}");
    assert!(
        said.contains("all processes ended, shared memory removed"),
        "{said}"
    );
    assert_eq!(
        stage.lines("actor.arguments")[0].split(' ').next_back(),
        Some("0")
    );
    stage.assert_nothing_is_left();
}

#[test]
fn a_learner_that_could_not_save_what_it_learnt_is_a_failure() {
    let learner = format!("{BRIEF}mkdir -p $run/checkpoints/00000002\nexit 0\n");
    let stage = Stage::new(OBEDIENT, &learner, OBEDIENT);
    let (status, said) = stage.train(&[]).end();
    assert_eq!(status, Some(1), "{said}");
    assert!(
        said.contains("what was learnt in iterations 3 to 3 is lost"),
        "{said}"
    );
    stage.assert_nothing_is_left();
}

#[test]
fn ctrl_c_ends_the_learner_first() {
    let stage = Stage::new(OBEDIENT, OBEDIENT, OBEDIENT);
    let train = stage.train(&["--set", "run.deadlines.stop_seconds=1.0"]);
    for name in ["scheduler", "learner", "actor"] {
        stage.started(name, 1);
    }
    train.signal(Signal::INT);
    let (status, said) = train.end();
    assert_eq!(status, Some(0), "{said}");
    let ended = stage.lines("ended");
    assert_eq!(ended.len(), 3, "{ended:?} {said}");
    assert_eq!(ended[0], "learner", "{ended:?}");
    stage.assert_nothing_is_left();
}

#[test]
fn who_does_not_obey_is_killed_and_named() {
    let stage = Stage::new(OBEDIENT, DEAF, OBEDIENT);
    let train = stage.train(&["--set", "run.deadlines.stop_seconds=0.2"]);
    stage.started("learner", 1);
    train.signal(Signal::TERM);
    let (status, said) = train.end();
    assert_eq!(status, Some(0), "{said}");
    assert!(said.contains("killed: learner"), "{said}");
    stage.assert_nothing_is_left();
}

#[test]
fn a_second_ctrl_c_waits_for_nobody() {
    // The patience is an hour; the test ends because nobody has it.
    let stage = Stage::new(OBEDIENT, DEAF, OBEDIENT);
    let train = stage.train(&["--set", "run.deadlines.stop_seconds=3600"]);
    stage.started("learner", 1);
    train.signal(Signal::INT);
    // Signals of one kind are merged while one is pending; another kind is not.
    train.signal(Signal::TERM);
    let (status, said) = train.end();
    assert_eq!(status, Some(0), "{said}");
    assert!(said.contains("killed: "), "{said}");
    stage.assert_nothing_is_left();
}

#[test]
fn time_is_up_after_the_minutes() {
    let stage = Stage::new(OBEDIENT, OBEDIENT, OBEDIENT);
    let minutes = [
        "--minutes",
        "0.005",
        "--set",
        "run.deadlines.stop_seconds=1.0",
    ]; // 0.3 s
    let (status, said) = stage.train(&minutes).end();
    assert_eq!(status, Some(0), "{said}");
    assert!(said.contains("time is up"), "{said}");
    assert_eq!(
        stage.lines("ended").first().map(String::as_str),
        Some("learner")
    );
}

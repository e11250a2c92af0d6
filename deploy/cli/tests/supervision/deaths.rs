//! Programs that die: started again, gone on from a checkpoint, given up, and what is said of it.

use rustix::process::{Signal, kill_process};

use crate::stage::{OBEDIENT, Stage};

#[test]
fn who_is_killed_is_started_again() {
    let stage = Stage::new(OBEDIENT, OBEDIENT, OBEDIENT);
    let train = stage.train(&["--set", "run.deadlines.stop_seconds=1.0"]);
    for name in ["scheduler", "actor", "learner"] {
        kill_process(stage.started(name, 1), Signal::KILL).unwrap();
        stage.started(name, 2);
    }
    train.signal(Signal::TERM);
    let (status, said) = train.end();
    assert_eq!(status, Some(0), "{said}");
    assert!(
        said.contains("scheduler was killed by signal 9 (SIGKILL); restart 1"),
        "{said}"
    );
    // Without a checkpoint there is nothing that the learner could go on from.
    assert!(!stage.lines("learner.arguments")[1].contains("--resume"));
    stage.assert_nothing_is_left();
}

#[test]
fn a_restarted_learner_goes_on_from_its_checkpoint() {
    let stage = Stage::new(OBEDIENT, OBEDIENT, OBEDIENT);
    let train = stage.train(&["--set", "run.deadlines.stop_seconds=1.0"]);
    let learner = stage.started("learner", 1);
    let run = run::Folder::open(&stage.path("runs/play")).unwrap();
    run.checkpoints()
        .write(4, "any", &[("part", b"x")])
        .unwrap();
    kill_process(learner, Signal::KILL).unwrap();
    stage.started("learner", 2);
    train.signal(Signal::TERM);
    let (_, said) = train.end();
    assert!(
        stage.lines("learner.arguments")[1].contains("--resume"),
        "{said}"
    );
    assert!(said.contains("last checkpoint 00000004"), "{said}");
}

#[test]
fn a_refusal_at_the_first_start_is_passed_on_and_not_repeated() {
    let learner = "ready\necho 'ampco-learner: this cannot work' >&2\nexit 1\n";
    let stage = Stage::new(OBEDIENT, learner, OBEDIENT);
    let (status, said) = stage.train(&[]).end();
    assert_eq!(status, Some(1), "{said}");
    assert!(said.contains("ampco-learner: this cannot work"), "{said}");
    assert!(
        said.ends_with(
            "ampco: learner is given up; it failed with status 1: ampco-learner: this cannot work\n"
        ),
        "{said}"
    );
    assert_eq!(stage.lines("learner.pids").len(), 1);
    stage.assert_nothing_is_left();
}

#[test]
fn an_actor_that_always_dies_is_given_up() {
    let stage = Stage::new(OBEDIENT, OBEDIENT, "ready\nkill -9 $$\n");
    let (status, said) = stage
        .train(&["--set", "run.deadlines.stop_seconds=1.0"])
        .end();
    assert_eq!(status, Some(1), "{said}");
    assert_eq!(stage.lines("actor.pids").len(), 5);
    assert!(
        said.contains("actor-0 is given up; it was killed by signal 9 (SIGKILL); somebody sent it, or the kernel"),
        "{said}"
    );
    stage.assert_nothing_is_left();
}

#[test]
fn an_empty_log_is_not_pointed_to() {
    let log = "mkdir -p $run/logs\n: >> $run/logs/learner.log\n";
    let silent = Stage::new(OBEDIENT, &format!("{log}ready\nexit 1\n"), OBEDIENT);
    let (status, said) = silent.train(&[]).end();
    assert_eq!(status, Some(1), "{said}");
    let last = said.lines().last().unwrap_or_default();
    assert!(
        last.contains("learner is given up; it failed with status 1; it said nothing and "),
        "{said}"
    );
    assert!(
        last.ends_with("logs/learner.log is empty") && !last.contains("see "),
        "{said}"
    );
    silent.assert_nothing_is_left();

    let writes = format!("{log}echo why >> $run/logs/learner.log\nready\nexit 1\n");
    let logged = Stage::new(OBEDIENT, &writes, OBEDIENT);
    let (_, said) = logged.train(&[]).end();
    let last = said.lines().last().unwrap_or_default();
    assert!(
        last.contains("it failed with status 1; see ") && last.ends_with("logs/learner.log"),
        "{said}"
    );
    logged.assert_nothing_is_left();
}

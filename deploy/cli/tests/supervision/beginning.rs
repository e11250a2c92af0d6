//! What is refused before anything starts.

use rustix::process::Signal;

use crate::stage::{OBEDIENT, Stage};

#[test]
fn bad_configuration_starts_nothing_and_exits_with_two() {
    let stage = Stage::new(OBEDIENT, OBEDIENT, OBEDIENT);
    for (arguments, words) in [
        (["--set", "ppo.epohcs=3"], "did you mean `epochs`?"),
        (["--set", "fleet.steps=0"], "steps = 0"),
        (["--preset", "smok"], "did you mean `smoke`?"),
        (
            ["--set", "motion.clips=[{file='none.csv',fps=50}]"],
            "none.csv",
        ),
    ] {
        let (status, said) = stage.ampco(&arguments).end();
        assert_eq!(status, Some(2), "{said}");
        assert!(said.contains(words), "{said}");
        assert_eq!(said.lines().count(), 1, "one clear line, not {said}");
    }
    assert!(!stage.path("runs").exists() && stage.lines("learner.pids").is_empty());
}

#[test]
fn a_run_is_not_overwritten_and_a_running_one_not_joined() {
    let learner = "echo '{\"iteration\": 1}' >> $run/metrics.jsonl\ntrap 'exit 0' TERM\nready\n\
                   sleep 1000 & wait $!\n";
    let stage = Stage::new(OBEDIENT, learner, OBEDIENT);
    let train = stage.train(&["--set", "run.deadlines.stop_seconds=0.5"]);
    stage.started("learner", 1);
    let (status, said) = stage.train(&[]).end();
    assert_eq!(status, Some(2), "{said}");
    assert!(
        said.contains("run play exists already") && said.contains("--resume"),
        "{said}"
    );

    let run = run::Folder::open(&stage.path("runs/play")).unwrap();
    run.checkpoints()
        .write(1, "any", &[("part", b"x")])
        .unwrap();
    let (status, said) = stage.ampco(&["--resume"]).end();
    assert_eq!(status, Some(1), "{said}");
    assert!(said.contains("already has a supervisor"), "{said}");

    train.signal(Signal::TERM);
    train.end();
}

//! One actor and one learner: rollouts arrive, the version grows, the actor adopts it.

use protocol::{Domain, Node, RewardSubscriber, Shutdown, WeightsSubscriber};
use rustix::process::Signal;

use crate::harness::{Alone, Process, metrics, until, until_iteration};

#[test]
fn rollouts_arrive_and_every_version_is_adopted() {
    let run = Alone::new(1);
    run.set("policy.observation_clip", 1.5);
    let domain = Domain::for_run(run.path()).expect("a domain");
    let node = Node::join(&domain, "monitor", &Shutdown::manual()).expect("joined");
    let weights = WeightsSubscriber::new(&node).expect("opened");
    let mut rewards = RewardSubscriber::new(&node).expect("opened");
    let mut learner = run.start("ampco-learner", &[]);
    let _actor = run.start("ampco-actor", &["--index", "0"]);

    let mut version = 0;
    until("version 4", || {
        if let Some(newest) = weights.newest().expect("readable") {
            assert!(newest.header().version >= version, "versions only grow");
            version = newest.header().version;
            assert_eq!(newest.header().observation_clip, 1.5, "as it is configured");
            assert!(newest.flat().iter().all(|number| number.is_finite()));
        }
        node.tick();
        (version >= 4).then_some(())
    });
    let first = until("a report", || {
        node.tick();
        rewards.receive().expect("readable")
    });
    let lines = metrics(run.path());
    // What the scheduler is told is what is written down.
    assert_eq!(lines[0]["iteration"], first.report.iteration);
    assert_eq!(lines[0]["task_std"], first.report.task_std);
    for line in lines {
        // Lock-step: were the actor a version behind, its rollout would not have been used.
        assert_eq!(line["policy_lag"], 0.0);
        assert_eq!(line["rollouts"], 1);
        assert_eq!(line["stale"], 0);
        assert_eq!(line["dropped"], 0);
        for part in ["physics", "observation", "inference"] {
            let seconds = line["timing"][format!("{part}_seconds")].as_f64();
            assert!(seconds > Some(0.0), "{part} takes time: {}", line["timing"]);
        }
        assert!(
            line["task_std"].as_f64() > Some(0.0),
            "rewards vary: {line}"
        );
    }
    learner.signal(Signal::TERM);
    assert!(learner.end().success(), "{}", learner.stderr.text());
    let last = metrics(run.path()).pop().expect("lines")["iteration"]
        .as_u64()
        .expect("a number");
    let checkpoint = run.path().join(format!("checkpoints/{last:08}"));
    assert!(
        checkpoint.join("manifest.json").is_file(),
        "a stop leaves a checkpoint"
    );
}

#[test]
fn a_killed_actor_rejoins_and_a_killed_learner_goes_on_from_its_checkpoint() {
    let run = Alone::new(1);
    run.set("run.checkpoint_every", 2);
    let learner = run.start("ampco-learner", &[]);
    let actor = run.start("ampco-actor", &["--index", "0"]);
    let reached = until_iteration(run.path(), 3)["iteration"]
        .as_u64()
        .expect("a number");
    kill(actor);
    let _again = run.start("ampco-actor", &["--index", "0"]);
    until_iteration(run.path(), reached + 3);
    kill(learner);
    let checkpoint = run::Folder::open(run.path())
        .expect("the folder")
        .checkpoints()
        .list()
        .pop()
        .expect("a checkpoint");
    let _resumed = run.start("ampco-learner", &["--resume"]);
    let line = until("an iteration after the checkpoint", || {
        let lines = metrics(run.path());
        let numbers: Vec<u64> = lines
            .iter()
            .filter_map(|line| line["iteration"].as_u64())
            .collect();
        assert!(
            numbers.windows(2).all(|pair| pair[1] == pair[0] + 1),
            "{numbers:?}"
        );
        lines
            .into_iter()
            .find(|line| line["iteration"].as_u64() >= Some(checkpoint + 3))
    });
    assert_eq!(line["policy_lag"], 0.0);
}

fn kill(mut process: Process) {
    process.signal(Signal::KILL);
    process.end();
}

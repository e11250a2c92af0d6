//! Processes that die, come back, and are told to stop.

use std::sync::mpsc::channel;
use std::time::{Duration, Instant};

use protocol::{
    Lists, Node, RolloutHeader, RolloutPublisher, RolloutSubscriber, SUPERVISOR_VARIABLE,
    SendOutcome, Shutdown, Wake, WeightsHeader, WeightsOrder, WeightsPublisher, WeightsSubscriber,
    end_with_supervisor,
};

use crate::harness::{DEADLINE, Run, assignment, command, eventually, layout, say, until_released};

fn header(version: u64) -> WeightsHeader {
    WeightsHeader::new(version, WeightsOrder::Collect, &[], 5.0, layout(), true)
}

/// What the other processes do.
#[test]
#[ignore = "run by the tests beside it, as their other process"]
fn other_process() {
    let (role, domain) = assignment();
    let join = |shutdown: &Shutdown| Node::join(&domain, &role, shutdown).unwrap();
    match role.as_str() {
        "learner" => {
            let node = join(&Shutdown::manual());
            let _rollouts = RolloutSubscriber::new(&node, Lists::default()).unwrap();
            let weights = WeightsPublisher::new(&node, 1).unwrap();
            weights.broadcast(header(5), &[5.0]).unwrap();
            say("ready");
            until_released();
        }
        "actor" => {
            let node = join(&Shutdown::manual());
            let mut rollouts = RolloutPublisher::new(&node, 0, layout(), DEADLINE).unwrap();
            let loan = rollouts.loan().unwrap();
            rollouts.send(loan, RolloutHeader::default()).unwrap();
            say("ready");
            until_released();
        }
        "waiting" => {
            let shutdown = Shutdown::on_signals().unwrap();
            let tied = end_with_supervisor().unwrap();
            let node = join(&shutdown);
            let weights = WeightsSubscriber::new(&node).unwrap();
            say(if tied { "tied" } else { "free" });
            let wake = weights.wait(2 * DEADLINE).unwrap();
            say(if wake == Wake::Shutdown {
                "told to stop"
            } else {
                "waited in vain"
            });
        }
        "supervisor" => {
            // The child speaks through the same pipe, so that it is heard after this process ends.
            let mut child = command("waiting")
                .env(SUPERVISOR_VARIABLE, std::process::id().to_string())
                .stdout(std::io::stdout())
                .spawn()
                .unwrap();
            child.wait().unwrap();
        }
        unknown => panic!("role {unknown}"),
    }
}

#[test]
fn a_killed_learner_s_places_are_free_again_and_actors_stay() {
    let run = Run::new();
    let actor = run.join("actor-0");
    let weights = WeightsSubscriber::new(&actor).unwrap();
    let mut rollouts = RolloutPublisher::new(&actor, 0, layout(), DEADLINE).unwrap();
    let receive = |version| {
        eventually("weights", || {
            weights.wait(Duration::from_millis(20)).unwrap();
            let newest = weights.newest().unwrap()?;
            (newest.header().version == version).then(|| newest.header().learner)
        })
    };

    let mut first = run.start("learner");
    first.expect("ready");
    let first_incarnation = receive(5);
    let loan = rollouts.loan().unwrap();
    let sent = rollouts.send(loan, RolloutHeader::default()).unwrap();
    assert_eq!(sent, SendOutcome::Delivered);
    first.kill();

    // In this process: the ports of the actor were never reopened.
    let learner = run.join("learner");
    let subscriber = RolloutSubscriber::new(&learner, Lists::default()).unwrap();
    let publisher = WeightsPublisher::new(&learner, 1).unwrap();
    publisher.broadcast(header(6), &[6.0]).unwrap();
    assert!(receive(6) > first_incarnation);

    let loan = rollouts.loan().unwrap();
    let sent = rollouts.send(loan, RolloutHeader::default()).unwrap();
    assert_eq!(sent, SendOutcome::Delivered);
    let rollout = eventually("a rollout", || {
        subscriber.wait(Duration::from_millis(20)).unwrap();
        subscriber.receive().unwrap()
    });
    // The first of this actor went to the first learner.
    assert_eq!(rollout.header().sequence, 1);
}

#[test]
fn a_killed_actor_is_replaced_and_its_last_rollout_still_counts() {
    let run = Run::new();
    let learner = run.join("learner");
    let subscriber = RolloutSubscriber::new(&learner, Lists::default()).unwrap();
    let receive = || {
        eventually("a rollout", || {
            subscriber.wait(Duration::from_millis(20)).unwrap();
            let rollout = subscriber.receive().unwrap()?;
            Some(rollout.header().incarnation)
        })
    };
    let mut first = run.start("actor");
    first.expect("ready");
    let first_incarnation = receive();
    first.kill();
    let second = run.start("actor");
    second.expect("ready");
    assert!(receive() > first_incarnation);
    second.release();
}

#[test]
fn an_actor_held_up_by_a_killed_learner_comes_free() {
    let run = Run::new();
    let actor = run.join("actor-0");
    let mut learner = run.start("learner");
    learner.expect("ready");
    let mut rollouts = RolloutPublisher::new(&actor, 0, layout(), 2 * DEADLINE).unwrap();

    let (sender, about_to_block) = channel();
    let sending = std::thread::spawn(move || {
        // The learner reads nothing: two fit, the third waits.
        for _ in 0..2 {
            let loan = rollouts.loan().unwrap();
            let sent = rollouts.send(loan, RolloutHeader::default()).unwrap();
            assert_eq!(sent, SendOutcome::Delivered);
        }
        let loan = rollouts.loan().unwrap();
        sender.send(()).unwrap();
        let start = Instant::now();
        let outcome = rollouts.send(loan, RolloutHeader::default()).unwrap();
        (outcome, start.elapsed())
    });
    about_to_block.recv_timeout(DEADLINE).unwrap();
    learner.kill();
    let (outcome, took) = sending.join().unwrap();
    assert_eq!(outcome, SendOutcome::Lost);
    // Not by its patience, which is twice as long.
    assert!(took < DEADLINE, "{took:?}");
}

#[test]
fn nothing_remains_of_processes_that_were_killed() {
    let run = Run::new();
    let mut learner = run.start("learner");
    learner.expect("ready");
    let mut actor = run.start("actor");
    actor.expect("ready");
    assert!(run.domain.remove().is_err());
    learner.kill();
    actor.kill();
    assert!(!run.domain.leftovers().unwrap().is_empty());
    run.domain.remove().unwrap();
    assert!(run.domain.leftovers().unwrap().is_empty());
}

#[test]
fn sigterm_ends_the_waiting() {
    let run = Run::new();
    let waiting = run.start("waiting");
    waiting.expect("free");
    waiting.terminate();
    waiting.expect("told to stop");
    waiting.release();
}

#[test]
fn children_of_a_killed_supervisor_are_told_to_stop() {
    let run = Run::new();
    let mut supervisor = run.start("supervisor");
    supervisor.expect("tied");
    supervisor.kill();
    supervisor.expect("told to stop");
    supervisor.expect_silence(); // the child has left the domain
}

//! Numbers that are none: caught where they come in, named, counted, and no reason to stop.

use std::time::Duration;

use protocol::{
    Domain, Lists, Node, RolloutHeader, RolloutLayout, RolloutPublisher, RolloutViewMut,
    SendOutcome, Shutdown, WeightsHeader, WeightsOrder, WeightsPublisher, WeightsSubscriber,
};
use serde_json::Value;

use crate::harness::{Alone, metrics, own_memory, until, until_iteration};

/// Longest that a send may take.
const PATIENCE: Duration = Duration::from_secs(30);

/// The smoke preset's rollouts for two actors: 16 / 2 robots, 8 steps.
fn layout() -> RolloutLayout {
    RolloutLayout {
        environments: 8,
        steps: 8,
        lists: Lists::default(),
    }
}

/// An actor whose rollouts are what the test says.
struct ActorsPart {
    weights: WeightsSubscriber,
    rollouts: RolloutPublisher,
}

impl ActorsPart {
    fn play(run: &Alone, index: u32) -> Self {
        let domain = Domain::for_run(run.path()).expect("a domain");
        let role = format!("actor-{index}");
        let node = Node::join(&domain, &role, &Shutdown::manual()).expect("joined");
        Self {
            weights: WeightsSubscriber::new(&node).expect("opened"),
            rollouts: RolloutPublisher::new(&node, index, layout(), PATIENCE).expect("opened"),
        }
    }

    /// Answers the next weights with zeros, changed by `spoil`, and returns the line of that iteration.
    fn answer(&mut self, run: &Alone, spoil: fn(&mut RolloutViewMut<'_>)) -> Value {
        let header = until("weights", || {
            let newest = self.weights.newest().expect("readable")?;
            assert!(newest.flat().iter().all(|number| number.is_finite()));
            Some(*newest.header())
        });
        let mut loan = self.rollouts.loan().expect("memory");
        loan.numbers_mut().fill(0.0);
        spoil(&mut loan.view_mut());
        let answer = RolloutHeader {
            learner: header.learner,
            policy_version: header.version,
            ..RolloutHeader::default()
        };
        let sent = self.rollouts.send(loan, answer).expect("sent");
        assert_eq!(sent, SendOutcome::Delivered);
        until_iteration(run.path(), header.version + 1);
        let lines = metrics(run.path());
        let this = Some(header.version + 1);
        lines
            .into_iter()
            .find(|line| line["iteration"].as_u64() == this)
            .expect("its line")
    }
}

#[test]
fn a_rollout_with_a_number_that_cannot_be_is_refused_and_the_others_are_learned_from() {
    let run = Alone::new(2);
    let learner = run.start("ampco-learner", &[]);
    let _actor = run.start("ampco-actor", &["--index", "0"]);
    let mut spoiled = ActorsPart::play(&run, 1);
    let spoils: [fn(&mut RolloutViewMut<'_>); 4] = [
        |view| view.observations[100] = f32::NAN,
        |view| view.task_rewards[3] = f32::INFINITY,
        |view| view.log_probs[0] = f32::NEG_INFINITY,
        |view| view.ends[9] = 7.0,
    ];
    for (count, spoil) in (1..).zip(spoils) {
        let line = spoiled.answer(&run, spoil);
        assert_eq!(line["unusable"], count, "{line}");
        assert_eq!(line["rollouts"], 1, "the other one counts: {line}");
        assert!(line.get("fault").is_none(), "{line}");
    }
    let line = spoiled.answer(&run, |_| {});
    assert_eq!(
        (&line["unusable"], &line["rollouts"]),
        (&4.into(), &2.into()),
        "{line}"
    );
    let said = learner.stderr.text();
    for named in [
        "observations",
        "task_rewards",
        "log_probs",
        "ends",
        "actor=1",
    ] {
        assert!(said.contains(named), "{named} is not in {said}");
    }
}

/// What an actor says to weights that a learner of this build would not send.
fn refused(header: WeightsHeader, flat: &[f32]) -> String {
    let run = Alone::new(2);
    let domain = Domain::for_run(run.path()).expect("a domain");
    let node = Node::join(&domain, "learner", &Shutdown::manual()).expect("joined");
    let weights = WeightsPublisher::new(&node, flat.len()).expect("opened");
    let mut actor = run.start("ampco-actor", &["--index", "0"]);
    weights.broadcast(header, flat).expect("sent");
    let status = actor.end();
    let said = actor.stderr.text();
    assert_eq!(status.code(), Some(1), "{said}");
    assert!(!said.contains("panic"), "{said}");
    said
}

#[test]
fn weights_that_are_none_are_refused_by_the_actor() {
    let header = |hidden: &[usize]| {
        WeightsHeader::new(0, WeightsOrder::Collect, hidden, 5.0, layout(), true)
    };
    let shape = policy::Shape::new(layout().lists.widths.observation, &[16, 16]);
    let mut flat = vec![0.5; shape.len()];
    flat[900] = f32::NAN;
    let said = refused(header(&[16, 16]), &flat);
    assert!(said.contains("weight 900 is NaN"), "{said}");

    flat[900] = 0.5;
    let order = WeightsHeader {
        order: 77,
        ..header(&[16, 16])
    };
    assert!(refused(order, &flat).contains("order 77"));
    // Nothing is reserved for sizes that the message does not have.
    let hostile = WeightsHeader {
        layers: u32::MAX,
        hidden: [u32::MAX; 6],
        ..header(&[16, 16])
    };
    assert!(refused(hostile, &flat).contains("4294967295"));
    let unclipped = WeightsHeader {
        observation_clip: f32::NAN,
        ..header(&[16, 16])
    };
    assert!(refused(unclipped, &flat).contains("clip of observations is NaN"));
    let other = WeightsHeader {
        environments: u32::MAX,
        steps: u32::MAX,
        ..header(&[16, 16])
    };
    assert!(refused(other, &flat).contains("config.toml"));
}

#[test]
fn the_learner_keeps_its_memory_while_it_refuses() {
    let run = Alone::new(2);
    let learner = run.start("ampco-learner", &[]);
    let _actor = run.start("ampco-actor", &["--index", "0"]);
    let mut spoiled = ActorsPart::play(&run, 1);
    spoiled.answer(&run, |view| view.actions.fill(f32::NAN));
    let before = own_memory(learner.pid());
    for _ in 0..30 {
        spoiled.answer(&run, |view| view.actions.fill(f32::NAN));
    }
    let grown = own_memory(learner.pid()).saturating_sub(before);
    assert!(grown < 16 << 20, "the learner grew by {grown} bytes");
}

//! What is refused, and what the refusal says.

use std::time::Duration;

use protocol::{
    DomainError, Lists, Node, PROTOCOL_VERSION, PortError, RolloutHeader, RolloutLayout,
    RolloutPublisher, RolloutSubscriber, Shutdown, WeightsHeader, WeightsOrder, WeightsPublisher,
    WeightsSubscriber,
};

use crate::harness::{DEADLINE, Run, layout};

#[test]
fn another_version_is_refused_and_both_are_named() {
    let run = Run::new();
    let learner = run.join("learner");
    let _subscriber = RolloutSubscriber::new(&learner, Lists::default()).unwrap();

    let newer = run.domain.clone().speaking(7002);
    let actor = Node::join(&newer, "actor-0", &Shutdown::manual()).unwrap();
    let error = RolloutPublisher::new(&actor, 0, layout(), DEADLINE).unwrap_err();
    let PortError::Version { theirs, ours, .. } = &error else {
        panic!("{error}");
    };
    let spoken = PROTOCOL_VERSION.to_string();
    assert_eq!((theirs.as_str(), *ours), (spoken.as_str(), 7002));
    let text = error.to_string();
    assert!(
        text.contains(&format!("version {spoken}")) && text.contains("7002"),
        "{text}"
    );
}

#[test]
fn a_second_learner_is_refused_while_the_first_lives() {
    let run = Run::new();
    let (first, second) = (run.join("learner"), run.join("learner"));
    let rollouts = RolloutSubscriber::new(&first, Lists::default()).unwrap();
    let weights = WeightsPublisher::new(&first, 1).unwrap();
    for error in [
        RolloutSubscriber::new(&second, Lists::default()).unwrap_err(),
        WeightsPublisher::new(&second, 1).unwrap_err(),
    ] {
        let PortError::Taken { limit, .. } = error else {
            panic!("{error}");
        };
        assert_eq!(limit, 1);
        assert!(error.to_string().contains("second process"), "{error}");
    }
    // It may take over once the first has left.
    drop((rollouts, weights));
    RolloutSubscriber::new(&second, Lists::default()).unwrap();
    WeightsPublisher::new(&second, 1).unwrap();
}

#[test]
fn memory_that_does_not_exist_is_refused_before_it_is_touched() {
    let run = Run::new();
    let actor = run.join("actor-0");
    // 100 million environments · 648 numbers · 4 bytes · 6 messages: a petabyte and a half.
    let layout = RolloutLayout {
        environments: 100_000_000,
        steps: 2,
        ..layout()
    };
    let error = RolloutPublisher::new(&actor, 0, layout, DEADLINE).unwrap_err();
    let PortError::Memory { needed, free, .. } = error else {
        panic!("{error}");
    };
    assert!(needed > free);
    assert!(error.to_string().contains("--shm-size"), "{error}");
}

#[test]
fn weights_of_another_shape_are_refused() {
    let run = Run::new();
    let learner = run.join("learner");
    let publisher = WeightsPublisher::new(&learner, 3).unwrap();
    let header = WeightsHeader::new(0, WeightsOrder::Collect, &[], 5.0, layout(), true);
    let error = publisher.broadcast(header, &[0.0; 2]).unwrap_err();
    let PortError::Length { expected, got, .. } = error else {
        panic!("{error}");
    };
    assert_eq!((expected, got), (3, 2));
}

#[test]
fn a_domain_is_not_removed_under_its_members_and_leaves_nothing_afterwards() {
    let run = Run::new();
    let (learner, actor) = (run.join("learner"), run.join("actor-5"));
    let publisher = WeightsPublisher::new(&learner, 1).unwrap();
    let subscriber = WeightsSubscriber::new(&actor).unwrap();
    subscriber.wait(Duration::ZERO).unwrap();

    let error = run.domain.remove().unwrap_err();
    let DomainError::InUse { members, .. } = &error else {
        panic!("{error}");
    };
    assert_eq!(members.len(), 2);
    assert!(members[0].starts_with("actor-5 (process "), "{members:?}");

    drop((publisher, subscriber, learner, actor));
    assert_eq!(run.domain.members().unwrap(), []);
    assert!(run.domain.remove().unwrap() > 0);
    assert!(run.domain.leftovers().unwrap().is_empty());
}

#[test]
fn rollouts_of_other_lists_are_refused_with_the_difference_in_words() {
    let run = Run::new();
    let (actor, learner) = (run.join("actor-2"), run.join("learner"));
    let text = "[actor]\nterms = ['gravity', 'command']";
    let config: observation::ObservationConfig = toml::from_str(text).unwrap();
    let other = RolloutLayout {
        lists: (&config.tables().unwrap()).into(),
        ..layout()
    };
    let subscriber = RolloutSubscriber::new(&learner, Lists::default()).unwrap();
    let mut publisher = RolloutPublisher::new(&actor, 2, other, DEADLINE).unwrap();
    let mut loan = publisher.loan().unwrap();
    loan.numbers_mut().fill(0.0);
    publisher.send(loan, RolloutHeader::default()).unwrap();
    let error = subscriber.receive().unwrap_err();
    assert!(
        matches!(error, PortError::Lists { actor: 2, .. }),
        "{error}"
    );
    let said = error.to_string();
    assert!(
        said.contains("observation.actor lacks height, linear_velocity")
            && said.contains("config.toml"),
        "{said}"
    );
}

//! What is sent arrives, in whatever order processes come.

use std::time::Duration;

use protocol::{
    Answer, Directive, DirectivePublisher, DirectiveSubscriber, Entry, Ledger, Lists,
    RewardPublisher, RewardReport, RewardSubscriber, RolloutHeader, RolloutPublisher,
    RolloutSubscriber, SendOutcome, Wake, WeightsHeader, WeightsOrder, WeightsPublisher,
    WeightsSubscriber,
};

use crate::harness::{DEADLINE, Run, eventually, layout};

#[test]
fn a_rollout_written_in_place_is_read_in_place() {
    let run = Run::new();
    let (actor, learner) = (run.join("actor-3"), run.join("learner"));
    let subscriber = RolloutSubscriber::new(&learner, Lists::default()).unwrap();
    let mut publisher = RolloutPublisher::new(&actor, 3, layout(), DEADLINE).unwrap();

    let mut loan = publisher.loan().unwrap();
    let mut view = loan.view_mut();
    for step in 0..layout().steps {
        view.step(step).task_rewards.fill(step as f32);
    }
    view.last_observations.fill(0.5);
    let header = RolloutHeader {
        learner: 9,
        policy_version: 12,
        physics_seconds: 0.5,
        observation_seconds: 0.25,
        inference_seconds: 0.75,
        waiting_seconds: 2.0,
        collect_seconds: 1.5,
        ..RolloutHeader::default()
    };
    assert_eq!(
        publisher.send(loan, header).unwrap(),
        SendOutcome::Delivered
    );

    assert_eq!(subscriber.wait(DEADLINE).unwrap(), Wake::Message);
    let rollout = subscriber.receive().unwrap().unwrap();
    let expected = RolloutHeader {
        actor: 3,
        environments: 2,
        steps: 3,
        incarnation: actor.incarnation(),
        sequence: 0,
        lists: Lists::default().into(),
        ..header
    };
    assert_eq!(*rollout.header(), expected);
    // Two environments in each of three steps.
    assert_eq!(rollout.view().task_rewards, [0.0, 0.0, 1.0, 1.0, 2.0, 2.0]);
    assert_eq!(rollout.view().last_observations, [0.5; 2 * 82]);
    assert!(subscriber.receive().unwrap().is_none());
}

#[test]
fn a_full_buffer_holds_the_actor_up_and_what_it_drops_is_counted() {
    let run = Run::new();
    let (actor, learner) = (run.join("actor-0"), run.join("learner"));
    let subscriber = RolloutSubscriber::new(&learner, Lists::default()).unwrap();
    let patience = Duration::from_millis(60);
    let mut publisher = RolloutPublisher::new(&actor, 0, layout(), patience).unwrap();
    assert!(subscriber.receive().unwrap().is_none()); // connects
    let mut send = || {
        let loan = publisher.loan().unwrap();
        let outcome = publisher.send(loan, RolloutHeader::default()).unwrap();
        (outcome, publisher.waited(), publisher.totals())
    };

    // Two fit.
    assert_eq!(send().0, SendOutcome::Delivered);
    assert_eq!(send().0, SendOutcome::Delivered);
    let (outcome, waited, totals) = send();
    assert_eq!(outcome, SendOutcome::Dropped);
    assert!(waited >= patience, "{waited:?}");
    assert_eq!((totals.delivered, totals.dropped), (2, 1));

    // Reading makes room; the gap shows.
    let mut ledger = Ledger::default();
    let mut enter = || {
        let rollout = subscriber.receive().unwrap().unwrap();
        ledger.enter(rollout.header(), 0, 0)
    };
    assert_eq!(enter(), Entry::Fresh);
    assert_eq!(enter(), Entry::Fresh);
    assert_eq!(send().0, SendOutcome::Delivered);
    assert_eq!(enter(), Entry::Fresh);
    assert_eq!(ledger.totals().dropped, 1);
    assert_eq!(ledger.totals().received, 3);
}

#[test]
fn a_request_to_stop_frees_an_actor_that_is_held_up() {
    let run = Run::new();
    let (actor, learner) = (run.join("actor-0"), run.join("learner"));
    let subscriber = RolloutSubscriber::new(&learner, Lists::default()).unwrap();
    let mut publisher = RolloutPublisher::new(&actor, 0, layout(), 2 * DEADLINE).unwrap();
    assert!(subscriber.receive().unwrap().is_none()); // connects
    let mut send = || {
        let loan = publisher.loan().unwrap();
        publisher.send(loan, RolloutHeader::default()).unwrap()
    };
    send();
    send();
    actor.shutdown().request();
    assert_eq!(send(), SendOutcome::Interrupted);
}

#[test]
fn without_a_learner_a_rollout_is_lost_and_said_so() {
    let run = Run::new();
    let actor = run.join("actor-0");
    let mut publisher = RolloutPublisher::new(&actor, 0, layout(), DEADLINE).unwrap();
    let loan = publisher.loan().unwrap();
    let outcome = publisher.send(loan, RolloutHeader::default()).unwrap();
    assert_eq!(outcome, SendOutcome::Lost);
    assert_eq!(publisher.totals().lost, 1);
}

#[test]
fn a_late_actor_gets_the_newest_weights_and_only_those() {
    let run = Run::new();
    let (learner, actor) = (run.join("learner"), run.join("actor-0"));
    let publisher = WeightsPublisher::new(&learner, 4).unwrap();
    let header =
        |version| WeightsHeader::new(version, WeightsOrder::Collect, &[8], 5.0, layout(), true);
    publisher.broadcast(header(1), &[1.0; 4]).unwrap();
    publisher.broadcast(header(2), &[2.0; 4]).unwrap();

    let subscriber = WeightsSubscriber::new(&actor).unwrap();
    let weights = eventually("the newest weights", || {
        subscriber.wait(Duration::from_millis(10)).unwrap();
        subscriber.newest().unwrap()
    });
    assert_eq!(weights.header().version, 2);
    assert_eq!(weights.header().learner, learner.incarnation());
    assert_eq!(weights.flat(), [2.0; 4]);
    drop(weights);

    // Of two sent since then, the newer.
    publisher.broadcast(header(3), &[3.0; 4]).unwrap();
    publisher.broadcast(header(4), &[4.0; 4]).unwrap();
    assert_eq!(subscriber.newest().unwrap().unwrap().flat(), [4.0; 4]);
    assert!(subscriber.newest().unwrap().is_none());
}

#[test]
fn weights_in_use_do_not_hinder_newer_ones() {
    let run = Run::new();
    let (learner, actor) = (run.join("learner"), run.join("actor-0"));
    let publisher = WeightsPublisher::new(&learner, 1).unwrap();
    let subscriber = WeightsSubscriber::new(&actor).unwrap();
    let broadcast = |version| {
        let header = WeightsHeader::new(version, WeightsOrder::Collect, &[], 5.0, layout(), false);
        publisher.broadcast(header, &[version as f32]).unwrap();
    };
    broadcast(1);
    let in_use = subscriber.newest().unwrap().unwrap();
    broadcast(2);
    let newer = subscriber.newest().unwrap().unwrap();
    assert_eq!((in_use.flat(), newer.flat()), (&[1.0][..], &[2.0][..]));
    drop(in_use);

    // A learner that broadcasts while the actor looks: it found one newer and looks on.
    std::thread::scope(|scope| {
        scope.spawn(|| (3..2000).for_each(broadcast));
        let mut last = 2;
        while last < 1999 {
            subscriber.wait(DEADLINE).unwrap();
            if let Some(weights) = subscriber.newest().unwrap() {
                assert!(weights.header().version > last);
                last = weights.header().version;
            }
        }
    });
    drop(newer);
}

#[test]
fn weights_outlive_more_broadcasts_than_memory_is_reserved_for() {
    let run = Run::new();
    let (learner, actor) = (run.join("learner"), run.join("actor-0"));
    let publisher = WeightsPublisher::new(&learner, 2).unwrap();
    let subscriber = WeightsSubscriber::new(&actor).unwrap();
    for version in 0..100 {
        let header = WeightsHeader::new(version, WeightsOrder::Collect, &[], 5.0, layout(), false);
        publisher.broadcast(header, &[version as f32; 2]).unwrap();
    }
    let weights = subscriber.newest().unwrap().unwrap();
    assert_eq!(weights.header().version, 99);
    assert_eq!(weights.flat(), [99.0; 2]);
}

#[test]
fn sixty_four_reports_wait_and_the_rest_is_a_counted_gap() {
    let run = Run::new();
    let (learner, scheduler) = (run.join("learner"), run.join("scheduler"));
    let mut subscriber = RewardSubscriber::new(&scheduler).unwrap();
    let mut publisher = RewardPublisher::new(&learner).unwrap();
    for iteration in 0..70 {
        let report = RewardReport {
            iteration,
            style_mean: 0.25,
            ..RewardReport::default()
        };
        publisher.send(report).unwrap();
    }
    assert_eq!(subscriber.wait(DEADLINE).unwrap(), Wake::Message);
    // 70 sent, the newest 64 kept: 0 to 5 are missing before the first.
    let first = subscriber.receive().unwrap().unwrap();
    assert_eq!(
        (first.missed, first.new_learner, first.report.iteration),
        (6, true, 6)
    );
    assert_eq!(first.report.style_mean, 0.25);
    let mut rest = 0;
    while let Some(arrival) = subscriber.receive().unwrap() {
        assert_eq!(arrival.missed, 0);
        rest += 1;
    }
    assert_eq!(rest, 63);
    assert_eq!(subscriber.missed(), 6);
}

#[test]
fn the_learner_waits_for_the_answer_to_its_own_report() {
    let run = Run::new();
    let (learner, scheduler) = (run.join("learner"), run.join("scheduler"));
    let mut publisher = DirectivePublisher::new(&scheduler).unwrap();
    let answer = |learner, iteration| Directive {
        learner,
        iteration,
        rule: 1,
        first: 0.5,
        ..Directive::default()
    };
    let me = learner.incarnation();
    // An answer to an earlier life, and one to the report before.
    publisher.send(answer(me - 1, 8)).unwrap();
    let mut subscriber = DirectiveSubscriber::new(&learner).unwrap();
    publisher.send(answer(me, 6)).unwrap();
    let short = Duration::from_millis(30);
    assert_eq!(subscriber.wait_for(me, 7, short).unwrap(), Answer::Late);

    let answering = std::thread::spawn(move || {
        publisher.send(answer(me, 7)).unwrap();
        publisher // dropping it would wake the learner too
    });
    let Answer::Came(directive) = subscriber.wait_for(me, 7, DEADLINE).unwrap() else {
        panic!("no answer within {DEADLINE:?}");
    };
    assert_eq!(directive.iteration, 7);
    assert_eq!(directive.scheduler, scheduler.incarnation());
    assert_eq!(directive.sequence, 2);
    assert_eq!((directive.rule, directive.first), (1, 0.5));
    answering.join().unwrap();

    // Asked to stop, the learner waits no longer than a second for the last word.
    learner.shutdown().request();
    let answer = subscriber.wait_for(me, 8, 100 * DEADLINE).unwrap();
    assert_eq!(answer, Answer::Shutdown);
}

#[test]
fn a_request_to_stop_is_said_once_and_then_waiting_goes_on() {
    let run = Run::new();
    let (learner, actor) = (run.join("learner"), run.join("actor-0"));
    let subscriber = RolloutSubscriber::new(&learner, Lists::default()).unwrap();
    learner.shutdown().request();
    assert_eq!(subscriber.wait(DEADLINE).unwrap(), Wake::Shutdown);
    // A learner that brings its iteration to an end neither spins nor misses a rollout.
    let short = Duration::from_millis(5);
    assert_eq!(subscriber.wait(short).unwrap(), Wake::Timeout);
    let mut publisher = RolloutPublisher::new(&actor, 0, layout(), DEADLINE).unwrap();
    let loan = publisher.loan().unwrap();
    publisher.send(loan, RolloutHeader::default()).unwrap();
    assert_eq!(subscriber.wait(DEADLINE).unwrap(), Wake::Message);
}

#[test]
fn two_runs_never_meet() {
    let (here, there) = (Run::new(), Run::new());
    let (learner, actor) = (here.join("learner"), there.join("actor-0"));
    let publisher = WeightsPublisher::new(&learner, 1).unwrap();
    let subscriber = WeightsSubscriber::new(&actor).unwrap();
    let header = WeightsHeader::new(1, WeightsOrder::Collect, &[], 5.0, layout(), true);
    publisher.broadcast(header, &[1.0]).unwrap();
    learner.tick();
    assert_eq!(
        subscriber.wait(Duration::from_millis(150)).unwrap(),
        Wake::Timeout
    );
    assert!(subscriber.newest().unwrap().is_none());
    // The only place of the other run is free.
    WeightsPublisher::new(&actor, 1).unwrap();
}

//! Someone who watches a run: told what the streams say, and not noticed, not even at the end.

use std::time::{Duration, Instant};

use protocol::{DirectiveSubscriber, Domain, Node, RewardSubscriber, Shutdown, WeightsSubscriber};
use rustix::process::Signal;

use crate::harness::{Runs, holder, metrics, until, until_iteration};

#[test]
fn a_watcher_sees_every_report_and_the_group_ends_well_around_it() {
    let runs = Runs::new();
    let mut group = runs.train("watched", &[]);
    let run = runs.run("watched");
    until_iteration(&run, 2);

    let domain = Domain::for_run(&run).expect("a domain");
    let node = Node::join(&domain, "monitor", &Shutdown::manual()).expect("joined");
    let mut rewards = RewardSubscriber::new(&node).expect("a place");
    let mut directives = DirectiveSubscriber::new(&node).expect("a place");
    let weights = WeightsSubscriber::new(&node).expect("a place");
    let first = until("a report", || rewards.receive().expect("readable"));
    let before = rewards.missed();
    let last = until("the third report after", || {
        let arrival = rewards.receive().expect("readable")?;
        (arrival.report.iteration >= first.report.iteration + 3).then_some(arrival)
    });
    assert_eq!(
        rewards.missed(),
        before,
        "no report is lost on a watcher that keeps up"
    );
    let line = until_iteration(&run, last.report.iteration);
    let logged = metrics(&run)
        .into_iter()
        .find(|line| line["iteration"].as_u64() == Some(last.report.iteration));
    assert_eq!(
        logged.expect("logged before it was reported")["style_mean"].as_f64(),
        Some(last.report.style_mean)
    );
    assert_eq!(line["dropped"], 0);
    assert!(
        directives.newest().expect("readable").is_some(),
        "the newest is kept for late readers"
    );
    let version = until("weights", || {
        weights
            .newest()
            .expect("readable")
            .map(|w| w.header().version)
    });
    assert!(version >= 2);

    // A watcher that notices the end late: the group waits for it, and then ends as always.
    group.signal(Signal::TERM);
    until("the end of the scheduler", || {
        holder(&run, "scheduler").is_none().then_some(())
    });
    let slow = Instant::now() + Duration::from_millis(500);
    until("a slow watcher", || (Instant::now() >= slow).then_some(()));
    drop((rewards, directives, weights, node));
    assert!(group.end().success(), "{}", group.stderr.text());
    let left = domain.leftovers().expect("readable");
    assert!(left.is_empty(), "{left:?}");
}

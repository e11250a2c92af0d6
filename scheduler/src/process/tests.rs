//! The loop over real shared memory, with a learner that only reports.

use std::fs;
use std::thread;
use std::time::Instant;

use ampco::{Schedule, ScheduleConfig};
use protocol::{Answer, DirectiveSubscriber, RewardPublisher, RewardReport};
use run::Metrics;
use serde_json::json;

use super::*;

/// Longest wait for an answer on a busy machine.
const PATIENCE: Duration = Duration::from_secs(30);

fn config() -> ScheduleConfig {
    ScheduleConfig {
        window: 5,
        percentile: 0.5,
        ..Default::default()
    }
}

/// A reward that climbs for ten iterations and stays.
fn report(iteration: u64) -> RewardReport {
    let style_mean = iteration.min(10) as f64 / 16.0;
    RewardReport {
        iteration,
        style_mean,
        style_std: 0.125,
        task_mean: 0.5,
        ..Default::default()
    }
}

/// What must come back: the decision of a scheduler that was never away.
fn expected(learner: u64, iteration: u64) -> Directive {
    let mut schedule = Schedule::new(config()).unwrap();
    for earlier in 1..=iteration {
        schedule.observe(message::report(&report(earlier))).unwrap();
    }
    message::directive(learner, &schedule.decision(iteration))
}

/// A learner that only reports, and the folder of its run.
struct Learner {
    folder: Folder,
    domain: Domain,
    node: Node,
    metrics: Metrics,
    rewards: RewardPublisher,
    directives: DirectiveSubscriber,
}

impl Learner {
    fn begin(runs: &Path) -> Self {
        let folder = Folder::create(runs, "run").unwrap();
        let domain = Domain::for_run(folder.path()).unwrap();
        let node = Node::join(&domain, "learner", &Shutdown::manual()).unwrap();
        Self {
            metrics: Metrics::open(&folder.metrics_path()).unwrap(),
            rewards: RewardPublisher::new(&node).unwrap(),
            directives: DirectiveSubscriber::new(&node).unwrap(),
            folder,
            domain,
            node,
        }
    }

    fn iterate(&mut self, iteration: u64) {
        let report = report(iteration);
        let line = json!({
            "iteration": iteration, "style_mean": report.style_mean, "style_std": report.style_std,
            "style_std_robots": report.style_std_robots, "task_mean": report.task_mean
        });
        self.metrics.append(&line).unwrap();
        self.rewards.send(report).unwrap();
    }

    /// Goes on until it is heard, as a report sent before the scheduler listens is lost; returns the iteration.
    fn iterate_until_answered(&mut self, first: u64) -> u64 {
        let deadline = Instant::now() + PATIENCE;
        let heard = (first..).find(|&iteration| {
            assert!(
                Instant::now() < deadline,
                "no answer to iterations {first} to {iteration}"
            );
            self.iterate(iteration);
            let learner = self.node.incarnation();
            let answer = self
                .directives
                .wait_for(learner, iteration, 2 * protocol::TICK)
                .unwrap();
            matches!(answer, Answer::Came(_))
        });
        heard.unwrap()
    }

    fn answer(&mut self, iteration: u64) -> Directive {
        match self
            .directives
            .wait_for(self.node.incarnation(), iteration, PATIENCE)
            .unwrap()
        {
            Answer::Came(directive) => directive,
            other => panic!("iteration {iteration}: {other:?}"),
        }
    }

    fn end(self) {
        let domain = self.domain.clone();
        drop(self);
        domain.remove().unwrap();
        assert!(domain.leftovers().unwrap().is_empty());
    }
}

/// A scheduler on a thread of its own.
struct Serving {
    shutdown: Shutdown,
    thread: thread::JoinHandle<Result<()>>,
}

impl Serving {
    fn begin(learner: &Learner) -> Self {
        let shutdown = Shutdown::manual();
        let node = Node::join(&learner.domain, "scheduler", &shutdown).unwrap();
        let folder = learner.folder.clone();
        Self {
            shutdown,
            thread: thread::spawn(move || {
                let mut held = folder.lock("scheduler")?;
                serve(&folder, Schedule::new(config()).unwrap(), &node, &mut held)
            }),
        }
    }

    fn end(self) {
        self.shutdown.request();
        self.thread.join().unwrap().unwrap();
    }
}

/// Everything but the numbers that the publisher counts up, and the time. As text: NaN stands for what does not exist yet.
fn content(directive: Directive) -> String {
    format!(
        "{:?}",
        Directive {
            scheduler: 0,
            sequence: 0,
            decision_seconds: 0.0,
            ..directive
        }
    )
}

#[test]
fn reports_are_answered_and_a_restart_changes_no_answer() {
    let runs = tempfile::tempdir().unwrap();
    let mut learner = Learner::begin(runs.path());
    let me = learner.node.incarnation();

    let serving = Serving::begin(&learner);
    let heard = learner.iterate_until_answered(1);
    assert_eq!(content(learner.answer(heard)), content(expected(me, heard)));
    learner.iterate(heard + 1);
    assert_eq!(
        content(learner.answer(heard + 1)),
        content(expected(me, heard + 1))
    );
    serving.end();

    // Nobody listens: these reports are lost, their lines are not.
    (heard + 2..heard + 30).for_each(|iteration| learner.iterate(iteration));
    let serving = Serving::begin(&learner);
    let heard = learner.iterate_until_answered(heard + 30);
    let answer = learner.answer(heard);
    assert_eq!(content(answer), content(expected(me, heard)));
    assert_eq!(answer.phase, 2);
    serving.end();
    learner.end();
}

#[test]
fn damaged_metrics_end_the_scheduler_with_the_line() {
    let runs = tempfile::tempdir().unwrap();
    let learner = Learner::begin(runs.path());
    fs::write(
        learner.folder.metrics_path(),
        "{\"iteration\":1}\nnonsense\n{\"iteration\":3}\n",
    )
    .unwrap();
    let error = Serving::begin(&learner).thread.join().unwrap().unwrap_err();
    assert!(format!("{error:#}").contains("line 2"), "{error:#}");
    learner.end();
}

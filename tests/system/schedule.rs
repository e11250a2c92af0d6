//! The scheduler and the learner, each with the test in the other's part.

use std::time::Duration;

use ampco::{Granularity, Numbers, Report, Rule, RuleError, Schedule, ScheduleConfig, Weighting};
use protocol::{
    Answer, Directive, DirectivePublisher, DirectiveSubscriber, Domain, Node, RewardPublisher,
    RewardReport, RewardSubscriber, Shutdown,
};
use rustix::process::Signal;
use serde_json::json;

use crate::harness::{Alone, metrics, until};

/// Windows of four, so that they fill and empty within a few reports.
fn config() -> ScheduleConfig {
    ScheduleConfig {
        window: 4,
        ..ScheduleConfig::default()
    }
}

/// A climb of six reports, then a plateau.
fn style(iteration: u64) -> f64 {
    (0.1 * iteration as f64).min(0.6)
}

fn weighting(directive: &Directive) -> Result<Weighting, RuleError> {
    Weighting::try_from(Numbers {
        rule: directive.rule,
        first: directive.first,
        second: directive.second,
        granularity: directive.granularity,
    })
}

struct LearnersPart {
    node: Node,
    rewards: RewardPublisher,
    directives: DirectiveSubscriber,
}

impl LearnersPart {
    fn play(run: &Alone) -> Self {
        let domain = Domain::for_run(run.path()).expect("a domain");
        let node = Node::join(&domain, "learner", &Shutdown::manual()).expect("joined");
        Self {
            rewards: RewardPublisher::new(&node).expect("opened"),
            directives: DirectiveSubscriber::new(&node).expect("opened"),
            node,
        }
    }

    /// Logs and reports as a learner does, and waits for the answer.
    fn report(&mut self, run: &Alone, iteration: u64) -> Directive {
        let (style_mean, style_std, task_mean) = (style(iteration), 0.05, 0.5);
        run::Metrics::open(&run.path().join("metrics.jsonl"))
            .and_then(|mut metrics| {
                metrics.append(&json!({
                    "iteration": iteration, "style_mean": style_mean,
                    "style_std": style_std, "style_std_robots": 0.02, "task_mean": task_mean,
                }))
            })
            .expect("a line");
        let report = RewardReport {
            iteration,
            style_mean,
            style_std,
            style_std_robots: 0.02,
            task_mean,
            ..RewardReport::default()
        };
        // A scheduler that is still starting hears nothing; a learner would go on without it.
        let directive = until(&format!("the answer to report {iteration}"), || {
            self.rewards.send(report).expect("sent");
            let learner = self.node.incarnation();
            let patience = Duration::from_millis(500);
            match self.directives.wait_for(learner, iteration, patience) {
                Ok(Answer::Came(directive)) => Some(directive),
                Ok(_) => None,
                Err(error) => panic!("{error}"),
            }
        });
        assert_eq!(directive.iteration, iteration);
        directive
    }
}

#[test]
fn the_scheduler_switches_where_the_paper_says_also_across_its_own_death() {
    let run = Alone::new(1);
    run.set("scheduler.window", 4);
    let mut scheduler = run.start("ampco-scheduler", &[]);
    let mut learner = LearnersPart::play(&run);
    let mut reference = Schedule::new(config()).expect("valid");
    let mut switched = None;
    for iteration in 1..=20 {
        if iteration == 8 {
            scheduler.signal(Signal::KILL);
            scheduler.end();
            scheduler = run.start("ampco-scheduler", &[]);
        }
        let directive = learner.report(&run, iteration);
        let expected = reference
            .observe(Report {
                iteration,
                style_mean: style(iteration),
                style_std: 0.05,
                style_std_robots: Some(0.02),
                task_mean: 0.5,
                episode_share: Some(0.0),
            })
            .expect("finite");
        assert_eq!(
            directive.phase,
            expected.phase.number(),
            "iteration {iteration}"
        );
        assert_eq!(weighting(&directive), Ok(expected.weighting()));
        switched = switched.or(directive.switched_at());
    }
    // Report 7 still breaks out: 0.6 is above the 95th percentile of 0.3, 0.4, 0.5, 0.6, which lies
    // at 0.585. Report 8 does not, of 0.4, 0.5, 0.6, 0.6 it is 0.6. The last breakout leaves the
    // window of four indicators with report 11, and 0 of 4 is below 0.05.
    assert_eq!(switched, Some(11));
}

#[test]
fn the_learner_obeys_the_directive_that_answers_its_report() {
    let run = Alone::new(1);
    let domain = Domain::for_run(run.path()).expect("a domain");
    let node = Node::join(&domain, "scheduler", &Shutdown::manual()).expect("joined");
    let mut reports = RewardSubscriber::new(&node).expect("opened");
    let mut directives = DirectivePublisher::new(&node).expect("opened");
    let _learner = run.start("ampco-learner", &[]);
    let _actor = run.start("ampco-actor", &["--index", "0"]);

    // A fixed quarter of style until report 3; then bounds that every style reward is below, which
    // Eq. 12 answers with style alone.
    let rule = |iteration: u64| match iteration {
        0..3 => Rule::Fixed { style_weight: 0.25 },
        _ => Rule::Bounded {
            lower: 1.5,
            upper: 2.0,
        },
    };
    until("six reports", || {
        let arrival = reports.receive().expect("readable")?;
        let iteration = arrival.report.iteration;
        let numbers = Numbers::from(Weighting {
            rule: rule(iteration),
            granularity: Granularity::Sample,
        });
        let directive = Directive {
            learner: arrival.report.learner,
            iteration,
            phase: if iteration < 3 { 1 } else { 2 },
            switched_at: if iteration < 3 { u64::MAX } else { 3 },
            lower: f64::NAN,
            upper: f64::NAN,
            breakout_rate: f64::NAN,
            trend: f64::NAN,
            rule: numbers.rule,
            first: numbers.first,
            second: numbers.second,
            ..Directive::default()
        };
        directives.send(directive).expect("sent");
        (iteration >= 6).then_some(())
    });
    for line in metrics(run.path()).iter().skip(1) {
        let iteration = line["iteration"].as_u64().expect("a number");
        let (phase, style) = if iteration <= 3 { (1, 0.25) } else { (2, 1.0) };
        assert_eq!(line["phase"], phase, "iteration {iteration}");
        assert_eq!(line["style_weight"], style, "iteration {iteration}");
    }
}

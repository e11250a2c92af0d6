//! `ampco bench scheduler`: what a decision and a weighting cost, beside the paper's figures.
//!
//! The decision is taken in its steady state, both windows full. The paper gives its weighting per control step of all
//! 4096 environments, so ours is given per transition and per such step.

use std::hint::black_box;
use std::time::Instant;

use ampco::{Method, Report, Rule, Schedule, ScheduleConfig};
use anyhow::{Result, ensure};
use clap::Args;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;
use serde_json::{Value, json};

/// Environments of the paper (III-A).
const ENVIRONMENTS: usize = 4096;
/// "percentile-based breakout detection requires 166.95 ± 27.95 µs once per episode" (II-B).
const PAPER_DECISION_US: f64 = 166.95;
/// "Phase I adaptive weighting requires 2.22 ± 0.22 µs per timestep" (II-B).
const PAPER_PHASE_ONE_US: f64 = 2.22;
/// "Phase II constrained optimization requires 3.20 ± 0.75 µs per timestep" (II-B).
const PAPER_PHASE_TWO_US: f64 = 3.20;

/// Times the scheduler's mathematics.
#[derive(Debug, Args)]
pub(crate) struct SchedulerBench {
    /// Iterations that both sliding windows hold.
    #[arg(long, default_value_t = 1000)]
    window: usize,
    /// Decisions that are timed.
    #[arg(long, default_value_t = 100_000)]
    decisions: usize,
}

impl SchedulerBench {
    /// Microseconds per decision, nanoseconds per weight.
    pub(crate) fn run(&self) -> Result<Value> {
        ensure!(
            self.decisions > 0,
            "--decisions 0: nothing to time; use 1 or more"
        );
        let decisions = self.decisions()?;
        let phase_one_ns = weight_ns(Rule::Guided { ceiling: 1.0 });
        let phase_two_ns = weight_ns(Rule::Bounded {
            lower: 0.2,
            upper: 0.6,
        });
        let per_step = |ns: f64| ns * ENVIRONMENTS as f64 / 1000.0;
        Ok(json!({
            "decision_us": at_share(&decisions, 0.5),
            "decision_p99_us": at_share(&decisions, 0.99),
            "window": self.window,
            "decisions": self.decisions,
            "phase_one_ns_per_transition": phase_one_ns,
            "phase_two_ns_per_transition": phase_two_ns,
            "phase_one_us_per_step_of_4096": per_step(phase_one_ns),
            "phase_two_us_per_step_of_4096": per_step(phase_two_ns),
            "paper": {
                "decision_us": PAPER_DECISION_US,
                "phase_one_us_per_step": PAPER_PHASE_ONE_US,
                "phase_two_us_per_step": PAPER_PHASE_TWO_US,
            },
        }))
    }

    /// Microseconds of each decision, sorted; each holds the cost of reading the clock, some 20 ns.
    fn decisions(&self) -> Result<Vec<f64>> {
        // Fixed weights never switch, but are watched like every method: each decision costs the same.
        let method = Method::Amp { style_weight: 0.5 };
        let mut schedule = Schedule::new(ScheduleConfig {
            method,
            window: self.window,
            ..Default::default()
        })?;
        let mut rng = Pcg64::seed_from_u64(1);
        let mut report = |iteration| Report {
            iteration,
            style_mean: rng.random_range(0.2..0.4),
            style_std: 0.1,
            style_std_robots: None,
            task_mean: 0.5,
            episode_share: None,
        };
        // The windows are full after W + 2 reports.
        let filled = self.window as u64 + 2;
        for iteration in 1..=filled {
            schedule.observe(report(iteration))?;
        }
        let mut micros = Vec::with_capacity(self.decisions);
        for iteration in filled + 1..=filled + self.decisions as u64 {
            let report = black_box(report(iteration));
            let started = Instant::now();
            black_box(schedule.observe(report)?);
            micros.push(started.elapsed().as_secs_f64() * 1e6);
        }
        micros.sort_by(f64::total_cmp);
        Ok(micros)
    }
}

/// Nanoseconds to weigh and blend one transition (Eq. 1 included), the best of several rounds.
fn weight_ns(rule: Rule) -> f64 {
    const ROUNDS: usize = 200;
    let mut rng = Pcg64::seed_from_u64(2);
    let styles: Vec<f32> = (0..ENVIRONMENTS)
        .map(|_| rng.random_range(0.0..1.0))
        .collect();
    let tasks: Vec<f32> = (0..ENVIRONMENTS)
        .map(|_| rng.random_range(0.0..1.0))
        .collect();
    let mut rewards = vec![0.0_f32; ENVIRONMENTS];
    let round = || {
        let started = Instant::now();
        let rule = black_box(rule);
        rule.blend_each(&styles, &tasks, &mut rewards);
        black_box(&rewards);
        started.elapsed().as_secs_f64() * 1e9 / ENVIRONMENTS as f64
    };
    std::iter::repeat_with(round)
        .take(ROUNDS)
        .fold(f64::INFINITY, f64::min)
}

/// The value below which this share of the sorted ones lies.
fn at_share(sorted: &[f64], share: f64) -> f64 {
    sorted[((sorted.len() - 1) as f64 * share) as usize]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_figures_are_there_and_positive() {
        let figures = SchedulerBench {
            window: 20,
            decisions: 50,
        }
        .run()
        .unwrap();
        for key in [
            "decision_us",
            "decision_p99_us",
            "phase_one_ns_per_transition",
            "phase_two_ns_per_transition",
        ] {
            assert!(
                figures[key].as_f64().is_some_and(|value| value > 0.0),
                "{key}"
            );
        }
        assert_eq!(figures["paper"]["decision_us"], 166.95);
    }

    #[test]
    fn a_share_of_sorted_values() {
        let sorted: Vec<f64> = (0..=100).map(f64::from).collect();
        assert_eq!(
            (at_share(&sorted, 0.5), at_share(&sorted, 0.99)),
            (50.0, 99.0)
        );
    }

    #[test]
    fn timing_nothing_is_refused() {
        assert!(
            SchedulerBench {
                window: 20,
                decisions: 0
            }
            .run()
            .is_err()
        );
    }
}

//! The life of a schedule: phase I until the style reward converges, then phase II for good.

use crate::arming::{Arm, Arming};
use crate::breakout::{Detector, Observation};
use crate::pace::Pace;
use crate::weighting::guidance::Ceiling;
use crate::{
    AfterConvergence, Bounds, BoundsSource, Decision, Granularity, Phase, Report, ReportError,
    Rule, ScheduleConfig, Switch, Weighting,
};
use vocabulary::{Invalid, Section};

/// Everything that the decisions of a run depend on.
#[derive(Clone, Debug)]
pub struct Schedule {
    config: ScheduleConfig,
    phase: Phase,
    arming: Arming,
    pace: Pace,
    detector: Detector,
    style_ceiling: Ceiling,
    task_ceiling: Ceiling,
    newest: Option<u64>,
}

impl Schedule {
    /// A schedule that has seen nothing; refuses a configuration that the mathematics cannot take.
    pub fn new(config: ScheduleConfig) -> Result<Self, Invalid> {
        config.validate()?;
        Ok(Self {
            phase: Phase::One,
            arming: Arming::new(&config),
            pace: Pace::new(&config),
            detector: Detector::new(config.window, config.percentile),
            style_ceiling: Ceiling::of_style(config.ceiling),
            task_ceiling: Ceiling::of_task(config.ceiling),
            newest: None,
            config,
        })
    }

    /// The same, of a run whose ramps have all arrived at an iteration: `arm = "episodes_last"` waits for it.
    #[must_use]
    pub fn settling(self, iteration: u64) -> Self {
        Self {
            arming: self.arming.settling(iteration),
            ..self
        }
    }

    /// Takes one iteration's report into account and decides for the next iteration.
    ///
    /// Does not allocate. A refused report leaves the schedule as it was.
    pub fn observe(&mut self, report: Report) -> Result<Decision, ReportError> {
        report.check(self.newest)?;
        self.newest = Some(report.iteration);
        self.style_ceiling.observe(report.style_mean);
        self.task_ceiling.observe(report.task_mean);
        self.pace.observe(report.episode_share);
        let arm = self.arming.observe(&report, self.pace.held());
        if arm == Arm::Begins {
            self.detector.clear();
        }
        let seen = self.detector.append(report.style_mean);
        self.advance(arm, &seen, &report);
        Ok(self.decision(report.iteration))
    }

    /// What is in force, as the answer to this iteration: also when its report was refused.
    pub fn decision(&self, iteration: u64) -> Decision {
        Decision {
            iteration,
            phase: self.phase,
            rule: self.rule(),
            granularity: self.granularity(),
            breakout_rate: self.detector.breakout_rate(),
            threshold: self.detector.threshold(),
            trend: self.detector.rewards().slope(),
            held: self.pace.held(),
        }
    }

    /// Rule and granularity in force.
    pub fn weighting(&self) -> Weighting {
        Weighting {
            rule: self.rule(),
            granularity: self.granularity(),
        }
    }

    /// The rule in force: before any report, that of the first iteration.
    pub fn rule(&self) -> Rule {
        match (self.phase, self.config.method.after_convergence()) {
            (Phase::Two(switch), AfterConvergence::Bounded) => Rule::Bounded {
                lower: switch.bounds.lower() as f32,
                upper: switch.bounds.upper() as f32,
            },
            _ => self
                .config
                .method
                .first_rule(self.style_ceiling.value(), self.task_ceiling.value()),
        }
    }

    /// Whose rewards the rule in force is evaluated on: Eq. 12 takes "the discriminator mean reward", the others as
    /// configured.
    pub fn granularity(&self) -> Granularity {
        match self.rule() {
            Rule::Bounded { .. } => Granularity::Mean,
            _ => self.config.granularity,
        }
    }

    /// The phase in force.
    pub fn phase(&self) -> Phase {
        self.phase
    }

    /// Newest iteration observed.
    pub fn newest_iteration(&self) -> Option<u64> {
        self.newest
    }

    /// The configuration it was made from.
    pub fn config(&self) -> &ScheduleConfig {
        &self.config
    }

    /// Enters phase II when Algorithm 1 says so and the method has one. Nothing leads back.
    fn advance(&mut self, arm: Arm, seen: &Observation, report: &Report) {
        let looking = self.phase == Phase::One
            && self.config.method.after_convergence() != AfterConvergence::Nothing;
        if !(looking && seen.converged && arm != Arm::Waiting) {
            return;
        }
        let window = self.detector.rewards();
        let (mean, deviation) = match self.config.bounds_from {
            BoundsSource::Batch => (report.style_mean, report.style_std),
            BoundsSource::Robots => (
                report.style_mean,
                report.style_std_robots.unwrap_or(report.style_std),
            ),
            BoundsSource::Window => (
                window.mean().unwrap_or(report.style_mean),
                window.deviation().unwrap_or(report.style_std),
            ),
        };
        self.phase = Phase::Two(Switch {
            iteration: report.iteration,
            bounds: Bounds::around(mean, deviation, self.config.alpha),
            trend: window.slope().unwrap_or(0.0),
        });
    }
}

#[cfg(test)]
mod tests;

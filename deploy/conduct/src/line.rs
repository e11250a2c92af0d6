//! The line that follows a study: how far it is, what runs now, how long it takes yet.

use std::time::Duration;

use ::study::outlook::{Progress, seconds_left};
use terminal::console::BETWEEN;
use terminal::figures::clock;
use wording::count;

/// A program that runs now.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Going {
    pub(super) name: String,
    /// `None` while it is judged.
    pub(super) iteration: Option<(u64, u64)>,
    pub(super) samples_per_second: Option<f64>,
}

/// How the study stands.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Stand {
    pub(super) runs: Vec<Progress>,
    pub(super) failed: usize,
    pub(super) going: Vec<Going>,
    pub(super) parallel: usize,
}

impl Stand {
    pub(super) fn line(&self) -> String {
        let done = self.runs.iter().filter(|run| run.done >= run.of).count();
        let mut parts = vec![format!("{done} of {} done", count(self.runs.len(), "run"))];
        if self.failed > 0 {
            parts.push(format!("{} failed", self.failed));
        }
        parts.extend(self.going.iter().map(Going::words));
        if let Some(seconds) = seconds_left(&self.runs, self.parallel)
            && let Ok(left) = Duration::try_from_secs_f64(seconds)
        {
            parts.push(format!("{} left", clock(left)));
        }
        parts.join(BETWEEN)
    }
}

impl Going {
    fn words(&self) -> String {
        let Some((iteration, of)) = self.iteration else {
            return format!("judging {}", self.name);
        };
        let rate = self
            .samples_per_second
            .map_or_else(String::new, |rate| format!(" at {rate:.0} samples/s"));
        format!("{} {iteration}/{of}{rate}", self.name)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_says_how_far_the_study_is() {
        let run = |done, pace| Progress {
            done,
            of: 100,
            pace,
        };
        let stand = Stand {
            runs: vec![run(100, Some(0.5)), run(40, Some(0.5)), run(0, None)],
            failed: 1,
            going: vec![
                Going {
                    name: "ampco-seed2".into(),
                    iteration: Some((40, 100)),
                    samples_per_second: Some(20_000.4),
                },
                Going {
                    name: "ampco-seed1".into(),
                    iteration: None,
                    samples_per_second: None,
                },
            ],
            parallel: 1,
        };
        // 60 × 0.5 s and 100 × 0.5 s
        assert_eq!(
            stand.line(),
            "1 of 3 runs done · 1 failed · ampco-seed2 40/100 at 20000 samples/s · judging ampco-seed1 · 1:20 left"
        );
    }
}

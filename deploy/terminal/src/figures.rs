//! The figures of a run in words: read from a line of its metrics, said in one line.
//!
//! Separate because `train` and `status` say the same things.

use std::fmt::Write;
use std::time::Duration;

use serde::Deserialize;
use serde_json::Value;
use vocabulary::Cause;
use wording::count;

/// What is shown of one line of `metrics.jsonl`; whatever a line does not have is not shown.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(default)]
pub struct Figures {
    /// Iterations done.
    pub iteration: u64,
    /// Transitions learnt from since the run began.
    pub samples: u64,
    /// Mean style reward of the iteration.
    pub style_mean: Option<f64>,
    /// Mean task reward of the iteration.
    pub task_mean: Option<f64>,
    /// Mean weight of the style reward.
    pub style_weight: Option<f64>,
    /// Mean weight of the task reward.
    pub task_weight: Option<f64>,
    /// 1 or 2.
    pub phase: Option<u32>,
    /// Mean length of the episodes that ended, in steps.
    pub episode_length: Option<f64>,
    /// What the gait is, in words.
    pub gait: Option<String>,
    /// Actors whose rollouts the iteration is made of.
    pub actors: Option<u64>,
    /// How long it took.
    pub timing: Timing,
}

/// How long it took.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(default)]
pub struct Timing {
    /// Transitions per second, from iteration to iteration.
    pub samples_per_second: Option<f64>,
    /// Seconds of the whole iteration.
    pub iteration_seconds: Option<f64>,
    broadcast_seconds: f64,
    gather_seconds: f64,
    copy_seconds: f64,
    physics_seconds: f64,
    observation_seconds: f64,
    inference_seconds: f64,
    waiting_seconds: f64,
    idle_share: Option<f64>,
    learning: Learning,
}

/// The learner's part of it.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(default)]
struct Learning {
    score: f64,
    advantage: f64,
    ppo: f64,
    discriminator: f64,
}

impl Timing {
    /// Where an iteration's time went, in one line; `None` where a line does not say.
    pub fn split(&self) -> Option<String> {
        let whole = self.iteration_seconds.filter(|seconds| *seconds > 0.0)?;
        let ms = |seconds: f64| format!("{:.0}", 1e3 * seconds);
        let mut line = format!(
            "{} ms: actors {} physics, {} observation, {} inference, {} waiting; \
             learner {} gathering ({} copying), {} scoring, {} PPO, {} discriminator, {} broadcast",
            ms(whole),
            ms(self.physics_seconds),
            ms(self.observation_seconds),
            ms(self.inference_seconds),
            ms(self.waiting_seconds),
            ms(self.gather_seconds),
            ms(self.copy_seconds),
            ms(self.learning.score + self.learning.advantage),
            ms(self.learning.ppo),
            ms(self.learning.discriminator),
            ms(self.broadcast_seconds),
        );
        if let Some(idle) = self.idle_share {
            let _ = write!(line, "; cores {:.0} % idle", 100.0 * idle);
        }
        Some(line)
    }
}

/// What the figures do not say but one who watches wants to know.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Outlook {
    /// The iteration at which the run is complete; 0 = none.
    pub iterations: u64,
    /// Actors that are alive now.
    pub actors_alive: usize,
    /// Time until the end, where there is one.
    pub left: Option<Duration>,
}

impl Figures {
    /// From a line; one that is no record of ours has no figures.
    pub fn read(line: &Value) -> Option<Self> {
        line["iteration"].as_u64()?;
        serde_json::from_value(line.clone()).ok()
    }

    /// One line for one who watches.
    pub fn line(&self, outlook: &Outlook) -> String {
        let mut line = format!("iteration {}", self.iteration);
        if outlook.iterations > 0 {
            let _ = write!(line, "/{}", outlook.iterations);
        }
        if let Some(rate) = self.timing.samples_per_second {
            let _ = write!(line, " · {rate:.0} samples/s");
        }
        if let (Some(style), Some(task)) = (self.style_mean, self.task_mean) {
            let _ = write!(line, " · style {style:.3} task {task:.3}");
        }
        if let Some(length) = self.episode_length {
            let _ = write!(line, " · episode {length:.0} steps");
        }
        if let Some(gait) = &self.gait {
            let _ = write!(line, " · {gait}");
        }
        if let Some(phase) = self.phase {
            let _ = write!(line, " · phase {phase}");
        }
        if let (Some(style), Some(task)) = (self.style_weight, self.task_weight) {
            let _ = write!(line, " · weights {style:.2}/{task:.2}");
        }
        let _ = write!(line, " · {} alive", count(outlook.actors_alive, "actor"));
        if let Some(left) = outlook.left {
            let _ = write!(line, " · {} left", clock(left));
        }
        line
    }
}

/// How the episodes of an iteration ended, by cause; `None` where a line does not say.
pub fn ends(line: &Value) -> Option<String> {
    let count = |cause: Cause| {
        let count = line[format!("termination/{}", cause.name())].as_u64()?;
        Some(format!("{} {count}", cause.name().replace('_', "-")))
    };
    let counts: Option<Vec<String>> = Cause::ALL.into_iter().map(count).collect();
    Some(format!("episodes ended: {}", counts?.join(", ")))
}

/// What the terms of the task came to, by name; `None` where a line does not say.
pub fn terms(line: &Value) -> Option<String> {
    let told = line.as_object()?.iter().filter_map(|(key, value)| {
        let named = key.starts_with("reward/") || key.starts_with("gate/");
        let mean = value.as_f64().filter(|_| named)?;
        Some(format!("{key} {mean:.3}"))
    });
    let told: Vec<String> = told.collect();
    (!told.is_empty()).then(|| format!("task: {}", told.join(", ")))
}

/// The newest figures and the pace of the last iterations.
#[derive(Debug, Default)]
pub struct Pace {
    /// Those of the newest line.
    pub newest: Option<Figures>,
    /// Exponential mean of the seconds of an iteration, over about ten.
    seconds: Option<f64>,
}

impl Pace {
    /// Takes one more line of the metrics.
    pub fn take(&mut self, line: &Value) {
        let Some(figures) = Figures::read(line) else {
            return;
        };
        if let Some(seconds) = figures.timing.iteration_seconds {
            self.seconds = Some(
                self.seconds
                    .map_or(seconds, |mean| mean + 0.1 * (seconds - mean)),
            );
        }
        self.newest = Some(figures);
    }

    /// Seconds of an iteration, once one was seen.
    pub fn seconds(&self) -> Option<f64> {
        self.seconds
    }

    /// Time until iteration `last` at this pace; `None` when there is no such end or no pace yet.
    pub fn until(&self, last: u64) -> Option<Duration> {
        let done = self.newest.as_ref()?.iteration;
        let seconds = self.seconds? * last.checked_sub(done)? as f64;
        if last == 0 {
            None
        } else {
            Duration::try_from_secs_f64(seconds).ok()
        }
    }
}

/// "1:02:03" or "2:03".
pub fn clock(time: Duration) -> String {
    let seconds = time.as_secs();
    let (hours, minutes, seconds) = (seconds / 3600, seconds / 60 % 60, seconds % 60);
    if hours > 0 {
        format!("{hours}:{minutes:02}:{seconds:02}")
    } else {
        format!("{minutes}:{seconds:02}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    fn line(iteration: u64, seconds: f64) -> Value {
        json!({
            "iteration": iteration, "samples": 8192 * iteration, "style_mean": 0.31, "task_mean": 0.625,
            "style_weight": 0.9, "task_weight": 0.1, "phase": 1, "episode_length": null, "actors": 2,
            "gait": "hop: hips in phase (+0.94)", "kl": 0.02, "timing": { "iteration_seconds": seconds, "samples_per_second": 4096.4 },
        })
    }

    #[test]
    fn a_line_says_what_is_known_and_nothing_else() {
        let figures = Figures::read(&line(3, 2.0)).unwrap();
        let outlook = Outlook {
            iterations: 50,
            actors_alive: 1,
            left: Some(Duration::from_secs(94)),
        };
        assert_eq!(
            figures.line(&outlook),
            "iteration 3/50 · 4096 samples/s · style 0.310 task 0.625 · hop: hips in phase (+0.94) \
             · phase 1 · weights 0.90/0.10 · 1 actor alive · 1:34 left"
        );
        assert_eq!(Figures::read(&json!({ "style_mean": 1.0 })), None);
    }

    #[test]
    fn time_left_is_iterations_left_times_their_pace() {
        let mut pace = Pace::default();
        assert_eq!(pace.until(50), None);
        pace.take(&line(10, 2.0));
        assert_eq!(pace.until(50), Some(Duration::from_secs(80))); // 40 × 2 s
        assert_eq!(pace.until(0), None); // no limit
        pace.take(&line(11, 12.0));
        assert_eq!(pace.until(12), Some(Duration::from_secs(3))); // 2 + 0.1·(12 − 2)
    }

    #[test]
    fn clocks_show_hours_only_when_there_are_some() {
        assert_eq!(clock(Duration::from_secs(59)), "0:59");
        assert_eq!(clock(Duration::from_secs(3_723)), "1:02:03");
    }
}

//! How far an evaluation has come, told by the threads that do it.

use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};

use terminal::figures::clock;

use super::episodes::Conditions;

/// How far all threads together have come.
pub(super) struct Progress {
    started: Instant,
    /// Steps of robots, those of episodes that ended early included.
    done: AtomicU64,
    all: u64,
    steps: u32,
}

/// How far a unit has come; the steps that a unit need not do count when it ends.
pub(super) struct UnitProgress<'a> {
    progress: &'a Progress,
    left: AtomicU64,
}

impl Progress {
    pub(super) fn new(episodes: impl Iterator<Item = usize>, conditions: &Conditions) -> Self {
        Self {
            started: Instant::now(),
            done: AtomicU64::new(0),
            all: episodes.sum::<usize>() as u64 * u64::from(conditions.steps),
            steps: conditions.steps,
        }
    }

    pub(super) fn of_unit(&self, episodes: usize) -> UnitProgress<'_> {
        UnitProgress {
            progress: self,
            left: AtomicU64::new(episodes as u64 * u64::from(self.steps)),
        }
    }

    pub(super) fn line(&self) -> String {
        let share = self.done.load(Ordering::Relaxed) as f64 / self.all as f64;
        let gone = self.started.elapsed();
        let mut line = format!("evaluating · {:.0} %", 100.0 * share);
        if share > 0.0 && gone > Duration::from_secs(1) {
            let left = gone.mul_f64((1.0 - share) / share);
            line.push_str(&format!(" · {} left", clock(left)));
        }
        line
    }
}

impl UnitProgress<'_> {
    pub(super) fn step(&self, robots: usize) {
        self.left.fetch_sub(robots as u64, Ordering::Relaxed);
        self.progress
            .done
            .fetch_add(robots as u64, Ordering::Relaxed);
    }
}

impl Drop for UnitProgress<'_> {
    fn drop(&mut self) {
        let left = self.left.load(Ordering::Relaxed);
        self.progress.done.fetch_add(left, Ordering::Relaxed);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn episodes_that_end_early_count_as_done() {
        let conditions = Conditions {
            steps: 100,
            episodes: 4,
            seed: 1,
            traced: false,
        };
        let progress = Progress::new([2, 2].into_iter(), &conditions);
        let unit = progress.of_unit(2);
        unit.step(2);
        assert!(progress.line().contains("0 %")); // 2 of 400
        drop(unit);
        assert!(progress.line().contains("50 %"), "{}", progress.line());
    }
}

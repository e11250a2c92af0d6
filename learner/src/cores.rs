//! How idle the machine is, by the kernel's own account.
//!
//! Separate because it is the one thing in the learner that looks at the machine and not at the run:
//! a group that leaves cores idle waits for something, and the metrics should say so.

/// Counts of the kernel at the time of the last question.
#[derive(Debug, Default)]
pub(crate) struct Cores {
    before: Option<Ticks>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct Ticks {
    idle: u64,
    all: u64,
}

impl Cores {
    /// Share of all cores' time since the last question in which they did nothing; `None` at first,
    /// when no time has passed, and where `/proc/stat` cannot be read.
    pub(crate) fn idle_share(&mut self) -> Option<f64> {
        let now = std::fs::read_to_string("/proc/stat")
            .ok()
            .and_then(|text| Ticks::read(&text))?;
        let before = self.before.replace(now)?;
        let all = now.all.checked_sub(before.all).filter(|all| *all > 0)?;
        Some(now.idle.saturating_sub(before.idle) as f64 / all as f64)
    }
}

impl Ticks {
    /// The first line: `cpu user nice system idle iowait irq softirq steal …`; the guests' columns
    /// after it are in `user` and `nice` already.
    fn read(text: &str) -> Option<Self> {
        let line = text.lines().next()?.strip_prefix("cpu ")?;
        let counts: Vec<u64> = line
            .split_whitespace()
            .take(8)
            .map(str::parse)
            .collect::<Result<_, _>>()
            .ok()?;
        Some(Self {
            idle: counts.get(3)? + counts.get(4)?,
            all: counts.iter().sum(),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn idle_is_idle_and_waiting_for_disks() {
        let ticks = Ticks::read("cpu  10 1 5 70 10 1 2 1 9 9\ncpu0 1 2 3").unwrap();
        assert_eq!(ticks, Ticks { idle: 80, all: 100 });
        assert_eq!(Ticks::read("intr 5"), None);
        assert_eq!(Ticks::read("cpu  1 2 x"), None);
    }

    #[test]
    fn the_first_question_has_no_answer() {
        assert_eq!(Cores::default().idle_share(), None);
    }
}

//! How long a study still takes.

/// How far a run has come.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Progress {
    /// Iterations done.
    pub done: u64,
    /// Iterations to do in all.
    pub of: u64,
    /// Seconds of an iteration, where it is known.
    pub pace: Option<f64>,
}

/// Seconds until all are done, `parallel` at a time; `None` before any pace is known.
///
/// A run that has not begun is taken to go at the mean pace of the others.
pub fn seconds_left(runs: &[Progress], parallel: usize) -> Option<f64> {
    let known: Vec<f64> = runs.iter().filter_map(|run| run.pace).collect();
    if known.is_empty() {
        return None;
    }
    let mean = known.iter().sum::<f64>() / known.len() as f64;
    let left = runs
        .iter()
        .map(|run| run.of.saturating_sub(run.done) as f64 * run.pace.unwrap_or(mean));
    let waiting = runs.iter().filter(|run| run.done < run.of).count();
    Some(left.sum::<f64>() / parallel.clamp(1, waiting.max(1)) as f64)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn run(done: u64, pace: Option<f64>) -> Progress {
        Progress {
            done,
            of: 100,
            pace,
        }
    }

    #[test]
    fn what_has_not_begun_goes_at_the_mean_pace() {
        assert_eq!(seconds_left(&[run(0, None)], 1), None);
        // 50 × 1 s, none, and 100 × 1.5 s
        let runs = [run(50, Some(1.0)), run(100, Some(2.0)), run(0, None)];
        assert_eq!(seconds_left(&runs, 1), Some(200.0));
        assert_eq!(seconds_left(&runs, 2), Some(100.0));
        assert_eq!(seconds_left(&runs, 9), Some(100.0)); // only two are left
    }
}

//! All runs of a study together: what each method came to.

use crate::file::StudyFile;
use crate::judged::Judged;
use crate::matrix::Entry;
use crate::measure::Measured;
use crate::metric::Metric;
use crate::overhead::Benchmark;
use crate::record::Record;
use crate::statistics::Spread;
use crate::told::Told;

/// Which number of a metric: a column of the paper's tables.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Column {
    /// The greatest window after the first 1,000 timesteps.
    Peak,
    /// The last window.
    Last,
    /// Iteration of convergence.
    Convergence,
}

impl Column {
    /// Its name in files.
    pub fn key(self) -> &'static str {
        match self {
            Self::Peak => "peak",
            Self::Last => "final",
            Self::Convergence => "convergence_iteration",
        }
    }
}

/// What became of a run.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum State {
    /// It has done all its iterations.
    Finished,
    /// It can go on.
    Unfinished,
    /// It ended in an error, in these words.
    Failed(String),
    /// It was not begun.
    Missing,
}

/// One run with all that is known of it.
#[derive(Clone, Debug)]
pub struct Run {
    /// Name of its [`Entry`].
    pub entry: String,
    /// Its seed.
    pub seed: u64,
    /// Its name.
    pub name: String,
    /// Its record, or the folder of a run that has none yet, as the report links to it.
    pub link: String,
    /// What became of it.
    pub state: State,
    /// Iterations that it was to do.
    pub target: u64,
    /// What its lines of metrics come to.
    pub told: Told,
    /// The metrics over it, if it has finished and is long enough.
    pub measured: Option<Measured>,
    /// What it did without exploration noise.
    pub judged: Vec<Judged>,
}

impl Run {
    /// A run that has a record.
    pub fn of(record: Record, link: String) -> Self {
        Self {
            name: record.run_name(),
            entry: record.entry.name,
            seed: record.seed,
            link,
            state: State::Finished,
            target: record.target,
            told: record.told,
            measured: record.measured,
            judged: record.judgement.map_or_else(Vec::new, |found| found.rows),
        }
    }

    /// A number of the tables.
    pub fn value(&self, metric: Metric, column: Column) -> Option<f64> {
        let figures = self.measured.as_ref()?.figures(metric);
        match column {
            Column::Peak => figures.peak,
            Column::Last => Some(figures.last),
            Column::Convergence => figures.convergence.map(|iteration| iteration as f64),
        }
    }

    /// Iteration whose report brought Phase II.
    pub fn switched_at(&self) -> Option<u64> {
        self.told.switched_at
    }
}

/// A study with its runs.
#[derive(Clone, Debug)]
pub struct Results {
    /// What was asked for.
    pub file: StudyFile,
    /// A row of the tables each.
    pub entries: Vec<Entry>,
    /// In the order in which they were made.
    pub runs: Vec<Run>,
    /// The scheduler's mathematics alone on this machine, if it was timed.
    pub benchmark: Option<Benchmark>,
    /// What the runs have in common, as name and value: machine, sizes, engine.
    pub facts: Vec<(String, String)>,
}

impl Results {
    /// The runs of an entry that count in tables.
    pub fn measured<'a>(&'a self, entry: &'a str) -> impl Iterator<Item = &'a Run> {
        self.runs
            .iter()
            .filter(move |run| run.entry == entry && run.measured.is_some())
    }

    /// Whether the study asks for an entry.
    pub fn has(&self, entry: &str) -> bool {
        self.entries.iter().any(|known| known.name == entry)
    }

    /// The numbers of an entry, in the order of its runs.
    pub fn values(&self, entry: &str, metric: Metric, column: Column) -> Vec<f64> {
        self.measured(entry)
            .filter_map(|run| run.value(metric, column))
            .collect()
    }

    /// Mean and deviation of an entry over its seeds.
    pub fn spread(&self, entry: &str, metric: Metric, column: Column) -> Option<Spread> {
        Spread::of(&self.values(entry, metric, column))
    }

    /// Numbers of two entries whose seeds are the same.
    pub fn paired(&self, a: &str, b: &str, metric: Metric, column: Column) -> Vec<(f64, f64)> {
        self.measured(a)
            .filter_map(|run| {
                let other = self.measured(b).find(|other| other.seed == run.seed)?;
                Some((run.value(metric, column)?, other.value(metric, column)?))
            })
            .collect()
    }
}

/// Results for the tests of other files.
#[cfg(test)]
pub(crate) mod sample {
    use super::*;
    use crate::measure::Line;

    /// A study of constant runs: per entry a value per seed; energy is 1000 times it, style a tenth of it.
    pub(crate) fn results(values: &[(&str, &[f64])]) -> Results {
        let methods: Vec<String> = values.iter().map(|(name, _)| format!("'{name}'")).collect();
        let seeds: Vec<String> = (1..=values[0].1.len())
            .map(|seed| seed.to_string())
            .collect();
        let text = format!(
            "title = 'a <study>'\niterations = 200\nmethods = [{}]\nseeds = [{}]",
            methods.join(","),
            seeds.join(",")
        );
        let file = StudyFile::parse(&text).unwrap();
        let mut runs = Vec::new();
        for (name, values) in values {
            for (seed, value) in (1..).zip(*values) {
                runs.push(run(name, seed, *value));
            }
        }
        Results {
            entries: file.entries(),
            file,
            runs,
            benchmark: None,
            facts: vec![("control steps per iteration".into(), "500".into())],
        }
    }

    fn run(entry: &str, seed: u64, value: f64) -> Run {
        let line = |iteration: u64| Line {
            iteration,
            samples: 100 * iteration,
            phase: Some(if iteration > 120 { 2 } else { 1 }),
            rmse: Some(value),
            energy_j: Some(1000.0 * value),
            style_mean: Some(value / 10.0),
            switched_at: (iteration > 120 && entry.starts_with("ampco")).then_some(120),
            ..Line::default()
        };
        let lines: Vec<Line> = (1..=200).map(line).collect();
        Run {
            entry: entry.to_owned(),
            seed,
            name: format!("{entry}-seed{seed}"),
            link: format!("../records/{entry}-seed{seed}.json"),
            state: State::Finished,
            target: 200,
            measured: Measured::of(&lines, 500),
            told: Told::of(&lines, 200),
            judged: Vec::new(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn entries_are_paired_by_their_seeds() {
        let mut results =
            sample::results(&[("ampco", &[1.0, 2.0, 3.0]), ("amp-0.5", &[4.0, 5.0, 6.0])]);
        let spread = results
            .spread("ampco", Metric::Energy, Column::Last)
            .unwrap();
        assert_eq!((spread.mean, spread.deviation), (2000.0, 1000.0));
        // Seed 2 of the other has failed.
        results.runs[4].measured = None;
        let paired = results.paired("ampco", "amp-0.5", Metric::Energy, Column::Last);
        assert_eq!(paired, [(1000.0, 4000.0), (3000.0, 6000.0)]);
        assert_eq!(
            results.values("adamimic", Metric::Rmse, Column::Peak),
            [0.0; 0]
        );
    }
}

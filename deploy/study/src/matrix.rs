//! The runs that a study file asks for.

use toml::Value;

use crate::file::{Budget, StudyFile};

/// A row of the tables: a preset, perhaps with some values changed.
#[derive(Clone, Debug, PartialEq)]
pub struct Entry {
    /// Its name in runs and tables.
    pub name: String,
    /// The preset.
    pub preset: String,
    /// Dotted keys and what they are set to: those of a sweep.
    pub values: Vec<(String, Value)>,
}

/// One run: an entry with a seed.
#[derive(Clone, Debug, PartialEq)]
pub struct Cell {
    /// What is run.
    pub entry: Entry,
    /// With which seed.
    pub seed: u64,
}

impl Cell {
    /// The run's name: that of its folder.
    pub fn run_name(&self) -> String {
        format!("{}-seed{}", self.entry.name, self.seed)
    }
}

impl Budget {
    /// Iterations of so many transitions each.
    pub fn iterations(self, rows: u64) -> u64 {
        match self {
            Self::Iterations(iterations) => iterations,
            Self::Samples(samples) => samples.div_ceil(rows.max(1)),
        }
    }
}

impl StudyFile {
    /// The rows of the tables: the methods in their order, then every combination of the sweep.
    pub fn entries(&self) -> Vec<Entry> {
        let methods = self.methods.iter().map(|method| Entry {
            name: stem(method),
            preset: method.clone(),
            values: Vec::new(),
        });
        methods.chain(self.swept()).collect()
    }

    /// All runs, a seed of every entry before the next seed: a study that is cut short then has whole seeds.
    pub fn cells(&self) -> Vec<Cell> {
        let entries = self.entries();
        let with = |seed| {
            move |entry: &Entry| Cell {
                entry: entry.clone(),
                seed,
            }
        };
        self.seeds
            .iter()
            .flat_map(|seed| entries.iter().map(with(*seed)))
            .collect()
    }

    fn swept(&self) -> Vec<Entry> {
        let Some(sweep) = &self.sweep else {
            return Vec::new();
        };
        let mut entries = vec![Entry {
            name: stem(&sweep.preset),
            preset: sweep.preset.clone(),
            values: Vec::new(),
        }];
        for (key, values) in &sweep.values {
            let values = values.as_array().map_or(&[][..], Vec::as_slice);
            let short = key.rsplit('.').next().unwrap_or(key);
            entries = entries
                .iter()
                .flat_map(|entry| values.iter().map(move |value| (entry, value)))
                .map(|(entry, value)| {
                    let mut entry = entry.clone();
                    entry.name = plain(&format!("{}-{short}-{}", entry.name, words(value)));
                    entry.values.push((key.clone(), value.clone()));
                    entry
                })
                .collect();
        }
        entries
    }
}

/// A preset's name in a run's: without folders and ending.
fn stem(preset: &str) -> String {
    let name = preset.rsplit('/').next().unwrap_or(preset);
    plain(name.strip_suffix(".toml").unwrap_or(name))
}

/// Only what may stand in a run's name.
fn plain(name: &str) -> String {
    let kept = |c: char| {
        if c.is_ascii_alphanumeric() || matches!(c, '.' | '-' | '_') {
            c
        } else {
            '-'
        }
    };
    name.chars().map(kept).collect()
}

fn words(value: &Value) -> String {
    match value {
        Value::String(text) => text.clone(),
        other => other.to_string(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(text: &str) -> Vec<String> {
        let file = StudyFile::parse(&format!("title = 't'\niterations = 5\n{text}")).unwrap();
        file.cells().iter().map(Cell::run_name).collect()
    }

    #[test]
    fn every_method_has_a_seed_before_any_has_two() {
        assert_eq!(
            names("methods = ['ampco', 'my/own.toml']\nseeds = [1, 2]"),
            ["ampco-seed1", "own-seed1", "ampco-seed2", "own-seed2"]
        );
    }

    #[test]
    fn a_sweep_takes_every_combination() {
        let text = "seeds = [3]\n[sweep]\npreset = 'ampco'\n[sweep.values]\n\
                    'scheduler.alpha' = [0.9, 0.99]\n'scheduler.arm' = ['after_rise', 'window_full']";
        let names = names(text);
        assert_eq!(names.len(), 4);
        assert_eq!(names[0], "ampco-alpha-0.9-arm-after_rise-seed3");
        assert_eq!(names[3], "ampco-alpha-0.99-arm-window_full-seed3");
    }

    #[test]
    fn samples_are_rounded_up_to_whole_iterations() {
        assert_eq!(Budget::Samples(8193).iterations(8192), 2);
        assert_eq!(Budget::Samples(8192).iterations(8192), 1);
        assert_eq!(Budget::Iterations(7).iterations(8192), 7);
    }
}

//! The runs that a study file asks for.

use serde::{Deserialize, Serialize};
use toml::Value;

use crate::file::{Budget, StudyFile, Sweep};

/// A row of the tables: a preset, perhaps with some values changed.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Entry {
    /// Its name in runs and tables.
    pub name: String,
    /// The preset.
    pub preset: String,
    /// Dotted keys and what they are set to: those of a sweep.
    pub values: Vec<(String, Value)>,
}

/// One run: an entry with a seed.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
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

/// Runs that were asked for earlier and those that are asked for now, each once, a seed of all before the next seed.
pub fn together(earlier: &[Cell], now: &[Cell]) -> Vec<Cell> {
    let mut cells: Vec<Cell> = Vec::new();
    // Where both have a run, what is asked for now is what it is.
    for cell in earlier.iter().chain(now) {
        match cells
            .iter_mut()
            .find(|known| known.run_name() == cell.run_name())
        {
            Some(known) => known.clone_from(cell),
            None => cells.push(cell.clone()),
        }
    }
    cells.sort_by_key(|cell| cell.seed);
    cells
}

/// Runs in an order that does not depend on who made them when: by seed, then as the rows of a study file, then by name.
pub fn ordered(mut cells: Vec<Cell>, rows: &[Entry]) -> Vec<Cell> {
    let place = |cell: &Cell| {
        let row = rows.iter().position(|row| row.name == cell.entry.name);
        row.unwrap_or(rows.len())
    };
    cells.sort_by(|a, b| {
        let key = |cell: &Cell| (cell.seed, place(cell));
        key(a)
            .cmp(&key(b))
            .then_with(|| a.entry.name.cmp(&b.entry.name))
    });
    cells
}

/// The rows of the tables that some runs fill, each once, in the order in which they first come.
pub fn entries(cells: &[Cell]) -> Vec<Entry> {
    let mut entries: Vec<Entry> = Vec::new();
    for cell in cells {
        if !entries.iter().any(|entry| entry.name == cell.entry.name) {
            entries.push(cell.entry.clone());
        }
    }
    entries
}

/// The seeds that some runs have between them, ascending.
pub fn seeds(cells: &[Cell]) -> Vec<u64> {
    let seeds: std::collections::BTreeSet<u64> = cells.iter().map(|cell| cell.seed).collect();
    seeds.into_iter().collect()
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
        methods.chain(self.sweeps.iter().flat_map(swept)).collect()
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
}

/// Every combination of a sweep.
fn swept(sweep: &Sweep) -> Vec<Entry> {
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
    fn what_was_asked_for_earlier_stays_beside_what_is_asked_for_now() {
        let cells = |text: &str| {
            let text = format!("title = 't'\niterations = 5\n{text}");
            StudyFile::parse(&text).unwrap().cells()
        };
        let earlier = cells("methods = ['ampco', 'amp-0.5']\nseeds = [3, 1]");
        let now = cells("methods = ['ampco', 'adamimic']\nseeds = [1, 2]");
        let all = together(&earlier, &now);
        let names: Vec<String> = all.iter().map(Cell::run_name).collect();
        assert_eq!(
            names,
            [
                "ampco-seed1",
                "amp-0.5-seed1",
                "adamimic-seed1",
                "ampco-seed2",
                "adamimic-seed2",
                "ampco-seed3",
                "amp-0.5-seed3"
            ]
        );
        let rows: Vec<String> = entries(&all).into_iter().map(|entry| entry.name).collect();
        assert_eq!(rows, ["ampco", "amp-0.5", "adamimic"]);
        assert_eq!(seeds(&all), [1, 2, 3]);
        assert_eq!(together(&all, &all), all);
        // Through JSON and back, a sweep's values included.
        let swept = "methods = []\nseeds = [1]\n[[sweep]]\npreset = 'ampco'\n[sweep.values]\n\
                     'scheduler.alpha' = [0.9, 1.0]\n'scheduler.window' = [4]\n'fleet.physics' = ['batched']";
        let swept = cells(swept);
        let json = serde_json::to_string(&swept).unwrap();
        assert_eq!(serde_json::from_str::<Vec<Cell>>(&json).unwrap(), swept);
    }

    #[test]
    fn the_order_of_runs_is_that_of_the_file_whoever_made_them() {
        let text = "title = 't'\niterations = 5\nmethods = ['b', 'a']\nseeds = [2, 1]";
        let file = StudyFile::parse(text).unwrap();
        let mut cells = file.cells();
        cells.push(Cell {
            seed: 1,
            entry: Entry {
                name: "0".into(),
                ..cells[0].entry.clone()
            },
        });
        let names = |cells: Vec<Cell>| -> Vec<String> {
            ordered(cells, &file.entries())
                .iter()
                .map(Cell::run_name)
                .collect()
        };
        let expected = ["b-seed1", "a-seed1", "0-seed1", "b-seed2", "a-seed2"];
        assert_eq!(names(cells.clone()), expected);
        cells.reverse();
        assert_eq!(names(cells), expected);
    }

    #[test]
    fn a_sweep_takes_every_combination() {
        let text = "seeds = [3]\n[[sweep]]\npreset = 'ampco'\n[sweep.values]\n\
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

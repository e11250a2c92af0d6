//! What all runs of a study have in common, for the head of its report, and where they differ though they should not.

use std::collections::BTreeMap;

use ::study::Run;
use anyhow::Result;
use run::motion::{Print, differences};
use wording::count;

use crate::folder::StudyFolder;

/// What all runs have in common, for the head of the report.
pub(super) fn of(
    folder: &StudyFolder,
    runs: &[Run],
    otherwise: usize,
) -> Result<Vec<(String, String)>> {
    let mut facts = Vec::new();
    let mut tell = |name: &str, value: String| facts.push((name.to_owned(), value));
    if otherwise > 0 {
        tell(
            "judgements left out",
            format!(
                "of {}, found under another [evaluate] or before it went on; `ampco study run` with their seeds and \
                 methods finds them anew",
                count(otherwise, "run")
            ),
        );
    }
    if let Some(origin) = folder.json("origin.json")? {
        let text = |key: &str| origin[key].as_str().unwrap_or("unknown").to_owned();
        tell("command", text("command"));
        tell(
            "machine",
            format!(
                "{}, {}",
                text("processor"),
                count(origin["cores"].as_u64().unwrap_or(0), "core")
            ),
        );
    }
    for words in other_motion(folder, runs)? {
        tell("reference motion not the same", words);
    }
    let begun = runs.iter().find(|run| !run.records.is_empty());
    let Some(run) = begun else {
        return Ok(facts);
    };
    if let Some(made) = folder.run(&run.name)? {
        let config = made.config()?;
        let value = |key: &str| {
            let given = config.given(key);
            given.map_or_else(
                || "–".to_owned(),
                |value| value.to_string().replace('"', ""),
            )
        };
        tell(
            "robots, control steps per iteration",
            format!("{}, {}", value("fleet.environments"), value("fleet.steps")),
        );
        tell("iterations of a run", run.target.to_string());
        tell("physics in training", value("fleet.physics"));
        tell("scheduler's window, iterations", value("scheduler.window"));
        tell(
            "percentile, alpha",
            format!(
                "{}, {}",
                value("scheduler.percentile"),
                value("scheduler.alpha")
            ),
        );
        tell("kernel of Eq. 14", value("task.reward.track.kernel"));
    }
    let rates: Vec<f64> = runs
        .iter()
        .filter_map(|run| run.records.last())
        .filter(|newest| newest.timing.seconds > 0.0)
        .map(|newest| newest.samples as f64 / newest.timing.seconds)
        .collect();
    let middle = ::study::statistics::median(&rates);
    if middle.is_finite() {
        tell(
            "transitions per second, median of the runs",
            format!("{middle:.0}"),
        );
    }
    Ok(facts)
}

/// Which runs have learned from other motion files than the first run of their method: the mean over such is of neither.
fn other_motion(folder: &StudyFolder, runs: &[Run]) -> Result<Vec<String>> {
    let mut first: BTreeMap<&str, (&str, Vec<Print>)> = BTreeMap::new();
    let mut said = Vec::new();
    for run in runs {
        let Some(made) = folder.run(&run.name)? else {
            continue;
        };
        let newest = made.motion()?.pop();
        let files = newest.map_or_else(Vec::new, |learned| learned.files);
        match first.get(run.entry.as_str()) {
            None => {
                first.insert(&run.entry, (&run.name, files));
            }
            Some((name, expected)) => {
                let differences = differences(expected, &files);
                if let Some(one) = differences.first() {
                    said.push(format!("{} and {name}: {one}", run.name));
                }
            }
        }
    }
    Ok(said)
}

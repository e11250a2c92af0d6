//! `ampco status`: how a run is going, from its folder alone.

mod board;
mod draw;
mod watch;

use anyhow::Result;
use clap::Args;
use gate::known::Known;
use run::{Folder, RunConfig, metrics};
use serde_json::{Value, json};
use terminal::figures::{self, Figures, Outlook};
use terminal::{Place, console};
use wording::count;

/// Show how a run is going: its newest figures, who is alive, its checkpoints
#[derive(Debug, Args)]
pub(crate) struct Status {
    /// Name or folder of the run [default: the newest]
    run: Option<String>,
    #[command(flatten)]
    place: Place,
    /// Print one JSON object instead
    #[arg(long)]
    json: bool,
    /// Stay and draw the run as it goes, until q
    #[arg(long, conflicts_with = "json")]
    watch: bool,
}

impl Status {
    pub(crate) fn run(&self) -> Result<()> {
        let folder = self.place.find(self.run.as_deref())?;
        if self.watch {
            return watch::run(folder);
        }
        let status = status(&folder)?;
        let mut text = if self.json {
            status.to_string()
        } else {
            describe(&folder, &status)?
        };
        text.push('\n');
        console::print(&text)
    }
}

/// Everything, as data.
fn status(folder: &Folder) -> Result<Value> {
    let holders = folder.holders()?;
    let checkpoints = folder.checkpoints();
    let processes: serde_json::Map<String, Value> = holders
        .iter()
        .map(|(role, pid)| {
            (
                role.clone(),
                // An actor on another machine has none here: its holder says where it is.
                pid.parse()
                    .map_or_else(|_| json!(pid), |pid: u32| json!(pid)),
            )
        })
        .collect();
    let newest = metrics::newest(&folder.metrics_path())?.unwrap_or(Value::Null);
    let figure = |name: &str| newest.get(name).cloned().unwrap_or(Value::Null);
    Ok(json!({
        "run": folder.name(),
        "folder": folder.path(),
        "alive": processes.contains_key("learner") || processes.contains_key("supervisor"),
        "iteration": figure("iteration"),
        "samples": figure("samples"),
        "samples_per_second": newest["timing"]["samples_per_second"],
        "gait": figure("gait"),
        "phase": figure("phase"),
        "style_weight": figure("style_weight"),
        "task_weight": figure("task_weight"),
        "actors": processes.keys().filter(|role| role.starts_with("actor-")).count(),
        "processes": processes,
        "checkpoints": checkpoints.list(),
        "newest_checkpoint": checkpoints.list().last().map(|at| checkpoints.path(*at)),
        "hosts": Known::now(folder)?,
        "metrics": newest,
    }))
}

/// The same for a reader.
fn describe(folder: &Folder, status: &Value) -> Result<String> {
    let run: RunConfig = folder.config()?.section()?;
    let mut lines = vec![format!(
        "run {} · {} · {}",
        folder.name(),
        if status["alive"] == true {
            "running"
        } else {
            "not running"
        },
        folder.path().display()
    )];
    lines.push(match Figures::read(&status["metrics"]) {
        Some(figures) => figures.line(&Outlook {
            iterations: run.iterations,
            actors_alive: status["actors"].as_u64().unwrap_or(0) as usize,
            left: None,
        }),
        None => "no iteration yet".to_owned(),
    });
    lines.extend(figures::terms(&status["metrics"]));
    lines.extend(figures::ends(&status["metrics"]));
    lines.extend(saturation(&status["metrics"]));
    let timing = Figures::read(&status["metrics"]).and_then(|figures| figures.timing.split());
    lines.extend(timing.map(|split| format!("time: {split}")));
    let processes = status["processes"].as_object().into_iter().flatten();
    let processes: Vec<String> = processes
        .map(|(role, pid)| match pid.as_str() {
            Some(place) => format!("{role} {place}"),
            None => format!("{role} {pid}"),
        })
        .collect();
    if !processes.is_empty() {
        lines.push(format!("processes: {}", processes.join(", ")));
    }
    lines.extend(Known::now(folder)?.iter().flat_map(Known::lines));
    let checkpoints = status["checkpoints"].as_array().map_or(0, Vec::len);
    lines.push(match status["newest_checkpoint"].as_str() {
        Some(path) => format!("{}, the newest {path}", count(checkpoints, "checkpoint")),
        None => "no checkpoint".to_owned(),
    });
    Ok(lines.join("\n"))
}

/// In words that the discriminator tells every transition apart; `None` where it does not, or a line does not say.
fn saturation(line: &Value) -> Option<String> {
    let scores = amp::Scores {
        expert: line["expert_score"].as_f64()?,
        policy: line["policy_score"].as_f64()?,
        style_std: line["style_std"].as_f64()?,
    };
    scores.are_saturated().then(|| scores.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_run_is_described_from_its_folder() {
        let runs = tempfile::tempdir().unwrap();
        let folder = Folder::create(runs.path(), "walk").unwrap();
        std::fs::write(folder.config_path(), "[run]\niterations = 50").unwrap();
        let empty = status(&folder).unwrap();
        assert_eq!(empty["alive"], false);
        assert!(
            describe(&folder, &empty)
                .unwrap()
                .contains("no iteration yet")
        );

        let record = json!({ "iteration": 7, "samples": 70, "phase": 1, "gait": "walk", "timing": {}, "termination/fall": 2,
            "termination/time_out": 1, "termination/stray": 9, "termination/fault": 0,
            "reward/track": 0.25, "gate/upright": 0.99, "expert_score": 0.98, "policy_score": -0.97,
            "style_std": 0.02 });
        run::Metrics::open(&folder.metrics_path())
            .unwrap()
            .append(&record)
            .unwrap();
        folder
            .checkpoints()
            .write(5, "shape", &[("part", b"x")])
            .unwrap();
        let _learner = folder.lock("learner").unwrap();
        let (_, _actor) = folder.lock_free_actor(0).unwrap();

        let status = status(&folder).unwrap();
        assert_eq!(status["alive"], true);
        assert_eq!(status["iteration"], 7);
        assert_eq!(status["actors"], 1);
        assert_eq!(status["gait"], "walk");
        assert_eq!(status["processes"]["learner"], std::process::id());
        assert_eq!(status["checkpoints"], json!([5]));
        let words = describe(&folder, &status).unwrap();
        assert!(
            words.contains("iteration 7/50 · walk") && words.contains("1 actor alive"),
            "{words}"
        );
        assert!(words.contains("1 checkpoint, the newest"), "{words}");
        assert!(
            words.contains("task: gate/upright 0.990, reward/track 0.250"),
            "{words}"
        );
        assert!(
            words.contains("tells every transition apart (scores 0.98 and -0.97"),
            "{words}"
        );
        assert!(
            words.contains("episodes ended: fall 2, time-out 1, stray 9, fault 0"),
            "{words}"
        );
    }
}

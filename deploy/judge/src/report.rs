//! The report of an evaluation: as data, as Markdown, as text.
//!
//! It says nothing of when and how long, so that the same policy and seed give the same bytes.

use std::path::{Path, PathBuf};

use anyhow::{Context, Result};
use serde::Serialize;
use serde_json::Value;
use sim::{GroundConfig, Physics};
use wording::count;

use super::episodes::Conditions;
use super::outcome::Outcome;
use super::reference::Nearest;
use super::scenario::Scenario;
use super::subject::{Kept, Subject};
use super::table;
use super::tally::{CONTROL_HZ, Tally};

/// All of it.
#[derive(Debug, Serialize)]
pub(super) struct Report {
    pub(super) suite: &'static str,
    checkpoint: PathBuf,
    iteration: u64,
    /// The checkpoint whose discriminator scored the style; the policy's own if there is none.
    judge: Option<PathBuf>,
    /// The engine that moved the robots.
    physics: Physics,
    self_collision: bool,
    /// What the robots walked on, where the floor was not level.
    #[serde(skip_serializing_if = "Option::is_none")]
    ground: Option<GroundConfig>,
    seconds: f64,
    episodes: usize,
    seed: u64,
    scenarios: Vec<Row>,
}

/// A scenario with what came of it.
#[derive(Debug, Serialize)]
pub(super) struct Row {
    pub(super) name: String,
    /// The first command.
    command: [f32; 3],
    /// Held one after another for equal parts of the episode.
    commands: Vec<[f32; 3]>,
    condition: String,
    from_reference: bool,
    randomize: bool,
    push: Option<f32>,
    /// What stressed the robots: names and sizes, `none` where nothing did.
    #[serde(skip_serializing_if = "Option::is_none")]
    stress: Option<String>,
    /// The reference motion nearest to the command, where there is one command.
    pub(super) reference: Option<Nearest>,
    #[serde(flatten)]
    pub(super) outcome: Outcome,
}

impl Report {
    pub(super) fn of(
        subject: &Subject,
        judge: Option<&Kept>,
        suite: &'static str,
        scenarios: &[Scenario],
        tallies: &[Tally],
        conditions: &Conditions,
    ) -> Self {
        let row = |(scenario, tally): (&Scenario, &Tally)| {
            let command = scenario.commands[0];
            let single = scenario.commands.len() == 1;
            Row {
                name: scenario.name.clone(),
                command,
                commands: scenario.commands.clone(),
                condition: scenario.condition(),
                from_reference: scenario.from_reference,
                randomize: !scenario.rows.is_empty(),
                push: scenario.push,
                stress: scenario.stress.as_ref().map(|row| row.label.clone()),
                reference: single
                    .then(|| subject.reference().nearest(command))
                    .flatten(),
                outcome: tally.outcome(),
            }
        };
        Self {
            suite,
            checkpoint: subject.kept.path.clone(),
            iteration: subject.kept.iteration,
            judge: judge.map(|judge| judge.path.clone()),
            physics: subject.mechanics.physics,
            self_collision: subject.mechanics.self_collision,
            ground: subject.task.ground,
            seconds: f64::from(conditions.steps) / CONTROL_HZ,
            episodes: conditions.episodes,
            seed: conditions.seed,
            scenarios: scenarios.iter().zip(tallies).map(row).collect(),
        }
    }

    /// An object per scenario.
    pub(super) fn rows(&self) -> Result<Vec<Value>> {
        let rows = self.scenarios.iter().map(serde_json::to_value);
        Ok(rows.collect::<Result<_, _>>()?)
    }

    /// For a terminal.
    pub(super) fn text(&self) -> String {
        format!("{}\n\n{}", self.summary(), table::text(&self.scenarios))
    }

    /// Writes `report.json` and `report.md` into a folder, making it.
    pub(super) fn write(&self, folder: &Path) -> Result<()> {
        std::fs::create_dir_all(folder)
            .with_context(|| format!("making the folder {}", folder.display()))?;
        let json = serde_json::to_string_pretty(self)? + "\n";
        for (name, text) in [("report.json", json), ("report.md", self.markdown())] {
            let path = folder.join(name);
            run::replace_file(&path, text.as_bytes())
                .with_context(|| format!("writing {}", path.display()))?;
        }
        Ok(())
    }

    fn summary(&self) -> String {
        let judge = match &self.judge {
            Some(judge) => format!("judged by {}", judge.display()),
            None => "judged by its own discriminator".to_owned(),
        };
        let ground = self.ground.map_or_else(String::new, |ground| {
            format!(
                ", on slopes to {}° and bumps to {} m",
                ground.slope, ground.bumps
            )
        });
        let parts = if self.self_collision {
            ""
        } else {
            ", its parts passing through each other"
        };
        format!(
            "{}, iteration {}: {} of {} s each, seed {}, {}{parts}{ground}; style {judge}",
            self.checkpoint.display(),
            self.iteration,
            count(self.episodes, "episode"),
            self.seconds,
            self.seed,
            match self.physics {
                Physics::Rapier => "in rapier",
                Physics::Batched => "in the batched engine",
            }
        )
    }

    fn markdown(&self) -> String {
        let mut text = format!(
            "# Evaluation: {}\n\n{}.\n\n{}\n",
            self.suite,
            self.summary(),
            table::LEGEND
        );
        let mut rest = self.scenarios.as_slice();
        while let Some(first) = rest.first() {
            let same = rest
                .iter()
                .take_while(|row| row.condition == first.condition)
                .count();
            let (section, others) = rest.split_at(same);
            text.push_str(&format!(
                "\n## {}\n\n{}\n",
                capitalised(&first.condition),
                table::markdown(section)
            ));
            rest = others;
        }
        text.push_str("\n## Plots\n\n");
        for row in &self.scenarios {
            text.push_str(&format!("- [{0}](plots/{0}.svg)\n", row.name));
        }
        text
    }
}

fn capitalised(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or_else(String::new, |first| {
        first.to_uppercase().chain(letters).collect()
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use vocabulary::Counts;

    fn report() -> Report {
        let row = |name: &str, condition: &str| Row {
            name: name.to_owned(),
            command: [0.5, 0.0, 0.0],
            commands: vec![[0.5, 0.0, 0.0]],
            condition: condition.to_owned(),
            from_reference: false,
            randomize: false,
            push: None,
            stress: None,
            reference: None,
            outcome: Tally {
                episodes: 4,
                ends: Counts::of(&[1.0, 2.0, 2.0, 2.0]),
                steps: 100.0,
                squared_error: 4.0,
                ..Tally::default()
            }
            .outcome(),
        };
        Report {
            suite: "standard",
            checkpoint: "runs/walk/checkpoints/00000100".into(),
            iteration: 100,
            judge: None,
            physics: Physics::Batched,
            self_collision: true,
            ground: None,
            seconds: 20.0,
            episodes: 4,
            seed: 1,
            scenarios: vec![
                row("forward-0.5", "from standing"),
                row("forward-1.0", "from standing"),
                row("forward-0.5-pushed", "pushed"),
            ],
        }
    }

    #[test]
    fn ground_that_is_not_level_is_told() {
        let level = report();
        assert!(!level.summary().contains("slopes"), "{}", level.summary());
        assert!(
            serde_json::to_value(&level)
                .unwrap()
                .get("ground")
                .is_none()
        );
        let hilly = Report {
            ground: Some(GroundConfig {
                slope: 3.0,
                bumps: 0.01,
            }),
            ..level
        };
        let told = ", in the batched engine, on slopes to 3° and bumps to 0.01 m; style";
        assert!(hilly.summary().contains(told), "{}", hilly.summary());
        assert_eq!(
            serde_json::to_value(&hilly).unwrap()["ground"]["slope"],
            3.0
        );
    }

    #[test]
    fn a_report_is_written_with_a_table_per_condition() {
        let folder = tempfile::tempdir().unwrap();
        let inside = folder.path().join("evaluation/standard");
        report().write(&inside).unwrap();
        let markdown = std::fs::read_to_string(inside.join("report.md")).unwrap();
        assert_eq!(markdown.matches("\n## From standing\n").count(), 1);
        assert_eq!(markdown.matches("\n## Pushed\n").count(), 1);
        assert!(
            markdown.contains("| forward-0.5 | 75.0 | 0.200 |"),
            "{markdown}"
        );
        assert!(markdown.contains("(plots/forward-0.5-pushed.svg)"));
        let json = std::fs::read(inside.join("report.json")).unwrap();
        let json: Value = serde_json::from_slice(&json).unwrap();
        assert_eq!(json["scenarios"][0]["survival"], 0.75);
        assert_eq!(
            json["scenarios"][0]["ends"],
            serde_json::json!({ "fall": 1, "time_out": 3, "stray": 0, "fault": 0 })
        );
        assert!(markdown.contains("| 1 fall |"), "{markdown}");
        assert_eq!(json["physics"], "batched");
        assert!(markdown.contains("seed 1, in the batched engine; style"));
        assert_eq!(json["scenarios"][2]["condition"], "pushed");
    }

    #[test]
    fn columns_stand_under_each_other() {
        let text = report().text();
        let lines: Vec<&str> = text.lines().skip(2).collect();
        assert_eq!(lines.len(), 2 + 3);
        let column = |line: &str, what: &str| line.find(what).map(|at| at + what.len());
        assert_eq!(column(lines[0], "rmse"), column(lines[2], "0.200"));
        assert!(lines[4].starts_with("forward-0.5-pushed  "));
    }
}

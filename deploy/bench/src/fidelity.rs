//! `ampco bench fidelity`: how true the physics is, an engine beside another.
//!
//! Separate because speed without it is worth nothing. The computing is in `fidelity`; this file runs
//! it, prints the table, and carries cases and traces to and from another simulator by files.

use std::path::{Path, PathBuf};

use anyhow::{Context, Result, anyhow};
use fidelity::{Engine, Row, Traces, case, cases, markdown, measure, rows};
use serde_json::{Map, Value, json};
use terminal::console::say;
use terminal::file;

/// Errors of the physics engines in the same cases, as a Markdown table
#[derive(Debug, clap::Args)]
pub(crate) struct FidelityBench {
    /// Robots in the stress run of 20 s
    #[arg(long, default_value_t = 128)]
    robots: usize,
    /// Robots of it that rapier simulates too; each takes half a second
    #[arg(long, default_value_t = 16)]
    rapier_robots: usize,
    /// Write the robot and the cases to this file for another simulator, and end
    #[arg(long, value_name = "FILE")]
    cases: Option<PathBuf>,
    /// Judge the traces in this file, of another simulator, beside ours
    #[arg(long, value_name = "FILE")]
    beside: Option<PathBuf>,
}

impl FidelityBench {
    pub(crate) fn run(&self) -> Result<Value> {
        self.cases.as_deref().map(file::check_place).transpose()?;
        let (cases, stress) = (cases::all(), cases::stress(self.robots));
        if let Some(path) = &self.cases {
            let document = json!({
                "document": g1::mjcf::document(&g1::mjcf::Physics {
                    timestep: case::STEP,
                    gravity: 9.81,
                    friction: 1.0,
                    self_collision: true,
                }),
                "step": case::STEP,
                "hold": case::HOLD,
                "finer": measure::FINER,
                "cases": cases,
                "stress": stress,
            });
            file::write(path, document.to_string().as_bytes())?;
            return Ok(json!({ "cases": path }));
        }
        // Read first: a wrong file should not cost a minute.
        let beside = self.beside.as_deref().map(read).transpose()?;
        let few = &stress[..self.rapier_robots.min(stress.len())];
        let mut all = vec![
            Traces::of(Engine::Batched, "batched", &cases, &stress),
            Traces::of(Engine::Rapier, "rapier", &cases, few),
        ];
        all.extend(beside);
        let judged: Vec<(&str, Vec<Row>)> = all
            .iter()
            .map(|traces| (traces.engine.as_str(), rows(traces)))
            .collect();
        say(&markdown(&judged));
        let engines: Map<String, Value> = judged
            .iter()
            .map(|(engine, rows)| ((*engine).to_owned(), json!(rows)))
            .collect();
        Ok(Value::Object(engines))
    }
}

fn read(path: &Path) -> Result<Traces> {
    let text = std::fs::read(path).with_context(|| format!("reading {}", path.display()))?;
    serde_json::from_slice(&text).map_err(|error| {
        anyhow!(
            "{} holds no traces ({}); let deploy/fidelity.py write them",
            path.display(),
            wording::said(&error.to_string())
        )
    })
}

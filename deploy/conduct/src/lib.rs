//! `ampco study`: the paper's comparison, run and reported.
//!
//! What is computed and written is in the crate `study`; here is what touches files and processes.

#![forbid(unsafe_code)]

mod conduct;
mod folder;
mod group;
mod judgement;
mod line;
mod plan;
mod read;

use std::path::{Path, PathBuf};

use ::study::StudyFile;
use anyhow::{Context, Result};
use clap::{Args, Subcommand};
use run::Config;
use terminal::failure::usage;
use terminal::{console, file};

use folder::StudyFolder;

/// Compare methods over seeds: run a matrix of training runs, report it in the paper's tables
#[derive(Debug, Args)]
pub struct Study {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    Run(RunStudy),
    Report(ReportStudy),
}

/// Run all runs of a study file, or go on where it was stopped
///
/// Finished runs stay, half-finished ones go on from their last checkpoint, failed ones are tried again: give the
/// same command as often as you like. Ctrl-C stops in order. A run that fails does not end the others.
#[derive(Debug, Args)]
struct RunStudy {
    /// Study file, as in deploy/studies/
    file: PathBuf,
    /// Folder of the study [default: studies/<name of the file>]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Only these methods of the file
    #[arg(long, value_name = "NAME,…", value_delimiter = ',')]
    methods: Vec<String>,
    /// Other seeds than the file's; runs of earlier seeds stay in the study
    #[arg(long, value_name = "N,…", value_delimiter = ',')]
    seeds: Vec<u64>,
    /// Another length of each run, in iterations
    #[arg(long, value_name = "N", conflicts_with = "samples")]
    iterations: Option<u64>,
    /// Another length of each run, in transitions
    #[arg(long, value_name = "N")]
    samples: Option<u64>,
    /// Process groups at a time; 0 = as many as the cores allow
    #[arg(long, value_name = "N")]
    parallel: Option<usize>,
    /// Set one value of every run's configuration; may be repeated
    #[arg(long = "set", value_name = "KEY=VALUE")]
    set: Vec<String>,
    /// Only say what would be run
    #[arg(long)]
    dry_run: bool,
}

/// Write tables, figures and claims of a study: report.html, SVG and CSV
#[derive(Debug, Args)]
struct ReportStudy {
    /// Folder of the study
    folder: PathBuf,
    /// Where to write [default: report/ in the study's folder]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
}

impl Study {
    /// Runs the study, or reports it.
    pub fn run(&self) -> Result<()> {
        match &self.command {
            Command::Run(run) => run.run(),
            Command::Report(report) => report.run(),
        }
    }
}

impl RunStudy {
    fn run(&self) -> Result<()> {
        let file = self.file()?;
        let beside = self.file.parent().unwrap_or(Path::new("."));
        let planned = plan::plan(&file, beside, &self.file.display().to_string())?;
        if self.dry_run {
            return print(&plan::describe(&planned));
        }
        let folder = StudyFolder::create(&self.out())?;
        let _only_one = folder.lock()?;
        let origin = self.file.display().to_string();
        let all = plan::together(&file, &planned, &folder, beside, &origin)?;
        folder.begin(&file, &planned, &all)?;
        conduct::conduct(&folder, &file, planned)
    }

    /// The file with what the options change.
    fn file(&self) -> Result<StudyFile> {
        let path = self.file.display();
        let text =
            file::read_text(&self.file).context("a study file is needed, as in deploy/studies/")?;
        let mut file =
            StudyFile::parse(&text).map_err(|error| usage(format!("{path}: {error}")))?;
        if !self.methods.is_empty() {
            let known: Vec<&str> = file.methods.iter().map(String::as_str).collect();
            for method in &self.methods {
                if !known.contains(&method.as_str()) {
                    let remedy = wording::nearest::remedy(method, &known);
                    return Err(usage(format!(
                        "--methods {method}: not in {path}; {remedy}"
                    )));
                }
            }
            file.methods.clone_from(&self.methods);
        }
        if !self.seeds.is_empty() {
            file.seeds.clone_from(&self.seeds);
        }
        if self.iterations.is_some() || self.samples.is_some() {
            (file.iterations, file.samples) = (self.iterations, self.samples);
        }
        if let Some(parallel) = self.parallel {
            file.parallel = parallel;
        }
        let mut overrides = Config::parse(&toml::to_string(&file.overrides)?, &path.to_string())?;
        for assignment in &self.set {
            let key = assignment.split('=').next().unwrap_or_default().trim();
            if ["seed", "run.seed"].contains(&key) {
                return Err(usage(format!(
                    "--set {assignment}: every run of a study has its own seed; give --seeds"
                )));
            }
            overrides.set(assignment)?;
        }
        file.overrides =
            toml::from_str(&overrides.to_toml()).context("laying --set over the file")?;
        file.check()
            .map_err(|error| usage(format!("{path}: {error}")))?;
        Ok(file)
    }

    fn out(&self) -> PathBuf {
        let stem = self.file.file_stem().unwrap_or_default();
        self.out
            .clone()
            .unwrap_or_else(|| Path::new("studies").join(stem))
    }
}

impl ReportStudy {
    fn run(&self) -> Result<()> {
        let folder = StudyFolder::open(&self.folder)?;
        let (out, to_study) = match &self.out {
            Some(out) => (out.clone(), ""),
            None => (folder.path().join("report"), "../"),
        };
        let results = read::results(&folder, to_study)?;
        std::fs::create_dir_all(&out)
            .with_context(|| format!("making the folder {}", out.display()))?;
        for file in ::study::report::files(&results) {
            let path = out.join(file.name);
            run::replace_file(&path, file.text.as_bytes())
                .with_context(|| format!("writing {}", path.display()))?;
        }
        print(&out.join("report.html").display().to_string())
    }
}

fn print(text: &str) -> Result<()> {
    console::print(&format!("{text}\n"))
}

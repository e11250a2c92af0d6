//! `ampco study`: the paper's comparison, run and reported.
//!
//! What is computed and written is in the crate `study`; here is what touches files and processes.

#![forbid(unsafe_code)]

mod conduct;
mod folder;
mod group;
mod judgement;
mod line;
mod merge;
mod plan;
mod read;
mod records;

use std::ffi::OsStr;
use std::path::{Path, PathBuf};

use ::study::StudyFile;
use anyhow::{Context, Result};
use clap::{Args, Subcommand};
use run::Config;
use terminal::failure::usage;
use terminal::{console, file};

use folder::StudyFolder;
use judgement::Judging;
use records::Records;

const EXAMPLES: &str = "\
Examples, the first two on two machines:
  ampco study run deploy/studies/flagship.toml --jobs 2 --seeds 1,2,3
  ampco study run deploy/studies/flagship.toml --jobs 2 --seeds 4,5,6
  ampco study merge studies/all studies/flagship elsewhere/flagship
  ampco study report studies/all";

/// Compare methods over seeds: run a matrix of training runs, report it in the paper's tables
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub struct Study {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    Run(RunStudy),
    Report(ReportStudy),
    Merge(MergeStudies),
}

/// Run all runs of a study file, or go on where it was stopped
///
/// Finished runs stay, half-finished ones go on from their last checkpoint, failed ones are tried again: give the
/// same command as often as you like. Ctrl-C stops in order. A run that fails does not end the others.
///
/// A run that is finished and judged leaves a record in records/ of the study's folder. Who has its record does not make it
/// again: those beside the study file, in results/<name>/records/, are taken over, or those of --records. So several
/// machines share a study by --methods and --seeds, and `ampco study merge` brings their records together.
///
/// Two groups of one thread each (fleet.actors = 1, ppo.threads = 1) do more together than one of two threads: with
/// --jobs each is kept to its own cores, if there are enough.
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
    /// Process groups at a time, each kept to its own cores; 0 = as many as the cores allow
    #[arg(long, value_name = "N")]
    jobs: Option<usize>,
    /// Folder with records of finished runs [default: results/<name of the file>/records beside the file, if it is there]
    #[arg(long, value_name = "DIR")]
    records: Option<PathBuf>,
    /// Set one value of every run's configuration; may be repeated
    #[arg(long = "set", value_name = "KEY=VALUE")]
    set: Vec<String>,
    /// Only say what would be run
    #[arg(long)]
    dry_run: bool,
}

/// Write tables, figures and claims of a study: report.html, SVG and CSV
///
/// Records are all that it needs of finished runs, so a folder with study.toml and records/ is enough, and gives the same
/// bytes on every machine.
#[derive(Debug, Args)]
struct ReportStudy {
    /// Folder of the study
    folder: PathBuf,
    /// Where to write [default: report/ in the study's folder]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
}

/// Bring the records of one study together that were made in several places
///
/// Records of runs that were made with another configuration, and two that contradict each other, are refused, and
/// nothing is then written.
#[derive(Debug, Args)]
struct MergeStudies {
    /// Folder that they go into; made if it is not there
    into: PathBuf,
    /// Folders of the same study
    #[arg(required = true)]
    from: Vec<PathBuf>,
}

impl Study {
    /// Runs the study, reports it, or brings its parts together.
    pub fn run(&self) -> Result<()> {
        match &self.command {
            Command::Run(run) => run.run(),
            Command::Report(report) => report.run(),
            Command::Merge(merge) => merge.run(),
        }
    }
}

impl RunStudy {
    fn run(&self) -> Result<()> {
        let (whole, file) = self.file()?;
        let beside = self.file.parent().unwrap_or(Path::new("."));
        let planned = plan::plan(&file, beside, &self.file.display().to_string())?;
        if self.dry_run {
            return print(&plan::describe(&planned));
        }
        let judging = Judging::of(&file, beside)?;
        let known = self.known(beside)?;
        let folder = StudyFolder::create(&self.out())?;
        let _only_one = folder.lock()?;
        let origin = self.file.display().to_string();
        let all = plan::together(&file, &planned, &folder, beside, &origin)?;
        records::bring(&folder, &planned, known.as_ref(), judging.as_ref())?;
        folder.begin(&whole, &planned, &all)?;
        conduct::conduct(&folder, &file, planned, judging.as_ref())
    }

    /// Records that were made elsewhere.
    fn known(&self, beside: &Path) -> Result<Option<Records>> {
        if let Some(given) = &self.records {
            if !given.is_dir() {
                return Err(usage(format!(
                    "--records {}: there is no such folder; give one with records, as deploy/studies/results/<name>/records",
                    given.display()
                )));
            }
            return Ok(Some(Records::new(given.clone())));
        }
        let usual = beside
            .join("results")
            .join(self.stem())
            .join(records::FOLDER);
        Ok(usual.is_dir().then(|| Records::new(usual)))
    }

    /// The file with what the options change, and the part of it that is asked for.
    fn file(&self) -> Result<(StudyFile, StudyFile)> {
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
        }
        if self.iterations.is_some() || self.samples.is_some() {
            (file.iterations, file.samples) = (self.iterations, self.samples);
        }
        if let Some(jobs) = self.jobs {
            file.jobs = jobs;
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
        let mut asked = file.clone();
        if !self.methods.is_empty() {
            asked.methods.clone_from(&self.methods);
            // A sweep is no method by name.
            asked.sweeps.clear();
        }
        if !self.seeds.is_empty() {
            asked.seeds.clone_from(&self.seeds);
            let new = self.seeds.iter().filter(|seed| !file.seeds.contains(seed));
            let new: Vec<u64> = new.copied().collect();
            file.seeds.extend(new);
        }
        for file in [&file, &asked] {
            file.check()
                .map_err(|error| usage(format!("{path}: {error}")))?;
        }
        Ok((file, asked))
    }

    fn out(&self) -> PathBuf {
        self.out
            .clone()
            .unwrap_or_else(|| Path::new("studies").join(self.stem()))
    }

    fn stem(&self) -> &OsStr {
        self.file.file_stem().unwrap_or_default()
    }
}

impl ReportStudy {
    fn run(&self) -> Result<()> {
        let folder = StudyFolder::open(&self.folder)?;
        let out = self
            .out
            .clone()
            .unwrap_or_else(|| folder.path().join("report"));
        std::fs::create_dir_all(&out)
            .with_context(|| format!("making the folder {}", out.display()))?;
        let way = way(&out, folder.path())?;
        let results = read::results(&folder, |path| format!("{way}{path}"))?;
        for file in ::study::report::files(&results) {
            let path = out.join(file.name);
            run::replace_file(&path, file.text.as_bytes())
                .with_context(|| format!("writing {}", path.display()))?;
        }
        print(&out.join("report.html").display().to_string())
    }
}

impl MergeStudies {
    fn run(&self) -> Result<()> {
        let from: Result<Vec<StudyFolder>> = self
            .from
            .iter()
            .map(|path| StudyFolder::open(path))
            .collect();
        print(&merge::merge(&self.into, &from?)?)
    }
}

/// How a link leads from one folder to another: "../" as often as there are folders to leave, then those to enter.
fn way(from: &Path, to: &Path) -> Result<String> {
    let real = |path: &Path| {
        path.canonicalize()
            .with_context(|| format!("finding {}", path.display()))
    };
    let (from, to) = (real(from)?, real(to)?);
    let common = from
        .components()
        .zip(to.components())
        .take_while(|(a, b)| a == b)
        .count();
    let mut way = "../".repeat(from.components().count() - common);
    for name in to.components().skip(common) {
        way.push_str(&format!("{}/", name.as_os_str().to_string_lossy()));
    }
    Ok(way)
}

fn print(text: &str) -> Result<()> {
    console::print(&format!("{text}\n"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_link_leads_from_the_report_to_the_study() {
        let place = tempfile::tempdir().unwrap();
        let path = |name: &str| {
            let path = place.path().join(name);
            std::fs::create_dir_all(&path).unwrap();
            path
        };
        let study = path("studies/one");
        assert_eq!(way(&path("studies/one/report"), &study).unwrap(), "../");
        assert_eq!(way(&study, &study).unwrap(), "");
        assert_eq!(
            way(&path("else/where"), &study).unwrap(),
            "../../studies/one/"
        );
    }
}

//! The folder of a study: what lies where in it.
//!
//! | entry | what |
//! | --- | --- |
//! | `study.toml` | the study as it was last asked for, options included, with all its methods |
//! | `runs.json` | every run that was asked for so far |
//! | `origin.json` | the command and the machine |
//! | `configs/<run>.toml` | the configuration that each run is started with |
//! | `runs/<run>/` | the runs, like any other |
//! | `records/<run>.json` | what is kept of each finished run: all that a report needs |
//! | `logs/<run>.log` | what `ampco train` and `ampco evaluate` said |
//! | `failed/<run>.txt` | why a run failed; gone once it has succeeded |
//! | `overhead.json` | what `ampco bench scheduler` found at the end |
//! | `report/` | the report |

use std::path::{Path, PathBuf};

use ::study::{Cell, StudyFile};
use anyhow::{Context, Result, anyhow};
use run::{Folder, FolderError, Lock};
use serde::de::DeserializeOwned;
use serde_json::{Value, json};
use terminal::failure::usage;
use terminal::file;

use super::plan::Planned;
use super::records::{self, Records};

/// Name of the file that lists the runs.
const RUNS: &str = "runs.json";

/// The folder.
#[derive(Debug)]
pub(super) struct StudyFolder {
    path: PathBuf,
}

impl StudyFolder {
    /// Makes it with its inner folders; what is there stays.
    pub(super) fn create(path: &Path) -> Result<Self> {
        for inner in ["configs", "runs", "logs", "failed", records::FOLDER] {
            let inner = path.join(inner);
            std::fs::create_dir_all(&inner)
                .with_context(|| format!("making the folder {}", inner.display()))?;
        }
        Self::absolute(path)
    }

    /// One that is there.
    pub(super) fn open(path: &Path) -> Result<Self> {
        if !path.join("study.toml").is_file() {
            return Err(usage(format!(
                "{} holds no study.toml; give the folder that `ampco study run` made",
                path.display()
            )));
        }
        Self::absolute(path)
    }

    fn absolute(path: &Path) -> Result<Self> {
        let absolute = std::path::absolute(path);
        Ok(Self {
            path: absolute.with_context(|| format!("finding {}", path.display()))?,
        })
    }

    pub(super) fn path(&self) -> &Path {
        &self.path
    }

    /// Refuses a second `ampco study run` in the same folder.
    pub(super) fn lock(&self) -> Result<Lock> {
        match Folder::open(&self.path)?.lock("study") {
            Err(FolderError::Held { pid, .. }) => Err(anyhow!(
                "process {pid} runs a study in {} already; wait for it, or use another --out",
                self.path.display()
            )),
            locked => Ok(locked?),
        }
    }

    pub(super) fn file(&self) -> Result<StudyFile> {
        let path = self.path.join("study.toml");
        let text = file::read_text(&path)?;
        StudyFile::parse(&text).map_err(|error| usage(format!("{}: {error}", path.display())))
    }

    /// Every run that was asked for so far; in a folder of an older program, those that were asked for last.
    pub(super) fn cells(&self) -> Result<Vec<Cell>> {
        match self.json(RUNS)? {
            Some(cells) => serde_json::from_value(cells)
                .with_context(|| format!("reading {}", self.path.join(RUNS).display())),
            None if self.path.join("study.toml").is_file() => Ok(self.file()?.cells()),
            None => Ok(Vec::new()),
        }
    }

    /// Writes down what is asked for: the file, the configuration of every run of it, and all runs that belong to the
    /// study by now.
    pub(super) fn begin(&self, file: &StudyFile, planned: &[Planned], all: &[Cell]) -> Result<()> {
        self.write(RUNS, &format!("{:#}\n", json!(all)))?;
        self.write("study.toml", &file.to_toml())?;
        self.write("origin.json", &format!("{:#}\n", origin()))?;
        for run in planned {
            let words = format!(
                "Run {} of the study; written by `ampco study run`.",
                run.name
            );
            run.config.write(&self.config(&run.name), &words)?;
        }
        Ok(())
    }

    pub(super) fn write(&self, name: &str, text: &str) -> Result<()> {
        let path = self.path.join(name);
        run::replace_file(&path, text.as_bytes())
            .with_context(|| format!("writing {}", path.display()))
    }

    /// JSON of a file in it, if it is there.
    pub(super) fn json(&self, name: &str) -> Result<Option<Value>> {
        let path = self.path.join(name);
        if !path.is_file() {
            return Ok(None);
        }
        let bytes = std::fs::read(&path).with_context(|| format!("reading {}", path.display()))?;
        Ok(Some(parse_json(&bytes, &path)?))
    }

    pub(super) fn records(&self) -> Records {
        Records::new(self.path.join(records::FOLDER))
    }

    pub(super) fn runs(&self) -> PathBuf {
        self.path.join("runs")
    }

    /// A run's folder, if it was begun.
    pub(super) fn run(&self, name: &str) -> Result<Option<Folder>> {
        let path = self.runs().join(name);
        let begun = path.join("config.toml").is_file();
        Ok(begun.then(|| Folder::open(&path)).transpose()?)
    }

    pub(super) fn config(&self, name: &str) -> PathBuf {
        self.path.join("configs").join(format!("{name}.toml"))
    }

    pub(super) fn log(&self, name: &str) -> PathBuf {
        self.path.join("logs").join(format!("{name}.log"))
    }

    fn failure_path(&self, name: &str) -> PathBuf {
        self.path.join("failed").join(format!("{name}.txt"))
    }

    /// Why a run failed, if it did.
    pub(super) fn failure(&self, name: &str) -> Option<String> {
        let words = std::fs::read_to_string(self.failure_path(name)).ok()?;
        Some(words.trim_end().to_owned())
    }

    /// Notes that a run failed, or that it has not.
    pub(super) fn note(&self, name: &str, failure: Option<&str>) -> Result<()> {
        let path = self.failure_path(name);
        match failure {
            Some(words) => run::replace_file(&path, format!("{words}\n").as_bytes()),
            None if path.exists() => std::fs::remove_file(&path),
            None => Ok(()),
        }
        .with_context(|| format!("noting the outcome of {name} in {}", path.display()))
    }
}

/// JSON, or an error that names the file and shows no more of it than a line.
fn parse_json<T: DeserializeOwned>(bytes: &[u8], path: &Path) -> Result<T> {
    serde_json::from_slice(bytes).map_err(|error| {
        let said = wording::said(&error.to_string());
        anyhow!(
            "{} cannot be read: {said}; move it away to have it made anew",
            path.display()
        )
    })
}

/// The command as it was typed, and the machine.
fn origin() -> Value {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let facts = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let model = facts
        .lines()
        .find_map(|line| line.strip_prefix("model name")?.split_once(": "))
        .map_or("unknown", |(_, model)| model);
    json!({
        "command": format!("ampco {}", arguments.join(" ")),
        "version": env!("CARGO_PKG_VERSION"),
        "processor": model,
        "cores": std::thread::available_parallelism().map_or(1, usize::from),
    })
}

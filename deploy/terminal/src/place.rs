//! Where runs are, and which one is meant.

use std::path::{Path, PathBuf};
use std::time::SystemTime;

use anyhow::Result;
use run::Folder;

use crate::failure::usage;

/// The folder of runs.
#[derive(Debug, Clone, clap::Args)]
pub struct Place {
    /// Folder in which the runs are
    #[arg(long, value_name = "DIR", default_value = "runs")]
    pub runs_dir: PathBuf,
}

impl Place {
    /// The run that is meant: a folder's path, a name in the folder of runs, or the newest.
    pub fn find(&self, run: Option<&str>) -> Result<Folder> {
        match run {
            Some(path) if is_path(Path::new(path)) => open(Path::new(path)),
            Some(name) => Ok(Folder::find(&self.runs_dir, name)?),
            None => self.newest(),
        }
    }

    /// The run that was written to last.
    fn newest(&self) -> Result<Folder> {
        let names = run::folder::list(&self.runs_dir);
        let newest = names.into_iter().max_by_key(|name| {
            let path = self.runs_dir.join(name);
            // By name when the times are the same, so that the answer never depends on luck.
            (written(&path), name.clone())
        });
        let Some(name) = newest else {
            let place = self.runs_dir.display();
            return Err(usage(format!(
                "there are no runs in {place}; start one with `ampco train`, or name the folder \
                 with --runs-dir"
            )));
        };
        Ok(Folder::find(&self.runs_dir, &name)?)
    }

    /// The first of `<stem>-1`, `<stem>-2`, … that is not taken.
    pub fn free_name(&self, stem: &str) -> String {
        let free = |number: &u32| !self.runs_dir.join(format!("{stem}-{number}")).exists();
        let number = (1..).find(free).expect("fewer runs than numbers");
        format!("{stem}-{number}")
    }
}

/// Whether a folder is meant and not a run's name.
fn is_path(given: &Path) -> bool {
    given.components().count() > 1 || given == Path::new(".")
}

/// The run or the shipped policy in a folder.
fn open(path: &Path) -> Result<Folder> {
    if path.join("config.toml").is_file() {
        return Ok(Folder::open(path)?);
    }
    let why = if path.is_dir() {
        "has no config.toml, so it is neither a run nor a shipped policy"
    } else {
        "is not a folder"
    };
    Err(usage(format!(
        "{} {why}; give a run's name, or the folder of a run or of a shipped policy",
        path.display()
    )))
}

fn written(run: &Path) -> Option<SystemTime> {
    ["metrics.jsonl", "config.toml"]
        .iter()
        .filter_map(|file| std::fs::metadata(run.join(file)).ok()?.modified().ok())
        .max()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn place() -> (tempfile::TempDir, Place) {
        let folder = tempfile::tempdir().unwrap();
        let runs_dir = folder.path().to_owned();
        (folder, Place { runs_dir })
    }

    fn make(place: &Place, name: &str, seconds: u64) {
        let folder = Folder::create(&place.runs_dir, name).unwrap();
        std::fs::write(folder.config_path(), "").unwrap();
        let file = std::fs::File::open(folder.config_path()).unwrap();
        let time = SystemTime::UNIX_EPOCH + std::time::Duration::from_secs(seconds);
        file.set_modified(time).unwrap();
    }

    #[test]
    fn without_a_name_the_newest_is_meant() {
        let (_folder, place) = place();
        assert!(
            place
                .find(None)
                .unwrap_err()
                .to_string()
                .contains("no runs")
        );
        make(&place, "old", 1_000);
        make(&place, "new", 3_000);
        make(&place, "middle", 2_000);
        assert_eq!(place.find(None).unwrap().name(), "new");
        assert_eq!(place.find(Some("old")).unwrap().name(), "old");
        let path = place.runs_dir.join("middle");
        assert_eq!(
            place.find(Some(path.to_str().unwrap())).unwrap().name(),
            "middle"
        );
    }

    #[test]
    fn a_path_without_a_run_is_refused_as_a_path() {
        let (_folder, place) = place();
        let refused = |path: PathBuf| {
            let refusal = place.find(Some(path.to_str().unwrap())).unwrap_err();
            refusal.to_string()
        };
        let missing = refused(place.runs_dir.join("athlet"));
        assert!(missing.contains("athlet is not a folder"), "{missing}");
        std::fs::create_dir(place.runs_dir.join("empty")).unwrap();
        let empty = refused(place.runs_dir.join("empty"));
        assert!(empty.contains("empty has no config.toml"), "{empty}");
    }

    #[test]
    fn names_are_numbered_from_one_past_those_taken() {
        let (_folder, place) = place();
        assert_eq!(place.free_name("smoke"), "smoke-1");
        make(&place, "smoke-1", 1_000);
        assert_eq!(place.free_name("smoke"), "smoke-2");
    }
}

//! Where clips come from: the built-in gait, a file, or a folder of files.

use crate::clip::Clip;
use crate::config::{ClipConfig, Gait, wrong};
use crate::error::MotionError;
use crate::quality::{Account, Defect, Quality, all, of_source};
use crate::{gait, import};
use std::path::{Path, PathBuf};

/// A clip of a configuration, as it comes: not mirrored.
#[derive(Clone, Debug, PartialEq)]
pub struct Reference {
    /// The clip, with its share of the weight.
    pub clip: Clip,
    /// What is known of how it came about; `None` of a built-in gait.
    pub account: Option<Account>,
    /// The defects that its source had and import mended.
    pub source: Vec<Defect>,
}

impl Reference {
    /// What is wrong with a clip from a file. Built-in gaits have no defects: tests go through all of them, and looking
    /// would only cost time at every start.
    pub fn defects(&self) -> Vec<Defect> {
        self.account.as_ref().map_or_else(Vec::new, |account| {
            all(&self.clip, &Quality::of(&self.clip), account, &self.source)
        })
    }
}

/// The clips of a source; those of a folder share its weight by their duration.
pub(super) fn load_clips(
    source: &ClipConfig,
    index: usize,
    base_dir: &Path,
) -> Result<Vec<Reference>, MotionError> {
    let options = import::Options {
        fps: source.fps,
        quaternion: source.quaternion,
        ground: source.ground.unwrap_or(true),
        ..import::Options::default()
    };
    let mut clips = match (source.gait, &source.file, &source.folder) {
        (Some(gait), ..) => {
            let velocity = source.velocity();
            let made = match gait {
                Gait::Stand => Some(gait::stand()),
                Gait::Walk => gait::walk(velocity),
                Gait::Run => gait::run(velocity),
                Gait::Start => gait::start(velocity),
                Gait::Stop => gait::stop(velocity),
            };
            let impossible =
                "no pose of the legs makes this gait; lower lateral, yaw_rate or speed";
            let none =
                || MotionError::Config(wrong(format!("clips[{index}]"), velocity, impossible));
            let clip = made.ok_or_else(none)?;
            vec![Reference {
                clip,
                account: None,
                source: Vec::new(),
            }]
        }
        (None, Some(file), _) => vec![read(&base_dir.join(file), &options)?],
        (None, None, Some(folder)) => tables(&base_dir.join(folder))?
            .iter()
            .map(|path| read(path, &options))
            .collect::<Result<_, _>>()?,
        (None, None, None) => {
            let remedy = "give gait, file or folder";
            let invalid = wrong(format!("clips[{index}]"), "{}", remedy);
            return Err(MotionError::Config(invalid));
        }
    };
    let seconds: f64 = clips.iter().map(|reference| reference.clip.seconds()).sum();
    for Reference { clip, .. } in &mut clips {
        clip.weight = source.weight * (clip.seconds() / seconds) as f32;
    }
    Ok(clips)
}

/// The files that a source is read from, the skeletons beside `.amc` files included.
pub(super) fn files(source: &ClipConfig, base_dir: &Path) -> Result<Vec<PathBuf>, MotionError> {
    let mut files = match (&source.file, &source.folder) {
        (Some(file), _) => vec![base_dir.join(file)],
        (None, Some(folder)) => tables(&base_dir.join(folder))?,
        (None, None) => Vec::new(),
    };
    if files.iter().any(|file| has_extension(file, "amc")) {
        // Which of them is meant is the importer's business; a name that it takes for a file is in its folder.
        let beside = files[0].parent().map(std::fs::read_dir);
        let beside = beside.and_then(Result::ok).into_iter().flatten().flatten();
        files.extend(
            beside
                .map(|entry| entry.path())
                .filter(|path| has_extension(path, "asf")),
        );
        files.sort();
    }
    Ok(files)
}

fn has_extension(path: &Path, expected: &str) -> bool {
    path.extension()
        .is_some_and(|extension| extension.eq_ignore_ascii_case(expected))
}

fn read(file: &Path, options: &import::Options) -> Result<Reference, MotionError> {
    let imported = import::import(file, options)?;
    Ok(Reference {
        account: Some(Account::of(&imported, file)),
        source: of_source(&imported, file),
        clip: imported.clip,
    })
}

/// The tables in a folder, sorted by name: the order must not depend on the file system.
fn tables(folder: &Path) -> Result<Vec<PathBuf>, MotionError> {
    let read = |source| MotionError::Read {
        path: folder.into(),
        source,
    };
    let mut paths = Vec::new();
    for entry in std::fs::read_dir(folder).map_err(read)? {
        let path = entry.map_err(read)?.path();
        if path.extension().is_some_and(|extension| extension == "csv") {
            paths.push(path);
        }
    }
    if paths.is_empty() {
        return Err(MotionError::File {
            path: folder.into(),
            problem: "holds no .csv file".into(),
            remedy: "fill it with ampco motions import FILE… --out FOLDER".into(),
        });
    }
    paths.sort();
    Ok(paths)
}

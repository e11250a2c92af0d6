//! Which files are meant, how they are read, many at once, and where clips are written.
//!
//! Separate because every subcommand asks for files in the same words.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc;
use std::thread;
use std::time::Instant;

use anyhow::{Context, Result};
use clap::Args;
use motion::import::{self, Format, Imported, Options};
use motion::{Clip, MotionError, QuaternionOrder};
use wording::count;

use crate::console::{Console, say};
use crate::failure::usage;

/// What motion files end in: a folder is searched for these.
const EXTENSIONS: [&str; 8] = ["npz", "bvh", "amc", "csv", "pkl", "npy", "motion", "pt"];
/// What clips of frames end in, and much else: these are looked into.
const TEXTS: [&str; 2] = ["json", "txt"];

/// Files and what they do not say themselves.
#[derive(Debug, Args)]
pub(super) struct Sources {
    /// Motion files, or folders that are searched for them
    #[arg(required = true, value_name = "FILE")]
    paths: Vec<PathBuf>,
    /// Format, instead of the one that the content tells
    #[arg(long)]
    format: Option<Format>,
    /// Frames per second of files that do not say them; a file that says others is refused
    #[arg(long)]
    fps: Option<f64>,
    /// Let --fps stand above what the files say
    #[arg(long, requires = "fps")]
    force_fps: bool,
    /// Order of the robot's quaternions (wxyz or xyzw), instead of what its posture tells
    #[arg(long)]
    quaternion: Option<QuaternionOrder>,
    /// Skeleton (.asf) of .amc files, instead of the one beside them
    #[arg(long, value_name = "FILE")]
    skeleton: Option<PathBuf>,
    /// Files at a time; what comes of them does not depend on it [default: one per core]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    jobs: Option<u16>,
    /// Leave a robot's motion at the height that the file gives it
    #[arg(long)]
    no_ground: bool,
}

/// A file and the name of its clip.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Source {
    pub(super) path: PathBuf,
    pub(super) name: String,
    /// Whether it was found in a folder, and not named by the user.
    pub(super) searched: bool,
}

/// What became of a file.
pub(super) struct Read {
    pub(super) source: Source,
    pub(super) outcome: Result<Imported, MotionError>,
    /// Time on one core, s.
    pub(super) seconds: f64,
}

impl Source {
    fn read(&self, options: &Options) -> Read {
        let began = Instant::now();
        let outcome = import::import(&self.path, options).map(|imported| Imported {
            clip: Clip {
                name: self.name.clone(),
                ..imported.clip
            },
            ..imported
        });
        Read {
            source: self.clone(),
            outcome,
            seconds: began.elapsed().as_secs_f64(),
        }
    }
}

impl Sources {
    /// Reads all files, several at once, in their order; progress goes to standard error.
    pub(super) fn read(&self) -> Result<Vec<Read>> {
        let sources = self.found()?;
        distinct(&sources)?;
        Ok(self.read_found(sources))
    }

    /// Reads files that were found.
    pub(super) fn read_found(&self, sources: Vec<Source>) -> Vec<Read> {
        self.each(&sources, |_, read| read)
    }

    /// Reads files and does `work` with each and its place, several at once; what comes of it is in the order of the
    /// files, whoever was quicker. Progress goes to standard error.
    pub(super) fn each<T: Send>(
        &self,
        sources: &[Source],
        work: impl Fn(usize, Read) -> T + Sync,
    ) -> Vec<T> {
        let options = self.options();
        let next = AtomicUsize::new(0);
        let mut done: Vec<Option<T>> = Vec::new();
        done.resize_with(sources.len(), || None);
        thread::scope(|scope| {
            let (send, results) = mpsc::channel();
            for _ in 0..self.jobs().min(sources.len()) {
                let send = send.clone();
                let (options, next, work) = (&options, &next, &work);
                scope.spawn(move || {
                    while let Some((i, source)) = {
                        let i = next.fetch_add(1, Ordering::Relaxed);
                        sources.get(i).map(|source| (i, source))
                    } {
                        if send.send((i, work(i, source.read(options)))).is_err() {
                            return; // nobody waits any more
                        }
                    }
                });
            }
            drop(send);
            let mut console = Console::new();
            let all = count(sources.len(), "file");
            for (before, (i, result)) in results.into_iter().enumerate() {
                if sources.len() > 1 {
                    let line = format!("read {} of {all} · {}", before + 1, sources[i].name);
                    console.show(&line, Instant::now());
                }
                done[i] = Some(result);
            }
            console.finish();
        });
        done.into_iter().flatten().collect()
    }

    /// How many files at a time.
    fn jobs(&self) -> usize {
        let cores = || thread::available_parallelism().map_or(1, usize::from);
        self.jobs.map_or_else(cores, usize::from)
    }

    /// All files that are read, skeletons among them.
    pub(super) fn files<'a>(&'a self, sources: &'a [Source]) -> Vec<&'a Path> {
        let motions = sources.iter().map(|source| source.path.as_path());
        motions.chain(self.skeleton.as_deref()).collect()
    }

    fn options(&self) -> Options {
        Options {
            fps: self.fps,
            force_fps: self.force_fps,
            format: self.format,
            quaternion: self.quaternion,
            skeleton: self.skeleton.clone(),
            ground: !self.no_ground,
        }
    }

    /// The files, folders searched.
    pub(super) fn found(&self) -> Result<Vec<Source>> {
        let mut sources = Vec::new();
        for path in &self.paths {
            if path.is_dir() {
                let before = sources.len();
                let mut passed = Vec::new();
                search(path, path, &mut sources, &mut passed)
                    .with_context(|| format!("searching {}", path.display()))?;
                say_passed(&passed);
                if sources.len() == before {
                    let endings = EXTENSIONS.join(", ");
                    return Err(usage(format!(
                        "{} holds no motion file ({endings})",
                        path.display()
                    )));
                }
            } else {
                sources.push(Source {
                    path: path.clone(),
                    name: name(path),
                    searched: false,
                });
            }
        }
        Ok(sources)
    }
}

/// Refuses two files of one name: nobody could tell what is shown of them.
fn distinct(sources: &[Source]) -> Result<()> {
    let mut known: BTreeMap<&str, &Path> = BTreeMap::new();
    for source in sources {
        if let Some(other) = known.insert(&source.name, &source.path) {
            return Err(usage(format!(
                "{} and {} would have the same name; give their common folder, or one at a time",
                other.display(),
                source.path.display()
            )));
        }
    }
    Ok(())
}

/// Says what was passed over, in a line.
fn say_passed(passed: &[PathBuf]) {
    const SHOWN: usize = 3;
    if passed.is_empty() {
        return;
    }
    let shown: Vec<String> = passed
        .iter()
        .take(SHOWN)
        .map(|path| path.display().to_string())
        .collect();
    let more = if passed.len() > SHOWN { ", …" } else { "" };
    say(&format!(
        "passed over {} with the shape of a body and no motion: {}{more}",
        count(passed.len(), "file"),
        shown.join(", ")
    ));
}

/// Motion files below a folder, sorted; their names carry the folders between.
/// Those that hold a body's shape and no motion come into `passed`.
fn search(
    root: &Path,
    folder: &Path,
    sources: &mut Vec<Source>,
    passed: &mut Vec<PathBuf>,
) -> Result<()> {
    let mut paths: Vec<PathBuf> = fs::read_dir(folder)?
        .map(|entry| entry.map(|entry| entry.path()))
        .collect::<Result<_, _>>()?;
    paths.sort();
    for path in paths {
        let ending = path.extension().map(|e| e.to_string_lossy().to_lowercase());
        let ending = ending.as_deref().unwrap_or_default();
        if path.is_dir() {
            search(root, &path, sources, passed)?;
        } else if ending == "npz" && import::is_body_shape(&path) {
            passed.push(path);
        } else if EXTENSIONS.contains(&ending)
            || TEXTS.contains(&ending) && import::is_text_of_frames(&path)
        {
            let inner = path.strip_prefix(root).unwrap_or(&path);
            let name = name(inner);
            let folders = inner
                .parent()
                .map(|p| p.to_string_lossy().replace('/', "_"));
            let name = match folders.as_deref() {
                None | Some("") => name,
                Some(folders) => format!("{folders}_{name}"),
            };
            sources.push(Source {
                path,
                name,
                searched: true,
            });
        }
    }
    Ok(())
}

fn name(path: &Path) -> String {
    path.file_stem()
        .map_or_else(|| "clip".into(), |stem| stem.to_string_lossy().into_owned())
}

/// Makes the folder that plots are written to.
pub(super) fn make_folder(out: &Path) -> Result<()> {
    fs::create_dir_all(out).with_context(|| format!("making the folder {}", out.display()))
}

#[cfg(test)]
mod tests;

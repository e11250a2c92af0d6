//! Which files are meant, and how they are read, many at once.
//!
//! Separate because every subcommand asks for files in the same words.

mod readable;
mod search;

use std::collections::{BTreeMap, HashSet};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc;
use std::thread;
use std::time::Instant;

use anyhow::{Context, Result};
use clap::Args;
use motion::import::{self, Format, Imported, Options};
use motion::{Clip, MotionError, QuaternionOrder};
use terminal::console::{Console, say};
use terminal::failure::usage;
use wording::count;

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
        let outcome = readable::check(&self.path, options)
            .and_then(|()| import::import(&self.path, options))
            .map_err(readable::told);
        let outcome = outcome.map(|imported| Imported {
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
    /// Reads all files, several at once, in their order, under names that differ; progress goes to standard error.
    pub(super) fn read(&self) -> Result<Vec<Read>> {
        Ok(self.read_found(told_apart(self.found()?)))
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
            let mut console = Console::on_stderr();
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

    /// The files, folders searched; a file that is given several times is taken once.
    pub(super) fn found(&self) -> Result<Vec<Source>> {
        let (mut sources, mut again) = (Vec::new(), Vec::new());
        let mut known = HashSet::new();
        for path in &self.paths {
            for source in given(path)? {
                if known.insert(search::key(&source.path)) {
                    sources.push(source);
                } else {
                    again.push(source.path);
                }
            }
        }
        if !again.is_empty() {
            say(&few(&again, "given again and taken once"));
        }
        Ok(sources)
    }
}

/// The files that an argument means.
fn given(path: &Path) -> Result<Vec<Source>> {
    if !path.is_dir() {
        return Ok(vec![Source {
            path: path.to_owned(),
            name: name(path),
            searched: false,
        }]);
    }
    let found = search::search(path).with_context(|| format!("searching {}", shown(path)))?;
    if !found.passed.is_empty() {
        let what = "with the shape of a body and no motion";
        say(&format!("passed over {}", few(&found.passed, what)));
    }
    if found.sources.is_empty() {
        let endings = search::EXTENSIONS.join(", ");
        return Err(usage(format!(
            "{} holds no motion file ({endings})",
            shown(path)
        )));
    }
    Ok(found.sources)
}

/// Sources whose names differ: those of one name are called by their paths.
fn told_apart(mut sources: Vec<Source>) -> Vec<Source> {
    let mut times: BTreeMap<String, usize> = BTreeMap::new();
    for source in &sources {
        *times.entry(source.name.clone()).or_default() += 1;
    }
    for source in &mut sources {
        if times.get(&source.name).is_some_and(|times| *times > 1) {
            source.name = shown(&source.path);
        }
    }
    sources
}

/// How many files, and the first few of them.
fn few(paths: &[PathBuf], what: &str) -> String {
    const SHOWN: usize = 3;
    let names: Vec<String> = paths.iter().take(SHOWN).map(|path| shown(path)).collect();
    let more = if paths.len() > SHOWN { ", …" } else { "" };
    let files = count(paths.len(), "file");
    format!("{files} {what}: {}{more}", names.join(", "))
}

/// The name of a clip from a file, in a line.
fn name(path: &Path) -> String {
    path.file_stem().map_or_else(
        || "clip".into(),
        |stem| stem.to_string_lossy().replace(char::is_control, "_"),
    )
}

/// A path as messages show it: in one line, without what a terminal would obey.
pub(super) fn shown(path: &Path) -> String {
    wording::harmless(&path.to_string_lossy())
        .replace('\n', "\\n")
        .replace('\t', "\\t")
}

/// An error and its causes in a line.
pub(super) fn describe(error: &MotionError) -> String {
    let mut text = error.to_string();
    let mut cause = std::error::Error::source(error);
    while let Some(error) = cause {
        text = format!("{text}: {error}");
        cause = error.source();
    }
    text
}

#[cfg(test)]
mod tests;

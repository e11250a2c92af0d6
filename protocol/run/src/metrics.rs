//! `metrics.jsonl`: one JSON object per iteration, appended as the run goes on.
//!
//! Separate because the learner writes it while others read it: the scheduler rebuilds its state
//! from it, the command line follows it. A process that dies in the middle of a line leaves it
//! torn; a reader passes over a torn *last* line, and a writer removes it before going on. Lines for
//! which a full disk has no room wait in memory, and follow when it has.

use std::fs::{File, OpenOptions};
use std::io::{self, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use serde::Serialize;
use serde::de::DeserializeOwned;
use serde_json::Value;

use crate::replace;

/// Why the metrics cannot be read or written.
#[derive(Debug, thiserror::Error)]
pub enum MetricsError {
    /// The system refused.
    #[error("cannot use {}", path.display())]
    Io {
        /// The file.
        path: PathBuf,
        /// What the system said.
        #[source]
        source: io::Error,
    },
    /// A line before the last is no record: the file was edited or damaged.
    #[error("{}, line {line}: not a record of metrics: {}", path.display(), wording::said(said))]
    Malformed {
        /// The file.
        path: PathBuf,
        /// Counted from 1.
        line: usize,
        /// What the parser said.
        said: String,
    },
}

/// Bytes of lines that wait for room on the disk; what comes after them is lost.
const WAITING: usize = 16 << 20;

/// The writer's end.
#[derive(Debug)]
pub struct Metrics {
    file: File,
    path: PathBuf,
    /// Whole lines that are not in the file yet.
    waiting: Vec<u8>,
    /// Bytes of the file that are whole lines.
    length: u64,
    /// The last write failed: behind `length` there may be half a line.
    torn: bool,
    lost: u64,
}

impl Metrics {
    /// Opens for appending, creating the file; a torn last line is removed.
    pub fn open(path: &Path) -> Result<Self, MetricsError> {
        let opened = || -> io::Result<(File, u64)> {
            let mut file = OpenOptions::new()
                .read(true)
                .append(true)
                .create(true)
                .open(path)?;
            let mut bytes = Vec::new();
            file.read_to_end(&mut bytes)?;
            let whole = whole_lines(&bytes);
            if whole < bytes.len() {
                file.set_len(whole as u64)?;
            }
            Ok((file, whole as u64))
        };
        let (file, length) = opened().map_err(|source| io_error(path, source))?;
        Ok(Self {
            file,
            path: path.to_owned(),
            waiting: Vec::new(),
            length,
            torn: false,
            lost: 0,
        })
    }

    /// Appends one record as one line, in one write: it outlives this process at once, and a power
    /// cut from the next [`Metrics::sync`] on.
    ///
    /// # Errors
    /// When the disk refuses. The line then waits and is written by the next call that can.
    pub fn append(&mut self, record: &impl Serialize) -> Result<(), MetricsError> {
        let before = self.waiting.len();
        let line = serde_json::to_writer(&mut self.waiting, record);
        if let Err(error) = line {
            self.waiting.truncate(before);
            return Err(io_error(&self.path, error.into()));
        }
        self.waiting.push(b'\n');
        if self.waiting.len() > WAITING {
            self.waiting.truncate(before);
            self.lost += 1;
        }
        let written = self.write();
        written.map_err(|source| io_error(&self.path, source))
    }

    /// Lines that were given up because too many waited already.
    pub fn lost(&self) -> u64 {
        self.lost
    }

    /// Writes what waits, all or nothing.
    fn write(&mut self) -> io::Result<()> {
        if self.torn {
            self.file.set_len(self.length)?;
            self.torn = false;
        }
        if let Err(error) = self.file.write_all(&self.waiting) {
            self.torn = self.file.set_len(self.length).is_err();
            return Err(error);
        }
        self.length += self.waiting.len() as u64;
        self.waiting.clear();
        Ok(())
    }

    /// Waits until everything appended is on the disk; called with each checkpoint.
    pub fn sync(&self) -> Result<(), MetricsError> {
        self.file
            .sync_data()
            .map_err(|source| io_error(&self.path, source))
    }
}

/// Reads all records; no file is no records, and a torn last line is passed over.
pub fn read<T: DeserializeOwned>(path: &Path) -> Result<Vec<T>, MetricsError> {
    let bytes = read_bytes(path)?;
    lines(&bytes)
        .enumerate()
        .map(|(index, line)| {
            serde_json::from_slice(line).map_err(|error| MetricsError::Malformed {
                path: path.to_owned(),
                line: index + 1,
                said: error.to_string(),
            })
        })
        .collect()
}

/// The newest record, without parsing the others.
pub fn newest(path: &Path) -> Result<Option<Value>, MetricsError> {
    let bytes = read_bytes(path)?;
    Ok(lines(&bytes)
        .last()
        .and_then(|line| serde_json::from_slice(line).ok()))
}

/// Drops every record after `iteration`: what a resumed run is about to write again.
pub fn truncate_after(path: &Path, iteration: u64) -> Result<(), MetricsError> {
    let bytes = read_bytes(path)?;
    let mut kept = Vec::with_capacity(bytes.len());
    for (index, line) in lines(&bytes).enumerate() {
        let record: Value =
            serde_json::from_slice(line).map_err(|error| MetricsError::Malformed {
                path: path.to_owned(),
                line: index + 1,
                said: error.to_string(),
            })?;
        if record["iteration"]
            .as_u64()
            .is_some_and(|at| at <= iteration)
        {
            kept.extend_from_slice(line);
            kept.push(b'\n');
        }
    }
    let cut = || {
        if !bytes.starts_with(&kept) {
            return replace::replace_file(path, &kept);
        }
        // The usual case: the end is cut off, for which also a full disk has room.
        let file = match OpenOptions::new().write(true).open(path) {
            Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(()),
            file => file?,
        };
        file.set_len(kept.len() as u64)?;
        file.sync_all()
    };
    cut().map_err(|source| io_error(path, source))
}

/// Follows a file that another process writes.
#[derive(Debug)]
pub struct Tail {
    path: PathBuf,
    offset: u64,
}

impl Tail {
    /// Follows from the start of the file, which need not exist yet.
    pub fn from_start(path: &Path) -> Self {
        Self {
            path: path.to_owned(),
            offset: 0,
        }
    }

    /// Follows from the present end: only what is written from now on.
    pub fn from_end(path: &Path) -> Self {
        Self {
            path: path.to_owned(),
            offset: std::fs::metadata(path).map_or(0, |metadata| metadata.len()),
        }
    }

    /// The whole lines written since the last call; lines that are no records are passed over.
    pub fn poll(&mut self) -> Result<Vec<Value>, MetricsError> {
        let mut file = match File::open(&self.path) {
            Ok(file) => file,
            Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(Vec::new()),
            Err(source) => return Err(io_error(&self.path, source)),
        };
        let mut read = || -> io::Result<Vec<u8>> {
            // A shorter file was truncated by a resuming learner: what remains has been seen.
            let length = file.metadata()?.len();
            self.offset = self.offset.min(length);
            file.seek(SeekFrom::Start(self.offset))?;
            let mut bytes = Vec::new();
            file.read_to_end(&mut bytes)?;
            Ok(bytes)
        };
        let bytes = read().map_err(|source| io_error(&self.path, source))?;
        self.offset += whole_lines(&bytes) as u64;
        Ok(lines(&bytes)
            .filter_map(|line| serde_json::from_slice(line).ok())
            .collect())
    }
}

/// How many bytes belong to whole lines.
fn whole_lines(bytes: &[u8]) -> usize {
    bytes
        .iter()
        .rposition(|byte| *byte == b'\n')
        .map_or(0, |newline| newline + 1)
}

fn lines(bytes: &[u8]) -> impl Iterator<Item = &[u8]> {
    bytes[..whole_lines(bytes)]
        .split(|byte| *byte == b'\n')
        .filter(|line| !line.is_empty())
}

fn read_bytes(path: &Path) -> Result<Vec<u8>, MetricsError> {
    match std::fs::read(path) {
        Ok(bytes) => Ok(bytes),
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(Vec::new()),
        Err(source) => Err(io_error(path, source)),
    }
}

fn io_error(path: &Path, source: io::Error) -> MetricsError {
    MetricsError::Io {
        path: path.to_owned(),
        source,
    }
}

#[cfg(test)]
mod tests;

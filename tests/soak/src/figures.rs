//! Memory, descriptors and shared memory of a group as time goes on: `soak.jsonl`.

use std::collections::BTreeMap;
use std::fs;
use std::os::unix::fs::MetadataExt;
use std::time::{Duration, Instant};

use anyhow::{Context, Result};
use protocol::Domain;
use run::{Folder, Metrics};
use serde::Serialize;

/// Between two samples.
const EVERY: Duration = Duration::from_secs(2);

/// After this time memory should not grow any more.
pub(super) const SETTLED: Duration = Duration::from_secs(300);

/// One look at all processes.
#[derive(Serialize)]
struct Sample {
    seconds: f64,
    processes: BTreeMap<String, Process>,
    /// Pages that exist under /dev/shm, bytes.
    shared_bytes: u64,
    shared_files: usize,
}

/// What a process holds.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
struct Process {
    pid: u32,
    /// Resident memory, bytes: all, and its part that belongs to no file.
    resident_bytes: u64,
    own_bytes: u64,
    descriptors: u64,
    threads: u64,
}

/// Least, most and last of a figure since the group has settled.
#[derive(Clone, Copy, Debug)]
struct Range {
    first: u64,
    most: u64,
    last: u64,
}

/// Samples so far.
pub(super) struct Figures {
    domain: Domain,
    file: Metrics,
    began: Instant,
    due: Instant,
    ranges: BTreeMap<String, Range>,
}

impl Figures {
    pub(super) fn begin(folder: &Folder) -> Result<Self> {
        Ok(Self {
            domain: Domain::for_run(folder.path())?,
            file: Metrics::open(&folder.path().join("soak.jsonl"))?,
            began: Instant::now(),
            due: Instant::now(),
            ranges: BTreeMap::new(),
        })
    }

    /// Takes a sample every few seconds.
    pub(super) fn take_when_due(&mut self, folder: &Folder) -> Result<()> {
        if Instant::now() < self.due {
            return Ok(());
        }
        self.due = Instant::now() + EVERY;
        let holders = folder.holders().context("looking who is alive")?;
        let processes: BTreeMap<String, Process> = holders
            .into_iter()
            .filter_map(|(role, pid)| Some((role, Process::read(pid.parse().ok()?)?)))
            .collect();
        let (shared_files, shared_bytes) = self.shared()?;
        let sample = Sample {
            seconds: self.began.elapsed().as_secs_f64(),
            processes,
            shared_bytes,
            shared_files,
        };
        if self.began.elapsed() >= SETTLED {
            self.add(&sample);
        }
        self.file.append(&sample).context("writing soak.jsonl")
    }

    fn shared(&self) -> Result<(usize, u64)> {
        let leftovers = self.domain.leftovers()?;
        let segments = leftovers.iter().filter(|path| path.starts_with("/dev/shm"));
        // A segment may vanish with its process while we look.
        let sizes: Vec<u64> = segments
            .filter_map(|path| Some(fs::metadata(path).ok()?.blocks() * 512))
            .collect();
        Ok((sizes.len(), sizes.iter().sum()))
    }

    fn add(&mut self, sample: &Sample) {
        let mut take = |name: String, value: u64| {
            let range = self.ranges.entry(name).or_insert(Range {
                first: value,
                most: value,
                last: value,
            });
            range.most = range.most.max(value);
            range.last = value;
        };
        for (role, process) in &sample.processes {
            take(
                format!("{role}: resident kB"),
                process.resident_bytes / 1024,
            );
            take(format!("{role}: own kB"), process.own_bytes / 1024);
            take(format!("{role}: descriptors"), process.descriptors);
            take(format!("{role}: threads"), process.threads);
        }
        take("/dev/shm: kB".to_owned(), sample.shared_bytes / 1024);
        take("/dev/shm: files".to_owned(), sample.shared_files as u64);
    }

    /// A table for people: each figure after five minutes, at most since then, and at the end.
    pub(super) fn summary(&self) -> String {
        let minutes = SETTLED.as_secs() / 60;
        let mut text = format!(
            "{:<28}{:>12}{:>12}{:>12}",
            "",
            format!("{minutes} min"),
            "most since",
            "at the end"
        );
        for (name, range) in &self.ranges {
            let Range { first, most, last } = range;
            text += &format!("\n{name:<28}{first:>12}{most:>12}{last:>12}");
        }
        text
    }
}

impl Process {
    /// What the kernel says of a process; `None` when it has just ended.
    fn read(pid: u32) -> Option<Self> {
        let status = fs::read_to_string(format!("/proc/{pid}/status")).ok()?;
        let descriptors = fs::read_dir(format!("/proc/{pid}/fd")).ok()?.count() as u64;
        Some(Self {
            pid,
            descriptors,
            ..Self::of(&status)
        })
    }

    /// From `/proc/<pid>/status`: lines of a name, a colon, a number, and kB where it is memory.
    fn of(status: &str) -> Self {
        let number = |name: &str| {
            let line = status.lines().find_map(|line| line.strip_prefix(name));
            let word = line.and_then(|rest| rest.split_whitespace().next());
            word.and_then(|word| word.parse::<u64>().ok()).unwrap_or(0)
        };
        Self {
            resident_bytes: number("VmRSS:") * 1024,
            own_bytes: number("RssAnon:") * 1024,
            threads: number("Threads:"),
            ..Self::default()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_kernel_s_words_become_figures() {
        let status = "Name:\tampco\nVmRSS:\t    2048 kB\nRssAnon:\t     512 kB\nThreads:\t3\n";
        let process = Process::of(status);
        assert_eq!(process.resident_bytes, 2_097_152); // 2 MiB
        assert_eq!(process.own_bytes, 524_288);
        assert_eq!(process.threads, 3);
    }

    #[test]
    fn this_very_process_is_read_and_one_that_is_none_is_not() {
        let process = Process::read(std::process::id()).unwrap();
        assert!(process.resident_bytes > 0 && process.descriptors >= 3 && process.threads > 0);
        assert_eq!(Process::read(u32::MAX), None);
    }
}

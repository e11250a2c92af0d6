//! What became of every rollout, written down by those who know: `logs/*.rollouts`.
//!
//! Separate because the counters in the processes die with them. A line is on its way to the disk
//! before the next thing happens, so it outlives the kill of its writer; put side by side, the lines
//! of all actors and of the learner tell whether a rollout was used twice or lost without being
//! counted. That is done in [`account`].

use std::fs::{File, OpenOptions};
use std::io::{self, Read, Seek, SeekFrom, Write};
use std::path::Path;

pub mod account;

pub use account::Account;

/// The ending of a journal's name.
const ENDING: &str = "rollouts";

/// The number of a rollout: actor, its life, its place in that life.
pub type Key = (u32, u64, u64);

/// One line.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Entry {
    /// An actor is about to send a rollout.
    Sending(Key),
    /// What its send came to, one of [`OUTCOMES`].
    Sent(Key, String),
    /// A learner begins after so many iterations: its own number, the iterations.
    Begun(u64, u64),
    /// A learner has received a rollout: its number, the iteration it gathers for, what it did with
    /// the rollout, one of [`FATES`].
    Received(u64, u64, Key, String),
    /// A carrier begins with an actor of its machine: what one before it held is lost.
    Carrying(u32),
    /// A carrier's rollout was acknowledged.
    Carried(Key),
    /// A gate opens its end of the learner's stream for an actor of another machine: what lay in one before is lost.
    Passing(u32),
    /// A gate has put a rollout into the learner's stream.
    Passed(Key),
}

/// What a send can come to: the learner's stream has it; nobody listened; the stream stayed full; the
/// actor was told to stop while it was full.
pub const OUTCOMES: [&str; 4] = ["delivered", "unheard", "full", "interrupted"];

/// What a learner can do with a rollout: learn from it; find its weights too old, or another
/// learner's; find it received before; find its actor's answer received before; find a number in it
/// that is none.
pub const FATES: [&str; 5] = ["used", "stale", "duplicate", "surplus", "unusable"];

impl Entry {
    fn line(&self) -> String {
        match self {
            Self::Sending((actor, life, number)) => format!("sending {actor} {life} {number}\n"),
            Self::Sent((actor, life, number), outcome) => {
                format!("sent {actor} {life} {number} {outcome}\n")
            }
            Self::Begun(learner, iteration) => format!("begun {learner} {iteration}\n"),
            Self::Received(learner, iteration, (actor, life, number), fate) => {
                format!("received {learner} {iteration} {actor} {life} {number} {fate}\n")
            }
            Self::Carrying(actor) => format!("carrying {actor}\n"),
            Self::Carried((actor, life, number)) => format!("carried {actor} {life} {number}\n"),
            Self::Passing(actor) => format!("passing {actor}\n"),
            Self::Passed((actor, life, number)) => format!("passed {actor} {life} {number}\n"),
        }
    }

    /// The entry of a line; `None` of one that was cut short.
    fn read(line: &str) -> Option<Self> {
        let words: Vec<&str> = line.split(' ').collect();
        let key = |words: &[&str]| -> Option<Key> {
            let [actor, life, number] = words else {
                return None;
            };
            Some((
                actor.parse().ok()?,
                life.parse().ok()?,
                number.parse().ok()?,
            ))
        };
        Some(match words.as_slice() {
            ["sending", rest @ ..] => Self::Sending(key(rest)?),
            ["sent", rest @ .., outcome] if OUTCOMES.contains(outcome) => {
                Self::Sent(key(rest)?, (*outcome).to_owned())
            }
            ["begun", learner, iteration] => {
                Self::Begun(learner.parse().ok()?, iteration.parse().ok()?)
            }
            ["received", learner, iteration, rest @ .., fate] if FATES.contains(fate) => {
                let (learner, iteration) = (learner.parse().ok()?, iteration.parse().ok()?);
                Self::Received(learner, iteration, key(rest)?, (*fate).to_owned())
            }
            ["carrying", actor] => Self::Carrying(actor.parse().ok()?),
            ["carried", rest @ ..] => Self::Carried(key(rest)?),
            ["passing", actor] => Self::Passing(actor.parse().ok()?),
            ["passed", rest @ ..] => Self::Passed(key(rest)?),
            _ => return None,
        })
    }
}

/// The writer's end.
#[derive(Debug)]
pub struct Journal(Option<File>);

impl Journal {
    /// Opens `logs/<process>.rollouts` for appending, or nothing at all unless `wanted`.
    pub fn open(logs: &Path, process: &str, wanted: bool) -> io::Result<Self> {
        if !wanted {
            return Ok(Self(None));
        }
        let path = logs.join(format!("{process}.{ENDING}"));
        let opened = OpenOptions::new()
            .read(true)
            .append(true)
            .create(true)
            .open(&path)
            .and_then(|mut file| {
                if !ends_with_a_line(&mut file)? {
                    file.write_all(b"\n")?;
                }
                Ok(file)
            });
        let named =
            |error: io::Error| io::Error::new(error.kind(), format!("{}: {error}", path.display()));
        Ok(Self(Some(opened.map_err(named)?)))
    }

    /// Writes an entry, which is made only if a journal is kept. A disk that refuses ends the journal
    /// and not the run; the account will then not come out even.
    pub fn write(&mut self, entry: impl FnOnce() -> Entry) {
        if let Some(file) = &mut self.0
            && let Err(error) = file.write_all(entry().line().as_bytes())
        {
            tracing::warn!(%error, "no more entries in the journal of rollouts");
            self.0 = None;
        }
    }
}

fn ends_with_a_line(file: &mut File) -> io::Result<bool> {
    if file.metadata()?.len() == 0 {
        return Ok(true);
    }
    let mut last = [0];
    file.seek(SeekFrom::End(-1))?;
    file.read_exact(&mut last)?;
    Ok(last == *b"\n")
}

/// All entries of the journals in a folder of logs: process after process, each in its order.
pub fn read(logs: &Path) -> io::Result<Vec<Vec<Entry>>> {
    let mut journals = Vec::new();
    for entry in std::fs::read_dir(logs)? {
        let path = entry?.path();
        if path.extension().is_some_and(|ending| ending == ENDING) {
            let bytes = std::fs::read(&path)?;
            let text = String::from_utf8_lossy(&bytes);
            journals.push(text.lines().filter_map(Entry::read).collect());
        }
    }
    Ok(journals)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_was_written_is_read_and_a_line_cut_short_is_not() {
        let logs = tempfile::tempdir().unwrap();
        let entries = [
            Entry::Sending((1, 20, 3)),
            Entry::Sent((1, 20, 3), "delivered".to_owned()),
            Entry::Begun(7, 0),
            Entry::Received(7, 1, (1, 20, 3), "used".to_owned()),
            Entry::Carrying(1),
            Entry::Carried((1, 20, 3)),
            Entry::Passing(1),
            Entry::Passed((1, 20, 3)),
        ];
        let mut journal = Journal::open(logs.path(), "actor-1", true).unwrap();
        for entry in &entries {
            journal.write(|| entry.clone());
        }
        drop(journal);
        let path = logs.path().join("actor-1.rollouts");
        let text = std::fs::read_to_string(&path).unwrap();
        std::fs::write(&path, text + "received 7 1 1 2").unwrap();
        let mut again = Journal::open(logs.path(), "actor-1", true).unwrap();
        again.write(|| Entry::Sending((1, 20, 4)));
        let mut expected = entries.to_vec();
        expected.push(Entry::Sending((1, 20, 4)));
        assert_eq!(read(logs.path()).unwrap(), [expected]);
    }

    #[test]
    fn nothing_is_written_where_nobody_asks() {
        let logs = tempfile::tempdir().unwrap();
        let mut journal = Journal::open(logs.path(), "learner", false).unwrap();
        journal.write(|| unreachable!("no entry is made"));
        assert!(read(logs.path()).unwrap().is_empty());
    }
}

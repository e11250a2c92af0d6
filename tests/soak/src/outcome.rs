//! What a soak has found: the account of all rollouts, and what is left.

use std::fs;
use std::path::Path;
use std::time::{SystemTime, UNIX_EPOCH};

use anyhow::{Context, Result};
use protocol::Domain;
use run::journal::{self, Account, Entry};
use run::{Folder, journal::account::account};
use serde_json::{Value, json};
use wording::count;

use super::PROMISED_SECONDS;

/// One kill: whom, when, and what there was to go on from.
#[derive(Clone, Debug)]
pub(super) struct Victim {
    role: String,
    /// Nanoseconds since 1970, as learners are numbered.
    moment: u64,
    checkpoint: Option<u64>,
}

impl Victim {
    /// The holder of a role, just before it is killed.
    pub(super) fn of(folder: &Folder, role: &str) -> Self {
        let since = SystemTime::now().duration_since(UNIX_EPOCH);
        Self {
            role: role.to_owned(),
            checkpoint: folder.checkpoints().newest_whole(),
            moment: since.map_or(0, |since| since.as_nanos() as u64),
        }
    }
}

/// Everything that is told at the end.
#[derive(Debug)]
pub(super) struct Outcome {
    kills: u64,
    restarts: u64,
    longest: f64,
    account: Account,
    left_bytes: u64,
    /// Processes that are still alive, by role.
    alive: Vec<String>,
    /// Learners that began earlier than they could have.
    set_back: Vec<String>,
}

impl Outcome {
    pub(super) fn of(
        folder: &Folder,
        guests: &[Folder],
        kills: u64,
        restarts: u64,
        longest: f64,
        victims: &[Victim],
    ) -> Result<Self> {
        let (mut journals, mut leftovers, mut alive) = (Vec::new(), Vec::new(), Vec::new());
        for folder in std::iter::once(folder).chain(guests) {
            let read = journal::read(&folder.logs());
            journals.extend(read.context("reading the journals of rollouts")?);
            leftovers.extend(Domain::for_run(folder.path())?.leftovers()?);
            alive.extend(folder.holders()?.into_iter().map(|(role, _)| role));
        }
        Ok(Self {
            kills,
            restarts,
            longest,
            account: account(&journals),
            left_bytes: leftovers.iter().map(|path| size(path)).sum(),
            alive,
            set_back: set_back(&journals, victims),
        })
    }

    /// The one object that scripts read.
    pub(super) fn json(&self) -> Value {
        json!({
            "kills": self.kills,
            "restarts": self.restarts,
            "whole_seconds_max": self.longest,
            "sent": self.account.sent,
            "used": self.account.used,
            "dropped": self.account.dropped,
            "uncounted": self.account.uncounted,
            "left_bytes": self.left_bytes,
        })
    }

    /// The promises that were not kept.
    pub(super) fn failures(&self) -> Vec<String> {
        let mut failures = self.set_back.clone();
        if self.longest > PROMISED_SECONDS {
            let longest = self.longest;
            failures.push(format!("the group took {longest:.1} s to be whole again"));
        }
        if self.account.uncounted > 0 {
            let uncounted = self.account.uncounted;
            failures.push(format!("unaccounted for: {}", count(uncounted, "rollout")));
        }
        if self.account.sent == 0 {
            failures.push("nothing was sent".to_owned());
        }
        if self.left_bytes > 0 {
            failures.push(format!("left over: {}", count(self.left_bytes, "byte")));
        }
        if !self.alive.is_empty() {
            failures.push(format!("still alive: {}", self.alive.join(", ")));
        }
        failures
    }
}

/// Learners that went on from an earlier checkpoint than was there when the one before was killed.
fn set_back(journals: &[Vec<Entry>], victims: &[Victim]) -> Vec<String> {
    let mut begun: Vec<(u64, u64)> = journals
        .iter()
        .flatten()
        .filter_map(|entry| match entry {
            Entry::Begun(learner, iteration) => Some((*learner, *iteration)),
            _ => None,
        })
        .collect();
    begun.sort_unstable();
    let complaint = |victim: &Victim| {
        let checkpoint = victim.checkpoint?;
        let next = begun.iter().find(|(learner, _)| *learner > victim.moment);
        let (_, iteration) = next.filter(|(_, iteration)| *iteration < checkpoint)?;
        Some(format!(
            "after {} was killed, training went on from iteration {iteration} although there was \
             checkpoint {checkpoint}",
            victim.role
        ))
    };
    victims.iter().filter_map(complaint).collect()
}

/// Bytes of a file or of all in a folder, and one for its being there.
fn size(path: &Path) -> u64 {
    let inside = fs::read_dir(path).map_or(0, |entries| {
        entries
            .filter_map(Result::ok)
            .map(|entry| size(&entry.path()))
            .sum()
    });
    let own = fs::symlink_metadata(path).map_or(0, |facts| facts.len().max(1));
    own + inside
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn going_on_from_less_than_there_was_is_noticed() {
        let victim = |moment, checkpoint| Victim {
            role: "learner".to_owned(),
            moment,
            checkpoint,
        };
        let journals = [vec![
            Entry::Begun(10, 0),
            Entry::Begun(30, 40),
            Entry::Begun(50, 30),
        ]];
        assert!(set_back(&journals, &[victim(20, Some(40)), victim(60, Some(99))]).is_empty());
        assert!(set_back(&journals, &[victim(20, None)]).is_empty());
        let complaints = set_back(&journals, &[victim(40, Some(40))]);
        assert_eq!(complaints.len(), 1);
        assert!(
            complaints[0].contains("from iteration 30"),
            "{complaints:?}"
        );
    }
}

//! The lists of a process as a few numbers of fixed size, and the difference between two processes' in words.
//!
//! Separate because a message carries it: whoever reads rows that another process wrote has to know that both mean the
//! same by each number.

use crate::table::{Entry, Table};
use crate::tables::Tables;
use crate::terms::{ACTOR, TERMS};

/// Most terms of all lists together; the critic's may begin with the actor's whole.
pub const LISTED: usize = 3 * TERMS.len() + 1;

/// A number for each listed term: of which list it is, which it is, and how it is seen; 0 where there is no more.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Print(pub [u64; LISTED]);

/// The lists as a print numbers them, from 1.
const LISTS: [&str; 3] = ["actor", "critic", "discriminator"];

impl Print {
    /// Of a process' lists.
    pub fn of(tables: &Tables) -> Self {
        Self::of_those(tables, &[1, 2, 3])
    }

    /// Of what the policy sees alone.
    pub fn of_actor(tables: &Tables) -> Self {
        Self::of_those(tables, &[1])
    }

    /// Of what the critic sees, the policy's included.
    pub fn of_critic(tables: &Tables) -> Self {
        Self::of_those(tables, &[1, 2])
    }

    /// Of the lists of these numbers.
    fn of_those(tables: &Tables, those: &[u64]) -> Self {
        let mut listed = Vec::with_capacity(LISTED);
        let mut list = |list: u64, table: &Table| {
            listed.extend(table.entries().iter().map(|entry| number(list, entry)));
        };
        list(1, &tables.actor);
        list(3, &tables.discriminator);
        if let Some(critic) = &tables.critic {
            list(2, &critic.own);
        }
        let shares = tables.shared_width() > 0;
        listed.extend(shares.then(|| 2 << 62 | code(ACTOR) << 32));
        listed.retain(|number| those.contains(&(number >> 62)));
        let mut print = [0; LISTED];
        print[..listed.len()].copy_from_slice(&listed);
        Self(print)
    }

    /// How another process' lists differ from these, in words; none if they do not.
    pub fn difference(&self, other: &Self) -> Option<String> {
        if self == other {
            return None;
        }
        let mut words = Vec::new();
        for (name, list) in LISTS.iter().zip(1..) {
            let (ours, theirs) = (self.list(list), other.list(list));
            if ours == theirs {
                continue;
            }
            let lacking = |of: &[u64], those: &[u64]| -> Vec<&str> {
                let terms = |numbers: &[u64]| numbers.iter().map(|n| n >> 32).collect::<Vec<_>>();
                let known = terms(of);
                let rest = those
                    .iter()
                    .filter(|number| !known.contains(&(*number >> 32)));
                rest.map(|number| term(*number)).collect()
            };
            let (more, less) = (lacking(&ours, &theirs), lacking(&theirs, &ours));
            let other_settings = ours.iter().filter_map(|number| {
                let same = theirs.iter().find(|other| *other >> 32 == *number >> 32)?;
                (same != number).then(|| term(*number))
            });
            let changed: Vec<&str> = other_settings.collect();
            let mut parts = Vec::new();
            if !less.is_empty() {
                parts.push(format!("lacks {}", less.join(", ")));
            }
            if !more.is_empty() {
                parts.push(format!("has {} besides", more.join(", ")));
            }
            if !changed.is_empty() {
                let changed = changed.join(", ");
                parts.push(format!(
                    "has another scale, noise, clip or past of {changed}"
                ));
            }
            if parts.is_empty() {
                parts.push("has another order".to_owned());
            }
            words.push(format!(
                "its list of observation.{name} {}",
                parts.join(" and ")
            ));
        }
        Some(words.join("; "))
    }

    fn list(&self, list: u64) -> Vec<u64> {
        let numbers = self.0.iter().copied();
        numbers.filter(|number| number >> 62 == list).collect()
    }
}

/// List in the two highest bits, the term's name in the thirty below them, how it is seen in the rest.
fn number(list: u64, entry: &Entry) -> u64 {
    let mut seen = Vec::new();
    for setting in [
        entry.scale,
        entry.noise,
        entry.clip.unwrap_or(f32::INFINITY),
    ] {
        seen.extend(setting.to_le_bytes());
    }
    seen.extend((entry.past as u64).to_le_bytes());
    seen.extend((entry.term.width() as u64).to_le_bytes());
    list << 62 | code(entry.term.name) << 32 | u64::from(hash(&seen))
}

fn code(name: &str) -> u64 {
    u64::from(hash(name.as_bytes()) >> 2)
}

fn term(number: u64) -> &'static str {
    let wanted = number >> 32 & 0x3fff_ffff;
    let names = TERMS.iter().map(|term| term.name).chain([ACTOR]);
    names
        .into_iter()
        .find(|name| code(name) == wanted)
        .unwrap_or("a term that is not known here")
}

/// FNV-1a, 32 bits: short, stable between builds, and no secret is at stake.
fn hash(bytes: &[u8]) -> u32 {
    bytes.iter().fold(0x811c_9dc5, |hash, byte| {
        (hash ^ u32::from(*byte)).wrapping_mul(0x0100_0193)
    })
}

#[cfg(test)]
mod tests;

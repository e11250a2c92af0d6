//! Actors' robots on their way to a checkpoint and back, in pieces.

use std::collections::BTreeMap;

use hosts::{Answer, Attached, PIECE, Piece, Robots, RobotsWanted, Said};
use run::Checkpoints;
use run::checkpoint::robots_of;
use tracing::{info, warn};

/// Most bytes of an actor's robots; 4,096 robots of rapier's take a tenth of it.
const MOST: u64 = 1 << 30;

/// Robots that have begun to arrive, and the last that were asked for.
#[derive(Debug, Default)]
pub(super) struct Moving {
    arriving: BTreeMap<u32, (u64, Vec<u8>)>,
    leaving: BTreeMap<u32, (u64, Vec<u8>)>,
}

impl Moving {
    /// Takes a piece. With the last one the robots are in the checkpoint.
    pub(super) fn attach(&mut self, robots: &Robots, to: &Checkpoints) -> Answer<Attached> {
        if robots.whole > MOST || robots.bytes.len() > PIECE {
            let words = format!("robots of {} bytes are too many", robots.whole);
            return Err(Said::Refused(words));
        }
        let (version, bytes) = self.arriving.entry(robots.actor).or_default();
        if *version != robots.version || robots.offset == 0 {
            (*version, *bytes) = (robots.version, Vec::new());
        }
        // A piece that comes again is there already.
        if robots.offset == bytes.len() as u64 {
            bytes.extend_from_slice(&robots.bytes);
        }
        let so_far = bytes.len() as u64;
        if so_far > robots.whole {
            self.arriving.remove(&robots.actor);
            return Err(Said::Refused("robots longer than they said".to_owned()));
        }
        if so_far == robots.whole {
            let (version, bytes) = self.arriving.remove(&robots.actor).unwrap_or_default();
            // As with an actor on this machine: a checkpoint without them is still a good checkpoint.
            match to.attach(version, &robots_of(robots.actor), &bytes) {
                Ok(()) => info!(actor = robots.actor, version, so_far, "robots saved"),
                Err(error) => {
                    warn!(actor = robots.actor, version, %error, "robots not saved");
                }
            }
        }
        Ok(Attached { so_far })
    }

    /// A piece of the robots of a checkpoint; none behind their end, and none where there are none.
    pub(super) fn fetch(&mut self, wanted: &RobotsWanted, from: &Checkpoints) -> Piece {
        let (version, bytes) = self.leaving.entry(wanted.actor).or_default();
        if *version != wanted.version || wanted.offset == 0 {
            let found = from.attachment(wanted.version, &robots_of(wanted.actor));
            let found = found.unwrap_or_else(|error| {
                warn!(actor = wanted.actor, version = wanted.version, %error, "robots not sent");
                None
            });
            (*version, *bytes) = (wanted.version, found.unwrap_or_default());
        }
        let from = usize::try_from(wanted.offset).unwrap_or(usize::MAX);
        let rest = bytes.get(from..).unwrap_or_default();
        let piece = rest[..rest.len().min(PIECE)].to_vec();
        if piece.len() < PIECE {
            self.leaving.remove(&wanted.actor);
        }
        Piece {
            bytes: piece.into(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn piece(offset: usize, whole: &[u8]) -> Robots {
        let rest = &whole[offset..];
        Robots {
            life: "life".to_owned(),
            actor: 3,
            version: 8,
            offset: offset as u64,
            whole: whole.len() as u64,
            bytes: rest[..rest.len().min(PIECE)].to_vec().into(),
        }
    }

    #[test]
    fn robots_arrive_in_pieces_and_leave_as_they_came() {
        let folder = tempfile::tempdir().unwrap();
        let checkpoints = Checkpoints::new(folder.path().to_owned());
        std::fs::create_dir_all(checkpoints.path(8)).unwrap();
        let whole: Vec<u8> = (0..PIECE + 1000).map(|i| (i % 251) as u8).collect();
        let mut moving = Moving::default();
        let so_far = |answer: Answer<Attached>| answer.unwrap().so_far as usize;
        assert_eq!(
            so_far(moving.attach(&piece(0, &whole), &checkpoints)),
            PIECE
        );
        // The answer was lost: the piece comes again.
        assert_eq!(
            so_far(moving.attach(&piece(0, &whole), &checkpoints)),
            PIECE
        );
        let done = moving.attach(&piece(PIECE, &whole), &checkpoints);
        assert_eq!(so_far(done), whole.len());
        let attached = checkpoints.attachment(8, "actor-3.bin").unwrap();
        assert!(attached.as_ref() == Some(&whole));

        let mut back = Vec::new();
        loop {
            let wanted = RobotsWanted {
                actor: 3,
                version: 8,
                offset: back.len() as u64,
                ..RobotsWanted::default()
            };
            let piece = moving.fetch(&wanted, &checkpoints).bytes;
            back.extend_from_slice(&piece);
            if piece.len() < PIECE {
                break;
            }
        }
        assert!(back == whole);
        let none = RobotsWanted {
            actor: 4,
            version: 8,
            ..RobotsWanted::default()
        };
        assert!(moving.fetch(&none, &checkpoints).bytes.is_empty());
    }

    #[test]
    fn robots_that_are_too_many_are_refused_before_any_memory_is_taken() {
        let folder = tempfile::tempdir().unwrap();
        let checkpoints = Checkpoints::new(folder.path().to_owned());
        let mut moving = Moving::default();
        let mut huge = piece(0, &[1, 2, 3]);
        huge.whole = 4 << 30;
        assert!(moving.attach(&huge, &checkpoints).is_err());
        let mut longer = piece(0, &[1, 2, 3]);
        longer.whole = 2;
        assert!(moving.attach(&longer, &checkpoints).is_err());
        assert!(moving.arriving.is_empty());
    }
}

//! Which host has which actors.
//!
//! An actor is a host's while the host is heard. Who was silent for [`LEASE`] has left: its roles are given up, so that
//! the learner no longer counts on them, and others may have the numbers.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

use hosts::{Figures, Join, Said};
use protocol::{MAX_ACTORS, Node, RolloutLayout, RolloutPublisher};
use run::journal::{Entry, Journal};
use run::{Folder, Lock};
use tracing::{info, warn};

use crate::known;

/// How long a host may be silent. A host says something every five seconds.
pub(super) const LEASE: Duration = Duration::from_secs(30);

/// An actor of another machine: its role, and its end of the stream.
#[derive(Debug)]
pub(super) struct Seat {
    pub(super) publisher: Mutex<RolloutPublisher>,
    _role: Lock,
}

/// A host, as long as it is heard.
#[derive(Debug)]
pub(super) struct Guest {
    name: String,
    from: String,
    seats: BTreeMap<u32, Arc<Seat>>,
    since: Instant,
    heard: Instant,
    pub(super) rollouts: u64,
    pub(super) bytes_in: u64,
    pub(super) bytes_out: u64,
    pub(super) figures: Figures,
}

/// Everything that is taken.
#[derive(Debug, Default)]
pub(super) struct Seats {
    /// By the host's stay.
    guests: BTreeMap<String, Guest>,
}

/// What a seat is made of.
pub(super) struct House<'a> {
    pub(super) folder: &'a Folder,
    pub(super) node: &'a Node,
    pub(super) layout: RolloutLayout,
    pub(super) patience: Duration,
    /// The first number that is not an actor's on this machine.
    pub(super) first: u32,
    pub(super) journal: &'a Mutex<Journal>,
}

impl Seats {
    /// Takes a host in, or hears it again: the numbers that it has, and as many more as it wants.
    pub(super) fn join(
        &mut self,
        from: &str,
        join: &Join,
        house: &House<'_>,
    ) -> Result<Vec<u32>, Said> {
        self.forget_silent();
        let now = Instant::now();
        let mut guest = self.guests.remove(&join.life).unwrap_or_else(|| Guest {
            name: join.host.clone(),
            from: String::new(),
            seats: BTreeMap::new(),
            since: now,
            heard: now,
            rollouts: 0,
            bytes_in: 0,
            bytes_out: 0,
            figures: Figures::default(),
        });
        (guest.from, guest.heard) = (from.to_owned(), now);
        let seated = guest.sit(join, house);
        let numbers: Vec<u32> = guest.seats.keys().copied().collect();
        info!(
            host = join.host,
            life = join.life,
            ?numbers,
            from,
            "a host joined"
        );
        self.guests.insert(join.life.clone(), guest);
        seated.map(|()| numbers)
    }

    /// The host of a stay, which is heard.
    pub(super) fn hear(&mut self, life: &str) -> Result<&mut Guest, Said> {
        let unknown =
            || Said::Unknown("this host was silent for too long; it joins again".to_owned());
        let guest = self.guests.get_mut(life).ok_or_else(unknown)?;
        guest.heard = Instant::now();
        Ok(guest)
    }

    /// The seat of a host's actor, which is heard.
    pub(super) fn seat(&mut self, life: &str, actor: u32) -> Result<Arc<Seat>, Said> {
        let guest = self.hear(life)?;
        let seat = guest.seats.get(&actor).cloned();
        seat.ok_or_else(|| Said::Unknown(format!("actor {actor} is not this host's")))
    }

    /// Lets actors of a host go, and the host with its last.
    pub(super) fn leave(&mut self, life: &str, numbers: &[u32]) {
        let Some(guest) = self.guests.get_mut(life) else {
            return;
        };
        guest.seats.retain(|number, _| !numbers.contains(number));
        info!(host = guest.name, ?numbers, "actors left");
        if guest.seats.is_empty() {
            self.guests.remove(life);
        }
    }

    /// Lets those go that were silent for too long.
    pub(super) fn forget_silent(&mut self) {
        self.guests.retain(|life, guest| {
            let stays = guest.heard.elapsed() < LEASE;
            if !stays {
                let numbers: Vec<&u32> = guest.seats.keys().collect();
                warn!(
                    host = guest.name,
                    life,
                    ?numbers,
                    "a host is silent and taken for gone"
                );
            }
            stays
        });
    }

    pub(super) fn is_empty(&self) -> bool {
        self.guests.is_empty()
    }

    pub(super) fn known(&self) -> Vec<known::Host> {
        self.guests.values().map(Guest::known).collect()
    }
}

impl Guest {
    /// Seats the actors that the host has, and new ones on the lowest free numbers.
    fn sit(&mut self, join: &Join, house: &House<'_>) -> Result<(), Said> {
        for number in &join.numbers {
            if self.seats.contains_key(number) {
                continue;
            }
            let role = format!("actor-{number}");
            let taken = || {
                Said::Refused(format!(
                    "actor {number} has become another's while this host was away: join again"
                ))
            };
            if *number < house.first || *number as usize >= MAX_ACTORS {
                return Err(taken());
            }
            let role = house.folder.lock(&role).map_err(|_| taken())?;
            self.take(*number, role, house)?;
        }
        while self.seats.len() < join.actors as usize {
            let free = house.folder.lock_free_actor(house.first);
            let (number, role) = free.map_err(|error| Said::Refused(error.to_string()))?;
            if number as usize >= MAX_ACTORS {
                return Err(Said::Refused(format!(
                    "the run is full: at most {MAX_ACTORS} actors"
                )));
            }
            self.take(number, role, house)?;
        }
        // A host that comes back with fewer actors gives the others up.
        while join.actors > 0 && self.seats.len() > join.actors as usize {
            self.seats.pop_last();
        }
        Ok(())
    }

    fn take(&mut self, number: u32, mut role: Lock, house: &House<'_>) -> Result<(), Said> {
        role.stand_for(&format!("on {}", self.name));
        let publisher = RolloutPublisher::new(house.node, number, house.layout, house.patience)
            .map_err(|error| Said::Refused(format!("a place for actor {number}: {error}")))?;
        let mut journal = house.journal.lock().unwrap_or_else(PoisonError::into_inner);
        journal.write(|| Entry::Passing(number));
        let seat = Seat {
            publisher: Mutex::new(publisher),
            _role: role,
        };
        self.seats.insert(number, Arc::new(seat));
        Ok(())
    }

    fn known(&self) -> known::Host {
        known::Host {
            host: self.name.clone(),
            from: self.from.clone(),
            actors: self.seats.keys().copied().collect(),
            seconds: self.since.elapsed().as_secs_f64(),
            silent_seconds: self.heard.elapsed().as_secs_f64(),
            rollouts: self.rollouts,
            bytes_in: self.bytes_in,
            bytes_out: self.bytes_out,
            resent: self.figures.resent,
            reconnects: self.figures.reconnects,
            acknowledgement_seconds: self.figures.acknowledgement_seconds,
        }
    }
}

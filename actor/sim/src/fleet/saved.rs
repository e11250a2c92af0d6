//! A fleet saved and restored, bit by bit.

use super::Fleet;
use crate::env::Environment;
use crate::error::SimError;
use crate::event::lot::Lot;
use crate::physics::SavedBodies;
use serde::{Deserialize, Serialize};

/// What a snapshot holds: all that a continuation depends on, configuration aside.
#[derive(Serialize, Deserialize)]
struct Snapshot<E, F> {
    bodies: SavedBodies,
    environments: E,
    observations: F,
    critic: F,
    features: F,
    faults: u64,
}

impl Fleet {
    /// Everything that the future depends on, configuration aside.
    pub fn save(&self) -> Vec<u8> {
        let snapshot = Snapshot {
            bodies: self.bodies.save(),
            environments: &self.environments,
            observations: &self.observations,
            critic: &self.critic,
            features: &self.features,
            faults: self.faults,
        };
        let written = "every part of a fleet can be written to memory";
        let mut bytes =
            bincode::serde::encode_to_vec(&snapshot, bincode::config::standard()).expect(written);
        let lots: Vec<Option<&Lot>> = self.environments.iter().map(Environment::lot).collect();
        // Where nothing befalls anybody there is no such part, and a snapshot of before is read as ever.
        if lots.iter().any(Option::is_some) {
            let lots = bincode::serde::encode_to_vec(&lots, bincode::config::standard());
            bytes.extend(lots.expect(written));
        }
        bytes
    }

    /// Continues, bit by bit, where [`Fleet::save`] was called on a fleet of the same configuration.
    /// On an error the fleet stays as it was.
    pub fn restore(&mut self, bytes: &[u8]) -> Result<(), SimError> {
        let decoded = bincode::serde::decode_from_slice(bytes, bincode::config::standard());
        let unread = |source| SimError::Snapshot {
            bytes: bytes.len(),
            source,
        };
        let (snapshot, read): (Snapshot<Vec<Environment>, Vec<f32>>, usize) =
            decoded.map_err(unread)?;
        let lots: Vec<Option<Lot>> = match &bytes[read..] {
            [] => vec![None; snapshot.environments.len()],
            rest => {
                let decoded = bincode::serde::decode_from_slice(rest, bincode::config::standard());
                decoded.map_err(unread)?.0
            }
        };
        if !lots.iter().flatten().all(Lot::is_sound) {
            return Err(SimError::Program);
        }
        let (found, expected) = (snapshot.environments.len(), self.len());
        let widths = self.setting.tables.widths();
        let whole = snapshot.observations.len() == found * widths.observation
            && snapshot.critic.len() == found * widths.critic
            && snapshot.features.len() == found * widths.features;
        if found != expected || lots.len() != found || !whole {
            return Err(SimError::Count { found, expected });
        }
        let (found, expected) = (snapshot.bodies.physics(), self.physics);
        if found != expected {
            return Err(SimError::Engine { found, expected });
        }
        if !self.bodies.restore(snapshot.bodies) {
            return Err(SimError::Program);
        }
        self.environments = snapshot.environments;
        for (index, (environment, lot)) in self.environments.iter_mut().zip(lots).enumerate() {
            environment.resume(lot, &mut self.bodies, index);
        }
        self.observations = snapshot.observations;
        self.critic = snapshot.critic;
        self.features = snapshot.features;
        self.faults = snapshot.faults;
        self.forget_last_steps();
        Ok(())
    }
}

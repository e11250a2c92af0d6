//! Past policy transitions, so that the discriminator does not forget what the policy no longer does.

use crate::TRANSITION;
use rand::{Rng, RngExt};
use serde::{Deserialize, Serialize};

/// A ring of transitions; a full one overwrites its oldest.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Replay {
    capacity: usize,
    /// Where the next transition goes.
    next: usize,
    /// `[transition][106]`, as many as were inserted up to the capacity.
    rows: Vec<f32>,
}

impl Replay {
    /// An empty ring of `capacity` transitions.
    pub fn new(capacity: usize) -> Self {
        Self {
            capacity,
            next: 0,
            rows: Vec::new(),
        }
    }

    /// Transitions held.
    pub fn len(&self) -> usize {
        self.rows.len() / TRANSITION
    }

    /// Whether nothing was inserted yet.
    pub fn is_empty(&self) -> bool {
        self.rows.is_empty()
    }

    /// Transitions that it can hold.
    pub fn capacity(&self) -> usize {
        self.capacity
    }

    /// Whether its parts fit each other; a decoded one may lie.
    pub(crate) fn is_sound(&self) -> bool {
        self.rows.len().is_multiple_of(TRANSITION)
            && self.len() <= self.capacity
            && (self.next == self.len()
                || (self.len() == self.capacity && self.next < self.capacity))
    }

    /// The same memory with another capacity; of too many transitions the newest stay.
    pub(crate) fn with_capacity(self, capacity: usize) -> Self {
        if capacity == self.capacity {
            return self;
        }
        let mut resized = Self::new(capacity);
        let oldest = if self.next < self.len() { self.next } else { 0 };
        let (newer, older) = self.rows.split_at(oldest * TRANSITION);
        for row in older
            .chunks_exact(TRANSITION)
            .chain(newer.chunks_exact(TRANSITION))
        {
            resized.insert(row);
        }
        resized
    }

    /// Remembers one transition.
    pub fn insert(&mut self, transition: &[f32]) {
        if self.next == self.capacity {
            self.next = 0;
        }
        if self.next == self.len() {
            self.rows.extend_from_slice(transition);
        } else {
            self.rows[self.next * TRANSITION..][..TRANSITION].copy_from_slice(transition);
        }
        self.next += 1;
    }

    /// A transition drawn uniformly.
    ///
    /// # Panics
    /// If it is empty.
    pub fn draw(&self, rng: &mut (impl Rng + ?Sized)) -> &[f32] {
        let i = rng.random_range(0..self.len());
        &self.rows[i * TRANSITION..][..TRANSITION]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng;

    #[test]
    fn the_oldest_is_overwritten() {
        let mut replay = Replay::new(3);
        let firsts = |replay: &Replay| -> Vec<f32> {
            replay.rows.chunks(TRANSITION).map(|row| row[0]).collect()
        };
        for i in 1..=2 {
            replay.insert(&[i as f32; TRANSITION]);
        }
        assert_eq!(firsts(&replay), [1.0, 2.0]);
        for i in 3..=5 {
            replay.insert(&[i as f32; TRANSITION]);
            assert!(replay.is_sound());
        }
        assert_eq!(firsts(&replay), [4.0, 5.0, 3.0]);
        assert_eq!(replay.len(), 3);
    }

    #[test]
    fn another_capacity_keeps_the_newest() {
        let mut replay = Replay::new(3);
        (1..=5).for_each(|i| replay.insert(&[i as f32; TRANSITION]));
        let firsts = |replay: &Replay| -> Vec<f32> {
            replay.rows.chunks(TRANSITION).map(|row| row[0]).collect()
        };
        assert_eq!(firsts(&replay.clone().with_capacity(9)), [3.0, 4.0, 5.0]);
        assert_eq!(firsts(&replay.with_capacity(2)), [5.0, 4.0]);
    }

    #[test]
    fn draws_reach_all_about_equally() {
        let mut replay = Replay::new(4);
        (0..4).for_each(|i| replay.insert(&[i as f32; TRANSITION]));
        let mut rng = rand_pcg::Pcg64::seed_from_u64(5);
        let mut counts = [0; 4];
        for _ in 0..4000 {
            counts[replay.draw(&mut rng)[0] as usize] += 1;
        }
        // 1000 each, standard deviation √(4000·¼·¾) = 27
        assert!(
            counts.iter().all(|count| (900..1100).contains(count)),
            "{counts:?}"
        );
    }
}

//! Past policy windows, so that the discriminator does not forget what the policy no longer does.

use rand::{Rng, RngExt};
use serde::{Deserialize, Serialize};

/// A ring of windows; a full one overwrites its oldest.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Replay {
    capacity: usize,
    /// Numbers of a window.
    width: usize,
    /// Where the next one goes.
    next: usize,
    /// `[window][frames][features]`, as many as were inserted up to the capacity.
    rows: Vec<f32>,
}

impl Replay {
    /// An empty ring of `capacity` windows of `width` numbers.
    pub fn new(capacity: usize, width: usize) -> Self {
        Self {
            capacity,
            width,
            next: 0,
            rows: Vec::new(),
        }
    }

    /// Windows held.
    pub fn len(&self) -> usize {
        self.rows.len() / self.width
    }

    /// Whether nothing was inserted yet.
    pub fn is_empty(&self) -> bool {
        self.rows.is_empty()
    }

    /// Numbers of a window.
    pub fn width(&self) -> usize {
        self.width
    }

    /// Windows that it can hold.
    pub fn capacity(&self) -> usize {
        self.capacity
    }

    /// Whether its parts fit each other; a decoded one may lie.
    pub(crate) fn is_sound(&self, width: usize) -> bool {
        self.width == width
            && self.rows.len().is_multiple_of(self.width)
            && self.len() <= self.capacity
            && (self.next == self.len()
                || (self.len() == self.capacity && self.next < self.capacity))
    }

    /// The same memory with another capacity; of too many windows the newest stay.
    pub(crate) fn with_capacity(self, capacity: usize) -> Self {
        if capacity == self.capacity {
            return self;
        }
        let mut resized = Self::new(capacity, self.width);
        let oldest = if self.next < self.len() { self.next } else { 0 };
        let (newer, older) = self.rows.split_at(oldest * self.width);
        for row in older
            .chunks_exact(self.width)
            .chain(newer.chunks_exact(self.width))
        {
            resized.insert(row);
        }
        resized
    }

    /// Remembers one window.
    pub fn insert(&mut self, window: &[f32]) {
        if self.next == self.capacity {
            self.next = 0;
        }
        if self.next == self.len() {
            self.rows.extend_from_slice(window);
        } else {
            self.rows[self.next * self.width..][..self.width].copy_from_slice(window);
        }
        self.next += 1;
    }

    /// A window drawn uniformly.
    ///
    /// # Panics
    /// If it is empty.
    pub fn draw(&self, rng: &mut (impl Rng + ?Sized)) -> &[f32] {
        let i = rng.random_range(0..self.len());
        &self.rows[i * self.width..][..self.width]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng;

    const WIDTH: usize = 3;

    #[test]
    fn the_oldest_is_overwritten() {
        let mut replay = Replay::new(3, WIDTH);
        let firsts =
            |replay: &Replay| -> Vec<f32> { replay.rows.chunks(WIDTH).map(|row| row[0]).collect() };
        for i in 1..=2 {
            replay.insert(&[i as f32; WIDTH]);
        }
        assert_eq!(firsts(&replay), [1.0, 2.0]);
        for i in 3..=5 {
            replay.insert(&[i as f32; WIDTH]);
            assert!(replay.is_sound(WIDTH));
        }
        assert_eq!(firsts(&replay), [4.0, 5.0, 3.0]);
        assert_eq!(replay.len(), 3);
    }

    #[test]
    fn another_capacity_keeps_the_newest() {
        let mut replay = Replay::new(3, WIDTH);
        (1..=5).for_each(|i| replay.insert(&[i as f32; WIDTH]));
        let firsts =
            |replay: &Replay| -> Vec<f32> { replay.rows.chunks(WIDTH).map(|row| row[0]).collect() };
        assert_eq!(firsts(&replay.clone().with_capacity(9)), [3.0, 4.0, 5.0]);
        assert_eq!(firsts(&replay.with_capacity(2)), [5.0, 4.0]);
    }

    #[test]
    fn draws_reach_all_about_equally() {
        let mut replay = Replay::new(4, WIDTH);
        (0..4).for_each(|i| replay.insert(&[i as f32; WIDTH]));
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

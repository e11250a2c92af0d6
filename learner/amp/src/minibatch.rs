//! Which rows a step takes, in which order, and which of them mirrored.

use rand::{Rng, RngExt};

/// A permutation of all rows that is shuffled anew for each epoch.
#[derive(Clone, Debug, Default)]
pub(crate) struct Order {
    rows: Vec<usize>,
}

impl Order {
    /// Rows 0 to `count` in a new random order (Fisher–Yates), whatever the order was.
    pub(crate) fn shuffle(&mut self, count: usize, rng: &mut (impl Rng + ?Sized)) -> &[usize] {
        self.rows.clear();
        self.rows.extend(0..count);
        for i in (1..count).rev() {
            self.rows.swap(i, rng.random_range(0..=i));
        }
        &self.rows
    }
}

/// Minibatches of an epoch: as even as they can be, none larger than `size`.
pub(crate) fn split(rows: &[usize], size: usize) -> impl Iterator<Item = &[usize]> {
    let count = rows.len().div_ceil(size);
    (0..count).map(move |i| &rows[networks::shards::part(rows.len(), i, count)])
}

/// Whether the row at `position` of `count` is taken mirrored: evenly spread, `share` of all.
pub(crate) fn is_mirrored(position: usize, share: f32) -> bool {
    let share = f64::from(share);
    ((position + 1) as f64 * share).floor() > (position as f64 * share).floor()
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng;

    #[test]
    fn an_epoch_takes_every_row_once() {
        let mut order = Order::default();
        let mut rng = rand_pcg::Pcg64::seed_from_u64(1);
        let first = order.shuffle(10, &mut rng).to_vec();
        let second = order.shuffle(10, &mut rng).to_vec();
        assert_ne!(first, second);
        let mut sorted = second.clone();
        sorted.sort_unstable();
        assert_eq!(sorted, (0..10).collect::<Vec<_>>());
        let sizes: Vec<_> = split(&second, 4).map(<[usize]>::len).collect();
        assert_eq!(sizes, [3, 3, 4]);
        assert_eq!(split(&second, 100).count(), 1);
    }

    #[test]
    fn the_share_of_mirrored_rows_is_exact() {
        let taken = |share| (0..100).filter(|i| is_mirrored(*i, share)).count();
        assert_eq!(
            [taken(0.0), taken(0.25), taken(0.5), taken(1.0)],
            [0, 25, 50, 100]
        );
    }
}

//! Rows divided among threads.
//!
//! The number of shards is the caller's choice, never the machine's: sums over shards are made in the order of shards,
//! so the same number gives the same bits anywhere. Threads live for one call; the first shard stays on the caller's.

use std::ops::{AddAssign, Range};
use std::thread;

/// Rows of shard `index` of `count`: contiguous, sizes differing by at most one.
pub fn part(rows: usize, index: usize, count: usize) -> Range<usize> {
    rows * index / count..rows * (index + 1) / count
}

/// Pieces of a range, each `length` long but the last.
pub fn pieces(range: Range<usize>, length: usize) -> impl Iterator<Item = Range<usize>> {
    let end = range.end;
    range
        .step_by(length)
        .map(move |start| start..(start + length).min(end))
}

/// Calls `work(index, state)` for every state, side by side; results in the order of states.
///
/// # Panics
/// If a call panics.
pub fn run<S: Send, R: Send>(states: &mut [S], work: impl Fn(usize, &mut S) -> R + Sync) -> Vec<R> {
    let Some((first, others)) = states.split_first_mut() else {
        return Vec::new();
    };
    thread::scope(|scope| {
        let work = &work;
        let handles: Vec<_> = others
            .iter_mut()
            .enumerate()
            .map(|(i, state)| scope.spawn(move || work(i + 1, state)))
            .collect();
        let mut results = vec![work(0, first)];
        results.extend(
            handles
                .into_iter()
                .map(|handle| handle.join().expect("a shard panicked")),
        );
        results
    })
}

/// Calls `work` for each of `count` shards of `rows`, side by side, and adds up the results in the order of shards.
///
/// # Panics
/// If a call panics.
pub fn total<R: Default + AddAssign + Send>(
    rows: usize,
    count: usize,
    work: impl Fn(Range<usize>) -> R + Sync,
) -> R {
    let mut states = vec![(); count];
    let mut parts = run(&mut states, |i, ()| work(part(rows, i, count))).into_iter();
    let mut total = parts.next().unwrap_or_default();
    parts.for_each(|part| total += part);
    total
}

/// Adds a shard's gradient to another's, number by number.
pub fn add(sum: &mut [f32], part: &[f32]) {
    sum.iter_mut().zip(part).for_each(|(sum, x)| *sum += x);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_cover_all_rows_once() {
        let parts: Vec<_> = (0..3).map(|i| part(10, i, 3)).collect();
        assert_eq!(parts, [0..3, 3..6, 6..10]);
        assert_eq!(pieces(3..10, 4).collect::<Vec<_>>(), [3..7, 7..10]);
    }

    #[test]
    fn totals_are_of_all_rows() {
        // 0 + 1 + … + 9 = 45, whoever adds what
        let sum = |count| total(10, count, |rows| rows.sum::<usize>());
        assert_eq!([1, 3, 10].map(sum), [45; 3]);
        let mut sum = [1.0, 2.0];
        add(&mut sum, &[0.5, -2.0]);
        assert_eq!(sum, [1.5, 0.0]);
    }

    #[test]
    fn results_keep_the_order_of_states() {
        let mut states = [10, 20, 30];
        let results = run(&mut states, |i, state| {
            *state += i;
            *state
        });
        assert_eq!((results, states), (vec![10, 21, 32], [10, 21, 32]));
        assert!(run(&mut [0; 0], |_, _| ()).is_empty());
    }
}

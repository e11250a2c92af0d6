//! The joints of a limb over a whole clip: what each frame asks for, without snaps.
//!
//! Separate because a frame alone cannot know that a solution jumps. The cost is that of the frames plus
//! that of every second difference, so a limb that is nearly straight, where a millimetre is many
//! degrees, gives up the millimetre. Steps are those of Gauss and Newton, damped until the cost falls:
//! a worse path is never kept. Long clips are solved in windows that look ahead.

use crate::banded::{self, Row};
use crate::limb::{Chain, Normal};
use nalgebra::SVector;

/// Weight of a squared second difference, rad² per frame⁴.
const BEND: f64 = 3.0;
/// Second difference from which on it weighs more, rad a frame², and how much more.
const SHARP: f64 = 0.085;
const SHARP_WEIGHT: f64 = 1000.0;
/// Frames that are solved at once, and those beyond that are solved with them and again.
const WINDOW: usize = 240;
const AHEAD: usize = 40;
const STEPS: usize = 30;
/// Change of all joints below which a window is done, rad.
const DONE: f64 = 4e-3;

/// Smooths a path of joint positions in place; `task` gives the normal equations of a frame.
pub(crate) fn smooth<const N: usize>(
    chain: &Chain<N>,
    path: &mut [SVector<f64, N>],
    task: &impl Fn(usize, &SVector<f64, N>) -> Normal<N>,
) {
    for first in (0..path.len()).step_by(WINDOW) {
        let end = (first + WINDOW + AHEAD).min(path.len());
        let begin = first.saturating_sub(2);
        settle(chain, &mut path[begin..end], first - begin, &|i, q| {
            task(begin + i, q)
        });
    }
}

/// Solves the frames from `first` on; those before it, two at most, stay.
fn settle<const N: usize>(
    chain: &Chain<N>,
    path: &mut [SVector<f64, N>],
    first: usize,
    task: &impl Fn(usize, &SVector<f64, N>) -> Normal<N>,
) {
    let (mut rows, mut cost) = equations(path, first, task);
    let mut damping = 1e-4;
    for _ in 0..STEPS {
        let Some(step) = banded::solve(&bounded(chain, &path[first..], &rows, damping)) else {
            damping *= 10.0;
            continue;
        };
        let mut trial = path.to_vec();
        for (q, step) in trial[first..].iter_mut().zip(&step) {
            *q = chain.clamped(&(*q + step));
        }
        let (next, then) = equations(&trial, first, task);
        if then < cost {
            let change = (first..path.len()).map(|i| (trial[i] - path[i]).amax());
            let change = change.fold(0.0, f64::max);
            path.copy_from_slice(&trial);
            (rows, cost) = (next, then);
            damping = f64::max(0.1 * damping, 1e-6);
            if change < DONE {
                return;
            }
        } else if damping > 1e4 {
            return;
        } else {
            damping *= 10.0;
        }
    }
}

/// The rows of the frames from `first` on, and the cost.
fn equations<const N: usize>(
    path: &[SVector<f64, N>],
    first: usize,
    task: &impl Fn(usize, &SVector<f64, N>) -> Normal<N>,
) -> (Vec<Row<N>>, f64) {
    let mut rows = vec![Row::new(); path.len() - first];
    let mut cost = 0.0;
    for (row, i) in rows.iter_mut().zip(first..) {
        let normal = task(i, &path[i]);
        row.own = normal.matrix;
        row.right = normal.right;
        cost += normal.cost;
    }
    // Second differences that end in frame i.
    for i in first.max(2)..path.len() {
        let bend = path[i] - path[i - 1] * 2.0 + path[i - 2];
        for k in 0..N {
            let over = bend[k] - bend[k].clamp(-SHARP, SHARP);
            let weight = BEND + if over == 0.0 { 0.0 } else { SHARP_WEIGHT };
            let pull = BEND * bend[k] + SHARP_WEIGHT * over;
            cost += BEND * bend[k] * bend[k] + SHARP_WEIGHT * over * over;
            for (back, by) in [(0, 1.0), (1, -2.0), (2, 1.0)] {
                if i >= first + back {
                    rows[i - first - back].own[(k, k)] += weight * by * by;
                    rows[i - first - back].right[k] -= pull * by;
                }
            }
            let row = i - first;
            rows[row].before[k] -= 2.0 * weight;
            rows[row].earlier[k] += weight;
            if row >= 1 {
                rows[row - 1].before[k] -= 2.0 * weight;
            }
        }
    }
    (rows, cost)
}

/// The rows damped, with joints that a bound holds taken out.
fn bounded<const N: usize>(
    chain: &Chain<N>,
    path: &[SVector<f64, N>],
    rows: &[Row<N>],
    damping: f64,
) -> Vec<Row<N>> {
    let mut rows = rows.to_vec();
    for (i, q) in path.iter().enumerate() {
        for k in 0..N {
            if chain.held(k, q[k], rows[i].right[k]) {
                let row = &mut rows[i];
                row.own.row_mut(k).fill(0.0);
                row.own.column_mut(k).fill(0.0);
                row.own[(k, k)] = 1.0;
                (row.right[k], row.before[k], row.earlier[k]) = (0.0, 0.0, 0.0);
                if let Some(next) = rows.get_mut(i + 1) {
                    next.before[k] = 0.0;
                }
                if let Some(after) = rows.get_mut(i + 2) {
                    after.earlier[k] = 0.0;
                }
            } else {
                let own = &mut rows[i].own[(k, k)];
                *own += damping * (1.0 + *own);
            }
        }
    }
    rows
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::limb::ARMS;

    type Arm = SVector<f64, 5>;

    /// A frame that asks for a position of all joints and nothing else.
    fn near(wanted: impl Fn(usize) -> f64) -> impl Fn(usize, &Arm) -> Normal<5> {
        move |i, q| {
            let mut normal = Normal::new();
            normal.stay(q, &Arm::repeat(wanted(i)), 2.0);
            normal
        }
    }

    fn bends(path: &[Arm]) -> f64 {
        let bend = |three: &[Arm]| (three[0] - three[1] * 2.0 + three[2]).amax();
        path.windows(3).map(bend).fold(0.0, f64::max)
    }

    #[test]
    fn a_step_becomes_a_slope_without_a_snap() {
        let chain = Chain::<5>::new(ARMS[0]);
        let task = near(|i| if i < 30 { 0.0 } else { 0.5 });
        let mut path: Vec<Arm> = (0..60)
            .map(|i| Arm::repeat(if i < 30 { 0.0 } else { 0.5 }))
            .collect();
        smooth(&chain, &mut path, &task);
        assert!(bends(&path) < 1.1 * SHARP, "{}", bends(&path));
        assert!(path[5].amax() < 0.02 && (path[55][0] - 0.5).abs() < 0.02);
    }

    #[test]
    fn a_slow_motion_is_left_as_it_is() {
        let chain = Chain::<5>::new(ARMS[0]);
        let wave = |i: usize| 0.3 * (0.06 * i as f64).sin(); // half a hertz
        let mut path = vec![Arm::zeros(); 600];
        smooth(&chain, &mut path, &near(wave));
        for (i, q) in path.iter().enumerate().skip(20).take(560) {
            // BEND/2 times 0.06⁴ is 2e-5 of the amplitude.
            assert!((q[0] - wave(i)).abs() < 1e-4, "{i}: {q} is not {}", wave(i));
        }
    }

    #[test]
    fn bounds_hold_and_are_reached() {
        let chain = Chain::<5>::new(ARMS[0]);
        let mut path = vec![Arm::zeros(); 100];
        smooth(&chain, &mut path, &near(|_| 9.0));
        assert_eq!(path[50], chain.upper);
    }

    /// A task with steep walls: a full step from the start makes it worse.
    #[test]
    fn a_worse_path_is_never_kept() {
        let chain = Chain::<5>::new(ARMS[0]);
        let lying = |_: usize, q: &Arm| {
            let mut normal = Normal::new();
            normal.stay(q, &Arm::repeat(0.3), 1.0);
            normal.right *= 40.0; // steps forty times too long
            normal
        };
        let start = vec![Arm::repeat(0.2); 20];
        let cost = |path: &[Arm]| equations(path, 0, &lying).1;
        let mut path = start.clone();
        smooth(&chain, &mut path, &lying);
        assert!(cost(&path) <= cost(&start));
        assert!((path[10][0] - 0.3).abs() < 0.1, "{}", path[10]);
    }
}

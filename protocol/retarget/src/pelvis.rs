//! How the pelvis is carried: where the standing legs have the lengths that the human's have.
//!
//! Separate because it decides the knees. A leg that is nearly straight changes its length by a fifth of
//! a millimetre in the last three degrees, so a pelvis that is a few millimetres too far away snaps
//! the knee open and one too near folds it. The pelvis therefore gives way, smoothly, and
//! the feet stay where they are planted.

use crate::banded::{self, Row};
use crate::limb::{ANKLE, Chain, HIP, LEGS};
use crate::posture::{Free, Soles};
use crate::{signal, sole};
use nalgebra::{Isometry3, Matrix3, SVector, Vector3};

/// A planted leg is not asked to be straighter than this, rad: at 0 its length says nothing of its knee.
const STRAIGHTEST: f64 = 0.07;
/// Weights: of a shift by axis, of its squared second difference; that of a leg's length is 1 at
/// [`USUAL_SLOPE`]. The pelvis rises and falls freely; over the ground it stays
/// about where the human's balance has it.
const STAY: [f64; 3] = [0.15, 0.15, 2e-3];
const BEND: f64 = 5.0;
/// How much more a leg that is too long for its knee weighs than one that is too short.
const STRETCHED: f64 = 4.0;
/// Change of a leg's length with its knee that has weight 1, m/rad, and the bounds of the weight.
const USUAL_SLOPE: f64 = 0.03;
const SLOPE_WEIGHTS: (f64, f64) = (0.25, 9.0);
/// Gaussian over the height that the ground asks for, frames.
const SMOOTHING: f64 = 3.0;
/// How much less a foot on its edge says: it may tip more or less.
const LOOSE: f64 = 0.7;
/// A leg that is too long by more than this has a foot that is not to be reached, m.
const MOST: f64 = 0.08;
const ROUNDS: usize = 4;

/// The pelvis' way against that of the targets.
pub(crate) struct Carried {
    /// What is added to its place in each frame, m.
    pub(crate) shift: Vec<Vector3<f64>>,
    /// Most that it was lowered because a leg did not reach, m.
    pub(crate) lowered: f64,
}

/// Carries the pelvis so that legs on planted soles are as bent as directions alone have them.
pub(crate) fn carry(free: &[Free], soles: &[Soles; 2]) -> Carried {
    let raise = raised(free, soles);
    let longest = length(STRAIGHTEST);
    let stay = Vector3::from(STAY);
    let mut shift = vec![Vector3::zeros(); free.len()];
    for _ in 0..ROUNDS {
        let mut rows = vec![Row::<3>::new(); free.len()];
        for (i, row) in rows.iter_mut().enumerate() {
            row.own = Matrix3::from_diagonal(&stay);
            row.right = -shift[i].component_mul(&stay);
            let carried = shift[i] + Vector3::new(0.0, 0.0, raise[i]);
            for (s, soles) in soles.iter().enumerate() {
                if let Some(sole) = &soles[i] {
                    let (hip, ankle) = (free[i].hips[s], free[i].ankles[s]);
                    let weight = 1.0 - LOOSE * sole::tipped(&sole.rotation);
                    let now = ankle_of(sole) - hip - carried;
                    fit(row, &(ankle - hip), &now, (weight, longest));
                }
            }
        }
        bend(&mut rows, &shift);
        let steps = banded::solve(&rows).expect("STAY makes the system positive definite");
        for (shift, step) in shift.iter_mut().zip(steps) {
            *shift += step;
        }
    }
    let mut carried: Vec<Vector3<f64>> = shift
        .iter()
        .zip(&raise)
        .map(|(shift, raise)| shift + Vector3::new(0.0, 0.0, *raise))
        .collect();
    let excess: Vec<f64> = (0..free.len())
        .map(|i| {
            let beyond = |s: usize| {
                let hip = free[i].hips[s] + carried[i];
                soles[s][i].map_or(0.0, |sole| beyond(&(ankle_of(&sole) - hip), longest))
            };
            beyond(0).max(beyond(1))
        })
        .collect();
    for (carried, lower) in carried.iter_mut().zip(signal::envelope(&excess, 8)) {
        carried.z -= lower;
    }
    let lowered = carried
        .iter()
        .zip(&raise)
        .map(|(carried, raise)| raise - carried.z)
        .fold(0.0, f64::max);
    Carried {
        shift: carried,
        lowered,
    }
}

/// Adds to a frame that a leg from hip to ankle, which is `now`, shall be as long as it is in `free`.
fn fit(row: &mut Row<3>, free: &Vector3<f64>, now: &Vector3<f64>, (share, longest): (f64, f64)) {
    let wanted = free.norm().min(longest);
    let along = now.normalize();
    let too_long = (now.norm() - wanted).min(MOST);
    let mut weight = (USUAL_SLOPE / slope(wanted)).powi(2);
    weight = share * weight.clamp(SLOPE_WEIGHTS.0, SLOPE_WEIGHTS.1);
    if too_long > 0.0 {
        weight *= STRETCHED;
    }
    row.own += along * along.transpose() * weight;
    row.right += along * (weight * too_long);
}

/// Adds that second differences shall be small.
fn bend(rows: &mut [Row<3>], shift: &[Vector3<f64>]) {
    for i in 2..rows.len() {
        let bend = shift[i] - shift[i - 1] * 2.0 + shift[i - 2];
        for (back, by) in [(0, 1.0), (1, -2.0), (2, 1.0)] {
            rows[i - back].own += Matrix3::identity() * (BEND * by * by);
            rows[i - back].right -= bend * (BEND * by);
        }
        rows[i].before -= Vector3::repeat(2.0 * BEND);
        rows[i - 1].before -= Vector3::repeat(2.0 * BEND);
        rows[i].earlier += Vector3::repeat(BEND);
    }
}

/// How much the pelvis must rise so that the standing foot which asks for less reaches the ground.
fn raised(free: &[Free], soles: &[Soles; 2]) -> Vec<f64> {
    let asked: Vec<Option<f64>> = (0..free.len())
        .map(|i| {
            let need = |s: usize| {
                soles[s][i].map(|sole| sole.translation.z - free[i].feet[s].translation.z)
            };
            [need(0), need(1)].into_iter().flatten().reduce(f64::min)
        })
        .collect();
    let mut lows: Vec<f64> = free
        .iter()
        .flat_map(|f| f.feet)
        .map(|foot| -(foot.translation.z + sole::lowest(&foot.rotation)))
        .collect();
    // A clip in which no foot ever stands: the lowest twentieth touches the ground.
    let otherwise = signal::quantile(&mut lows, 0.95);
    signal::gaussian(&signal::filled(&asked, otherwise), SMOOTHING)
}

/// How far a leg from a hip to a foot is beyond its reach: what the foot is to be moved by, m.
pub(crate) fn overreach(hip: &Vector3<f64>, foot: &Isometry3<f64>) -> Vector3<f64> {
    let leg = ankle_of(foot) - hip;
    leg.normalize() * (length(STRAIGHTEST) - leg.norm()).min(0.0)
}

/// Origin of the ankle pitch joint over a level foot, m.
fn ankle_of(foot: &Isometry3<f64>) -> Vector3<f64> {
    let above = -g1::JOINT_TABLE[LEGS[0] + ANKLE + 1].origin[2];
    foot.translation.vector + foot.rotation * Vector3::new(0.0, 0.0, above)
}

/// How much lower the hip must be for the ankle to be within reach, m; at most [`MOST`].
fn beyond(leg: &Vector3<f64>, longest: f64) -> f64 {
    let reach = (longest * longest - leg.xy().norm_squared())
        .max(0.0)
        .sqrt();
    (-leg.z - reach).clamp(0.0, MOST)
}

/// Hip roll joint to ankle pitch joint when the knee is bent by an angle, m.
fn length(knee: f64) -> f64 {
    let [thigh, shin] = bones();
    (thigh * thigh + shin * shin + 2.0 * thigh * shin * knee.cos()).sqrt()
}

/// How much a leg of a length shortens when its knee bends, m/rad.
fn slope(length: f64) -> f64 {
    let [thigh, shin] = bones();
    let cos = (length * length - thigh * thigh - shin * shin) / (2.0 * thigh * shin);
    thigh * shin * (1.0 - cos.clamp(-1.0, 1.0).powi(2)).sqrt() / length
}

/// Lengths of thigh and shin, m.
fn bones() -> [f64; 2] {
    let pose = Chain::<6>::new(LEGS[0]).pose(&Isometry3::identity(), &SVector::zeros());
    let length = |(from, to): (usize, usize)| (pose.origin(to) - pose.origin(from)).norm();
    debug_assert_eq!(crate::limb::BONES[0].0, HIP);
    crate::limb::BONES.map(length)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::FRAC_PI_2;

    /// A standing robot of level feet with the hips at a height over them, m, its sole planted at `up`.
    fn standing(frames: usize, height: f64, up: f64) -> (Vec<Free>, [Soles; 2]) {
        let at = |z: f64| [0.1, -0.1].map(|y| Vector3::new(0.0, y, z));
        let foot = |z: f64| at(z).map(|place| Isometry3::from_parts(place.into(), nalgebra::one()));
        let free = Free {
            feet: foot(0.035),
            hips: at(height),
            ankles: at(0.035 + 0.017558),
        };
        let soles = foot(0.035 + up).map(|sole| vec![Some(sole); frames]);
        (vec![free; frames], soles)
    }

    #[test]
    fn a_leg_is_as_long_as_its_triangle() {
        let [thigh, shin] = bones();
        // Hip roll to knee: 0.30146/cos 10.02° m by the table of joints, and 2 mm across.
        assert!((thigh - 0.30614).abs() < 1e-4 && (shin - 0.30001).abs() < 1e-5);
        assert!((length(0.0) - thigh - shin).abs() < 1e-12);
        assert!((length(FRAC_PI_2).powi(2) - thigh * thigh - shin * shin).abs() < 1e-12);
        let change = (length(0.5 - 1e-6) - length(0.5 + 1e-6)) / 2e-6;
        assert!((slope(length(0.5)) - change).abs() < 1e-8);
        // Three degrees from straight are a fifth of a millimetre.
        assert!((length(0.0) - length(0.0524) - 2.1e-4).abs() < 1e-5);
    }

    #[test]
    fn the_pelvis_keeps_the_length_of_standing_legs() {
        let (free, soles) = standing(30, 0.60, 0.02);
        let carried = carry(&free, &soles);
        for shift in &carried.shift {
            assert!(
                (shift - Vector3::new(0.0, 0.0, 0.02)).norm() < 1e-6,
                "{shift}"
            );
        }
        assert!(carried.lowered < 1e-6);
    }

    #[test]
    fn the_pelvis_comes_down_to_what_the_legs_reach() {
        // Hips 0.637 m over ankles, where legs reach 0.606 m.
        let (free, soles) = standing(30, 0.69, 0.0);
        let carried = carry(&free, &soles);
        for shift in &carried.shift {
            let leg = 0.69 + shift.z - 0.052558;
            assert!(leg < length(STRAIGHTEST) + 1e-9, "{leg} m");
            assert!(leg > 0.60, "{leg} m");
        }
        assert!((carried.lowered - (0.69 - 0.052558 - length(STRAIGHTEST))).abs() < 2e-3);
    }

    #[test]
    fn a_foot_beyond_reach_is_to_come_back_along_the_leg() {
        // 0.8 m below the hip's level line and 0.6 m ahead of it: 1 m from hip to ankle.
        let foot = Isometry3::translation(0.6, 0.0, -0.8 - 0.017558);
        let back = overreach(&Vector3::zeros(), &foot);
        let by = 1.0 - length(STRAIGHTEST);
        assert!(
            (back - Vector3::new(-0.6, 0.0, 0.8) * by).norm() < 1e-9,
            "{back}"
        );
        let near = Isometry3::translation(0.0, 0.0, -0.55);
        assert_eq!(overreach(&Vector3::zeros(), &near).norm(), 0.0);
    }

    /// One leg stands for half a second 3 mm higher than the other does after it: the way between is
    /// smooth. A step would bend it by 3 mm at once, 6° of a knee that is bent by 10°.
    #[test]
    fn from_leg_to_leg_the_pelvis_goes_smoothly() {
        let (mut free, mut soles) = standing(50, 0.6556, 0.0);
        for i in 0..50 {
            soles[usize::from(i < 25)][i] = None;
            free[i].ankles[0].z -= 0.003;
        }
        let shift = carry(&free, &soles).shift;
        for three in shift.windows(3) {
            let bend = three[2].z - 2.0 * three[1].z + three[0].z;
            assert!(bend.abs() < 1e-3, "{bend} m a frame²");
        }
    }
}

//! Joints for targets, frame by frame: damped least squares within joint limits.
//!
//! Separate because it finds where a limb's path runs, from nothing but directions; [`crate::path`] then
//! smooths it. A step that makes things worse is not taken, and a limb that ends far off is tried
//! once more from the default pose: least squares on angles have wrong minima.

use crate::feet::Foothold;
use crate::limb::{ARMS, BONES, Chain, LEGS, Normal, Pose};
use crate::targets::Target;
use g1::BODIES;
use g1::links::SOLE_CORNERS;
use nalgebra::{Cholesky, Isometry3, Point3, SVector, Vector3};

/// Weights of squared residuals: directions and turns in rad.
const BONE: f64 = 2.0;
const FOOT_TURN: f64 = 1.0;
/// The same where a foot has its place, in stance and in swing.
const PLANNED_BONE: (f64, f64) = (0.05, 3.0);
const PLANNED_TURN: (f64, f64) = (1500.0, 0.3);
/// A standing foot does not slip; along the leg, which is about upright, it gives way a little sooner.
const PLANNED_WAY: (f64, f64) = (4e5, 10.0);
const PLANNED_HEIGHT: (f64, f64) = (2e4, 10.0);
/// What a foot on its edge weighs: its pitch against the bones.
const TIPPED_BONE: f64 = 3.0;
const TIPPED_PITCH: f64 = 0.3;
/// A swinging sole that is too low.
const SCUFFING: f64 = 2e3;
/// Toward the default pose: decides what directions leave open (a straight arm's twist).
const POSTURE: f64 = 2e-3;
/// Toward the frame before.
const CHANGE: f64 = 5e-3;

/// Steps of a frame at most, and the change below which it is done, rad.
const STEPS: usize = 60;
const DONE: f64 = 0.01;
/// Cost from which on a second start is tried: a bone that is 20° off.
const ROUGH: f64 = 0.24; // BONE · (2 sin 10°)²

/// What directions ask of a leg: those of its bones, and its foot's orientation.
pub(crate) fn leg(
    chain: &Chain<6>,
    target: &Target,
    side: usize,
    q: &SVector<f64, 6>,
) -> Normal<6> {
    let mut normal = Normal::new();
    let pose = chain.pose(&target.frame(), q);
    for (bone, ends) in target.bones[side].iter().zip(BONES) {
        normal.point(&pose, ends, bone, BONE);
    }
    normal.turn(&pose, &target.feet[side], FOOT_TURN);
    normal.stay(q, &chain.home, POSTURE);
    normal
}

/// What is asked of a leg whose foot has its place.
pub(crate) fn planned_leg(
    chain: &Chain<6>,
    base: &Isometry3<f64>,
    bones: &[Vector3<f64>; 4],
    foot: &Foothold,
    q: &SVector<f64, 6>,
) -> Normal<6> {
    let between = |(stance, swing): (f64, f64)| swing * (stance / swing).powf(foot.firm);
    let tipped = |flat: f64, tipped: f64| flat * (tipped / flat).powf(foot.tipped);
    let mut normal = Normal::new();
    let pose = chain.pose(base, q);
    let bone = between((tipped(PLANNED_BONE.0, TIPPED_BONE), PLANNED_BONE.1));
    for (direction, ends) in bones.iter().zip(BONES) {
        normal.point(&pose, ends, direction, bone);
    }
    let (way, height) = (between(PLANNED_WAY), between(PLANNED_HEIGHT));
    let place = (foot.frame * Point3::from(foot.pivot)).coords;
    normal.reach(&pose, &foot.pivot, &place, &Vector3::new(way, way, height));
    let turn = between(PLANNED_TURN);
    let pitch = between((tipped(PLANNED_TURN.0, TIPPED_PITCH), PLANNED_TURN.1));
    let weights = Vector3::new(turn, pitch, turn);
    normal.turn_about(&pose, &foot.frame.rotation, &foot.frame.rotation, &weights);
    if foot.clearance > 0.0 {
        clear(&mut normal, &pose, foot.clearance);
    }
    normal.stay(q, &chain.home, POSTURE);
    normal
}

/// The lowest corner of a swinging sole shall not be too low.
fn clear(normal: &mut Normal<6>, pose: &Pose<6>, height: f64) {
    let corners = SOLE_CORNERS.map(|corner| pose.end() * Point3::from(corner));
    let lowest = (0..4).min_by(|&a, &b| corners[a].z.total_cmp(&corners[b].z));
    let Some(k) = lowest.filter(|&k| corners[k].z < height) else {
        return;
    };
    let to = Vector3::new(corners[k].x, corners[k].y, height);
    let only_up = Vector3::new(0.0, 0.0, SCUFFING);
    normal.reach(pose, &Vector3::from(SOLE_CORNERS[k]), &to, &only_up);
}

/// What directions ask of an arm that hangs on `torso`.
pub(crate) fn arm(
    chain: &Chain<5>,
    torso: &Isometry3<f64>,
    target: &Target,
    side: usize,
    q: &SVector<f64, 5>,
) -> Normal<5> {
    let mut normal = Normal::new();
    let pose = chain.pose(torso, q);
    for (bone, ends) in target.bones[side][2..].iter().zip(BONES) {
        normal.point(&pose, ends, bone, BONE);
    }
    normal.stay(q, &chain.home, POSTURE);
    normal
}

/// A limb through all frames, each from the one before.
pub(crate) fn march<const N: usize>(
    chain: &Chain<N>,
    frames: usize,
    task: &impl Fn(usize, &SVector<f64, N>) -> Normal<N>,
) -> Vec<SVector<f64, N>> {
    let mut path: Vec<SVector<f64, N>> = Vec::with_capacity(frames);
    for i in 0..frames {
        let before = path.last().copied();
        let asked = |q: &SVector<f64, N>| {
            let mut normal = task(i, q);
            if let Some(before) = &before {
                normal.stay(q, before, CHANGE);
            }
            normal
        };
        let (mut best, cost) = settle(chain, before.unwrap_or(chain.home), &asked);
        if cost > ROUGH && before.is_some() {
            let (other, less) = settle(chain, chain.home, &asked);
            if less < 0.5 * cost {
                best = other;
            }
        }
        path.push(best);
    }
    path
}

/// The nearest minimum, and its cost.
fn settle<const N: usize>(
    chain: &Chain<N>,
    start: SVector<f64, N>,
    task: &impl Fn(&SVector<f64, N>) -> Normal<N>,
) -> (SVector<f64, N>, f64) {
    let mut q = chain.clamped(&start);
    let mut now = task(&q);
    let mut damping = 1e-3;
    for _ in 0..STEPS {
        let trial = chain.clamped(&(q + step(chain, &q, &now, damping)));
        let then = task(&trial);
        if then.cost < now.cost {
            let change = (trial - q).amax();
            (q, now) = (trial, then);
            damping = f64::max(0.1 * damping, 1e-6);
            if change < DONE {
                break;
            }
        } else if damping > 1e3 {
            break;
        } else {
            damping *= 10.0;
        }
    }
    (q, now.cost)
}

/// The damped step of the joints that no bound holds.
fn step<const N: usize>(
    chain: &Chain<N>,
    q: &SVector<f64, N>,
    normal: &Normal<N>,
    damping: f64,
) -> SVector<f64, N> {
    let (mut matrix, mut right) = (normal.matrix, normal.right);
    for k in 0..N {
        if chain.held(k, q[k], right[k]) {
            matrix.row_mut(k).fill(0.0);
            matrix.column_mut(k).fill(0.0);
            matrix[(k, k)] = 1.0;
            right[k] = 0.0;
        } else {
            matrix[(k, k)] *= 1.0 + damping;
            matrix[(k, k)] += damping;
        }
    }
    Cholesky::new(matrix).map_or_else(SVector::zeros, |c| c.solve(&right))
}

/// Directions of thigh, shin, upper arm and forearm as the robot has them, by side.
pub fn bones(bodies: &[Isometry3<f64>; BODIES]) -> [[Vector3<f64>; 4]; 2] {
    std::array::from_fn(|side| {
        let bone = |first: usize, (from, to): (usize, usize)| {
            let [a, b] = [from, to].map(|k| bodies[first + 1 + k].translation.vector);
            (b - a).normalize()
        };
        [
            bone(LEGS[side], BONES[0]),
            bone(LEGS[side], BONES[1]),
            bone(ARMS[side], BONES[0]),
            bone(ARMS[side], BONES[1]),
        ]
    })
}

#[cfg(test)]
mod tests;

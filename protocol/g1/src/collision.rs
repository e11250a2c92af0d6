//! What of the robot meets what: a capsule for each thigh, shin, foot and forearm and one for the trunk, and the pairs of
//! them that can touch.
//!
//! Separate from the shapes because these bear force: both engines, the MJCF and the checks of motion take them from
//! here. Only pairs that joints within their limits can bring together are listed; bodies next to each other in the
//! tree, which overlap in every pose, are not.
//!
//! Sizes: half-widths of the collision meshes of Unitree's `g1_23dof_rev_1_0.urdf` across the leg or arm (thigh 45 mm,
//! shin 36 mm, forearm 33 mm, hand 41 mm), the sole's outline for the foot, and the torso's capsule of mjlab's
//! `g1.xml` (Apache-2.0, 90 mm) drawn down to the pelvis for the trunk. The forearm's capsule goes on to the finger
//! tips: the wrist turns about the same line. Limbs slide along each other without friction, as in mjlab's model, where
//! geoms other than the feet have `condim` 1.

use crate::links::{LEFT_FOOT, RIGHT_FOOT, TORSO};
use crate::state::RobotState;
use crate::{BODIES, kinematics};
use nalgebra::{Isometry3, Point3, Vector3};

/// Capsules of the robot.
pub const CAPSULES: usize = 9;
/// Pairs of capsules that may touch.
pub const PAIRS: usize = 16;

/// All points within `radius` of the segment between two points fixed to a body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Capsule {
    /// What it stands for.
    pub name: &'static str,
    /// Body that carries it.
    pub body: usize,
    /// Ends of the segment in the link frame, m.
    pub ends: [[f64; 3]; 2],
    /// m.
    pub radius: f64,
}

const fn capsule(
    name: &'static str,
    body: usize,
    from: [f64; 3],
    to: [f64; 3],
    radius: f64,
) -> Capsule {
    Capsule {
        name,
        body,
        ends: [from, to],
        radius,
    }
}

const fn thigh(name: &'static str, body: usize) -> Capsule {
    capsule(name, body, [0.0, 0.0, -0.03], [-0.06, 0.0, -0.17], 0.045)
}

const fn shin(name: &'static str, body: usize) -> Capsule {
    capsule(name, body, [0.01, 0.0, 0.0], [0.01, 0.0, -0.27], 0.036)
}

const fn foot(name: &'static str, body: usize) -> Capsule {
    capsule(name, body, [-0.02, 0.0, -0.02], [0.1, 0.0, -0.02], 0.03)
}

const fn forearm(name: &'static str, body: usize) -> Capsule {
    capsule(name, body, [0.0, 0.0, -0.01], [0.31, 0.0, -0.01], 0.035)
}

/// The capsules; at most one a body.
pub const CAPSULE_TABLE: [Capsule; CAPSULES] = [
    thigh("left thigh", 3),
    shin("left shin", 4),
    foot("left foot", LEFT_FOOT),
    thigh("right thigh", 9),
    shin("right shin", 10),
    foot("right foot", RIGHT_FOOT),
    capsule("trunk", TORSO, [0.005, 0.0, -0.06], [0.01, 0.0, 0.2], 0.09),
    forearm("left forearm", 17),
    forearm("right forearm", 22),
];

/// Pairs of capsules that may touch, the one further left on a robot that stands first.
pub const PAIR_TABLE: [[usize; 2]; PAIRS] = [
    // Legs.
    [0, 3],
    [0, 4],
    [0, 5],
    [1, 3],
    [1, 4],
    [1, 5],
    [2, 3],
    [2, 4],
    [2, 5],
    // Arms with trunk, thighs and each other.
    [7, 6],
    [6, 8],
    [7, 0],
    [7, 3],
    [0, 8],
    [3, 8],
    [7, 8],
];

/// What the capsules of a pair of [`PAIR_TABLE`] stand for.
pub fn names(pair: usize) -> [&'static str; 2] {
    PAIR_TABLE[pair].map(|capsule| CAPSULE_TABLE[capsule].name)
}

/// The gap between two capsules.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gap {
    /// Distance of the surfaces, m; negative where they overlap.
    pub distance: f32,
    /// Unit vector from the second capsule to the first, world frame; zero where their segments cross.
    pub normal: Vector3<f32>,
}

/// The gap of a pair of [`PAIR_TABLE`], given every body's frame.
pub fn gap(bodies: &[Isometry3<f32>; BODIES], pair: usize) -> Gap {
    let [a, b] = PAIR_TABLE[pair].map(|capsule| &CAPSULE_TABLE[capsule]);
    let ends = |capsule: &Capsule| {
        let frame = &bodies[capsule.body];
        let place = |at: [f64; 3]| frame * Point3::from(at).cast::<f32>();
        capsule.ends.map(place)
    };
    let apart = between(ends(a), ends(b));
    Gap {
        distance: apart.norm() - (a.radius + b.radius) as f32,
        normal: apart.try_normalize(0.0).unwrap_or_default(),
    }
}

/// The pair that is nearest to touching, or deepest within each other, and its distance, m.
pub fn nearest(state: &RobotState) -> (usize, f32) {
    let bodies = kinematics::forward_state(state);
    (0..PAIRS)
        .map(|pair| (pair, gap(&bodies, pair).distance))
        .min_by(|a, b| a.1.total_cmp(&b.1))
        .expect("there are pairs")
}

/// From the nearest point of the second segment to that of the first.
///
/// Each segment's ends against the other, and the lines' own nearest points where both lie within the segments.
fn between(a: [Point3<f32>; 2], b: [Point3<f32>; 2]) -> Vector3<f32> {
    let (along_a, along_b) = (a[1] - a[0], b[1] - b[0]);
    let (square_a, square_b) = (along_a.norm_squared(), along_b.norm_squared());
    let onto_b = |point: Point3<f32>| {
        let share = ((point - b[0]).dot(&along_b) / square_b).clamp(0.0, 1.0);
        point - (b[0] + along_b * share)
    };
    let onto_a = |point: Point3<f32>| {
        let share = ((point - a[0]).dot(&along_a) / square_a).clamp(0.0, 1.0);
        a[0] + along_a * share - point
    };
    let ends = [onto_b(a[0]), onto_b(a[1]), onto_a(b[0]), onto_a(b[1])];
    let mixed = along_a.dot(&along_b);
    let determinant = square_a * square_b - mixed * mixed;
    let start = a[0] - b[0];
    let (c, f) = (along_a.dot(&start), along_b.dot(&start));
    let s = (mixed * f - c * square_b) / determinant;
    let t = (square_a * f - mixed * c) / determinant;
    // Parallel lines have no such points (NaN or far away): the ends say it all.
    let within = (0.0..=1.0).contains(&s) && (0.0..=1.0).contains(&t);
    let inner = within.then(|| start + along_a * s - along_b * t);
    ends.into_iter()
        .chain(inner)
        .min_by(|a, b| a.norm_squared().total_cmp(&b.norm_squared()))
        .expect("segments have ends")
}

#[cfg(test)]
mod tests;

//! The robot's tree as the solver walks it: a trunk, four limbs of twelve degrees each, contact points.
//!
//! Separate because everything that is known before the first step is here, taken from the tables of
//! `g1`. The generalised velocity is that of the pelvis' origin (3, world frame), its angular velocity
//! (3, world frame) and 23 joint speeds: 29 numbers. Seen from its end every limb hangs on a chain of
//! twelve: a leg on the base's 6 and its own 6, an arm on the base's 6, the waist and its own 5.

use crate::capsules::Capsules;
use crate::lane::Real;
use g1::{BODIES, JOINT_TABLE, JOINTS, LEFT_FOOT, LINK_TABLE, RIGHT_FOOT, joints, links};
use nalgebra::Rotation3;

/// Degrees of freedom of the free base.
pub(crate) const BASE: usize = 6;
/// Degrees of freedom.
pub(crate) const DEGREES: usize = BASE + JOINTS;
/// Degrees of the trunk: the base and the waist.
pub(crate) const TRUNK: usize = BASE + 1;
/// Limbs: left leg, right leg, left arm, right arm.
pub(crate) const LIMBS: usize = 4;
/// Degrees from the base to the end of any limb.
pub(crate) const CHAIN: usize = 12;
/// The greatest number of joints of a limb.
pub(crate) const LIMB_JOINTS: usize = 6;
/// First joint of every limb.
pub(crate) const LIMB_FIRST: [usize; LIMBS] = [
    joints::LEFT_LEG,
    joints::RIGHT_LEG,
    joints::LEFT_ARM,
    joints::RIGHT_ARM,
];
/// Points of the body that may touch the ground: eight corners of the soles, then twenty others.
pub const POINTS: usize = 28;
/// Points on the soles, the left foot's first.
pub const SOLE_POINTS: usize = 8;
/// Soles: left, right.
pub(crate) const SOLES: usize = 2;

/// A point that may touch the ground.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point {
    /// Body that carries it.
    pub body: usize,
    /// Place in the link frame, m.
    pub at: [f64; 3],
}

impl Point {
    /// The limb on whose chain it lies, and how many degrees of that chain move it. Points of the
    /// trunk are counted to the left arm, whose chain begins with the trunk.
    pub(crate) fn chain(&self) -> (usize, usize) {
        match self.body {
            links::PELVIS => (2, BASE),
            links::TORSO => (2, TRUNK),
            body => {
                let joint = body - 1;
                let limb = (0..LIMBS)
                    .rev()
                    .find(|&limb| LIMB_FIRST[limb] <= joint)
                    .expect("the first limb begins at joint 0");
                let prefix = if limb < 2 { BASE } else { TRUNK };
                (limb, prefix + joint - LIMB_FIRST[limb] + 1)
            }
        }
    }
}

const fn point(body: usize, x: f64, y: f64, z: f64) -> Point {
    Point {
        body,
        at: [x, y, z],
    }
}

const fn sole(body: usize, corner: usize) -> Point {
    Point {
        body,
        at: links::SOLE_CORNERS[corner],
    }
}

/// The points. Those beside the soles follow the outline of the bodies to about 2 cm; they matter
/// for robots that lie on the ground, which have ended their episode.
pub const POINT_TABLE: [Point; POINTS] = [
    sole(LEFT_FOOT, 0),
    sole(LEFT_FOOT, 1),
    sole(LEFT_FOOT, 2),
    sole(LEFT_FOOT, 3),
    sole(RIGHT_FOOT, 0),
    sole(RIGHT_FOOT, 1),
    sole(RIGHT_FOOT, 2),
    sole(RIGHT_FOOT, 3),
    // Knees and thighs.
    point(4, 0.04, 0.0, 0.0),
    point(10, 0.04, 0.0, 0.0),
    point(3, 0.0, 0.04, -0.08),
    point(9, 0.0, -0.04, -0.08),
    // Pelvis: buttocks and groin.
    point(0, -0.07, 0.07, -0.1),
    point(0, -0.07, -0.07, -0.1),
    point(0, 0.06, 0.05, -0.1),
    point(0, 0.06, -0.05, -0.1),
    // Chest, back and head.
    point(13, 0.09, 0.07, 0.25),
    point(13, 0.09, -0.07, 0.25),
    point(13, -0.08, 0.07, 0.25),
    point(13, -0.08, -0.07, 0.25),
    point(13, 0.06, 0.0, 0.47),
    point(13, -0.06, 0.0, 0.47),
    // Shoulders, elbows, hands.
    point(15, 0.0, 0.03, 0.0),
    point(20, 0.0, -0.03, 0.0),
    point(17, -0.02, 0.0, -0.03),
    point(22, -0.02, 0.0, -0.03),
    point(18, 0.17, 0.0, 0.0),
    point(23, 0.17, 0.0, 0.0),
];

/// Axis of every joint (0, 1, 2: along x, y, z of its frame), and whether that frame is turned: known
/// when the solver is compiled. Left and right are alike.
pub(crate) const SHAPES: [(usize, bool); JOINTS] = {
    let mut shapes = [(0, false); JOINTS];
    let mut i = 0;
    while i < JOINTS {
        let ([_, y, z], [roll, pitch, yaw]) = (JOINT_TABLE[i].axis, JOINT_TABLE[i].rpy);
        let axis = if z == 1.0 {
            2
        } else if y == 1.0 {
            1
        } else {
            0
        };
        shapes[i] = (axis, roll != 0.0 || pitch != 0.0 || yaw != 0.0);
        i += 1;
    }
    shapes
};

/// A hinge as the solver sees it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Hinge<T> {
    /// Origin in the parent frame, m.
    pub(crate) origin: [T; 3],
    /// Columns of the joint frame's orientation in the parent frame.
    pub(crate) placed: [[T; 3]; 3],
    pub(crate) lower: T,
    pub(crate) upper: T,
    pub(crate) armature: T,
}

/// The tables in the solver's own numbers.
#[derive(Clone, Debug)]
pub(crate) struct Tree<T> {
    pub(crate) hinges: [Hinge<T>; JOINTS],
    /// What [`inertial`] says of every nominal body.
    pub(crate) inertials: [[T; 10]; BODIES],
    pub(crate) points: [[T; 3]; POINTS],
    /// Points of every body: indices into `points`, by first and one past the last in `order`.
    pub(crate) of_body: [(usize, usize); BODIES],
    /// Points of every limb, likewise.
    pub(crate) of_limb: [(usize, usize); LIMBS],
    /// Points by limb, then by body.
    pub(crate) order: [usize; POINTS],
    /// Velocity per impulse of the points, 1/kg.
    pub(crate) weights: [T; POINTS],
    /// Whether the robot's parts meet each other.
    pub(crate) collides: bool,
    /// What meets if they do.
    pub(crate) capsules: Capsules<T>,
}

impl<T: Real> Tree<T> {
    /// With the points' weights, 1/kg, which take a solver to find: [`crate::contact::tree`].
    pub(crate) fn weighed(weights: [f64; POINTS], self_collision: bool) -> Self {
        Self {
            weights: weights.map(T::of),
            collides: self_collision,
            ..Self::weightless()
        }
    }

    /// All but the points' weights; its parts pass through each other.
    pub(crate) fn weightless() -> Self {
        let hinges = std::array::from_fn(|i| {
            let joint = &JOINT_TABLE[i];
            let [roll, pitch, yaw] = joint.rpy;
            let placed = Rotation3::from_euler_angles(roll, pitch, yaw);
            Hinge {
                origin: joint.origin.map(T::of),
                placed: std::array::from_fn(|column| {
                    std::array::from_fn(|row| T::of(placed[(row, column)]))
                }),
                lower: T::of(joint.lower),
                upper: T::of(joint.upper),
                armature: T::of(joint.armature),
            }
        });
        let mut order: [usize; POINTS] = std::array::from_fn(|i| i);
        order.sort_by_key(|&i| (POINT_TABLE[i].chain().0, POINT_TABLE[i].body));
        let of_body = std::array::from_fn(|body| {
            let on = |&i: &usize| POINT_TABLE[i].body == body;
            let first = order.iter().position(on).unwrap_or(0);
            (first, first + order.iter().filter(|&i| on(i)).count())
        });
        let of_limb = std::array::from_fn(|limb| {
            let first = order.partition_point(|&i| POINT_TABLE[i].chain().0 < limb);
            (
                first,
                order.partition_point(|&i| POINT_TABLE[i].chain().0 <= limb),
            )
        });
        Self {
            hinges,
            inertials: std::array::from_fn(|body| inertial(body, 0.0, [0.0; 3]).map(T::of)),
            points: POINT_TABLE.map(|point| point.at.map(T::of)),
            of_body,
            of_limb,
            order,
            weights: [T::default(); POINTS],
            collides: false,
            capsules: Capsules::new(),
        }
    }
}

/// Mass, centre of mass (3) and inertia about it (xx yy zz xy xz yz) of a body, as the rows that the
/// solver reads; the torso varied.
pub(crate) fn inertial(body: usize, torso_mass: f64, torso_com: [f64; 3]) -> [f64; 10] {
    let link = &LINK_TABLE[body];
    let (mut mass, mut com) = (link.mass, link.com);
    if body == links::TORSO {
        mass += torso_mass;
        com = std::array::from_fn(|axis| com[axis] + torso_com[axis]);
    }
    let mut out = [0.0; 10];
    out[0] = mass;
    out[1..4].copy_from_slice(&com);
    for (out, inertia) in out[4..].iter_mut().zip(link.inertia) {
        *out = inertia * mass / link.mass;
    }
    out
}

#[cfg(test)]
mod tests;

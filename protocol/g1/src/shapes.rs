//! What the bodies look like: capsules and boxes that stand for them in pictures.
//!
//! Separate from the links because nothing here has weight or touches anything; only the foot boxes are also what the
//! simulation puts on the ground. A limb runs from its own joint to the joint that it carries, so the joint table is
//! the drawing; thicknesses are measured by eye from photographs of the robot.

use crate::links::{self, FOOT_CENTRE, FOOT_HALF_EXTENTS};
use crate::{BODIES, JOINT_TABLE};

/// A solid in the frame of its body, m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Shape {
    /// All points within `radius` of the segment between two points.
    Capsule {
        /// One end of the segment.
        from: [f64; 3],
        /// The other end.
        to: [f64; 3],
        /// Distance from the segment to the surface.
        radius: f64,
    },
    /// A box along the body's axes.
    Box {
        /// Its centre.
        centre: [f64; 3],
        /// Half of each edge.
        half_extents: [f64; 3],
    },
}

/// Radius of each limb, m, by the part of the body's name that says which it is.
const RADII: [(&str, f64); 11] = [
    ("hip_pitch", 0.045),
    ("hip_roll", 0.05),
    ("hip_yaw", 0.052),
    ("knee", 0.042),
    ("ankle_pitch", 0.03),
    ("shoulder_pitch", 0.038),
    ("shoulder_roll", 0.036),
    ("shoulder_yaw", 0.034),
    ("elbow", 0.03),
    ("wrist_roll", 0.032),
    ("head", 0.07),
];

/// The shapes of a body; every body has at least one.
///
/// # Panics
/// If there is no such body.
pub fn of(body: usize) -> Vec<Shape> {
    assert!(body < BODIES, "the robot has {BODIES} bodies");
    match body {
        links::PELVIS => vec![Shape::Box {
            centre: [0.0, 0.0, -0.05],
            half_extents: [0.05, 0.07, 0.06],
        }],
        links::LEFT_FOOT | links::RIGHT_FOOT => vec![Shape::Box {
            centre: FOOT_CENTRE,
            half_extents: FOOT_HALF_EXTENTS,
        }],
        // The head is fixed to the torso; its top is at the robot's 1.32 m.
        links::TORSO => vec![
            Shape::Box {
                centre: [0.0, 0.0, 0.15],
                half_extents: [0.07, 0.085, 0.14],
            },
            Shape::Capsule {
                from: [0.0, 0.0, 0.37],
                to: [0.0, 0.0, 0.42],
                radius: radius("head"),
            },
        ],
        _ => vec![limb(body)],
    }
}

fn limb(body: usize) -> Shape {
    let carried = JOINT_TABLE.iter().find(|joint| joint.parent == body);
    Shape::Capsule {
        from: [0.0; 3],
        // A hand carries no joint.
        to: carried.map_or([0.17, 0.0, 0.0], |joint| joint.origin),
        radius: radius(links::LINK_TABLE[body].name),
    }
}

fn radius(name: &str) -> f64 {
    let known = RADII.iter().find(|(part, _)| name.contains(part));
    known.expect("every limb has a thickness").1
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{RobotState, kinematics};
    use nalgebra::Point3;

    /// Least and greatest height of the drawing of a state.
    fn heights(state: &RobotState) -> [f32; 2] {
        let frames = kinematics::forward_state(state);
        let mut range = [f32::MAX, f32::MIN];
        let mut see = |z: f32, reach: f32| {
            range = [range[0].min(z - reach), range[1].max(z + reach)];
        };
        for (body, frame) in frames.iter().enumerate() {
            let z = |point: [f64; 3]| (frame * Point3::from(point).cast::<f32>()).z;
            for shape in of(body) {
                match shape {
                    Shape::Capsule { from, to, radius } => {
                        see(z(from), radius as f32);
                        see(z(to), radius as f32);
                    }
                    Shape::Box {
                        centre: c,
                        half_extents: h,
                    } => {
                        for sign in [[-1.0, 1.0], [1.0, 1.0], [1.0, -1.0], [-1.0, -1.0]] {
                            see(z([c[0] + sign[0] * h[0], c[1], c[2] + sign[1] * h[2]]), 0.0);
                        }
                    }
                }
            }
        }
        range
    }

    #[test]
    fn the_standing_robot_is_drawn_from_the_ground_to_its_published_height() {
        let [least, greatest] = heights(&RobotState::standing());
        assert!(least.abs() < 1e-4, "soles at {least} m");
        // Unitree gives 1.32 m with straight knees; the default pose bends them a little.
        assert!((1.29..1.33).contains(&greatest), "head at {greatest} m");
    }
}

//! Left–right reflection of states, commands and actions.
//!
//! Separate because mirrored clips, mirrored minibatches and tests of symmetry need the same signs. The reflection is y → −y: sides swap, positions and velocities along y change
//! sign, rotations about x and z change sign (an angular velocity is an axial vector).

use crate::joints::{LEFT_ARM, RIGHT_ARM, RIGHT_LEG, WAIST};
use crate::{ACTION, JOINT_TABLE, JOINTS, RobotState};
use nalgebra::{Quaternion, UnitQuaternion, Vector3};

/// A reflection as a permutation with signs: `out[i] = sign[i] · in[index[i]]`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mirror<const N: usize> {
    /// Where each number comes from.
    pub index: [usize; N],
    /// +1 or −1.
    pub sign: [f32; N],
}

impl<const N: usize> Mirror<N> {
    /// Reflects `input` into `out`.
    ///
    /// # Panics
    /// If either is not `N` long.
    pub fn apply(&self, input: &[f32], out: &mut [f32]) {
        assert_eq!((input.len(), out.len()), (N, N), "lengths of a reflection");
        for (i, o) in out.iter_mut().enumerate() {
            *o = self.sign[i] * input[self.index[i]];
        }
    }

    const fn identity() -> Self {
        let mut index = [0; N];
        let mut i = 0;
        while i < N {
            index[i] = i;
            i += 1;
        }
        Self {
            index,
            sign: [1.0; N],
        }
    }
}

/// Signs of a command: forward stays, leftward and turning to the left change.
const COMMAND_SIGNS: [f32; 3] = [1.0, -1.0, -1.0];

/// Reflection of a vector of joints: actions, positions, velocities.
pub const ACTION_MIRROR: Mirror<ACTION> = {
    let mut mirror = Mirror::identity();
    let mut i = 0;
    while i < JOINTS {
        mirror.index[i] = if i < RIGHT_LEG {
            i + RIGHT_LEG
        } else if i < WAIST {
            i - RIGHT_LEG
        } else if i < LEFT_ARM {
            i
        } else if i < RIGHT_ARM {
            i + (RIGHT_ARM - LEFT_ARM)
        } else {
            i - (RIGHT_ARM - LEFT_ARM)
        };
        // A hinge about y bends the same way on both sides; about x or z the opposite way.
        mirror.sign[i] = if JOINT_TABLE[i].axis[1] == 1.0 {
            1.0
        } else {
            -1.0
        };
        i += 1;
    }
    mirror
};

/// Reflects an action (23 numbers).
pub fn mirror_action(input: &[f32], out: &mut [f32]) {
    ACTION_MIRROR.apply(input, out);
}

/// Reflects a command.
pub fn mirror_command(command: [f32; crate::COMMAND]) -> [f32; crate::COMMAND] {
    std::array::from_fn(|i| COMMAND_SIGNS[i] * command[i])
}

/// Reflects a state across the world's x–z plane.
pub fn mirror_state(state: &RobotState) -> RobotState {
    let mut mirrored = *state;
    let q = state.orientation.quaternion();
    mirrored.position = polar(&state.position);
    mirrored.orientation = UnitQuaternion::new_unchecked(Quaternion::new(q.w, -q.i, q.j, -q.k));
    mirrored.linear_velocity = polar(&state.linear_velocity);
    mirrored.angular_velocity = -polar(&state.angular_velocity);
    mirror_action(&state.joint_positions, &mut mirrored.joint_positions);
    mirror_action(&state.joint_velocities, &mut mirrored.joint_velocities);
    mirrored
}

fn polar(v: &Vector3<f32>) -> Vector3<f32> {
    Vector3::new(v.x, -v.y, v.z)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kinematics::forward;
    use crate::{DEFAULT_POSE, LINK_TABLE};
    use nalgebra::Isometry3;

    fn askew() -> RobotState {
        RobotState {
            position: Vector3::new(1.0, 0.3, 0.75),
            orientation: UnitQuaternion::from_euler_angles(0.2, -0.1, 0.5),
            linear_velocity: Vector3::new(0.9, -0.2, 0.1),
            angular_velocity: Vector3::new(0.3, 0.6, -0.4),
            joint_positions: std::array::from_fn(|i| 0.05 * i as f32 - 0.4),
            joint_velocities: std::array::from_fn(|i| (i as f32).sin()),
        }
    }

    #[test]
    fn twice_is_the_identity() {
        assert_eq!(mirror_state(&mirror_state(&askew())), askew());
        for i in 0..JOINTS {
            let j = ACTION_MIRROR.index[i];
            assert_eq!(ACTION_MIRROR.index[j], i);
            assert_eq!(ACTION_MIRROR.sign[j], ACTION_MIRROR.sign[i]);
        }
        assert_eq!(mirror_command([1.0, 2.0, 3.0]), [1.0, -2.0, -3.0]);
    }

    #[test]
    fn the_default_pose_is_symmetric() {
        let mut mirrored = [0.0; JOINTS];
        mirror_action(&DEFAULT_POSE, &mut mirrored);
        assert_eq!(mirrored, DEFAULT_POSE);
    }

    #[test]
    fn mirrored_bodies_are_reflections() {
        let bodies = |s: &RobotState| {
            forward(
                &Isometry3::from_parts(s.position.into(), s.orientation),
                &s.joint_positions,
            )
        };
        let (here, there) = (bodies(&askew()), bodies(&mirror_state(&askew())));
        for (i, link) in LINK_TABLE.iter().enumerate() {
            let other = if link.name.starts_with("left") {
                link.name.replacen("left", "right", 1)
            } else {
                link.name.replacen("right", "left", 1)
            };
            let j = LINK_TABLE.iter().position(|l| l.name == other).unwrap();
            let gap = polar(&here[i].translation.vector) - there[j].translation.vector;
            // Unitree's shoulders differ by 10 µm between the sides.
            assert!(gap.norm() < 3e-5, "{}: {gap:?}", link.name);
        }
    }
}

//! Inverse kinematics of the right leg.
//!
//! Separate because it is the one solver here: six joints for the six numbers of a foot's pose.

use g1::joints::RIGHT_LEG;
use g1::kinematics::{forward, point_jacobian};
use g1::{JOINTS, RIGHT_FOOT};
use nalgebra::{Isometry3, Matrix6, Point3, Vector6};

/// The right leg's joint positions (rad) that put the foot body at `foot`, both frames in the
/// world, starting from `guess`. `None` when the foot is out of reach.
///
/// Damped least squares, Δq = Jᵀ(JJᵀ + λI)⁻¹e, with steps of at most 0.3 rad.
pub(super) fn solve(
    base: &Isometry3<f64>,
    foot: &Isometry3<f64>,
    guess: [f64; 6],
) -> Option<[f64; 6]> {
    const DAMPING: f64 = 1e-10;
    const TOLERANCE: f64 = 1e-9;
    let mut q = [0.0; JOINTS];
    q[RIGHT_LEG..RIGHT_LEG + 6].copy_from_slice(&guess);
    for _ in 0..60 {
        let bodies = forward(base, &q);
        let reached = bodies[RIGHT_FOOT];
        let gap = foot.translation.vector - reached.translation.vector;
        let turn = (foot.rotation * reached.rotation.inverse()).scaled_axis();
        let error = Vector6::new(gap.x, gap.y, gap.z, turn.x, turn.y, turn.z);
        if error.norm() < TOLERANCE {
            return q[RIGHT_LEG..RIGHT_LEG + 6].try_into().ok();
        }
        let jacobian = point_jacobian(&bodies, RIGHT_FOOT, &Point3::origin());
        let leg: Matrix6<f64> = jacobian.fixed_view::<6, 6>(0, 6 + RIGHT_LEG).into_owned();
        let normal = leg * leg.transpose() + Matrix6::identity() * DAMPING;
        let step = leg.transpose() * normal.cholesky()?.solve(&error);
        let scale = (0.3 / step.amax()).min(1.0);
        for (joint, change) in q[RIGHT_LEG..].iter_mut().zip(step.iter()) {
            *joint += scale * change;
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::UnitQuaternion;

    #[test]
    fn finds_the_joints_that_made_a_foot_pose() {
        let made = [-0.5, -0.1, 0.15, 0.9, -0.3, 0.05];
        let mut q = [0.0; JOINTS];
        q[RIGHT_LEG..RIGHT_LEG + 6].copy_from_slice(&made);
        let base = Isometry3::from_parts(
            [0.1, 0.02, 0.75].into(),
            UnitQuaternion::from_euler_angles(0.03, 0.05, -0.1),
        );
        let foot = forward(&base, &q)[RIGHT_FOOT];
        let found = solve(&base, &foot, [-0.3, 0.0, 0.0, 0.6, -0.3, 0.0]).unwrap();
        for (a, b) in found.iter().zip(&made) {
            assert!((a - b).abs() < 1e-6, "{found:?}");
        }
    }

    #[test]
    fn a_foot_too_far_away_is_out_of_reach() {
        let base = Isometry3::translation(0.0, 0.0, 1.5);
        let foot = Isometry3::translation(0.0, -0.1, 0.035);
        assert_eq!(solve(&base, &foot, [-0.3, 0.0, 0.0, 0.6, -0.3, 0.0]), None);
    }
}

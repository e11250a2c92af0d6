//! A leg's six joints for where its foot must be.
//!
//! Separate because it is the solver, and what it is asked for (`lean.rs`) is not.

use super::Row;
use g1::joints::{LEFT_LEG, RIGHT_LEG};
use g1::kinematics::{forward, point_jacobian};
use g1::{JOINT_TABLE, JOINTS, LEFT_FOOT, RIGHT_FOOT};
use nalgebra::{Isometry3, Matrix6, Point3, Vector6};

/// First joint and foot of the legs, left and right.
pub(super) const LEGS: [(usize, usize); 2] = [(LEFT_LEG, LEFT_FOOT), (RIGHT_LEG, RIGHT_FOOT)];

/// Weight of a metre against a radian in where a foot is.
const METRE: f64 = 30.0;
/// Steps of the solver, the error (rad) at which it is done, and the distance that it keeps from limits.
const STEPS: usize = 60;
const DONE: f64 = 1e-7;
const MARGIN: f64 = 1e-6;

/// Frame of the pelvis.
pub(super) fn base(row: &Row) -> Isometry3<f64> {
    Isometry3::from_parts(row.position.into(), row.orientation)
}

/// Frames of the feet, left and right.
pub(super) fn feet(row: &Row) -> [Isometry3<f64>; 2] {
    let bodies = forward(&base(row), &row.joints);
    LEGS.map(|(_, foot)| bodies[foot])
}

/// Six joints for the six numbers of a foot, by damped least squares within the joints' limits.
pub(super) fn solve_leg(
    base: &Isometry3<f64>,
    joints: &mut [f64; JOINTS],
    (first, foot): (usize, usize),
    goal: &Isometry3<f64>,
) {
    let error = |joints: &[f64; JOINTS]| {
        let bodies = forward(base, joints);
        let place = METRE * (goal.translation.vector - bodies[foot].translation.vector);
        let turn = (goal.rotation * bodies[foot].rotation.inverse()).scaled_axis();
        let error = Vector6::new(place.x, place.y, place.z, turn.x, turn.y, turn.z);
        (bodies, error)
    };
    let (mut bodies, mut now) = error(joints);
    let mut damping = 1e-4;
    for _ in 0..STEPS {
        if now.norm() < DONE || damping > 1e6 {
            return;
        }
        let whole = point_jacobian(&bodies, foot, &Point3::origin());
        let mut jacobian: Matrix6<f64> = whole.fixed_columns::<6>(6 + first).into_owned();
        jacobian.fixed_rows_mut::<3>(0).scale_mut(METRE);
        let normal = jacobian.transpose() * jacobian + Matrix6::identity() * damping;
        let Some(step) = normal
            .cholesky()
            .map(|c| c.solve(&(jacobian.transpose() * now)))
        else {
            return;
        };
        let mut tried = *joints;
        for k in 0..6 {
            let joint = &JOINT_TABLE[first + k];
            let (lower, upper) = (joint.lower + MARGIN, joint.upper - MARGIN);
            tried[first + k] = (tried[first + k] + step[k]).clamp(lower, upper);
        }
        let (tried_bodies, after) = error(&tried);
        if after.norm() < now.norm() {
            (*joints, bodies, now) = (tried, tried_bodies, after);
            damping = f64::max(damping / 10.0, 1e-9);
        } else {
            damping *= 10.0;
        }
    }
}

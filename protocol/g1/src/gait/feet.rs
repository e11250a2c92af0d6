//! Where the feet go: clearance in swing, slip in stance, step lengths.
//!
//! Separate from the sums over features because these ask where the soles are, which takes forward
//! kinematics.

use super::{in_contact, landings};
use crate::kinematics;
use crate::links::{LEFT_FOOT, RIGHT_FOOT};
use crate::{BODIES, RobotState};
use nalgebra::{Isometry3, Vector3};

const FEET: [usize; 2] = [LEFT_FOOT, RIGHT_FOOT];

/// Below this mean step length (m) nobody steps forward or backward, and their ratio is noise.
const SHORTEST_STEP: f64 = 0.02;

/// Sums from which the measures follow.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Feet {
    swing_steps: f64,
    clearance: f64,
    stance_steps: f64,
    slip: f64,
    landings: [f64; 2],
    step_lengths: [f64; 2],
}

impl Feet {
    /// Adds one robot's control step: its state and foot forces (N; left, right) at the end, and
    /// the foot forces one step before, or `None` at an episode's first step. The ground is z = 0;
    /// place and heading of the state are free.
    pub fn add(&mut self, state: &RobotState, forces: [f32; 2], before: Option<[f32; 2]>) {
        let bodies = kinematics::forward_state(state);
        let (down, landed) = (in_contact(forces), landings(forces, before));
        for (side, foot) in FEET.into_iter().enumerate() {
            let corners = kinematics::sole_points(&bodies, foot);
            let lowest = corners
                .into_iter()
                .reduce(|a, b| if b.z < a.z { b } else { a })
                .expect("a sole has corners");
            if down[side] {
                // The lowest corner: a foot that rolls over its toe turns about it and does not slip.
                let velocity = kinematics::point_velocity(&bodies, state, foot, &lowest);
                self.stance_steps += 1.0;
                self.slip += f64::from(velocity.xy().norm());
            } else {
                self.swing_steps += 1.0;
                self.clearance += f64::from(lowest.z.max(0.0));
            }
            if landed[side] {
                self.landings[side] += 1.0;
                self.step_lengths[side] += f64::from(ahead(&bodies, state, side));
            }
        }
    }

    /// Adds the steps of another sum.
    pub fn merge(&mut self, other: &Self) {
        self.swing_steps += other.swing_steps;
        self.clearance += other.clearance;
        self.stance_steps += other.stance_steps;
        self.slip += other.slip;
        for side in 0..2 {
            self.landings[side] += other.landings[side];
            self.step_lengths[side] += other.step_lengths[side];
        }
    }

    /// Mean height of a sole's lowest corner while its foot is in the air, m.
    pub fn clearance(&self) -> Option<f64> {
        (self.swing_steps > 0.0).then(|| self.clearance / self.swing_steps)
    }

    /// Mean horizontal speed of a sole's lowest corner while its foot is on the ground, m/s.
    pub fn slip_speed(&self) -> Option<f64> {
        (self.stance_steps > 0.0).then(|| self.slip / self.stance_steps)
    }

    /// Way that a foot slips on the ground in one stride, m, at `control_hz` steps a second.
    pub fn slip_per_stride(&self, control_hz: f64) -> Option<f64> {
        let strides: f64 = self.landings.iter().sum();
        (strides > 0.0).then(|| self.slip / control_hz / strides)
    }

    /// Mean step length of the left and the right foot, m: how far ahead of the other it lands.
    pub fn step_lengths(&self) -> Option<[f64; 2]> {
        let landed = self.landings.iter().all(|landings| *landings > 0.0);
        landed.then(|| [0, 1].map(|side| self.step_lengths[side] / self.landings[side]))
    }

    /// 1 − |L − R| / (|L| + |R|) of the mean step lengths: 1 both feet step alike, 0 one foot always
    /// leads; `None` where steps go neither forward nor backward.
    pub fn step_symmetry(&self) -> Option<f64> {
        let [left, right] = self.step_lengths()?;
        let both = left.abs() + right.abs();
        (both > 2.0 * SHORTEST_STEP).then(|| 1.0 - (left - right).abs() / both)
    }
}

/// How far a foot is ahead of the other along the heading, m.
fn ahead(bodies: &[Isometry3<f32>; BODIES], state: &RobotState, side: usize) -> f32 {
    let at = |side: usize| bodies[FEET[side]].translation.vector;
    let (sin, cos) = state.yaw().sin_cos();
    (at(side) - at(1 - side)).dot(&Vector3::new(cos, sin, 0.0))
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::UnitQuaternion;
    use std::f32::consts::FRAC_PI_2;

    const LEFT: [f32; 2] = [315.0, 0.0];
    const RIGHT: [f32; 2] = [0.0, 315.0];

    fn close(got: Option<f64>, expected: f64) -> bool {
        (got.unwrap() - expected).abs() < 1e-4
    }

    #[test]
    fn standing_feet_neither_slip_nor_swing() {
        let mut feet = Feet::default();
        feet.add(&RobotState::standing(), [157.0; 2], None);
        assert!(close(feet.slip_speed(), 0.0));
        assert_eq!(feet.clearance(), None);
        assert_eq!(feet.slip_per_stride(50.0), None);
        assert_eq!(feet.step_symmetry(), None);
    }

    #[test]
    fn a_lifted_robot_that_slides_is_measured_in_metres() {
        // 3 cm above ground, whichever way it faces; the loaded foot goes with the robot at 0.5 m/s.
        let mut state = RobotState::standing();
        state.position.z += 0.03;
        state.orientation = UnitQuaternion::from_euler_angles(0.0, 0.0, 1.0);
        state.linear_velocity = Vector3::new(0.3, 0.4, 0.0);
        let mut feet = Feet::default();
        feet.add(&state, LEFT, Some(RIGHT));
        assert!(close(feet.clearance(), 0.03)); // of the right
        assert!(close(feet.slip_speed(), 0.5)); // of the left
        assert!(close(feet.slip_per_stride(50.0), 0.01)); // 0.5 m/s · 20 ms, one landing
    }

    #[test]
    fn a_foot_that_rolls_about_its_edge_does_not_slip() {
        // The whole robot leans forward and turns about the edge of its toes, as at push-off.
        let mut state = RobotState::standing();
        state.orientation = UnitQuaternion::from_euler_angles(0.0, 0.2, 0.0);
        let bodies = kinematics::forward_state(&state);
        let toe = kinematics::sole_points(&bodies, LEFT_FOOT)
            .into_iter()
            .reduce(|a, b| if b.z < a.z { b } else { a })
            .unwrap();
        state.angular_velocity = Vector3::new(0.0, 1.0, 0.0);
        state.linear_velocity = state.angular_velocity.cross(&(state.position - toe.coords));
        let mut feet = Feet::default();
        feet.add(&state, LEFT, None);
        assert!(close(feet.slip_speed(), 0.0));
    }

    #[test]
    fn step_lengths_tell_a_walk_from_a_foot_that_always_leads() {
        let astride = |left_ahead: bool| {
            let mut state = RobotState::standing();
            state.orientation = UnitQuaternion::from_euler_angles(0.0, 0.0, FRAC_PI_2);
            let turn = if left_ahead { 0.3 } else { -0.3 };
            state.joint_positions[0] -= turn; // hip pitch: negative swings forward
            state.joint_positions[6] += turn;
            state
        };
        let mut walk = Feet::default();
        walk.add(&astride(true), LEFT, Some(RIGHT));
        walk.add(&astride(false), RIGHT, Some(LEFT));
        let [left, right] = walk.step_lengths().unwrap();
        assert!(left > 0.3 && (left - right).abs() < 1e-4, "{left} {right}");
        assert!(close(walk.step_symmetry(), 1.0));
        let mut gallop = Feet::default();
        gallop.add(&astride(true), LEFT, Some(RIGHT));
        gallop.add(&astride(true), RIGHT, Some(LEFT));
        assert!(close(gallop.step_symmetry(), 0.0));
        walk.merge(&gallop);
        // Left 4·x/4 of x, right (x − x)/2 = 0: 1 − x/x.
        assert!(close(walk.step_symmetry(), 0.0));
    }
}

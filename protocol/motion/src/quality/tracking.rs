//! How well a robot that moves exactly as a clip obeys the clip's own command.
//!
//! Separate because it is the bound of a wish: a pelvis sways and turns within a stride, and a robot that
//! walks as the clip does cannot have less of an error, by the measures by which policies are judged.

use crate::clip::Clip;
use serde::Serialize;

/// Root mean square errors, measured as in an evaluation (III-F).
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Tracking {
    /// Of the planar velocity in the heading frame, m/s.
    pub rmse: f64,
    /// Of its lateral part, m/s.
    pub rmse_lateral: f64,
    /// Of the yaw rate, rad/s.
    pub rmse_yaw_rate: f64,
}

impl Tracking {
    /// Measures a clip that has frames.
    pub fn of(clip: &Clip) -> Self {
        let mut sums = [0.0; 3];
        for frame in &clip.frames {
            let velocity = frame.velocity_in_heading();
            let moves = [velocity.x, velocity.y, frame.angular_velocity.z];
            for axis in 0..3 {
                sums[axis] += f64::from(clip.command[axis] - moves[axis]).powi(2);
            }
        }
        let [forward, lateral, yaw_rate] = sums.map(|sum| sum / clip.frames.len() as f64);
        Self {
            rmse: (forward + lateral).sqrt(),
            rmse_lateral: lateral.sqrt(),
            rmse_yaw_rate: yaw_rate.sqrt(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gait;
    use g1::RobotState;
    use nalgebra::Vector3;

    #[test]
    fn errors_by_hand() {
        let mut clip = gait::walk(1.0).unwrap();
        clip.command = [1.0, 0.0, 0.2];
        // Two frames: exact, and 0.3 m/s slow, 0.4 m/s to the side, turning at 0.2 rad/s too much.
        let frame = |velocity, yaw_rate| RobotState {
            linear_velocity: velocity,
            angular_velocity: Vector3::new(0.0, 0.0, yaw_rate),
            ..RobotState::standing()
        };
        clip.frames = vec![
            frame(Vector3::new(1.0, 0.0, 0.0), 0.2),
            frame(Vector3::new(0.7, 0.4, 0.0), 0.4),
        ];
        let found = Tracking::of(&clip);
        let half = 0.5_f64.sqrt();
        let close = |a: f64, b: f64| assert!((a - b).abs() < 1e-6, "{a} {b}");
        close(found.rmse, 0.5 * half);
        close(found.rmse_lateral, 0.4 * half);
        close(found.rmse_yaw_rate, 0.2 * half);
    }

    #[test]
    fn a_walk_sways_and_turns_within_its_stride() {
        let walk = Tracking::of(&gait::walk(1.0).unwrap());
        assert!((0.1..0.25).contains(&walk.rmse), "{walk:?}");
        assert!(walk.rmse_lateral < walk.rmse && walk.rmse_yaw_rate > 0.1);
    }
}

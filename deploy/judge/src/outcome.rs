//! The numbers that follow from the sums of a scenario, as a report tells them.

use g1::JOINT_TABLE;
use g1::links::total_mass;
use serde::Serialize;
use vocabulary::Counts;

use super::tally::{CONTROL_HZ, Tally};

impl Tally {
    pub(super) fn outcome(&self) -> Outcome {
        let mean = |sum: f64| sum / self.steps;
        let root = |sum: f64| mean(sum).sqrt();
        let (torque_joint, torque_peak) = self.motors.torque_peak();
        let (speed_joint, joint_speed_peak) = self.motors.speed_peak();
        let settled =
            |sum: f64| (self.settled_steps > 0.0).then(|| (sum / self.settled_steps).sqrt());
        let verdict = self.verdict();
        let gait = self.conduct.gait();
        let [forward, left, yaw_rate] = self.conduct.pace().velocity().unwrap_or_default();
        Outcome {
            episodes: self.episodes,
            survival: (self.episodes as u64 - self.cut_short()) as f64 / self.episodes as f64,
            ends: self.ends,
            seconds_survived: self.seconds_survived(),
            rmse: root(self.squared_error),
            rmse_settled: settled(self.settled_error),
            rmse_forward: root(self.squared_errors[0]),
            rmse_lateral: root(self.squared_errors[1]),
            rmse_yaw_rate: root(self.squared_errors[2]),
            rmse_yaw_rate_settled: settled(self.settled_yaw_error),
            off: self.off.planar(),
            off_yaw_rate: self.off.turning(),
            velocity: [forward, left],
            yaw_rate,
            energy_j: mean(self.energy) * 1_000.0,
            cost_of_transport: cost_of_transport(mean(self.energy), forward.hypot(left)),
            style_reward: mean(self.style),
            task_reward: mean(self.task),
            gait: verdict.to_string(),
            gait_is_good: verdict.is_good(),
            hip_correlation: gait.hip_correlation(),
            contact_correlation: gait.contact_correlation(),
            stride_rate_hz: gait.stride_rate(CONTROL_HZ),
            duty_factor: gait.duty_factor(),
            double_support: gait.double_support(),
            flight_share: gait.flight_share(),
            pelvis_height: gait.pelvis_height(),
            foot_clearance: self.feet.clearance(),
            foot_slip: self.feet.slip_speed(),
            slip_per_stride: self.feet.slip_per_stride(CONTROL_HZ),
            step_lengths: self.feet.step_lengths(),
            step_symmetry: self.feet.step_symmetry(),
            torque_peak,
            torque_peak_joint: JOINT_TABLE[torque_joint].name,
            torque_saturated_share: self.motors.saturated_share(),
            joint_speed_peak,
            joint_speed_peak_joint: JOINT_TABLE[speed_joint].name,
        }
    }
}

/// Standard gravity, m/s².
const GRAVITY: f64 = 9.81;

/// Below this speed, m/s, a robot goes nowhere.
const SOMEWHERE: f64 = 0.1;

/// Work per weight and way:  E / (m·g·s), from the work of a control step (J) and the speed (m/s).
fn cost_of_transport(work: f64, speed: f64) -> Option<f64> {
    (speed >= SOMEWHERE).then(|| work * CONTROL_HZ / (total_mass() * GRAVITY * speed))
}

/// What came of a scenario, over all steps that robots were on their feet.
#[derive(Clone, Debug, Serialize)]
pub(super) struct Outcome {
    pub(super) episodes: usize,
    /// Share of episodes that had all their time.
    pub(super) survival: f64,
    /// How many ended for each cause.
    pub(super) ends: Counts,
    /// Mean time to the fall or to the end.
    pub(super) seconds_survived: f64,
    /// √(mean ‖v* − v‖²), planar, heading frame, m/s (III-F).
    pub(super) rmse: f64,
    /// The same without the first two seconds after a start or a new command: no robot goes at 2 m/s at once.
    pub(super) rmse_settled: Option<f64>,
    /// Its forward part, m/s.
    pub(super) rmse_forward: f64,
    /// Its lateral part, m/s.
    pub(super) rmse_lateral: f64,
    /// √(mean (ω* − ω)²), about the vertical, rad/s.
    pub(super) rmse_yaw_rate: f64,
    /// The same without the first two seconds after a start or a new command.
    pub(super) rmse_yaw_rate_settled: Option<f64>,
    /// Mean distance of a settled robot's mean planar velocity over whole strides from its command, m/s.
    pub(super) off: Option<f64>,
    /// The same of the yaw rate, rad/s.
    pub(super) off_yaw_rate: Option<f64>,
    /// Mean planar velocity in the heading frame, m/s.
    pub(super) velocity: [f64; 2],
    /// Mean yaw rate, rad/s.
    pub(super) yaw_rate: f64,
    /// Positive mechanical work per 1,000 control steps of one robot, J, without exploration noise.
    pub(super) energy_j: f64,
    /// Of the same work: per weight and way, without unit; none of a robot that goes nowhere.
    pub(super) cost_of_transport: Option<f64>,
    pub(super) style_reward: f64,
    pub(super) task_reward: f64,
    /// The verdict in words, of settled robots and by the whole command: forward, lateral, yaw rate.
    pub(super) gait: String,
    pub(super) gait_is_good: bool,
    pub(super) hip_correlation: Option<f64>,
    pub(super) contact_correlation: Option<f64>,
    pub(super) stride_rate_hz: Option<f64>,
    pub(super) duty_factor: Option<f64>,
    /// Share of time with both feet on the ground.
    pub(super) double_support: Option<f64>,
    pub(super) flight_share: Option<f64>,
    pub(super) pelvis_height: Option<f64>,
    /// Mean height of a sole in swing, m.
    pub(super) foot_clearance: Option<f64>,
    /// Mean speed of a sole in stance, m/s.
    pub(super) foot_slip: Option<f64>,
    /// Way of a sole in stance, m per stride.
    pub(super) slip_per_stride: Option<f64>,
    /// Mean, left and right, m.
    pub(super) step_lengths: Option<[f64; 2]>,
    pub(super) step_symmetry: Option<f64>,
    /// Greatest share of an effort limit, and whose.
    pub(super) torque_peak: f32,
    pub(super) torque_peak_joint: &'static str,
    /// Share of steps in which some motor gave all it has.
    pub(super) torque_saturated_share: Option<f64>,
    /// Greatest share of a velocity limit, and whose.
    pub(super) joint_speed_peak: f32,
    pub(super) joint_speed_peak_joint: &'static str,
}

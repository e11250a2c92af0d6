//! The task: follow a commanded velocity, upright (Eq. 14), until a fall or the time is up.
//!
//! Separate because this file is the equation's home; what is simulated and what is learned from it
//! are elsewhere.

use crate::command::CommandConfig;
use crate::config::{self, Invalid};
use crate::curriculum::CurriculumConfig;
use crate::physics::Physics;
use crate::stance::SingleStanceConfig;
use crate::start::StartConfig;
use crate::stray::StrayConfig;
use g1::RobotState;
use nalgebra::Vector2;
use serde::{Deserialize, Serialize};

/// The `[task]` section.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct TaskConfig {
    /// Which engine moves the robots: `"rapier"` (default; the judge of every result) or
    /// `"batched"`, the fast solver for this one robot.
    pub physics: Physics,
    /// Sharpness k of the tracking kernel, s²/m². Default 0.25 (Eq. 14). The recipe that walked used
    /// 2, which tracks better: 0.25 still pays 78 % for an error of 1 m/s.
    pub kernel: f32,
    /// A second, wider kernel w, s²/m²: what is paid is the mean of both. Default: none. A sharp kernel pays next to
    /// nothing to who is half a metre per second off, so that setting off sooner is felt only by its end.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub wide_kernel: Option<f32>,
    /// Weight of the squared yaw-rate error (rad²/s²) beside the squared velocity error in the
    /// kernel. Default 0: Eq. 14 has velocities only. The recipe that walked used 0.25; without it
    /// nothing in the task tells the robot to keep its heading.
    pub yaw_rate_weight: f32,
    /// What a joule of positive mechanical work in a control step takes off the task reward, as the
    /// exponent of a factor, 1/J. Default 0: nothing in Eq. 14 asks for less energy. Walking at 1 m/s
    /// takes 2 to 3 J a step.
    pub effort_weight: f32,
    /// Pelvis height below which the robot has fallen, m. Default 0.55, of the recipe that walked.
    pub fall_height: f32,
    /// Uprightness −g_z below which the robot has fallen. Default 0.7, a tilt of 46°.
    pub fall_upright: f32,
    /// Control steps in an episode. Default 1000, the 20 s of III-F.
    pub episode_steps: u32,
    /// Let the first episodes begin at different ages, so that time-outs do not come all at once.
    /// Default true.
    pub staggered: bool,
    /// Commands.
    pub command: CommandConfig,
    /// Where episodes begin.
    pub start: StartConfig,
    /// When an episode ends because the robot does not do what it is told. Default: never.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub stray: Option<StrayConfig>,
    /// What long steps pay. Default: nothing, as in Eq. 14.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub single_stance: Option<SingleStanceConfig>,
    /// Where some of these values go as samples come in. Default: nowhere.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub curriculum: Option<CurriculumConfig>,
}

impl Default for TaskConfig {
    fn default() -> Self {
        Self {
            physics: Physics::Rapier,
            kernel: 0.25,
            wide_kernel: None,
            yaw_rate_weight: 0.0,
            effort_weight: 0.0,
            fall_height: 0.55,
            fall_upright: 0.7,
            episode_steps: 1_000,
            staggered: true,
            command: CommandConfig::default(),
            start: StartConfig::default(),
            stray: None,
            single_stance: None,
            curriculum: None,
        }
    }
}

impl TaskConfig {
    /// Checks every field; names the first bad one, its value and a remedy.
    pub fn validate(&self) -> Result<(), Invalid> {
        config::at_least("kernel", self.kernel, 0.0)?;
        if let Some(wide) = self.wide_kernel {
            config::at_least("wide_kernel", wide, 0.0)?;
        }
        config::at_least("yaw_rate_weight", self.yaw_rate_weight, 0.0)?;
        config::at_least("effort_weight", self.effort_weight, 0.0)?;
        config::at_least("fall_height", self.fall_height, 0.0)?;
        config::require(
            self.fall_height < 0.75,
            "fall_height",
            self.fall_height,
            "stay below 0.75, or the standing robot (0.784 m) has fallen",
        )?;
        config::require(
            (-1.0..1.0).contains(&self.fall_upright),
            "fall_upright",
            self.fall_upright,
            "give a cosine from -1 to below 1",
        )?;
        config::require(
            self.episode_steps > 0,
            "episode_steps",
            self.episode_steps,
            "give at least 1",
        )?;
        self.command.validate()?;
        self.start.validate()?;
        self.stray.as_ref().map_or(Ok(()), StrayConfig::validate)?;
        self.single_stance
            .as_ref()
            .map_or(Ok(()), SingleStanceConfig::validate)?;
        self.curriculum
            .as_ref()
            .map_or(Ok(()), CurriculumConfig::validate)
    }

    /// Task reward: rᴳ = exp(−k·(‖v* − v‖² + w·(ω* − ω)²) − e·E)·r_upright   (Eq. 14; w = e = 0 in the
    /// paper)
    ///
    /// v is the pelvis' planar velocity in the heading frame, ω its yaw rate about the vertical, E the
    /// positive mechanical work of the step, J. A factor, so that rᴳ stays between 0 and 1, where Eq. 9
    /// and Eq. 12 expect it. With a wide kernel the mean of both kernels is paid. Where `single_stance` is given, an environment pays that factor of it.
    pub fn reward(&self, command: &[f32; 3], state: &RobotState, work: f32) -> f32 {
        let yaw_error = command[2] - state.angular_velocity.z;
        let error = tracking_error(command, state) + self.yaw_rate_weight * yaw_error.powi(2);
        let pays = |kernel: f32| (-kernel * error - self.effort_weight * work).exp();
        let sharp = pays(self.kernel);
        let obeys = self
            .wide_kernel
            .map_or(sharp, |wide| 0.5 * (sharp + pays(wide)));
        obeys * upright(state)
    }

    /// Whether the robot lies, or is about to.
    pub fn has_fallen(&self, state: &RobotState) -> bool {
        // Written so that NaN falls.
        !(state.position.z >= self.fall_height && upright(state) >= self.fall_upright)
    }
}

/// Squared velocity error ‖v* − v‖² in the heading frame, m²/s².
pub fn tracking_error(command: &[f32; 3], state: &RobotState) -> f32 {
    (Vector2::new(command[0], command[1]) - state.velocity_in_heading()).norm_squared()
}

/// r_upright = max(0, −g_z), g the unit gravity in the base frame: 1 upright, 0 lying or upside down.
pub fn upright(state: &RobotState) -> f32 {
    (-state.projected_gravity().z).max(0.0)
}

/// How a step left its episode.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum End {
    /// It goes on.
    Running,
    /// A fall (or a state that could not be used, or straying from the command).
    Fall,
    /// The time was up.
    Timeout,
}

impl End {
    /// As written into a rollout: 0, 1, 2.
    pub fn code(self) -> f32 {
        match self {
            Self::Running => 0.0,
            Self::Fall => 1.0,
            Self::Timeout => 2.0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{UnitQuaternion, Vector3};
    use std::f32::consts::{FRAC_PI_2, FRAC_PI_3};

    fn close(a: f32, b: f32) -> bool {
        (a - b).abs() < 1e-6
    }

    /// Facing world y and walking along it at 1 m/s, turning left at 0.5 rad/s.
    fn walking() -> RobotState {
        RobotState {
            orientation: UnitQuaternion::from_euler_angles(0.0, 0.0, FRAC_PI_2),
            linear_velocity: Vector3::new(0.0, 1.0, 0.3),
            angular_velocity: Vector3::new(0.0, 0.0, 0.5),
            ..RobotState::standing()
        }
    }

    #[test]
    fn equation_14_by_hand() {
        let task = TaskConfig::default();
        // v = (1, 0) in the heading frame. v* = (1, 0): no error, upright.
        assert!(close(task.reward(&[1.0, 0.0, 0.5], &walking(), 0.0), 1.0));
        // v* = (3, 1): error 2² + 1² = 5, exp(−5/4) = 0.286505.
        assert!(close(tracking_error(&[3.0, 1.0, 0.0], &walking()), 5.0));
        assert!(close(
            task.reward(&[3.0, 1.0, 0.0], &walking(), 0.0),
            0.286_504_8
        ));
        // The literal equation ignores the yaw rate.
        assert!(close(task.reward(&[1.0, 0.0, -9.0], &walking(), 0.0), 1.0));
    }

    #[test]
    fn leaning_costs_the_cosine() {
        let mut state = walking();
        state.orientation *= UnitQuaternion::from_euler_angles(FRAC_PI_3, 0.0, 0.0);
        // Rolled by 60°: cos 60° = ½; the heading is unchanged.
        assert!(close(
            TaskConfig::default().reward(&[1.0, 0.0, 0.0], &state, 0.0),
            0.5
        ));
        // Upside down pays nothing rather than less than nothing.
        state.orientation = UnitQuaternion::from_euler_angles(3.0, 0.0, 0.0);
        assert_eq!(upright(&state), 0.0);
    }

    #[test]
    fn kernel_and_yaw_rate_weight_of_the_recipe() {
        let task = TaskConfig {
            kernel: 2.0,
            yaw_rate_weight: 0.25,
            ..TaskConfig::default()
        };
        // Velocity error ½ m/s, yaw error 1 rad/s: exp(−2·(¼ + ¼·1)) = exp(−1).
        let reward = task.reward(&[1.5, 0.0, 1.5], &walking(), 0.0);
        assert!(close(reward, 0.367_879_44), "{reward}");
    }

    #[test]
    fn work_costs_a_share_where_it_counts() {
        let mut task = TaskConfig::default();
        assert!(close(task.reward(&[1.0, 0.0, 0.5], &walking(), 9.0), 1.0));
        // Two joules at 0.05 each: exp(−0.1).
        task.effort_weight = 0.05;
        let reward = task.reward(&[1.0, 0.0, 0.5], &walking(), 2.0);
        assert!(close(reward, 0.904_837_4), "{reward}");
    }

    #[test]
    fn a_wide_kernel_pays_half() {
        let task = TaskConfig {
            kernel: 4.0,
            wide_kernel: Some(1.0),
            ..TaskConfig::default()
        };
        // v = (1, 0), v* = (2, 0): ½·(e⁻⁴ + e⁻¹) = ½·(0.018316 + 0.367879).
        let reward = task.reward(&[2.0, 0.0, 0.5], &walking(), 0.0);
        assert!(close(reward, 0.193_097_5), "{reward}");
        assert!(close(task.reward(&[1.0, 0.0, 0.5], &walking(), 0.0), 1.0));
    }

    #[test]
    fn falls_are_low_or_tilted() {
        let task = TaskConfig::default();
        let mut state = RobotState::standing();
        assert!(!task.has_fallen(&state));
        state.position.z = 0.549;
        assert!(task.has_fallen(&state));
        state.position.z = 0.551;
        assert!(!task.has_fallen(&state));
        // cos 45° = 0.707, cos 46° = 0.695.
        state.orientation = UnitQuaternion::from_euler_angles(0.0, 45_f32.to_radians(), 0.0);
        assert!(!task.has_fallen(&state));
        state.orientation = UnitQuaternion::from_euler_angles(0.0, 46_f32.to_radians(), 0.0);
        assert!(task.has_fallen(&state));
        state.position.z = f32::NAN;
        assert!(task.has_fallen(&state));
    }

    #[test]
    fn a_section_holds_only_its_differences() {
        let parsed: TaskConfig = serde_from("kernel = 2.0\n[start]\nlift = 0.01\n");
        assert_eq!(parsed.kernel, 2.0);
        assert_eq!(parsed.start.lift, 0.01);
        assert_eq!(parsed.episode_steps, 1_000);
        assert!(toml::from_str::<TaskConfig>("kernle = 2.0").is_err());
        parsed.validate().unwrap();
        let bad = TaskConfig {
            fall_height: 0.9,
            ..TaskConfig::default()
        };
        assert!(
            bad.validate()
                .unwrap_err()
                .to_string()
                .contains("fall_height = 0.9")
        );
    }

    fn serde_from(text: &str) -> TaskConfig {
        toml::from_str(text).unwrap()
    }
}

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

#[cfg(test)]
mod tests;

//! Following the commanded velocity: the first factor of Eq. 14.

use crate::moment::Moment;
use crate::terms::Term;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use vocabulary::{Checked, Ramp, invalid};

/// r = exp(−k·(‖v* − v‖² + w·(ω* − ω)²))   (Eq. 14; w = 0 in the paper)
///
/// v is the pelvis' planar velocity in the heading frame, ω its yaw rate about the vertical.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Track {
    /// How much it counts beside other terms. Default 1.
    pub weight: Ramp<f32>,
    /// Sharpness k, s²/m². Default 0.25 (Eq. 14). The recipe that walked used 2, which tracks better: 0.25 still pays 78 %
    /// for an error of 1 m/s.
    pub kernel: Ramp<f32>,
    /// Weight w of the squared yaw-rate error (rad²/s²) beside the squared velocity error. Default 0: Eq. 14 has velocities
    /// only. The recipe that walked used 0.25; without it nothing in the task tells the robot to keep its heading.
    pub yaw_rate: Ramp<f32>,
}

impl Default for Track {
    fn default() -> Self {
        Self {
            weight: 1.0.into(),
            kernel: 0.25.into(),
            yaw_rate: 0.0.into(),
        }
    }
}

impl Term for Track {
    fn weight(&self) -> &Ramp<f32> {
        &self.weight
    }

    fn value(&self, moment: &Moment<'_>) -> f32 {
        let yaw_error = moment.command[2] - moment.state.angular_velocity.z;
        let error = moment.velocity_error + self.yaw_rate.now() * yaw_error.powi(2);
        (-self.kernel.now() * error).exp()
    }

    fn set(&mut self, samples: f64) {
        for ramp in [&mut self.weight, &mut self.kernel, &mut self.yaw_rate] {
            ramp.set(samples);
        }
    }

    fn validate(&self) -> Checked {
        let not_negative = |path: &str, value: f32| invalid::at_least(path, value, 0.0);
        self.kernel.check("kernel", not_negative)?;
        self.yaw_rate.check("yaw_rate", not_negative)
    }
}

//! Falling: the robot lies, or is about to.

use crate::moment::uprightness;
use g1::RobotState;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use vocabulary::{Checked, invalid};

/// When a robot has fallen.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct FallConfig {
    /// Pelvis height below which it has, m. Default 0.55, of the recipe that walked.
    pub height: f32,
    /// Uprightness −g_z below which it has. Default 0.7, a tilt of 46°.
    pub upright: f32,
}

impl Default for FallConfig {
    fn default() -> Self {
        Self {
            height: 0.55,
            upright: 0.7,
        }
    }
}

impl FallConfig {
    /// Checks every parameter; names the first bad one.
    pub(crate) fn validate(&self) -> Checked {
        invalid::at_least("height", self.height, 0.0)?;
        invalid::require(
            self.height < 0.75,
            "height",
            self.height,
            "stay below 0.75, or the standing robot (0.784 m) has fallen",
        )?;
        invalid::require(
            (-1.0..1.0).contains(&self.upright),
            "upright",
            self.upright,
            "give a cosine from -1 to below 1",
        )
    }

    /// Whether the robot lies, or is about to.
    pub fn has_fallen(&self, state: &RobotState) -> bool {
        // Written so that NaN falls.
        !(state.position.z >= self.height && uprightness(state) >= self.upright)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::UnitQuaternion;

    #[test]
    fn falls_are_low_or_tilted() {
        let rule = FallConfig::default();
        let mut state = RobotState::standing();
        assert!(!rule.has_fallen(&state));
        state.position.z = 0.549;
        assert!(rule.has_fallen(&state));
        state.position.z = 0.551;
        assert!(!rule.has_fallen(&state));
        // cos 45° = 0.707, cos 46° = 0.695.
        state.orientation = UnitQuaternion::from_euler_angles(0.0, 45_f32.to_radians(), 0.0);
        assert!(!rule.has_fallen(&state));
        state.orientation = UnitQuaternion::from_euler_angles(0.0, 46_f32.to_radians(), 0.0);
        assert!(rule.has_fallen(&state));
        state.position.z = f32::NAN;
        assert!(rule.has_fallen(&state));
    }
}

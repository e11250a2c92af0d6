//! What has to be known to run a policy besides its numbers: what it may be told, how it begins, who limits what.
//!
//! Separate because it is of the training environment, not of the network: whoever begins otherwise begins where the
//! policy has never been.

use g1::RobotState;
use serde::{Deserialize, Serialize};

/// Ranges of commands: forward and leftward velocity (m/s), yaw rate (rad/s), least and greatest each.
pub type Commands = [[f32; 2]; 3];

/// How a policy is begun, told and stopped.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Operation {
    /// What it was told in training; outside it does anything.
    pub commands: CommandRanges,
    /// Height of the pelvis' origin above the ground under it in the default pose, soles on the ground, m.
    pub standing_height: f32,
    /// What heights are measured from.
    pub height: String,
    /// How to begin.
    pub start: String,
    /// How to stop.
    pub stop: String,
    /// Who limits torques, and where official files say otherwise.
    pub torque: String,
    /// In which order a history is seen, and where others do otherwise.
    pub history: String,
    /// Delay that was trained with.
    pub latency: String,
    /// What meets what.
    pub collision: String,
    /// Whose masses.
    pub hardware: String,
}

/// Ranges that commands came from, with both ends.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct CommandRanges {
    /// m/s.
    pub forward: [f32; 2],
    /// m/s.
    pub left: [f32; 2],
    /// rad/s, to the left.
    pub yaw_rate: [f32; 2],
}

impl Operation {
    /// Of a policy that was told `commands`.
    pub fn of([forward, left, yaw_rate]: Commands) -> Self {
        let stands = [forward, left, yaw_rate]
            .iter()
            .all(|[least, greatest]| *least <= 0.0 && *greatest >= 0.0);
        Self {
            commands: CommandRanges { forward, left, yaw_rate },
            standing_height: RobotState::standing().position.z,
            height: "the pelvis' origin above the ground under it".to_owned(),
            start: "stand in the default pose, both soles on the ground and at rest, previous action 0; then send \
                    commands, at most a metre per second more at once"
                .to_owned(),
            stop: if stands {
                "command 0, 0, 0: it stands".to_owned()
            } else {
                "it was never told to stand: bring the command to the slowest of its range, then let a controller of \
                 your own take over"
                    .to_owned()
            },
            torque: "the simulation cuts kp·(target − q) − kd·q̇ to ±effort in every physics step; a robot's drives do so \
                     at limits of their own. Ankles are cut at 35 N·m here and at 50 in official files, hip roll at 139 and \
                     at 88 in some"
                .to_owned(),
            history: "each term by itself, the present first and then the past, newest first; readers of deploy.yaml expect \
                      the oldest first"
                .to_owned(),
            latency: "none: an action acts from the moment that its observation was made".to_owned(),
            collision: "feet meet the ground; legs, arms and trunk meet each other as in g1.xml".to_owned(),
            hardware: "masses of Unitree's g1_23dof_rev_1_0, 32.1 kg; the older g1_23dof, as in unitree_mujoco, has 34.1 kg, two \
                       of them more in the torso"
                .to_owned(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_policy_that_never_stood_is_not_stopped_by_a_command_of_zero() {
        let walks = Operation::of([[0.4, 1.4], [0.0; 2], [0.0; 2]]);
        assert!(walks.stop.starts_with("it was never told to stand"));
        let all = Operation::of([[-0.6, 2.3], [-0.4, 0.4], [-1.0, 1.0]]);
        assert!(all.stop.ends_with("it stands"));
        assert_eq!(all.commands.left, [-0.4, 0.4]);
        assert!((all.standing_height - 0.78).abs() < 0.02);
    }
}

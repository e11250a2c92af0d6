//! The description as metadata of the ONNX model, under the names that mjlab's and Isaac Lab's exporters use.
//!
//! Separate because readers of a lone `policy.onnx` know these names and nothing else of ours. Lists are comma-separated,
//! a number per joint in the order of `joint_names`, as those exporters write them.

use crate::description::{Description, Term};

/// What a policy of these terms calls them elsewhere; ours where others have no such term.
pub(crate) fn elsewhere(name: &str) -> &str {
    match name {
        "height" => "base_height",
        "linear_velocity" => "base_lin_vel",
        "angular_velocity" => "base_ang_vel",
        "gravity" => "projected_gravity",
        "command" => "velocity_commands",
        "joint_position" => "joint_pos_rel",
        "joint_angle" => "joint_pos",
        "joint_velocity" => "joint_vel_rel",
        "previous_action" => "last_action",
        ours => ours,
    }
}

/// Keys and values for [`crate::onnx::model`].
pub fn properties(description: &Description) -> Vec<(String, String)> {
    let joints = &description.joints;
    let of_joints =
        |value: fn(&crate::description::JointDescription) -> f64| list(joints.iter().map(value));
    let terms = &description.observation;
    let of_terms = |value: fn(&Term) -> String| list(terms.iter().map(value));
    let scale = description.control.action_scale;
    let origin = &description.origin;
    let told = &description.operation.commands;
    let pairs = [
        ("run", origin.run.clone()),
        ("run_path", origin.run.clone()),
        ("iteration", origin.iteration.to_string()),
        ("weights_sha256", origin.weights_sha256.clone()),
        ("joint_names", list(joints.iter().map(|joint| &joint.name))),
        ("joint_stiffness", of_joints(|joint| joint.kp)),
        ("joint_damping", of_joints(|joint| joint.kd)),
        ("joint_effort_limit", of_joints(|joint| joint.effort)),
        (
            "default_joint_pos",
            of_joints(|joint| joint.default_position),
        ),
        ("action_scale", list(joints.iter().map(|_| scale))),
        ("command_names", "base_velocity".to_owned()),
        (
            "command_ranges",
            list([told.forward, told.left, told.yaw_rate].iter().flatten()),
        ),
        (
            "observation_names",
            of_terms(|term| elsewhere(&term.name).to_owned()),
        ),
        (
            "observation_lengths",
            of_terms(|term| (term.length / (1 + term.past)).to_string()),
        ),
        (
            "observation_history_lengths",
            of_terms(|term| (1 + term.past).to_string()),
        ),
        (
            "observation_history_order",
            "newest first, term by term".to_owned(),
        ),
        (
            "observation_scales",
            of_terms(|term| term.scale.to_string()),
        ),
        (
            "observation_clips",
            of_terms(|term| term.clip.map_or("none".to_owned(), |clip| clip.to_string())),
        ),
        (
            "observation_frames",
            of_terms(|term| term.frame.replace(',', ";")),
        ),
        ("policy_hz", description.control.policy_hz.to_string()),
        (
            "unitree_motor_ids",
            list(joints.iter().map(|joint| joint.unitree_motor)),
        ),
    ];
    let owned = pairs
        .into_iter()
        .map(|(key, value)| (key.to_owned(), value));
    owned.collect()
}

/// Comma-separated, without blanks.
fn list(parts: impl Iterator<Item = impl ToString>) -> String {
    let parts: Vec<String> = parts.map(|part| part.to_string()).collect();
    parts.join(",")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Origin;
    use crate::network::Network;
    use observation::ObservationConfig;
    use policy::Shape;
    use serde_json::Value;
    use std::collections::BTreeMap;

    #[test]
    fn a_lone_model_says_how_it_is_run() {
        let text = "[actor]\nterms = ['angular_velocity', 'command']\n[actor.term.angular_velocity]\n\
                    past = 4\nscale = 0.5\nclip = 8.0";
        let config: ObservationConfig = toml::from_str(text).unwrap();
        let seen = config.tables().unwrap().actor;
        let shape = Shape::new(18, &[]); // 5 times 3, and 3
        let mut flat = vec![0.0; shape.len()];
        flat[shape.sigma()].fill(1.0);
        let network = Network::new(shape, 5.0, flat).unwrap();
        let description = Description::new(
            &network,
            &seen,
            Origin::default(),
            [50.0, 200.0],
            [[-0.5, 2.0], [-0.25, 0.25], [-1.0, 1.0]],
            Value::Null,
            Value::Null,
        );
        let told: BTreeMap<String, String> = properties(&description).into_iter().collect();
        for (key, value) in [
            ("observation_names", "base_ang_vel,velocity_commands"),
            ("observation_lengths", "3,3"),
            ("observation_history_lengths", "5,1"),
            ("observation_scales", "0.5,1"),
            ("observation_clips", "8,none"),
            ("command_ranges", "-0.5,2,-0.25,0.25,-1,1"),
            ("policy_hz", "50"),
        ] {
            assert_eq!(told[key], value, "{key}");
        }
        let count = |key: &str| told[key].split(',').count();
        for key in [
            "joint_names",
            "joint_stiffness",
            "joint_damping",
            "default_joint_pos",
            "action_scale",
        ] {
            assert_eq!(count(key), 23, "{key}");
        }
        assert!(told["joint_names"].starts_with("left_hip_pitch_joint,left_hip_roll_joint"));
        assert!(told["unitree_motor_ids"].ends_with("12,15,16,17,18,19,22,23,24,25,26"));
    }
}

//! What is written is what the description says, in the orders of the layout.

use super::*;
use crate::Origin;
use crate::network::Network;
use observation::ObservationConfig;
use policy::Shape;
use serde_json::Value;

fn described(list: &str, run: &str) -> Description {
    let config: ObservationConfig = toml::from_str(list).unwrap();
    let seen = config.tables().unwrap().actor;
    let shape = Shape::new(seen.width(), &[]);
    let mut flat = vec![0.0; shape.len()];
    flat[shape.sigma()].fill(1.0);
    let network = Network::new(shape, 5.0, flat).unwrap();
    let origin = Origin {
        run: run.to_owned(),
        ..Origin::default()
    };
    let commands = [[-0.5, 2.0], [-0.25, 0.25], [-1.0, 1.0]];
    let rates = [50.0, 200.0];
    Description::new(
        &network,
        &seen,
        origin,
        rates,
        commands,
        Value::Null,
        Value::Null,
    )
}

/// The value of a key, wherever it first is.
fn value<'a>(text: &'a str, key: &str) -> &'a str {
    let mut lines = text.lines().filter_map(|line| line.trim().split_once(": "));
    lines.find(|(name, _)| *name == key).unwrap().1
}

fn numbers_of(text: &str, key: &str) -> Vec<f64> {
    let list = value(text, key).trim_matches(['[', ']']);
    list.split(", ").map(|part| part.parse().unwrap()).collect()
}

#[test]
fn gains_are_of_motors_and_the_rest_of_joints() {
    let text = text(&described("", "walk"));
    let map = numbers_of(&text, "joint_ids_map");
    let (stiffness, damping) = (numbers_of(&text, "stiffness"), numbers_of(&text, "damping"));
    assert_eq!((map.len(), stiffness.len(), damping.len()), (23, 29, 29));
    // Waist yaw is 12 in both; the left shoulder's pitch is the 14th joint and motor 15, the right one's 19th and 22.
    assert_eq!(
        (map[12], map[13], map[18], map[22]),
        (12.0, 15.0, 22.0, 26.0)
    );
    // Knee, waist yaw, waist roll (held), left shoulder pitch, left wrist pitch (held), right wrist yaw (held).
    let at = |gains: &[f64]| [3, 12, 13, 15, 20, 28].map(|motor: usize| gains[motor]);
    assert_eq!(at(&stiffness), [150.0, 200.0, 40.0, 40.0, 40.0, 40.0]);
    assert_eq!(at(&damping), [4.0, 5.0, 5.0, 1.0, 1.0, 1.0]);
    let pose = numbers_of(&text, "default_joint_pos");
    assert_eq!(
        (pose.len(), pose[0], pose[3], pose[13]),
        (23, -0.1, 0.3, 0.3)
    );
    assert_eq!(numbers_of(&text, "offset"), pose);
    assert_eq!(numbers_of(&text, "scale"), [0.25; 23]); // the first is the action's
    assert_eq!(value(&text, "step_dt"), "0.02");
    assert_eq!(value(&text, "lin_vel_x"), "[-0.5, 2.0]");
    assert_eq!(value(&text, "ang_vel_z"), "[-1.0, 1.0]");
}

#[test]
fn a_term_is_written_as_it_is_seen() {
    let list = "[actor]\nterms = ['angular_velocity', 'command']\n[actor.term.angular_velocity]\n\
                past = 4\nscale = 1e-7\nclip = 8.0";
    let text = text(&described(list, "walk"));
    let expected = "\
observations:
  base_ang_vel:
    params: {}
    clip: [-8.0, 8.0]
    scale: [0.0000001, 0.0000001, 0.0000001]
    history_length: 5
  velocity_commands:
    params: {command_name: base_velocity}
    clip: null
    scale: [1.0, 1.0, 1.0]
    history_length: 1
";
    assert!(text.ends_with(expected), "{text}");
    assert!(
        text.contains("newest first") && !text.contains("They have no"),
        "{text}"
    );
}

#[test]
fn what_differs_is_said_where_it_does_and_not_elsewhere() {
    let paper = text(&described("", "walk"));
    assert!(
        paper.contains("# - They have no base_height, base_lin_vel: a robot"),
        "{paper}"
    );
    assert!(
        paper.contains("[batch, 82]") && !paper.contains("newest first"),
        "{paper}"
    );
    let robots = "[actor]\nterms = ['angular_velocity', 'gravity', 'command', 'joint_angle', 'joint_position', \
                  'joint_velocity', 'previous_action']";
    let robots = text(&described(robots, "walk"));
    assert!(
        !robots.contains("They have no") && !robots.contains("newest first"),
        "{robots}"
    );
}

#[test]
fn a_name_of_two_lines_stays_a_comment() {
    let text = text(&described("", "walk\nstep_dt: 9"));
    assert_eq!(value(&text, "step_dt"), "0.02");
    assert_eq!(text.matches("\nstep_dt").count(), 1);
}

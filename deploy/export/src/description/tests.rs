//! The description covers the observation, and its example is what the network does.

use super::*;
use observation::{ObservationConfig, Tables};
use policy::Shape;

fn remembering() -> Table {
    let text = "[actor]\nterms = ['gravity', 'command']\npast = 2\n[actor.term.command]\nscale = 2.0\nclip = 0.8\nnoise = 0.1\npast = 0";
    let config: ObservationConfig = toml::from_str(text).unwrap();
    config.tables().unwrap().actor
}

#[test]
fn terms_cover_the_observation_without_gaps() {
    for seen in [Tables::default().actor, remembering()] {
        let mut next = 0;
        for term in terms(&seen) {
            assert_eq!(term.start, next, "{}", term.name);
            assert_eq!(term.length, term.labels.len() * (1 + term.past));
            next += term.length;
        }
        assert_eq!(next, seen.width());
    }
}

#[test]
fn the_example_is_what_the_network_does() {
    // Weights of zero but for the last bias: the action is that bias, whatever is observed.
    let shape = Shape::new(g1::OBSERVATION, &[]);
    let mut flat = vec![0.0; shape.len()];
    flat[shape.sigma()].fill(1.0);
    let first = flat.len() - g1::ACTION;
    flat[first + 3] = 0.75;
    let network = Network::new(shape, 2.5, flat).unwrap();
    let description = Description::new(
        &network,
        &Tables::default().actor,
        Origin::default(),
        [50.0, 200.0],
        [[0.4, 1.4], [0.0; 2], [0.0; 2]],
        Value::Null,
        Value::Null,
    );
    assert_eq!(description.network.clip, 2.5);
    assert_eq!(description.example.action[3], 0.75);
    assert_eq!(description.example.observation[10], 0.5);
    let text = serde_json::to_string(&description).unwrap();
    let back: Description = serde_json::from_str(&text).unwrap();
    assert_eq!(back, description);
    assert_eq!(back.joints[3].name, "left_knee_joint");
    assert_eq!(back.joints[13].unitree_motor, 15); // waist roll and pitch are 13 and 14
}

#[test]
fn how_a_term_is_seen_is_told() {
    let told = terms(&remembering());
    let [gravity, command] = told.as_slice() else {
        panic!("{told:?}");
    };
    assert_eq!((gravity.length, gravity.past, gravity.clip), (9, 2, None));
    assert_eq!((command.start, command.length, command.scale), (9, 3, 2.0));
    assert_eq!((command.clip, command.noise), (Some(0.8), 0.1));
    assert_eq!(command.labels, ["forward", "left", "yaw_rate"]);
    let shape = Shape::new(12, &[]);
    let mut flat = vec![0.0; shape.len()];
    flat[shape.sigma()].fill(1.0);
    let network = Network::new(shape, 5.0, flat).unwrap();
    // Gravity three times, and 0.5 m/s doubled.
    let example = example(&network, &remembering());
    assert_eq!(example.observation[2..6], [-1.0, 0.0, 0.0, -1.0]);
    assert_eq!(example.observation[9..], [1.0, 0.0, 0.0]);
}

#[test]
fn every_motor_of_the_larger_robot_is_driven_or_held() {
    let driven = joints().into_iter().map(|joint| joint.unitree_motor);
    let held = held::motors().into_iter().map(|held| held.unitree_motor);
    let mut all: Vec<u32> = driven.chain(held).collect();
    all.sort_unstable();
    assert_eq!(all, (0..29).collect::<Vec<_>>());
}

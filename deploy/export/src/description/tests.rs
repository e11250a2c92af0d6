//! The description covers the observation, and its example is what the network does.

use super::*;
use policy::Shape;

#[test]
fn terms_cover_the_observation_without_gaps() {
    let mut next = 0;
    for term in observation_terms() {
        assert_eq!(term.start, next, "{}", term.name);
        next += term.length;
    }
    assert_eq!(next, OBSERVATION);
}

#[test]
fn the_example_is_what_the_network_does() {
    // Weights of zero but for the last bias: the action is that bias, whatever is observed.
    let shape = Shape::new(&[]);
    let mut flat = vec![0.0; shape.len()];
    flat[policy::SIGMA].fill(1.0);
    let first = flat.len() - g1::ACTION;
    flat[first + 3] = 0.75;
    let network = Network::new(shape, 2.5, flat).unwrap();
    let description = Description::new(
        &network,
        Origin::default(),
        [50.0, 200.0],
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
}

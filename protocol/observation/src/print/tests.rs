//! Lists that differ are told apart, in words.

use super::*;
use crate::ObservationConfig;

fn print(text: &str) -> Print {
    let config: ObservationConfig = toml::from_str(text).unwrap();
    Print::of(&config.tables().unwrap())
}

#[test]
fn the_same_lists_do_not_differ() {
    assert_eq!(print("").difference(&print("[actor]\npast = 0")), None);
    assert_eq!(
        print("").0.iter().filter(|number| **number != 0).count(),
        8 + 1 + 5
    );
}

#[test]
fn a_difference_names_list_and_term() {
    let ours = print("");
    let of = |text: &str| ours.difference(&print(text)).unwrap();
    let without = "[actor]\nterms = ['gravity', 'command', 'friction']";
    let said = of(without);
    assert!(
        said.starts_with("its list of observation.actor lacks height, linear_velocity")
            && said.contains("has friction besides"),
        "{said}"
    );
    let said = of("[actor.term.gravity]\nscale = 2.0");
    assert_eq!(
        said,
        "its list of observation.actor has another scale, noise, clip or past of gravity"
    );
    let turned = "[discriminator]\nterms = ['linear_velocity', 'height', 'angular_velocity', \
                  'joint_angle', 'joint_velocity']";
    assert_eq!(
        of(turned),
        "its list of observation.discriminator has another order"
    );
    let critic = of("[critic]\nterms = ['actor', 'friction']");
    assert_eq!(
        critic,
        "its list of observation.critic has friction besides"
    );
    let mut unknown = ours;
    unknown.0[0] ^= 1 << 40;
    let said = ours.difference(&unknown).unwrap();
    assert!(said.contains("not known here"), "{said}");
}

#[test]
fn a_critic_that_begins_with_the_actors_row_is_another_than_one_that_does_not() {
    let with = print("[critic]\nterms = ['actor', 'friction']");
    let without = print("[critic]\nterms = ['friction']");
    assert!(with.difference(&without).is_some());
}

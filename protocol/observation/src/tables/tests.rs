//! What follows from the lists, and where things are found.

use super::*;
use crate::ObservationConfig;

fn tables(text: &str) -> Tables {
    toml::from_str::<ObservationConfig>(text)
        .unwrap()
        .tables()
        .unwrap()
}

#[test]
fn the_papers_lists_need_nothing_beside_themselves() {
    let tables = Tables::default();
    let expected = Widths {
        observation: g1::OBSERVATION,
        critic: 0,
        features: g1::FEATURES,
        measured: 0,
    };
    assert_eq!(tables.widths(), expected);
    assert_eq!(tables.critic_width(), g1::OBSERVATION);
    assert!(tables.is_papers_actor());
    assert_eq!(tables.velocities(), Some([1, 2, 6]));
    let places = tables.places();
    assert_eq!(places.command, Place::Observation(g1::observation::COMMAND));
    assert_eq!(places.gravity, Place::Observation(g1::observation::GRAVITY));
    assert_eq!(places.features, Place::Features(0..g1::FEATURES));
}

#[test]
fn a_critic_that_sees_more_adds_to_the_actors_row() {
    let lists = tables(
        "[actor]\nterms = ['gravity', 'command']\npast = 2\n\
         [critic]\nterms = ['actor', 'linear_velocity', 'foot_forces']",
    );
    // (3 + 3)·3 of the actor, 3 + 2 beside.
    assert_eq!((lists.critic_width(), lists.shared_width()), (18 + 5, 18));
    assert_eq!((lists.widths().observation, lists.widths().critic), (18, 5));
    let mirror = lists.critic_reflection();
    assert_eq!(mirror.index[..18], (0..18).collect::<Vec<_>>());
    // The velocity's y turns round; the feet change places.
    assert_eq!(mirror.sign[18..], [1.0, -1.0, 1.0, 1.0, 1.0]);
    assert_eq!(mirror.index[18..], [18, 19, 20, 22, 21]);
    // What the actor sees is in units though it has past frames: the newest are first.
    assert_eq!(lists.places().command, Place::Observation(9..12));
    let blind = tables("[critic]\nterms = ['height', 'friction']");
    assert_eq!((blind.critic_width(), blind.shared_width()), (2, 0));
    assert_eq!(blind.critic_reflection().index, [0, 1]);
}

#[test]
fn what_no_list_shows_in_units_is_measured_beside() {
    let lists = tables(
        "[actor]\nterms = ['command', 'joint_position']\n[actor.term.command]\nscale = 2.0\n\
         [discriminator]\nterms = ['joint_angle', 'height']",
    );
    // 3 of the command, all the paper's features, 3 of gravity.
    assert_eq!(lists.widths().measured, 3 + g1::FEATURES + 3);
    let places = lists.places();
    assert_eq!(places.command, Place::Measured(0..3));
    assert_eq!(places.features, Place::Measured(3..3 + g1::FEATURES));
    let end = 3 + g1::FEATURES;
    assert_eq!(places.gravity, Place::Measured(end..end + 3));
    assert_eq!(lists.velocities(), None);
    // A list that begins with the paper's shows it, whatever comes after.
    let longer = tables(
        "[discriminator]\nterms = ['height', 'linear_velocity', 'angular_velocity', 'joint_angle', \
         'joint_velocity', 'key_bodies']",
    );
    assert_eq!(longer.widths().measured, 0);
    assert_eq!(longer.widths().features, g1::FEATURES + 15);
}

#[test]
fn noise_of_its_own_can_be_left_out() {
    let noisy = tables("[actor.term.gravity]\nnoise = 0.1");
    let noise = |tables: &Tables| tables.actor.entries()[3].noise;
    assert_eq!((noise(&noisy), noise(&noisy.exact())), (0.1, 0.0));
}

#[test]
fn all_lists_are_told_in_words() {
    let lists = tables(
        "[actor]\nterms = ['gravity']\npast = 1\n[critic]\nterms = ['actor', 'friction']\n\
         [discriminator]\nterms = ['height']",
    );
    assert_eq!(
        lists.words(),
        "actor [gravity past 1] critic [actor, friction] discriminator [height]"
    );
}

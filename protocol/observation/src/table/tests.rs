//! Rows, frames and reflections by hand.

use super::*;
use crate::Scene;
use g1::RobotState;

fn entry(name: &str) -> Entry {
    Entry::plain(terms::named(name).unwrap())
}

/// Height with two past frames, the command doubled and cut to ±0.3.
fn table() -> Table {
    Table::of(vec![
        Entry {
            past: 2,
            ..entry("height")
        },
        Entry {
            scale: 2.0,
            clip: Some(0.3),
            ..entry("command")
        },
    ])
}

#[test]
fn rows_remember_and_begin_anew() {
    let table = table();
    assert_eq!((table.width(), table.frame_width()), (6, 4));
    assert!(!table.is_of_the_present());
    let mut row = [f32::NAN; 6];
    table.remember(&[1.0, 7.0, 8.0, 9.0], true, &mut row);
    assert_eq!(row, [1.0, 1.0, 1.0, 7.0, 8.0, 9.0]);
    table.remember(&[2.0, 4.0, 5.0, 6.0], false, &mut row);
    table.remember(&[3.0, 4.0, 5.0, 6.0], false, &mut row);
    assert_eq!(row, [3.0, 2.0, 1.0, 4.0, 5.0, 6.0]);
    table.remember(&[4.0, 4.0, 5.0, 6.0], false, &mut row);
    assert_eq!(row[..3], [4.0, 3.0, 2.0]);
    table.remember(&[9.0, 0.0, 0.0, 0.0], true, &mut row);
    assert_eq!(row[..3], [9.0; 3]);
}

#[test]
fn a_frame_is_cut_and_then_scaled() {
    let mut frame = [0.78, 0.5, -0.1, -9.0];
    table().adjust(&mut frame);
    assert_eq!(frame, [0.78, 0.6, -0.2, -0.6]);
}

#[test]
fn a_command_that_is_held_from_outside_shows_at_once() {
    let table = Table::of(vec![Entry {
        past: 1,
        scale: 2.0,
        ..entry("command")
    }]);
    let mut row = [0.0; 6];
    table.replace("command", &[1.0, 0.0, 0.5], false, &mut row);
    assert_eq!(row, [2.0, 0.0, 1.0, 0.0, 0.0, 0.0]);
    table.replace("command", &[0.5, 0.0, 0.0], true, &mut row);
    assert_eq!(row, [1.0, 0.0, 0.0, 1.0, 0.0, 0.0]);
    table.replace("gravity", &[7.0; 3], true, &mut row);
    assert_eq!(row, [1.0, 0.0, 0.0, 1.0, 0.0, 0.0]);
}

#[test]
fn only_plain_terms_are_in_units() {
    let table = table();
    assert_eq!(table.in_units("height"), Some(0..1));
    assert_eq!(table.in_units("command"), None);
    assert_eq!(table.in_units("friction"), None);
}

#[test]
fn a_row_is_reflected_frame_by_frame() {
    // Angular velocity (−, +, −) of two frames, then the height.
    let table = Table::of(vec![
        Entry {
            past: 1,
            ..entry("angular_velocity")
        },
        entry("height"),
    ]);
    let mirror = table.reflection();
    assert_eq!(mirror.index, [0, 1, 2, 3, 4, 5, 6]);
    assert_eq!(mirror.sign, [-1.0, 1.0, -1.0, -1.0, 1.0, -1.0, 1.0]);
    // Joints swap sides within their own frame: the second frame begins where the first ends.
    let joints = Table::of(vec![Entry {
        past: 1,
        ..entry("joint_velocity")
    }])
    .reflection();
    assert_eq!(joints.index[0], g1::joints::RIGHT_LEG);
    assert_eq!(joints.index[g1::JOINTS], g1::JOINTS + g1::joints::RIGHT_LEG);
}

#[test]
fn terms_in_another_order_are_the_same_numbers_elsewhere() {
    let state = RobotState {
        joint_positions: std::array::from_fn(|i| i as f32),
        ..RobotState::standing()
    };
    let row = Table::plain(["gravity", "height", "joint_angle"]).row(&Scene::of(&state));
    assert_eq!(row[..3], [0.0, 0.0, -1.0]);
    assert_eq!((row[3], row[4], row[5]), (state.position.z, 0.0, 1.0));
    assert_eq!(row.len(), 4 + g1::JOINTS);
}

#[test]
fn a_list_is_told_in_words() {
    assert_eq!(table().words(), "height past 2, command scale 2 clip 0.3");
}

#[test]
fn the_papers_lists_are_written_by_one_function_each() {
    let writers = |names: &[&str]| Table::plain(names.iter().copied()).writers.len();
    assert_eq!(writers(&terms::PAPER_ACTOR), 1);
    assert_eq!(writers(&terms::PAPER_DISCRIMINATOR), 1);
    let longer = [&terms::PAPER_DISCRIMINATOR[..], &["key_bodies"]].concat();
    assert_eq!(writers(&longer), 2);
    assert_eq!(writers(&["command", "height"]), 2);
}

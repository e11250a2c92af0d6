//! Places of rollouts in the arrays, by hand.

use super::*;
use crate::robot::tests::{FEATURES, OBSERVATION, simple};

#[test]
fn rollouts_have_their_own_places() {
    let mut batch = Batch::new(simple().widths());
    batch.resize(2, 3, 2);
    batch.add_segment(1, 4);
    assert_eq!((batch.rows(), batch.robots()), (16, 8));
    for i in 0..3 {
        let part = batch.segment_mut(i);
        part.ends.fill(i as f32);
        part.last_observations.fill(i as f32);
    }
    assert_eq!(batch.ends[..6], [0.0; 6]);
    assert_eq!(batch.ends[12..], [2.0; 4]);
    assert_eq!(batch.last_observations[4 * OBSERVATION], 2.0);
    batch.remove_segment(1);
    assert_eq!((batch.rows(), batch.robots()), (10, 6));
    assert_eq!(batch.ends[6..], [2.0; 4]);
    assert_eq!(batch.last_observations[2 * OBSERVATION], 2.0);
    assert_eq!(batch.check(&simple().widths()), Ok(()));
}

#[test]
fn time_outs_know_their_environment() {
    let mut batch = Batch::new(simple().widths());
    batch.resize(2, 2, 3);
    // second rollout (rows 6..12), second step (9..12), third environment
    batch.ends[11] = Cause::TimeOut.code();
    batch.ends[0] = Cause::Fall.code();
    assert_eq!(batch.time_outs().collect::<Vec<_>>(), [(11, 5)]);
}

#[test]
fn what_is_not_finite_is_named() {
    let mut batch = Batch::new(simple().widths());
    assert_eq!(
        batch.check(&simple().widths()),
        Err(LearningError::EmptyBatch)
    );
    batch.resize(1, 2, 2);
    batch.timeout_observations.fill(f32::NAN); // nothing timed out: these numbers mean nothing
    assert_eq!(batch.check(&simple().widths()), Ok(()));
    batch.features[3 * FEATURES + 5] = f32::INFINITY;
    let error = batch.check(&simple().widths()).expect_err("infinite");
    assert_eq!(
        error.to_string(),
        "field `features` of the batch, row 3, holds inf"
    );
    batch.features.pop();
    assert!(matches!(
        batch.check(&simple().widths()),
        Err(LearningError::BatchLength {
            field: "features",
            ..
        })
    ));
    batch.resize(1, 2, 2);
    batch.features.fill(0.0);
    batch.ends[2] = Cause::TimeOut.code();
    assert!(matches!(
        batch.check(&simple().widths()),
        Err(LearningError::BatchNotFinite {
            field: "timeout_observations",
            row: 0,
            ..
        })
    ));
}

#[test]
fn a_robot_s_mean_is_over_its_own_rows() {
    let mut batch = Batch::default();
    batch.add_segment(2, 2);
    batch.add_segment(1, 1);
    // Rows go robot by robot within a step: the first robot has 0.25 and 0.75, the second 0.5 and 1.
    let means = batch.means_of_robots(&[0.25, 0.5, 0.75, 1.0, 0.125]);
    assert_eq!(means, [0.5, 0.75, 0.125]);
    // Rows measure 0 1 2, 3 4 5 and so on.
    batch.widths.measured = 3;
    batch.measured = (0..15).map(|number| number as f32).collect();
    let commands = batch.commands_of_robots(&Place::Measured(0..3));
    assert_eq!(
        commands,
        [[3.0, 4.0, 5.0], [6.0, 7.0, 8.0], [12.0, 13.0, 14.0]]
    );
}

#[test]
fn the_last_robots_of_every_rollout_explore_calmly() {
    let mut batch = Batch::new(simple().widths());
    batch.add_segment(2, 4);
    batch.add_segment(1, 2);
    let explored = |batch: &Batch| {
        let mut widths = Vec::new();
        batch.exploration(&mut widths);
        widths
    };
    assert!(explored(&batch).is_empty());
    batch.calm_share = 0.25;
    // One of four, and half a robot rounds up to one of two.
    let [all, half] = [1.0, CALM];
    let step = [all, all, all, half];
    assert_eq!(explored(&batch), [&step[..], &step, &[all, half]].concat());
}

//! A critic that sees what the policy does not.

use super::*;
use crate::robot::tests::FEATURES;
use crate::robot::{Mirror, Robot};

/// Sees the policy's numbers and one more, which the mirror turns round.
fn robot() -> Robot {
    let mut mirror = simple().observation_mirror;
    mirror.index.push(OBSERVATION);
    mirror.sign.push(-1.0);
    Robot {
        critic_mirror: Some(mirror),
        ..simple()
    }
}

/// Rewards are what only the critic sees, and nothing after a step counts.
fn config() -> LearningConfig {
    let mut config = super::config();
    config.ppo.gamma = 0.0;
    config.ppo.mirrored_share = 0.0.into();
    config.ppo.learning_rate = 3e-3;
    config.ppo.schedule = crate::config::RateSchedule::Fixed;
    config
}

fn learning(robot: Robot, config: LearningConfig) -> Learning {
    Learning::new(config, robot, 11).expect("usable")
}

/// A batch of `robot`, which sees zeros: what pays is behind the policy's numbers in the critic's rows, if it has rows of its own.
fn batch(learning: &Learning, robot: &Robot, seed: u64) -> Batch {
    let seen = super::batch(&super::learning(), seed);
    let mut batch = Batch::new(robot.widths());
    batch.resize(2, 6, 5);
    let Batch {
        actions,
        features,
        next_features,
        ..
    } = &mut batch;
    actions.copy_from_slice(&seen.actions);
    features.copy_from_slice(&seen.features);
    next_features.copy_from_slice(&seen.next_features);
    batch.log_probs.copy_from_slice(&seen.log_probs);
    batch.episode_steps.fill(40.0);
    let mut rng = Pcg64::seed_from_u64(seed);
    for row in 0..batch.rows() {
        let pay: f32 = rng.random_range(0.0..1.0);
        batch.task_rewards[row] = pay;
        if robot.critic_mirror.is_some() {
            let critic = &mut batch.critic[row * (OBSERVATION + 1)..][..=OBSERVATION];
            critic[OBSERVATION] = pay;
        }
    }
    assert_eq!(learning.sigma().len(), ACTION);
    batch
}

fn iterate(learning: &mut Learning, robot: &Robot, seed: u64) -> IterationReport {
    let batch = batch(learning, robot, seed);
    let mut rng = Pcg64::seed_from_u64(1000 + seed);
    let mut experts = |rows: &mut [f32]| {
        assert_eq!(rows.len() % (2 * FEATURES), 0);
        rows.iter_mut()
            .for_each(|x| *x = rng.random_range(-1.0..1.0));
    };
    let rule = Rule::Fixed { style_weight: 0.0 };
    learning
        .iterate(&batch, &mut experts, rule, Granularity::Sample)
        .expect("finite")
}

#[test]
fn it_foresees_what_the_policys_numbers_do_not_tell() {
    let foreseen = |robot: Robot| {
        let mut learning = learning(robot.clone(), config());
        (0..80)
            .map(|seed| iterate(&mut learning, &robot, seed).explained_variance)
            .last()
            .unwrap()
    };
    let (seeing, blind) = (foreseen(robot()), foreseen(simple()));
    assert!(seeing > 0.5 && blind < 0.2, "{seeing} {blind}");
}

#[test]
fn it_goes_on_bit_by_bit_and_only_with_its_own_rows() {
    let (robot, mut mirrored) = (robot(), config());
    mirrored.ppo.mirrored_share = 0.5.into();
    let mut before = learning(robot.clone(), mirrored.clone());
    iterate(&mut before, &robot, 1);
    iterate(&mut before, &robot, 2);
    let bytes = before.save();
    let mut after = learning(robot.clone(), mirrored.clone());
    after.load(&bytes).unwrap();
    assert_eq!(after.save(), bytes);
    assert_eq!(
        iterate(&mut before, &robot, 3),
        iterate(&mut after, &robot, 3)
    );
    assert_eq!(before.save(), after.save());

    let mut shared = learning(simple(), mirrored.clone());
    let said = shared.load(&bytes).unwrap_err().to_string();
    assert!(
        said.contains("[83, 16]") && said.contains("[82, 16]"),
        "{said}"
    );
    let said = after.load(&shared.save()).unwrap_err().to_string();
    assert!(said.contains("critic"), "{said}");
    assert_eq!(after.save(), before.save());
    // As wide as the policy's, and still others.
    let same_width = Robot {
        critic_mirror: Some(simple().observation_mirror),
        ..simple()
    };
    let mut same = learning(same_width, mirrored);
    let said = same.load(&shared.save()).unwrap_err().to_string();
    assert!(said.contains("rows of its own"), "{said}");
    let mut damaged = bytes.clone();
    damaged.push(0);
    assert!(
        after
            .load(&damaged)
            .unwrap_err()
            .to_string()
            .contains("too many")
    );
}

#[test]
fn statistics_of_both_sides_stay_alike() {
    let (robot, mut mirrored) = (robot(), config());
    mirrored.ppo.mirrored_share = 0.5.into();
    let mut learning = learning(robot.clone(), mirrored);
    iterate(&mut learning, &robot, 1);
    // Each row and its reflection: the sign of the last number cancels.
    let scaling = learning.core.critic.as_ref().unwrap().scaling();
    assert!(
        scaling.mean[OBSERVATION].abs() < 1e-6,
        "{}",
        scaling.mean[OBSERVATION]
    );
}

#[test]
fn rows_of_other_widths_are_refused() {
    let mut learning = learning(robot(), config());
    let batch = batch(&learning, &simple(), 1);
    let mut none = |_: &mut [f32]| unreachable!("the batch is refused before");
    let refused = learning.iterate(&batch, &mut none, RULE, Granularity::Sample);
    let said = refused.unwrap_err().to_string();
    assert!(
        said.contains("critic: 0") && said.contains("critic: 83"),
        "{said}"
    );
    let tilted = Robot {
        critic_mirror: Some(Mirror {
            index: vec![1, 1],
            sign: vec![1.0; 2],
        }),
        ..simple()
    };
    assert!(Learning::new(config(), tilted, 1).is_err());
}

//! Ground as steep and as rough as asked for, the same in both engines, and robots that stand on it.

use super::*;
use crate::{Fleet, Physics, RandomizationConfig, Starts, StepRows, TaskConfig};
use g1::ACTION;
use vocabulary::Section;

const HILLY: GroundConfig = GroundConfig {
    slope: 5.0,
    bumps: 0.0,
};

const ROUGH: GroundConfig = GroundConfig {
    slope: 5.0,
    bumps: 0.02,
};

/// Least distance of a sole's corner from the ground below it, m; of a state as it is told.
fn clearance(ground: &Ground, told: &RobotState) -> f32 {
    let mut state = *told;
    state.position.z += ground.height(state.position.x, state.position.y);
    let bodies = kinematics::forward_state(&state);
    let soles = [LEFT_FOOT, RIGHT_FOOT].map(|foot| kinematics::sole_points(&bodies, foot));
    let above = |corner: &nalgebra::Point3<f32>| corner.z - ground.height(corner.x, corner.y);
    soles.iter().flatten().map(above).fold(f32::MAX, f32::min)
}

fn fleet(physics: Physics, ground: GroundConfig) -> Fleet {
    let task = TaskConfig {
        ground: Some(ground),
        ..TaskConfig::default()
    };
    let plain = RandomizationConfig::default();
    Fleet::new(physics, &task, &plain, Starts::default(), 6, 3).unwrap()
}

#[test]
fn hills_are_as_steep_as_asked_for_and_nowhere_steeper() {
    let ground = HILLY.lay(1);
    let (mut steepest, mut highest, mut ways) = (0.0_f32, 0.0_f32, [false; 4]);
    let mut x = -EXTENT;
    while x < EXTENT {
        let mut y = -EXTENT;
        while y < EXTENT {
            let here = ground.height(x, y);
            let slopes = [
                (ground.height(x + 0.01, y) - here) / 0.01,
                (ground.height(x, y + 0.01) - here) / 0.01,
            ];
            steepest = steepest.max(slopes[0].hypot(slopes[1]));
            highest = highest.max(here);
            ways[usize::from(slopes[0] > 0.0) + 2 * usize::from(slopes[1] > 0.0)] |=
                slopes[0].abs().min(slopes[1].abs()) > 0.02;
            assert!(here >= 0.0, "{here}");
            y += 0.13;
        }
        x += 0.13;
    }
    // tan 5° = 0.0875; a grid of 25 cm cuts its corners a little.
    assert!((0.080..0.0885).contains(&steepest), "{steepest}");
    // H = 0.0875·6/π = 16.7 cm from valley to top.
    assert!((0.160..0.168).contains(&highest), "{highest}");
    assert_eq!(ways, [true; 4], "uphill to every side");
    assert_eq!(ground.height(EXTENT, 0.0), 0.0);
    assert_eq!(ground.height(-3.0, EXTENT + 5.0), 0.0);
}

#[test]
fn bumps_are_between_nothing_and_their_height() {
    let bumpy = GroundConfig {
        slope: 0.0,
        bumps: 0.02,
    };
    let (ground, other) = (bumpy.lay(1), bumpy.lay(2));
    let heights: Vec<f32> = (0..40)
        .flat_map(|i| (0..40).map(move |j| (0.25 * i as f32, 0.25 * j as f32)))
        .map(|(x, y)| ground.height(x, y))
        .collect();
    assert!(heights.iter().all(|height| (0.0..=0.02).contains(height)));
    let mean = heights.iter().sum::<f32>() / 1_600.0;
    // 1 cm; of 1,600 even draws the mean strays by 0.02/√12/40 = 0.14 mm.
    assert!((mean - 0.01).abs() < 0.0006, "{mean}");
    assert_ne!(ground.height(1.0, 1.0), other.height(1.0, 1.0));
}

#[test]
fn robots_begin_over_the_ground_and_stand_on_it_in_both_engines() {
    let ground = ROUGH.lay(3);
    for physics in [Physics::Rapier, Physics::Batched] {
        let mut fleet = fleet(physics, ROUGH);
        let mut places = Vec::new();
        for robot in 0..fleet.len() {
            let state = fleet.state(robot);
            // The lift of starts is 5 mm.
            assert!(clearance(&ground, state) > 0.0049, "{physics:?} {robot}");
            assert!(state.position.x.abs() <= START && state.position.y.abs() <= START);
            // No higher than hill and bumps under a foot 20 cm away ask for: 1.8 + 2 cm and the lift.
            let above = state.position.z - RobotState::standing().position.z;
            assert!(
                (-1e-4..0.05).contains(&above),
                "{physics:?} {robot}: {above}"
            );
            places.push(state.position.x);
        }
        assert!(places.windows(2).all(|pair| pair[0] != pair[1]));
        let mut rows = StepRows::of(&fleet, 0.0);
        for _ in 0..15 {
            fleet.step(&vec![0.0; fleet.len() * ACTION], &mut rows.out());
        }
        for robot in 0..fleet.len() {
            // Between triangles and the bilinear cell lies a quarter of a bump, 5 mm, at most.
            let left = clearance(&ground, fleet.state(robot));
            assert!(
                (-0.012..0.01).contains(&left),
                "{physics:?} {robot}: {left}"
            );
            let force: f32 = rows.foot_forces[2 * robot..][..2].iter().sum();
            assert!(
                (150.0..600.0).contains(&force),
                "{physics:?} {robot}: {force} N of 315"
            );
        }
    }
}

#[test]
fn a_fleet_on_hills_goes_on_bit_by_bit() {
    for physics in [Physics::Rapier, Physics::Batched] {
        let mut one = fleet(physics, ROUGH);
        let mut rows = StepRows::of(&one, 0.0);
        let actions = vec![0.1; one.len() * ACTION];
        for _ in 0..5 {
            one.step(&actions, &mut rows.out());
        }
        let mut other = fleet(physics, ROUGH);
        other.restore(&one.save()).unwrap();
        for _ in 0..5 {
            one.step(&actions, &mut rows.out());
            other.step(&actions, &mut rows.out());
        }
        assert_eq!(one.observations(), other.observations(), "{physics:?}");
    }
}

#[test]
fn what_no_ground_may_be_is_refused_with_its_path() {
    for (text, path) in [
        ("[ground]\nslope = 5.5", "ground.slope"),
        ("[ground]\nslope = -1.0", "ground.slope"),
        ("[ground]\nslope = nan", "ground.slope"),
        ("[ground]\nbumps = 0.03", "ground.bumps"),
    ] {
        let task: TaskConfig = toml::from_str(text).unwrap();
        assert_eq!(task.validate().unwrap_err().path, path, "{text}");
    }
    let task: TaskConfig = toml::from_str("[ground]\nslope = 3.0").unwrap();
    task.validate().unwrap();
    assert_eq!(task.ground.unwrap().bumps, 0.0);
    assert_eq!(TaskConfig::default().ground, None);
    assert!(toml::from_str::<TaskConfig>("[ground]\nhills = 3.0").is_err());
}

//! Starts: drawn by weight, noisy within limits, above the ground.

use super::*;
use rand::SeedableRng;
use rand_pcg::Pcg64Mcg;

fn frames() -> Starts {
    let mut crouched = RobotState::standing();
    crouched.position.z = 0.6; // soles 18 cm underground
    let mut flying = RobotState::standing();
    flying.position.z += 0.1;
    Starts {
        states: vec![crouched, flying],
        commands: vec![[0.8, 0.0, 0.0], [2.2, 0.0, 0.0]],
        cumulative_weights: vec![1.0, 4.0],
    }
}

fn clearance(state: &RobotState) -> f32 {
    kinematics::lowest_foot_point(&kinematics::forward_state(state))
}

#[test]
fn frames_are_drawn_by_weight_and_lifted_out_of_the_ground() {
    let start = StartConfig {
        position_noise: 0.0,
        velocity_noise: 0.0,
        ..StartConfig::default()
    };
    let commands = CommandConfig {
        matched_share: Ramp::Constant(1.0),
        ..CommandConfig::default()
    };
    let mut rng = Pcg64Mcg::seed_from_u64(1);
    let mut flying = 0;
    for _ in 0..1_000 {
        let Beginning {
            state,
            command,
            fits,
        } = draw(&frames(), None, &start, &commands, &mut rng);
        assert!(fits);
        if command[0] == 2.2 {
            flying += 1;
            assert!((clearance(&state) - 0.1).abs() < 1e-5);
        } else {
            assert_eq!(command, [0.8, 0.0, 0.0]);
            assert!((clearance(&state) - 0.005).abs() < 1e-5);
        }
    }
    // Weight 3 of 4: Binomial(1000, ¾) is 750 ± 13.7.
    assert!((682..818).contains(&flying), "{flying}");
}

#[test]
fn noise_keeps_its_size_and_the_joint_limits() {
    let mut frame = RobotState::standing();
    frame.joint_positions[3] = JOINT_TABLE[3].lower as f32; // left knee stretched out
    let start = StartConfig::default();
    let mut rng = Pcg64Mcg::seed_from_u64(2);
    let mut greatest = [0.0_f32; 2];
    for _ in 0..200 {
        let mut state = frame;
        perturb(&mut state, &start, &mut rng);
        for i in 0..g1::JOINTS {
            let moved = (state.joint_positions[i] - frame.joint_positions[i]).abs();
            greatest[0] = greatest[0].max(moved);
            greatest[1] = greatest[1].max(state.joint_velocities[i].abs());
        }
        assert!(state.joint_positions[3] >= frame.joint_positions[3]);
    }
    assert!((0.0195..=0.0201).contains(&greatest[0]), "{greatest:?}");
    assert!((0.0975..=0.1).contains(&greatest[1]), "{greatest:?}");
}

#[test]
fn without_motion_or_share_the_robot_stands() {
    let commands = CommandConfig::default();
    let mut rng = Pcg64Mcg::seed_from_u64(3);
    let start = StartConfig {
        reference_share: Ramp::Constant(0.0),
        position_noise: 0.0,
        velocity_noise: 0.0,
        ..StartConfig::default()
    };
    for starts in [Starts::default(), frames()] {
        let Beginning {
            state,
            command,
            fits,
        } = draw(&starts, None, &start, &commands, &mut rng);
        assert_eq!(state.joint_positions, g1::DEFAULT_POSE);
        assert!(!fits);
        assert!((0.4..=1.2).contains(&command[0]));
    }
}

#[test]
fn mismatched_lists_are_refused() {
    let mut starts = frames();
    starts.commands.pop();
    assert!(starts.validate().is_err());
    let mut starts = frames();
    starts.cumulative_weights = vec![2.0, 1.0];
    assert!(starts.validate().is_err());
    frames().validate().unwrap();
    Starts::default().validate().unwrap();
}

#[test]
fn motion_that_ranges_will_ask_for_waits_until_they_do() {
    let (start, starts) = (StartConfig::default(), frames());
    let moving = |to: f32, samples: f64| {
        let mut commands = CommandConfig {
            forward: Ramp::moving([0.4, 1.0], [0.4, to], [1e6, 2e6]),
            matched_share: Ramp::Constant(1.0),
            ..CommandConfig::default()
        };
        commands.set(samples);
        commands
    };
    let mut rng = Pcg64Mcg::seed_from_u64(4);
    let mut fast = |commands: &CommandConfig| {
        let drawn = (0..200).map(|_| draw(&starts, None, &start, commands, &mut rng).command[0]);
        drawn.filter(|speed| *speed == 2.2).count()
    };
    // Three quarters of the frames are at 2.2 m/s: 16 in a row are once in a hundred.
    assert!(fast(&moving(2.5, 0.0)) < 10);
    // Binomial(200, ¾): 150 ± 6, when they have moved, and of motion that they never ask for.
    assert!((110..190).contains(&fast(&moving(2.5, 2e6))));
    assert!((110..190).contains(&fast(&moving(1.2, 0.0))));
}

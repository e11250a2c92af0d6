//! What a lot draws, and what comes of it.

use super::*;
use g1::JOINT_TABLE;
use observation::Lot as Told;
use rand::SeedableRng;
use rand_pcg::Pcg64Mcg;

fn draw(text: &str, seed: u64) -> (Lot, Variation) {
    let table: EventConfig = toml::from_str(text).unwrap();
    let mut variation = Variation::NOMINAL;
    let lot = Lot::draw(&table, &mut variation, &mut Pcg64Mcg::seed_from_u64(seed));
    (lot, variation)
}

#[test]
fn targets_act_as_late_as_the_delay_says() {
    for delay in 0..=GREATEST_DELAY {
        let seconds = delay as f32 * PHYSICS_STEP;
        let (mut lot, _) = draw(
            &format!("action_delay = {{ range = [{seconds}, {seconds}] }}"),
            1,
        );
        lot.begin(&RobotState::standing());
        let mut acted = Vec::new();
        for step in 1..=5 {
            let targets = lot.targets(&[step as f32; JOINTS]);
            acted.extend(targets.map(|targets| targets[22]));
        }
        // What was set before physics step 4·(n − 1) acts `delay` of them later.
        for (at, target) in acted.into_iter().enumerate().skip(delay) {
            assert_eq!(target, ((at - delay) / SUBSTEPS + 1) as f32, "{delay} {at}");
        }
    }
}

#[test]
fn a_motor_with_a_misread_joint_holds_it_off() {
    let (mut lot, _) = draw("encoder_offset = { range = [0.02, 0.02] }", 1);
    lot.begin(&RobotState::standing());
    let seen = lot.seen().joint_positions[3] - RobotState::standing().joint_positions[3];
    assert!((seen - 0.02).abs() < 1e-6, "{seen}");
    let targets = lot.targets(&[0.5; JOINTS]);
    assert!(
        targets
            .iter()
            .flatten()
            .all(|target| (target - 0.48).abs() < 1e-6)
    );
}

#[test]
fn factors_are_of_the_robots_own_motors_and_each_joint_has_one() {
    let (lot, variation) = draw(
        "stiffness = { range = [0.8, 1.2] }\ndamping = { range = [0.5, 0.5] }\n\
         motor_strength = { range = [0.9, 0.9] }\njoint_friction = { range = [0.5, 0.5] }\n\
         joint_damping = { range = [0.1, 0.1] }",
        2,
    );
    let condition = lot.condition();
    for (i, joint) in JOINT_TABLE.iter().enumerate() {
        let factor = condition.motors.stiffness[i] / joint.kp as f32;
        assert!((0.8..=1.2).contains(&factor), "{factor}");
        assert_eq!(condition.motors.damping[i], 0.5 * joint.kd as f32);
        assert!((condition.motors.effort[i] - 0.9 * joint.effort as f32).abs() < 1e-4);
    }
    let [first, second, ..] = lot.stiffness;
    assert_ne!(first, second);
    assert_eq!(
        (condition.friction, condition.drag),
        ([0.5; JOINTS], [0.1; JOINTS])
    );
    assert!(condition.curves.is_none() && variation == Variation::NOMINAL);
    let (fading, _) = draw("torque_speed = true", 2);
    assert_eq!(fading.condition().curves, Some(CURVES));
}

#[test]
fn a_slope_is_gravity_that_leans_and_is_seen_so() {
    let mut mean = Vector3::zeros();
    for seed in 0..400 {
        let (mut lot, _) = draw("slope = { range = [0.087, 0.087] }", seed);
        let gravity = Vector3::from(lot.condition().gravity);
        assert!((gravity.norm() - 9.81).abs() < 1e-4);
        assert!((gravity.z + 9.81 * 0.087_f32.cos()).abs() < 1e-4);
        mean += gravity / 400.0;
        // Upright on the level floor of the simulation, it sees down where gravity pulls.
        lot.begin(&RobotState::standing());
        let seen = lot.seen();
        assert!((seen.projected_gravity() - gravity / 9.81).norm() < 1e-5);
        assert_eq!(seen.position, RobotState::standing().position);
        let mut truth = Truth::NOMINAL;
        lot.tell(&mut truth);
        assert!((Vector3::from(truth.lot.down) - gravity / 9.81).norm() < 1e-6);
    }
    // From all sides: each part of a direction has a deviation of 0.6 m/s² / √400.
    assert!(mean.x.abs() < 0.15 && mean.y.abs() < 0.15, "{mean}");
}

#[test]
fn loads_and_floors_go_where_those_of_table_one_do() {
    let text = "payload = { range = [4.0, 4.0] }\nground_friction = { range = [0.3, 0.3] }";
    let table: EventConfig = toml::from_str(text).unwrap();
    let mut variation = Variation {
        torso_mass: 0.5,
        ..Variation::NOMINAL
    };
    let lot = Lot::draw(&table, &mut variation, &mut Pcg64Mcg::seed_from_u64(1));
    assert_eq!((variation.torso_mass, variation.friction), (4.5, 0.3));
    // Nothing else is touched.
    assert_eq!(lot.condition(), Condition::nominal(lot.condition().motors));
    let mut truth = Truth::NOMINAL;
    lot.tell(&mut truth);
    assert_eq!(truth.lot, Told::NOMINAL);
}

#[test]
fn delays_are_whole_physics_steps_and_fill_their_range() {
    let text =
        "action_delay = { range = [0.0, 0.04] }\nobservation_delay = { range = [0.01, 0.02] }";
    let lots: Vec<Lot> = (0..400).map(|seed| draw(text, seed).0).collect();
    for steps in 0..=GREATEST_DELAY {
        assert!(lots.iter().any(|lot| lot.delay == steps), "{steps}");
    }
    assert!(
        lots.iter()
            .all(|lot| lot.is_sound() && (2..=4).contains(&lot.senses.delay))
    );
    let mut truth = Truth::NOMINAL;
    lots[0].tell(&mut truth);
    let [action, observation] = truth.lot.delays;
    assert_eq!(action, lots[0].delay as f32 * 0.005);
    assert_eq!(observation, lots[0].senses.delay as f32 * 0.005);
    let mut damaged = lots[0].clone();
    damaged.delay = GREATEST_DELAY + 1;
    assert!(!damaged.is_sound());
}

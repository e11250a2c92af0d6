//! The same states and the same flight in MuJoCo, as `deploy/transfer/reference.py` wrote them.
//!
//! Contact is left out, that of the robot with itself too: two engines' contacts are two models, while what they see of a state and how free bodies and
//! motors move has one answer.

use g1::{JOINTS, OBSERVATION, RobotState, state};
use serde_json::Value;
use sim::{
    CommandConfig, FallConfig, Fleet, Mechanics, Physics, RandomizationConfig, StartConfig, Starts,
    StepRows, TaskConfig, TerminationConfig, TimeOutConfig,
};

const ENGINES: [Physics; 2] = [Physics::Rapier, Physics::Batched];

const REFERENCE: &str = include_str!("mujoco.json");

fn numbers<const N: usize>(value: &Value) -> [f32; N] {
    let list = value.as_array().expect("a list");
    let numbers: Vec<f32> = list.iter().map(|x| x.as_f64().unwrap() as f32).collect();
    numbers.try_into().expect("as many as asked for")
}

fn robot_state(value: &Value) -> RobotState {
    let [w, x, y, z] = numbers(&value["orientation"]);
    RobotState {
        position: numbers::<3>(&value["position"]).into(),
        orientation: state::quaternion(w, x, y, z),
        linear_velocity: numbers::<3>(&value["linear_velocity"]).into(),
        angular_velocity: numbers::<3>(&value["angular_velocity"]).into(),
        joint_positions: numbers(&value["joint_positions"]),
        joint_velocities: numbers(&value["joint_velocities"]),
    }
}

/// One robot in exactly this state, high up, that no rule ends.
fn placed(physics: Physics, flight: &Value) -> Fleet {
    let start = robot_state(&flight["state"]);
    let command = numbers(&flight["command"]);
    let task = TaskConfig {
        termination: TerminationConfig {
            fall: FallConfig {
                height: 0.0,
                upright: -1.0,
            },
            time_out: TimeOutConfig {
                staggered: false,
                ..TimeOutConfig::default()
            },
            ..TerminationConfig::default()
        },
        start: StartConfig {
            reference_share: 1.0.into(),
            lift: 0.0,
            position_noise: 0.0,
            velocity_noise: 0.0,
        },
        command: CommandConfig {
            matched_share: 1.0.into(),
            ..CommandConfig::default()
        },
        ..TaskConfig::default()
    };
    let starts: Starts = [(start, command, 1.0)].into_iter().collect();
    let mut fleet = Fleet::new(
        Mechanics {
            physics,
            self_collision: false,
        },
        &task,
        &RandomizationConfig::default(),
        starts,
        1,
        0,
    )
    .unwrap();
    fleet.hold_command(0, command);
    fleet
}

fn flights() -> Vec<(Physics, Value)> {
    let reference: Value = serde_json::from_str(REFERENCE).unwrap();
    assert!((reference["mass"].as_f64().unwrap() - g1::links::total_mass()).abs() < 1e-9);
    let flights = reference["flights"].as_array().unwrap();
    ENGINES
        .iter()
        .flat_map(|engine| flights.iter().map(|flight| (*engine, flight.clone())))
        .collect()
}

#[test]
fn both_see_the_same_at_the_start() {
    for (engine, flight) in flights() {
        let fleet = placed(engine, &flight);
        let expected: [f32; OBSERVATION] = numbers(&flight["observation"]);
        for (i, (ours, theirs)) in fleet.observations().iter().zip(expected).enumerate() {
            assert!(
                (ours - theirs).abs() < 1e-4,
                "{engine:?}, number {i}: {ours} and {theirs}"
            );
        }
    }
}

#[test]
fn open_loop_joints_stay_together_for_a_fifth_of_a_second_in_the_air() {
    for (engine, flight) in flights() {
        let mut fleet = placed(engine, &flight);
        let mut rows = StepRows::of(&fleet, 0.0);
        let steps = flight["steps"].as_array().unwrap();
        assert_eq!(steps.len(), 10, "0.2 s at 50 Hz");
        let (mut work, mut their_work) = (0.0, 0.0);
        for (i, step) in steps.iter().enumerate() {
            let targets: [f32; JOINTS] = numbers(&step["targets"]);
            let action: [f32; JOINTS] =
                std::array::from_fn(|j| (targets[j] - g1::DEFAULT_POSE[j]) / g1::ACTION_SCALE);
            fleet.step(&action, &mut rows.out());
            work += rows.energies[0];
            their_work += step["work"].as_f64().unwrap() as f32;
            let expected: [f32; JOINTS] = numbers(&step["joint_positions"]);
            let ours = fleet.state(0).joint_positions;
            let squares = ours.iter().zip(expected).map(|(a, b)| (a - b).powi(2));
            let rms = (squares.sum::<f32>() / JOINTS as f32).sqrt();
            // The joints swing by 0.3 rad and more meanwhile.
            assert!(rms < 0.005, "{engine:?}, step {i}: {rms} rad apart");
        }
        // At steps of 5 ms MuJoCo's own work is a percent or two from that of short steps.
        assert!(
            (work - their_work).abs() < 0.03 * their_work,
            "{engine:?}: {work} J and {their_work} J"
        );
    }
}

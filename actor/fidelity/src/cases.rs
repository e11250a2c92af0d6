//! The cases, each for one thing that physics must get right.
//!
//! Separate from running them because here one reads what the table means.

use crate::case::{Case, Gains, HOLD, Push, STEP};
use g1::{DEFAULT_POSE, JOINT_TABLE, JOINTS, RobotState, joints};
use nalgebra::{UnitQuaternion, Vector3};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

/// Length of the stress run, s.
const STRESS_SECONDS: f64 = 20.0;
/// Seconds of standing before the sideways pull begins, s.
pub(crate) const SETTLING: f64 = 1.0;

/// A joint that is driven into a stop, and whether that is its upper one.
pub(crate) const STOPS: [(usize, bool); 4] = [
    (joints::LEFT_LEG + 3, false), // knee, stretched
    (joints::RIGHT_LEG + 1, true), // hip roll, inward
    (joints::RIGHT_LEG + 4, true), // ankle pitch, toes up
    (joints::LEFT_ARM + 3, true),  // elbow
];

/// All cases but the stress run.
pub fn all() -> Vec<Case> {
    let mut cases = vec![tumble(), posing(), drop(), stand(), squat(), creep()];
    cases.extend(STOPS.map(|(joint, upper)| into_stop(joint, upper)));
    cases.extend([legs(), arm()]);
    cases
}

fn lifted(height: f32) -> RobotState {
    let mut state = RobotState::standing();
    state.position.z += height;
    state
}

/// Limp and turning in free fall, far from every stop: nothing but inertia and gravity.
pub fn tumble() -> Case {
    let mut start = lifted(10.0);
    start.orientation = UnitQuaternion::from_euler_angles(0.4, -0.3, 1.1);
    start.angular_velocity = Vector3::new(-0.45, 0.3, 0.9);
    for leg in [joints::LEFT_LEG, joints::RIGHT_LEG] {
        start.joint_positions[leg] = -0.6;
        start.joint_positions[leg + 3] = 1.2;
    }
    for (i, speed) in start.joint_velocities.iter_mut().enumerate() {
        *speed = 0.15 * (2.3 * i as f32 + 1.0).cos();
    }
    for leg in [joints::LEFT_LEG, joints::RIGHT_LEG] {
        start.joint_velocities[leg + 3] = 0.3;
    }
    Case::new("tumble", 1.0, start, Gains::limp())
}

/// The robot's own motors take the joints to a new pose in free fall.
pub fn posing() -> Case {
    let mut case = Case::new("posing", 0.5, lifted(10.0), Gains::of_the_robot());
    for (i, target) in case.targets[0].iter_mut().enumerate() {
        *target += 0.15 * (1.7 * i as f32).cos();
    }
    case
}

/// From 10 cm onto stiff legs.
pub fn drop() -> Case {
    Case {
        refined: true,
        ..Case::new("drop", 1.0, lifted(0.1), Gains::stiff())
    }
}

/// Ten seconds on stiff legs.
pub fn stand() -> Case {
    Case {
        refined: true,
        ..Case::new("stand", 10.0, RobotState::standing(), Gains::stiff())
    }
}

/// Two deep knee bends in four seconds, soles level.
pub fn squat() -> Case {
    let mut case = Case::new("squat", 4.0, RobotState::standing(), Gains::stiff());
    let holds = case.steps / HOLD;
    case.targets = (0..holds)
        .map(|hold| {
            let time = (hold * HOLD) as f64 * STEP;
            let bend = 0.4 * (1.0 - (std::f64::consts::PI * time).cos()) as f32;
            let mut pose = DEFAULT_POSE;
            for leg in [joints::LEFT_LEG, joints::RIGHT_LEG] {
                pose[leg] -= 0.5 * bend;
                pose[leg + 3] += bend;
                pose[leg + 4] -= 0.5 * bend;
            }
            pose
        })
        .collect();
    case.refined = true;
    case
}

/// Standing while a twentieth of gravity pulls sideways: dry friction holds.
pub fn creep() -> Case {
    Case {
        pull: [0.0, 0.05 * 9.81, 0.0],
        pull_from: (SETTLING / STEP) as usize,
        ..Case::new(
            "creep",
            SETTLING + 3.0,
            RobotState::standing(),
            Gains::stiff(),
        )
    }
}

/// The robot's own motor drives a joint past its stop in free fall.
fn into_stop(joint: usize, upper: bool) -> Case {
    let name = format!("stop {}", JOINT_TABLE[joint].name);
    let mut case = Case::new(&name, 0.8, lifted(10.0), Gains::of_the_robot());
    case.targets[0][joint] = if upper {
        JOINT_TABLE[joint].upper as f32 + 1.5
    } else {
        JOINT_TABLE[joint].lower as f32 - 1.5
    };
    // A leg on its way inward finds the other one out of it.
    let (roll, other) = (joints::RIGHT_LEG + 1, joints::LEFT_LEG + 1);
    if joint == roll {
        case.start.joint_positions[other] = 0.6;
        case.targets[0][other] = 0.6;
    }
    case
}

/// The robot's own motors roll both hips inward in free fall until the legs meet.
pub(crate) fn legs() -> Case {
    let mut case = Case::new("legs", 1.0, lifted(10.0), Gains::of_the_robot());
    case.targets[0][joints::LEFT_LEG + 1] = -0.5;
    case.targets[0][joints::RIGHT_LEG + 1] = 0.5;
    case.refined = true;
    case
}

/// The left arm is pulled in and across in free fall until it meets the trunk.
pub(crate) fn arm() -> Case {
    let mut case = Case::new("arm", 1.0, lifted(10.0), Gains::of_the_robot());
    case.targets[0][joints::LEFT_ARM + 1] = -0.6;
    case.targets[0][joints::LEFT_ARM + 2] = -1.0;
    case.refined = true;
    case
}

/// Robots of the stress run: targets within ±2.5 rad of the default pose, 2 m/s of push a second.
pub fn stress(robots: usize) -> Vec<Case> {
    let case = |robot: usize| {
        let mut random = Pcg64Mcg::seed_from_u64(robot as u64);
        let name = format!("stress {robot}");
        let start = RobotState::standing();
        let mut case = Case::new(&name, STRESS_SECONDS, start, Gains::of_the_robot());
        case.every = (1.0 / STEP) as usize;
        let mut pose = DEFAULT_POSE;
        case.targets = (0..case.steps / HOLD)
            .map(|hold| {
                if hold % 10 == 0 {
                    for i in 0..JOINTS {
                        pose[i] = DEFAULT_POSE[i] + random.random_range(-2.5..2.5_f32);
                    }
                }
                pose
            })
            .collect();
        case.pushes = (0..STRESS_SECONDS as usize)
            .map(|second| Push {
                at: 50 * second + robot % 50,
                change: [
                    random.random_range(-2.0..2.0),
                    random.random_range(-2.0..2.0),
                    0.0,
                ],
            })
            .collect();
        case
    };
    (0..robots).map(case).collect()
}

//! Joint motors: a position controller with a torque limit, hard stops, and the work that it takes.
//!
//! Separate because the torque has to be known exactly, for energy is an objective of the study.
//! rapier's own motors are not used: they add a constraint row each, creep under load, and keep
//! their torque to themselves. Instead each joint's passive spring is set every physics step so that
//! it pulls with the torque we want; damping is rapier's implicit one, which is stable at any gain.

use crate::world::{BASE_DEGREES, HINGE_AXIS};
use g1::{ACTION_SCALE, DEFAULT_POSE, JOINT_TABLE, JOINTS};
use rapier3d::dynamics::{JointAxesMask, JointLimits, Multibody};

/// Stiffness of the spring that carries a torque τ by resting τ/ε away, N·m/rad. Small enough that
/// its own pull over a step (ε·q̇·dt, below 1e-4 N·m) does not matter, large enough for f32.
const CARRIER_STIFFNESS: f32 = 1e-3;

/// Gains and limits of every joint's motor.
#[derive(Clone, Debug, PartialEq)]
pub struct Gains {
    /// kp, N·m/rad.
    pub stiffness: [f32; JOINTS],
    /// kd, N·m·s/rad.
    pub damping: [f32; JOINTS],
    /// Greatest torque, N·m.
    pub effort: [f32; JOINTS],
}

impl Gains {
    /// The robot's own (`g1::JOINT_TABLE`).
    pub fn of_the_robot() -> Self {
        Self {
            stiffness: JOINT_TABLE.map(|joint| joint.kp as f32),
            damping: JOINT_TABLE.map(|joint| joint.kd as f32),
            effort: JOINT_TABLE.map(|joint| joint.effort as f32),
        }
    }
}

/// Target positions of an action, rad: default pose + 0.25·a.
pub fn targets(action: &[f32; JOINTS]) -> [f32; JOINTS] {
    std::array::from_fn(|i| DEFAULT_POSE[i] + ACTION_SCALE * action[i])
}

/// Torques of one physics step, as τ = constant − damping·q̇⁺ with q̇⁺ the speed after the step.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Torques {
    constant: [f32; JOINTS],
    damping: [f32; JOINTS],
}

/// Sets the multibody's springs, dampers and stops for the coming physics step:
/// τ = kp·(target − q) − kd·q̇⁺, or ±effort where kp·(target − q) − kd·q̇ is beyond it.
pub(crate) fn drive(gains: &Gains, targets: &[f32; JOINTS], multibody: &mut Multibody) -> Torques {
    let mut torques = Torques {
        constant: [0.0; JOINTS],
        damping: [0.0; JOINTS],
    };
    for i in 0..JOINTS {
        let q = position(multibody, i);
        let speed = multibody.generalized_velocity()[BASE_DEGREES + i];
        let pull = gains.stiffness[i] * (targets[i] - q);
        let asked = pull - gains.damping[i] * speed;
        if asked.abs() <= gains.effort[i] {
            torques.constant[i] = pull;
            torques.damping[i] = gains.damping[i];
        } else {
            torques.constant[i] = asked.clamp(-gains.effort[i], gains.effort[i]);
        }
        multibody.damping_mut()[BASE_DEGREES + i] = torques.damping[i];
        let joint = &mut multibody.link_mut(i + 1).expect("a link per joint").joint;
        joint.set_spring(
            HINGE_AXIS,
            CARRIER_STIFFNESS,
            q + torques.constant[i] / CARRIER_STIFFNESS,
        );
        // A stop acts only on a joint that is beyond it, but costs a solve of the mass matrix
        // always; so it is there only then, with the same result.
        let (lower, upper) = (JOINT_TABLE[i].lower as f32, JOINT_TABLE[i].upper as f32);
        if q < lower || q > upper {
            joint.data.limits[HINGE_AXIS] = JointLimits {
                min: lower,
                max: upper,
                impulse: 0.0,
            };
            joint.data.limit_axes = JointAxesMask::ANG_X;
        } else {
            joint.data.limit_axes = JointAxesMask::empty();
        }
    }
    torques
}

/// Positive work of a physics step, J: E = Σᵢ max(0, τᵢ·q̇ᵢ)·dt (III-F).
///
/// Summed per physics step (dt = 5 ms) and not once per control step (dt = 20 ms): the target stands
/// still within a control step while the torque follows the joint, so the power can change its sign
/// inside it, and one sample would count all of it or nothing. τ is the torque that acted and q̇ the
/// speed over which it acted (the positions moved by q̇⁺·dt), so this is the work that was done.
pub(crate) fn positive_work(torques: &Torques, multibody: &Multibody, dt: f32) -> f32 {
    let velocity = multibody.generalized_velocity();
    (0..JOINTS)
        .map(|i| {
            let speed = velocity[BASE_DEGREES + i];
            (torques.of(i, speed) * speed).max(0.0)
        })
        .sum::<f32>()
        * dt
}

/// |τ| as a share of the robot's effort limit and |q̇| as a share of its velocity limit, per joint.
pub(crate) fn use_of_limits(
    torques: &Torques,
    multibody: &Multibody,
) -> ([f32; JOINTS], [f32; JOINTS]) {
    let velocity = multibody.generalized_velocity();
    let speed = |i: usize| velocity[BASE_DEGREES + i];
    let limits = |i: usize| {
        let joint = &JOINT_TABLE[i];
        (joint.effort as f32, joint.velocity_limit as f32)
    };
    (
        std::array::from_fn(|i| torques.of(i, speed(i)).abs() / limits(i).0),
        std::array::from_fn(|i| speed(i).abs() / limits(i).1),
    )
}

impl Torques {
    /// The torque that acted on a joint whose speed after the step is `speed`, N·m.
    pub(crate) fn of(&self, joint: usize, speed: f32) -> f32 {
        self.constant[joint] - self.damping[joint] * speed
    }
}

/// A joint's position, rad.
pub(crate) fn position(multibody: &Multibody, joint: usize) -> f32 {
    multibody
        .link(joint + 1)
        .expect("a link per joint")
        .joint
        .coords()[HINGE_AXIS]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::engine::Engine;
    use crate::model::Variation;
    use crate::world::{PHYSICS_STEP, World};
    use g1::RobotState;

    /// In the air, so that nothing but the motors and gravity acts.
    fn hanging() -> World {
        let mut world = World::new(&Variation::NOMINAL);
        let mut state = RobotState::standing();
        state.position.z += 3.0;
        world.set_state(&state);
        world
    }

    #[test]
    fn zero_action_asks_for_the_default_pose() {
        assert_eq!(targets(&[0.0; JOINTS]), DEFAULT_POSE);
        let mut action = [0.0; JOINTS];
        action[3] = -2.0; // left knee: 0.3 − 0.25·2
        assert!((targets(&action)[3] + 0.2).abs() < 1e-6);
    }

    #[test]
    fn torque_is_stiffness_times_error_less_damping_times_speed() {
        let mut world = hanging();
        let mut goal = DEFAULT_POSE;
        goal[3] += 0.1; // knee, 150 N·m/rad: 15 N·m
        goal[16] += 2.0; // elbow, 40 N·m/rad: 80 N·m asked, 25 given
        let gains = Gains::of_the_robot();
        let torques = drive(&gains, &goal, world.multibody_mut());
        assert!((torques.of(3, 0.0) - 15.0).abs() < 1e-3);
        assert!((torques.of(3, 0.5) - 13.0).abs() < 1e-3); // 15 − 4·0.5
        assert_eq!(torques.of(16, 0.0), 25.0);
        assert_eq!(torques.of(16, 9.0), 25.0); // saturated: constant over the step
        assert_eq!(torques.of(0, 0.0), 0.0);
    }

    #[test]
    fn the_torque_that_is_told_is_the_one_that_acted() {
        // Momentum of the whole robot about the knee's motor: with two runs from the same state,
        // one with and one without current in one joint, the work told must equal the difference in
        // what the physics gained. Told work τ·q̇⁺·dt against ½·q̇⁺·(I_eff·q̇⁺): from rest,
        // τ·dt = I_eff·q̇⁺ with I_eff = 1/(M⁻¹)ᵢᵢ.
        let mut world = hanging();
        let mut engine = Engine::new();
        let mut gains = Gains::of_the_robot();
        gains.damping = [0.0; JOINTS];
        for i in 0..JOINTS {
            if i != 3 {
                gains.stiffness[i] = 0.0;
            }
        }
        let mut goal = DEFAULT_POSE;
        goal[3] += 0.02; // 150·0.02 = 3 N·m
        let told = world.physics_step(&mut engine, &gains, &goal).energy;
        let speed = world.state().joint_velocities[3];
        assert!((told - 3.0 * speed * PHYSICS_STEP).abs() < 1e-6 * told.abs().max(1.0));
        let effective = 3.0 * PHYSICS_STEP / speed;
        // The shank and foot about the knee weigh about 0.1 kg·m², less what the thigh gives way.
        assert!((0.02..0.2).contains(&effective), "{effective} kg·m²");
        let unit = world.multibody().inv_augmented_mass();
        let mut column = nalgebra::DVector::zeros(BASE_DEGREES + JOINTS);
        column[BASE_DEGREES + 3] = 1.0;
        unit.solve_mut(&mut column);
        let expected = 1.0 / column[BASE_DEGREES + 3];
        assert!(
            (effective - expected).abs() < 0.02 * expected,
            "{effective} {expected}"
        );
    }

    #[test]
    fn limits_are_used_in_shares() {
        let mut world = hanging();
        let mut state = world.state();
        state.joint_velocities[12] = 3.2; // waist, of at most 32 rad/s
        world.set_state(&state);
        let mut gains = Gains::of_the_robot();
        gains.stiffness[12] = 0.0;
        gains.damping = [0.0; JOINTS]; // the torque below is the one at the step's start
        let mut goal = DEFAULT_POSE;
        goal[3] += 0.278; // knee: 150·0.278 = 41.7 N·m, 0.3 of 139
        goal[16] += 2.0; // elbow: 80 asked, all of its 25 given
        let mut engine = Engine::new();
        let step = world.physics_step(&mut engine, &gains, &goal);
        assert!((step.torque_use[3] - 0.3).abs() < 1e-4);
        assert_eq!(step.torque_use[16], 1.0);
        assert!(step.torque_use[12] < 1e-6);
        let waist = world.state().joint_velocities[12];
        assert!(waist > 1.0 && (step.speed_use[12] - waist / 32.0).abs() < 1e-6);
        // A control step remembers its greatest: the knee asks for less and less on its way.
        let whole = world.control_step(&mut engine, &gains, &goal);
        let last = world.physics_step(&mut engine, &gains, &goal);
        assert!(whole.torque_use[3] > last.torque_use[3]);
    }

    #[test]
    fn braking_costs_nothing() {
        let mut world = hanging();
        let mut state = world.state();
        state.joint_velocities[12] = 2.0; // waist turning
        world.set_state(&state);
        let mut gains = Gains::of_the_robot();
        gains.stiffness = [0.0; JOINTS]; // pure dampers only ever take energy
        let exertion = world.physics_step(&mut Engine::new(), &gains, &DEFAULT_POSE);
        assert_eq!(exertion.energy, 0.0);
        assert!(world.state().joint_velocities[12] < 2.0);
    }
}

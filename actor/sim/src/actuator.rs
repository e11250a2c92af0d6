//! Joint motors: a position controller with a torque limit, hard stops, and the work that it takes.
//!
//! Separate because the torque has to be known exactly, for energy is an objective of the study.
//! rapier's own motors are not used: they add a constraint row each, creep under load, and keep
//! their torque to themselves. Instead each joint's passive spring is set every physics step so that
//! it pulls with the torque we want; damping is rapier's implicit one, which is stable at any gain.

use crate::model::{BASE_DEGREES, GRAVITY, HINGE_AXIS};
use dynamics::Condition;
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

/// What the motors of a robot obey, and what rubs in its joints.
#[derive(Clone, Copy)]
pub(crate) enum Law<'a> {
    /// The gains, and nothing else.
    Table(&'a Gains),
    /// What a robot has of its own.
    Own(&'a Condition),
}

impl Law<'_> {
    /// kp, kd of a joint.
    fn gains(&self, joint: usize) -> (f32, f32) {
        match self {
            Law::Table(gains) => (gains.stiffness[joint], gains.damping[joint]),
            Law::Own(own) => (own.motors.stiffness[joint], own.motors.damping[joint]),
        }
    }

    /// The greatest torque of a joint that is asked for one at a speed, N·m.
    fn limit(&self, joint: usize, asked: f32, speed: f32) -> f32 {
        match self {
            Law::Table(gains) => gains.effort[joint],
            Law::Own(own) => own.limit(joint, asked, speed),
        }
    }

    /// What rubs in a joint, as a damping, N·m·s/rad.
    fn resistance(&self, joint: usize, speed: f32) -> f32 {
        match self {
            Law::Table(_) => 0.0,
            Law::Own(own) => own.resistance(joint, speed),
        }
    }

    /// Gravity, world frame, m/s².
    pub(crate) fn gravity(&self) -> [f32; 3] {
        match self {
            Law::Table(_) => [0.0, 0.0, -GRAVITY],
            Law::Own(own) => own.gravity,
        }
    }
}

/// Target positions of an action, rad: default pose + 0.25·a.
#[inline]
pub fn targets(action: &[f32; JOINTS]) -> [f32; JOINTS] {
    // Not by a function of the index, which becomes a call for each joint of every robot and step.
    let mut targets = DEFAULT_POSE;
    for (target, action) in targets.iter_mut().zip(action) {
        *target += ACTION_SCALE * action;
    }
    targets
}

/// Torques of one physics step, as τ = constant − damping·q̇⁺ with q̇⁺ the speed after the step.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Torques {
    constant: [f32; JOINTS],
    damping: [f32; JOINTS],
}

/// Sets the multibody's springs, dampers and stops for the coming physics step:
/// τ = kp·(target − q) − kd·q̇⁺, or ±effort where kp·(target − q) − kd·q̇ is beyond it. What rubs in a joint is damping
/// as well, and no torque of its motor.
pub(crate) fn drive(law: Law<'_>, targets: &[f32; JOINTS], multibody: &mut Multibody) -> Torques {
    let mut torques = Torques {
        constant: [0.0; JOINTS],
        damping: [0.0; JOINTS],
    };
    for i in 0..JOINTS {
        let q = position(multibody, i);
        let speed = multibody.generalized_velocity()[BASE_DEGREES + i];
        let (stiffness, damping) = law.gains(i);
        let pull = stiffness * (targets[i] - q);
        let asked = pull - damping * speed;
        let limit = law.limit(i, asked, speed);
        if asked.abs() <= limit {
            torques.constant[i] = pull;
            torques.damping[i] = damping;
        } else {
            torques.constant[i] = asked.clamp(-limit, limit);
        }
        multibody.damping_mut()[BASE_DEGREES + i] = torques.damping[i] + law.resistance(i, speed);
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
mod tests;

//! What one robot has of its own: its motors, the friction in its joints, where gravity points, a force that acts on it.
//!
//! Separate because most fleets have nothing of the kind, and must not pay for it: the step of robots without conditions
//! does not read one of these numbers.

use crate::block::{LANES, Row};
use crate::drive::Motors;
use crate::lane::{Lane, Real};
use g1::JOINTS;
use g1::motors::Curve;

/// Gravity, m/s².
pub(crate) const GRAVITY: f64 = 9.81;

/// Below this speed, rad/s, dry friction fades to nothing: Unitree's own figure of its motors, `Va` (see [`g1::motors`]).
pub const FULL_FRICTION: f32 = 0.01;

/// What is different about one robot's joints and its world, beside its [`crate::Build`].
#[derive(Clone, Debug, PartialEq)]
pub struct Condition {
    /// Its motors instead of the solver's.
    pub motors: Motors<f32>,
    /// How their torque falls with speed; none: it does not.
    pub curves: Option<[Curve; JOINTS]>,
    /// Dry friction of every joint, N·m.
    pub friction: [f32; JOINTS],
    /// Friction of every joint that grows with its speed, N·m·s/rad.
    pub drag: [f32; JOINTS],
    /// Gravity, world frame, m/s².
    pub gravity: [f32; 3],
}

impl Condition {
    /// None at all: the robot of the tables with these motors.
    pub fn nominal(motors: Motors<f32>) -> Self {
        Self {
            motors,
            curves: None,
            friction: [0.0; JOINTS],
            drag: [0.0; JOINTS],
            gravity: [0.0, 0.0, -GRAVITY as f32],
        }
    }

    /// The greatest torque of a joint that turns at `speed` (rad/s) and is asked for a torque of some sign, N·m.
    pub fn limit(&self, joint: usize, asked: f32, speed: f32) -> f32 {
        let effort = self.motors.effort[joint];
        self.curves.map_or(effort, |curves| {
            let curve = curves[joint];
            let peak = if asked * speed > 0.0 {
                curve.driving
            } else {
                curve.braking
            };
            effort.min(peak) * curve.left(speed.abs())
        })
    }

    /// What a joint's frictions amount to as a damping, N·m·s/rad, at a speed: taken implicitly it stops a slow joint and
    /// never turns one round.
    pub fn resistance(&self, joint: usize, speed: f32) -> f32 {
        self.drag[joint] + self.friction[joint] / speed.abs().max(FULL_FRICTION)
    }
}

/// The same of many robots, a number each: rows in a block, lanes in a group.
#[derive(Clone)]
pub(crate) struct Own<X> {
    pub(crate) stiffness: [X; JOINTS],
    pub(crate) damping: [X; JOINTS],
    /// Greatest torque along the speed.
    pub(crate) driving: [X; JOINTS],
    /// Greatest torque against the speed.
    pub(crate) braking: [X; JOINTS],
    /// Share of it that is left: level − fade·|q̇|, between 0 and 1.
    pub(crate) level: [X; JOINTS],
    pub(crate) fade: [X; JOINTS],
    pub(crate) friction: [X; JOINTS],
    pub(crate) drag: [X; JOINTS],
    /// Upward acceleration that stands for gravity.
    pub(crate) lift: [X; 3],
    /// On the torso's centre of mass, world frame, N.
    pub(crate) force: [X; 3],
}

impl<X: Copy> Own<X> {
    pub(crate) fn all(x: X) -> Self {
        Self {
            stiffness: [x; JOINTS],
            damping: [x; JOINTS],
            driving: [x; JOINTS],
            braking: [x; JOINTS],
            level: [x; JOINTS],
            fade: [x; JOINTS],
            friction: [x; JOINTS],
            drag: [x; JOINTS],
            lift: [x; 3],
            force: [x; 3],
        }
    }
}

impl<T: Real> Own<Row<T>> {
    /// Sixteen robots of a condition.
    pub(crate) fn of(condition: &Condition) -> Self {
        let mut own = Self::all(Row::default());
        (0..LANES).for_each(|lane| own.set(lane, condition));
        own
    }

    /// One robot's; no force acts on it.
    pub(crate) fn set(&mut self, lane: usize, condition: &Condition) {
        let number = |x: f32| T::of(f64::from(x));
        for i in 0..JOINTS {
            let effort = condition.motors.effort[i];
            let (mut peaks, mut level, mut fade) = ([effort; 2], 1.0, 0.0);
            if let Some(curves) = &condition.curves {
                let Curve {
                    knee,
                    no_load,
                    driving,
                    braking,
                } = curves[i];
                peaks = [driving, braking].map(|peak| effort.min(peak));
                fade = 1.0 / (no_load - knee);
                level = no_load * fade;
            }
            self.stiffness[i].0[lane] = number(condition.motors.stiffness[i]);
            self.damping[i].0[lane] = number(condition.motors.damping[i]);
            self.driving[i].0[lane] = number(peaks[0]);
            self.braking[i].0[lane] = number(peaks[1]);
            self.level[i].0[lane] = number(level);
            self.fade[i].0[lane] = number(fade);
            self.friction[i].0[lane] = number(condition.friction[i]);
            self.drag[i].0[lane] = number(condition.drag[i]);
        }
        for axis in 0..3 {
            self.lift[axis].0[lane] = number(-condition.gravity[axis]);
            self.force[axis].0[lane] = T::default();
        }
    }
}

impl<L: Lane> Own<L> {
    /// Torque limit of a joint that is asked for a torque at a speed.
    #[inline(always)]
    pub(crate) fn limit(&self, joint: usize, asked: L, speed: L) -> L {
        let (zero, one) = (speed.lit(0.0), speed.lit(1.0));
        let drives = zero.less(asked * speed);
        let peak = self.driving[joint].select(drives, self.braking[joint]);
        let left = self.fade[joint].neg_mul_add(speed.abs(), self.level[joint]);
        peak * left.max(zero).min(one)
    }

    /// What a joint's frictions amount to as a damping.
    #[inline(always)]
    pub(crate) fn resistance(&self, joint: usize, speed: L) -> L {
        let least = speed.lit(f64::from(FULL_FRICTION));
        self.drag[joint] + self.friction[joint] / speed.abs().max(least)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use g1::JOINT_TABLE;
    use g1::joints::index_of;
    use g1::motors::CURVES;

    #[test]
    fn one_robot_and_many_have_the_same_limits_and_frictions() {
        let motors = Motors {
            stiffness: [100.0; JOINTS],
            damping: [2.0; JOINTS],
            effort: JOINT_TABLE.map(|joint| joint.effort as f32),
        };
        let condition = Condition {
            curves: Some(CURVES),
            friction: [0.5; JOINTS],
            drag: [0.1; JOINTS],
            ..Condition::nominal(motors)
        };
        let rows = Own::<Row<f64>>::of(&condition);
        let mut own = Own::all(0.0);
        for joint in 0..JOINTS {
            own.driving[joint] = rows.driving[joint].0[7];
            own.braking[joint] = rows.braking[joint].0[7];
            own.level[joint] = rows.level[joint].0[7];
            own.fade[joint] = rows.fade[joint].0[7];
            own.friction[joint] = rows.friction[joint].0[7];
            own.drag[joint] = rows.drag[joint].0[7];
        }
        let knee = index_of("left_knee_joint").unwrap();
        // Driving at rest 111, braking 131, and half of either at 18.6 rad/s.
        for (asked, speed, limit) in [
            (100.0, 1.0, 111.0),
            (100.0, -1.0, 131.0),
            (-1.0, -18.6, 55.5),
            (1.0, -18.6, 65.5),
            (1.0, 25.0, 0.0),
        ] {
            let one = condition.limit(knee, asked, speed);
            assert!((one - limit).abs() < 1e-3, "{one} at {speed}");
            let many = own.limit(knee, f64::from(asked), f64::from(speed));
            assert!((many - f64::from(limit)).abs() < 1e-3, "{many} at {speed}");
        }
        // 0.5 N·m at 2 rad/s are 0.25 N·m·s/rad, at rest 0.5 / 0.01.
        for (speed, resistance) in [(2.0, 0.35), (-2.0, 0.35), (0.0, 50.1)] {
            assert!((condition.resistance(knee, speed) - resistance).abs() < 1e-5);
            let many = own.resistance(knee, f64::from(speed));
            assert!((many - f64::from(resistance)).abs() < 1e-4);
        }
    }
}

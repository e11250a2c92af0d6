//! Motors and stops: what acts in the joints, implicit where stiffness asks for it.
//!
//! Separate because the torque has to be known exactly, for energy is an objective of the study. The
//! law is τ = kp·(target − q − a·q̇⁺) − kd·q̇⁺ with q̇⁺ the speed after the step and a a tenth of the
//! step, or ± effort where that law, with the speed before the step, asks for more.
//!
//! With a = 0 a joint leads the solution of the equations of motion by half a step when it follows a
//! target, for the target of a step acts on all of its velocity. Half a step ahead would cure that and
//! brake free swings instead; a tenth lessens the one error and not yet adds the other.

use crate::lane::{Lane, Real};
use g1::JOINTS;

/// Gains and limits of every joint's motor.
#[derive(Clone, Debug, PartialEq)]
pub struct Motors<T> {
    /// kp, N·m/rad.
    pub stiffness: [T; JOINTS],
    /// kd, N·m·s/rad.
    pub damping: [T; JOINTS],
    /// Greatest torque, N·m.
    pub effort: [T; JOINTS],
}

impl<T: Real> Motors<T> {
    /// The same motors in numbers of another size.
    pub fn cast<U: Real>(&self) -> Motors<U> {
        Motors {
            stiffness: self.stiffness.map(|x| U::of(x.to_f64())),
            damping: self.damping.map(|x| U::of(x.to_f64())),
            effort: self.effort.map(|x| U::of(x.to_f64())),
        }
    }
}

/// Natural frequency of a joint against its stop, rad/s: a stop is a critically damped spring on the
/// joint's own inertia, implicit in time, so its stiffness needs no bound but costs no accuracy
/// either, for stops are hard in the robot.
const STOP_FREQUENCY: f64 = 150.0;

/// Share of a step by which the stiffness looks ahead. Of 0, 0.1, 0.2 and 0.5 the one with which
/// every row of posing and squatting (`ampco bench fidelity`) errs less than with 0.
pub(crate) const AHEAD: f64 = 0.1;

/// The torque of one joint over a step: τ = constant − damping·q̇⁺.
#[derive(Clone, Copy)]
pub(crate) struct Torque<L> {
    pub(crate) constant: L,
    pub(crate) damping: L,
}

impl<L: Lane> Torque<L> {
    /// Of the motor law for a joint at `q` with speed `speed`.
    #[inline(always)]
    pub(crate) fn of_motor(
        stiffness: L,
        damping: L,
        effort: L,
        target: L,
        q: L,
        speed: L,
        ahead: L,
    ) -> Self {
        let pull = stiffness * (target - q);
        let asked = damping.neg_mul_add(speed, pull);
        let beyond = effort.less(asked.abs());
        let zero = asked.lit(0.0);
        Self {
            constant: asked.max(-effort).min(effort).select(beyond, pull),
            damping: zero.select(beyond, stiffness.mul_add(ahead, damping)),
        }
    }

    /// What acted, N·m.
    #[inline(always)]
    pub(crate) fn at(&self, speed: L) -> L {
        self.damping.neg_mul_add(speed, self.constant)
    }
}

/// A stop's part in the step: what it adds to the diagonal of H and to dt·force.
#[inline(always)]
pub(crate) fn stop<L: Lane>(lower: L, upper: L, q: L, speed: L, inertia: L, dt: L) -> (L, L) {
    let zero = q.lit(0.0);
    let gap = (lower - q).max(zero) - (q - upper).max(zero);
    let out = zero.less(gap.abs());
    let rate = q.lit(STOP_FREQUENCY) * dt;
    // K·dt² = I·rate², D·dt = 2·I·rate.
    let stiffness = inertia * rate * rate;
    let resistance = (inertia + inertia).mul_add(rate, stiffness);
    let push = stiffness.mul_add(gap / dt, -(resistance * speed));
    (resistance.select(out, zero), push.select(out, zero))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn torque_is_stiffness_times_error_less_damping_times_speed() {
        // Knee: 150·0.1 = 15 N·m, less 4·0.5 after the step.
        let knee = Torque::of_motor(150.0_f64, 4.0, 139.0, 0.4, 0.3, 0.0, 0.0);
        assert!((knee.at(0.0) - 15.0).abs() < 1e-12);
        assert!((knee.at(0.5) - 13.0).abs() < 1e-12);
        // Elbow: 40·2 = 80 N·m asked, 25 given, whatever the speed after the step.
        let elbow = Torque::of_motor(40.0_f64, 1.0, 25.0, 2.0, 0.0, 0.0, 0.0005);
        assert_eq!((elbow.at(0.0), elbow.at(9.0)), (25.0, 25.0));
        let back = Torque::of_motor(40.0_f64, 1.0, 25.0, -2.0, 0.0, 0.0, 0.0005);
        assert_eq!(back.at(1.0), -25.0);
    }

    #[test]
    fn a_stop_pushes_back_only_beyond_it() {
        assert_eq!(stop(-1.0_f64, 1.0, 0.99, 5.0, 0.1, 0.005), (0.0, 0.0));
        // 0.1 rad beyond at rest: rate .75, K·dt² = .1·.5625, push K·dt·gap = .05625·20·(−.1/.1)…
        let (resistance, push) = stop(-1.0_f64, 1.0, 1.1, 0.0, 0.1, 0.005);
        assert!((resistance - (0.05625 + 0.15)).abs() < 1e-12);
        assert!((push + 0.05625 * 0.1 / 0.005).abs() < 1e-12);
        let (_, other) = stop(-1.0_f64, 1.0, -1.1, 0.0, 0.1, 0.005);
        assert!((other + push).abs() < 1e-12);
    }
}

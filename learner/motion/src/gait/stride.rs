//! A stride: human curves turned into poses of the G1 with its feet on the ground.
//!
//! Separate because walking and running differ in figures only. The base follows its curves, each
//! foot follows its [`FootPath`], the legs between are solved by inverse kinematics, the waist and
//! the arms follow their curves. The left side is the right side's reflection half a stride later,
//! so symmetry is exact. The base is carried as high as the legs allow.

use super::foot::{FootPath, lowest_offset};
use super::harmonics::Harmonics;
use super::leg;
use g1::joints::{LEFT_ARM, LEFT_LEG, RIGHT_ARM, RIGHT_LEG, WAIST};
use g1::kinematics::forward;
use g1::mirror::ACTION_MIRROR;
use g1::{JOINTS, RIGHT_FOOT};
use nalgebra::{Isometry3, Translation3, UnitQuaternion};
use std::f64::consts::{PI, TAU};

/// The pose of the robot at a moment.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pose {
    pub(super) base: Isometry3<f64>,
    pub(super) joints: [f64; JOINTS],
}

/// Sagittal curves of the right leg, rad.
#[derive(Clone, Copy, Debug)]
pub(super) struct Leg {
    pub(super) hip_pitch: Harmonics,
    pub(super) knee: Harmonics,
    pub(super) ankle_pitch: Harmonics,
}

/// Curves of the base in the frame that moves with the mean speed.
#[derive(Clone, Copy, Debug)]
pub(super) struct Base {
    pub(super) roll: Harmonics,
    pub(super) pitch: Harmonics,
    pub(super) yaw: Harmonics,
    /// Forward and leftward motion about the mean, m.
    pub(super) surge: Harmonics,
    pub(super) sway: Harmonics,
    pub(super) bounce: Bounce,
    /// Height that the bounce is added to, m.
    pub(super) level: f64,
}

/// How the base rises and falls.
#[derive(Clone, Copy, Debug)]
pub(super) enum Bounce {
    /// Walking: over a stiff leg, highest in the middle of single support (amplitude in m).
    Vault { amplitude: f64, stance: f64 },
    /// Running: thrown up by stance and falling freely in flight (period in s).
    Spring { period: f64, stance: f64 },
}

impl Bounce {
    /// Height above the level, m.
    pub(super) fn at(&self, phase: f64) -> f64 {
        match *self {
            Self::Vault { amplitude, stance } => {
                amplitude * (2.0 * TAU * (phase - stance / 2.0)).cos()
            }
            Self::Spring { period, stance } => {
                let g = super::normative::GRAVITY;
                let (t, ground) = (phase.rem_euclid(0.5) * period, stance * period);
                let flight = (0.5 - stance) * period;
                if t < ground {
                    // z̈ = −g + A·sin(πt/ground), A such that the speed turns from −g·flight/2 to +.
                    let push = g * (ground + flight) * ground / TAU;
                    g * t * (ground - t) / 2.0 - push * (PI * t / ground).sin()
                } else {
                    let t = t - ground;
                    g * t * (flight - t) / 2.0
                }
            }
        }
    }
}

/// A periodic gait of the G1.
#[derive(Clone, Copy, Debug)]
pub(super) struct Stride {
    /// Mean speed, m/s, and duration of a stride (two steps), s.
    pub(super) speed: f64,
    pub(super) period: f64,
    pub(super) leg: Leg,
    pub(super) base: Base,
    pub(super) foot: FootPath,
    /// Half of the distance between the lines that the ankles follow, m.
    pub(super) half_width: f64,
    pub(super) waist: Harmonics,
    /// Shoulder pitch, roll, yaw, elbow, wrist roll of the right arm, rad.
    pub(super) arm: [Harmonics; 5],
}

impl Stride {
    /// Raises the base to the greatest level, at most `level`, that keeps every knee bent by at
    /// least `knee` (rad). `None` when no level does.
    pub(super) fn raised(mut self, level: f64, knee: f64) -> Option<Self> {
        let (mut low, mut high) = (0.55, level);
        for _ in 0..14 {
            let middle = 0.5 * (low + high);
            self.carry_at(middle);
            if self.reaches(knee) {
                low = middle;
            } else {
                high = middle;
            }
        }
        self.carry_at(low);
        self.reaches(knee).then_some(self)
    }

    fn carry_at(&mut self, level: f64) {
        // The human swing is known relative to the pelvis: it goes down with it.
        self.foot.swing_lift.mean += level - self.base.level;
        self.base.level = level;
    }

    fn reaches(&self, knee: f64) -> bool {
        const GRID: usize = 80;
        (0..GRID).all(|i| {
            self.right_leg(i as f64 / GRID as f64)
                .is_some_and(|q| q[3] >= knee)
        })
    }

    /// The pose at a time since right contact, s; the base moves on along x. `None` where a leg does
    /// not reach, which [`Self::raised`] excludes.
    pub(super) fn pose(&self, time: f64) -> Option<Pose> {
        let phase = (time / self.period).rem_euclid(1.0);
        let opposite = (phase + 0.5).rem_euclid(1.0);
        let mut base = self.base_at(phase);
        base.translation.vector.x += self.speed * time;
        let mut joints = [0.0; JOINTS];
        write(&mut joints, RIGHT_LEG, &self.right_leg(phase)?, false);
        write(&mut joints, LEFT_LEG, &self.right_leg(opposite)?, true);
        let arm = |phase: f64| self.arm.map(|curve| curve.at(phase));
        write(&mut joints, RIGHT_ARM, &arm(phase), false);
        write(&mut joints, LEFT_ARM, &arm(opposite), true);
        joints[WAIST] = self.waist.at(phase);
        Some(Pose { base, joints })
    }

    /// The frame of the base in the moving frame.
    fn base_at(&self, phase: f64) -> Isometry3<f64> {
        let base = &self.base;
        Isometry3::from_parts(
            Translation3::new(
                base.surge.at(phase),
                base.sway.at(phase),
                base.level + base.bounce.at(phase),
            ),
            UnitQuaternion::from_euler_angles(
                base.roll.at(phase),
                base.pitch.at(phase),
                base.yaw.at(phase),
            ),
        )
    }

    fn right_leg(&self, phase: f64) -> Option<[f64; 6]> {
        let sole = self.foot.at(phase);
        let foot = Isometry3::from_parts(
            Translation3::new(sole.x, -self.half_width, sole.z),
            UnitQuaternion::from_euler_angles(0.0, sole.pitch, 0.0),
        );
        let guess = [
            self.leg.hip_pitch.at(phase),
            0.0,
            0.0,
            self.leg.knee.at(phase).max(0.3),
            self.leg.ankle_pitch.at(phase),
            0.0,
        ];
        leg::solve(&self.base_at(phase), &foot, guess)
    }
}

/// Writes one side's joints, those of the left being the reflection of the right's.
fn write(joints: &mut [f64; JOINTS], first: usize, side: &[f64], reflected: bool) {
    for (i, &q) in side.iter().enumerate() {
        let sign = if reflected {
            ACTION_MIRROR.sign[first + i]
        } else {
            1.0
        };
        joints[first + i] = f64::from(sign) * q;
    }
}

/// The swing that a leg's curves make of themselves: ankle forward of the pelvis (m), lowest point
/// of the sole above the ground (m) for a base that bounces about `level`, pitch of the sole (rad).
pub(super) fn human_swing(
    leg: &Leg,
    pitch: &Harmonics,
    height: impl Fn(f64) -> f64,
) -> [Harmonics; 3] {
    let ankle = |phase: f64| {
        let mut q = [0.0; JOINTS];
        q[RIGHT_LEG] = leg.hip_pitch.at(phase);
        q[RIGHT_LEG + 3] = leg.knee.at(phase);
        q[RIGHT_LEG + 4] = leg.ankle_pitch.at(phase);
        let base = Isometry3::rotation(nalgebra::Vector3::y() * pitch.at(phase));
        forward(&base, &q)[RIGHT_FOOT].translation.vector
    };
    let sole_pitch = |phase: f64| {
        pitch.at(phase) + leg.hip_pitch.at(phase) + leg.knee.at(phase) + leg.ankle_pitch.at(phase)
    };
    [
        Harmonics::of(|phase| ankle(phase).x),
        Harmonics::of(|phase| height(phase) + ankle(phase).z + lowest_offset(sole_pitch(phase))),
        Harmonics::of(sole_pitch),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_run_falls_freely_in_flight_and_is_thrown_up_by_stance() {
        let (period, stance) = (0.6, 0.3);
        let bounce = Bounce::Spring { period, stance };
        let h = 1e-4;
        let z = |time: f64| bounce.at(time / period);
        let acceleration = |t: f64| (z(t + h) - 2.0 * z(t) + z(t - h)) / (h * h);
        // Half a period lasts 0.3 s: 0.18 s of stance, then 0.12 s of flight.
        for t in [0.19, 0.24, 0.29] {
            assert!((acceleration(t) + 9.81).abs() < 1e-3);
        }
        // Thrust is a half sine whose mean carries the weight of the flight too, so its peak is
        // π/2·(0.3/0.18)·g = 2.618 g, and the acceleration g less.
        assert!((acceleration(0.09) - 1.618 * 9.81).abs() < 0.01);
        // In 0.12 s of flight the base rises by g·0.12²/8 = 17.7 mm.
        assert!((z(0.24) - 0.017658).abs() < 1e-6 && z(0.18).abs() < 1e-9);
        let speed = |t: f64| (z(t + h) - z(t - h)) / (2.0 * h);
        for t in [0.0, 0.18, 0.3] {
            assert!((speed(t + 2.0 * h) - speed(t - 2.0 * h)).abs() < 1e-2); // no step at contact
        }
    }

    #[test]
    fn a_walk_is_highest_in_the_middle_of_single_support() {
        let bounce = Bounce::Vault {
            amplitude: 0.02,
            stance: 0.6,
        };
        // Right stance lasts to 0.6 and the left foot is off from 0.1 to 0.5: the middle is 0.3.
        assert!((bounce.at(0.3) - 0.02).abs() < 1e-12 && (bounce.at(0.05) + 0.02).abs() < 1e-12);
    }
}

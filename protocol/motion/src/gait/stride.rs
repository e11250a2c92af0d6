//! A stride: human curves turned into poses of the G1 with its feet on the ground.
//!
//! Separate because walking and running differ in figures only. The base follows its curves, each
//! foot follows its [`FootPath`], the legs between are solved by inverse kinematics, the waist and
//! the arms follow their curves. The left side is solved as the right side of the reflected robot half
//! a stride later, so a straight gait is exactly symmetric. The base is carried as high as the legs
//! allow. Where the way only begins or ends, every curve is scaled by its share of the speed.

use super::bounce::Bounce;
use super::foot::{FootPath, lowest_offset};
use super::foothold::Side;
use super::harmonics::Harmonics;
use super::leg;
use super::way::Way;
use g1::joints::{LEFT_ARM, LEFT_LEG, RIGHT_ARM, RIGHT_LEG, WAIST};
use g1::kinematics::forward;
use g1::mirror::ACTION_MIRROR;
use g1::state::STANDING_HEIGHT;
use g1::{DEFAULT_POSE, JOINTS, RIGHT_FOOT};
use nalgebra::{Isometry2, Isometry3, Quaternion, Translation3, UnitQuaternion, Vector3};
use std::ops::RangeInclusive;

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
    /// How much lower the base is carried where the gait is half begun or half ended, m.
    pub(super) crouch: f64,
}

/// A gait of the G1: a way over the ground and how body and feet go along it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Stride {
    pub(super) way: Way,
    /// The phase at time 0, where the pelvis is at the world's origin.
    pub(super) begin: f64,
    /// Whether time runs backward: a walk seen so is a walk backward.
    pub(super) reversed: bool,
    pub(super) leg: Leg,
    pub(super) base: Base,
    pub(super) foot: FootPath,
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

    /// Crouches between standing and full speed as little as keeps every knee bent by at least `knee`
    /// (rad) from one phase to another. `None` when no crouch does.
    pub(super) fn crouched(mut self, phases: RangeInclusive<f64>, knee: f64) -> Option<Self> {
        (0..20).find_map(|i| {
            self.base.crouch = 0.005 * f64::from(i);
            self.bends(phases.clone(), knee).then_some(self)
        })
    }

    fn reaches(&self, knee: f64) -> bool {
        self.bends(0.0..=1.0, knee)
    }

    fn bends(&self, phases: RangeInclusive<f64>, knee: f64) -> bool {
        const PER_STRIDE: f64 = 80.0;
        let span = phases.end() - phases.start();
        let grid = (span * PER_STRIDE).round() as usize;
        (0..grid).all(|i| {
            let phase = phases.start() + span * i as f64 / grid as f64;
            [Side::Right, Side::Left]
                .iter()
                .all(|side| self.leg(*side, phase).is_some_and(|q| q[3] >= knee))
        })
    }

    /// The pose at a time, s. `None` where a leg does not reach, which [`Self::raised`] excludes for
    /// a periodic gait.
    pub(super) fn pose(&self, time: f64) -> Option<Pose> {
        let strides = time / self.way.period;
        let phase = self.begin + if self.reversed { -strides } else { strides };
        let moving = self.way.frame(self.begin).inverse() * self.way.frame(phase);
        let mut joints = DEFAULT_POSE.map(f64::from);
        let share = self.way.share(phase);
        let upper = |joint: &mut f64, curve: f64| *joint += share * (curve - *joint);
        upper(&mut joints[WAIST], self.waist.at(phase));
        for (first, side) in [(RIGHT_ARM, Side::Right), (LEFT_ARM, Side::Left)] {
            for (i, curve) in self.arm.iter().enumerate() {
                let curve = reflection(first + i, side) * curve.at(phase + side.lag());
                upper(&mut joints[first + i], curve);
            }
        }
        for (first, side) in [(RIGHT_LEG, Side::Right), (LEFT_LEG, Side::Left)] {
            for (i, q) in self.leg(side, phase)?.into_iter().enumerate() {
                joints[first + i] = reflection(first + i, side) * q;
            }
        }
        Some(Pose {
            base: carried(&moving, &self.base_at(phase)),
            joints,
        })
    }

    /// The frame of the base in the moving frame; it is that of standing where the way stands still.
    fn base_at(&self, phase: f64) -> Isometry3<f64> {
        let (base, share) = (&self.base, self.way.share(phase));
        let height = base.level + base.bounce.at(phase);
        let crouch = 4.0 * share * (1.0 - share) * base.crouch;
        Isometry3::from_parts(
            Translation3::new(
                share * base.surge.at(phase),
                self.way.sway(phase) * base.sway.at(phase),
                STANDING_HEIGHT + share * (height - STANDING_HEIGHT) - crouch,
            ),
            UnitQuaternion::from_euler_angles(
                share * base.roll.at(phase),
                share * base.pitch.at(phase),
                share * base.yaw.at(phase),
            ),
        )
    }

    /// The joints of a leg, those of the left as its reflection on the right has them.
    fn leg(&self, side: Side, phase: f64) -> Option<[f64; 6]> {
        let seen = |frame: Isometry3<f64>| match side {
            Side::Right => frame,
            Side::Left => reflected(&frame),
        };
        let foot = seen(self.foot.at(side, phase, &self.way).frame());
        let own = phase + side.lag();
        let guess = [
            self.leg.hip_pitch.at(own),
            0.0,
            0.0,
            self.leg.knee.at(own).max(0.3),
            self.leg.ankle_pitch.at(own),
            0.0,
        ];
        leg::solve(&seen(self.base_at(phase)), &foot, guess)
    }
}

/// What a joint's angle on the right side is multiplied by to be that of `side`.
fn reflection(joint: usize, side: Side) -> f64 {
    match side {
        Side::Right => 1.0,
        Side::Left => f64::from(ACTION_MIRROR.sign[joint]),
    }
}

/// A frame seen in a mirror: y → −y.
fn reflected(frame: &Isometry3<f64>) -> Isometry3<f64> {
    let (p, q) = (frame.translation.vector, frame.rotation.quaternion());
    Isometry3::from_parts(
        Translation3::new(p.x, -p.y, p.z),
        UnitQuaternion::new_unchecked(Quaternion::new(q.w, -q.i, q.j, -q.k)),
    )
}

/// A frame carried along the ground.
fn carried(ground: &Isometry2<f64>, frame: &Isometry3<f64>) -> Isometry3<f64> {
    let (p, yaw) = (ground.translation.vector, ground.rotation.angle());
    Isometry3::new(Vector3::new(p.x, p.y, 0.0), Vector3::z() * yaw) * frame
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
        let base = Isometry3::rotation(Vector3::y() * pitch.at(phase));
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

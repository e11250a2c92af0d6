//! What the robot shall do in a frame: directions of its bones, orientation and place of its pelvis.
//!
//! Separate because this is where a human becomes a robot. Directions need neither scale factors per
//! limb nor fixed rotations per skeleton; one number, the ratio of the legs, scales the way over the
//! ground. Trunk: the robot has one joint (waist yaw) where humans have a spine, so the pelvis takes
//! the lean of the whole trunk.

use crate::capture::{Capture, Landmark, Landmarks, Side};
use crate::contact::Contact;
use crate::signal;
use g1::JOINT_TABLE;
use g1::joints::WAIST;
use nalgebra::{Isometry3, Rotation3, Unit, UnitQuaternion, Vector3};

/// Thigh, shin and ankle of the robot in line, m: hip roll to knee, knee to ankle pitch, ankle pitch
/// to ankle roll.
pub const ROBOT_LEG: f64 = 0.309 + 0.300 + 0.0176;

/// Middle of the hip roll joints below the origin of the pelvis, m.
const HIP_DROP: f64 = 0.1027 + 0.030465;

/// How far shoulders lie behind hips in an upright human, rad.
///
/// 4.5° in the mean SMPL body, 6° in the CMU skeleton at rest: without this every upright human would
/// lean back.
const UPRIGHT_LEAN: f64 = -0.09;

/// What the solver aims at in one frame. World frame, z up.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Target {
    /// Orientation of the pelvis.
    pub pelvis: UnitQuaternion<f64>,
    /// Place of the pelvis, m, before the feet are put on the ground.
    pub place: Vector3<f64>,
    /// Waist yaw, rad.
    pub waist: f64,
    /// Directions of thigh, shin, upper arm and forearm, by [`Side::index`].
    pub bones: [[Vector3<f64>; 4]; 2],
    /// Orientation of the feet: x to the toe, z out of the sole's back.
    pub feet: [UnitQuaternion<f64>; 2],
}

impl Target {
    /// Frame of the pelvis, before the feet are put on the ground.
    pub fn frame(&self) -> Isometry3<f64> {
        Isometry3::from_parts(self.place.into(), self.pelvis)
    }
}

/// Ratio of the robot's legs to the human's.
pub fn scale(leg_length: f64) -> f64 {
    ROBOT_LEG / leg_length
}

/// The targets of a capture at the robot's rate.
pub fn of(capture: &Capture, scale: f64, contacts: &[Contact]) -> Vec<Target> {
    let mut yaw: Vec<f64> = capture.frames.iter().map(heading).collect();
    signal::unwrap(&mut yaw);
    let lean = |f: fn(&Landmarks, f64) -> f64| -> Vec<f64> {
        capture
            .frames
            .iter()
            .zip(&yaw)
            .map(|(l, &h)| f(l, h))
            .collect()
    };
    let (pitch, roll) = (lean(trunk_pitch), lean(trunk_roll));
    // One frame: what is quicker in the angles and the way of a whole trunk is noise of markers.
    let [yaw, pitch, roll] = [yaw, pitch, roll].map(|series| signal::gaussian(&series, 1.0));
    let pelvis = |i: usize| UnitQuaternion::from_euler_angles(roll[i], pitch[i], yaw[i]);
    let mut waist: Vec<f64> = (0..capture.frames.len())
        .map(|i| waist_yaw(&capture.frames[i], &pelvis(i)))
        .collect();
    signal::unwrap(&mut waist);
    let waist = signal::gaussian(&waist, 1.0);
    let place: [Vec<f64>; 3] = std::array::from_fn(|axis| {
        let hips = capture.frames.iter().map(|l| l.middle(Landmark::Hip)[axis]);
        signal::gaussian(&hips.collect::<Vec<f64>>(), 1.0)
    });
    let feet = Side::BOTH.map(|side| feet(capture, side, contacts, &pelvis));
    (0..capture.frames.len())
        .map(|i| {
            let (landmarks, pelvis) = (&capture.frames[i], pelvis(i));
            Target {
                pelvis,
                place: Vector3::from_fn(|axis, _| place[axis][i]) * scale
                    + pelvis * Vector3::new(0.0, 0.0, HIP_DROP),
                waist: waist[i].clamp(JOINT_TABLE[WAIST].lower, JOINT_TABLE[WAIST].upper),
                bones: Side::BOTH.map(|side| bones(landmarks, side)),
                feet: [feet[0][i], feet[1][i]],
            }
        })
        .collect()
}

/// Yaw of the direction that the hips face, rad.
fn heading(landmarks: &Landmarks) -> f64 {
    let across = across(landmarks, Landmark::Hip);
    (-across.x).atan2(across.y)
}

/// From the right joint centre to the left one.
fn across(landmarks: &Landmarks, landmark: Landmark) -> Vector3<f64> {
    landmarks.of(Side::Left, landmark) - landmarks.of(Side::Right, landmark)
}

/// Lean of the trunk forward, rad.
fn trunk_pitch(landmarks: &Landmarks, heading: f64) -> f64 {
    let up = landmarks.middle(Landmark::Shoulder) - landmarks.middle(Landmark::Hip);
    let forward = up.x * heading.cos() + up.y * heading.sin();
    forward.atan2(up.z) - UPRIGHT_LEAN
}

/// Mean of the slope of the hips and the lean of the trunk to the right, rad: the robot's pelvis and
/// trunk roll as one, a human's against each other.
fn trunk_roll(landmarks: &Landmarks, heading: f64) -> f64 {
    let hips = across(landmarks, Landmark::Hip);
    let up = landmarks.middle(Landmark::Shoulder) - landmarks.middle(Landmark::Hip);
    let left = up.y * heading.cos() - up.x * heading.sin();
    0.5 * (hips.z.atan2(hips.xy().norm()) + (-left).atan2(up.z))
}

/// Turn of the shoulders against the hips, to the left, rad.
fn waist_yaw(landmarks: &Landmarks, pelvis: &UnitQuaternion<f64>) -> f64 {
    let shoulders = pelvis.inverse_transform_vector(&across(landmarks, Landmark::Shoulder));
    (-shoulders.x).atan2(shoulders.y)
}

fn bones(landmarks: &Landmarks, side: Side) -> [Vector3<f64>; 4] {
    use Landmark::{Ankle, Elbow, Hip, Knee, Shoulder, Wrist};
    [
        (Hip, Knee),
        (Knee, Ankle),
        (Shoulder, Elbow),
        (Elbow, Wrist),
    ]
    .map(|(from, to)| {
        let bone = landmarks.of(side, to) - landmarks.of(side, from);
        // Two centres in one place have no direction: down will do.
        bone.try_normalize(1e-6).unwrap_or_else(|| -Vector3::z())
    })
}

/// Orientation of a foot in every frame. Its pitch is counted from how the foot stands when it
/// stands: skeletons put the toe joint at any height.
fn feet(
    capture: &Capture,
    side: Side,
    contacts: &[Contact],
    pelvis: &dyn Fn(usize) -> UnitQuaternion<f64>,
) -> Vec<UnitQuaternion<f64>> {
    let toe: Vec<Vector3<f64>> = capture
        .frames
        .iter()
        .map(|f| f.of(side, Landmark::Toe) - f.of(side, Landmark::Ankle))
        .map(|d| d.try_normalize(1e-6).unwrap_or_else(Vector3::x))
        .collect();
    let mut standing: Vec<f64> = toe
        .iter()
        .zip(contacts)
        .filter(|(_, contact)| contact.flat[side.index()])
        .map(|(toe, _)| -toe.z.asin())
        .collect();
    if standing.is_empty() {
        standing = toe.iter().map(|toe| -toe.z.asin()).collect();
    }
    let neutral = signal::median(&mut standing);
    (0..toe.len())
        .map(|i| {
            // The pelvis says where left is: a foot in swing may point straight down or backward.
            let left = pelvis(i) * Vector3::y();
            let y = (left - toe[i] * left.dot(&toe[i]))
                .try_normalize(1e-6)
                .unwrap_or_else(Vector3::y);
            let basis = Rotation3::from_basis_unchecked(&[toe[i], y, toe[i].cross(&y)]);
            let turn = UnitQuaternion::from_axis_angle(&Unit::new_unchecked(y), -neutral);
            turn * UnitQuaternion::from_rotation_matrix(&basis)
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{contact, puppet};

    fn targets() -> Vec<Target> {
        let capture = puppet::walking(50.0, 2.0);
        of(
            &capture,
            scale(capture.leg_length()),
            &contact::detect(&capture),
        )
    }

    #[test]
    fn the_way_is_scaled_by_the_legs_and_the_trunk_is_upright() {
        let targets = targets();
        let way = (targets[100].place - targets[0].place).x;
        // 2 s at the puppet's speed, times 0.6266/0.84.
        let expected = 2.0 * puppet::SPEED * ROBOT_LEG / puppet::LEG;
        assert!((way - expected).abs() < 0.01, "{way} is not {expected}");
        for target in &targets {
            let (roll, pitch, yaw) = target.pelvis.euler_angles();
            assert!(roll.abs() < 0.02 && yaw.abs() < 0.02);
            // The puppet's shoulders are straight above its hips.
            assert!((pitch + UPRIGHT_LEAN).abs() < 0.02, "{pitch}");
        }
    }

    #[test]
    fn a_standing_foot_is_level_and_points_ahead() {
        let capture = puppet::walking(50.0, 2.0);
        let contacts = contact::detect(&capture);
        for (target, contact) in targets().iter().zip(&contacts) {
            for side in 0..2 {
                if contact.flat[side] {
                    let toe = target.feet[side] * Vector3::x();
                    assert!(toe.x > 0.99 && toe.z.abs() < 0.05, "{toe}");
                }
            }
        }
    }

    #[test]
    fn bones_are_unit_vectors_from_joint_to_joint() {
        let frame = puppet::walking(50.0, 1.0).frames[7];
        for side in Side::BOTH {
            let [thigh, ..] = bones(&frame, side);
            let expected = frame.of(side, Landmark::Knee) - frame.of(side, Landmark::Hip);
            assert!((thigh - expected.normalize()).norm() < 1e-12);
        }
    }
}

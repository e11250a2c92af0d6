//! The account of a clip: what its report says, measured.
//!
//! Separate from the recipe because it changes nothing.

use crate::RATE;
use crate::capture::{Capture, Side};
use crate::contact;
use crate::feet::Plan;
use crate::floor::Floor;
use crate::limb::{Chain, KNEE, LEGS, MARGIN};
use crate::posture::Posture;
use crate::report::{Report, Sharpest, bones_off, held};
use crate::targets::Target;
use crate::{signal, solver};
use g1::kinematics::forward;
use g1::{JOINT_TABLE, JOINTS, LEFT_FOOT, RIGHT_FOOT};
use nalgebra::Vector3;

/// A bone that is further off than this does something else, degrees.
const OFF_TARGET: f64 = 20.0;

/// What was done to a clip; `slowed` counts frames by joint, lengths are in m.
pub(crate) fn account(
    human: &Capture,
    targets: &[Target],
    plan: &Plan,
    postures: &[Posture],
    (slowed, human_leg, scale, lifted): (&[usize; JOINTS], f64, f64, f64),
) -> Report {
    let angles: Vec<Vec<f64>> = targets
        .iter()
        .zip(postures)
        .map(|(target, posture)| direction_errors(target, posture))
        .collect();
    let mut errors = angles.concat();
    let off = errors.iter().filter(|error| **error > OFF_TARGET).count();
    let way =
        postures[postures.len() - 1].base.translation.vector - postures[0].base.translation.vector;
    let standing: Vec<Option<f64>> = contact::standing_toes(human)
        .into_iter()
        .map(|height| Some(scale * height?))
        .collect();
    let carried = plan.shift.iter().map(|shift| shift.xy().norm());
    Report {
        frames: postures.len(),
        human_leg,
        scale,
        scaled_speed: scale * human.travel_speed(),
        speed: way.xy().norm() * RATE / (postures.len() - 1) as f64,
        off_target: off as f64 / errors.len() as f64,
        direction_error: signal::median(&mut errors),
        direction_error_95: signal::quantile(&mut errors, 0.95),
        bones_off: bones_off(&angles),
        knee_error: knee_error(targets, postures),
        sharpest: sharpest(postures),
        stances: plan.stances,
        feet_moved: plan.moved,
        lowered: plan.lowered,
        unreached: plan.unreached,
        carried: carried.fold(0.0, f64::max),
        lifted,
        floor: Floor::of(&standing),
        at_limit: held(&at_limit(postures)),
        at_speed: held(slowed),
    }
}

/// Angles between bones and feet of the robot and those of the human, degrees: thigh, shin, upper arm,
/// forearm and foot of the left side, then of the right.
fn direction_errors(target: &Target, posture: &Posture) -> Vec<f64> {
    let bodies = forward(&posture.base, &posture.joints);
    let bones = solver::bones(&bodies);
    let mut errors = Vec::new();
    for side in Side::BOTH {
        let s = side.index();
        let pairs = bones[s].iter().zip(&target.bones[s]);
        errors.extend(pairs.map(|(a, b)| angle(a, b).to_degrees()));
        let foot = [LEFT_FOOT, RIGHT_FOOT][s];
        let toe = bodies[foot].rotation * Vector3::x();
        errors.push(angle(&toe, &(target.feet[s] * Vector3::x())).to_degrees());
    }
    errors
}

fn angle(a: &Vector3<f64>, b: &Vector3<f64>) -> f64 {
    a.dot(b).clamp(-1.0, 1.0).acos()
}

/// Root mean square over both knees and all frames, degrees.
fn knee_error(targets: &[Target], postures: &[Posture]) -> f64 {
    let square = |(target, posture): (&Target, &Posture)| {
        let error = |s: usize| {
            let flexion = angle(&target.bones[s][0], &target.bones[s][1]);
            (posture.joints[LEGS[s] + KNEE] - flexion).to_degrees()
        };
        error(0).powi(2) + error(1).powi(2)
    };
    let sum: f64 = targets.iter().zip(postures).map(square).sum();
    (sum / (2 * postures.len()) as f64).sqrt()
}

/// The greatest second difference of each joint of the legs.
fn sharpest(postures: &[Posture]) -> Vec<Sharpest> {
    let of = |joint: usize| {
        let bend = |i: usize| {
            let [a, b, c] = [i - 1, i, i + 1].map(|i| postures[i].joints[joint]);
            (a - 2.0 * b + c).abs().to_degrees()
        };
        let frames = 1..postures.len().saturating_sub(1);
        let most = frames.max_by(|&i, &j| bend(i).total_cmp(&bend(j)))?;
        Some(Sharpest {
            joint: JOINT_TABLE[joint].name.into(),
            frame: most + 1,
            degrees: bend(most),
        })
    };
    LEGS.into_iter()
        .flat_map(|first| first..first + 6)
        .filter_map(of)
        .collect()
}

/// Frames in which a joint is as far as it may go.
fn at_limit(postures: &[Posture]) -> [usize; JOINTS] {
    let [left, right] = LEGS.map(Chain::<6>::new);
    std::array::from_fn(|j| {
        let joint = &JOINT_TABLE[j];
        let (mut lower, upper) = (joint.lower + MARGIN, joint.upper - MARGIN);
        for leg in [&left, &right] {
            if (leg.first..leg.first + 6).contains(&j) {
                lower = leg.lower[j - leg.first];
            }
        }
        let at = |p: &&Posture| p.joints[j] <= lower || p.joints[j] >= upper;
        postures.iter().filter(at).count()
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use g1::DEFAULT_POSE;
    use g1::joints::WAIST;
    use nalgebra::{Isometry3, UnitQuaternion};

    /// The default pose, and the target that it is.
    fn standing() -> (Target, Posture) {
        let posture = Posture {
            base: Isometry3::translation(0.0, 0.0, 0.78),
            joints: DEFAULT_POSE.map(f64::from),
        };
        let bodies = forward(&posture.base, &posture.joints);
        let target = Target {
            pelvis: UnitQuaternion::identity(),
            place: posture.base.translation.vector,
            waist: posture.joints[WAIST],
            bones: solver::bones(&bodies),
            feet: [bodies[LEFT_FOOT].rotation, bodies[RIGHT_FOOT].rotation],
        };
        (target, posture)
    }

    #[test]
    fn the_sharpest_change_is_found_where_it_is() {
        let (_, posture) = standing();
        let mut postures = [posture; 5];
        postures[3].joints[LEGS[1] + KNEE] += 0.1;
        let sharpest = sharpest(&postures);
        assert_eq!(sharpest.len(), 12);
        // 0, 0.1, 0 differ twice by -0.2 rad = -11.459°; the only one of twelve.
        let knee = &sharpest[6 + KNEE];
        assert_eq!((knee.joint.as_str(), knee.frame), ("right_knee_joint", 4));
        assert!((knee.degrees - 11.459).abs() < 1e-3);
        assert_eq!(sharpest.iter().filter(|s| s.degrees > 1e-9).count(), 1);
    }

    #[test]
    fn one_bone_of_ten_is_off() {
        let (mut target, posture) = standing();
        target.bones[0][1] = -target.bones[0][1];
        let errors = direction_errors(&target, &posture);
        assert_eq!(errors.len(), 10);
        assert_eq!(errors.iter().filter(|e| **e > OFF_TARGET).count(), 1);
        assert!((errors[1] - 180.0).abs() < 1e-6);
    }

    #[test]
    fn knees_are_judged_against_the_angle_between_the_bones() {
        let (mut target, mut posture) = standing();
        let shin = |flexion: f64| Vector3::new(-flexion.sin(), 0.0, -flexion.cos());
        for side in 0..2 {
            target.bones[side][..2].copy_from_slice(&[-Vector3::z(), shin(0.5)]);
        }
        posture.joints[LEGS[0] + KNEE] = 0.5;
        posture.joints[LEGS[1] + KNEE] = 0.5 + 0.1;
        // The root of (0² + 0.1²)/2 rad² is 4.051°.
        assert!((knee_error(&[target], &[posture]) - 4.051).abs() < 1e-3);
    }
}

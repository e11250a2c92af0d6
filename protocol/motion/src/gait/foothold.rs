//! Where feet are put down: places on the ground that stay while the body passes.
//!
//! Separate from the foot's motion because it alone knows how wide, how far ahead and how far out of
//! a curve a foot is placed, and where feet stand side by side.

use super::way::Way;
use g1::LEFT_FOOT;
use g1::kinematics::forward;
use g1::state::STANDING_HEIGHT;
use g1::{DEFAULT_POSE, JOINTS};
use nalgebra::{Isometry2, Isometry3, Vector2};

/// A side of the body.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Side {
    Left,
    Right,
}

impl Side {
    /// How far the side's own phase, 0 at its contact, is ahead of the right's.
    pub(super) fn lag(self) -> f64 {
        match self {
            Self::Left => 0.5,
            Self::Right => 0.0,
        }
    }

    fn sign(self) -> f64 {
        match self {
            Self::Left => 1.0,
            Self::Right => -1.0,
        }
    }
}

/// A foot's place during one stance.
#[derive(Clone, Copy, Debug)]
pub(super) struct Foothold {
    pub(super) side: Side,
    /// The flat sole's ankle on the ground and its heading, in the world.
    pub(super) place: Isometry2<f64>,
    /// The side's own phase at contact.
    pub(super) contact_phase: f64,
    /// Shares of the gait's pitch at contact and at toe-off.
    pub(super) contact: f64,
    pub(super) toe_off: f64,
    /// Whether the next foothold is the same: the foot is not lifted.
    pub(super) stays: bool,
}

/// The rule by which places are chosen.
#[derive(Clone, Copy, Debug)]
pub(super) struct Footing {
    /// Mean place of the flat sole's ankle during stance, forward of the pelvis, m.
    pub(super) centre: f64,
    /// Half of the distance between the lines that the ankles follow, m.
    pub(super) half_width: f64,
    /// How far both lines are to the left of the pelvis, m: out of a curve that the body leans into.
    pub(super) shift: f64,
}

impl Footing {
    /// The foothold that a foot gets at a contact: in the middle of stance the body is over it.
    pub(super) fn foothold(
        &self,
        side: Side,
        contact_phase: f64,
        stance: f64,
        way: &Way,
    ) -> Foothold {
        let landing = contact_phase - side.lag();
        let rest = way.rest(landing);
        let at_rest = |strides: f64| rest.is_some() && way.rest(landing + strides).is_some();
        let place = match rest {
            Some(frame) => frame * standing(side),
            None => {
                let aside = side.sign() * self.half_width + self.shift;
                way.frame(landing + stance / 2.0) * Isometry2::translation(self.centre, aside)
            }
        };
        let stays = at_rest(1.0);
        // A foot that does not come or does not go does not roll either.
        let rolling = |still: bool, phase: f64| if still { 0.0 } else { way.share(phase) };
        Foothold {
            side,
            place,
            contact_phase,
            contact: rolling(at_rest(-1.0), landing),
            toe_off: rolling(stays, landing + stance),
            stays,
        }
    }
}

/// The ankle of a side when the robot stands in its default pose, in the pelvis's heading frame.
pub(super) fn standing(side: Side) -> Isometry2<f64> {
    let joints: [f64; JOINTS] = DEFAULT_POSE.map(f64::from);
    let base = Isometry3::translation(0.0, 0.0, STANDING_HEIGHT);
    let left = forward(&base, &joints)[LEFT_FOOT].translation.vector;
    Isometry2::new(Vector2::new(left.x, side.sign() * left.y), 0.0)
}

#[cfg(test)]
mod tests {
    use super::super::way::{Change, Ramp};
    use super::*;
    use crate::velocity::Velocity;

    const FOOTING: Footing = Footing {
        centre: -0.05,
        half_width: 0.1,
        shift: 0.0,
    };

    #[test]
    fn the_body_is_over_the_foot_in_the_middle_of_stance() {
        let way = Way {
            velocity: Velocity::from(1.0),
            period: 1.0,
            change: Change::Steady,
        };
        // Right contact at 3, stance of 0.6: over it at 3.3. Left contact at 3 − 0.5.
        let right = FOOTING.foothold(Side::Right, 3.0, 0.6, &way).place;
        let left = FOOTING.foothold(Side::Left, 3.0, 0.6, &way).place;
        assert!((right.translation.vector - Vector2::new(3.25, -0.1)).norm() < 1e-12);
        assert!((left.translation.vector - Vector2::new(2.75, 0.1)).norm() < 1e-12);
    }

    #[test]
    fn feet_leave_their_standing_place_at_the_first_step_and_come_to_one_at_the_last() {
        let ramp = Ramp { from: 0.4, to: 1.4 };
        let mut way = Way {
            velocity: Velocity::from(1.0),
            period: 1.0,
            change: Change::Start {
                lift: 0.6,
                speed: ramp,
                sway: ramp,
            },
        };
        for (side, last) in [(Side::Right, 0.0), (Side::Left, 1.0)] {
            let stands = FOOTING.foothold(side, last, 0.6, &way);
            assert_eq!(stands.place, standing(side));
            assert!(!stands.stays && stands.contact == 0.0);
            let earlier = FOOTING.foothold(side, last - 1.0, 0.6, &way);
            assert!(earlier.stays && earlier.place == stands.place && earlier.toe_off == 0.0);
            let first = FOOTING.foothold(side, last + 1.0, 0.6, &way);
            assert!(!first.stays && first.contact > 0.0 && first.place != stands.place);
        }
        way.change = Change::Stop {
            last: 2.0,
            speed: ramp,
            sway: ramp,
        };
        let end = way.frame(1.4);
        for side in [Side::Right, Side::Left] {
            let comes = FOOTING.foothold(side, 2.0, 0.6, &way);
            assert!(comes.stays && comes.place == end * standing(side));
            assert!(!FOOTING.foothold(side, 1.0, 0.6, &way).stays);
        }
    }
}

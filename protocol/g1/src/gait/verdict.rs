//! What a gait is, in a word: from measures to a verdict that a log can say.
//!
//! Separate because learner, status and evaluation must call the same thing by the same name.

use super::{Gait, Pace};

/// Correlations beyond ± this are a pattern; between them legs do as they like.
const PATTERN: f64 = 0.3;
/// Slower than this (m/s), a robot stands.
const STANDING_SPEED: f64 = 0.1;
/// Slower than this (rad/s), a robot does not turn.
const STANDING_TURN: f64 = 0.1;
/// Below this share of the speed asked for a robot crawls, and as far above it it rushes.
const CRAWL_SHARE: f64 = 0.5;
/// Share of the speed asked for that a way may be off its direction: 14°.
const ASTRAY_SHARE: f64 = 0.25;
/// Yaw rate (rad/s) that a robot may be off while it goes; at 1 m/s it makes circles of 5 m.
const SWERVE: f64 = 0.2;
/// Fewer strides than this per second are the last steps before standing.
const STEPPING_HZ: f64 = 0.25;
/// Time in the air that makes a run; a walk has none, and a tenth is what published runs of this
/// robot at 2 m/s begin with.
const RUN_FLIGHT: f64 = 0.1;
/// Pelvis height (m) below which knees are bent as in no reference motion; standing is 0.78, a fall
/// is 0.55.
const CROUCH_HEIGHT: f64 = 0.65;
/// Robots that fall sooner (s) have shown where they started rather than how they walk.
const SHORT_LIFE: f64 = 2.0;

/// The measures that a verdict looks at.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Signs {
    /// Mean time to a fall or to the end, s; `None` if nobody's time ended.
    pub seconds_upright: Option<f64>,
    /// Planar speed asked for and speed along that direction, m/s; `None` if asked to stay on the spot.
    pub speeds: Option<(f64, f64)>,
    /// Yaw rate asked for and yaw rate that way round, rad/s; `None` if not asked to turn.
    pub turns: Option<(f64, f64)>,
    /// Speed that is not asked for, m/s: across the way asked for, or in any direction where none is.
    pub drift: f64,
    /// Yaw rate where none is asked for, rad/s.
    pub swerve: f64,
    /// Whether the way asked for is more lateral than forward.
    pub sideways: bool,
    /// Left–right correlation of hip pitch.
    pub hip_correlation: Option<f64>,
    /// Left–right correlation of ground contact.
    pub contact_correlation: Option<f64>,
    /// Strides per second.
    pub stride_rate: f64,
    /// Share of time with no foot on the ground.
    pub flight_share: f64,
    /// Mean height of the pelvis, m.
    pub pelvis_height: f64,
}

/// What was done of what was asked for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Part {
    /// What was done; below zero the other way.
    pub done: f64,
    /// What was asked for, above zero.
    pub asked: f64,
    /// Unit of both.
    pub unit: &'static str,
}

/// What a gait is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Verdict {
    /// Stays where it is, as asked.
    Stand,
    /// Legs alternate, at the speed and with the turn asked for.
    Walk,
    /// The same with flight.
    Run,
    /// Turns on the spot, stepping, as asked.
    Turn,
    /// Falls within the first seconds, which s.
    Fall(f64),
    /// Both legs move together; the correlation, and whether it is of the hips (else of contacts).
    Hop(f64, bool),
    /// Stands though asked to go or to turn.
    Still(Part),
    /// Goes or turns far too slowly.
    Crawl(Part),
    /// Goes or turns far too fast.
    Rush(Part),
    /// Goes with its pelvis this low, m.
    Crouch(f64),
    /// Legs neither alternate nor move together; the correlation.
    Shuffle(f64),
    /// Steps though asked to stand, this often per second.
    StepInPlace(f64),
    /// Moves at this speed (m/s) though asked to stay on the spot.
    Drift(f64),
    /// Turns at this rate (rad/s) though asked to stay.
    Spin(f64),
    /// Goes off the way asked for, at this speed across it, m/s.
    Sidle(f64),
    /// Goes as fast as asked, but turns otherwise.
    Veer(Part),
    /// Turns at this rate (rad/s) though asked to go straight.
    Circle(f64),
}

impl Signs {
    /// From the sums of steps that ask for the same kind of thing, at `control_hz` steps a second. Steps that ask for
    /// different things are told apart by [`super::Conduct`].
    pub fn of(gait: &Gait, pace: &Pace, seconds_upright: Option<f64>, control_hz: f64) -> Self {
        Self {
            seconds_upright,
            speeds: pace.speeds(),
            turns: pace.turns(),
            drift: pace.astray(),
            swerve: pace.swerve(),
            sideways: pace.is_sideways(),
            hip_correlation: gait.hip_correlation(),
            contact_correlation: gait.contact_correlation(),
            stride_rate: gait.stride_rate(control_hz).unwrap_or_default(),
            flight_share: gait.flight_share().unwrap_or_default(),
            pelvis_height: gait.pelvis_height().unwrap_or_default(),
        }
    }

    /// Whether robots step, rather than slide or sway.
    fn steps(&self) -> bool {
        self.stride_rate >= STEPPING_HZ || self.flight_share >= RUN_FLIGHT
    }
}

impl Part {
    /// How much of it is done, if that is not as asked for: off by half of it, and if too much, by more than `slack`.
    fn fault(self, standing: f64, slack: f64) -> Option<Verdict> {
        let Self { done, asked, .. } = self;
        if done < standing.min(CRAWL_SHARE * asked) {
            Some(Verdict::Still(self))
        } else if done < CRAWL_SHARE * asked {
            Some(Verdict::Crawl(self))
        } else if done > (1.0 + CRAWL_SHARE) * asked && done > asked + slack {
            Some(Verdict::Rush(self))
        } else {
            None
        }
    }
}

impl Verdict {
    /// The first that fits, the worst first: whoever falls at once shows no gait, and whoever hops
    /// may do so at any speed.
    pub fn of(signs: &Signs) -> Self {
        if let Some(seconds) = signs.seconds_upright.filter(|s| *s < SHORT_LIFE) {
            return Self::Fall(seconds);
        }
        let turn = signs.turns.map(|(asked, done)| Part {
            done,
            asked,
            unit: "rad/s",
        });
        match (signs.speeds, turn) {
            (Some((asked, done)), turn) => {
                let unit = "m/s";
                Self::of_going(signs, Part { done, asked, unit }, turn)
            }
            (None, Some(turn)) => Self::of_turning(signs, turn),
            (None, None) => Self::of_staying(signs),
        }
    }

    fn of_going(signs: &Signs, speed: Part, turn: Option<Part>) -> Self {
        // Sideways steps hardly use the hips' pitch: there the contacts tell.
        let witness = if signs.sideways {
            signs.contact_correlation
        } else {
            signs.hip_correlation
        };
        let moves = signs.steps() || speed.done > STANDING_SPEED;
        if let Some(correlation) = witness.filter(|c| *c > PATTERN && moves) {
            return Self::Hop(correlation, !signs.sideways);
        }
        if let Some(fault) = speed.fault(STANDING_SPEED, STANDING_SPEED) {
            return fault;
        }
        if signs.drift >= STANDING_SPEED.max(ASTRAY_SHARE * speed.asked) {
            return Self::Sidle(signs.drift);
        }
        if let Some(turn) = turn.filter(|turn| turn.fault(0.0, SWERVE).is_some()) {
            return Self::Veer(turn);
        }
        if signs.swerve >= SWERVE {
            return Self::Circle(signs.swerve);
        }
        if signs.pelvis_height < CROUCH_HEIGHT {
            return Self::Crouch(signs.pelvis_height);
        }
        match witness {
            Some(correlation) if correlation > -PATTERN => Self::Shuffle(correlation),
            None => Self::Shuffle(0.0),
            _ if signs.flight_share >= RUN_FLIGHT => Self::Run,
            _ => Self::Walk,
        }
    }

    fn of_turning(signs: &Signs, turn: Part) -> Self {
        // As of sideways steps. A robot that turns slowly has both feet down most of the time, so that they need not
        // alternate as in a walk.
        let contacts = signs.contact_correlation.unwrap_or_default();
        if contacts > PATTERN && signs.steps() {
            return Self::Hop(contacts, false);
        }
        if let Some(fault) = turn.fault(STANDING_TURN, SWERVE) {
            return fault;
        }
        if signs.drift >= STANDING_SPEED {
            Self::Drift(signs.drift)
        } else if signs.pelvis_height < CROUCH_HEIGHT {
            Self::Crouch(signs.pelvis_height)
        } else if !signs.steps() {
            Self::Shuffle(contacts)
        } else {
            Self::Turn
        }
    }

    fn of_staying(signs: &Signs) -> Self {
        if signs.drift >= STANDING_SPEED {
            Self::Drift(signs.drift)
        } else if signs.swerve >= STANDING_TURN {
            Self::Spin(signs.swerve)
        } else if signs.stride_rate >= STEPPING_HZ {
            Self::StepInPlace(signs.stride_rate)
        } else if signs.pelvis_height < CROUCH_HEIGHT {
            Self::Crouch(signs.pelvis_height)
        } else {
            Self::Stand
        }
    }

    /// Whether this is what was asked for.
    pub fn is_good(&self) -> bool {
        matches!(self, Self::Stand | Self::Walk | Self::Run | Self::Turn)
    }

    /// The first of the words: what it is, without how much.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Stand => "stand",
            Self::Walk => "walk",
            Self::Run => "run",
            Self::Turn => "turn",
            Self::Fall(_) => "fall",
            Self::Hop(..) => "hop",
            Self::Still(..) => "still",
            Self::Crawl(..) => "crawl",
            Self::Rush(..) => "rush",
            Self::Crouch(_) => "crouch",
            Self::Shuffle(_) => "shuffle",
            Self::StepInPlace(_) => "step in place",
            Self::Drift(_) => "drift",
            Self::Spin(_) => "spin",
            Self::Sidle(_) => "sidle",
            Self::Veer(_) | Self::Circle(_) => "veer",
        }
    }
}

impl std::fmt::Display for Verdict {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let name = self.name();
        match self {
            Self::Stand | Self::Walk | Self::Run | Self::Turn => f.write_str(name),
            Self::Fall(seconds) => write!(f, "{name}: after {seconds:.1} s"),
            Self::Hop(correlation, true) => write!(f, "{name}: hips in phase ({correlation:+.2})"),
            Self::Hop(correlation, false) => {
                write!(f, "{name}: feet land together ({correlation:+.2})")
            }
            Self::Still(part) | Self::Crawl(part) | Self::Rush(part) | Self::Veer(part) => {
                let Part { done, asked, unit } = part;
                write!(f, "{name}: {done:.2} of {asked:.2} {unit}")
            }
            Self::Crouch(height) => write!(f, "{name}: pelvis at {height:.2} m"),
            Self::Shuffle(correlation) => {
                write!(f, "{name}: legs do not alternate ({correlation:+.2})")
            }
            Self::StepInPlace(rate) => write!(f, "{name}: {rate:.1} strides/s, asked to stand"),
            Self::Drift(speed) => write!(f, "{name}: {speed:.2} m/s, asked to stay"),
            Self::Spin(rate) => write!(f, "{name}: {rate:.2} rad/s, asked to stay"),
            Self::Sidle(speed) => write!(f, "{name}: {speed:.2} m/s off its way"),
            Self::Circle(rate) => write!(f, "{name}: {rate:.2} rad/s, asked to go straight"),
        }
    }
}

#[cfg(test)]
mod tests;

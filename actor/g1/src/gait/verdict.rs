//! What a gait is, in a word: from measures to a verdict that a log can say.
//!
//! Separate because learner, status and evaluation must call the same thing by the same name.

use super::{Gait, Pace};

/// Correlations beyond ± this are a pattern; between them legs do as they like.
const PATTERN: f64 = 0.3;
/// Slower than this (m/s), a robot stands.
const STANDING_SPEED: f64 = 0.1;
/// Below this share of the speed asked for a robot crawls.
const CRAWL_SHARE: f64 = 0.5;
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
    /// Planar speed asked for and speed along that direction, m/s; `None` if asked to stay.
    pub speeds: Option<(f64, f64)>,
    /// Speed of the mean velocity where no speed is asked for, m/s.
    pub drift: f64,
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

/// What a gait is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Verdict {
    /// Stays where it is, as asked.
    Stand,
    /// Legs alternate, at the speed asked for.
    Walk,
    /// The same with flight.
    Run,
    /// Falls within the first seconds, which s.
    Fall(f64),
    /// Both legs move together; the correlation, and whether it is of the hips (else of contacts).
    Hop(f64, bool),
    /// Stands though asked to go: speed and speed asked for, m/s.
    Still(f64, f64),
    /// Goes far too slowly: speed and speed asked for, m/s.
    Crawl(f64, f64),
    /// Goes with its pelvis this low, m.
    Crouch(f64),
    /// Legs neither alternate nor move together; the correlation.
    Shuffle(f64),
    /// Steps though asked to stand, this often per second.
    StepInPlace(f64),
    /// Moves at this speed (m/s) though asked to stay.
    Drift(f64),
}

impl Signs {
    /// From the sums of a batch or of episodes, at `control_hz` steps a second.
    pub fn of(gait: &Gait, pace: &Pace, seconds_upright: Option<f64>, control_hz: f64) -> Self {
        let [forward, left] = pace.velocity().unwrap_or_default();
        Self {
            seconds_upright,
            speeds: pace.speeds().filter(|_| pace.is_going()),
            drift: forward.hypot(left),
            sideways: pace.is_sideways(),
            hip_correlation: gait.hip_correlation(),
            contact_correlation: gait.contact_correlation(),
            stride_rate: gait.stride_rate(control_hz).unwrap_or_default(),
            flight_share: gait.flight_share().unwrap_or_default(),
            pelvis_height: gait.pelvis_height().unwrap_or_default(),
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
        match signs.speeds {
            Some((commanded, speed)) => Self::of_going(signs, commanded, speed),
            None => Self::of_staying(signs),
        }
    }

    fn of_going(signs: &Signs, commanded: f64, speed: f64) -> Self {
        // Sideways steps hardly use the hips' pitch: there the contacts tell.
        let witness = if signs.sideways {
            signs.contact_correlation
        } else {
            signs.hip_correlation
        };
        let steps = signs.stride_rate >= STEPPING_HZ || signs.flight_share >= RUN_FLIGHT;
        match witness {
            Some(correlation) if correlation > PATTERN && (steps || speed > STANDING_SPEED) => {
                Self::Hop(correlation, !signs.sideways)
            }
            _ if speed < STANDING_SPEED.min(CRAWL_SHARE * commanded) => {
                Self::Still(speed, commanded)
            }
            _ if speed < CRAWL_SHARE * commanded => Self::Crawl(speed, commanded),
            _ if signs.pelvis_height < CROUCH_HEIGHT => Self::Crouch(signs.pelvis_height),
            Some(correlation) if correlation > -PATTERN => Self::Shuffle(correlation),
            None => Self::Shuffle(0.0),
            _ if signs.flight_share >= RUN_FLIGHT => Self::Run,
            _ => Self::Walk,
        }
    }

    fn of_staying(signs: &Signs) -> Self {
        if signs.drift >= STANDING_SPEED {
            Self::Drift(signs.drift)
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
        matches!(self, Self::Stand | Self::Walk | Self::Run)
    }

    /// The first of the words: what it is, without how much.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Stand => "stand",
            Self::Walk => "walk",
            Self::Run => "run",
            Self::Fall(_) => "fall",
            Self::Hop(..) => "hop",
            Self::Still(..) => "still",
            Self::Crawl(..) => "crawl",
            Self::Crouch(_) => "crouch",
            Self::Shuffle(_) => "shuffle",
            Self::StepInPlace(_) => "step in place",
            Self::Drift(_) => "drift",
        }
    }
}

impl std::fmt::Display for Verdict {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let name = self.name();
        match self {
            Self::Stand | Self::Walk | Self::Run => f.write_str(name),
            Self::Fall(seconds) => write!(f, "{name}: after {seconds:.1} s"),
            Self::Hop(correlation, true) => write!(f, "{name}: hips in phase ({correlation:+.2})"),
            Self::Hop(correlation, false) => {
                write!(f, "{name}: feet land together ({correlation:+.2})")
            }
            Self::Still(speed, asked) | Self::Crawl(speed, asked) => {
                write!(f, "{name}: {speed:.2} of {asked:.2} m/s")
            }
            Self::Crouch(height) => write!(f, "{name}: pelvis at {height:.2} m"),
            Self::Shuffle(correlation) => {
                write!(f, "{name}: legs do not alternate ({correlation:+.2})")
            }
            Self::StepInPlace(rate) => write!(f, "{name}: {rate:.1} strides/s, asked to stand"),
            Self::Drift(speed) => write!(f, "{name}: {speed:.2} m/s, asked to stay"),
        }
    }
}

#[cfg(test)]
mod tests;

//! Why an episode ended: as a number in rollouts, as a name in metrics and reports, counted.

use serde::ser::{Serialize, SerializeMap, Serializer};

/// As a rollout says that an episode goes on. Ends are [`Cause::code`].
pub const RUNNING: f32 = 0.0;

/// Why an episode ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Cause {
    /// The robot lies, or is about to.
    Fall,
    /// The time was up; the robot could have gone on.
    TimeOut,
    /// The robot went on at a velocity that was not asked for.
    Stray,
    /// The step could not be used: its action or its result was not finite.
    Fault,
}

impl Cause {
    /// All of them, in the order of their codes.
    pub const ALL: [Self; 4] = [Self::Fall, Self::TimeOut, Self::Stray, Self::Fault];

    /// As written into a rollout: 1 to 4.
    pub const fn code(self) -> f32 {
        match self {
            Self::Fall => 1.0,
            Self::TimeOut => 2.0,
            Self::Stray => 3.0,
            Self::Fault => 4.0,
        }
    }

    /// What a rollout says of a step; an error holds a number that says nothing.
    pub fn of(code: f32) -> Result<Option<Self>, f32> {
        if code == RUNNING {
            return Ok(None);
        }
        let found = Self::ALL.into_iter().find(|cause| cause.code() == code);
        found.map(Some).ok_or(code)
    }

    /// As written in metrics and reports.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Fall => "fall",
            Self::TimeOut => "time_out",
            Self::Stray => "stray",
            Self::Fault => "fault",
        }
    }
}

/// How many episodes ended for each cause. Serialises as a map from every cause's name to its count.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts([u64; Cause::ALL.len()]);

impl Counts {
    /// Of the steps of rollouts; numbers that say nothing are not counted.
    pub fn of(ends: &[f32]) -> Self {
        let mut counts = Self::default();
        for cause in ends.iter().filter_map(|&end| Cause::of(end).ok().flatten()) {
            counts.add(cause);
        }
        counts
    }

    /// Counts one more.
    pub fn add(&mut self, cause: Cause) {
        self.0[cause as usize] += 1;
    }

    /// Counts all of another's.
    pub fn merge(&mut self, other: &Self) {
        for (count, more) in self.0.iter_mut().zip(other.0) {
            *count += more;
        }
    }

    /// Episodes that ended for a cause.
    pub fn by(&self, cause: Cause) -> u64 {
        self.0[cause as usize]
    }

    /// Episodes that ended.
    pub fn total(&self) -> u64 {
        self.0.iter().sum()
    }
}

impl Serialize for Counts {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(Some(Cause::ALL.len()))?;
        for cause in Cause::ALL {
            map.serialize_entry(cause.name(), &self.by(cause))?;
        }
        map.end()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn codes_are_read_back_and_others_say_nothing() {
        let read = Cause::ALL.map(|cause| Cause::of(cause.code()));
        assert_eq!(read, Cause::ALL.map(|cause| Ok(Some(cause))));
        assert_eq!(Cause::ALL.map(Cause::code), [1.0, 2.0, 3.0, 4.0]);
        assert_eq!(Cause::of(0.0), Ok(None));
        for none in [5.0, -1.0, 1.5, f32::INFINITY] {
            assert_eq!(Cause::of(none), Err(none));
        }
        assert!(Cause::of(f32::NAN).is_err());
    }

    #[test]
    fn every_end_is_counted_once() {
        let mut counts = Counts::of(&[0.0, 1.0, 3.0, 0.0, 1.0, 4.0, 9.0]);
        counts.add(Cause::TimeOut);
        counts.merge(&Counts::of(&[2.0, 3.0]));
        assert_eq!(Cause::ALL.map(|cause| counts.by(cause)), [2, 2, 2, 1]);
        assert_eq!(counts.total(), 7);
    }
}

//! What the terms of the task came to in a rollout: names with means, in a header of fixed size.
//!
//! Separate because names cross a border here: the actor knows which terms there are, the learner writes whatever it is
//! told under the names that it is told, and neither has the other's table.

use iceoryx2::prelude::ZeroCopySend;

use super::layout::Flaw;

/// Most terms that a header can tell.
pub const MAX_TERMS: usize = 16;
/// Most bytes of a name.
pub const MAX_NAME: usize = 28;
/// Groups that a name begins with.
const GROUPS: [&str; 2] = ["reward/", "gate/"];

/// A term's mean over the steps of a rollout.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, ZeroCopySend)]
#[type_name("ampco.TermMean")]
pub struct TermMean {
    /// Its name in metrics, filled up with zeros; all zeros where there is no term.
    name: [u8; MAX_NAME],
    mean: f32,
}

impl TermMean {
    /// Of the terms that a fleet tells.
    ///
    /// # Panics
    /// With more than [`MAX_TERMS`] terms, or a name of more than [`MAX_NAME`] bytes.
    pub fn of<'a>(told: impl IntoIterator<Item = (&'a str, f32)>) -> [Self; MAX_TERMS] {
        let mut terms = [Self::default(); MAX_TERMS];
        for (count, (name, mean)) in told.into_iter().enumerate() {
            assert!(count < MAX_TERMS, "a header tells {MAX_TERMS} terms");
            let term = &mut terms[count];
            term.name[..name.len()].copy_from_slice(name.as_bytes());
            term.mean = mean;
        }
        terms
    }

    /// Its name as it is sent, filled up with zeros, and its mean, sound or not: for one who only carries it.
    pub fn parts(&self) -> ([u8; MAX_NAME], f32) {
        (self.name, self.mean)
    }

    /// What [`Self::parts`] gave.
    pub fn from_parts(name: [u8; MAX_NAME], mean: f32) -> Self {
        Self { name, mean }
    }

    /// Name and mean; none where there is no term. An error holds a number that cannot be, or 0 where the name cannot.
    fn read(&self) -> Result<Option<(&str, f32)>, f32> {
        let length = self.name.iter().position(|byte| *byte == 0);
        let (name, rest) = self.name.split_at(length.unwrap_or(MAX_NAME));
        if name.is_empty() && self.mean == 0.0 && rest.iter().all(|byte| *byte == 0) {
            return Ok(None);
        }
        let plain = |byte: &u8| byte.is_ascii_lowercase() || matches!(byte, b'/' | b'_');
        let named = std::str::from_utf8(name).ok().filter(|name| {
            GROUPS
                .iter()
                .any(|group| name.len() > group.len() && name.starts_with(group))
                && name.bytes().all(|byte| plain(&byte))
                && rest.iter().all(|byte| *byte == 0)
        });
        match named {
            Some(_) if !self.mean.is_finite() => Err(self.mean),
            Some(name) => Ok(Some((name, self.mean))),
            None => Err(0.0),
        }
    }
}

/// What a header tells of the terms, in its order.
///
/// # Errors
/// A name or a mean that no sound actor sends.
pub(super) fn read(terms: &[TermMean; MAX_TERMS]) -> Result<Vec<(&str, f32)>, Flaw> {
    let mut told: Vec<(&str, f32)> = Vec::new();
    for (row, term) in terms.iter().enumerate() {
        let flaw = |value| Flaw {
            field: "terms",
            row,
            value,
        };
        if let Some((name, mean)) = term.read().map_err(flaw)? {
            if told.iter().any(|(other, _)| *other == name) {
                return Err(flaw(mean));
            }
            told.push((name, mean));
        }
    }
    Ok(told)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_was_told_is_read_back() {
        let told = [("reward/track", 0.25), ("gate/upright", 1.0)];
        let terms = TermMean::of(told);
        assert_eq!(read(&terms), Ok(told.to_vec()));
        assert_eq!(read(&TermMean::of([])), Ok(Vec::new()));
        let longest = format!("gate/{}", "x".repeat(MAX_NAME - 5));
        assert_eq!(
            read(&TermMean::of([(&*longest, 0.5)])),
            Ok(vec![(&*longest, 0.5)])
        );
    }

    #[test]
    fn what_no_actor_tells_is_refused() {
        let flaw = |told: &[(&str, f32)]| {
            let terms = TermMean::of(told.iter().copied());
            read(&terms).unwrap_err().row
        };
        assert_eq!(
            flaw(&[("reward/track", 1.0), ("gate/upright", f32::NAN)]),
            1
        );
        // Names that would write over other figures, twice the same, or no names.
        for name in [
            "samples",
            "reward/",
            "timing.seconds",
            "reward/Track",
            "gate/a b",
            "",
        ] {
            assert_eq!(flaw(&[(name, 0.5)]), 0, "{name}");
        }
        assert_eq!(flaw(&[("gate/a", 0.5), ("gate/a", 0.5)]), 1);
        let mut torn = TermMean::of([("gate/a", 0.5)]);
        torn[3].name = [0xff; MAX_NAME];
        assert_eq!(read(&torn).unwrap_err().row, 3);
        torn[3] = TermMean::default();
        torn[3].name[5] = b'x';
        assert_eq!(read(&torn).unwrap_err().row, 3);
        let mut behind = TermMean::of([("gate/a", 0.5)]);
        behind[0].name[9] = b'x';
        assert_eq!(read(&behind).unwrap_err().row, 0);
    }
}

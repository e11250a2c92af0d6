//! Why a value of the configuration is refused: where it stands, what it is, what would be accepted.
//!
//! Separate so that each section's struct stands beside the code that reads it and all fail alike.

use std::fmt::Debug;

/// A value that cannot be used.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{path} = {value} is not usable: {remedy}")]
pub struct Invalid {
    /// Where it stands in its section, dotted.
    pub path: String,
    /// The value, printed.
    pub value: String,
    /// What would be accepted.
    pub remedy: String,
}

/// What a check comes to.
pub type Checked = Result<(), Invalid>;

impl Invalid {
    /// Of a value.
    pub fn new(path: impl Into<String>, value: impl Debug, remedy: impl Into<String>) -> Self {
        Self {
            path: path.into(),
            value: format!("{value:?}"),
            remedy: remedy.into(),
        }
    }

    /// The same, with its path from outside the table that it stands in.
    #[must_use]
    pub fn inside(self, table: &str) -> Self {
        Self {
            path: format!("{table}.{}", self.path),
            ..self
        }
    }
}

/// Fails unless `value` holds.
pub fn require(holds: bool, path: &str, value: impl Debug, remedy: impl Into<String>) -> Checked {
    if holds {
        return Ok(());
    }
    Err(Invalid::new(path, value, remedy))
}

/// A share lies in 0..=1.
pub fn share(path: &str, value: f32) -> Checked {
    let holds = (0.0..=1.0).contains(&value);
    require(holds, path, value, "give a share from 0 to 1")
}

/// A number that is finite and no less than `least`.
pub fn at_least(path: &str, value: f32, least: f32) -> Checked {
    let holds = value.is_finite() && value >= least;
    require(
        holds,
        path,
        value,
        format!("give a finite number from {least} on"),
    )
}

/// A number that is finite and above 0.
pub fn positive(path: &str, value: f32) -> Checked {
    let holds = value.is_finite() && value > 0.0;
    require(holds, path, value, "give a finite number above 0")
}

/// A range is finite and in order.
pub fn range(path: &str, value: [f32; 2]) -> Checked {
    let holds = value.iter().all(|x| x.is_finite()) && value[0] <= value[1];
    require(
        holds,
        path,
        value,
        "give two finite numbers, the lesser first",
    )
}

/// A number within limits; `why` says what they are.
pub fn between(path: &str, value: f32, limits: [f32; 2], why: &str) -> Checked {
    let [least, greatest] = limits;
    let holds = (least..=greatest).contains(&value);
    let remedy = format!("give a number from {least} to {greatest}: {why}");
    require(holds, path, value, remedy)
}

/// A range that is finite, in order and within limits; `why` says what they are.
pub fn range_between(path: &str, value: [f32; 2], limits: [f32; 2], why: &str) -> Checked {
    range(path, value)?;
    let [least, greatest] = limits;
    let holds = least <= value[0] && value[1] <= greatest;
    let remedy = format!("give a range within {least} to {greatest}: {why}");
    require(holds, path, value, remedy)
}

/// A table inside a section, checked by its owner.
pub fn within(table: &str, checked: Checked) -> Checked {
    checked.map_err(|invalid| invalid.inside(table))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_refusal_names_path_value_and_remedy() {
        let told = within("command", share("kinds.mixed", 1.5)).unwrap_err();
        assert_eq!(
            told.to_string(),
            "command.kinds.mixed = 1.5 is not usable: give a share from 0 to 1"
        );
    }

    #[test]
    fn numbers_that_are_none_are_no_numbers_of_any_kind() {
        for broken in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
            assert!(share("x", broken).is_err() && positive("x", broken).is_err());
            assert!(at_least("x", broken, 0.0).is_err());
            assert!(range("x", [broken, 1.0]).is_err() && range("x", [0.0, broken]).is_err());
        }
        assert!(at_least("x", 0.5, 0.5).is_ok() && at_least("x", 0.4, 0.5).is_err());
        assert!(positive("x", 0.0).is_err() && positive("x", 1e-30).is_ok());
        assert!(range("x", [1.0, 1.0]).is_ok() && range("x", [2.0, 1.0]).is_err());
        assert!(share("x", 1.0).is_ok() && share("x", 1.001).is_err());
    }

    #[test]
    fn limits_are_told_with_their_reason() {
        let told = range_between("friction", [0.5, 9.0], [0.0, 3.0], "rubber has 1").unwrap_err();
        assert_eq!(
            told.to_string(),
            "friction = [0.5, 9.0] is not usable: give a range within 0 to 3: rubber has 1"
        );
        for (range, holds) in [
            ([0.0, 3.0], true),
            ([-0.1, 3.0], false),
            ([0.0, 3.1], false),
            ([2.0, 1.0], false),
            ([f32::NAN, 1.0], false),
        ] {
            assert_eq!(range_between("x", range, [0.0, 3.0], "").is_ok(), holds);
        }
        for (value, holds) in [(0.0, true), (3.0, true), (3.1, false), (f32::NAN, false)] {
            assert_eq!(between("x", value, [0.0, 3.0], "").is_ok(), holds);
        }
    }
}

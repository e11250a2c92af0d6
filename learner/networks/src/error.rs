//! Why weights or states from outside were refused.

/// A vector that does not fit the network it is for.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum NetworkError {
    /// A flat vector of the wrong length.
    #[error("{what}: {found} numbers, expected {expected}")]
    Length {
        /// What the vector is.
        what: String,
        /// Numbers that the shape has.
        expected: usize,
        /// Numbers given.
        found: usize,
    },
    /// NaN or infinite.
    #[error("{what}: number {index} is {value}")]
    NotFinite {
        /// What the vector is.
        what: String,
        /// Index in it.
        index: usize,
        /// Its value.
        value: f32,
    },
}

impl NetworkError {
    /// Passes if a vector has the expected length.
    pub fn check_length(what: &str, expected: usize, found: usize) -> Result<(), Self> {
        if expected == found {
            return Ok(());
        }
        Err(Self::Length {
            what: what.to_owned(),
            expected,
            found,
        })
    }
}

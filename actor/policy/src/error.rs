//! Why weights were refused.

/// Refused weights, or what comes with them; the policy then keeps those it has.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum PolicyError {
    /// The vector is not as long as the shape says.
    #[error("{found} weights where the shape has {expected}")]
    Length {
        /// Numbers that the shape has.
        expected: usize,
        /// Numbers given.
        found: usize,
    },
    /// NaN or infinite.
    #[error("weight {index} is {value}, not a finite number")]
    NotFinite {
        /// Index in the flat vector.
        index: usize,
        /// Its value.
        value: f32,
    },
    /// An exploration width that is no width.
    #[error("standard deviation of action {action} is {value}, not above zero")]
    Deviation {
        /// Index of the action.
        action: usize,
        /// Its value.
        value: f32,
    },
    /// A limit of normalised observations that is no limit.
    #[error("the clip of observations is {value}, not a finite number above zero")]
    Clip {
        /// Its value.
        value: f32,
    },
}

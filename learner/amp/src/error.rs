//! Why an iteration was refused or a state cannot be continued.

/// What went wrong. After any of them the learner is as it was before the call.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum LearningError {
    /// The batch holds no row.
    #[error("the batch is empty")]
    EmptyBatch,
    /// A field of the batch has another length than its segments say.
    #[error("field `{field}` of the batch has {found} numbers, its segments need {expected}")]
    BatchLength {
        /// Name of the field.
        field: &'static str,
        /// Numbers needed.
        expected: usize,
        /// Numbers found.
        found: usize,
    },
    /// Rows of the batch are not as wide as what is seen of the robot.
    #[error("rows of the batch have {found:?}, this learner's {expected:?}")]
    BatchWidths {
        /// Numbers needed.
        expected: crate::Widths,
        /// Numbers found.
        found: crate::Widths,
    },
    /// The batch holds NaN or infinity: nothing was learnt from it.
    #[error("field `{field}` of the batch, row {row}, holds {value}")]
    BatchNotFinite {
        /// Name of the field.
        field: &'static str,
        /// Row, counted over the whole field.
        row: usize,
        /// The value.
        value: f32,
    },
    /// An update computed NaN or infinity; the last good weights stay.
    #[error("{what} became {value} in iteration {iteration}; the weights from before it are kept")]
    NotFinite {
        /// Name of the tensor or quantity.
        what: String,
        /// The value.
        value: f64,
        /// Iterations done before.
        iteration: u64,
    },
    /// The rule of the scheduler cannot be evaluated.
    #[error("rule of the scheduler")]
    Rule(#[from] ampco::RuleError),
    /// A section of the configuration cannot be used.
    #[error("section [{section}]")]
    Config {
        /// Name of the section.
        section: &'static str,
        /// What is wrong.
        #[source]
        source: vocabulary::Invalid,
    },
    /// The robot's tables contradict the dimensions.
    #[error("robot: {0}")]
    Robot(String),
    /// The saved state is not one of this program.
    #[error("saved state cannot be read: {0}")]
    Decode(String),
    /// The saved state is of networks of other sizes.
    #[error("tensor `{name}` is {saved} in the saved state and {expected} in the configuration")]
    Tensor {
        /// Name of the tensor.
        name: String,
        /// Its sizes as saved.
        saved: String,
        /// Its sizes as configured.
        expected: String,
    },
    /// The saved state of an optimizer or a normalizer does not fit.
    #[error("saved state does not fit")]
    Network(#[from] networks::NetworkError),
}

/// A quantity that an update made NaN or infinite.
#[derive(Clone, Debug, PartialEq)]
pub struct Fault {
    /// Name of the tensor or quantity.
    pub what: String,
    /// Its value.
    pub value: f64,
}

impl Fault {
    pub(crate) fn new(what: impl Into<String>, value: impl Into<f64>) -> Self {
        Self {
            what: what.into(),
            value: value.into(),
        }
    }

    /// Fails at the first NaN or infinity of `numbers`, by the name that `name` gives to its place.
    pub(crate) fn unless_finite(
        numbers: &[f32],
        name: impl FnOnce(usize) -> String,
    ) -> Result<(), Self> {
        match networks::first_not_finite(numbers) {
            Some(index) => Err(Self::new(name(index), numbers[index])),
            None => Ok(()),
        }
    }
}

//! A section of the configuration: a struct beside the code that it is for.
//!
//! Separate because whoever reads a section, whichever process it is, has to get the same one: under one name, and
//! checked. What its keys are for is said by the doc comments of its fields, which are read at run time as well.

use crate::invalid::Checked;
use schemars::JsonSchema;
use serde::Serialize;
use serde::de::DeserializeOwned;

/// A section of the configuration. Its defaults are used where a configuration does not mention a key.
pub trait Section: Serialize + DeserializeOwned + Default + JsonSchema {
    /// Its name in a configuration.
    const NAME: &'static str;

    /// Refuses the first value that cannot be used: called wherever a section is read, and by what is built of one that
    /// code has put together.
    fn validate(&self) -> Checked;
}

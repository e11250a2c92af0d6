//! What is said about a configuration that cannot be used: the place, the key, the value, the remedy.

use std::path::PathBuf;

use wording::{line, said};

/// Why a configuration cannot be used. Every message names the origin, the key and the remedy.
#[derive(Debug, thiserror::Error)]
pub enum ConfigError {
    /// The file cannot be read.
    #[error("cannot read {}", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// What the system said.
        #[source]
        source: std::io::Error,
    },
    /// The file cannot be written.
    #[error("cannot write {}", path.display())]
    Write {
        /// The file.
        path: PathBuf,
        /// What the system said.
        #[source]
        source: std::io::Error,
    },
    /// The text is not TOML.
    #[error("{origin}: not valid TOML: {message}")]
    Syntax {
        /// The file or preset.
        origin: String,
        /// What the file is instead, or line, column, what the parser said and a piece of the line.
        message: String,
    },
    /// A preset that lies on nothing that there is, or on itself, or takes away what is not there.
    #[error("{origin}: {}", said(problem))]
    Preset {
        /// The file or preset.
        origin: String,
        /// What is wrong, and what to write instead.
        problem: String,
    },
    /// `--set` was given something that is not `key=value`.
    #[error("--set {}: {}", line(given), said(problem))]
    Assignment {
        /// The argument as given.
        given: String,
        /// What is wrong with it.
        problem: String,
    },
    /// A section that nobody reads.
    #[error("{origin}: unknown section [{}]; {remedy}", line(section))]
    UnknownSection {
        /// Where it was given.
        origin: String,
        /// The section's name.
        section: String,
        /// The closest names.
        remedy: String,
    },
    /// A key that nobody reads.
    #[error(
        "{origin}: unknown key `{}` in [{section}] (value {value}); {remedy}",
        line(key)
    )]
    UnknownKey {
        /// Where it was given.
        origin: String,
        /// The section.
        section: String,
        /// The key, dotted if nested.
        key: String,
        /// The value given to it.
        value: String,
        /// The closest names.
        remedy: String,
    },
    /// A value of the wrong type or an unknown choice.
    #[error(
        "{origin}: `{}` = {value} in [{}]: {}",
        line(key),
        line(section),
        said(problem)
    )]
    Value {
        /// Where it was given.
        origin: String,
        /// The section.
        section: String,
        /// The key, dotted if nested.
        key: String,
        /// The value given to it.
        value: String,
        /// What was expected.
        problem: String,
    },
    /// A value that its section's owner refuses: out of range, or at odds with another.
    #[error("{origin}: [{section}] {}", said(problem))]
    Refused {
        /// Where it was given.
        origin: String,
        /// The section.
        section: String,
        /// The owner's words: field, value, remedy.
        problem: String,
    },
}

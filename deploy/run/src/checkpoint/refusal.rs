//! What is said about a checkpoint that cannot be used: the reason, and the newest good one.

use std::io;
use std::path::{Path, PathBuf};

use super::FORMAT_VERSION;

/// Why a checkpoint cannot be used or written.
#[derive(Debug, thiserror::Error)]
pub enum CheckpointError {
    /// It was looked at and found wanting.
    #[error("checkpoint {} is refused: {reason}; {}", path.display(), remedy(previous_good.as_deref()))]
    Refused {
        /// The checkpoint's folder.
        path: PathBuf,
        /// What is wrong with it.
        reason: Refusal,
        /// The newest older checkpoint of the run that is good.
        previous_good: Option<PathBuf>,
    },
    /// The run has none.
    #[error("there is no checkpoint in {}", .0.display())]
    None(PathBuf),
    /// The system refused, as with a full disk.
    #[error("cannot use {}", path.display())]
    Io {
        /// The file or folder.
        path: PathBuf,
        /// What the system said.
        #[source]
        source: io::Error,
    },
}

/// What is wrong with a checkpoint.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum Refusal {
    /// No manifest, or the manifest of something else.
    #[error("it is not a checkpoint of this program ({0})")]
    Foreign(String),
    /// Written by a later version of this program.
    #[error("its format is version {found}, and this program reads up to {FORMAT_VERSION}")]
    Newer {
        /// The version found.
        found: u32,
    },
    /// The manifest is not as it was written.
    #[error("its manifest is corrupt")]
    Manifest,
    /// A part is not there.
    #[error("part `{0}` is missing")]
    Missing(String),
    /// A part is shorter or longer than it was.
    #[error("part `{part}` is truncated: {found} bytes of {expected}")]
    Truncated {
        /// The part.
        part: String,
        /// Bytes written.
        expected: u64,
        /// Bytes found.
        found: u64,
    },
    /// A part's checksum differs.
    #[error("part `{0}` is corrupt: its checksum differs")]
    Corrupt(String),
    /// It belongs to networks of another shape.
    #[error("it is of shape `{found}`, and this run's is `{expected}`")]
    Shape {
        /// This run's shape.
        expected: String,
        /// The checkpoint's.
        found: String,
    },
}

fn remedy(previous_good: Option<&Path>) -> String {
    match previous_good {
        Some(path) => format!(
            "the newest good one before it is {}: move the refused one away to go on from that",
            path.display()
        ),
        None => "no earlier checkpoint is good".to_owned(),
    }
}

//! What is said about a checkpoint that cannot be used: the reason, and the newest good one.

use std::io;
use std::path::PathBuf;

use super::FORMAT_VERSION;

/// Why a checkpoint cannot be used or written.
#[derive(Debug, thiserror::Error)]
pub enum CheckpointError {
    /// It was looked at and found wanting.
    #[error("checkpoint {} is refused: {reason}{instead}", path.display())]
    Refused {
        /// The checkpoint's folder.
        path: PathBuf,
        /// What is wrong with it.
        reason: Refusal,
        /// What can be used in its place.
        instead: Instead,
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
    #[error(
        "it is of shape `{}`, and this run's is `{expected}`",
        wording::line(found)
    )]
    Shape {
        /// This run's shape.
        expected: String,
        /// The checkpoint's.
        found: String,
    },
}

/// What can be used in place of a refused checkpoint; as text it ends the sentence that refuses.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Instead {
    /// The newest good one of those before it.
    Earlier(PathBuf),
    /// There are earlier ones, and none of them is good.
    NoneGood,
    /// There is none before it, as of a checkpoint that lies alone.
    NoneEarlier,
    /// Nothing was looked for: the checkpoint is used without what was refused.
    Unasked,
}

impl std::fmt::Display for Instead {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Earlier(path) => write!(
                f,
                "; the newest good one before it is {}: give that folder, or move the refused one away to go on from \
                 that",
                path.display()
            ),
            Self::NoneGood => f.write_str("; no earlier checkpoint is good"),
            Self::NoneEarlier => f.write_str("; there is no earlier one beside it"),
            Self::Unasked => Ok(()),
        }
    }
}

//! What can be wrong with reference motion: each error names the place and the remedy.
//!
//! Separate because configuration, import and gait share it. What a message quotes of a file is cut short here, whoever
//! quotes it.

use std::path::PathBuf;
use wording::said;

/// Why a dataset of reference motion could not be made.
#[derive(Debug, thiserror::Error)]
pub enum MotionError {
    /// A field of the `[motion]` section has an unusable value.
    #[error("motion.{0}")]
    Config(vocabulary::Invalid),
    /// A file could not be read.
    #[error("cannot read motion file {}; check motion.clips[].file (relative paths start at the folder of the configuration)", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// Why.
        #[source]
        source: std::io::Error,
    },
    /// A line or a cell of a file cannot be used.
    #[error("{} line {line}{}: {}; {remedy}", path.display(), column_text(column), said(problem))]
    Cell {
        /// The file.
        path: PathBuf,
        /// Line, counted from 1.
        line: usize,
        /// Column, counted from 1, if one is to blame.
        column: Option<usize>,
        /// What is wrong.
        problem: String,
        /// What to do.
        remedy: String,
    },
    /// A frame of a file without lines cannot be used.
    #[error("{} frame {frame}, {}: {}; {remedy}", path.display(), wording::line(field), said(problem))]
    Frame {
        /// The file.
        path: PathBuf,
        /// Frame, counted from 1.
        frame: usize,
        /// The array or joint, and which of its numbers.
        field: String,
        /// What is wrong.
        problem: String,
        /// What to do.
        remedy: String,
    },
    /// A file as a whole cannot be used.
    #[error("{}: {}; {remedy}", path.display(), said(problem))]
    File {
        /// The file.
        path: PathBuf,
        /// What is wrong.
        problem: String,
        /// What to do.
        remedy: String,
    },
}

impl MotionError {
    /// What in the `[motion]` section is to blame.
    pub fn path(&self) -> &str {
        match self {
            Self::Config(invalid) => &invalid.path,
            Self::Read { .. } | Self::Cell { .. } | Self::Frame { .. } | Self::File { .. } => {
                "clips"
            }
        }
    }
}

fn column_text(column: &Option<usize>) -> String {
    column.map_or_else(String::new, |column| format!(" column {column}"))
}

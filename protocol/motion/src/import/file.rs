//! A file in memory, and the containers that formats share: NumPy's and PyTorch's archives, Python
//! pickles, and what all of them may be packed in.
//!
//! Separate because none of them knows motion, and because what can be wrong with a container is the
//! same for every format inside it.

pub(super) mod array;
pub(super) mod compressed;
pub(super) mod npz;
pub(super) mod pickle;
pub(super) mod torch;

use crate::error::MotionError;
use std::io::{self, Read};
use std::path::Path;

/// Largest file that is read, bytes: three hours of a table at 120 frames a second are about 400 MB.
const LARGEST: u64 = 512 << 20;

/// A file's content and the name that errors give it.
#[derive(Clone, Copy, Debug)]
pub(super) struct File<'a> {
    pub(super) path: &'a Path,
    pub(super) bytes: &'a [u8],
}

impl File<'_> {
    /// The content as text; what is not text becomes signs that no number has.
    pub(super) fn text(&self) -> std::borrow::Cow<'_, str> {
        String::from_utf8_lossy(self.bytes)
    }

    /// The file as a whole cannot be used.
    pub(super) fn unusable(&self, problem: &str, remedy: &str) -> MotionError {
        MotionError::File {
            path: self.path.into(),
            problem: problem.into(),
            remedy: remedy.into(),
        }
    }

    /// That it is something else than its name says, if that is known: a better reason than what a reader stumbled
    /// over. Asked once a reader has given up, so that nothing that can be read is refused.
    pub(super) fn foreign(&self) -> Option<MotionError> {
        let foreign = wording::foreign(self.bytes)?;
        Some(self.unusable(&format!("is {}", foreign.what), foreign.remedy))
    }

    /// A line of it cannot be used.
    pub(super) fn line(&self, line: usize, problem: String, remedy: &str) -> MotionError {
        MotionError::Cell {
            path: self.path.into(),
            line,
            column: None,
            problem,
            remedy: remedy.into(),
        }
    }

    /// A frame of it (counted from 0) cannot be used.
    pub(super) fn frame(
        &self,
        frame: usize,
        field: &str,
        problem: String,
        remedy: &str,
    ) -> MotionError {
        MotionError::Frame {
            path: self.path.into(),
            frame: frame + 1,
            field: field.into(),
            problem,
            remedy: remedy.into(),
        }
    }
}

/// The bytes of a file, if there are not too many.
pub(super) fn read(path: &Path) -> Result<Vec<u8>, MotionError> {
    let read = |source| MotionError::Read {
        path: path.into(),
        source,
    };
    let mut bytes = Vec::new();
    std::fs::File::open(path)
        .and_then(|file| file.take(LARGEST + 1).read_to_end(&mut bytes))
        .map_err(read)?;
    if bytes.len() as u64 > LARGEST {
        let large = io::Error::new(io::ErrorKind::FileTooLarge, "larger than 512 MiB");
        return Err(read(large));
    }
    Ok(bytes)
}

//! Files that other processes add to a checkpoint once it is written, and whether all of them have come.
//!
//! Separate because the manifest cannot know them: each carries its own length and checksum, and a process
//! that is killed never adds its own.

use super::manifest::{Part, is_part_name};
use super::{Checkpoint, CheckpointError, Checkpoints, Instead, Refusal};
use crate::replace;
use std::{fs, io};

impl Checkpoints {
    /// Opens the one to go on from: the newest that nothing is missing of, since what others were to attach when they
    /// were killed may never have come. Where none is whole, the newest is opened; a newest that is damaged is
    /// refused as by [`Checkpoints::open_newest`]. Given a shape, all must be of it.
    pub fn open_whole(&self, shape: Option<&str>) -> Result<Checkpoint, CheckpointError> {
        let newest = self.open_newest(shape)?;
        if self.is_whole(&newest) {
            return Ok(newest);
        }
        let older = self.list().into_iter().rev();
        let whole = older
            .filter(|at| *at < newest.iteration)
            .filter_map(|at| self.inspect(at, shape).ok())
            .find(|checkpoint| self.is_whole(checkpoint));
        Ok(whole.unwrap_or(newest))
    }

    /// Whether all that others were to attach to a checkpoint is there and as it was written.
    pub fn is_whole(&self, checkpoint: &Checkpoint) -> bool {
        let there =
            |name: &String| matches!(self.attachment(checkpoint.iteration, name), Ok(Some(_)));
        checkpoint.awaited.iter().all(there)
    }

    /// What a checkpoint lacks of all that others were to attach to it, each with the reason; empty where it is whole.
    pub fn lacks(&self, checkpoint: &Checkpoint) -> Vec<String> {
        let problem = |name: &String| match self.attachment(checkpoint.iteration, name) {
            Ok(Some(_)) => None,
            Ok(None) => Some(format!("{name} never came")),
            Err(CheckpointError::Refused { reason, .. }) => Some(format!("{name}: {reason}")),
            Err(other) => Some(format!("{name}: {other}")),
        };
        checkpoint.awaited.iter().filter_map(problem).collect()
    }

    /// The iteration of the newest that is whole, whatever its shape.
    pub fn newest_whole(&self) -> Option<u64> {
        let newest_first = self.list().into_iter().rev();
        newest_first
            .filter_map(|at| self.inspect(at, None).ok())
            .find(|checkpoint| self.is_whole(checkpoint))
            .map(|checkpoint| checkpoint.iteration)
    }

    /// Adds a file of another process (an actor's fleet) to a checkpoint that is already written.
    /// It carries its own length and checksum, since the manifest cannot know it.
    ///
    /// # Panics
    /// If the name is not a plain file name.
    pub fn attach(&self, iteration: u64, name: &str, bytes: &[u8]) -> Result<(), CheckpointError> {
        assert!(is_part_name(name), "{name:?} is not a plain file name");
        let path = self.path(iteration).join(name);
        let framed = [Part::of(name, bytes).frame().as_slice(), bytes].concat();
        replace::replace_file(&path, &framed).map_err(|source| CheckpointError::Io { path, source })
    }

    /// What [`Checkpoints::attach`] added, checked; `None` when nothing of that name was.
    pub fn attachment(
        &self,
        iteration: u64,
        name: &str,
    ) -> Result<Option<Vec<u8>>, CheckpointError> {
        let path = self.path(iteration).join(name);
        let framed = match fs::read(&path) {
            Ok(framed) => framed,
            Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(None),
            Err(source) => return Err(CheckpointError::Io { path, source }),
        };
        unframe(name, &framed)
            .map(Some)
            .map_err(|reason| CheckpointError::Refused {
                path: self.path(iteration),
                reason,
                instead: Instead::Unasked,
            })
    }
}

fn unframe(name: &str, framed: &[u8]) -> Result<Vec<u8>, Refusal> {
    let Some((frame, bytes)) = framed.split_first_chunk() else {
        return Err(Refusal::Corrupt(name.to_owned()));
    };
    Part::unframe(name, frame).check(bytes)?;
    Ok(bytes.to_vec())
}

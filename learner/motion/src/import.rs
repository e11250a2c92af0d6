//! Motion from files, on the same footing as the built-in gait.
//!
//! Separate because files are not to be trusted: everything is checked before it is a [`Clip`].
//! The way: `import/csv.rs` reads rows, `import/resample.rs` brings them to 50 Hz, puts the feet on
//! the ground and differentiates.

mod csv;
mod resample;

use crate::clip::Clip;
use crate::config::QuaternionOrder;
use crate::error::MotionError;
use g1::JOINTS;
use nalgebra::{UnitQuaternion, Vector3};
use std::io::{self, Read};
use std::path::Path;

/// How a file is to be understood.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Options {
    /// Frames per second of the file.
    pub fps: f64,
    /// Order of the quaternion when there is no header to tell.
    pub quaternion: QuaternionOrder,
    /// Whether to move the motion up or down until the feet are on the ground.
    pub ground: bool,
}

/// A row of a file: place and posture, no velocities yet.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Row {
    position: Vector3<f64>,
    orientation: UnitQuaternion<f64>,
    joints: [f64; JOINTS],
}

/// Largest file that is read, bytes: three hours at 120 frames a second are about 400 MB.
const LARGEST: u64 = 512 << 20;

/// Reads a CSV file of motion.
///
/// # Errors
/// A missing, too large or unreadable file, or the first line that cannot be used.
pub fn load(path: &Path, options: &Options) -> Result<Clip, MotionError> {
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
    let rows = csv::parse(&String::from_utf8_lossy(&bytes), path, options.quaternion)?;
    resample::clip(&rows, path, options)
}

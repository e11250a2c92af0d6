//! Room in shared memory: asked for before it is used.
//!
//! Separate because a full `/dev/shm` must end in one clear error. Its files are sparse: without
//! this, creating a port succeeds and the first write to a page that does not exist kills the
//! process with SIGBUS, possibly hours later and in another process.

use std::fmt::Display;
use std::fs::{self, File, OpenOptions, Permissions};
use std::io;
use std::os::unix::fs::{MetadataExt, PermissionsExt};
use std::path::PathBuf;

use rustix::fs::{FallocateFlags, fallocate, statvfs};
use rustix::io::Errno;

use crate::domain::SHARED_MEMORY;
use crate::error::PortError;

/// Bytes kept free for the small segments in which connections and services are kept.
pub(crate) const MARGIN: u64 = 4 << 20;

/// Fails unless `bytes` and a margin are free in shared memory.
pub(crate) fn require(stream: &'static str, bytes: u64) -> Result<(), PortError> {
    let free = free_bytes(stream)?;
    if free < bytes + MARGIN {
        let needed = bytes + MARGIN;
        return Err(PortError::Memory {
            stream,
            needed,
            free,
        });
    }
    Ok(())
}

/// Takes the pages of the segment whose name begins with `prefix` and ends with `suffix` now, so
/// that later writes cannot fail. (In between stands a digest of iceoryx2's own.)
pub(crate) fn commit(stream: &'static str, prefix: &str, suffix: &str) -> Result<(), PortError> {
    let system = |cause: String| PortError::System {
        stream,
        action: "reserving shared memory",
        cause,
    };
    let (path, file) = open(prefix, suffix)
        .map_err(|error| system(format!("{SHARED_MEMORY}/{prefix}*{suffix}: {error}")))?;
    let described = |error: &dyn Display| system(format!("{}: {error}", path.display()));
    let needed = file.metadata().map_err(|error| described(&error))?.len();
    match fallocate(&file, FallocateFlags::empty(), 0, needed) {
        Ok(()) => Ok(()),
        Err(Errno::NOSPC) => Err(PortError::Memory {
            stream,
            needed,
            free: free_bytes(stream)?,
        }),
        Err(error) => Err(described(&error)),
    }
}

/// Takes from other users what the middleware left them of our segments: it makes those in which it
/// keeps its own accounts readable and writable for everyone.
pub(crate) fn make_private(prefix: &str) -> io::Result<()> {
    for entry in fs::read_dir(SHARED_MEMORY)? {
        let entry = entry?;
        if !entry
            .file_name()
            .as_encoded_bytes()
            .starts_with(prefix.as_bytes())
        {
            continue;
        }
        // A segment may vanish with its process while we look, and be another run's by then.
        let Ok(facts) = entry.metadata() else {
            continue;
        };
        if facts.mode() & 0o077 != 0 && facts.uid() == rustix::process::getuid().as_raw() {
            let private = Permissions::from_mode(facts.mode() & 0o700);
            match fs::set_permissions(entry.path(), private) {
                Err(error) if error.kind() != io::ErrorKind::NotFound => return Err(error),
                _ => {}
            }
        }
    }
    Ok(())
}

fn open(prefix: &str, suffix: &str) -> io::Result<(PathBuf, File)> {
    for entry in fs::read_dir(SHARED_MEMORY)? {
        let entry = entry?;
        let name = entry.file_name();
        let name = name.as_encoded_bytes();
        if name.starts_with(prefix.as_bytes()) && name.ends_with(suffix.as_bytes()) {
            let path = entry.path();
            let file = OpenOptions::new().write(true).open(&path)?;
            return Ok((path, file));
        }
    }
    Err(io::ErrorKind::NotFound.into())
}

fn free_bytes(stream: &'static str) -> Result<u64, PortError> {
    let facts = statvfs(SHARED_MEMORY).map_err(|error| PortError::System {
        stream,
        action: "measuring free shared memory",
        cause: format!("{SHARED_MEMORY}: {error}"),
    })?;
    // A tmpfs without a limit reports no blocks at all.
    if facts.f_blocks == 0 {
        return Ok(u64::MAX);
    }
    Ok(facts.f_bavail.saturating_mul(facts.f_frsize))
}

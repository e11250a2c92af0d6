//! What `torch.save` writes: a zip archive of a pickle, and the numbers of every tensor beside it.
//!
//! Separate because it joins two containers. Nothing of PyTorch is run: see [`super::pickle`].

use super::File;
use super::pickle::Pickle;
use crate::error::MotionError;
use std::cell::RefCell;
use std::io::{Cursor, Read};
use zip::ZipArchive;

/// Reads the pickle of an archive, `None` if it has none: `NAME/data.pkl` beside `NAME/data/0`, ….
///
/// # Errors
/// An archive or a pickle that is cut off or holds other than plain data.
pub(in crate::import) fn read(file: &File<'_>) -> Result<Option<Pickle>, MotionError> {
    let Ok(zip) = ZipArchive::new(Cursor::new(file.bytes)) else {
        return Ok(None); // the reader of NumPy's archives says what is wrong
    };
    let Some(folder) = zip
        .file_names()
        .find_map(|name| name.strip_suffix("data.pkl").map(String::from))
    else {
        return Ok(None);
    };
    let zip = RefCell::new(zip);
    let largest = file.bytes.len() as u64 * 8 + (1 << 20);
    let entry = |name: &str| {
        let mut zip = zip.borrow_mut();
        let entry = zip.by_name(&format!("{folder}{name}")).ok()?;
        let size = entry.size();
        let mut bytes = Vec::new();
        entry.take(largest).read_to_end(&mut bytes).ok()?;
        (bytes.len() as u64 == size).then_some(bytes)
    };
    if entry("byteorder").is_some_and(|order| order != b"little") {
        return Err(file.unusable(
            "was saved by PyTorch on a machine with the big end first",
            "save it again on an ordinary one",
        ));
    }
    let pickle = entry("data.pkl").ok_or_else(|| {
        file.unusable(
            "is an archive of PyTorch whose data.pkl cannot be read",
            "download or export it again: it may be cut off",
        )
    })?;
    let storages = Box::new(|name: &str| entry(&format!("data/{name}")));
    Pickle::read_with(file, &pickle, Some(storages)).map(Some)
}

#[cfg(test)]
pub(in crate::import) mod tests;

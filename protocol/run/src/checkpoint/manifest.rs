//! The manifest of a checkpoint: what was written, so that anything else is noticed.

use std::fs;
use std::path::Path;

use serde::{Deserialize, Serialize};

use super::{Contents, Refusal};

/// The version of the layout below; raised when an older program could no longer read it.
pub const FORMAT_VERSION: u32 = 1;
const FORMAT: &str = "ampco-checkpoint";

/// Its file, beside the parts.
pub(super) const FILE: &str = "manifest.json";

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Manifest {
    format: String,
    version: u32,
    pub(super) iteration: u64,
    pub(super) shape: String,
    pub(super) parts: Vec<Part>,
    /// Files that other processes were to attach.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub(super) awaited: Vec<String>,
    /// How good the owner finds it; the more the better.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(super) score: Option<f64>,
    /// CRC32 of this manifest written with a seal of 0.
    seal: u32,
}

/// What is known of a part.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Part {
    pub(super) name: String,
    length: u64,
    crc: u32,
}

impl Part {
    pub(super) fn of(name: &str, bytes: &[u8]) -> Self {
        Self {
            name: name.to_owned(),
            length: bytes.len() as u64,
            crc: crc32fast::hash(bytes),
        }
    }

    /// Whether these are the bytes that were written.
    pub(super) fn check(&self, bytes: &[u8]) -> Result<(), Refusal> {
        let found = bytes.len() as u64;
        if found != self.length {
            return Err(Refusal::Truncated {
                part: self.name.clone(),
                expected: self.length,
                found,
            });
        }
        if crc32fast::hash(bytes) != self.crc {
            return Err(Refusal::Corrupt(self.name.clone()));
        }
        Ok(())
    }

    /// Length and checksum in twelve bytes, for a file that carries its own.
    pub(super) fn frame(&self) -> [u8; 12] {
        let mut frame = [0; 12];
        frame[..8].copy_from_slice(&self.length.to_le_bytes());
        frame[8..].copy_from_slice(&self.crc.to_le_bytes());
        frame
    }

    /// The part that [`Part::frame`] describes.
    pub(super) fn unframe(name: &str, frame: &[u8; 12]) -> Self {
        let (length, crc) = frame.split_at(8);
        Self {
            name: name.to_owned(),
            length: u64::from_le_bytes(length.try_into().expect("eight bytes")),
            crc: u32::from_le_bytes(crc.try_into().expect("four bytes")),
        }
    }
}

impl Manifest {
    pub(super) fn new(iteration: u64, contents: &Contents<'_>, parts: Vec<Part>) -> Self {
        let mut manifest = Self {
            format: FORMAT.to_owned(),
            version: FORMAT_VERSION,
            iteration,
            shape: contents.shape.to_owned(),
            parts,
            awaited: contents.awaited.to_vec(),
            // JSON has no other numbers.
            score: contents.score.filter(|score| score.is_finite()),
            seal: 0,
        };
        manifest.seal = manifest.computed_seal();
        manifest
    }

    /// Reads the manifest in a folder, unless it is of something else or not as it was written.
    pub(super) fn read(path: &Path) -> Result<Self, Refusal> {
        let text = fs::read(path.join(FILE)).map_err(|_| Refusal::Foreign(format!("no {FILE}")))?;
        let any: serde_json::Value = serde_json::from_slice(&text)
            .map_err(|_| Refusal::Foreign(format!("{FILE} is not JSON")))?;
        if any["format"] != FORMAT {
            return Err(Refusal::Foreign(format!(
                "{FILE} says format {}",
                wording::line(&any["format"].to_string())
            )));
        }
        // The version comes first: a later manifest may have other fields.
        let found = any["version"]
            .as_u64()
            .and_then(|version| u32::try_from(version).ok());
        match found {
            Some(found) if found > FORMAT_VERSION => return Err(Refusal::Newer { found }),
            Some(_) => {}
            None => return Err(Refusal::Manifest),
        }
        let manifest: Self = serde_json::from_value(any).map_err(|_| Refusal::Manifest)?;
        let parts = manifest.parts.iter().map(|part| &part.name);
        let names_stay_inside = parts
            .chain(&manifest.awaited)
            .all(|name| is_part_name(name));
        if manifest.seal != manifest.computed_seal() || !names_stay_inside {
            return Err(Refusal::Manifest);
        }
        Ok(manifest)
    }

    fn computed_seal(&self) -> u32 {
        let mut unsealed = self.clone();
        unsealed.seal = 0;
        crc32fast::hash(&serde_json::to_vec(&unsealed).expect("a manifest is plain data"))
    }
}

/// Whether a name stays in its folder and is no file of ours.
pub(super) fn is_part_name(name: &str) -> bool {
    let plain = |c: char| c.is_ascii_alphanumeric() || matches!(c, '.' | '-' | '_');
    !name.is_empty() && !name.starts_with('.') && name != FILE && name.chars().all(plain)
}

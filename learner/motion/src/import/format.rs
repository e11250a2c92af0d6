//! Which format a file is in, told from its content.
//!
//! Separate because names of files lie: half of all `.npz` and `.csv` files hold something else than
//! the program expects that is given them.

use super::file::pickle::Pickle;
use super::file::{File, npz};
use super::phc;
use crate::error::MotionError;
use serde::{Deserialize, Serialize};
use std::fmt;
use std::str::FromStr;

/// The formats that can be read.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Format {
    /// AMASS, SMPL or SMPL+H parameters: `poses`, `trans`, `mocap_framerate` in an `.npz`.
    Amass,
    /// AMASS, SMPL-X parameters: `root_orient`, `pose_body`, `trans`, `mocap_frame_rate`.
    Smplx,
    /// Biovision hierarchy: LAFAN1, CMU, Bandai Namco and others.
    Bvh,
    /// Acclaim motion, with its skeleton in an `.asf` beside it: CMU.
    Amc,
    /// A table of the G1: Unitree's, its relatives, and what `ampco` writes.
    Csv,
    /// BeyondMimic, mjlab, whole_body_tracking: `joint_pos`, `body_pos_w`, `body_quat_w`.
    BeyondMimic,
    /// Isaac Lab's AMP motions: `dof_names`, `body_names`, `body_positions`.
    IsaacLab,
    /// Isaac Gym's AMP motions: a pickled skeleton motion in an `.npy`.
    IsaacGym,
    /// GMR: a pickle with `root_pos`, `root_rot`, `dof_pos`.
    Gmr,
    /// PHC, ASAP, PBHC: a pickle of clips with `root_trans_offset`, `root_rot` and `dof`, or `pose_aa`.
    Phc,
}

impl Format {
    /// All of them.
    pub const ALL: [Self; 10] = [
        Self::Amass,
        Self::Smplx,
        Self::Bvh,
        Self::Amc,
        Self::Csv,
        Self::BeyondMimic,
        Self::IsaacLab,
        Self::IsaacGym,
        Self::Gmr,
        Self::Phc,
    ];

    /// The name that users write.
    pub fn name(self) -> &'static str {
        match self {
            Self::Amass => "amass",
            Self::Smplx => "smplx",
            Self::Bvh => "bvh",
            Self::Amc => "amc",
            Self::Csv => "csv",
            Self::BeyondMimic => "beyondmimic",
            Self::IsaacLab => "isaaclab",
            Self::IsaacGym => "isaacgym",
            Self::Gmr => "gmr",
            Self::Phc => "phc",
        }
    }
}

impl fmt::Display for Format {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl FromStr for Format {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        Self::ALL
            .into_iter()
            .find(|format| format.name() == text)
            .ok_or_else(|| format!("give one of {}", Self::ALL.map(Self::name).join(", ")))
    }
}

/// The arrays that tell the `.npz` formats apart.
const ARRAYS: [(Format, [&str; 2]); 4] = [
    (Format::Smplx, ["pose_body", "root_orient"]),
    (Format::Amass, ["poses", "trans"]),
    (Format::BeyondMimic, ["joint_pos", "body_pos_w"]),
    (Format::IsaacLab, ["body_names", "body_positions"]),
];

/// The format of a file and by what it was told.
pub(super) fn detect(file: &File<'_>) -> Result<(Format, String), MotionError> {
    let bytes = file.bytes;
    if bytes.starts_with(b"PK") {
        return detect_npz(file);
    }
    if bytes.starts_with(b"\x93NUMPY") {
        return Ok((Format::IsaacGym, "a NumPy array of one object".into()));
    }
    if bytes.first() == Some(&0x80) {
        return detect_pickle(file);
    }
    let text = String::from_utf8_lossy(&bytes[..bytes.len().min(4096)]);
    let first = text
        .lines()
        .map(|line| line.trim_start_matches('\u{feff}').trim())
        .find(|line| !line.is_empty() && !line.starts_with('#'))
        .unwrap_or("");
    if first.eq_ignore_ascii_case("HIERARCHY") {
        return Ok((Format::Bvh, "HIERARCHY in its first line".into()));
    }
    if text.contains(":bonedata") || first.starts_with(":version") {
        return Err(file.unusable(
            "is an Acclaim skeleton (.asf), which holds no motion",
            "import the .amc files beside it; the skeleton is found by itself",
        ));
    }
    if first.starts_with(':') || first == "1" {
        return Ok((Format::Amc, "Acclaim's keywords".into()));
    }
    Ok((Format::Csv, "a table of numbers".into()))
}

/// The keys that tell the pickled formats apart.
fn detect_pickle(file: &File<'_>) -> Result<(Format, String), MotionError> {
    let pickle = Pickle::read(file, file.bytes)?;
    let told = |format: Format, keys: &str| Ok((format, format!("a pickle with {keys}")));
    if phc::is(&pickle) {
        return told(Format::Phc, "root_trans_offset, root_rot, dof, or pose_aa");
    }
    if pickle.has("root_pos") && pickle.has("dof_pos") {
        return told(Format::Gmr, "root_pos and dof_pos");
    }
    Err(file.unusable(
        &format!(
            "is a pickle with {}, which no known format has",
            pickle.keys().join(", ")
        ),
        "known are PHC, ASAP and PBHC, and GMR; say which with --format",
    ))
}

fn detect_npz(file: &File<'_>) -> Result<(Format, String), MotionError> {
    let archive = npz::Archive::open(file)?;
    let names = archive.names();
    let has = |name: &&str| names.iter().any(|n| n == name);
    for (format, arrays) in ARRAYS {
        if arrays.iter().all(has) {
            return Ok((format, format!("arrays {} and {}", arrays[0], arrays[1])));
        }
    }
    Err(file.unusable(
        &format!(
            "holds the arrays {}, which no known format has",
            names.join(", ")
        ),
        "known are AMASS, SMPL-X, BeyondMimic and Isaac Lab; say which with --format",
    ))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    fn told(bytes: &[u8]) -> Result<Format, String> {
        let path = Path::new("motion");
        detect(&File { path, bytes })
            .map(|(format, _)| format)
            .map_err(|e| e.to_string())
    }

    #[test]
    fn text_is_told_by_its_first_words() {
        assert_eq!(told(b"HIERARCHY\nROOT Hips"), Ok(Format::Bvh));
        assert_eq!(told(b"\xef\xbb\xbfhierarchy\r\n"), Ok(Format::Bvh));
        assert_eq!(told(b"#!OML:ASF x\n:FULLY-SPECIFIED\n"), Ok(Format::Amc));
        assert_eq!(told(b"x,y,z\n1,2,3"), Ok(Format::Csv));
        assert_eq!(told(b""), Ok(Format::Csv));
        let message = told(b":version 1.10\n:bonedata").unwrap_err();
        assert!(message.contains(".amc"), "{message}");
    }

    #[test]
    fn bytes_are_told_by_their_marks() {
        assert_eq!(told(b"\x93NUMPY\x01\x00"), Ok(Format::IsaacGym));
        let message = told(b"\x80\x04\x95").unwrap_err();
        assert!(message.contains("cut off"), "{message}");
        let message = told(b"\x80\x04}\x8c\x01aK\x01s.").unwrap_err();
        assert!(message.contains("pickle with a,"), "{message}");
        let message = told(b"PK\x03\x04 cut off").unwrap_err();
        assert!(message.contains("again"), "{message}");
    }

    #[test]
    fn names_are_read_back() {
        for format in Format::ALL {
            assert_eq!(format.to_string().parse(), Ok(format));
        }
        assert!("fbx".parse::<Format>().unwrap_err().contains("bvh"));
    }
}

//! Which format a file is in, told from its content.
//!
//! Separate because names of files lie: half of all `.npz` and `.csv` files hold something else than
//! the program expects that is given them.

use super::file::pickle::Pickle;
use super::file::{File, npz, torch};
use super::{amp_rsl_rl, frames, mimickit, phc, proto};
use crate::error::MotionError;
use serde::{Deserialize, Serialize};
use std::fmt;
use std::io::Read;
use std::path::Path;
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
    /// MimicKit: a pickle with `frames`.
    MimicKit,
    /// ProtoMotions: PyTorch's archive with `rigid_body_pos`.
    ProtoMotions,
    /// amp-rsl-rl: `joints_list`, `joint_positions`, `root_position`, in an `.npy` or `.npz`.
    #[serde(rename = "amp-rsl-rl")]
    AmpRslRl,
    /// DeepMimic: JSON with `Frames` of 44 numbers.
    DeepMimic,
    /// TienKung-Lab and its relatives: JSON with `FrameDuration` and `Frames`.
    TienKung,
}

impl Format {
    /// All of them.
    pub const ALL: [Self; 15] = [
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
        Self::MimicKit,
        Self::ProtoMotions,
        Self::AmpRslRl,
        Self::DeepMimic,
        Self::TienKung,
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
            Self::MimicKit => "mimickit",
            Self::ProtoMotions => "protomotions",
            Self::AmpRslRl => "amp-rsl-rl",
            Self::DeepMimic => "deepmimic",
            Self::TienKung => "tienkung",
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
const ARRAYS: [(Format, [&str; 2]); 5] = [
    (Format::Smplx, ["pose_body", "root_orient"]),
    (Format::Amass, ["poses", "trans"]),
    (Format::BeyondMimic, ["joint_pos", "body_pos_w"]),
    (Format::IsaacLab, ["body_names", "body_positions"]),
    (Format::AmpRslRl, ["joints_list", "joint_positions"]),
];

/// What PyTorch's files began with before they were archives: a pickled number.
const OLD_TORCH: &[u8] = b"\x80\x02\x8a\x0al\xfc\x9cF\xf9 j\xa8P\x19";

/// The format of a file and by what it was told.
pub(super) fn detect(file: &File<'_>) -> Result<(Format, String), MotionError> {
    let bytes = file.bytes;
    if bytes.starts_with(b"PK") {
        return detect_npz(file);
    }
    if bytes.starts_with(b"\x93NUMPY") {
        let dictionary = Pickle::of_npy(file)?;
        if amp_rsl_rl::is(&dictionary) {
            return Ok((Format::AmpRslRl, "joints_list and joint_positions".into()));
        }
        return Ok((Format::IsaacGym, "a NumPy array of one object".into()));
    }
    if bytes.starts_with(OLD_TORCH) {
        return Err(file.unusable(
            "was saved by PyTorch in its old format, which is no archive",
            "save it again: python -c \"import torch, sys; torch.save(torch.load(sys.argv[1], weights_only=True), sys.argv[2])\" FILE NEW",
        ));
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
    if first.starts_with('{') {
        return detect_json(file);
    }
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

fn detect_json(file: &File<'_>) -> Result<(Format, String), MotionError> {
    match frames::is_deepmimic(&file.text()) {
        Some(true) => Ok((Format::DeepMimic, "JSON with Frames".into())),
        Some(false) => Ok((
            Format::TienKung,
            "JSON with FrameDuration and Frames".into(),
        )),
        None => Err(file.unusable(
            "is JSON without Frames, which no known format is",
            "known are the clips of DeepMimic and of TienKung-Lab",
        )),
    }
}

/// The keys that tell the pickled formats apart.
fn detect_pickle(file: &File<'_>) -> Result<(Format, String), MotionError> {
    let pickle = Pickle::read(file, file.bytes)?;
    let told = |format: Format, keys: &str| Ok((format, format!("a pickle with {keys}")));
    if mimickit::is(&pickle) {
        return told(Format::MimicKit, "frames");
    }
    if proto::is(&pickle) {
        return told(Format::ProtoMotions, "rigid_body_pos");
    }
    if phc::is(&pickle) {
        return told(Format::Phc, "root_trans_offset, root_rot, dof, or pose_aa");
    }
    if pickle.has("root_pos") && pickle.has("dof_pos") {
        return told(Format::Gmr, "root_pos and dof_pos");
    }
    Err(file.unusable(
        &format!(
            "is a pickle with {}, which no known format has",
            pickle.holds()
        ),
        "known are PHC, ASAP and PBHC, GMR, and MimicKit; say which with --format",
    ))
}

/// That a file whose name promises one format begins like none of them, if so: a better reason than what is wrong with it as
/// the table that it was then taken for.
pub(super) fn misnamed(file: &File<'_>) -> Option<MotionError> {
    let ending = file.path.extension()?.to_string_lossy().to_lowercase();
    let promised = ["npz", "npy", "pkl", "bvh", "amc", "motion", "pt"].contains(&ending.as_str());
    let taken_for_a_table = matches!(detect(file), Ok((Format::Csv, _)));
    (promised && taken_for_a_table).then(|| {
        let head = String::from_utf8_lossy(&file.bytes[..file.bytes.len().min(4096)]);
        file.unusable(
            &format!(
                "is no .{ending} file: it begins with {}",
                wording::quoted(head.trim_start())
            ),
            "download or export it again, or give it the name of what it is",
        )
    })
}

fn detect_npz(file: &File<'_>) -> Result<(Format, String), MotionError> {
    if let Some(pickle) = torch::read(file)? {
        if proto::is(&pickle) {
            let told = "PyTorch's archive with rigid_body_pos";
            return Ok((Format::ProtoMotions, told.into()));
        }
        return Err(file.unusable(
            &format!(
                "is PyTorch's archive of {}, which no known format has",
                pickle.holds()
            ),
            "known are ProtoMotions' .motion and .pt",
        ));
    }
    let archive = npz::Archive::open(file)?;
    let names = archive.names();
    let has = |name: &&str| names.iter().any(|n| n == name);
    for (format, arrays) in ARRAYS {
        if arrays.iter().all(has) {
            return Ok((format, format!("arrays {} and {}", arrays[0], arrays[1])));
        }
    }
    if is_shape(&names) {
        return Err(file.unusable(
            "holds the shape of a body and no motion",
            "import the motions beside it; shapes in folders are passed over",
        ));
    }
    if names.is_empty() {
        return Err(file.unusable("holds no arrays", "download or export it again"));
    }
    Err(file.unusable(
        &format!(
            "holds the arrays {}, which no known format has",
            wording::line(&names.join(", "))
        ),
        "known are AMASS, SMPL-X, BeyondMimic, Isaac Lab and amp-rsl-rl; say which with --format",
    ))
}

/// Whether arrays are those of AMASS's `shape.npz` and `…_stagei.npz`: betas, and nothing that moves.
fn is_shape(names: &[String]) -> bool {
    let has = |name: &str| names.iter().any(|n| n == name);
    let moves = ["poses", "pose_body", "trans", "root_orient"];
    (has("betas") || has("beta")) && !moves.into_iter().any(has)
}

/// Whether a file is a body's shape without motion, as AMASS puts one beside every subject's motions.
/// Files that cannot be read, and large ones, are none.
pub fn is_body_shape(path: &Path) -> bool {
    const LARGEST: u64 = 4 << 20;
    let small = std::fs::metadata(path).is_ok_and(|file| file.is_file() && file.len() <= LARGEST);
    let Some(bytes) = small.then(|| std::fs::read(path).ok()).flatten() else {
        return false;
    };
    let file = File {
        path,
        bytes: &bytes,
    };
    bytes.starts_with(b"PK")
        && npz::Archive::open(&file).is_ok_and(|archive| is_shape(&archive.names()))
}

/// Whether a text file is a clip of `Frames` by its beginning: other JSON and notes lie beside motions.
pub fn is_text_of_frames(path: &Path) -> bool {
    const BEGINNING: u64 = 4096;
    let mut begin = Vec::new();
    let read =
        std::fs::File::open(path).and_then(|file| file.take(BEGINNING).read_to_end(&mut begin));
    let text = String::from_utf8_lossy(&begin);
    let text = text.trim_start_matches('\u{feff}').trim_start();
    read.is_ok() && text.starts_with('{') && text.contains("\"Frames\"")
}

#[cfg(test)]
#[path = "format_tests.rs"]
mod tests;

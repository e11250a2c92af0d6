//! Acclaim motion (`.amc`) with its skeleton (`.asf`), as in the CMU collection.
//!
//! Separate as every format is. A bone's rotation is given about the axes of its own frame:
//! L = C·R·C⁻¹ with C the bone's axis, R = Rz·Ry·Rx of the degrees of freedom that it has.

mod asf;

use super::file::{self, File};
use super::human::Joints;
use crate::error::MotionError;
use asf::Skeleton;
use nalgebra::{Rotation3, Vector3};
use std::path::{Path, PathBuf};

/// Frames per second of the CMU collection: the format has no place for it.
pub(super) const USUAL_FPS: f64 = 120.0;

/// Joint positions: a bone's entry is where it ends. Says which skeleton was taken.
pub(super) fn read(
    file: &File<'_>,
    skeleton: Option<&Path>,
    decisions: &mut Vec<String>,
) -> Result<Joints, MotionError> {
    let path = match skeleton {
        Some(path) => path.to_owned(),
        None => find_skeleton(file)?,
    };
    let bytes = file::read(&path)?;
    let skeleton = File {
        path: &path,
        bytes: &bytes,
    };
    let skeleton = asf::read(&skeleton).map_err(|error| skeleton.foreign().unwrap_or(error))?;
    decisions.push(format!("skeleton {}", path.display()));
    let frames = frames(file, &skeleton)?;
    Ok(named(&skeleton, frames))
}

/// The skeleton beside a motion: named like the part before the underscore (02_01.amc, 02.asf), else
/// the only one there.
fn find_skeleton(file: &File<'_>) -> Result<PathBuf, MotionError> {
    let stem = file
        .path
        .file_stem()
        .map(|s| s.to_string_lossy().into_owned())
        .unwrap_or_default();
    let subject = stem.split('_').next().unwrap_or(&stem);
    let folder = file.path.parent().unwrap_or(Path::new(""));
    for name in [&stem, subject] {
        let path = folder.join(format!("{name}.asf"));
        if path.is_file() {
            return Ok(path);
        }
    }
    let here = if folder.as_os_str().is_empty() {
        Path::new(".")
    } else {
        folder
    };
    let mut found: Vec<PathBuf> = std::fs::read_dir(here)
        .map(|entries| entries.flatten().map(|entry| entry.path()).collect())
        .unwrap_or_default();
    found.retain(|path| {
        path.extension()
            .is_some_and(|e| e.eq_ignore_ascii_case("asf"))
    });
    match found.as_slice() {
        [only] => Ok(only.clone()),
        _ => Err(file.unusable(
            &format!("needs its skeleton; {subject}.asf is not beside it"),
            "put the subject's .asf file into the same folder, or give --skeleton FILE",
        )),
    }
}

/// Ends of the bones in every frame, the root first.
fn frames(file: &File<'_>, skeleton: &Skeleton) -> Result<Vec<Vec<Vector3<f64>>>, MotionError> {
    let text = file.text();
    let mut frames = Vec::new();
    let mut pose: Option<Pose> = None;
    for (i, line) in text.lines().enumerate() {
        let line = line.trim();
        if line.is_empty() || line.starts_with(['#', ':']) {
            continue;
        }
        let mut words = line.split_whitespace();
        let first = words.next().unwrap_or("");
        if let Ok(number) = first.parse::<u64>() {
            frames.extend(
                pose.take()
                    .map(|pose| pose.finish(file, skeleton, frames.len()))
                    .transpose()?,
            );
            if number != frames.len() as u64 + 1 {
                let problem = format!("frame {number} follows frame {}", frames.len());
                let remedy = "frames must follow each other; export it again or cut the gap";
                return Err(file.line(i + 1, problem, remedy));
            }
            pose = Some(Pose::new(skeleton));
            continue;
        }
        let Some(pose) = &mut pose else {
            let problem = format!("{first:?} before the first frame");
            return Err(file.line(
                i + 1,
                problem,
                "a motion begins with the line 1; is it an .amc file?",
            ));
        };
        pose.set(file, skeleton, i + 1, frames.len(), first, words)?;
    }
    frames.extend(
        pose.map(|pose| pose.finish(file, skeleton, frames.len()))
            .transpose()?,
    );
    if frames.is_empty() {
        return Err(file.unusable("holds no frames", "download or export it again"));
    }
    Ok(frames)
}

/// The numbers of a frame as they come in.
struct Pose {
    values: Vec<Option<Vec<f64>>>,
}

impl Pose {
    fn new(skeleton: &Skeleton) -> Self {
        Self {
            values: vec![None; skeleton.bones.len()],
        }
    }

    fn set<'w>(
        &mut self,
        file: &File<'_>,
        skeleton: &Skeleton,
        line: usize,
        frame: usize,
        bone: &str,
        words: impl Iterator<Item = &'w str>,
    ) -> Result<(), MotionError> {
        let Some(index) = skeleton.bones.iter().position(|b| b.name == bone) else {
            let problem = format!("bone {bone:?} is not in the skeleton");
            return Err(file.line(
                line,
                problem,
                "is it the skeleton of this subject? give --skeleton FILE",
            ));
        };
        let expected = skeleton.bones[index].channels.len();
        let numbers: Vec<f64> = words
            .map(|word| {
                word.parse::<f64>()
                    .ok()
                    .filter(|x| x.is_finite())
                    .ok_or_else(|| {
                        let problem = format!("{word:?} is not a finite number (line {line})");
                        file.frame(frame, bone, problem, "repair or cut the frame")
                    })
            })
            .collect::<Result<_, _>>()?;
        if numbers.len() != expected {
            let problem = format!(
                "{} where the skeleton has {expected} (line {line})",
                wording::count(numbers.len(), "number")
            );
            return Err(file.frame(frame, bone, problem, "download or export it again"));
        }
        self.values[index] = Some(numbers);
        Ok(())
    }

    fn finish(
        self,
        file: &File<'_>,
        skeleton: &Skeleton,
        frame: usize,
    ) -> Result<Vec<Vector3<f64>>, MotionError> {
        let mut turns: Vec<Rotation3<f64>> = Vec::with_capacity(skeleton.bones.len());
        let mut ends: Vec<Vector3<f64>> = Vec::with_capacity(skeleton.bones.len());
        for (bone, values) in skeleton.bones.iter().zip(&self.values) {
            let values = match values {
                Some(values) => values.as_slice(),
                None if bone.channels.is_empty() => &[],
                None => {
                    let problem = "is missing".to_owned();
                    return Err(file.frame(
                        frame,
                        &bone.name,
                        problem,
                        "download or export it again: it may be cut off",
                    ));
                }
            };
            let (moved, turned) = bone.pose(values);
            let (start, before) = match bone.parent {
                Some(parent) => (ends[parent], turns[parent]),
                None => (Vector3::zeros(), Rotation3::identity()),
            };
            let turn = before * turned;
            ends.push(start + turn * bone.vector + moved);
            turns.push(turn);
        }
        Ok(ends.into_iter().map(|end| end * skeleton.unit).collect())
    }
}

/// The ends of bones as the joints that they are: where a thigh ends there is the knee.
fn named(skeleton: &Skeleton, frames: Vec<Vec<Vector3<f64>>>) -> Joints {
    const ENDS: [(&str, &str); 7] = [
        ("hipjoint", "hip"),
        ("femur", "knee"),
        ("tibia", "ankle"),
        ("foot", "toe"),
        ("clavicle", "arm"),
        ("humerus", "elbow"),
        ("radius", "wrist"),
    ];
    // Other bones keep a name that is no joint's: a toe bone ends where no joint is.
    let name = |bone: &str| {
        ENDS.iter()
            .find_map(|(end, joint)| {
                bone.strip_suffix(end)
                    .filter(|side| matches!(*side, "l" | "r"))
                    .map(|side| format!("{side}{joint}"))
            })
            .unwrap_or_else(|| format!("end of {bone}"))
    };
    Joints {
        names: skeleton.bones.iter().map(|bone| name(&bone.name)).collect(),
        frames,
        ..Joints::default()
    }
}

#[cfg(test)]
#[path = "amc_tests.rs"]
pub(super) mod tests;

//! Motion from files, on the same footing as the built-in gait.
//!
//! Separate because files are not to be trusted: everything is checked before it is a [`Clip`]. The
//! way: `format.rs` tells the format, a file per format reads it, `rate.rs` decides on its frames per
//! second, and then either the robot's rows (`resample.rs`: `calibration.rs`, `lean.rs`, `bounds.rs`,
//! `ground.rs`) or a human's joints (`human.rs`, then the crate `retarget`) become 50 Hz. What was written
//! here before ([`crate::export`]) is taken as it is.

mod account;
mod amass;
mod amc;
mod amp_rsl_rl;
mod bounds;
mod bvh;
mod calibration;
mod csv;
mod file;
mod format;
mod frames;
mod ground;
mod human;
mod isaac;
mod joints;
mod lean;
mod leg;
mod mimickit;
mod order;
mod phc;
mod proto;
mod rate;
mod resample;
mod robot;
mod skeleton;
mod upright;

pub use account::{Imported, Jump, Options, Source};
pub use format::{Format, is_body_shape, is_text_of_frames};

use crate::clip::Clip;
use crate::config::QuaternionOrder;
use crate::error::MotionError;
use file::File;
use g1::JOINTS;
use human::Joints;
use nalgebra::{UnitQuaternion, Vector3};
use std::path::Path;

/// A row of a file: place and posture, no velocities yet.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Row {
    position: Vector3<f64>,
    orientation: UnitQuaternion<f64>,
    joints: [f64; JOINTS],
    /// Positions of [`joints::DROPPED`], rad; 0 where the file has no such joint.
    dropped: [f64; joints::DROPPED.len()],
}

/// What a format's reader gives.
#[derive(Debug)]
enum Motion {
    /// The G1; its quaternions are sure, or to be decided with this as usual order.
    Robot(Vec<Row>, Sure),
    /// The G1 as [`crate::export`] wrote it: nothing is left to do.
    Finished(Vec<Row>),
    Human(Joints),
}

/// Whether quaternions are in a known order.
#[derive(Debug)]
enum Sure {
    Yes,
    No { usual: Option<QuaternionOrder> },
}

/// Reads a file of motion in any known format; see [`import`].
///
/// # Errors
/// As [`import`].
pub fn load(path: &Path, options: &Options) -> Result<Clip, MotionError> {
    import(path, options).map(|imported| imported.clip)
}

/// Reads a file of motion in any known format and says what was done.
///
/// # Errors
/// A missing, too large or unreadable file, or the first thing in it that cannot be used, with file,
/// frame or line, field and remedy.
pub fn import(path: &Path, options: &Options) -> Result<Imported, MotionError> {
    let packed = file::read(path)?;
    let mut decisions = Vec::new();
    let unpacked = file::compressed::unpacked(&File {
        path,
        bytes: &packed,
    })?;
    let bytes = match unpacked {
        Some((bytes, how)) => {
            decisions.push(format!("unpacked, it was compressed with {how}"));
            bytes
        }
        None => packed,
    };
    let file = File {
        path,
        bytes: &bytes,
    };
    imported(&file, options, decisions).map_err(|error| {
        let misnamed = || options.format.is_none().then(|| format::misnamed(&file))?;
        file.foreign().or_else(misnamed).unwrap_or(error)
    })
}

fn imported(
    file: &File<'_>,
    options: &Options,
    mut decisions: Vec<String>,
) -> Result<Imported, MotionError> {
    let format = match options.format {
        Some(format) => format,
        None => {
            let (format, told) = format::detect(file)?;
            decisions.push(format!("{format}: {told}"));
            format
        }
    };
    let (motion, stated) = read(file, format, options, &mut decisions)?;
    let fps = rate::decide(file, options, stated, &mut decisions)?;
    let mut source = Source::default();
    let (frames, clip, retargeting) = match motion {
        Motion::Robot(rows, sure) => {
            let rows = oriented(file, rows, sure, fps, options, &mut decisions)?;
            let clip;
            (clip, source) = resample::clip(file, &rows, fps, options.ground, &mut decisions)?;
            (rows.len(), clip, None)
        }
        Motion::Finished(rows) => {
            resample::check_duration(file, rows.len(), fps)?;
            decisions.push("written by ampco: taken as it is".into());
            (rows.len(), resample::finished(file.path, &rows), None)
        }
        Motion::Human(joints) => {
            resample::check_duration(file, joints.frames.len(), fps)?;
            let capture = human::capture(file, &joints, fps, &mut decisions)?;
            let (postures, report) = retarget::retarget(&capture);
            let rows: Vec<Row> = postures.iter().map(row).collect();
            (
                joints.frames.len(),
                resample::finished(file.path, &rows),
                Some(report),
            )
        }
    };
    Ok(Imported {
        clip,
        format,
        frames,
        fps,
        decisions,
        retargeting,
        source,
    })
}

/// The motion of a file and its frames per second, if it says them.
fn read(
    file: &File<'_>,
    format: Format,
    options: &Options,
    decisions: &mut Vec<String>,
) -> Result<(Motion, Option<f64>), MotionError> {
    let human = |(joints, fps)| (Motion::Human(joints), fps);
    Ok(match format {
        Format::Amass | Format::Smplx => human(amass::read(file, decisions)?),
        Format::Bvh => {
            let (joints, fps) = bvh::read(file)?;
            (Motion::Human(joints), Some(fps))
        }
        Format::Amc => {
            let joints = amc::read(file, options.skeleton.as_deref(), decisions)?;
            // The format has no place for a rate: the user's word contradicts nothing.
            let usual = options.fps.is_none() && rate::in_name(file.path).is_none();
            if usual {
                decisions.push(format!(
                    "{} frames a second, as in the CMU collection",
                    amc::USUAL_FPS
                ));
            }
            (Motion::Human(joints), usual.then_some(amc::USUAL_FPS))
        }
        Format::Csv => {
            let mut table = csv::parse(file)?;
            let fps = table.fps(file, options, decisions)?;
            if table.unsure {
                let (rows, told) = order::of_rows(file, table.rows)?;
                decisions.push(told);
                table.rows = rows;
            }
            let motion = match (table.ours, table.named) {
                (true, _) if !options.force_fps => Motion::Finished(table.rows),
                (_, true) => Motion::Robot(table.rows, Sure::Yes),
                (_, false) => Motion::Robot(table.rows, Sure::No { usual: None }),
            };
            (motion, fps)
        }
        Format::BeyondMimic => {
            let (rows, fps) = robot::beyond_mimic(file, decisions)?;
            (Motion::Robot(rows, Sure::Yes), fps)
        }
        Format::IsaacLab => match isaac::lab(file, decisions)? {
            (isaac::Lab::Robot(rows), fps) => (Motion::Robot(rows, Sure::Yes), fps),
            (isaac::Lab::Humanoid(joints), fps) => (Motion::Human(joints), fps),
        },
        Format::IsaacGym => human(isaac::gym(file, decisions)?),
        Format::MimicKit => mimickit::read(file, decisions)?,
        Format::ProtoMotions => proto::read(file, decisions)?,
        Format::DeepMimic => frames::deepmimic(file, decisions)?,
        Format::TienKung => frames::tienkung(file, decisions)?,
        Format::AmpRslRl => {
            let (rows, fps) = amp_rsl_rl::read(file, decisions)?;
            let usual = Some(QuaternionOrder::Xyzw);
            (Motion::Robot(rows, Sure::No { usual }), fps)
        }
        Format::Phc => phc::read(file, options.format.is_some(), decisions)?,
        Format::Gmr => {
            let (rows, fps) = robot::gmr(file, options.format.is_some(), decisions)?;
            let usual = Some(QuaternionOrder::Xyzw);
            (Motion::Robot(rows, Sure::No { usual }), fps)
        }
    })
}

/// Rows with their quaternions in the right order.
fn oriented(
    file: &File<'_>,
    rows: Vec<Row>,
    sure: Sure,
    fps: f64,
    options: &Options,
    decisions: &mut Vec<String>,
) -> Result<Vec<Row>, MotionError> {
    let Sure::No { usual } = sure else {
        return Ok(rows);
    };
    let order = match options.quaternion {
        Some(order) => order,
        None => {
            let (order, told) = upright::decide(file, &rows, fps, usual)?;
            decisions.push(told);
            order
        }
    };
    Ok(match order {
        QuaternionOrder::Wxyz => rows,
        QuaternionOrder::Xyzw => upright::reread(&rows),
    })
}

fn row(posture: &retarget::Posture) -> Row {
    Row {
        position: posture.base.translation.vector,
        orientation: posture.base.rotation,
        joints: posture.joints,
        dropped: [0.0; joints::DROPPED.len()],
    }
}

#[cfg(test)]
#[path = "import/foreign_tests.rs"]
mod foreign_tests;
#[cfg(test)]
#[path = "import/import_tests.rs"]
mod tests;

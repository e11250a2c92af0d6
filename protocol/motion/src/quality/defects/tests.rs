//! Clips without defects, and each defect alone with its figures.

mod captures;
mod ground;
mod joints;
mod moves;
mod sound;
mod sources;
mod touch;
mod whole;

use super::super::severity;
use super::*;
use crate::gait::{self, Velocity};
use g1::joints::{LEFT_LEG, index_of};
use g1::{JOINT_TABLE, RobotState};
use nalgebra::{UnitQuaternion, Vector3};
use retarget::report::BoneOff;

fn of(clip: &Clip) -> Vec<Defect> {
    defects(clip, &Quality::of(clip), &Account::None)
}

/// The defect of a kind, alone or among those that follow from it.
fn found(clip: &Clip, kind: Kind) -> Defect {
    let all = of(clip);
    let found = all.iter().find(|defect| defect.kind == kind);
    found
        .unwrap_or_else(|| panic!("{kind:?} is not in {all:?}"))
        .clone()
}

fn kinds(clip: &Clip) -> Vec<Kind> {
    of(clip).iter().map(|defect| defect.kind).collect()
}

/// A robot that stands for so many frames, then changed frame by frame.
fn standing(frames: usize, change: impl Fn(usize, &mut RobotState)) -> Clip {
    let mut clip = Clip {
        name: "made up".into(),
        frames: vec![RobotState::standing(); frames],
        cyclic: false,
        ..gait::stand()
    };
    for (i, frame) in clip.frames.iter_mut().enumerate() {
        change(i, frame);
    }
    clip
}

fn walk(speed: f64, seconds: f64) -> Clip {
    gait::walk(speed).unwrap().unrolled(seconds)
}

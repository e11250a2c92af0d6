//! Biovision hierarchy (`.bvh`): a skeleton of offsets, then channels frame by frame.
//!
//! Separate as every format is. Channels may be in any order and positions on any joint: a channel
//! that is there replaces its part of the joint's offset (Bandai Namco's files have six on each).

mod words;

use super::file::File;
use super::human::Joints;
use crate::error::MotionError;
use nalgebra::{Rotation3, UnitQuaternion, Vector3};
use std::collections::BTreeMap;
use wording::count;
use words::Words;

/// A channel of a joint: an axis to move along or to turn about.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Channel {
    Position(usize),
    Rotation(usize),
}

#[derive(Debug)]
struct Joint {
    parent: Option<usize>,
    offset: Vector3<f64>,
    channels: Vec<Channel>,
}

/// Joint positions and frames per second.
pub(super) fn read(file: &File<'_>) -> Result<(Joints, f64), MotionError> {
    let text = file.text();
    let mut words = Words::new(file, &text);
    let mut names = Vec::new();
    let joints = hierarchy(&mut words, &mut names)?;
    words.expect("MOTION")?;
    words.expect("Frames:")?;
    let declared = words.number("the number of frames")?;
    words.expect("Frame")?;
    words.expect("Time:")?;
    let seconds = words.number("the frame time")?;
    if !(1e-4..=1.0).contains(&seconds) {
        let problem = format!("Frame Time is {seconds} s");
        return Err(words.error(
            problem,
            "write the seconds between frames, from 0.0001 to 1",
        ));
    }
    let channels: usize = joints.iter().map(|joint| joint.channels.len()).sum();
    let mut frames = Vec::new();
    let mut turns: BTreeMap<usize, Vec<UnitQuaternion<f32>>> =
        last(&joints).map(|joint| (joint, Vec::new())).collect();
    while words.more() {
        let pose = frame(&mut words, &joints, channels, frames.len())?;
        for (&joint, turns) in &mut turns {
            turns.push(UnitQuaternion::from_rotation_matrix(&pose.turns[joint]).cast());
        }
        frames.push(pose.places);
    }
    if frames.len() as f64 != declared {
        let problem = format!(
            "holds {} where Frames: says {declared}",
            count(frames.len(), "frame")
        );
        return Err(file.unusable(&problem, "download or export it again: it may be cut off"));
    }
    let parents = joints.iter().map(|joint| joint.parent).collect();
    let joints = Joints {
        names,
        frames,
        parents,
        turns,
    };
    Ok((joints, 1.0 / seconds))
}

/// Joints that turn and on which no other does: hands, head, and feet without toes.
fn last(joints: &[Joint]) -> impl Iterator<Item = usize> + '_ {
    let turns = |joint: &Joint| !joint.channels.is_empty();
    let parent = move |at: usize| {
        joints
            .iter()
            .any(|joint| joint.parent == Some(at) && turns(joint))
    };
    (0..joints.len()).filter(move |&at| turns(&joints[at]) && !parent(at))
}

/// Joints and end sites from the hierarchy; an end site is named after its joint, with "End".
fn hierarchy(words: &mut Words<'_>, names: &mut Vec<String>) -> Result<Vec<Joint>, MotionError> {
    let mut joints: Vec<Joint> = Vec::new();
    let mut open: Vec<usize> = Vec::new();
    words.expect("HIERARCHY")?;
    loop {
        let (_, word) = words.word("a joint")?;
        match word {
            "ROOT" | "JOINT" | "End" => {
                let name = words.name()?;
                let parent = open.last().copied();
                names.push(match (word, parent) {
                    ("End", Some(parent)) => format!("{}End", names[parent]),
                    _ => name,
                });
                words.expect("{")?;
                open.push(joints.len());
                joints.push(Joint {
                    parent,
                    offset: Vector3::zeros(),
                    channels: Vec::new(),
                });
            }
            "OFFSET" => {
                let offset = [
                    words.number("OFFSET")?,
                    words.number("OFFSET")?,
                    words.number("OFFSET")?,
                ];
                words.current(&mut joints, &open)?.offset = offset.into();
            }
            "CHANNELS" => {
                let count = words.number("CHANNELS")?;
                for _ in 0..count.clamp(0.0, 6.0) as usize {
                    let channel = words.channel()?;
                    words.current(&mut joints, &open)?.channels.push(channel);
                }
            }
            "}" => {
                open.pop();
                if open.is_empty() {
                    return Ok(joints);
                }
            }
            other => {
                let problem = format!("{other:?} in the hierarchy");
                let remedy = "expected JOINT, End Site, OFFSET, CHANNELS or }; export it again";
                return Err(words.error(problem, remedy));
            }
        }
    }
}

/// All joints in a frame.
struct Pose {
    places: Vec<Vector3<f64>>,
    turns: Vec<Rotation3<f64>>,
}

fn frame(
    words: &mut Words<'_>,
    joints: &[Joint],
    channels: usize,
    index: usize,
) -> Result<Pose, MotionError> {
    let line = words.line();
    let mut numbers = Vec::with_capacity(channels);
    for _ in 0..channels {
        numbers.push(words.frame_number(index, channels, numbers.len(), line)?);
    }
    let mut numbers = numbers.into_iter();
    let mut turns: Vec<Rotation3<f64>> = Vec::with_capacity(joints.len());
    let mut places: Vec<Vector3<f64>> = Vec::with_capacity(joints.len());
    for joint in joints {
        let (mut offset, mut turn) = (joint.offset, Rotation3::identity());
        for channel in &joint.channels {
            let number = numbers.next().expect("as many numbers as channels");
            match *channel {
                Channel::Position(axis) => offset[axis] = number,
                Channel::Rotation(axis) => {
                    let about = Vector3::ith(axis, number.to_radians());
                    turn *= Rotation3::from_scaled_axis(about);
                }
            }
        }
        let (place, before) = match joint.parent {
            Some(p) => (places[p] + turns[p] * offset, turns[p]),
            None => (offset, Rotation3::identity()),
        };
        places.push(place);
        turns.push(before * turn);
    }
    Ok(Pose { places, turns })
}

impl Words<'_> {
    fn channel(&mut self) -> Result<Channel, MotionError> {
        let (_, word) = self.word("a channel")?;
        let axis = match word.bytes().next() {
            Some(b'X' | b'x') => 0,
            Some(b'Y' | b'y') => 1,
            _ => 2,
        };
        match word.get(1..).map(str::to_ascii_lowercase).as_deref() {
            Some("position") => Ok(Channel::Position(axis)),
            Some("rotation") => Ok(Channel::Rotation(axis)),
            _ => Err(self.error(
                format!("channel {word:?}"),
                "expected Xposition … Zrotation",
            )),
        }
    }

    fn current<'j>(
        &mut self,
        joints: &'j mut [Joint],
        open: &[usize],
    ) -> Result<&'j mut Joint, MotionError> {
        match open.last() {
            Some(&i) => Ok(&mut joints[i]),
            None => Err(self.error("numbers outside a joint".into(), "export it again as BVH")),
        }
    }
}

#[cfg(test)]
#[path = "bvh_tests.rs"]
pub(super) mod tests;

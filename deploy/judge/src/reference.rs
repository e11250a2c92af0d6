//! The reference motion as a measure: where to begin, and how often a human steps at a speed.

use g1::RobotState;
use motion::{Clip, Dataset};
use serde::Serialize;
use sim::Starts;

/// Left and right hip pitch among the joints.
const LEFT_HIP: usize = 0;
const RIGHT_HIP: usize = 6;

/// Commands this close together (m/s, rad/s) are one: mirror images differ by rounding.
const SAME: f32 = 0.02;

/// How much farther a clip that goes round may be, m/s, and still be taken instead of one that does not.
const NEIGHBOUR: f32 = 0.15;

/// The clips of a run.
pub(super) struct Reference {
    clips: Vec<Clip>,
}

/// What the clip nearest to a command does.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(super) struct Nearest {
    pub(super) clip: String,
    pub(super) command: [f32; 3],
    pub(super) stride_rate_hz: f64,
}

impl Reference {
    pub(super) fn of(dataset: &Dataset) -> Self {
        Self {
            clips: dataset.clips().to_vec(),
        }
    }

    /// Frames of the clips that go nearest to `command`, mirrored ones included.
    pub(super) fn starts(&self, command: [f32; 3]) -> Starts {
        self.around(command)
            .flat_map(|clip| {
                let weight = clip.weight / clip.frames.len() as f32;
                clip.frames
                    .iter()
                    .map(move |frame| (*frame, clip.command, weight))
            })
            .collect()
    }

    /// The clip that goes nearest to `command`.
    pub(super) fn nearest(&self, command: [f32; 3]) -> Option<Nearest> {
        let clip = self.around(command).next()?;
        Some(Nearest {
            clip: clip.name.clone(),
            command: clip.command,
            stride_rate_hz: stride_rate(&clip.frames, clip.cyclic, clip.seconds()),
        })
    }

    /// The clips that go as `command` asks, as nearly as there are any.
    ///
    /// Those that go round come first: a clip of setting off has its velocity only at its end.
    fn around(&self, command: [f32; 3]) -> impl Iterator<Item = &Clip> {
        let least = |clips: &mut dyn Iterator<Item = &Clip>| {
            clips
                .map(|clip| gap(clip, command))
                .fold(f32::INFINITY, f32::min)
        };
        let of_all = least(&mut self.clips.iter());
        let going_round = least(&mut self.clips.iter().filter(|clip| clip.cyclic));
        let steady = going_round <= of_all + NEIGHBOUR;
        let nearest = if steady { going_round } else { of_all };
        self.clips
            .iter()
            .filter(move |clip| gap(clip, command) <= nearest + SAME && (clip.cyclic || !steady))
    }
}

fn gap(clip: &Clip, command: [f32; 3]) -> f32 {
    let squares = (0..3).map(|i| (clip.command[i] - command[i]).powi(2));
    squares.sum::<f32>().sqrt()
}

/// How often the left leg overtakes the right in a second.
fn stride_rate(frames: &[RobotState], cyclic: bool, seconds: f64) -> f64 {
    let ahead =
        |state: &RobotState| state.joint_positions[RIGHT_HIP] > state.joint_positions[LEFT_HIP];
    let pairs = frames.iter().zip(frames.iter().skip(1));
    let wrap = frames.last().zip(frames.first()).filter(|_| cyclic);
    let overtakings = pairs
        .chain(wrap)
        .filter(|(before, after)| !ahead(before) && ahead(after))
        .count();
    overtakings as f64 / seconds
}

#[cfg(test)]
mod tests {
    use super::*;
    use motion::{MotionConfig, gait};
    use std::path::Path;

    #[test]
    fn frames_are_those_of_the_nearest_clips() {
        let dataset = Dataset::load(&MotionConfig::default(), Path::new(".")).unwrap();
        let reference = Reference::of(&dataset);
        // Clips at 0.4, 0.6, 0.8, 0.98 and 1.2 m/s, each with its mirror image.
        for (command, speed) in [(0.5, 0.4..0.61), (2.0, 1.2..1.21), (-0.5, 0.4..0.41)] {
            let starts = reference.starts([command, 0.0, 0.0]);
            assert!(!starts.states.is_empty());
            let fits = |c: &[f32; 3]| speed.contains(&c[0]) || (c[0] - speed.start).abs() < SAME;
            assert!(starts.commands.iter().all(fits), "{command}");
            starts.validate().unwrap();
        }
        let nearest = reference.nearest([1.0, 0.0, 0.0]).unwrap();
        assert!((nearest.command[0] - 0.98).abs() < 1e-3);
    }

    #[test]
    fn a_walk_comes_before_a_start_to_the_same_speed() {
        let config: MotionConfig = toml::from_str(
            "clips = [{ gait = \"walk\", speed = 0.6 }, { gait = \"start\", speed = 0.5 }, \
             { gait = \"start\", speed = 1.2 }]",
        )
        .unwrap();
        let reference = Reference::of(&Dataset::load(&config, Path::new(".")).unwrap());
        let speed = |command: f32| reference.nearest([command, 0.0, 0.0]).unwrap().command[0];
        assert!((speed(0.5) - 0.6).abs() < 1e-3);
        assert!((speed(1.2) - 1.2).abs() < 1e-3); // no walk is anywhere near
    }

    #[test]
    fn a_stride_is_counted_once_also_over_the_end_of_a_cycle() {
        let walk = gait::walk(1.0).unwrap();
        let rate = stride_rate(&walk.frames, walk.cyclic, walk.seconds());
        // A generated cycle is one stride.
        assert!((rate - 1.0 / walk.seconds()).abs() < 1e-9, "{rate}");
        let stand = gait::stand();
        assert_eq!(
            stride_rate(&stand.frames, stand.cyclic, stand.seconds()),
            0.0
        );
    }
}

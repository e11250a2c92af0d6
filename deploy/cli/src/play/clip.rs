//! A reference motion as it is: no physics, no policy.

use std::path::{Path, PathBuf};

use anyhow::{Context, Result};
use motion::{Clip, ClipConfig, Dataset, FRAME_SECONDS, Gait, MotionConfig};
use playback::{Frame, Recording};

/// Which motion.
#[derive(Debug, PartialEq)]
pub(super) enum Source {
    Gait(Gait, f64),
    File(PathBuf),
}

impl Source {
    /// A built-in gait (`walk:0.8`) or a file that is there; anything else is no clip.
    pub(super) fn parse(text: &str) -> Option<Self> {
        let gait = |text: &str| {
            let (name, speed) = text.split_once(':')?;
            let gait = match name {
                "stand" => Gait::Stand,
                "walk" => Gait::Walk,
                "run" => Gait::Run,
                _ => return None,
            };
            Some(Self::Gait(gait, speed.parse().ok()?))
        };
        gait(text).or_else(|| {
            let path = Path::new(text);
            path.is_file().then(|| Self::File(path.to_owned()))
        })
    }

    fn config(&self, fps: Option<f64>) -> ClipConfig {
        match self {
            Self::Gait(gait, speed) => ClipConfig {
                gait: Some(*gait),
                speed: (*gait != Gait::Stand).then_some(*speed),
                ..ClipConfig::default()
            },
            Self::File(path) => ClipConfig {
                file: Some(path.clone()),
                fps,
                ..ClipConfig::default()
            },
        }
    }
}

/// The motion, a cyclic one repeated for `seconds`.
pub(super) fn record(source: &Source, fps: Option<f64>, seconds: f64) -> Result<Recording> {
    let config = MotionConfig {
        clips: vec![source.config(fps)],
        mirror: false,
        ..MotionConfig::default()
    };
    let dataset = Dataset::load(&config, Path::new("")).context("loading the motion")?;
    let clip = dataset.clips().first().expect("one clip was asked for");
    Ok(Recording {
        title: clip.name.clone(),
        source: "reference motion".to_owned(),
        frame_seconds: FRAME_SECONDS,
        fell_at: None,
        frames: frames(clip, (seconds / FRAME_SECONDS).round() as usize + 1),
    })
}

/// Frames of a clip; a cyclic one goes on from where its last frame led.
fn frames(clip: &Clip, count: usize) -> Vec<Frame> {
    let frame = |state: &g1::RobotState| Frame::of(state, clip.command);
    if !clip.cyclic {
        return clip.frames.iter().map(frame).collect();
    }
    let (first, last) = (&clip.frames[0], clip.frames.last().expect("not empty"));
    let mut progress = last.position - first.position + last.linear_velocity * FRAME_SECONDS as f32;
    progress.z = 0.0;
    (0..count)
        .map(|i| {
            let (round, at) = (i / clip.frames.len(), i % clip.frames.len());
            let mut state = clip.frames[at];
            state.position += progress * round as f32;
            frame(&state)
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gaits_and_files_are_told_from_runs() {
        assert_eq!(
            Source::parse("walk:0.8"),
            Some(Source::Gait(Gait::Walk, 0.8))
        );
        assert_eq!(Source::parse("walk"), None); // a run may be called so
        assert_eq!(Source::parse("hop:1"), None);
        let file = tempfile::NamedTempFile::new().unwrap();
        let path = file.path();
        assert_eq!(
            Source::parse(path.to_str().unwrap()),
            Some(Source::File(path.to_owned()))
        );
    }

    #[test]
    fn a_cycle_goes_on_without_a_jump() {
        let recording = record(&Source::Gait(Gait::Walk, 0.8), None, 6.0).unwrap();
        assert_eq!(recording.frames.len(), 301);
        let steps = recording.frames.windows(2);
        for pair in steps {
            let forward = pair[1].position[0] - pair[0].position[0];
            // 0.8 m/s are 16 mm a frame; the pelvis swings a little around that.
            assert!((0.010..0.022).contains(&forward), "{forward} m");
        }
        let walked = recording.frames[300].position[0] - recording.frames[0].position[0];
        assert!((walked - 4.8).abs() < 0.1, "{walked} m in 6 s");
    }
}

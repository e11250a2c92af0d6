//! All reference motion of a run, ready to be sampled.
//!
//! Separate because the discriminator draws thousands of transitions per iteration: they lie here as
//! features already, and drawing one costs a search among clips and a copy.

use crate::clip::Clip;
use crate::config::{ClipConfig, Gait, MotionConfig, wrong};
use crate::error::MotionError;
use crate::strata::Strata;
use crate::{gait, import};
use g1::observation::{ANGULAR_VELOCITY, LINEAR_VELOCITY, features};
use g1::{FEATURES, RobotState};
use rand::{Rng, RngExt};
use std::fmt::Write;
use std::path::{Path, PathBuf};

/// Which features are velocity forward and aside, m/s, and yaw rate, rad/s.
const VELOCITY: [usize; 3] = [
    LINEAR_VELOCITY.start,
    LINEAR_VELOCITY.start + 1,
    ANGULAR_VELOCITY.end - 1,
];

/// Clips with what is needed to draw from them.
///
/// A clip is drawn in proportion to its weight, whatever its length; then any of its frames alike.
#[derive(Clone, Debug)]
pub struct Dataset {
    clips: Vec<Clip>,
    /// Running sum of the clips' weights.
    cumulative_weights: Vec<f32>,
    /// Features of all frames of all clips, and where each clip's begin (in frames).
    features: Vec<f32>,
    starts: Vec<usize>,
    /// Shares of transitions, if every speed counts alike.
    strata: Option<Strata>,
}

impl Dataset {
    /// Makes or reads the clips of a configuration; relative paths start at `base_dir`.
    ///
    /// # Errors
    /// A field out of range, a file that cannot be read or used: the message names the place and
    /// the remedy.
    pub fn load(config: &MotionConfig, base_dir: &Path) -> Result<Self, MotionError> {
        config.validate()?;
        let mut clips = Vec::new();
        for (index, source) in config.clips.iter().enumerate() {
            for mut clip in load_clips(source, index, base_dir)? {
                if config.mirror {
                    clip.weight /= 2.0;
                    clips.push(clip.mirrored());
                }
                clips.push(clip);
            }
        }
        let data = Self::of(clips);
        Ok(if config.stratify {
            data.stratified()
        } else {
            data
        })
    }

    /// The same clips, drawn so that every speed has the same share.
    pub fn stratified(self) -> Self {
        Self {
            strata: Some(Strata::of(&self.clips)),
            ..self
        }
    }

    /// A dataset of clips already at hand.
    ///
    /// # Panics
    /// If there is no clip, one without a transition, or one whose weight is not above zero.
    pub fn of(clips: Vec<Clip>) -> Self {
        assert!(!clips.is_empty(), "a dataset has a clip");
        let mut data = Self {
            cumulative_weights: Vec::with_capacity(clips.len()),
            features: Vec::new(),
            starts: Vec::with_capacity(clips.len()),
            strata: None,
            clips,
        };
        let (mut weight, mut frames) = (0.0, 0);
        for clip in &data.clips {
            assert!(clip.transitions() > 0, "{} has a transition", clip.name);
            assert!(clip.weight > 0.0, "{} has a weight", clip.name);
            weight += clip.weight;
            data.cumulative_weights.push(weight);
            data.starts.push(frames);
            frames += clip.frames.len();
        }
        data.features.resize(frames * FEATURES, 0.0);
        let states = data.clips.iter().flat_map(|clip| &clip.frames);
        for (row, state) in data.features.chunks_exact_mut(FEATURES).zip(states) {
            features(state, row);
        }
        data
    }

    /// The clips, mirrored ones included.
    pub fn clips(&self) -> &[Clip] {
        &self.clips
    }

    /// Pairs of successive frames in all clips.
    pub fn transitions(&self) -> usize {
        self.clips.iter().map(Clip::transitions).sum()
    }

    /// Every frame with its clip's command and its chance of being drawn, relative to the others.
    pub fn frames(&self) -> impl Iterator<Item = (&RobotState, [f32; 3], f32)> {
        self.clips
            .iter()
            .enumerate()
            .flat_map(move |(index, clip)| {
                let even = clip.weight / clip.frames.len() as f32;
                clip.frames.iter().enumerate().map(move |(i, f)| {
                    let strata = self.strata.as_ref();
                    (
                        f,
                        clip.command,
                        strata.map_or(even, |strata| strata.share(index, i)),
                    )
                })
            })
    }

    /// Draws a window of motion: the features of successive steps, oldest first, 53 numbers each; every
    /// transition is equally often its end. In a cyclic clip the first frame follows the last; before
    /// the first frame of another clip there is nothing but that frame. Allocates nothing.
    ///
    /// Gives the command that such motion obeys: in a cyclic clip the clip's own; in another, which sets off, stops or
    /// wanders, the window's mean velocity.
    ///
    /// # Panics
    /// If `out` is not as long as two steps or more.
    pub fn sample_window(&self, rng: &mut impl Rng, out: &mut [f32]) -> [f32; 3] {
        let steps = out.len() / FEATURES;
        assert!(
            steps >= 2 && out.len().is_multiple_of(FEATURES),
            "a window has 53 numbers for each of two steps or more"
        );
        let (index, i) = match &self.strata {
            Some(strata) => strata.draw(rng),
            None => {
                let index = self.sample_clip(rng);
                (index, rng.random_range(0..self.clips[index].transitions()))
            }
        };
        let clip = &self.clips[index];
        let length = clip.frames.len();
        for (place, state) in out.chunks_exact_mut(FEATURES).enumerate() {
            // Steps from the window's last but one, which is frame i.
            let ahead = place as isize - (steps as isize - 2);
            let frame = i as isize + ahead;
            let frame = if clip.cyclic {
                frame.rem_euclid(length as isize)
            } else {
                frame.max(0)
            };
            let at = (self.starts[index] + frame as usize) * FEATURES;
            state.copy_from_slice(&self.features[at..at + FEATURES]);
        }
        if clip.cyclic {
            return clip.command;
        }
        VELOCITY.map(|feature| {
            let sum: f32 = out.iter().skip(feature).step_by(FEATURES).sum();
            sum / steps as f32
        })
    }

    /// Draws a frame with its clip's command, to start an episode from.
    pub fn sample_frame(&self, rng: &mut impl Rng) -> (&RobotState, [f32; 3]) {
        let (index, i) = match &self.strata {
            Some(strata) => strata.draw(rng),
            None => {
                let index = self.sample_clip(rng);
                (index, rng.random_range(0..self.clips[index].frames.len()))
            }
        };
        let clip = &self.clips[index];
        (&clip.frames[i], clip.command)
    }

    /// A line per clip for logs: name, seconds, speed, share.
    pub fn describe(&self) -> String {
        let total = self.total_weight();
        let mut text = String::new();
        for clip in &self.clips {
            let share = 100.0 * clip.weight / total;
            let (seconds, speed) = (clip.seconds(), clip.speed());
            // Writing to a String cannot fail.
            let _ = writeln!(
                text,
                "{}: {seconds:.2} s at {speed:.2} m/s, {share:.1} %",
                clip.name
            );
        }
        text
    }

    fn sample_clip(&self, rng: &mut impl Rng) -> usize {
        let drawn = rng.random::<f32>() * self.total_weight();
        let index = self.cumulative_weights.partition_point(|&sum| sum <= drawn);
        index.min(self.clips.len() - 1) // rounding may draw the total itself
    }

    fn total_weight(&self) -> f32 {
        self.cumulative_weights[self.clips.len() - 1]
    }
}

/// The clips of a source; those of a folder share its weight by their duration.
fn load_clips(
    source: &ClipConfig,
    index: usize,
    base_dir: &Path,
) -> Result<Vec<Clip>, MotionError> {
    let options = import::Options {
        fps: source.fps,
        quaternion: source.quaternion,
        ground: source.ground.unwrap_or(true),
        ..import::Options::default()
    };
    let mut clips = match (source.gait, &source.file, &source.folder) {
        (Some(gait), ..) => {
            let velocity = source.velocity();
            let made = match gait {
                Gait::Stand => Some(gait::stand()),
                Gait::Walk => gait::walk(velocity),
                Gait::Run => gait::run(velocity),
                Gait::Start => gait::start(velocity),
                Gait::Stop => gait::stop(velocity),
            };
            let impossible =
                "no pose of the legs makes this gait; lower lateral, yaw_rate or speed";
            vec![made.ok_or_else(|| wrong(format!("clips[{index}]"), velocity, impossible))?]
        }
        (None, Some(file), _) => vec![import::load(&base_dir.join(file), &options)?],
        (None, None, Some(folder)) => tables(&base_dir.join(folder))?
            .iter()
            .map(|path| import::load(path, &options))
            .collect::<Result<_, _>>()?,
        (None, None, None) => {
            return Err(wrong(
                format!("clips[{index}]"),
                "{}",
                "give gait, file or folder",
            ));
        }
    };
    let seconds: f64 = clips.iter().map(Clip::seconds).sum();
    for clip in &mut clips {
        clip.weight = source.weight * (clip.seconds() / seconds) as f32;
    }
    Ok(clips)
}

/// The tables in a folder, sorted by name: the order must not depend on the file system.
fn tables(folder: &Path) -> Result<Vec<PathBuf>, MotionError> {
    let read = |source| MotionError::Read {
        path: folder.into(),
        source,
    };
    let mut paths = Vec::new();
    for entry in std::fs::read_dir(folder).map_err(read)? {
        let path = entry.map_err(read)?.path();
        if path.extension().is_some_and(|extension| extension == "csv") {
            paths.push(path);
        }
    }
    if paths.is_empty() {
        return Err(MotionError::File {
            path: folder.into(),
            problem: "holds no .csv file".into(),
            remedy: "fill it with ampco motions import FILE… --out FOLDER".into(),
        });
    }
    paths.sort();
    Ok(paths)
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng;
    use rand_pcg::Pcg64Mcg;

    /// A clip whose frames are told apart by height: `base`, `base` + 1, …
    fn numbered(base: f32, frames: usize, cyclic: bool, weight: f32) -> Clip {
        let frame = |i: usize| {
            let mut state = RobotState::standing();
            state.position.z = base + i as f32;
            state
        };
        Clip {
            name: format!("from {base}"),
            frames: (0..frames).map(frame).collect(),
            cyclic,
            command: [base, 0.0, 0.0],
            weight,
        }
    }

    #[test]
    fn a_window_tells_the_command_that_it_obeys() {
        let mut rng = Pcg64Mcg::seed_from_u64(3);
        let mut window = [0.0; 2 * FEATURES];
        let walk = Dataset::of(vec![gait::walk(0.8).expect("a gait")]);
        let asked = walk.clips()[0].command;
        assert_eq!(walk.sample_window(&mut rng, &mut window), asked);
        // Who sets off is not there yet: its speed as of now, between none and the last.
        let start = Dataset::of(vec![gait::start(0.8).expect("a gait")]);
        let speeds: Vec<f32> = (0..300)
            .map(|_| {
                let [forward, ..] = start.sample_window(&mut rng, &mut window);
                assert!((forward - (window[1] + window[FEATURES + 1]) / 2.0).abs() < 1e-6);
                forward
            })
            .collect();
        assert!(speeds.iter().any(|speed| *speed < 0.2) && speeds.iter().any(|speed| *speed > 0.6));
    }

    #[test]
    fn transitions_join_successive_frames_and_wrap_only_in_cycles() {
        let data = Dataset::of(vec![
            numbered(0.0, 3, true, 1.0),
            numbered(10.0, 3, false, 1.0),
        ]);
        assert_eq!(data.transitions(), 3 + 2);
        let mut rng = Pcg64Mcg::seed_from_u64(7);
        let (mut out, mut seen) = ([0.0; 2 * FEATURES], Vec::new());
        for _ in 0..200 {
            data.sample_window(&mut rng, &mut out);
            seen.push((out[0] as i32, out[FEATURES] as i32));
        }
        seen.sort_unstable();
        seen.dedup();
        assert_eq!(seen, [(0, 1), (1, 2), (2, 0), (10, 11), (11, 12)]);

        // Four steps: back beyond the beginning, where only a cycle goes on.
        let (mut out, mut seen) = ([0.0; 4 * FEATURES], Vec::new());
        for _ in 0..200 {
            data.sample_window(&mut rng, &mut out);
            seen.push([0, 1, 2, 3].map(|step| out[step * FEATURES] as i32));
        }
        seen.sort_unstable();
        seen.dedup();
        let expected = [
            [0, 1, 2, 0],
            [1, 2, 0, 1],
            [2, 0, 1, 2],
            [10, 10, 10, 11],
            [10, 10, 11, 12],
        ];
        assert_eq!(seen, expected);
    }

    #[test]
    fn clips_are_drawn_by_weight_not_by_length() {
        let data = Dataset::of(vec![
            numbered(0.0, 300, true, 1.0),
            numbered(1000.0, 3, true, 3.0),
        ]);
        let mut rng = Pcg64Mcg::seed_from_u64(1);
        let drawn = (0..4000)
            .filter(|_| data.sample_frame(&mut rng).1[0] == 1000.0)
            .count();
        assert!((2900..3100).contains(&drawn), "{drawn}"); // 3/4 of 4000, σ = 27
        let share: f32 = data
            .frames()
            .filter(|f| f.1[0] == 1000.0)
            .map(|f| f.2)
            .sum();
        assert!((share - 3.0).abs() < 1e-5);
    }

    #[test]
    fn the_default_walks_at_five_speeds_and_their_mirror_images() {
        let data = Dataset::load(&MotionConfig::default(), Path::new("/nowhere")).unwrap();
        assert_eq!(data.clips().len(), 10);
        let total: f32 = data.clips().iter().map(|c| c.weight).sum();
        assert!((total - 7.0).abs() < 1e-5); // 1 + 1 + 1 + 3 + 1, halved and doubled
        let speeds: Vec<f32> = data.clips().iter().step_by(2).map(Clip::speed).collect();
        assert_eq!(speeds, [0.4, 0.6, 0.8, 0.98, 1.2]);
        let text = data.describe();
        assert!(
            text.contains("walk 0.98 m/s mirrored: ") && text.contains("21.4 %"),
            "{text}"
        );
    }

    #[test]
    fn a_cyclic_clip_wraps_without_a_jump() {
        let walk = gait::walk(0.8).unwrap();
        let n = walk.frames.len();
        let largest = |i: usize| {
            let (mut a, mut b) = ([0.0; FEATURES], [0.0; FEATURES]);
            features(&walk.frames[i], &mut a);
            features(&walk.frames[(i + 1) % n], &mut b);
            (7..30).map(|j| (a[j] - b[j]).abs()).fold(0.0, f32::max)
        };
        let usual = (0..n - 1).map(largest).fold(0.0, f32::max);
        assert!(largest(n - 1) <= usual, "{} after {usual}", largest(n - 1));
    }

    #[test]
    fn a_folder_shares_its_weight_by_duration() {
        let folder = tempfile::tempdir().unwrap();
        let config = |text: &str| toml::from_str::<MotionConfig>(text).unwrap();
        let named = config("mirror = false\nclips = [{ folder = \"set\", weight = 2.0 }]");
        assert!(Dataset::load(&named, folder.path()).is_err()); // not there
        let set = folder.path().join("set");
        std::fs::create_dir(&set).unwrap();
        let message = Dataset::load(&named, folder.path())
            .unwrap_err()
            .to_string();
        assert!(
            message.contains("no .csv") && message.contains("motions import"),
            "{message}"
        );
        let mut walk = gait::walk(1.0).unwrap();
        std::fs::write(set.join("b.csv"), crate::export::to_csv(&walk, &[])).unwrap();
        let whole = walk.frames.len();
        walk.frames.truncate(whole / 2);
        std::fs::write(set.join("a.csv"), crate::export::to_csv(&walk, &[])).unwrap();
        std::fs::write(set.join("notes.json"), "{}").unwrap();
        let data = Dataset::load(&named, folder.path()).unwrap();
        let names: Vec<&str> = data.clips().iter().map(|c| c.name.as_str()).collect();
        assert_eq!(names, ["a", "b"]);
        let weights: Vec<f32> = data.clips().iter().map(|c| c.weight).collect();
        assert!((weights[0] + weights[1] - 2.0).abs() < 1e-6);
        let shares = (whole / 2 - 1) as f32 / (whole - 1) as f32;
        assert!((weights[0] / weights[1] - shares).abs() < 1e-4);
    }

    #[test]
    fn the_same_seed_draws_the_same() {
        let data = Dataset::of(vec![gait::stand(), gait::walk(1.0).unwrap()]);
        let draw = || {
            let mut rng = Pcg64Mcg::seed_from_u64(3);
            let mut out = [0.0; 2 * FEATURES];
            (0..10)
                .map(|_| {
                    data.sample_window(&mut rng, &mut out);
                    out
                })
                .collect::<Vec<_>>()
        };
        assert_eq!(draw(), draw());
    }
}

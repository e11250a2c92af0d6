//! All reference motion of a run, ready to be sampled.
//!
//! Separate because the discriminator draws thousands of transitions per iteration: they lie here as
//! features already, and drawing one costs a search among clips and a copy.

use crate::clip::Clip;
use crate::config::{ClipConfig, Gait, MotionConfig, wrong};
use crate::error::MotionError;
use crate::{gait, import};
use g1::observation::features;
use g1::{FEATURES, RobotState};
use rand::{Rng, RngExt};
use std::fmt::Write;
use std::path::Path;

/// Numbers in a transition: the features of two successive steps.
pub const TRANSITION: usize = 2 * FEATURES;

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
            let mut clip = load_clip(source, index, base_dir)?;
            if config.mirror {
                clip.weight /= 2.0;
                clips.push(clip.mirrored());
            }
            clips.push(clip);
        }
        Ok(Self::of(clips))
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
        self.clips.iter().flat_map(|clip| {
            let weight = clip.weight / clip.frames.len() as f32;
            clip.frames.iter().map(move |f| (f, clip.command, weight))
        })
    }

    /// Draws a transition: the features of a step and of the next, 53 and 53 numbers. In a cyclic
    /// clip the first frame follows the last. Allocates nothing.
    ///
    /// # Panics
    /// If `out` is not 106 long.
    pub fn sample_transition(&self, rng: &mut impl Rng, out: &mut [f32]) {
        assert_eq!(out.len(), TRANSITION, "a transition has 106 numbers");
        let index = self.sample_clip(rng);
        let clip = &self.clips[index];
        let i = rng.random_range(0..clip.transitions());
        let next = (i + 1) % clip.frames.len();
        let row = |i: usize| {
            let at = (self.starts[index] + i) * FEATURES;
            &self.features[at..at + FEATURES]
        };
        out[..FEATURES].copy_from_slice(row(i));
        out[FEATURES..].copy_from_slice(row(next));
    }

    /// Draws a frame with its clip's command, to start an episode from.
    pub fn sample_frame(&self, rng: &mut impl Rng) -> (&RobotState, [f32; 3]) {
        let clip = &self.clips[self.sample_clip(rng)];
        let i = rng.random_range(0..clip.frames.len());
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

fn load_clip(source: &ClipConfig, index: usize, base_dir: &Path) -> Result<Clip, MotionError> {
    let clip = match (source.gait, &source.file) {
        (Some(gait), _) => {
            let speed = source.speed.unwrap_or(0.0);
            let made = match gait {
                Gait::Stand => Some(gait::stand()),
                Gait::Walk => gait::walk(speed),
                Gait::Run => gait::run(speed),
            };
            let impossible = "no pose of the legs makes this gait; choose another speed";
            made.ok_or_else(|| wrong(format!("clips[{index}].speed"), speed, impossible))?
        }
        (None, Some(file)) => {
            let options = import::Options {
                fps: source.fps.unwrap_or(50.0),
                quaternion: source.quaternion.unwrap_or_default(),
                ground: source.ground.unwrap_or(true),
            };
            import::load(&base_dir.join(file), &options)?
        }
        (None, None) => return Err(wrong(format!("clips[{index}]"), "{}", "give gait or file")),
    };
    Ok(Clip {
        weight: source.weight,
        ..clip
    })
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
    fn transitions_join_successive_frames_and_wrap_only_in_cycles() {
        let data = Dataset::of(vec![
            numbered(0.0, 3, true, 1.0),
            numbered(10.0, 3, false, 1.0),
        ]);
        assert_eq!(data.transitions(), 3 + 2);
        let mut rng = Pcg64Mcg::seed_from_u64(7);
        let (mut out, mut seen) = ([0.0; TRANSITION], Vec::new());
        for _ in 0..200 {
            data.sample_transition(&mut rng, &mut out);
            seen.push((out[0] as i32, out[FEATURES] as i32));
        }
        seen.sort_unstable();
        seen.dedup();
        assert_eq!(seen, [(0, 1), (1, 2), (2, 0), (10, 11), (11, 12)]);
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
    fn the_same_seed_draws_the_same() {
        let data = Dataset::of(vec![gait::stand(), gait::walk(1.0).unwrap()]);
        let draw = || {
            let mut rng = Pcg64Mcg::seed_from_u64(3);
            let mut out = [0.0; TRANSITION];
            (0..10)
                .map(|_| {
                    data.sample_transition(&mut rng, &mut out);
                    out
                })
                .collect::<Vec<_>>()
        };
        assert_eq!(draw(), draw());
    }
}

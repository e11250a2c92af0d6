//! All reference motion of a run, ready to be sampled.
//!
//! Separate because the discriminator draws thousands of transitions per iteration: they lie here as
//! features already, and drawing one costs a search among clips and a copy.

mod source;

pub use source::Reference;

use crate::clip::Clip;
use crate::config::{Draw, MotionConfig};
use crate::error::MotionError;
use crate::strata::Strata;
use g1::RobotState;
use observation::{Scene, Table, Tables};
use rand::{Rng, RngExt};
use std::fmt::Write;
use std::path::{Path, PathBuf};
use vocabulary::Section;

/// Clips with what is needed to draw from them.
///
/// A clip is drawn in proportion to its weight, whatever its length; then any of its frames alike.
#[derive(Clone, Debug)]
pub struct Dataset {
    clips: Vec<Clip>,
    /// Running sum of the clips' weights.
    cumulative_weights: Vec<f32>,
    /// What is seen of all frames of all clips, a row each, and where each clip's begin (in frames).
    features: Vec<f32>,
    /// Numbers of a row.
    width: usize,
    /// Velocity forward and aside, m/s, and yaw rate, rad/s, of all frames.
    velocities: Vec<[f32; 3]>,
    starts: Vec<usize>,
    /// Shares of transitions, if every speed counts alike.
    strata: Option<Strata>,
    by_commands: bool,
}

/// How far apart two commands are that motion of one passes for motion of the other: m/s forward, m/s aside, rad/s. About as
/// far as the commands of neighbouring built-in gaits in the presets.
const NEAR: [f32; 3] = [0.15, 0.1, 0.25];

impl Dataset {
    /// Makes or reads the clips of a configuration; relative paths start at `base_dir`.
    ///
    /// # Errors
    /// A field out of range, a file that cannot be read or used: the message names the place and
    /// the remedy.
    pub fn load(config: &MotionConfig, base_dir: &Path) -> Result<Self, MotionError> {
        let mut clips = Vec::new();
        for Reference { mut clip, .. } in Self::read(config, base_dir)? {
            if config.mirror {
                clip.weight /= 2.0;
                clips.push(clip.mirrored());
            }
            clips.push(clip);
        }
        let data = Self::of(clips);
        Ok(match config.draw {
            Draw::Weights => data,
            Draw::Speeds => data.stratified(),
            Draw::Commands => Self {
                by_commands: true,
                ..data
            },
        })
    }

    /// The files that [`Dataset::load`] reads, each once, in the order of the clips; none of built-in gaits.
    ///
    /// # Errors
    /// A folder that cannot be read or holds nothing. Whether a file is there and can be used is not looked at.
    pub fn files(config: &MotionConfig, base_dir: &Path) -> Result<Vec<PathBuf>, MotionError> {
        let mut files: Vec<PathBuf> = Vec::new();
        for source in &config.clips {
            for file in source::files(source, base_dir)? {
                if !files.contains(&file) {
                    files.push(file);
                }
            }
        }
        Ok(files)
    }

    /// The clips of a configuration as they come, not mirrored, with what is known of them; else as [`Self::load`].
    ///
    /// # Errors
    /// As [`Self::load`].
    pub fn read(config: &MotionConfig, base_dir: &Path) -> Result<Vec<Reference>, MotionError> {
        config.validate().map_err(MotionError::Config)?;
        let mut clips = Vec::new();
        for (index, source) in config.clips.iter().enumerate() {
            clips.extend(source::load_clips(source, index, base_dir)?);
        }
        Ok(clips)
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
            width: 0,
            velocities: Vec::new(),
            starts: Vec::with_capacity(clips.len()),
            strata: None,
            by_commands: false,
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
        let states = data.clips.iter().flat_map(|clip| &clip.frames);
        let velocities = states.map(|state| {
            let (linear, angular) = (state.velocity_in_base(), state.angular_velocity_in_base());
            [linear.x, linear.y, angular.z]
        });
        data.velocities = velocities.collect();
        data.seen_as(&Tables::default().discriminator)
    }

    /// The same clips, seen as a list says.
    pub fn seen_as(mut self, table: &Table) -> Self {
        self.width = table.width();
        self.features.clear();
        let states = self.clips.iter().flat_map(|clip| &clip.frames);
        for state in states {
            self.features.extend(table.row(&Scene::of(state)));
        }
        self
    }

    /// Numbers that are seen of a frame.
    pub fn width(&self) -> usize {
        self.width
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

    /// Whether the policy's commands decide which motion is drawn, see [`Self::sample_window_near`].
    pub fn is_drawn_by_commands(&self) -> bool {
        self.by_commands
    }

    /// Draws a window as [`Self::sample_window`] does, of a clip whose command is near one: with weight w and at a distance of
    /// d times [`NEAR`], in proportion to w·exp(−d²/2).
    ///
    /// # Panics
    /// If `out` is not as long as two states or more.
    pub fn sample_window_near(
        &self,
        command: [f32; 3],
        rng: &mut impl Rng,
        spacing: usize,
        out: &mut [f32],
    ) -> [f32; 3] {
        let far = |clip: &Clip| {
            let apart = clip.command.iter().zip(command).zip(NEAR);
            let squares = apart.map(|((a, b), near)| ((a - b) / near).powi(2));
            squares.sum::<f32>()
        };
        let nearest = self.clips.iter().map(far).fold(f32::INFINITY, f32::min);
        // The nearest counts in full, however far it is.
        let share = |clip: &Clip| clip.weight * (0.5 * (nearest - far(clip))).exp();
        let mut left = rng.random::<f32>() * self.clips.iter().map(share).sum::<f32>();
        let drawn = self.clips.iter().position(|clip| {
            left -= share(clip);
            left < 0.0
        });
        // Rounding may leave some.
        let index = drawn.unwrap_or(self.clips.len() - 1);
        let end = rng.random_range(0..self.clips[index].transitions());
        self.window(index, end, spacing, out)
    }

    /// Draws a window of motion: what is seen of states `spacing` steps apart, oldest first; every
    /// transition is equally often its end. In a cyclic clip the first frame follows the last; before
    /// the first frame of another clip there is nothing but that frame. Allocates nothing.
    ///
    /// Gives the command that such motion obeys: in a cyclic clip the clip's own; in another, which sets off, stops or
    /// wanders, the window's mean velocity.
    ///
    /// # Panics
    /// If `out` is not as long as two states or more.
    pub fn sample_window(&self, rng: &mut impl Rng, spacing: usize, out: &mut [f32]) -> [f32; 3] {
        let (index, i) = match &self.strata {
            Some(strata) => strata.draw(rng),
            None => {
                let index = self.sample_clip(rng);
                (index, rng.random_range(0..self.clips[index].transitions()))
            }
        };
        self.window(index, i, spacing, out)
    }

    /// The window that ends with transition `i` of a clip, and its command.
    fn window(&self, index: usize, i: usize, spacing: usize, out: &mut [f32]) -> [f32; 3] {
        let width = self.width;
        let steps = out.len() / width;
        assert!(
            steps >= 2 && out.len().is_multiple_of(width),
            "a window has {width} numbers for each of two states or more"
        );
        let clip = &self.clips[index];
        let length = clip.frames.len();
        let mut sums = [0.0; 3];
        for (place, state) in out.chunks_exact_mut(width).enumerate() {
            // The newest is the end of transition i.
            let back = (steps - 1 - place) * spacing;
            let frame = (i + 1) as isize - back as isize;
            let frame = if clip.cyclic {
                frame.rem_euclid(length as isize)
            } else {
                frame.max(0)
            };
            let at = self.starts[index] + frame as usize;
            state.copy_from_slice(&self.features[at * width..][..width]);
            for (sum, velocity) in sums.iter_mut().zip(self.velocities[at]) {
                *sum += velocity;
            }
        }
        if clip.cyclic {
            return clip.command;
        }
        sums.map(|sum| sum / steps as f32)
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

#[cfg(test)]
mod tests;

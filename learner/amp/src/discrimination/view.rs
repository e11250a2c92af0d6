//! How windows come before the discriminator's eyes.
//!
//! Separate because windows are kept as they are measured, a command behind the states if that is seen, and only here
//! become what the network takes: normalised states, and instead of the command how far the velocity is off it. The
//! penalty (Eq. 5) keeps the judge flat along states, and only along them: where it held for what is asked too, standing
//! was good style whatever that was.

use crate::COMMAND;
use crate::config::DiscriminatorConfig;
use networks::Scaling;

/// A mapping of windows, fixed until the statistics change.
#[derive(Clone, Debug, PartialEq)]
pub struct View {
    /// Of all states of a window.
    pub(super) states: Scaling,
    /// Numbers of a state.
    features: usize,
    /// The inverse of what an error is measured in, if the command is seen.
    inverse: Option<[f32; COMMAND]>,
    /// Which features are the velocities that a command asks for.
    velocity: [usize; COMMAND],
}

impl View {
    /// Of windows of `config.frames` states, each scaled as `state` says.
    pub(super) fn new(
        config: &DiscriminatorConfig,
        velocity: [usize; COMMAND],
        state: Scaling,
    ) -> Self {
        let mut states = state;
        let features = states.mean.len();
        for _ in 1..config.frames {
            states.mean.extend_from_within(..features);
            states.inverse.extend_from_within(..features);
        }
        Self {
            states,
            features,
            inverse: config.command_blur.map(|blur| blur.map(f32::recip)),
            velocity,
        }
    }

    /// Appends what is seen of windows, `[row][width]`.
    pub fn apply(&self, windows: &[f32], out: &mut Vec<f32>) {
        let Some(inverse) = self.inverse else {
            self.states.apply(windows, out);
            return;
        };
        let states = self.states.mean.len();
        for window in windows.chunks_exact(states + COMMAND) {
            let (moved, command) = window.split_at(states);
            self.states.apply(moved, out);
            let clip = self.states.clip;
            for (i, feature) in self.velocity.into_iter().enumerate() {
                let sum: f32 = moved.iter().skip(feature).step_by(self.features).sum();
                let mean = sum / (states / self.features) as f32;
                out.push(((mean - command[i]) * inverse[i]).clamp(-clip, clip));
            }
        }
    }
}

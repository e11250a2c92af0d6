//! Where one step of a fleet is written.

use observation::Widths;

/// Where one step of the fleet is written: every slice holds a row per environment.
pub struct StepOut<'a> {
    /// Task reward rᴳ (Eq. 14), N.
    pub task_rewards: &'a mut [f32],
    /// Positive mechanical work of the motors in this step, J, N.
    pub energies: &'a mut [f32],
    /// Squared velocity error ‖v* − v‖², m²/s², N.
    pub tracking_errors: &'a mut [f32],
    /// 0 where the episode goes on, else why it ended ([`vocabulary::Cause::code`]), N.
    pub ends: &'a mut [f32],
    /// Steps done in the episode, this one included, N.
    pub episode_steps: &'a mut [f32],
    /// What the discriminator sees of the state at t + 1, a row each; of a finished episode its own last.
    pub next_features: &'a mut [f32],
    /// Vertical force on left and right sole, mean over the step, N (newtons), N·2.
    pub foot_forces: &'a mut [f32],
    /// What is measured beside (see [`observation::Tables::measured`]) of the state at t + 1 and the command at t, a row
    /// each; of a finished episode its own last.
    pub measured: &'a mut [f32],
    /// The last policy observation of episodes that timed out on this step, a row each; other rows are left alone.
    pub timeout_observations: &'a mut [f32],
    /// What the critic saw of its own then, a row each.
    pub timeout_critic: &'a mut [f32],
}

impl StepOut<'_> {
    pub(super) fn check(&self, n: usize, widths: &Widths) {
        for (name, length, expected) in [
            ("task_rewards", self.task_rewards.len(), n),
            ("energies", self.energies.len(), n),
            ("tracking_errors", self.tracking_errors.len(), n),
            ("ends", self.ends.len(), n),
            ("episode_steps", self.episode_steps.len(), n),
            (
                "next_features",
                self.next_features.len(),
                n * widths.features,
            ),
            ("foot_forces", self.foot_forces.len(), n * 2),
            ("measured", self.measured.len(), n * widths.measured),
            (
                "timeout_observations",
                self.timeout_observations.len(),
                n * widths.observation,
            ),
            (
                "timeout_critic",
                self.timeout_critic.len(),
                n * widths.critic,
            ),
        ] {
            assert_eq!(length, expected, "length of {name} for {n} environments");
        }
    }
}

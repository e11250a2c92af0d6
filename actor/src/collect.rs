//! Fills one rollout in place: the policy acts, the fleet steps, every number goes straight into
//! the memory that the learner will read.

use std::time::Instant;

use policy::Policy;
use protocol::RolloutViewMut;
use rand_pcg::Pcg64Mcg;
use sim::{Fleet, StepOut};

/// Seconds that a rollout took, by what they were spent on.
#[derive(Clone, Copy, Debug, Default)]
pub struct Timing {
    /// Moving the robots.
    pub physics: f32,
    /// Rewards, ends, resets and what is seen after the step.
    pub observation: f32,
    /// Running the policy and drawing its noise.
    pub inference: f32,
}

/// Lets `policy` act in `fleet` for as many steps as `rollout` has room for.
///
/// The last `calm` robots explore calmly. Allocates nothing. `rollout` may hold old numbers: every block is written, the time-out block
/// with zeros where no episode timed out.
pub fn collect(
    fleet: &mut Fleet,
    policy: &mut Policy,
    calm: usize,
    generator: &mut Pcg64Mcg,
    rollout: &mut RolloutViewMut<'_>,
) -> Timing {
    let layout = rollout.layout;
    let mut timing = Timing::default();
    rollout.timeout_observations.fill(0.0);
    rollout.timeout_critic.fill(0.0);
    for t in 0..layout.steps {
        let step = rollout.step(t);
        let started = Instant::now();
        step.observations.copy_from_slice(fleet.observations());
        step.critic.copy_from_slice(fleet.critic_observations());
        step.features.copy_from_slice(fleet.features());
        policy.sample(
            step.observations,
            calm,
            generator,
            step.actions,
            step.means,
            step.log_probs,
        );
        let acted = Instant::now();
        fleet.advance(step.actions);
        let moved = Instant::now();
        fleet.observe(&mut StepOut {
            task_rewards: step.task_rewards,
            energies: step.energies,
            tracking_errors: step.tracking_errors,
            ends: step.ends,
            episode_steps: step.episode_steps,
            next_features: step.next_features,
            foot_forces: step.foot_forces,
            measured: step.measured,
            timeout_observations: step.timeout_observations,
            timeout_critic: step.timeout_critic,
        });
        timing.inference += (acted - started).as_secs_f32();
        timing.physics += (moved - acted).as_secs_f32();
        timing.observation += moved.elapsed().as_secs_f32();
    }
    rollout
        .last_observations
        .copy_from_slice(fleet.observations());
    rollout
        .last_critic
        .copy_from_slice(fleet.critic_observations());
    timing
}

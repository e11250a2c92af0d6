//! The learner as bytes: everything that an exact continuation needs, and checks when it comes back.

use crate::learning::Core;
use crate::replay::Replay;
use crate::{Learning, LearningError};
use networks::{AdamState, NormalizerState, snapshot};
use rand_pcg::Pcg64;
use serde::{Deserialize, Serialize};
use std::borrow::Cow;
use std::ops::Range;

/// Changes when the content does.
const FORMAT: u32 = 2;

/// Rows that the statistics of a snapshot count as, for it does not say: so many that they hardly move any more. A trained
/// policy unlearns when it sees them move (counted as 10⁸, one lost 2 % of its task reward in 8 million samples).
const ROWS_OF_A_SNAPSHOT: f64 = 1e12;

#[derive(Serialize, Deserialize)]
struct Saved<'a> {
    format: u32,
    iteration: u64,
    samples: u64,
    rate: f32,
    #[serde(borrow)]
    policy: Vec<Tensor<'a>>,
    policy_adam: AdamState,
    #[serde(borrow)]
    discriminator: Vec<Tensor<'a>>,
    discriminator_adam: AdamState,
    observations: NormalizerState,
    features: NormalizerState,
    replay: Replay,
    generator: Pcg64,
}

/// The discriminator alone: what judges style, and no more.
#[derive(Serialize, Deserialize)]
struct SavedJudge<'a> {
    format: u32,
    #[serde(borrow)]
    discriminator: Vec<Tensor<'a>>,
    features: NormalizerState,
}

#[derive(Serialize, Deserialize)]
struct Tensor<'a> {
    // Borrowed from the bytes: a name of its own would be allocated as long as damaged bytes say.
    #[serde(borrow)]
    name: Cow<'a, str>,
    sizes: Vec<usize>,
    numbers: Vec<f32>,
}

type Layout = Vec<(String, Vec<usize>, Range<usize>)>;

impl Learning {
    /// Everything that an exact continuation needs. The caller keeps the configuration beside it.
    pub fn save(&self) -> Vec<u8> {
        let core = &self.core;
        let (weights, adam, features) = core.discriminator.state();
        let policy = [core.ppo.actor(), core.ppo.critic(), core.ppo.log_sigma()].concat();
        let saved = Saved {
            format: FORMAT,
            iteration: core.iteration,
            samples: core.samples,
            rate: core.ppo.rate(),
            policy: tensors(core.ppo.tensors(), &policy),
            policy_adam: core.ppo.adam().state().clone(),
            discriminator: tensors(core.discriminator.tensors(), weights),
            discriminator_adam: adam.state().clone(),
            observations: core.observations.state().clone(),
            features: features.state().clone(),
            replay: self.replay.clone(),
            generator: core.generator.clone(),
        };
        let standard = bincode::config::standard();
        let mut bytes =
            bincode::serde::encode_to_vec(&saved, standard).expect("plain numbers into memory");
        // Behind it, so that the state of a critic without rows of its own stays what it was.
        if let Some(critic) = &core.critic {
            let own = bincode::serde::encode_to_vec(critic.state(), standard);
            bytes.extend(own.expect("plain numbers into memory"));
        }
        bytes
    }

    /// Continues from a saved state; the next iteration gives the same bits as it would have given then.
    ///
    /// # Errors
    /// If the bytes are no saved state, or one of networks of other sizes. The learner is then as it was before.
    pub fn load(&mut self, bytes: &[u8]) -> Result<(), LearningError> {
        let refuse = |why: String| LearningError::Decode(why);
        let (saved, critic) = Saved::read(bytes)?;
        if !saved.replay.is_sound(self.replay.width()) {
            return Err(refuse(
                "the remembered transitions contradict themselves".to_owned(),
            ));
        }
        let mut core = self.core.clone();
        core.take_policy(saved.policy, saved.policy_adam, saved.rate)?;
        core.take_critic(critic)?;
        let layout = core.discriminator.tensors();
        let (weights, adam, features) = core.discriminator.state_mut();
        restore(layout, saved.discriminator, weights)?;
        adam.restore(saved.discriminator_adam)?;
        features.restore(saved.features)?;
        core.observations.restore(saved.observations)?;
        core.generator = saved.generator;
        core.iteration = saved.iteration;
        core.samples = saved.samples;
        self.core = core;
        self.replay = saved.replay.with_capacity(self.replay.capacity());
        Ok(())
    }
}

impl Saved<'_> {
    /// Bytes of this format, to the last; behind them the statistics of a critic with rows of its own.
    fn read(bytes: &[u8]) -> Result<(Saved<'_>, Option<NormalizerState>), LearningError> {
        let refuse = |why: String| LearningError::Decode(why);
        let (saved, used): (Saved<'_>, usize) =
            bincode::serde::borrow_decode_from_slice(bytes, bincode::config::standard())
                .map_err(|error| refuse(error.to_string()))?;
        if saved.format != FORMAT {
            return Err(refuse(format!(
                "format {}, this program reads {FORMAT}",
                saved.format
            )));
        }
        let rest = &bytes[used..];
        if rest.is_empty() {
            return Ok((saved, None));
        }
        let (critic, used): (NormalizerState, usize) =
            bincode::serde::decode_from_slice(rest, bincode::config::standard())
                .map_err(|error| refuse(format!("{} bytes too many: {error}", rest.len())))?;
        if used != rest.len() {
            return Err(refuse(format!("{} bytes too many", rest.len() - used)));
        }
        Ok((saved, Some(critic)))
    }
}

impl Core {
    /// Statistics of what the critic sees, where it sees rows of its own and nowhere else.
    fn take_critic(&mut self, saved: Option<NormalizerState>) -> Result<(), LearningError> {
        match (&mut self.critic, saved) {
            (None, None) => Ok(()),
            (Some(normalizer), Some(saved)) => Ok(normalizer.restore(saved)?),
            (mine, _) => {
                let said = |own: bool| {
                    if own {
                        "rows of its own"
                    } else {
                        "what the policy sees"
                    }
                };
                let (here, there) = (said(mine.is_some()), said(mine.is_none()));
                Err(LearningError::Decode(format!(
                    "its critic sees {there}, that of the configuration {here}"
                )))
            }
        }
    }

    /// Actor, critic and widths with their optimizer and its rate.
    fn take_policy(
        &mut self,
        policy: Vec<Tensor<'_>>,
        moments: AdamState,
        saved_rate: f32,
    ) -> Result<(), LearningError> {
        if !(saved_rate.is_finite() && saved_rate > 0.0) {
            return Err(LearningError::Decode(format!("learning rate {saved_rate}")));
        }
        let layout = self.ppo.tensors();
        let (weights, adam, rate) = self.ppo.state_mut();
        restore(layout, policy, weights)?;
        adam.restore(moments)?;
        *rate = saved_rate;
        Ok(())
    }
}

impl Learning {
    /// Begins with the policy of another learner: actor, critic, their optimizer and the statistics of observations.
    /// Discriminator, memory and the count of samples stay as they are.
    ///
    /// # Errors
    /// As of [`Learning::load`]. The learner is then as it was before.
    pub fn load_policy(&mut self, bytes: &[u8]) -> Result<(), LearningError> {
        let (saved, critic) = Saved::read(bytes)?;
        let mut core = self.core.clone();
        core.take_policy(saved.policy, saved.policy_adam, saved.rate)?;
        core.take_critic(critic)?;
        core.observations.restore(saved.observations)?;
        self.core = core;
        Ok(())
    }

    /// Begins with a policy as actors get it ([`networks::snapshot`]) and its critic's weights, if they are known; without,
    /// the critic is new, see [`crate::PpoConfig::critic_first`]. So is the optimizer.
    ///
    /// # Errors
    /// If actor or critic are of other sizes, or a number is not finite. The learner is then as it was before.
    pub fn load_snapshot(
        &mut self,
        flat: &[f32],
        critic: Option<&[f32]>,
    ) -> Result<(), LearningError> {
        let mut core = self.core.clone();
        let parts = snapshot::import(core.ppo.actor_shape(), flat)?;
        core.observations.restore(NormalizerState {
            count: ROWS_OF_A_SNAPSHOT,
            mean: parts.mean.iter().map(|mean| f64::from(*mean)).collect(),
            squares: parts
                .inverse
                .iter()
                .map(|inverse| ROWS_OF_A_SNAPSHOT / f64::from(*inverse).powi(2))
                .collect(),
        })?;
        core.ppo.begin_with(parts.actor, critic)?;
        self.core = core;
        Ok(())
    }

    /// The critic's weights, for [`Learning::load_snapshot`].
    pub fn critic(&self) -> &[f32] {
        self.core.ppo.critic()
    }

    /// The discriminator alone, a hundredth of [`Learning::save`]: enough to judge style, not to go on training.
    pub fn save_judge(&self) -> Vec<u8> {
        let (weights, _, features) = self.core.discriminator.state();
        let saved = SavedJudge {
            format: FORMAT,
            discriminator: tensors(self.core.discriminator.tensors(), weights),
            features: features.state().clone(),
        };
        bincode::serde::encode_to_vec(&saved, bincode::config::standard())
            .expect("plain numbers into memory")
    }

    /// Judges by a discriminator that was saved alone.
    ///
    /// # Errors
    /// If the bytes are no saved discriminator, or one of other sizes. The learner is then as it was before.
    pub fn load_judge(&mut self, bytes: &[u8]) -> Result<(), LearningError> {
        let (saved, used): (SavedJudge<'_>, usize) =
            bincode::serde::borrow_decode_from_slice(bytes, bincode::config::standard())
                .map_err(|error| LearningError::Decode(error.to_string()))?;
        if saved.format != FORMAT || used != bytes.len() {
            return Err(LearningError::Decode(format!(
                "format {}, {used} of {} bytes; this program reads format {FORMAT}",
                saved.format,
                bytes.len()
            )));
        }
        let mut core = self.core.clone();
        let layout = core.discriminator.tensors();
        let (weights, _, features) = core.discriminator.state_mut();
        restore(layout, saved.discriminator, weights)?;
        features.restore(saved.features)?;
        self.core = core;
        Ok(())
    }
}

fn tensors(layout: Layout, flat: &[f32]) -> Vec<Tensor<'static>> {
    layout
        .into_iter()
        .map(|(name, sizes, place)| Tensor {
            name: name.into(),
            sizes,
            numbers: flat[place].to_vec(),
        })
        .collect()
}

/// Writes tensors to their places if they are the ones expected, in order.
fn restore(layout: Layout, saved: Vec<Tensor<'_>>, flat: &mut [f32]) -> Result<(), LearningError> {
    for i in 0..layout.len().max(saved.len()) {
        let (expected, found) = (layout.get(i), saved.get(i));
        let fits = expected
            .zip(found)
            .filter(|((name, sizes, place), tensor)| {
                *name == tensor.name
                    && *sizes == tensor.sizes
                    && place.len() == tensor.numbers.len()
            });
        let Some(((name, _, place), tensor)) = fits else {
            let name = expected
                .map(|(name, ..)| name.as_str())
                .or(found.map(|tensor| &*tensor.name));
            let describe = |there: Option<(&str, &Vec<usize>)>| match there {
                Some((name, sizes)) => format!("{name} {sizes:?}"),
                None => "absent".to_owned(),
            };
            return Err(LearningError::Tensor {
                name: name.unwrap_or_default().to_owned(),
                saved: describe(found.map(|tensor| (&*tensor.name, &tensor.sizes))),
                expected: describe(expected.map(|(name, sizes, _)| (name.as_str(), sizes))),
            });
        };
        if let Some(index) = networks::first_not_finite(&tensor.numbers) {
            return Err(LearningError::Decode(format!(
                "number {index} of tensor `{name}` is {}",
                tensor.numbers[index]
            )));
        }
        flat[place.clone()].copy_from_slice(&tensor.numbers);
    }
    Ok(())
}

//! The learner's sections of a run's configuration.
//!
//! The paper says only that "all RL hyperparameters follow the original AMP implementation" for 4,096 environments on a
//! GPU; these defaults are a smaller set that walked within 1.6 million samples on one CPU core ("the recipe" below).

mod discriminator;
mod policy;
mod ppo;

pub(crate) use discriminator::{DECAY, FEATURE_CLIP, HEAD_DECAY, REPLAY_SHARE, floor};
pub use discriminator::{DiscriminatorConfig, LossKind};
pub use policy::{ExplorationConfig, ExplorationKind, PolicyConfig};
pub(crate) use policy::{LAST_GAIN, LEARNED_SIGMA, OBSERVATION_FLOOR};
pub(crate) use ppo::{GRADIENT_NORM, GREATEST_RATE, KL_BAND, LEAST_RATE, RATE_FACTOR};
pub use ppo::{OffPolicy, PpoConfig, RateSchedule};

use std::fmt::Debug;
use vocabulary::{Invalid, Ramp, Section};

/// All sections of the learner.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LearningConfig {
    /// `[policy]`
    pub policy: PolicyConfig,
    /// `[exploration]`
    pub exploration: ExplorationConfig,
    /// `[ppo]`
    pub ppo: PpoConfig,
    /// `[discriminator]`
    pub discriminator: DiscriminatorConfig,
}

impl LearningConfig {
    /// Refuses the first value that learning cannot work with, with its section.
    pub fn validate(&self) -> Result<(), crate::LearningError> {
        let named = |section| move |source| crate::LearningError::Config { section, source };
        self.policy.validate().map_err(named("policy"))?;
        self.exploration.validate().map_err(named("exploration"))?;
        self.ppo.validate().map_err(named("ppo"))?;
        self.discriminator
            .validate()
            .map_err(named("discriminator"))
    }
}

/// The first field that breaks its condition.
struct Check(Result<(), Invalid>);

impl Check {
    fn that(self, holds: bool, path: &str, value: impl Debug, remedy: &str) -> Self {
        if self.0.is_err() || holds {
            return self;
        }
        Self(Err(Invalid::new(path, value, remedy)))
    }

    /// Both ends of what may move.
    fn ramp(self, path: &str, ramp: &Ramp<f32>, check: fn(Self, &str, f32) -> Self) -> Self {
        let checked = self
            .0
            .and_then(|()| ramp.check(path, |path, value| check(Self(Ok(())), path, value).0));
        Self(checked)
    }

    fn positive(self, field: &str, value: f32) -> Self {
        let holds = value > 0.0 && value.is_finite();
        self.that(holds, field, value, "use a finite number above 0")
    }

    /// For standard deviations of actions and their factors: far below this an actor would have none at all.
    fn at_least_a_millionth(self, field: &str, value: f32) -> Self {
        let holds = value.is_finite() && value >= 1e-6;
        self.that(holds, field, value, "use a finite number from 1e-6 on")
    }

    fn not_negative(self, field: &str, value: f32) -> Self {
        let holds = value >= 0.0 && value.is_finite();
        self.that(holds, field, value, "use a finite number, 0 or above")
    }

    fn share(self, field: &str, value: f32) -> Self {
        self.that(
            (0.0..=1.0).contains(&value),
            field,
            value,
            "use a share from 0 to 1",
        )
    }

    fn count(self, field: &str, value: usize, most: usize) -> Self {
        self.that(
            (1..=most).contains(&value),
            field,
            value,
            &format!("use a whole number from 1 to {most}"),
        )
    }

    /// Broadcast weights name their hidden layers in six places.
    fn layers(self, field: &str, widths: &[usize]) -> Self {
        let holds = (1..=6).contains(&widths.len())
            && widths.iter().all(|width| (1..=4096).contains(width));
        self.that(holds, field, widths, "use 1 to 6 layers of 1 to 4096 units")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn defaults_are_usable() {
        LearningConfig::default().validate().expect("defaults");
    }

    #[test]
    fn a_section_says_only_its_differences() {
        let ppo: PpoConfig =
            toml::from_str("epochs = 5\nschedule = \"per_minibatch\"").expect("ppo");
        assert_eq!((ppo.epochs, ppo.minibatch), (5, 2048));
        assert_eq!(ppo.schedule, RateSchedule::PerMinibatch);
        let judge: DiscriminatorConfig = toml::from_str("frames = 4").expect("discriminator");
        assert_eq!((judge.frames, judge.steps), (4, 3));
        assert!(toml::from_str::<PpoConfig>("epoch = 5").is_err());
        assert!(toml::from_str::<DiscriminatorConfig>("frame = 4").is_err());
    }

    #[test]
    fn a_bad_value_is_named_with_its_remedy() {
        let mut config = LearningConfig::default();
        config.ppo.mirrored_share = 1.5.into();
        let error = config.ppo.validate().expect_err("1.5 is no share");
        assert_eq!(
            error.to_string(),
            "mirrored_share = 1.5 is not usable: use a share from 0 to 1"
        );
        assert!(config.validate().is_err());
        config.ppo = PpoConfig {
            learning_rate: f32::NAN,
            ..Default::default()
        };
        assert_eq!(
            config.ppo.validate().expect_err("NaN").path,
            "learning_rate"
        );
        config.policy.hidden.clear();
        assert_eq!(
            config.policy.validate().expect_err("no layer").path,
            "hidden"
        );
    }
}

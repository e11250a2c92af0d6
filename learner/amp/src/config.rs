//! The learner's sections of a run's configuration.
//!
//! The paper says only that "all RL hyperparameters follow the original AMP implementation" for 4,096 environments on a
//! GPU; these defaults are a smaller set that walked within 1.6 million samples on one CPU core ("the recipe" below).

use serde::{Deserialize, Serialize};

/// A value that learning cannot work with.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("`{field}` = {value}: {remedy}")]
pub struct ConfigError {
    /// Name of the field.
    pub field: &'static str,
    /// Its value.
    pub value: String,
    /// What is allowed.
    pub remedy: &'static str,
}

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

/// `[policy]`: sizes of actor and critic, and what they see.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct PolicyConfig {
    /// Widths of the actor's hidden layers (ELU). The recipe's 256-128-64; published G1 trainers use 512-256-128.
    pub hidden: Vec<usize>,
    /// Widths of the critic's hidden layers (ELU). As the actor's.
    pub critic_hidden: Vec<usize>,
    /// Gain of the actor's first last layer: small, so that the first actions are near the default pose. The recipe's.
    pub last_gain: f32,
    /// Normalised observations are clipped to ± this. The recipe's.
    pub observation_clip: f32,
    /// Least standard deviation of an observation, in its own unit: what never varied must not be blown up later.
    pub observation_floor: f32,
}

/// `[exploration]`: the standard deviation σ of actions around the policy's mean, in units of actions.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct ExplorationConfig {
    /// `scheduled` follows the samples, `learned` is adapted by PPO from `initial_sigma` on.
    pub kind: ExplorationKind,
    /// Legs' σ at first: 0.6 is 0.15 rad. The recipe's; σ 0.15 from the start got stuck falling.
    pub initial_sigma: f32,
    /// Scheduled: legs' σ at the end. The recipe's.
    pub final_sigma: f32,
    /// Scheduled: samples until σ begins to shrink. The recipe's.
    pub hold_samples: f64,
    /// Scheduled: samples at which it has arrived, on a straight line of log σ. The recipe's.
    pub final_samples: f64,
    /// Waist's σ in parts of the legs'. Noise there is the discriminator's shortcut. The recipe's.
    pub waist_factor: f32,
    /// Arms' σ in parts of the legs'. The recipe's.
    pub arm_factor: f32,
    /// Learned: σ stays within `[min_sigma, max_sigma]`.
    pub min_sigma: f32,
    /// Learned: see `min_sigma`.
    pub max_sigma: f32,
}

/// Choices of [`ExplorationConfig::kind`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ExplorationKind {
    /// σ by the number of samples.
    Scheduled,
    /// σ as a parameter of the policy, the same in every state.
    Learned,
}

/// `[ppo]`: how the policy is improved.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct PpoConfig {
    /// γ, discount per 20 ms step. 0.99 in all published G1 trainers.
    pub gamma: f32,
    /// λ of the advantage estimate. 0.95 in all published G1 trainers.
    pub lambda: f32,
    /// Blended rewards are multiplied by it, so that values stay near 1. The recipe's.
    pub reward_scale: f32,
    /// Clip range of the probability ratio. 0.2 in most trainers.
    pub clip: f32,
    /// Clip range of the value's change, none if absent (the recipe's).
    pub value_clip: Option<f32>,
    /// Weight of the value loss beside the surrogate. 1 in most trainers; the networks share nothing but the norm.
    pub value_coefficient: f32,
    /// Weight of the entropy bonus; only `learned` exploration answers to it. The recipe's 0.
    pub entropy_coefficient: f32,
    /// Passes over the batch. The recipe's.
    pub epochs: usize,
    /// Rows per step. The recipe's.
    pub minibatch: usize,
    /// Adam's rate at first. The recipe's.
    pub learning_rate: f32,
    /// When the rate follows the KL divergence. Per minibatch it saw-toothed in the recipe's trials.
    pub schedule: RateSchedule,
    /// Mean KL divergence of the last epoch that the rate is steered to. The recipe's.
    pub kl_target: f32,
    /// The rate changes when KL leaves [target / band, target · band].
    pub kl_band: f32,
    /// Factor of one change. The recipe's.
    pub rate_factor: f32,
    /// Lowest rate. As in published trainers.
    pub min_learning_rate: f32,
    /// Highest rate. As in published trainers.
    pub max_learning_rate: f32,
    /// Global norm that gradients are shortened to. 1 in all published trainers.
    pub gradient_norm: f32,
    /// Over which rows advantages get mean 0 and deviation 1.
    pub advantage_normalization: AdvantageNormalization,
    /// Share of each minibatch that is replaced by its left–right mirror image. The recipe's half.
    pub mirrored_share: f32,
    /// Threads that rows are divided among. Sums are made in their order, so that results depend on this number and not
    /// on the machine.
    pub threads: usize,
}

/// Choices of [`PpoConfig::schedule`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum RateSchedule {
    /// The rate stays.
    Fixed,
    /// Once per iteration.
    PerIteration,
    /// Before every minibatch's step.
    PerMinibatch,
}

/// Choices of [`PpoConfig::advantage_normalization`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum AdvantageNormalization {
    /// All rows of the iteration.
    Batch,
    /// The rows of each minibatch.
    Minibatch,
    /// Not at all.
    None,
}

/// `[discriminator]`: the judge of style.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct DiscriminatorConfig {
    /// Widths of hidden layers (ReLU). The recipe's; published trainers use 1024-512.
    pub hidden: Vec<usize>,
    /// Steps per iteration. The recipe's.
    pub steps: usize,
    /// Expert transitions per step, and as many of the policy. The recipe's.
    pub batch: usize,
    /// AdamW's rate. The recipe's.
    pub learning_rate: f32,
    /// Weight decay of hidden layers. The recipe's.
    pub decay: f32,
    /// Weight decay of the last layer. The recipe's.
    pub head_decay: f32,
    /// λ_GP of Eq. 6, on normalised observations. The recipe's; published least-squares trainers use 10.
    pub gradient_penalty: f32,
    /// Past policy transitions that are remembered.
    pub replay_capacity: usize,
    /// New transitions remembered per iteration: capacity and this make a memory of about 50 iterations.
    pub replay_insert: usize,
    /// Share of a step's policy transitions that is taken from memory. The recipe's half.
    pub replay_share: f32,
    /// Normalised features are clipped to ± this.
    pub feature_clip: f32,
    /// Least standard deviations of features: differences below them are not style.
    pub floors: Floors,
}

/// `[discriminator.floors]`, each in its own unit. The recipe's: without that of joint velocities, exploration noise
/// gives the policy away.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Floors {
    /// m
    pub height: f32,
    /// m/s
    pub linear_velocity: f32,
    /// rad/s
    pub angular_velocity: f32,
    /// rad
    pub joint_position: f32,
    /// rad/s
    pub joint_velocity: f32,
}

impl Default for PolicyConfig {
    fn default() -> Self {
        Self {
            hidden: vec![256, 128, 64],
            critic_hidden: vec![256, 128, 64],
            last_gain: 0.01,
            observation_clip: 5.0,
            observation_floor: 0.02,
        }
    }
}

impl Default for ExplorationConfig {
    fn default() -> Self {
        Self {
            kind: ExplorationKind::Scheduled,
            initial_sigma: 0.6,
            final_sigma: 0.2,
            hold_samples: 1.0e6,
            final_samples: 3.0e6,
            waist_factor: 0.3,
            arm_factor: 0.3,
            min_sigma: 0.05,
            max_sigma: 1.0,
        }
    }
}

impl Default for PpoConfig {
    fn default() -> Self {
        Self {
            gamma: 0.99,
            lambda: 0.95,
            reward_scale: 0.1,
            clip: 0.2,
            value_clip: None,
            value_coefficient: 1.0,
            entropy_coefficient: 0.0,
            epochs: 4,
            minibatch: 2048,
            learning_rate: 3e-4,
            schedule: RateSchedule::PerIteration,
            kl_target: 0.025,
            kl_band: 1.5,
            rate_factor: 1.3,
            min_learning_rate: 1e-5,
            max_learning_rate: 1e-2,
            gradient_norm: 1.0,
            advantage_normalization: AdvantageNormalization::Batch,
            mirrored_share: 0.5,
            threads: 2,
        }
    }
}

impl Default for DiscriminatorConfig {
    fn default() -> Self {
        Self {
            hidden: vec![256, 128],
            steps: 3,
            batch: 1024,
            learning_rate: 1e-4,
            decay: 1e-3,
            head_decay: 1e-2,
            gradient_penalty: 20.0,
            replay_capacity: 50_000,
            replay_insert: 1024,
            replay_share: 0.5,
            feature_clip: 5.0,
            floors: Floors::default(),
        }
    }
}

impl Default for Floors {
    fn default() -> Self {
        Self {
            height: 0.03,
            linear_velocity: 0.3,
            angular_velocity: 0.5,
            joint_position: 0.1,
            joint_velocity: 2.0,
        }
    }
}

/// The first field that breaks its condition.
struct Check(Result<(), ConfigError>);

impl Check {
    fn that(
        self,
        holds: bool,
        field: &'static str,
        value: impl ToString,
        remedy: &'static str,
    ) -> Self {
        if self.0.is_err() || holds {
            return self;
        }
        Self(Err(ConfigError {
            field,
            value: value.to_string(),
            remedy,
        }))
    }

    fn positive(self, field: &'static str, value: f32) -> Self {
        let holds = value > 0.0 && value.is_finite();
        self.that(holds, field, value, "use a finite number above 0")
    }

    fn not_negative(self, field: &'static str, value: f32) -> Self {
        let holds = value >= 0.0 && value.is_finite();
        self.that(holds, field, value, "use a finite number, 0 or above")
    }

    fn share(self, field: &'static str, value: f32) -> Self {
        self.that(
            (0.0..=1.0).contains(&value),
            field,
            value,
            "use a share from 0 to 1",
        )
    }

    fn count(self, field: &'static str, value: usize, most: usize) -> Self {
        self.that(
            (1..=most).contains(&value),
            field,
            value,
            "use a whole number, at least 1 and not absurdly large",
        )
    }

    /// Broadcast weights name their hidden layers in six places.
    fn layers(self, field: &'static str, widths: &[usize]) -> Self {
        let holds = (1..=6).contains(&widths.len())
            && widths.iter().all(|width| (1..=4096).contains(width));
        self.that(
            holds,
            field,
            format!("{widths:?}"),
            "use 1 to 6 layers of 1 to 4096 units",
        )
    }
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

impl PolicyConfig {
    /// Refuses the first value that learning cannot work with.
    pub fn validate(&self) -> Result<(), ConfigError> {
        Check(Ok(()))
            .layers("hidden", &self.hidden)
            .layers("critic_hidden", &self.critic_hidden)
            .positive("last_gain", self.last_gain)
            .positive("observation_clip", self.observation_clip)
            .positive("observation_floor", self.observation_floor)
            .0
    }
}

impl ExplorationConfig {
    /// Refuses the first value that learning cannot work with.
    pub fn validate(&self) -> Result<(), ConfigError> {
        Check(Ok(()))
            .positive("initial_sigma", self.initial_sigma)
            .positive("final_sigma", self.final_sigma)
            .that(
                self.hold_samples >= 0.0 && self.hold_samples.is_finite(),
                "hold_samples",
                self.hold_samples,
                "use a finite number, 0 or above",
            )
            .that(
                self.final_samples >= self.hold_samples && self.final_samples.is_finite(),
                "final_samples",
                self.final_samples,
                "use hold_samples or more",
            )
            .positive("waist_factor", self.waist_factor)
            .positive("arm_factor", self.arm_factor)
            .positive("min_sigma", self.min_sigma)
            .that(
                self.max_sigma >= self.min_sigma && self.max_sigma.is_finite(),
                "max_sigma",
                self.max_sigma,
                "use min_sigma or more",
            )
            .0
    }
}

impl PpoConfig {
    /// Refuses the first value that learning cannot work with.
    pub fn validate(&self) -> Result<(), ConfigError> {
        Check(Ok(()))
            .share("gamma", self.gamma)
            .share("lambda", self.lambda)
            .positive("reward_scale", self.reward_scale)
            .positive("clip", self.clip)
            .positive("value_clip", self.value_clip.unwrap_or(1.0))
            .not_negative("value_coefficient", self.value_coefficient)
            .not_negative("entropy_coefficient", self.entropy_coefficient)
            .count("epochs", self.epochs, 1000)
            .count("minibatch", self.minibatch, 1 << 24)
            .positive("learning_rate", self.learning_rate)
            .positive("kl_target", self.kl_target)
            .that(
                self.kl_band >= 1.0,
                "kl_band",
                self.kl_band,
                "use 1 or more",
            )
            .that(
                self.rate_factor > 1.0,
                "rate_factor",
                self.rate_factor,
                "use more than 1, such as 1.3",
            )
            .positive("min_learning_rate", self.min_learning_rate)
            .that(
                self.max_learning_rate >= self.min_learning_rate,
                "max_learning_rate",
                self.max_learning_rate,
                "use min_learning_rate or more",
            )
            .positive("gradient_norm", self.gradient_norm)
            .share("mirrored_share", self.mirrored_share)
            .count("threads", self.threads, 256)
            .0
    }
}

impl DiscriminatorConfig {
    /// Refuses the first value that learning cannot work with.
    pub fn validate(&self) -> Result<(), ConfigError> {
        Check(Ok(()))
            .layers("hidden", &self.hidden)
            .count("steps", self.steps, 1000)
            .count("batch", self.batch, 1 << 20)
            .positive("learning_rate", self.learning_rate)
            .not_negative("decay", self.decay)
            .not_negative("head_decay", self.head_decay)
            .not_negative("gradient_penalty", self.gradient_penalty)
            .count("replay_capacity", self.replay_capacity, 10_000_000)
            .count("replay_insert", self.replay_insert, self.replay_capacity)
            .share("replay_share", self.replay_share)
            .positive("feature_clip", self.feature_clip)
            .positive("floors.height", self.floors.height)
            .positive("floors.linear_velocity", self.floors.linear_velocity)
            .positive("floors.angular_velocity", self.floors.angular_velocity)
            .positive("floors.joint_position", self.floors.joint_position)
            .positive("floors.joint_velocity", self.floors.joint_velocity)
            .0
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
            toml::from_str("epochs = 5\nvalue_clip = 0.2\nschedule = \"per_minibatch\"")
                .expect("ppo");
        assert_eq!(
            (ppo.epochs, ppo.value_clip, ppo.minibatch),
            (5, Some(0.2), 2048)
        );
        assert_eq!(ppo.schedule, RateSchedule::PerMinibatch);
        let judge: DiscriminatorConfig =
            toml::from_str("floors = { height = 0.1 }").expect("discriminator");
        assert_eq!(
            (judge.floors.height, judge.floors.joint_velocity),
            (0.1, 2.0)
        );
        assert!(toml::from_str::<PpoConfig>("epoch = 5").is_err());
        assert!(toml::from_str::<DiscriminatorConfig>("floors = { hight = 0.1 }").is_err());
    }

    #[test]
    fn a_bad_value_is_named_with_its_remedy() {
        let mut config = LearningConfig::default();
        config.ppo.mirrored_share = 1.5;
        let error = config.ppo.validate().expect_err("1.5 is no share");
        assert_eq!(
            error.to_string(),
            "`mirrored_share` = 1.5: use a share from 0 to 1"
        );
        assert!(config.validate().is_err());
        config.ppo = PpoConfig {
            learning_rate: f32::NAN,
            ..Default::default()
        };
        assert_eq!(
            config.ppo.validate().expect_err("NaN").field,
            "learning_rate"
        );
        config.policy.hidden.clear();
        assert_eq!(
            config.policy.validate().expect_err("no layer").field,
            "hidden"
        );
    }
}

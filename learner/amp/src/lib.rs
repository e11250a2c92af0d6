//! Adversarial Motion Priors: section II-A of the paper. Batches in, a better policy and a report out.
//!
//! [`Learning::iterate`] is one iteration: score the transitions with the discriminator (Eq. 7), blend the rewards by the
//! rule of the scheduler (Eq. 1, 2), estimate advantages, improve the policy by PPO, then train the discriminator on
//! expert and policy transitions (Eq. 3–6). The crate is pure: generators are seeded by the caller, the clock is passed
//! in, and the same batches give the same bits.
//!
//! | equation | item |
//! | --- | --- |
//! | 1, 2 blended reward | [`ampco::Weights`], applied by [`blend::blend`] |
//! | 3, expert loss | [`losses::expert_loss`] |
//! | 4, policy loss | [`losses::policy_loss`] |
//! | 5, gradient penalty | [`losses::gradient_penalty`] |
//! | 6, combined loss | [`losses::amp_loss`] |
//! | 7, style reward | [`style::style_reward`] |
//!
//! | subject | module |
//! | --- | --- |
//! | what rollouts bring | [`batch`] |
//! | generalised advantage estimation | [`gae`] |
//! | the same of rollouts that an older policy made | [`vtrace`] |
//! | the clipped surrogate and its companions | [`surrogate`] |
//! | one PPO update | [`ppo`] |
//! | one discriminator update, and the transitions it remembers | [`discrimination`], [`replay`] |
//! | how wide actions are drawn | [`exploration`] |
//! | what is known of the robot | [`robot`] |
//! | whether the discriminator still has an opinion | [`saturation`] |
#![forbid(unsafe_code)]

pub mod batch;
pub mod blend;
mod columns;
pub mod config;
pub mod discrimination;
mod error;
pub mod exploration;
pub mod gae;
mod inference;
mod learning;
pub mod losses;
mod minibatch;
pub mod ppo;
pub mod replay;
mod report;
pub mod robot;
pub mod saturation;
mod saved;
mod spread;
pub mod style;
pub mod surrogate;
pub mod vtrace;
pub mod window;

pub use batch::{Batch, Segment, SegmentMut};
pub use columns::{Feature, FeatureKind, Place, Widths};
pub use config::{DiscriminatorConfig, ExplorationConfig, LearningConfig, PolicyConfig, PpoConfig};
pub use error::LearningError;
pub use learning::{Clock, Learning};
pub use report::{IterationReport, Seconds};
pub use robot::{JointGroup, Mirror, Robot};
pub use saturation::{Saturation, Scores};

/// Numbers of a command: m/s forward, m/s aside, rad/s (III-A).
pub const COMMAND: usize = 3;

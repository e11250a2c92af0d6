//! The task as an environment: Unitree G1 robots on a flat floor, in rapier or in the batched solver,
//! at 200 Hz, asked to follow velocity commands at 50 Hz.
//!
//! Separate, and pure, because learning must not care what simulates: this is the only crate that
//! sees rapier. It owns no clock, no thread and no file; the same seed gives the same bits.
//!
//! | subject | file |
//! | --- | --- |
//! | N environments in a fixed order: step, save, restore | [`fleet`] |
//! | one episode's life | `env` |
//! | memory for a step of a fleet | [`rows`] |
//! | the `[task]` section, a table of contents | [`task`] |
//! | what a step came to, as rewards see it | [`moment`] |
//! | reward terms (Eq. 14 is one), their mean | [`reward`] |
//! | factors of the reward (Eq. 14 has one) | [`gate`] |
//! | what a table of terms is | `terms` |
//! | what ends an episode: a fall, the time, straying | [`termination`] |
//! | commands c_t | [`command`] |
//! | kinds of command, each with its share of the robots | [`kind`] |
//! | where episodes begin | [`start`] |
//! | hills and bumps | [`ground`] |
//! | domain randomisation (Table I) | [`randomization`] |
//! | what befalls a real robot: delays, other motors, slopes, forces | [`event`] |
//! | motors: position control, torque limits, energy (III-F) | [`actuator`] |
//! | the two engines behind one seam | [`physics`] |
//! | a robot in rapier, state in and out | [`world`], [`model`] |
//! | rapier's settings | [`engine`] |
//! | lengths of a physics and a control step | [`time`] |
//!
//! A value of the task that moves with the samples is a [`vocabulary::Ramp`].
#![forbid(unsafe_code)]

pub mod actuator;
pub mod command;
pub mod engine;
mod env;
pub mod error;
pub mod event;
pub mod fleet;
pub mod gate;
pub mod ground;
pub mod kind;
pub mod model;
pub mod moment;
pub mod physics;
pub mod randomization;
pub mod reward;
pub mod rows;
pub mod start;
pub mod task;
pub mod termination;
mod terms;
pub mod time;
pub mod world;

pub use actuator::Gains;
pub use command::CommandConfig;
pub use engine::Engine;
pub use error::SimError;
pub use event::EventConfig;
pub use fleet::{Fleet, LastStep, StepOut, Varied};
pub use gate::GateConfig;
pub use ground::GroundConfig;
pub use kind::{Kind, KindsConfig};
pub use model::Variation;
pub use moment::Moment;
pub use physics::{Mechanics, Physics};
pub use randomization::RandomizationConfig;
pub use reward::RewardConfig;
pub use rows::StepRows;
pub use start::{StartConfig, Starts};
pub use task::TaskConfig;
pub use termination::TerminationConfig;
pub use termination::fall::FallConfig;
pub use termination::stray::StrayConfig;
pub use termination::time_out::TimeOutConfig;
pub use world::{Exertion, World};

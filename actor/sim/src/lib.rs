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
//! | the task reward (Eq. 14), falls, time-outs | [`task`] |
//! | a task that grows with the samples | [`curriculum`] |
//! | commands c_t | [`command`] |
//! | kinds of command, each with its share of the robots | [`kind`] |
//! | where episodes begin | [`start`] |
//! | domain randomisation (Table I) | [`randomization`] |
//! | straying from the command ends an episode | [`stray`] |
//! | standing on one foot at a time pays | [`stance`] |
//! | motors: position control, torque limits, energy (III-F) | [`actuator`] |
//! | the two engines behind one seam | [`physics`] |
//! | a robot in rapier, state in and out | [`world`], [`model`] |
//! | rapier's settings | [`engine`] |
#![forbid(unsafe_code)]

pub mod actuator;
pub mod command;
pub mod config;
pub mod curriculum;
pub mod engine;
mod env;
pub mod error;
pub mod fleet;
pub mod kind;
pub mod model;
pub mod physics;
pub mod randomization;
pub mod rows;
pub mod stance;
pub mod start;
pub mod stray;
pub mod task;
pub mod world;

pub use actuator::Gains;
pub use command::CommandConfig;
pub use config::Invalid;
pub use curriculum::CurriculumConfig;
pub use engine::Engine;
pub use error::SimError;
pub use fleet::{Fleet, LastStep, StepOut};
pub use kind::{Kind, KindsConfig};
pub use model::Variation;
pub use physics::Physics;
pub use randomization::RandomizationConfig;
pub use rows::StepRows;
pub use stance::SingleStanceConfig;
pub use start::{StartConfig, Starts};
pub use stray::StrayConfig;
pub use task::TaskConfig;
pub use world::{Exertion, World};

//! A run's folder and what lies in it.
//!
//! Every process of a run opens the same folder `runs/<name>/`; this crate is the one place that knows what it holds:
//!
//! | entry | what | who writes | module |
//! | --- | --- | --- | --- |
//! | `config.toml` | the fully resolved configuration | `ampco train` | [`config`] |
//! | `motion.json` | the motion files it learned from, by their hashes | `ampco train` | [`motion`] |
//! | `metrics.jsonl` | one line of figures per iteration | the learner | [`metrics`] |
//! | `events.out.tfevents.…` | the same figures for TensorBoard, a file per start | the learner | [`events`] |
//! | `checkpoints/<iteration>/` | everything that an exact continuation needs | learner, actors | [`checkpoint`] |
//! | `evaluation/<suite>/` | reports and figures | `ampco evaluate` | – |
//! | `join/`, `hosts.json`, `hosts.jsonl` | by what other machines join, and which have | the gate | – |
//! | `logs/<process>.log` | the events of one process | that process | [`log`] |
//! | `logs/*.rollouts` | what became of every rollout, where `run.journal` asks for it | learner, actors, who passes rollouts on | [`journal`] |
//! | `<role>.lock` | who is alive in this run | that process | [`roles`] |
//!
//! It is separate from the shells because all of them and the command line share it, and it knows neither messages nor
//! mathematics.
#![forbid(unsafe_code)]

pub mod checkpoint;
pub mod config;
pub mod events;
pub mod folder;
pub mod journal;
pub mod log;
pub mod metrics;
pub mod motion;
pub mod resume;
pub mod roles;
pub mod sections;

mod assignment;
mod replace;

pub use checkpoint::{Checkpoint, CheckpointError, Checkpoints, Contents};
pub use config::{Config, ConfigError};
pub use events::Events;
pub use folder::{Folder, FolderError};
pub use metrics::{Metrics, MetricsError};
pub use replace::{remove_drafts, replace_file};
pub use roles::Lock;
pub use sections::{Deadlines, FleetConfig, Mode, RunConfig};

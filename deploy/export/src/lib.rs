//! A trained policy in the formats of others, as bytes: what a simulator or a robot needs to run it.
//!
//! Separate, and pure, because an export is read by people who have nothing else of ours: what is in it must be
//! complete and must mean the same there as here.
//!
//! | file | what | module |
//! | --- | --- | --- |
//! | `policy.onnx` | observation in, deterministic action out; normalisation inside | [`onnx`] |
//! | in it, as metadata | what a lone `policy.onnx` says of joints, gains, terms and rates | [`metadata`] |
//! | `policy.safetensors` | the same weights under the names of a PyTorch `Sequential` | [`tensors`] |
//! | `deploy.yaml` | the same in the layout of Unitree's controllers | [`deploy_yaml`] |
//! | `policy.json` | joints, gains, observation layout, rates, where it comes from | [`description`] |
//!
//! Writing files is the caller's business.
#![forbid(unsafe_code)]

pub mod deploy_yaml;
pub mod description;
pub mod held;
pub mod metadata;
pub mod network;
pub mod onnx;
pub mod operation;
pub mod tensors;

pub use description::{Description, Origin};
pub use network::Network;

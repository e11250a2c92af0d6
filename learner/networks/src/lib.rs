//! The learner's networks: what is evaluated, differentiated, initialised, optimised and exported.
//!
//! The crate knows multilayer perceptrons, their flat weights and a normalizer; it knows neither rewards nor losses.
//! Weights live in flat vectors, where optimizers, checks, checkpoints and the broadcast read and write them; a
//! [`Mlp`] is a copy on a burn device that computes. Gradients come back into a flat vector of the same layout.
//!
//! | item | subject |
//! | --- | --- |
//! | [`Shape`] | sizes of a perceptron and the layout of its flat weights |
//! | [`Mlp`] | forward, gradients of parameters, gradient with respect to the input |
//! | [`fused`] | products, bias, activation and their derivatives in one pass, as burn operations |
//! | [`orthogonal`] | first weights |
//! | [`Adam`] | the optimizer, with decoupled weight decay |
//! | [`Normalizer`] | running mean and variance |
//! | [`snapshot`] | what actors get: statistics, exploration widths, actor |
//! | [`shards`] | rows divided among threads |
// The one exception is `product`, which hands matrices to a library by pointer.
#![deny(unsafe_code)]

mod adam;
mod device;
mod elu;
mod error;
pub mod fused;
mod gradient;
mod init;
mod kernels;
mod mlp;
mod normalizer;
mod product;
mod shape;
pub mod shards;
pub mod snapshot;

pub use adam::{Adam, AdamConfig, AdamState, Decay};
pub use device::{plain_device, tensor, tracked_device, values};
pub use error::NetworkError;
pub use gradient::{clip_norm, first_not_finite, norm};
pub use init::orthogonal;
pub use mlp::Mlp;
pub use normalizer::{Normalizer, NormalizerState, Scaling};
pub use shape::{Activation, LayerLayout, Shape};

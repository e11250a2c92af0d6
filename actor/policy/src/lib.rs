//! Inference of the policy network from flat weights: batched, without allocation, the same bits every time.
//!
//! The learner trains with a tensor library; an actor only evaluates, thousands of times per second, and wants neither
//! the library's size nor its overhead. So this crate knows one network: observation → normalise and clip → linear
//! layers with ELU between them → mean action, with a Gaussian of given width around it.
//!
//! **Determinism.** Every row of a batch is computed by the same operations in the same order, whatever the batch size,
//! its place in the batch or the width of the machine's vectors (see `kernel`): a row's result has the same bits alone
//! and among 256 others.
//!
//! **Why no matrix library.** The weights change once per rollout and are used hundreds of times in between, so they
//! are packed once. A general product packs and allocates in every call, and picks its kernel by the size of the batch,
//! which changes last bits. The kernel here costs with bias, normalisation and ELU no more than a tenth more than the
//! `gemm` crate's bare product for 16 rows and more, and a third less for one row.
//!
//! **Why not bf16**, where the processor has it. With weights and activations rounded to it, sums in `f32`, the mean actions
//! of a policy that walks and runs are .019 σ off at σ = .08 (rms, 4,096 standard normal rows): a divergence of .0073 from
//! the policy that the learner differentiates, where its iterations end by going .002. It would win no more than a
//! quarter of a microsecond of the eight that a sample costs two cores.
//!
//! Of ours, the number of joints is imported and nothing else: what the policy sees is as wide as its weights say.
#![forbid(unsafe_code)]

mod elu;
mod error;
mod gaussian;
mod kernel;
mod layer;
mod normal;
mod policy;
mod shape;

pub use error::PolicyError;
pub use gaussian::Gaussian;
pub use policy::Policy;
pub use shape::{LayerPlace, OUTPUTS, Shape};

//! How true the physics is: the same cases through every engine, and their errors in one table.
//!
//! Separate, and pure, because engines must not judge themselves. Free motion is compared with a
//! fourth-order solution of the equations of motion, contact with the same engine at a tenth of the
//! step. Another simulator takes part through files: cases out ([`Case`]), traces in ([`Trace`]); it
//! only simulates, and every error is computed here.
//!
//! | subject | file |
//! | --- | --- |
//! | what is simulated | [`case`], [`cases`] |
//! | what came of it | [`trace`] |
//! | the engines, the reference | [`engines`] |
//! | errors of one engine | [`measure`] |
//! | the table | [`table`] |
#![forbid(unsafe_code)]

pub mod case;
pub mod cases;
pub mod engines;
pub mod measure;
pub mod table;
pub mod trace;

pub use case::{Case, Gains};
pub use engines::Engine;
pub use measure::{Row, Traces, rows};
pub use table::markdown;
pub use trace::{Frame, Trace};

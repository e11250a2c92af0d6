//! What policy, critic and discriminator see: lists of named terms, and every size that follows from them.
//!
//! Separate, and below all of them, because the simulation writes what the networks read, the learner mirrors it and an
//! export describes it: a term is said once, and no other crate knows how many numbers an observation has.
//!
//! | subject | file |
//! | --- | --- |
//! | what a term is | [`term`] |
//! | the table of all terms, each in a file by its subject | [`terms`] |
//! | what terms are written from | [`scene`] |
//! | the `[observation]` section | [`config`] |
//! | a list made ready: places, widths, rows, reflection | [`table`] |
//! | the lists of a run together | [`tables`] |
//! | lists that are allowed and odd | [`mod@oddities`] |
//! | two processes' lists compared | [`print`] |
//!
//! A row holds its terms one after another; a term with past frames has its newest first, then the older ones. What a
//! term measures, in its unit, gets noise, is cut to its clip and multiplied by its scale, in this order.
#![forbid(unsafe_code)]

pub mod config;
pub mod oddities;
pub mod print;
mod reflect;
pub mod scene;
pub mod table;
pub mod tables;
pub mod term;
pub mod terms;

pub use config::{JudgedList, ObservationConfig, SeenList, SeenTerm};
pub use print::Print;
pub use scene::{Lot, Scene, Truth};
pub use table::{Entry, Reflection, Table};
pub use tables::{Critic, Place, Places, Tables, Widths};
pub use term::{Kind, Term, Writer};
pub use terms::TERMS;

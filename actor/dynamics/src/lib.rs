//! Many G1 robots per instruction: the dynamics of one known tree, sixteen robots to a register.
//!
//! Separate, and pure, because this is mechanics: it knows the robot's tables and nothing of tasks,
//! observations or learning. It owns no clock, no thread and no file. rapier simulates any scene, one
//! robot at a time, with dense algebra; here the tree is known and the same for every robot, so that
//! no branch depends on a robot and every operation does sixteen at once.
//!
//! | subject | file |
//! | --- | --- |
//! | robots by number: state in and out, advance | [`robots`] |
//! | what acts in the joints | [`drive`] |
//! | what one robot has of its own | [`condition`] |
//! | the ground | [`ground`] |
//! | the tree, contact points | [`tree`] |
//! | rows of sixteen numbers | [`block`] |
//! | the robots of one register | `group` |
//! | one robot in double precision, and its equations of motion | [`reference`] |
//! | one step | `step` |
//! | bodies: place, motion, inertia | `body` |
//! | capsules that meet, and what tells that they are apart | `capsules` |
//! | bias forces and the mass matrix | `kinematics` |
//! | LᵀDL along the tree | `factor` |
//! | contacts | `contact` |
//! | vectors, rotations, inertias | `spatial` |
//! | numbers of many robots | [`lane`] |
#![forbid(unsafe_code)]
#![expect(
    clippy::needless_range_loop,
    clippy::manual_memcpy,
    clippy::reversed_empty_ranges,
    clippy::absurd_extreme_comparisons,
    reason = "loops of known length over arrays stay in registers; iterators and copies made of calls do not"
)]

pub mod block;
mod body;
mod capsules;
pub mod condition;
mod contact;
pub mod drive;
mod factor;
pub mod ground;
mod group;
mod kinematics;
pub mod lane;
pub mod reference;
pub mod robots;
mod spatial;
mod step;
pub mod tree;

pub use block::Build;
pub use condition::Condition;
pub use drive::Motors;
pub use ground::{Ground, Heights};
pub use reference::Reference;
pub use robots::{Effort, Peaks, Robots, Saved, Solver};

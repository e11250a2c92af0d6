//! The two rhythms: physics at 200 Hz, control at 50 Hz.
//!
//! Separate because engines and tasks both count in them, and neither may import the other.

/// Length of a physics step, s: 200 Hz (III-A).
pub const PHYSICS_STEP: f32 = 0.005;
/// Physics steps in a control step: the policy runs at 50 Hz (III-A).
pub const SUBSTEPS: usize = 4;
/// Length of a control step, s.
pub const CONTROL_STEP: f32 = PHYSICS_STEP * SUBSTEPS as f32;

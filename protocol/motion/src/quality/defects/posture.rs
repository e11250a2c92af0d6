//! Robots that are not on their feet.
//!
//! Separate because a robot that lies makes every measure of soles meaningless.

use super::super::Feet;
use super::super::defect::{Defect, Frames, Kind, Severity};
use g1::RobotState;

/// Tilt of the pelvis, as the cosine against up, beyond which a low robot lies: 60°. A bow tilts as far, but on
/// stretched legs.
const TILTED: f32 = 0.5;
/// Height of the pelvis above the lower sole, m, that goes with it: half of standing (0.784 m).
const LOW: f32 = 0.4;
/// Tilt beyond which nobody is on their feet at any height: the head is lower than the pelvis, by 20°.
const UPSIDE_DOWN: f32 = -0.34;
/// Pelvis above the ground, m, below which no squat comes: with its knees at their stop, soles level and the trunk
/// upright it has 0.21 m.
const SITS: f32 = 0.2;
/// Pelvis above the ground, m, below which it is a full squat, or kneeling.
const DOWN: f32 = 0.3;

/// A robot that lies, sits, kneels or squats as low in any frame.
pub(super) fn lying(frames: &[RobotState], feet: &[Feet]) -> Option<Defect> {
    let up = |f: &RobotState| -f.projected_gravity().z;
    let lies = |f: &RobotState, feet: &Feet| {
        let above_soles = f.position.z - feet.low[0].min(feet.low[1]);
        up(f) < TILTED && above_soles < LOW || up(f) < UPSIDE_DOWN
    };
    let mut on_back = false;
    let mut bad = Vec::new();
    for (i, (frame, feet)) in frames.iter().zip(feet).enumerate() {
        let lies = lies(frame, feet);
        if lies || frame.position.z < DOWN {
            on_back |= lies;
            bad.push((i, -f64::from(frame.position.z)));
        }
    }
    let at = Frames::of(&bad)?;
    let frame = &frames[at.worst - 1];
    let height = f64::from(frame.position.z);
    let says = if on_back {
        let tilt = bad
            .iter()
            .map(|&(i, _)| up(&frames[i]))
            .fold(1.0_f32, f32::min);
        format!(
            "lies: the pelvis is tilted by up to {:.0}°, down to {height:.2} m",
            tilt.clamp(-1.0, 1.0).acos().to_degrees()
        )
    } else {
        format!("sits, kneels or squats: the pelvis comes down to {height:.2} m")
    };
    let severity = if on_back || height < f64::from(SITS) {
        Severity::Unfit
    } else {
        Severity::Odd
    };
    Some(Defect::new(Kind::Lying, severity, at, (height, "m"), &says))
}

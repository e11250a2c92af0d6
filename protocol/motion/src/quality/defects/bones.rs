//! Bones of the robot that do not do what the human's did, by the account of retargeting.
//!
//! Separate because a clip alone cannot tell it.

use super::super::defect::{Defect, Frames, Kind, Severity, few};
use retarget::Report;
use retarget::report::BONE_OFF;

/// Share of the frames for which a bone may be off: a fifth of a stride is half of a swing.
const MUCH: f64 = 0.2;

/// Bones that end far off for much of the clip.
pub(super) fn off(report: &Report) -> Option<Defect> {
    let mut off: Vec<_> = report
        .bones_off
        .iter()
        .filter(|bone| bone.frames as f64 > MUCH * report.frames as f64)
        .collect();
    off.sort_by(|a, b| b.by.total_cmp(&a.by));
    // More than a twentieth of all ten bones is half of one of them.
    let Some(worst) = off.first() else {
        return (report.direction_error_95 > BONE_OFF).then(|| {
            let by = report.direction_error_95;
            let says = format!("bones are off the human's by {by:.0}° (95 %)");
            Defect::throughout(Kind::Bones, Severity::Unfit, report.frames, (by, "°"), says)
        });
    };
    let names: Vec<String> = off.iter().map(|bone| bone.bone.clone()).collect();
    let share = worst.frames as f64 / report.frames as f64;
    let frames = Frames {
        first: worst.first,
        last: worst.last,
        worst: worst.worst,
        count: worst.frames,
    };
    let says = format!(
        "bones are off the human's by up to {:.0}°, by more than {BONE_OFF:.0}° in {:.0} % of frames: {}; 95 % of all \
         are within {:.0}°",
        worst.by,
        100.0 * share,
        few(&names),
        report.direction_error_95
    );
    let defect = Defect::new(Kind::Bones, Severity::Unfit, frames, (worst.by, "°"), &says);
    Some(defect.of_joints(names))
}

//! What a source had and import mended: the clip shows it no longer, its account does.
//!
//! Separate because it is judged by what import measured, not by the clip.

use super::super::account;
use super::super::defect::{Defect, Frames, Kind, Severity, few};
use super::ground::Unevenness;
use super::{ground, moves};
use crate::import::{Imported, Jump};
use retarget::Floor;
use std::path::Path;

/// Times its motor's speed beyond which a joint of the source is another motion than the one that is left of it.
const OUTRUN: f64 = 2.0;

/// The defects that the source of a clip had: as import measured them just now, or as they stand beside the file.
pub(crate) fn of(imported: &Imported, file: &Path) -> Vec<Defect> {
    let floor = match &imported.retargeting {
        Some(report) => report.floor.and_then(|floor| uneven(ground::TOES, &floor)),
        None => imported
            .source
            .floor
            .and_then(|floor| uneven(ground::SOLES, &floor)),
    };
    let found = jumps(&imported.source.jumps).into_iter().chain(floor);
    let mut found: Vec<Defect> = found
        .map(|defect| Defect {
            of_source: true,
            ..defect
        })
        .collect();
    let known = account::source_beside(file, imported.clip.frames.len()).unwrap_or_default();
    join(&mut found, &known, false);
    found
}

/// The defects of a clip with those that its source had: of a kind that both have, the worse.
pub(super) fn join(found: &mut Vec<Defect>, source: &[Defect], down: bool) {
    for defect in source {
        // Where the soles of a person on the floor are says nothing about the ground.
        if down && defect.kind == Kind::Drift {
            continue;
        }
        match found.iter_mut().find(|other| other.kind == defect.kind) {
            Some(other) if other.value >= defect.value => {}
            Some(other) => *other = defect.clone(),
            None => found.push(defect.clone()),
        }
    }
}

/// Joints that were slowed, or that no motor would have followed.
fn jumps(jumps: &[Jump]) -> Option<Defect> {
    let severity = |jump: &Jump| {
        let jolts = jump.acceleration > moves::LIMB || jump.reversal > moves::JOLT;
        if jump.times > OUTRUN || jolts {
            Some(Severity::Unfit)
        } else {
            (jump.times > 1.0).then_some(Severity::Odd)
        }
    };
    let mut bad: Vec<(&Jump, Severity)> = jumps
        .iter()
        .filter_map(|jump| Some((jump, severity(jump)?)))
        .collect();
    bad.sort_by(|a, b| b.1.cmp(&a.1).then(b.0.times.total_cmp(&a.0.times)));
    let &(worst, severity) = bad.first()?;
    let names: Vec<String> = bad.iter().map(|(jump, _)| jump.joint.clone()).collect();
    let others = match names.len() {
        1 => String::new(),
        _ => format!("; also {}", few(&names[1..])),
    };
    let says = format!(
        "in the source {} jumps by {:.0}°, {:.1} times what its motor turns in a frame{others}",
        worst.joint,
        worst.angle.to_degrees(),
        worst.times
    );
    let mut at: Vec<(usize, f64)> = bad
        .iter()
        .map(|(jump, _)| (jump.frame - 1, jump.times))
        .collect();
    at.sort_by_key(|(frame, _)| *frame);
    at.dedup_by_key(|(frame, _)| *frame);
    let frames = Frames {
        worst: worst.frame,
        ..Frames::of(&at)?
    };
    let value = (worst.angle, "rad");
    Some(Defect::new(Kind::Jump, severity, frames, value, &says).of_joints(names))
}

fn uneven(limits: Unevenness, floor: &Floor) -> Option<Defect> {
    let says = "in the source the ground under standing feet";
    let places = [floor.lowest, floor.highest].map(|frame| frame.saturating_sub(1));
    ground::uneven(limits, floor.by, places.into(), says)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn jump(times: f64, (acceleration, reversal): (f64, f64)) -> Jump {
        Jump {
            joint: "left_knee_joint".into(),
            frame: 101,
            angle: 0.4 * times,
            times,
            acceleration,
            reversal,
        }
    }

    #[test]
    fn what_outran_its_motor_is_odd_and_what_jumped_is_unfit() {
        let severity = |times, accelerations| {
            let found = jumps(&[jump(times, accelerations)]);
            found.map(|defect| defect.severity)
        };
        let calm = (300.0, 200.0);
        assert_eq!(severity(0.9, calm), None);
        assert_eq!(severity(1.2, calm), Some(Severity::Odd));
        assert_eq!(severity(1.2, (1200.0, 200.0)), Some(Severity::Unfit));
        assert_eq!(severity(1.1, (950.0, 950.0)), Some(Severity::Unfit));
        assert_eq!(severity(2.1, calm), Some(Severity::Unfit));
        let defect = jumps(&[jump(1.2, calm), jump(3.5, (3500.0, 3500.0))]).unwrap();
        assert_eq!((defect.frames.worst, defect.joints.len()), (101, 2));
        for part in ["left_knee_joint jumps by 80°", "3.5 times", "frame"] {
            assert!(defect.says.contains(part), "{}", defect.says);
        }
    }

    #[test]
    fn ground_is_odd_and_unfit_from_twice_as_much_under_toes_as_under_soles() {
        let severity = |limits, by| {
            let floor = Floor {
                by,
                lowest: 150,
                highest: 20,
            };
            uneven(limits, &floor).map(|defect| (defect.kind, defect.severity))
        };
        let (odd, unfit) = ((Kind::Drift, Severity::Odd), (Kind::Drift, Severity::Unfit));
        assert_eq!(severity(ground::SOLES, 0.015), None);
        assert_eq!(severity(ground::SOLES, 0.03), Some(odd));
        assert_eq!(severity(ground::SOLES, 0.06), Some(unfit));
        assert_eq!(severity(ground::TOES, 0.04), None);
        assert_eq!(severity(ground::TOES, 0.06), Some(odd));
        assert_eq!(severity(ground::TOES, 0.11), Some(unfit));
    }
}

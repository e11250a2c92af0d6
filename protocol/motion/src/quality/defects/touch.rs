//! Parts of the robot within each other.
//!
//! Separate because a human's legs that pass each other closely, and hands on hips, are within each other on a robot of
//! other proportions: no motor follows them, and both engines push them apart.

use super::super::defect::{Defect, Frames, Kind, Severity};
use g1::RobotState;
use g1::collision::{PAIR_TABLE, PAIRS, gap, names};
use g1::kinematics::forward_state;

/// Legs that are within each other by more than this do not pass, m: capsules follow the shells to about 1 cm.
const DEEP: f64 = 0.02;

/// Pairs of parts that are within each other, the deepest first.
pub(super) fn of(frames: &[RobotState]) -> Option<Defect> {
    let mut deepest = [0.0_f64; PAIRS];
    let mut bad = Vec::new();
    for (i, frame) in frames.iter().enumerate() {
        let bodies = forward_state(frame);
        let mut within = 0.0;
        for (pair, deepest) in deepest.iter_mut().enumerate() {
            let depth = -f64::from(gap(&bodies, pair).distance);
            *deepest = deepest.max(depth);
            within = depth.max(within);
        }
        if within > 0.0 {
            bad.push((i, within));
        }
    }
    let at = Frames::of(&bad)?;
    let mut pairs: Vec<usize> = (0..PAIRS).filter(|&pair| deepest[pair] > 0.0).collect();
    pairs.sort_by(|&a, &b| deepest[b].total_cmp(&deepest[a]));
    let most = deepest[pairs[0]];
    // An arm that is kept off the body still shows the motion.
    let legs = |pair: &&usize| names(**pair).iter().all(|part| !part.ends_with("forearm"));
    let blocked = pairs.iter().filter(legs).any(|&pair| deepest[pair] > DEEP);
    let severity = if blocked {
        Severity::Unfit
    } else {
        Severity::Odd
    };
    let [a, b] = names(pairs[0]);
    let says = match pairs.len() {
        1 => format!("{a} and {b} are {most:.3} m within each other"),
        many => format!(
            "{a} and {b} are {most:.3} m within each other, and {} more of {} pairs touch",
            many - 1,
            PAIR_TABLE.len()
        ),
    };
    let mut parts: Vec<String> = Vec::new();
    for part in pairs.into_iter().flat_map(names) {
        if !parts.iter().any(|known| known == part) {
            parts.push(part.into());
        }
    }
    Some(Defect::new(Kind::Touch, severity, at, (most, "m"), &says).of_joints(parts))
}

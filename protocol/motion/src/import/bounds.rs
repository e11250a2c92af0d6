//! Holds joints within their limits and their motors' speeds.
//!
//! Separate because a spline between rows may leave both, and files come from robots, solvers and
//! people that knew neither.

use super::{Jump, Row};
use crate::clip::FRAME_SECONDS;
use g1::JOINT_TABLE;

/// Distance that is kept from a limit that would be passed, rad: six digits are written, `f32` rounds.
const MARGIN: f64 = 1e-6;
/// Share of the motor's speed at which a joint is too fast, and the share that it is slowed to: what was
/// slowed is not slowed again.
const TOO_FAST: f64 = 0.999;
const SLOWED: f64 = 0.95;

/// Moves joints of rows at 50 Hz as little as it takes to stay within limits and speeds; says which, and gives what each
/// joint that it moved did before.
pub(super) fn hold(rows: &mut [Row], decisions: &mut Vec<String>) -> Vec<Jump> {
    let (mut at_limit, mut at_speed) = (Vec::new(), Vec::new());
    let mut jumps = Vec::new();
    for (j, joint) in JOINT_TABLE.iter().enumerate() {
        let raw: Vec<f64> = rows.iter().map(|row| row.joints[j]).collect();
        let mut held: Vec<f64> = raw
            .iter()
            .map(|q| q.clamp(joint.lower + MARGIN, joint.upper - MARGIN))
            .collect();
        let beyond = raw.iter().zip(&held).map(|(a, b)| (a - b).abs());
        let beyond = beyond.fold(0.0, f64::max);
        if beyond > 2.0 * MARGIN {
            at_limit.push(format!("{} (by {:.1}°)", joint.name, beyond.to_degrees()));
        }
        let reach = joint.velocity_limit * FRAME_SECONDS;
        let steps = held.windows(2).map(|pair| (pair[1] - pair[0]).abs());
        let fastest = steps.fold(0.0, f64::max);
        if fastest > TOO_FAST * reach {
            at_speed.push(format!("{} (of {:.1} times)", joint.name, fastest / reach));
            held = slowed(&held, SLOWED * reach);
        }
        if fastest > TOO_FAST * reach || beyond > 2.0 * MARGIN {
            jumps.extend(jump(joint.name, &raw, reach));
        }
        for (row, q) in rows.iter_mut().zip(held) {
            row.joints[j] = q;
        }
    }
    if !at_limit.is_empty() {
        decisions.push(format!("held at their limits: {}", at_limit.join(", ")));
    }
    if !at_speed.is_empty() {
        let slowed = at_speed.join(", ");
        decisions.push(format!("slowed to their motors' speeds: {slowed}"));
    }
    jumps
}

/// The greatest step of a joint that its motor moves by `reach` in a frame, rad.
fn jump(joint: &str, series: &[f64], reach: f64) -> Option<Jump> {
    let step = |i: usize| series[i] - series[i - 1];
    let worst = (1..series.len()).max_by(|&i, &j| step(i).abs().total_cmp(&step(j).abs()))?;
    let changes: Vec<f64> = (2..series.len())
        .map(|i| (step(i) - step(i - 1)) / (FRAME_SECONDS * FRAME_SECONDS))
        .collect();
    let reversals = changes
        .windows(2)
        .filter(|pair| pair[0] * pair[1] < 0.0)
        .map(|pair| pair[0].abs().min(pair[1].abs()));
    Some(Jump {
        joint: joint.into(),
        frame: worst + 1,
        angle: step(worst).abs(),
        times: step(worst).abs() / reach,
        acceleration: changes.iter().fold(0.0, |most, a| a.abs().max(most)),
        reversal: reversals.fold(0.0, f64::max),
    })
}

/// A series whose steps are at most `reach`: half way between the greatest such series below and the
/// least such above. Where the series is slow for long enough it stays as it is; a jump becomes a ramp
/// about its middle. It never leaves the range of the series.
fn slowed(series: &[f64], reach: f64) -> Vec<f64> {
    let bound = |tighter: fn(f64, f64) -> f64, step: f64| {
        let mut bound = series.to_vec();
        for i in 1..bound.len() {
            bound[i] = tighter(bound[i], bound[i - 1] + step);
        }
        for i in (1..bound.len()).rev() {
            bound[i - 1] = tighter(bound[i - 1], bound[i] + step);
        }
        bound
    };
    let (below, above) = (bound(f64::min, reach), bound(f64::max, -reach));
    below
        .iter()
        .zip(above)
        .map(|(a, b)| (a + b) / 2.0)
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use g1::DEFAULT_POSE;
    use nalgebra::{UnitQuaternion, Vector3};

    /// Rows in the default pose but for one joint.
    fn moving(joint: usize, series: &[f64]) -> Vec<Row> {
        let row = |q: &f64| {
            let mut joints = DEFAULT_POSE.map(f64::from);
            joints[joint] = *q;
            Row {
                position: Vector3::zeros(),
                orientation: UnitQuaternion::identity(),
                joints,
                dropped: [0.0; 6],
            }
        };
        series.iter().map(row).collect()
    }

    #[test]
    fn a_jump_becomes_a_ramp_about_its_middle() {
        // 0 to 1 in steps of 0.4: below comes 0.4 a step from the last 0, above goes 0.4 a step to the
        // first 1; between the last 0 and the first 1 both meet their fellow half way.
        let jump = [0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 1.0];
        let below = [0.0, 0.0, 0.0, 0.0, 0.4, 0.8, 1.0, 1.0];
        let above = [0.0, 0.0, 0.2, 0.6, 1.0, 1.0, 1.0, 1.0];
        let expected = std::array::from_fn::<f64, 8, _>(|i| (below[i] + above[i]) / 2.0);
        for (a, b) in slowed(&jump, 0.4).iter().zip(expected) {
            assert!((a - b).abs() < 1e-12, "{a} is not {b}");
        }
        let slow = [0.0, 0.3, 0.1, 0.4];
        assert_eq!(slowed(&slow, 0.4), slow);
        assert_eq!(slowed(&[2.0], 0.4), [2.0]);
    }

    #[test]
    fn joints_stay_within_limits_and_speeds_and_only_once() {
        // Left ankle roll: ±0.2618 rad, 30 rad/s, so 0.6 rad a frame; left knee: 20 rad/s, 0.4 rad.
        for (joint, series) in [
            (5, vec![0.0, 0.2, 0.3, -0.5, 0.2618, 0.0]),
            (3, vec![0.1, 0.1, 1.1, 0.1, 0.1, 2.9, 2.9]),
        ] {
            let mut rows = moving(joint, &series);
            let mut decisions = Vec::new();
            hold(&mut rows, &mut decisions);
            let table = &JOINT_TABLE[joint];
            for row in &rows {
                let q = f64::from(row.joints[joint] as f32);
                assert!((table.lower..=table.upper).contains(&q), "{q}");
            }
            for pair in rows.windows(2) {
                let step = (pair[1].joints[joint] - pair[0].joints[joint]).abs();
                assert!(step <= table.velocity_limit * 0.02, "{step}");
            }
            assert!(decisions[0].starts_with("held at their limits: left_"));
            let once = rows.clone();
            hold(&mut rows, &mut Vec::new());
            assert_eq!(rows, once);
        }
        // −0.5 is 0.2382 rad, 13.6°, beyond −0.2618.
        let mut decisions = Vec::new();
        hold(&mut moving(5, &[0.0, -0.25, -0.5]), &mut decisions);
        assert_eq!(
            decisions,
            ["held at their limits: left_ankle_roll_joint (by 13.6°)"]
        );
        // 1 rad a frame is 2.5 times the knee's 0.4.
        decisions.clear();
        let jumps = hold(&mut moving(3, &[0.1, 0.1, 1.1, 1.1]), &mut decisions);
        let [jump] = jumps.as_slice() else {
            panic!("{jumps:?}");
        };
        assert_eq!((jump.joint.as_str(), jump.frame), ("left_knee_joint", 3));
        assert!((jump.angle - 1.0).abs() < 1e-9 && (jump.times - 2.5).abs() < 1e-9);
        // 1 rad over (0.02 s)², and back in the next frame.
        assert!((jump.acceleration - 2500.0).abs() < 1e-6);
        assert!((jump.reversal - 2500.0).abs() < 1e-6);
        assert_eq!(
            decisions,
            ["slowed to their motors' speeds: left_knee_joint (of 2.5 times)"]
        );
    }

    #[test]
    fn what_is_within_bounds_is_not_touched() {
        let series = [0.1, 0.45, 0.8, 1.0, 0.8];
        let (mut rows, mut decisions) = (moving(3, &series), Vec::new());
        let before = rows.clone();
        hold(&mut rows, &mut decisions);
        assert_eq!((rows, decisions.len()), (before, 0));
    }
}

//! What the waist of the 29-joint robot does, done without it.
//!
//! Separate because it is the one thing that is lost between the two robots and not just left out: without
//! roll and pitch of the waist a bow is a walk upright. As in retargeting, the pelvis takes the lean of the
//! trunk: it turns about the middle of its hip joints until the torso stands as it stood, and the legs are
//! solved anew, so that the feet stay where they were.

use super::Row;
use super::joints::DROPPED;
use super::leg::{LEGS, base, feet, solve_leg};
use g1::joints::{LEFT_LEG, WAIST};
use g1::kinematics::forward;
use g1::{JOINT_TABLE, JOINTS};
use nalgebra::{Isometry3, UnitQuaternion, Vector3};
use retarget::signal;

/// Less than this of a joint that is left out is not worth a word, rad.
const NOTICED: f64 = 5.0 * std::f64::consts::PI / 180.0;
/// Waist roll and waist pitch in [`DROPPED`]; wrists after them.
const WAIST_JOINTS: std::ops::Range<usize> = 0..2;
/// The middle of the hip pitch joints in the pelvis frame, m: about it a bow needs hip pitch only.
const PIVOT: Vector3<f64> = Vector3::new(0.0, 0.0, JOINT_TABLE[LEFT_LEG].origin[2]);
/// A foot that is out of reach by less is not worth lowering the pelvis, m.
const OUT_OF_REACH: f64 = 1e-4;
/// Rounds of lowering the pelvis, and frames over which that is smoothed, to both sides.
const ROUNDS: usize = 4;
const SMOOTH: usize = 5;

/// Puts the lean of the waist into the pelvis and says what became of the joints that the robot lacks.
///
/// Rows are at 50 Hz; their dropped joints are 0 afterwards.
pub(super) fn into_pelvis(rows: &mut [Row], decisions: &mut Vec<String>) {
    let reach = |k: usize| {
        rows.iter()
            .map(|row| row.dropped[k].abs())
            .fold(0.0, f64::max)
    };
    let reached: [f64; DROPPED.len()] = std::array::from_fn(reach);
    let named = |k: usize| format!("{} ({:.0}°)", DROPPED[k], reached[k].to_degrees());
    let waist: Vec<String> = WAIST_JOINTS
        .filter(|&k| reached[k] > 0.0)
        .map(named)
        .collect();
    if !waist.is_empty() {
        let Moved { feet, lowered } = lean(rows);
        decisions.push(format!(
            "{}: this robot has no such joint; the lean went into the pelvis (lowered by up to {:.1} mm), \
             the legs follow (feet move by up to {:.1} mm)",
            waist.join(", "),
            1000.0 * lowered,
            1000.0 * feet
        ));
    }
    let left_out: Vec<String> = (WAIST_JOINTS.end..DROPPED.len())
        .filter(|&k| reached[k] > NOTICED)
        .map(named)
        .collect();
    left_out_joints(&left_out, decisions);
    for row in rows {
        row.dropped = [0.0; DROPPED.len()];
    }
}

/// Says which joints of a file the G1 does not have at all.
pub(super) fn say_others(others: &[(String, f64)], decisions: &mut Vec<String>) {
    let left_out: Vec<String> = others
        .iter()
        .filter(|(_, reached)| *reached > NOTICED)
        .map(|(name, reached)| format!("{name} ({:.0}°)", reached.to_degrees()))
        .collect();
    left_out_joints(&left_out, decisions);
}

fn left_out_joints(named: &[String], decisions: &mut Vec<String>) {
    if !named.is_empty() {
        let named = named.join(", ");
        decisions.push(format!("{named}: this robot has no such joint; left out"));
    }
}

/// How far feet and pelvis moved at most, m.
struct Moved {
    feet: f64,
    lowered: f64,
}

fn lean(rows: &mut [Row]) -> Moved {
    let goals: Vec<[Isometry3<f64>; 2]> = rows.iter().map(feet).collect();
    let before: Vec<[f64; JOINTS]> = rows.iter().map(|row| row.joints).collect();
    for row in rows.iter_mut() {
        let turn = row.orientation * lean_of(row);
        row.position += row.orientation * PIVOT - turn * PIVOT;
        row.orientation = turn;
    }
    let mut lowered = vec![0.0; rows.len()];
    for _ in 0..ROUNDS {
        let needs: Vec<f64> = (0..rows.len())
            .map(|i| {
                rows[i].joints = before[i];
                solve(&mut rows[i], &goals[i])
            })
            .collect();
        if needs.iter().all(|need| *need <= OUT_OF_REACH) {
            break;
        }
        let lower = signal::envelope(&needs, SMOOTH);
        for ((row, lower), sum) in rows.iter_mut().zip(lower).zip(&mut lowered) {
            row.position.z -= lower;
            *sum += lower;
        }
    }
    let moved = rows.iter_mut().zip(&goals).map(|(row, goals)| {
        solve(row, goals);
        let away =
            |k: usize| (feet(row)[k].translation.vector - goals[k].translation.vector).norm();
        away(0).max(away(1))
    });
    Moved {
        feet: moved.fold(0.0, f64::max),
        lowered: lowered.into_iter().fold(0.0, f64::max),
    }
}

/// The turn of the torso against a pelvis that has only yaw, in the pelvis frame: the waist's joints follow
/// each other as yaw, roll, pitch.
fn lean_of(row: &Row) -> UnitQuaternion<f64> {
    let yaw = UnitQuaternion::from_euler_angles(0.0, 0.0, row.joints[WAIST]);
    let roll = UnitQuaternion::from_euler_angles(row.dropped[0], 0.0, 0.0);
    let pitch = UnitQuaternion::from_euler_angles(0.0, row.dropped[1], 0.0);
    yaw * roll * pitch * yaw.inverse()
}

/// Solves both legs for where the feet must be; returns by how much the pelvis is too high, m.
fn solve(row: &mut Row, goals: &[Isometry3<f64>; 2]) -> f64 {
    let base = base(row);
    let mut need: f64 = 0.0;
    for ((first, foot), goal) in LEGS.into_iter().zip(goals) {
        solve_leg(&base, &mut row.joints, (first, foot), goal);
        let bodies = forward(&base, &row.joints);
        let hip = bodies[first + 1].translation.vector;
        let way = (goal.translation.vector - hip).normalize();
        let short = (goal.translation.vector - bodies[foot].translation.vector).dot(&way);
        need = need.max(short / way.z.abs().max(0.5));
    }
    need
}

#[cfg(test)]
#[path = "lean_tests.rs"]
mod tests;

//! Measures of a clip, by forward kinematics of its frames.

use crate::clip::{Clip, FRAME_SECONDS};
use g1::kinematics::{forward_state, lowest_sole_point, sole_points};
use g1::{LEFT_FOOT, RIGHT_FOOT, RobotState};
use nalgebra::Point2;

/// A sole below this is on the ground, m.
const TOUCHING: f32 = 2e-3;

/// The frames of a clip, a cyclic one's repeated so that every frame has two neighbours.
pub(super) fn successive(clip: &Clip) -> Vec<RobotState> {
    let mut frames = clip.unrolled(1.5 * clip.seconds()).frames;
    if clip.cyclic {
        frames.truncate(clip.frames.len() + 2);
    }
    frames
}

/// Root mean square of the slowest sole corner's speed while a foot is on the ground, m/s.
pub(super) fn stance_slip(clip: &Clip, foot: usize) -> f32 {
    let corners = |f: &RobotState| sole_points(&forward_state(f), foot);
    let soles: Vec<_> = successive(clip).iter().map(corners).collect();
    let (mut sum, mut count) = (0.0, 0);
    for pair in soles.windows(2).take(clip.transitions()) {
        let [a, b] = pair else { unreachable!() };
        let touching = |corner: &usize| a[*corner].z < TOUCHING && b[*corner].z < TOUCHING;
        // The corner that stays down longest is the one that bears; a rolling sole has others move.
        let speed = (0..4)
            .filter(touching)
            .map(|c| (b[c] - a[c]).norm() / FRAME_SECONDS as f32)
            .reduce(f32::min);
        if let Some(speed) = speed {
            sum += speed * speed;
            count += 1;
        }
    }
    assert!(count > 0, "{} never stands", clip.name);
    (sum / count as f32).sqrt()
}

/// Share of frames in which any of the feet is within 2 mm of the ground.
pub(super) fn duty(clip: &Clip, feet: &[usize]) -> f32 {
    let down = |f: &&RobotState| {
        feet.iter()
            .any(|&foot| lowest_sole_point(&forward_state(f), foot) < TOUCHING)
    };
    clip.frames.iter().filter(down).count() as f32 / clip.frames.len() as f32
}

/// Height of the sole's lowest point in the middle of swing, the least of all swings, m.
pub(super) fn clearance(clip: &Clip, foot: usize) -> f32 {
    let frames = clip.unrolled(2.0 * clip.seconds()).frames;
    let height = |f: &RobotState| lowest_sole_point(&forward_state(f), foot);
    let heights: Vec<f32> = frames.iter().map(height).collect();
    let swings = heights.split(|height| *height < TOUCHING);
    // Whole swings only: none that the clip's ends cut off, none that is a frame at the threshold.
    let first = heights.iter().position(|h| *h < TOUCHING).unwrap_or(0);
    let last = heights.iter().rposition(|h| *h < TOUCHING).unwrap_or(0);
    let whole = |swing: &&[f32]| {
        let begin = (swing.as_ptr() as usize - heights.as_ptr() as usize) / size_of::<f32>();
        swing.len() > 2 && begin > first && begin < last
    };
    swings
        .filter(whole)
        .map(|swing| swing[swing.len() / 2])
        .reduce(f32::min)
        .unwrap_or(0.0)
}

/// Least distance between the outlines of the two soles, seen from above, m.
pub(super) fn gap(clip: &Clip) -> f32 {
    let distance = |f: &RobotState| {
        let bodies = forward_state(f);
        let [left, right] =
            [LEFT_FOOT, RIGHT_FOOT].map(|foot| outline(&sole_points(&bodies, foot)));
        let apart = |a: &[Point2<f32>; 4], b: &[Point2<f32>; 4]| {
            let edges = (0..4).map(|i| (b[i], b[(i + 1) % 4]));
            edges
                .flat_map(|edge| a.map(|corner| to_edge(&corner, edge)))
                .fold(f32::INFINITY, f32::min)
        };
        apart(&left, &right).min(apart(&right, &left))
    };
    clip.frames
        .iter()
        .map(distance)
        .fold(f32::INFINITY, f32::min)
}

/// Corners in the order around the sole.
fn outline(corners: &[nalgebra::Point3<f32>; 4]) -> [Point2<f32>; 4] {
    [0, 1, 3, 2].map(|i: usize| corners[i].xy())
}

fn to_edge(point: &Point2<f32>, (a, b): (Point2<f32>, Point2<f32>)) -> f32 {
    let along = b - a;
    let share = ((point - a).dot(&along) / along.norm_squared()).clamp(0.0, 1.0);
    (point - (a + along * share)).norm()
}

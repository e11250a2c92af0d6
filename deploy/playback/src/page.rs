//! The page: template, style, renderer and recording in one file that needs nothing else.
//!
//! Separate from the recording because this is for eyes only. Poses of all bodies are computed here, by the kinematics
//! that the rest of the project uses, so the page knows no robot: it draws shapes where it is told.

use g1::shapes::{self, Shape};
use g1::{BODIES, JOINTS, kinematics};
use serde_json::{Value, json};

use crate::recording::{Frame, Recording};

const TEMPLATE: &str = include_str!("page/page.html");
const STYLE: &str = include_str!("page/page.css");
const SCENE: &str = include_str!("page/scene.js");
const TRACES: &str = include_str!("page/traces.js");
const PLAYER: &str = include_str!("page/player.js");

/// Steps in a metre and in a unit of a quaternion: 0.1 mm, and 0.1 mm at an arm's length.
const RESOLUTION: f32 = 1e4;

/// The page that plays a recording.
///
/// # Panics
/// If the recording has no frame, or a frame has not 23 joints.
pub fn html(recording: &Recording) -> String {
    assert!(!recording.frames.is_empty(), "there is something to play");
    // Inside a script element only this sequence could end it.
    let data = data(recording).to_string().replace("</", "<\\/");
    TEMPLATE
        .replace("{{title}}", &escape(&recording.title))
        .replace("{{source}}", &escape(&recording.source))
        .replace("{{style}}", STYLE)
        .replace("{{script}}", &[SCENE, TRACES, PLAYER].concat())
        // Last, so that nothing in the recording is taken for a place of the template.
        .replace("{{data}}", &data)
}

fn data(recording: &Recording) -> Value {
    let frames = &recording.frames;
    let mut positions = Vec::with_capacity(frames.len() * BODIES * 3);
    let mut rotations = Vec::with_capacity(frames.len() * BODIES * 4);
    for frame in frames {
        for body in kinematics::forward_state(&state(frame)) {
            let q = body.rotation;
            positions.extend(body.translation.vector.iter().map(|x| steps(*x)));
            rotations.extend([q.w, q.i, q.j, q.k].map(steps));
        }
    }
    let column = |of: fn(&Frame) -> [f32; 3]| -> Vec<Value> {
        frames
            .iter()
            .flat_map(of)
            .map(|x| json!((x * 1e3).round() / 1e3))
            .collect()
    };
    let forces: Option<Vec<i64>> = frames
        .iter()
        .map(|frame| frame.foot_forces.map(|pair| pair.map(|x| x.round() as i64)))
        .collect::<Option<Vec<_>>>()
        .map(|pairs| pairs.concat());
    json!({
        "frameSeconds": recording.frame_seconds,
        "count": frames.len(),
        "resolution": RESOLUTION,
        "bodies": (0..BODIES).map(|body| shapes::of(body).iter().map(shape).collect()).collect::<Vec<Value>>(),
        "feet": [g1::LEFT_FOOT, g1::RIGHT_FOOT],
        "positions": positions,
        "rotations": rotations,
        "command": column(|frame| frame.command),
        "velocity": column(|frame| frame.velocity),
        "forces": forces,
    })
}

fn state(frame: &Frame) -> g1::RobotState {
    let joints = |values: &[f32]| -> [f32; JOINTS] {
        values.try_into().expect("a number for each of 23 joints")
    };
    let [w, i, j, k] = frame.orientation;
    let mut state = g1::RobotState::standing();
    state.position = frame.position.into();
    state.orientation = g1::state::quaternion(w, i, j, k);
    state.joint_positions = joints(&frame.joint_positions);
    state
}

fn steps(x: f32) -> i64 {
    (x * RESOLUTION).round() as i64
}

fn shape(shape: &Shape) -> Value {
    match shape {
        Shape::Capsule { from, to, radius } => json!({ "from": from, "to": to, "radius": radius }),
        Shape::Box {
            centre,
            half_extents,
        } => json!({ "centre": centre, "half": half_extents }),
    }
}

fn escape(text: &str) -> String {
    text.replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('>', "&gt;")
        .replace('"', "&quot;")
}

#[cfg(test)]
mod tests {
    use super::*;
    use g1::RobotState;

    fn standing() -> Recording {
        Recording {
            title: "a <b> </script> & {{data}}".to_owned(),
            source: "test".to_owned(),
            frame_seconds: 0.02,
            fell_at: None,
            frames: vec![Frame::of(&RobotState::standing(), [0.0; 3]); 3],
        }
    }

    #[test]
    fn the_page_is_whole_and_names_cannot_break_it() {
        let page = html(&standing());
        assert!(page.contains("a &lt;b&gt; &lt;/script&gt;"));
        assert_eq!(page.matches("</script>").count(), 2);
        for forbidden in [
            "http://",
            "https://",
            "src=",
            "import ",
            "{{style}}",
            "{{script}}",
        ] {
            assert!(!page.contains(forbidden), "{forbidden} in the page");
        }
    }

    #[test]
    fn poses_are_those_of_the_kinematics() {
        let data = data(&standing());
        // The first body of the first frame is the pelvis at standing height, 0.7842 m.
        assert_eq!(data["positions"][2], 7842);
        assert_eq!(data["rotations"][0], 10_000);
        assert_eq!(data["positions"].as_array().unwrap().len(), 3 * 24 * 3);
        // The ankle is 35 mm above the sole, which stands on the ground.
        assert_eq!(data["positions"][g1::LEFT_FOOT * 3 + 2], 350);
        assert_eq!(data["forces"], Value::Null);
    }
}

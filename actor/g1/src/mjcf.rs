//! The same robot written as MJCF, for MuJoCo.
//!
//! Separate because it is for another program: tables out, nothing in. The feet collide with the
//! floor as in our engines, and nothing else collides; all other settings are MuJoCo's defaults.

use crate::links::{FOOT_CENTRE, FOOT_HALF_EXTENTS};
use crate::state::STANDING_HEIGHT;
use crate::{JOINT_TABLE, LEFT_FOOT, LINK_TABLE, RIGHT_FOOT};
use nalgebra::UnitQuaternion;
use std::fmt::Write;

/// The robot on a plane as an MJCF document, with a position actuator of the robot's gains and limit
/// for every joint, in the order of the table.
pub fn document() -> String {
    let mut bodies = String::new();
    body(0, &mut bodies);
    let mut motors = String::new();
    for joint in &JOINT_TABLE {
        let (name, effort) = (joint.name, joint.effort);
        let _ = writeln!(
            motors,
            r#"<position name="{name}" joint="{name}" kp="{}" kv="{}" forcelimited="true" forcerange="-{effort} {effort}"/>"#,
            joint.kp, joint.kd
        );
    }
    format!(
        r#"<mujoco model="g1">
<compiler angle="radian" inertiafromgeom="false"/>
<option timestep="0.005" integrator="implicitfast"/>
<worldbody>
<geom name="floor" type="plane" size="50 50 1"/>
{bodies}</worldbody>
<actuator>
{motors}</actuator>
</mujoco>
"#
    )
}

/// A body and all that it carries.
fn body(index: usize, out: &mut String) {
    let link = &LINK_TABLE[index];
    let _ = write!(out, r#"<body name="{}""#, link.name);
    if index == 0 {
        let _ = writeln!(out, r#" pos="0 0 {STANDING_HEIGHT}"><freejoint/>"#);
    } else {
        let joint = &JOINT_TABLE[index - 1];
        let [roll, pitch, yaw] = joint.rpy;
        let q = UnitQuaternion::from_euler_angles(roll, pitch, yaw);
        let _ = writeln!(
            out,
            r#" pos="{}" quat="{}"><joint name="{}" axis="{}" range="{} {}" armature="{}"/>"#,
            list(&joint.origin),
            list(&[q.w, q.i, q.j, q.k]),
            joint.name,
            list(&joint.axis),
            joint.lower,
            joint.upper,
            joint.armature
        );
    }
    let _ = writeln!(
        out,
        r#"<inertial pos="{}" mass="{}" fullinertia="{}"/>"#,
        list(&link.com),
        link.mass,
        list(&link.inertia)
    );
    if index == LEFT_FOOT || index == RIGHT_FOOT {
        let _ = writeln!(
            out,
            r#"<geom name="{}" type="box" pos="{}" size="{}"/>"#,
            link.name,
            list(&FOOT_CENTRE),
            list(&FOOT_HALF_EXTENTS)
        );
    }
    for (child, link) in LINK_TABLE.iter().enumerate() {
        if link.parent == Some(index) {
            body(child, out);
        }
    }
    out.push_str("</body>\n");
}

fn list(numbers: &[f64]) -> String {
    let words: Vec<_> = numbers.iter().map(f64::to_string).collect();
    words.join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{BODIES, JOINTS};

    #[test]
    fn every_body_joint_and_motor_is_there_in_order() {
        let document = document();
        assert_eq!(document.matches("<body ").count(), BODIES);
        assert_eq!(document.matches("</body>").count(), BODIES);
        assert_eq!(document.matches("type=\"box\"").count(), 2);
        let places = JOINT_TABLE.map(|joint| {
            let words = format!("<joint name=\"{}\"", joint.name);
            document.find(&words).expect("every joint")
        });
        assert!(places.is_sorted(), "depth first is the order of the table");
        assert_eq!(document.matches("<position ").count(), JOINTS);
        assert!(document.contains(r#"range="-0.087267 2.8798""#)); // the left knee
    }
}

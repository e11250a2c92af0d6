//! The same robot as MJCF, for MuJoCo: written from the tables that the simulation is built from.
//!
//! Separate because it is a translation and knows MuJoCo's words, nothing else here does. What acts is chosen so that
//! a model of the file moves like the robot of the simulation:
//!
//! | here | in the file |
//! | --- | --- |
//! | τ = kp·(target − q) − kd·q̇, at most the effort | `position` actuators with `forcerange`; `implicitfast` takes kd at the end of the step |
//! | only soles touch the floor | `contype`/`conaffinity`; friction is the sole's, by `priority` |
//! | limbs and trunk meet in the pairs of [`collision`], without friction | capsules of group 3, a `pair` of `condim` 1 for each |
//! | rotor inertia at the joint | `armature` |
//! | bodies as drawn | geoms of group 1 without mass or contact |
//!
//! Format: <https://mujoco.readthedocs.io/en/stable/XMLreference.html>.

use crate::collision::{self, CAPSULE_TABLE, PAIRS};
use crate::links::{FOOT_CENTRE, FOOT_HALF_EXTENTS, LEFT_FOOT, PELVIS, RIGHT_FOOT};
use crate::shapes::{self, Shape};
use crate::state::STANDING_HEIGHT;
use crate::{BODIES, JOINT_TABLE, LINK_TABLE};
use std::fmt::Write;

/// How the model is stepped.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Physics {
    /// Length of a physics step, s.
    pub timestep: f64,
    /// Gravitational acceleration, m/s².
    pub gravity: f64,
    /// Friction coefficient between soles and floor.
    pub friction: f64,
    /// Whether limbs and trunk meet each other; they pass through each other otherwise.
    pub self_collision: bool,
}

/// Name of the keyframe in which the robot stands in its default pose, soles on the floor.
pub const KEYFRAME: &str = "standing";

/// The model as a document. Joints and actuators come in the order of [`JOINT_TABLE`].
pub fn document(physics: &Physics) -> String {
    let mut out = String::with_capacity(32_000);
    head(physics, &mut out).expect("a string takes all that is written");
    body(PELVIS, physics, 2, &mut out).expect("a string takes all that is written");
    out.push_str("  </worldbody>\n");
    if physics.self_collision {
        pairs(&mut out).expect("a string takes all that is written");
    }
    tail(&mut out).expect("a string takes all that is written");
    out
}

fn head(physics: &Physics, out: &mut String) -> std::fmt::Result {
    let Physics {
        timestep, gravity, ..
    } = physics;
    write!(
        out,
        r#"<mujoco model="g1_23dof">
  <!-- Unitree G1 with 23 joints. Masses, inertias, frames, limits: Unitree's g1_23dof_rev_1_0.urdf, BSD-3-Clause.
       Gains, armature, default pose: unitree_rl_lab, Apache-2.0. SI units. -->
  <compiler angle="radian" eulerseq="XYZ" inertiafromgeom="false"/>
  <option timestep="{timestep}" gravity="0 0 -{gravity}" integrator="implicitfast" cone="elliptic"/>
  <statistic extent="1.5" center="0 0 0.7"/>
  <visual>
    <global offwidth="1920" offheight="1080"/>
    <headlight ambient="0.35 0.35 0.35" diffuse="0.45 0.45 0.45"/>
  </visual>
  <asset>
    <texture type="skybox" builtin="gradient" rgb1="0.93 0.95 0.96" rgb2="0.72 0.78 0.85" width="64" height="64"/>
    <texture name="grid" type="2d" builtin="checker" width="256" height="256" rgb1="0.86 0.88 0.9" rgb2="0.76 0.79 0.83"/>
    <material name="grid" texture="grid" texrepeat="1 1" texuniform="true"/>
  </asset>
  <worldbody>
    <light pos="0 0 4" dir="0.2 0.3 -1" directional="true"/>
    <geom name="floor" type="plane" size="0 0 0.1" material="grid" contype="1" conaffinity="0"/>
"#
    )
}

/// A body with all that hangs on it.
fn body(index: usize, physics: &Physics, depth: usize, out: &mut String) -> std::fmt::Result {
    let link = &LINK_TABLE[index];
    let pad = "  ".repeat(depth);
    if index == PELVIS {
        writeln!(
            out,
            r#"{pad}<body name="{}" pos="0 0 {STANDING_HEIGHT}">
{pad}  <freejoint name="floating_base"/>"#,
            link.name
        )?;
    } else {
        let joint = &JOINT_TABLE[index - 1];
        writeln!(
            out,
            r#"{pad}<body name="{}" pos="{}" euler="{}">
{pad}  <joint name="{}" axis="{}" range="{} {}" armature="{}"/>"#,
            link.name,
            numbers(&joint.origin),
            numbers(&joint.rpy),
            joint.name,
            numbers(&joint.axis),
            joint.lower,
            joint.upper,
            joint.armature,
        )?;
    }
    writeln!(
        out,
        r#"{pad}  <inertial pos="{}" mass="{}" fullinertia="{}"/>"#,
        numbers(&link.com),
        link.mass,
        numbers(&link.inertia)
    )?;
    if index == LEFT_FOOT || index == RIGHT_FOOT {
        writeln!(
            out,
            r#"{pad}  <geom name="{}_sole" type="box" pos="{}" size="{}" friction="{} 0.005 0.0001" condim="3" priority="1" contype="0" conaffinity="1" group="1" rgba="0.15 0.16 0.2 1"/>"#,
            link.name,
            numbers(&FOOT_CENTRE),
            numbers(&FOOT_HALF_EXTENTS),
            physics.friction
        )?;
    } else {
        for shape in shapes::of(index) {
            let (kind, place) = match shape {
                Shape::Capsule { from, to, radius } => (
                    "capsule",
                    format!(
                        r#"fromto="{} {}" size="{radius}""#,
                        numbers(&from),
                        numbers(&to)
                    ),
                ),
                Shape::Box {
                    centre,
                    half_extents,
                } => (
                    "box",
                    format!(
                        r#"pos="{}" size="{}""#,
                        numbers(&centre),
                        numbers(&half_extents)
                    ),
                ),
            };
            writeln!(
                out,
                r#"{pad}  <geom type="{kind}" {place} contype="0" conaffinity="0" group="1" rgba="0.78 0.8 0.83 1"/>"#
            )?;
        }
    }
    let meets = |&capsule: &&collision::Capsule| physics.self_collision && capsule.body == index;
    if let Some(capsule) = CAPSULE_TABLE.iter().find(meets) {
        let [from, to] = capsule.ends;
        writeln!(
            out,
            r#"{pad}  <geom name="{}" type="capsule" fromto="{} {}" size="{}" contype="0" conaffinity="0" group="3" rgba="0.8 0.3 0.2 0.4"/>"#,
            geom(capsule.name),
            numbers(&from),
            numbers(&to),
            capsule.radius
        )?;
    }
    for child in (0..BODIES).filter(|&child| LINK_TABLE[child].parent == Some(index)) {
        body(child, physics, depth + 1, out)?;
    }
    writeln!(out, "{pad}</body>")
}

/// Name of a capsule's geom.
fn geom(capsule: &str) -> String {
    format!("{}_collision", capsule.replace(' ', "_"))
}

/// What may touch beside the soles and the floor.
fn pairs(out: &mut String) -> std::fmt::Result {
    out.push_str("  <contact>\n");
    for pair in 0..PAIRS {
        let [a, b] = collision::names(pair).map(geom);
        writeln!(out, r#"    <pair geom1="{a}" geom2="{b}" condim="1"/>"#)?;
    }
    out.push_str("  </contact>\n");
    Ok(())
}

fn tail(out: &mut String) -> std::fmt::Result {
    out.push_str("  <actuator>\n");
    for joint in &JOINT_TABLE {
        let name = joint.name.trim_end_matches("_joint");
        writeln!(
            out,
            r#"    <position name="{name}" joint="{}" kp="{}" kv="{}" forcerange="-{effort} {effort}"/>"#,
            joint.name,
            joint.kp,
            joint.kd,
            effort = joint.effort,
        )?;
    }
    let pose = JOINT_TABLE.map(|joint| joint.default_position);
    writeln!(
        out,
        r#"  </actuator>
  <keyframe>
    <key name="{KEYFRAME}" qpos="0 0 {STANDING_HEIGHT} 1 0 0 0 {pose}" ctrl="{pose}"/>
  </keyframe>
</mujoco>"#,
        pose = numbers(&pose)
    )
}

/// Numbers that read back to the same bits, apart by spaces.
fn numbers(values: &[f64]) -> String {
    let words: Vec<String> = values.iter().map(f64::to_string).collect();
    words.join(" ")
}

#[cfg(test)]
mod tests;

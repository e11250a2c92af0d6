//! The description as `deploy.yaml`, in the layout that controllers of unitree_rl_lab and unitree_rl_mjlab read.
//!
//! Separate because the layout is theirs. It has two orders: gains are of motors as Unitree counts them, everything else
//! is of the policy's joints, and `joint_ids_map` leads from one to the other. What the layout cannot say, or their
//! readers understand otherwise, is said in comments at the top. Written by hand: flow lists under block keys, and
//! nothing that would have to be quoted.

use std::fmt::{Display, Write};

use crate::description::{Description, Term};
use crate::metadata::elsewhere;

/// Motors that `LowCmd` (`unitree_hg`) addresses on the larger G1.
const MOTORS: usize = 29;

/// Their names of terms that their controllers can tell.
const TOLD_THERE: [&str; 7] = [
    "base_ang_vel",
    "projected_gravity",
    "velocity_commands",
    "joint_pos",
    "joint_pos_rel",
    "joint_vel_rel",
    "last_action",
];

/// The whole file.
pub fn text(description: &Description) -> String {
    let joints = &description.joints;
    let control = &description.control;
    let defaults = numbers(joints.iter().map(|joint| joint.default_position));
    let names = list(joints.iter().map(|joint| &joint.name));
    let map = list(joints.iter().map(|joint| joint.unitree_motor));
    let scale = numbers(joints.iter().map(|_| control.action_scale));
    let [stiffness, damping] = gains(description).map(|gains| numbers(gains.into_iter()));
    let told = &description.operation.commands;
    let [forward, left, turn] =
        [told.forward, told.left, told.yaw_rate].map(|range| numbers(range.into_iter()));
    let mut out = comments(description);
    write!(
        out,
        "joint_ids_map: {map}\n\
         step_dt: {}\n\
         stiffness: {stiffness}\n\
         damping: {damping}\n\
         default_joint_pos: {defaults}\n\
         history_order: newest_first\n\
         commands:\n\
         \x20 base_velocity:\n\
         \x20   ranges:\n\
         \x20     lin_vel_x: {forward}\n\
         \x20     lin_vel_y: {left}\n\
         \x20     ang_vel_z: {turn}\n\
         \x20     heading: null\n\
         actions:\n\
         \x20 JointPositionAction:\n\
         \x20   clip: null\n\
         \x20   joint_names: {names}\n\
         \x20   scale: {scale}\n\
         \x20   offset: {defaults}\n\
         \x20   joint_ids: null\n\
         observations:\n",
        number(1.0 / control.policy_hz)
    )
    .expect("a String takes all");
    out.extend(description.observation.iter().map(term));
    out
}

/// kp (N·m/rad) and kd (N·m·s/rad) of every motor, those that the policy does not drive included.
fn gains(description: &Description) -> [Vec<f64>; 2] {
    let (mut kp, mut kd) = (vec![0.0; MOTORS], vec![0.0; MOTORS]);
    let driven = description.joints.iter();
    let driven = driven.map(|joint| (joint.unitree_motor, joint.kp, joint.kd));
    let held = description.held_motors.iter();
    let held = held.map(|motor| (motor.unitree_motor, motor.kp, motor.kd));
    for (motor, stiffness, damping) in driven.chain(held) {
        kp[motor as usize] = stiffness;
        kd[motor as usize] = damping;
    }
    [kp, kd]
}

fn term(term: &Term) -> String {
    let frames = 1 + term.past;
    let name = elsewhere(&term.name);
    let params = match name {
        "velocity_commands" => "{command_name: base_velocity}",
        _ => "{}",
    };
    let clip = term
        .clip
        .map_or("null".to_owned(), |clip| numbers([-clip, clip].into_iter()));
    let scale = numbers((0..term.length / frames).map(|_| term.scale));
    format!(
        "  {name}:\n    params: {params}\n    clip: {clip}\n    scale: {scale}\n    history_length: {frames}\n"
    )
}

/// What a reader of the layout would take otherwise than it is.
fn comments(description: &Description) -> String {
    let terms = &description.observation;
    let inputs: usize = terms.iter().map(|term| term.length).sum();
    let untold: Vec<&str> = terms
        .iter()
        .map(|term| elsewhere(&term.name))
        .filter(|name| !TOLD_THERE.contains(name))
        .collect();
    let held = list(
        description
            .held_motors
            .iter()
            .map(|held| held.unitree_motor),
    );
    let mut lines = vec![
        // Debug, as a name may hold anything.
        format!(
            "Policy {:?}, iteration {}, in the layout of unitree_rl_lab and unitree_rl_mjlab: there it is params/deploy.yaml",
            description.origin.run, description.origin.iteration
        ),
        "beside exported/policy.onnx. policy.json says all of it and more; efforts, limits and where to begin are there alone."
            .to_owned(),
        format!(
            "stiffness and damping are of motors 0 to {}, as G1JointIndex of unitree_sdk2 counts them; the rest is of the \
             policy's joints.",
            MOTORS - 1
        ),
        format!("Motors {held} are not the policy's: on a robot that has them they are held at 0."),
        "What their controllers would take otherwise:".to_owned(),
        format!(
            "- policy.onnx has an input {:?} of any batch, [batch, {inputs}]; they want one called \"obs\" with a batch of 1.",
            description.network.input
        ),
    ];
    if terms.iter().any(|term| term.past > 0) {
        lines.push(
            "- A history is newest first here, each term by itself; theirs is oldest first and would be read backwards."
                .to_owned(),
        );
    }
    if !untold.is_empty() {
        lines.push(format!(
            "- They have no {}: a robot does not measure that, and they refuse this file. It is for simulators.",
            untold.join(", ")
        ));
    }
    lines.iter().map(|line| format!("# {line}\n")).collect()
}

fn numbers(values: impl Iterator<Item = impl Display>) -> String {
    list(values.map(number))
}

/// With a point and without an exponent: what readers of YAML take for a number with a fraction, all of them.
fn number(value: impl Display) -> String {
    let text = value.to_string();
    if text.contains('.') {
        text
    } else {
        text + ".0"
    }
}

fn list(parts: impl Iterator<Item = impl ToString>) -> String {
    let parts: Vec<String> = parts.map(|part| part.to_string()).collect();
    format!("[{}]", parts.join(", "))
}

#[cfg(test)]
mod tests;

//! The section read, refused, and set to a moment.

use super::super::*;
use super::{read, track};
use crate::gate::effort::Effort;
use crate::kind::KindsConfig;
use crate::termination::stray::StrayConfig;

#[test]
fn a_section_holds_only_its_differences() {
    let parsed = read("[reward.track]\nkernel = 2.0\n[start]\nlift = 0.01\n");
    assert_eq!(parsed.reward.track, Some(track(2.0, 0.0)));
    assert_eq!(parsed.gate, GateConfig::default());
    assert_eq!(parsed.start.lift, 0.01);
    assert_eq!(parsed.termination.time_out.steps, 1_000);
    for unknown in [
        "kernle = 2.0",
        "[reward.pose]",
        "[gate.upright]\nkernel = 1",
    ] {
        assert!(toml::from_str::<TaskConfig>(unknown).is_err(), "{unknown}");
    }
    parsed.validate().unwrap();
}

#[test]
fn what_cannot_be_used_is_told_by_its_path() {
    for (text, path) in [
        (
            "[termination.fall]\nheight = 0.9",
            "termination.fall.height",
        ),
        (
            "[termination.time_out]\nsteps = 0",
            "termination.time_out.steps",
        ),
        ("[termination.stray]\nleast = 0", "termination.stray.least"),
        ("[reward.track]\nkernel = -1", "reward.track.kernel"),
        (
            "[reward.track]\nkernel = { from = 1, to = -1, samples = [0, 1] }",
            "reward.track.kernel.to",
        ),
        (
            "[reward.track_wide]\nweight = -1",
            "reward.track_wide.weight",
        ),
        ("[reward.track]\nweight = 0", "reward"),
        (
            "[reward.track]\nweight = { from = 0, to = 1, samples = [0, 1] }",
            "reward",
        ),
        ("[gate.effort]\nweight = nan", "gate.effort.weight"),
        (
            "[command]\nforward = { from = [0, 1], to = [1, 0], samples = [0, 1] }",
            "command.forward.to",
        ),
        (
            "[command]\nkinds = { backward = 1 }",
            "command.kinds.backward",
        ),
        (
            "[start]\nreference_share = { from = 1, to = 0, samples = [2, 1] }",
            "start.reference_share.samples",
        ),
    ] {
        assert_eq!(read(text).validate().unwrap_err().path, path, "{text}");
    }
}

#[test]
fn what_no_robot_can_be_asked_for_is_told_with_the_reason() {
    for (text, path, why) in [
        (
            "[command]\nforward = [0, 10.1]",
            "command.forward",
            "sprinter",
        ),
        ("[command]\nlateral = [-5.1, 0]", "command.lateral", "aside"),
        (
            "[command]\nyaw_rate = [0, 1e30]",
            "command.yaw_rate",
            "turn and a half",
        ),
        (
            "[command]\nyaw_rate = { from = [0, 1], to = [0, 11], samples = [0, 1] }",
            "command.yaw_rate.to",
            "turn and a half",
        ),
        (
            "[command]\nresample_seconds = [0, 3]",
            "command.resample_seconds",
            "to a day",
        ),
        (
            "[command]\nresample_seconds = [3, 1e9]",
            "command.resample_seconds",
            "to a day",
        ),
        (
            "[command]\nkinds = { forward = 1e30 }",
            "command.kinds.forward",
            "relative",
        ),
        ("[start]\nlift = 0.6", "start.lift", "fall"),
        (
            "[start]\nposition_noise = 3.3",
            "start.position_noise",
            "half a turn",
        ),
        ("[start]\nvelocity_noise = 41", "start.velocity_noise", "37"),
        (
            "[reward.track]\nweight = 1e30",
            "reward.track.weight",
            "weighed",
        ),
        ("[ground]\nslope = 6", "ground.slope", "degrees from 0 to 5"),
        (
            "[ground]\nbumps = -0.01",
            "ground.bumps",
            "metres from 0 to 0.02",
        ),
    ] {
        let invalid = read(text).validate().unwrap_err();
        assert_eq!(invalid.path, path, "{text}");
        assert!(invalid.remedy.contains(why), "{text}: {invalid}");
    }
    let widest = "[command]\nforward = [-10, 10]\nlateral = [-5, 5]\nyaw_rate = [-10, 10]";
    read(widest).validate().unwrap();
}

#[test]
fn some_term_is_paid_at_every_time() {
    let task = |track: &str, wide: &str| {
        read(&format!(
            "[reward.track]\nweight = {track}\n[reward.track_wide]\nweight = {wide}\n"
        ))
        .validate()
    };
    let way = |from: u32, to: u32, begins: u32, arrives: u32| {
        format!("{{ from = {from}, to = {to}, samples = [{begins}, {arrives}] }}")
    };
    // One fades while the other comes; one comes in when the other has gone; nothing in between.
    assert!(task(&way(1, 0, 5, 9), &way(0, 1, 5, 9)).is_ok());
    assert!(task(&way(1, 0, 5, 9), &way(0, 1, 9, 20)).is_err());
    assert!(task(&way(1, 0, 5, 9), &way(0, 1, 8, 20)).is_ok());
    // A step has the first value at its sample, and the second right after.
    assert!(task(&way(1, 0, 5, 5), &way(0, 1, 0, 9)).is_ok());
    assert!(task(&way(1, 0, 5, 5), &way(0, 1, 6, 6)).is_err());
    assert!(task("0", &way(0, 1, 0, 1)).is_err());
    assert!(task("0", "1").is_ok());
}

/// Every number of a table, and every range, by its path; those of lists of other things are none.
fn numbers(table: &toml::Table, before: &str) -> Vec<String> {
    let inside = |(key, value): (&String, &toml::Value)| {
        let path = format!("{before}{key}");
        match value {
            toml::Value::Table(inner) => numbers(inner, &format!("{path}.")),
            toml::Value::Float(_) | toml::Value::Array(_) => vec![path],
            _ => Vec::new(),
        }
    };
    table.iter().flat_map(inside).collect()
}

#[test]
fn whatever_may_move_does() {
    let full = TaskConfig {
        reward: RewardConfig {
            track_wide: Some(track(1.0, 0.5)),
            ..RewardConfig::default()
        },
        gate: GateConfig {
            effort: Some(Effort::default()),
            ..GateConfig::default()
        },
        termination: TerminationConfig {
            stray: Some(StrayConfig::default()),
            ..TerminationConfig::default()
        },
        command: CommandConfig {
            kinds: Some(KindsConfig::default()),
            ..CommandConfig::default()
        },
        ..TaskConfig::default()
    };
    let table = toml::Table::try_from(&full).unwrap();
    let mut moving = Vec::new();
    for path in numbers(&table, "") {
        let mut other = table.clone();
        let mut keys: Vec<&str> = path.split('.').collect();
        let last = keys.pop().unwrap();
        let holder = keys.iter().fold(&mut other, |table, key| {
            table[*key].as_table_mut().expect("a table")
        });
        let end = |to: bool| match &holder[last] {
            toml::Value::Array(_) => {
                toml::Value::Array(vec![0.0.into(), if to { 3.0 } else { 1.0 }.into()])
            }
            _ => toml::Value::Float(if to { 3.0 } else { 1.0 }),
        };
        let way = [
            ("from", end(false)),
            ("to", end(true)),
            ("samples", toml::Value::Array(vec![0.0.into(), 8.0.into()])),
        ];
        let way = way
            .map(|(key, value)| (key.to_owned(), value))
            .into_iter()
            .collect();
        holder.insert(last.to_owned(), toml::Value::Table(way));
        let Ok(task) = other.try_into::<TaskConfig>() else {
            continue;
        };
        let halfway = toml::Table::try_from(task.at(4.0)).unwrap();
        let value = path
            .split('.')
            .fold(&toml::Value::Table(halfway), |value, key| &value[key])
            .clone();
        let arrived = match &value {
            toml::Value::Array(ends) => ends[1].as_float(),
            other => other.as_float(),
        };
        // Halfway from 1 to 3, and no ramp any more.
        assert_eq!(arrived, Some(2.0), "{path} does not move: {value}");
        moving.push(path);
    }
    for path in [
        "reward.track.kernel",
        "reward.track_wide.weight",
        "gate.effort.weight",
        "termination.stray.share",
        "command.forward",
        "command.lateral",
        "command.yaw_rate",
        "command.matched_share",
        "command.standing_share",
        "command.kinds.approach",
        "start.reference_share",
    ] {
        assert!(
            moving.contains(&path.to_owned()),
            "{path} cannot move: {moving:?}"
        );
    }
}

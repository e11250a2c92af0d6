//! The language of `--stress`, and that every stress is one.

use super::*;
use vocabulary::Section;

fn rows(text: &str) -> Vec<Row> {
    match text.parse().unwrap() {
        Stresses::Rows(rows) => rows,
        Stresses::Help => panic!("{text} is no help"),
    }
}

#[test]
fn lists_are_read_as_those_of_sim2sim() {
    let labels =
        |text: &str| -> Vec<String> { rows(text).into_iter().map(|row| row.label).collect() };
    assert_eq!(labels("none"), ["none"]);
    assert_eq!(
        labels("delay, push=300,gains=0.8+payload=6,delay=20"),
        ["none", "delay=20", "push=300", "gains=0.8+payload=6"]
    );
    assert_eq!(rows("delay")[1].values, [("delay", 20.0)]);
    let standard = rows("standard");
    assert_eq!(standard.len(), 1 + 13 + 1);
    assert_eq!(standard[14].label, "half");
    let half: Vec<f32> = standard[14]
        .values
        .iter()
        .map(|(_, value)| *value)
        .collect();
    assert_eq!(
        half,
        [
            10.0, 0.9, 0.95, 2.0, 0.65, 2.5, 1.0, 125.0, 0.01, 1.0, 0.5, 0.5, 4.0
        ]
    );
    assert_eq!("help".parse(), Ok(Stresses::Help));
}

#[test]
fn what_cannot_be_read_is_told_with_its_remedy() {
    for (text, says) in [
        ("wind", "`wind` is no stress; there are delay, gains"),
        ("delay=99", "give delay a number from 0 to 40 ms"),
        ("friction=x", "give friction a number from 0 to 3"),
        ("delay=nan", "give delay a number"),
        ("delay+delay=10", "twice"),
        ("", "`` is no stress"),
    ] {
        let said = text.parse::<Stresses>().unwrap_err();
        assert!(said.contains(says), "{text}: {said}");
    }
}

#[test]
fn every_stress_does_something_up_to_its_ends_and_is_explained() {
    let help = explained();
    for stress in &STRESSES {
        assert!(help.contains(stress.name) && help.contains(stress.help));
        for value in [
            stress.limits[0],
            stress.default,
            stress.half(),
            stress.limits[1],
        ] {
            let acting = Row::of(vec![(stress.name, value)]).acting();
            acting.event.validate().unwrap();
            if let Some(ground) = acting.ground(None) {
                ground.validate().unwrap();
            }
        }
        let acting = Row::of(vec![(stress.name, stress.default)]).acting();
        assert_ne!(acting, Acting::default(), "{}", stress.name);
    }
    let all = Row::all("all", |stress| stress.default).acting();
    assert_eq!(all.event.action_delay.unwrap().range, [0.02, 0.02]);
    assert_eq!(all.event.encoder_offset.unwrap().range, [-0.02, 0.02]);
    assert_eq!(all.ground(None).unwrap().bumps, 0.02);
}

//! The table: what it refuses, how it grows, and that it is nothing without rows.

use super::*;

fn read(text: &str) -> EventConfig {
    toml::from_str(text).unwrap()
}

#[test]
fn without_rows_it_is_nothing() {
    assert_eq!(read(""), EventConfig::default());
    assert!(!EventConfig::default().has_rows());
    assert!(read("torque_speed = true").has_rows());
    for kind in &KINDS {
        let config = read(&format!("{} = {{ range = [0.5, 0.6] }}", kind.name));
        assert!(config.has_rows(), "{}", kind.name);
        // Each key reaches the row that its limits are of.
        let mut copy = config.clone();
        let ranges = copy.ranges();
        let listed: Vec<&str> = KINDS
            .iter()
            .zip(&ranges)
            .filter(|(_, range)| range.is_some())
            .map(|(kind, _)| kind.name)
            .collect();
        assert_eq!(listed, [kind.name]);
    }
}

#[test]
fn every_row_has_ends_with_a_reason() {
    for kind in &KINDS {
        let [least, greatest] = kind.limits;
        let at = |range: [f32; 2]| {
            let text = format!("{} = {{ range = {range:?} }}", kind.name);
            read(&text)
                .validate()
                .map_err(|invalid| invalid.to_string())
        };
        assert_eq!(at([least, greatest]), Ok(()), "{}", kind.name);
        for beyond in [
            [least - 0.1, greatest],
            [least, greatest + 0.1],
            [greatest, least],
        ] {
            let said = at(beyond).unwrap_err();
            assert!(
                said.starts_with(&format!("{}.range = ", kind.name)),
                "{said}"
            );
        }
        assert!(at([least - 0.1, greatest]).unwrap_err().contains(kind.why));
    }
    let force = |more: &str| {
        let text = format!("force = {{ range = [50.0, 150.0], {more} }}");
        read(&text).validate().unwrap_err().path
    };
    assert_eq!(force("duration = [0.0, 0.1]"), "force.duration");
    assert_eq!(force("seconds = [4.0, 3.0]"), "force.seconds");
    let arms = read("arms = { range = [0.0, 0.5], duration = [0.0, 1.0] }");
    assert_eq!(arms.validate().unwrap_err().path, "arms.duration");
}

#[test]
fn the_table_grows_from_what_changes_nothing() {
    let mut config = read(
        "action_delay = { range = [0.0, 0.04] }\nstiffness = { range = [0.8, 1.2] }\n\
         ground_friction = { range = [0.4, 1.2] }\nforce = { range = [50.0, 150.0] }\n\
         torque_speed = true\nplain_share = 0.25\n",
    );
    config.strength = Ramp::moving(0.0, 1.0, [1e6, 3e6]);
    assert_eq!(config.at(1e6), EventConfig::default());
    let half = config.at(2e6);
    assert_eq!(half.action_delay.unwrap().range, [0.0, 0.02]);
    assert_eq!(half.stiffness.unwrap().range, [0.9, 1.1]); // half-way from 1
    assert_eq!(half.ground_friction.unwrap().range, [0.7, 1.1]);
    assert_eq!(half.force.unwrap().range, [25.0, 75.0]);
    assert!(half.torque_speed && half.plain_share == 0.25 && half.payload.is_none());
    let whole = EventConfig {
        strength: 1.0.into(),
        ..config.clone()
    };
    assert_eq!(config.at(3e6), whole);
}

#[test]
fn what_table_one_says_as_well_is_refused() {
    let table = RandomizationConfig::table_one();
    let said = read("ground_friction = { range = [0.3, 1.2] }")
        .check_beside(&table)
        .unwrap_err()
        .to_string();
    assert!(
        said.contains("ground_friction") && said.contains("`friction`"),
        "{said}"
    );
    let load = |least: f32, beside: f32| {
        let event = read(&format!("payload = {{ range = [{least:?}, 0.0] }}"));
        let table = RandomizationConfig {
            mass_variation: Some(Row {
                range: [beside, 0.0],
            }),
            ..RandomizationConfig::default()
        };
        event.check_beside(&table)
    };
    // 4 kg and 3 kg are the 7 kg that a torso of 7.8 kg can lose.
    assert_eq!(load(-4.0, -3.0), Ok(()));
    assert_eq!(load(-4.0, -3.5).unwrap_err().path, "payload.range");
    assert_eq!(EventConfig::default().check_beside(&table), Ok(()));
}

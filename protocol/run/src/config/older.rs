//! What a run of an older program says, in today's words.
//!
//! Only for files that a program has written, which hold every value: a run made yesterday is gone on with and judged
//! today. What a person writes is refused with the new spelling instead (see `moved`), and so is here what has no meaning
//! any more.

use toml::{Table, Value};

use super::moved::GONE;

/// Rows of Table I: the key that switched one, and what its other keys are called within it.
const ROWS: [(&str, &[(&str, &str)]); 9] = [
    ("mass_variation", &[("mass_range", "range")]),
    ("friction", &[("friction_range", "range")]),
    ("com_offset", &[("com_range", "range")]),
    (
        "impulse",
        &[("impulse_range", "range"), ("impulse_seconds", "seconds")],
    ),
    (
        "linear_velocity_noise",
        &[("linear_velocity_range", "range")],
    ),
    (
        "angular_velocity_noise",
        &[("angular_velocity_range", "range")],
    ),
    ("gravity_noise", &[("gravity_range", "range")]),
    ("joint_position_noise", &[("joint_position_range", "range")]),
    ("joint_velocity_noise", &[("joint_velocity_range", "range")]),
];

/// Says in today's words what can be said in them; the rest stays.
pub(super) fn in_todays_words(table: &mut Table) {
    physics(table);
    self_collision(table);
    draw(table);
    for (path, now) in GONE {
        if now != "none" {
            drop_same(table, path, now);
        }
    }
    if let Some(Value::Table(randomization)) = table.get_mut("randomization") {
        rows(randomization);
    }
}

/// What has the one value that is left says nothing; another value stays to be refused.
fn drop_same(table: &mut Table, path: &str, now: &str) {
    let (section, key) = path.split_once('.').expect("a section and a key");
    let Some(Value::Table(section)) = table.get_mut(section) else {
        return;
    };
    let now: Table = toml::from_str(&format!("now = {now}")).expect("TOML of the program's");
    if section.get(key) == now.get("now") {
        section.remove(key);
    }
}

/// `task.physics` is `fleet.physics`.
fn physics(table: &mut Table) {
    let Some(Value::Table(task)) = table.get_mut("task") else {
        return;
    };
    let Some(engine) = task.remove("physics") else {
        return;
    };
    let fleet = table.entry("fleet").or_insert(Value::Table(Table::new()));
    if let Value::Table(fleet) = fleet {
        fleet.entry("physics").or_insert(engine);
    }
}

/// Where it is not said whether a robot's parts meet, they passed through each other.
fn self_collision(table: &mut Table) {
    if let Some(Value::Table(fleet)) = table.get_mut("fleet") {
        fleet
            .entry("self_collision")
            .or_insert(Value::Boolean(false));
    }
}

/// `motion.stratify` is a way to draw.
fn draw(table: &mut Table) {
    let Some(Value::Table(motion)) = table.get_mut("motion") else {
        return;
    };
    let Some(Value::Boolean(even)) = motion.get("stratify") else {
        return;
    };
    let by = if *even { "speeds" } else { "weights" };
    motion.remove("stratify");
    motion.entry("draw").or_insert(by.into());
}

/// A row that was switched on is a table; one that was not is none.
fn rows(randomization: &mut Table) {
    for (row, keys) in ROWS {
        let Some(Value::Boolean(on)) = randomization.get(row) else {
            continue;
        };
        let on = *on;
        randomization.remove(row);
        let parts = keys.iter().filter_map(|(old, now)| {
            let value = randomization.remove(*old)?;
            Some(((*now).to_owned(), value))
        });
        let parts: Table = parts.collect();
        if on {
            randomization.insert(row.to_owned(), Value::Table(parts));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn today(text: &str) -> Table {
        let mut table = toml::from_str(text).unwrap();
        in_todays_words(&mut table);
        table
    }

    #[test]
    fn the_engine_is_of_the_fleet() {
        let old = "[task]\nphysics = \"batched\"\n[task.reward]\n[fleet]\nsteps = 8";
        let new =
            "[task.reward]\n[fleet]\nsteps = 8\nphysics = \"batched\"\nself_collision = false";
        assert_eq!(today(old), toml::from_str(new).unwrap());
        assert_eq!(
            today("[task]\nphysics = \"batched\"")["fleet"]["physics"].as_str(),
            Some("batched")
        );
    }

    #[test]
    fn parts_pass_through_each_other_where_it_is_not_said() {
        let said = |text| today(text)["fleet"]["self_collision"].as_bool();
        assert_eq!(said("[fleet]\nsteps = 8"), Some(false));
        assert_eq!(said("[fleet]\nself_collision = true"), Some(true));
        assert_eq!(said("[fleet]\nself_collision = false"), Some(false));
    }

    #[test]
    fn motion_is_drawn_as_it_was() {
        let said = |text| today(text)["motion"].as_table().unwrap().clone();
        assert_eq!(
            said("[motion]\nstratify = true")["draw"].as_str(),
            Some("speeds")
        );
        assert_eq!(
            said("[motion]\nstratify = false")["draw"].as_str(),
            Some("weights")
        );
        assert!(!said("[motion]\nstratify = true").contains_key("stratify"));
        assert!(said("[motion]\nmirror = true").get("draw").is_none());
    }

    #[test]
    fn rows_that_were_on_are_tables_and_others_are_none() {
        let old = "[randomization]\nplain_share = 0.3\n\
                   friction = true\nfriction_range = [0.5, 1.0]\n\
                   gravity_noise = false\ngravity_range = [-0.1, 0.1]\n\
                   impulse = true\nimpulse_range = [0.0, 0.9]\nimpulse_seconds = [1.5, 4.0]";
        let new = "[randomization]\nplain_share = 0.3\n\
                   friction = { range = [0.5, 1.0] }\n\
                   impulse = { range = [0.0, 0.9], seconds = [1.5, 4.0] }";
        assert_eq!(today(old), toml::from_str(new).unwrap());
        // Today's words stay.
        assert_eq!(today(new), toml::from_str(new).unwrap());
    }

    #[test]
    fn a_key_without_a_choice_is_dropped_where_it_has_the_value_that_is_left() {
        let same = "[ppo]\nkl_band = 1.5\nepochs = 4\nadvantage_normalization = \"batch\"\n\
                    [discriminator.floors]\nheight = 0.03\nlinear_velocity = 0.3\n\
                    angular_velocity = 0.5\njoint_position = 0.1\njoint_velocity = 2.0";
        assert_eq!(
            today(same),
            toml::from_str("[ppo]\nepochs = 4\n[discriminator]").unwrap()
        );
        let other = today("[ppo]\nkl_band = 2.0\nvalue_clip = 0.2");
        assert_eq!(other["ppo"].as_table().unwrap().len(), 2);
    }

    #[test]
    fn what_makes_no_sense_stays_to_be_refused() {
        for odd in [
            "task = 3",
            "[task]\nphysics = 1\n[fleet]",
            "fleet = 1\n[task]\nphysics = \"rapier\"",
            "randomization = []",
        ] {
            let _ = today(odd);
        }
        let kept = today("[randomization]\nfriction = \"on\"");
        assert_eq!(kept["randomization"]["friction"].as_str(), Some("on"));
    }
}

//! Every key that a configuration can have: its text and unit, from the doc comment of its field.
//!
//! The first sentence says what the key is; a unit stands in it between commas, as in "Pelvis height below which it has,
//! m." Rows of a table of terms that say nothing of their own unit have that of the row's text.

use schemars::generate::SchemaSettings;
use serde_json::{Map, Value};

use crate::resolve::SECTIONS;

/// The units that a first sentence may name.
const UNITS: [&str; 15] = [
    "m",
    "s",
    "m/s",
    "rad",
    "rad/s",
    "kg",
    "N",
    "N·m",
    "N·m·s/rad",
    "J",
    "1/J",
    "s²/m²",
    "min",
    "samples",
    "degrees",
];

/// A key of the configuration.
#[derive(Clone, Debug, PartialEq)]
pub struct Key {
    /// Dotted, with its section.
    pub path: String,
    /// All of its doc comment, in one line.
    pub text: String,
    /// Of its value.
    pub unit: Option<String>,
    /// As it is counted: what several terms have is one.
    counted: String,
    /// Whether its value is a list of any length.
    pub list: bool,
}

impl Key {
    /// The table that it stands in, and its name there.
    pub fn parts(&self) -> (&str, &str) {
        self.path.rsplit_once('.').expect("a section and a key")
    }

    /// What it is, in a sentence.
    pub fn sentence(&self) -> &str {
        sentence(&self.text)
    }
}

/// How many keys there are besides lists, by `--count`.
pub fn count<'a>(keys: impl IntoIterator<Item = &'a Key>) -> usize {
    let counted: std::collections::BTreeSet<&str> = keys
        .into_iter()
        .filter(|key| !key.list)
        .map(|key| key.counted.as_str())
        .collect();
    counted.len()
}

/// Every key of every section; those of a table before those of the tables in it.
pub fn all() -> Vec<Key> {
    let mut keys = Vec::new();
    for section in &SECTIONS {
        let settings = SchemaSettings::draft2020_12().with(|settings| {
            settings.inline_subschemas = true;
        });
        let schema = (section.schema)(&mut settings.into_generator());
        let place = Place {
            path: section.name.to_owned(),
            counted: section.name.to_owned(),
            unit: None,
        };
        walk(schema.as_value(), &place, &mut keys);
    }
    keys
}

/// A table on the way down.
struct Place {
    path: String,
    counted: String,
    /// Of the rows in it that name none.
    unit: Option<String>,
}

fn walk(schema: &Value, place: &Place, keys: &mut Vec<Key>) {
    let Some(table) = table(schema) else {
        return;
    };
    let terms = table.get("terms") == Some(&Value::Bool(true));
    let fields = table["properties"].as_object().into_iter().flatten();
    let mut inner = Vec::new();
    for (name, field) in fields {
        let text = text(field);
        let below = |name: &str, whole: &str| format!("{whole}.{name}");
        let path = below(name, &place.path);
        if self::table(field).is_some() {
            let counted = below(if terms { "*" } else { name }, &place.counted);
            let unit = unit(&text);
            inner.push((
                field,
                Place {
                    path,
                    counted,
                    unit,
                },
            ));
            continue;
        }
        keys.push(Key {
            path,
            counted: below(name, &place.counted),
            unit: unit(&text).or_else(|| place.unit.clone()),
            list: is_list(field),
            text,
        });
    }
    for (field, place) in inner {
        walk(field, &place, keys);
    }
}

/// The schema of a table with keys of its own, or of one that may be missing.
fn table(schema: &Value) -> Option<&Map<String, Value>> {
    let object = schema.as_object()?;
    if object.contains_key("properties") {
        return Some(object);
    }
    let some = |choice: &&Value| choice["type"] != "null";
    let mut choices = object.get("anyOf")?.as_array()?.iter().filter(some);
    // Of several, as a number or a ramp, each is a value.
    match (choices.next(), choices.next()) {
        (Some(only), None) => table(only),
        _ => None,
    }
}

/// Of a length that is not fixed.
fn is_list(schema: &Value) -> bool {
    schema["type"] == "array" && schema.get("maxItems").is_none()
}

/// The doc comment of a field in one line.
fn text(schema: &Value) -> String {
    let text = schema["description"].as_str().unwrap_or_default();
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// The first sentence: the next begins with a capital letter.
fn sentence(text: &str) -> &str {
    let begins = |rest: &str| rest.starts_with(|c: char| c.is_uppercase() || c == '`');
    let mut stops = text.match_indices(". ");
    let end = stops.find(|(at, _)| begins(&text[at + 2..]));
    end.map_or(text, |(at, _)| &text[..=at])
}

/// The units that a text's first sentence names.
fn unit(text: &str) -> Option<String> {
    let sentence = sentence(text).trim_end_matches('.');
    let parts = sentence.split([',', ':', ';', '(', ')']).map(str::trim);
    let units: Vec<&str> = parts.filter(|part| UNITS.contains(part)).collect();
    (!units.is_empty()).then(|| units.join(", "))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::presets;
    use crate::resolve;

    fn key(path: &str) -> Key {
        let found = all().into_iter().find(|key| key.path == path);
        found.unwrap_or_else(|| panic!("no key {path}"))
    }

    #[test]
    fn every_key_says_what_it_is_for() {
        for key in all() {
            let sentence = key.sentence();
            let words = sentence.split(' ').count();
            assert!(words >= 2 && sentence.ends_with('.'), "{key:?}");
            assert!(words < 60, "{}: {sentence}", key.path);
        }
    }

    #[test]
    fn a_key_that_is_measured_has_its_unit() {
        for (path, unit) in [
            ("run.minutes", "min"),
            ("run.deadlines.rollout_seconds", "s"),
            ("task.reward.track.kernel", "s²/m²"),
            ("task.gate.effort.weight", "1/J"),
            ("task.ground.slope", "degrees"),
            ("task.ground.bumps", "m"),
            ("task.termination.fall.height", "m"),
            ("task.termination.stray.seconds", "s"),
            ("task.termination.stray.grace_on_course", "s"),
            ("task.termination.stray.least", "m/s"),
            ("task.command.forward", "m/s"),
            ("task.command.yaw_rate", "rad/s"),
            ("task.command.resample_seconds", "s"),
            ("task.start.position_noise", "rad"),
            ("task.start.velocity_noise", "rad/s"),
            // The row says it, its range does not.
            ("randomization.mass_variation.range", "kg"),
            ("randomization.impulse.range", "m/s"),
            ("randomization.impulse.seconds", "s"),
            ("randomization.joint_velocity_noise.range", "rad/s"),
            ("event.action_delay.range", "s"),
            ("event.joint_friction.range", "N·m"),
            ("event.slope.range", "rad"),
            ("event.force.range", "N"),
            ("event.force.duration", "s"),
            ("event.arms.range", "rad"),
            ("event.arms.duration", "s"),
            ("discriminator.command_blur", "m/s, m/s, rad/s"),
            ("ppo.critic_first", "samples"),
        ] {
            assert_eq!(key(path).unit.as_deref(), Some(unit), "{path}");
        }
        for path in ["run.seed", "ppo.gamma", "randomization.friction.range"] {
            assert_eq!(key(path).unit, None, "{path}");
        }
        // Whatever is called after a unit has it.
        for key in all() {
            if key.path.ends_with("seconds") {
                assert_eq!(key.unit.as_deref(), Some("s"), "{}", key.path);
            }
        }
    }

    #[test]
    fn a_configuration_has_no_key_but_these() {
        let keys = all();
        for name in presets::names() {
            let mut config = presets::find(name).unwrap().config;
            resolve::settle_all(&mut config).unwrap();
            for path in config.leaves().keys() {
                let known = |key: &Key| {
                    let rest = path.strip_prefix(&key.path);
                    rest.is_some_and(|rest| rest.is_empty() || rest.starts_with('.'))
                };
                // A table without keys, as a randomization without rows.
                let empty = keys
                    .iter()
                    .any(|key| key.path.starts_with(&format!("{path}.")));
                assert!(empty || keys.iter().any(known), "{name}: {path}");
            }
        }
    }

    #[test]
    fn what_several_terms_have_is_counted_once() {
        let keys = all();
        let counted = |path: &str| key(path).counted;
        assert_eq!(
            counted("task.reward.track.kernel"),
            counted("task.reward.track_wide.kernel")
        );
        assert_eq!(counted("task.reward.track.kernel"), "task.reward.*.kernel");
        assert_eq!(
            counted("randomization.friction.range"),
            "randomization.*.range"
        );
        assert_ne!(counted("ppo.epochs"), counted("ppo.minibatch"));
        assert!(key("motion.clips").list && key("policy.hidden").list);
        assert!(!key("task.command.forward").list && !key("scheduler.method").list);
        assert!(count(&keys) <= 110, "{} keys", count(&keys));
    }

    #[test]
    fn a_sentence_ends_before_the_next_and_not_after_an_abbreviation() {
        assert_eq!(
            sentence("W, as Eq. 9 has it. Default 1."),
            "W, as Eq. 9 has it."
        );
        assert_eq!(sentence("All of it"), "All of it");
        assert_eq!(
            unit("How far, m: least and greatest. Default 2, s."),
            Some("m".into())
        );
        assert_eq!(unit("A mass."), None);
    }
}

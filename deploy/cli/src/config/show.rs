//! Keys with their values, as TOML that explains itself and as JSON.

use configuration::keys::Key;
use serde_json::json;
use toml::Value;

use super::Shown;

/// A key with its value, and that of another configuration.
pub(super) struct Entry<'a> {
    pub(super) key: &'a Key,
    value: Option<&'a Value>,
    other: Option<&'a Value>,
}

/// What is to be shown: all keys, or those in which two configurations differ.
pub(super) fn entries<'a>(
    keys: &'a [Key],
    shown: &'a Shown,
    other: Option<&'a Shown>,
) -> Vec<Entry<'a>> {
    let entry = |key: &'a Key| {
        let entry = Entry {
            key,
            value: shown.config.given(&key.path),
            other: other.and_then(|other| other.config.given(&key.path)),
        };
        let told = match other {
            Some(_) => entry.value != entry.other,
            // Of terms that are not listed there is nothing to say.
            None => shown.has(key.parts().0),
        };
        told.then_some(entry)
    };
    keys.iter().filter_map(entry).collect()
}

/// TOML with a comment before and behind each value.
pub(super) fn toml(entries: &[Entry<'_>], shown: &Shown, other: Option<&Shown>) -> String {
    let mut text = match other {
        None => format!("# {}: every value, and where it was given.\n", shown.name),
        Some(other) if entries.is_empty() => {
            format!("# {} and {} do not differ.\n", shown.name, other.name)
        }
        Some(other) => format!("# {}, where it differs from {}.\n", shown.name, other.name),
    };
    if let Some(on) = other.and_then(|other| other.on.as_ref()) {
        text.push_str(&format!("on = {}\n", Value::from(on.as_str())));
        let unset = unset(entries, shown);
        if !unset.is_empty() {
            text.push_str(&format!("unset = {}\n", Value::from(unset)));
        }
    }
    let mut table = "";
    for entry in entries {
        let (place, name) = entry.key.parts();
        if place != table {
            // A header alone would list a term.
            let hidden = if shown.has(place) { "" } else { "# " };
            text.push_str(&format!("\n{hidden}[{place}]\n"));
            table = place;
        }
        text.push_str(&format!("# {}\n", entry.key.sentence()));
        if let Some(other) = other {
            let value = entry.other.map_or_else(|| "not set".to_owned(), in_a_line);
            let origin = match entry.other {
                Some(_) => format!(", {}", other.origin(&entry.key.path)),
                None => String::new(),
            };
            text.push_str(&format!("# in {}: {value}{origin}\n", other.name));
        }
        let unit = entry
            .key
            .unit
            .as_ref()
            .map_or(String::new(), |unit| format!("{unit}; "));
        let Some(value) = entry.value else {
            text.push_str(&format!("# {name} is not set ({unit}default)\n"));
            continue;
        };
        let origin = shown.origin(&entry.key.path);
        text.push_str(&format!("{name} = {} # {unit}{origin}\n", written(value)));
    }
    text
}

/// What the other configuration has and this one has not: keys, or whole tables of them.
fn unset(entries: &[Entry<'_>], shown: &Shown) -> Vec<String> {
    let mut unset: Vec<String> = Vec::new();
    for entry in entries.iter().filter(|entry| entry.value.is_none()) {
        let (place, _) = entry.key.parts();
        let path = if shown.has(place) {
            &entry.key.path
        } else {
            place
        };
        if !unset.iter().any(|known| known == path) {
            unset.push(path.to_owned());
        }
    }
    unset
}

/// A value as TOML; a list of tables with a line for each.
fn written(value: &Value) -> String {
    match value {
        Value::Array(items) if items.iter().any(Value::is_table) => {
            let lines = items.iter().map(|item| format!("    {item},\n"));
            format!("[\n{}]", lines.collect::<String>())
        }
        value => in_a_line(value),
    }
}

/// A value in one line; what moves as it is written by hand.
fn in_a_line(value: &Value) -> String {
    match value {
        Value::Table(table) if table.keys().eq(["from", "samples", "to"]) => {
            let [from, to, samples] = ["from", "to", "samples"].map(|key| &table[key]);
            format!("{{ from = {from}, to = {to}, samples = {samples} }}")
        }
        value => value.to_string(),
    }
}

/// The same as JSON.
pub(super) fn json(entries: &[Entry<'_>], shown: &Shown, other: Option<&Shown>) -> String {
    let keys = entries.iter().map(|entry| {
        let path = &entry.key.path;
        let origin = |of: &Shown, value: Option<&Value>| value.map(|_| of.origin(path));
        let mut row = json!({
            "key": path,
            "value": entry.value,
            "unit": entry.key.unit,
            "text": entry.key.text,
            "origin": origin(shown, entry.value),
        });
        if let Some(other) = other {
            row["other"] = json!(entry.other);
            row["other_origin"] = json!(origin(other, entry.other));
        }
        row
    });
    let mut all = json!({ "of": shown.name, "keys": keys.collect::<Vec<_>>() });
    if let Some(other) = other {
        all["other"] = json!(other.name);
    }
    format!("{all:#}\n")
}

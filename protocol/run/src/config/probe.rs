//! What the reader of a section would take in a place, where something of the wrong kind stands.
//!
//! Separate because only the reader knows: it is asked by handing it something else there. A table with a key that it cannot
//! know is answered with the keys of that table, a word with the choices, an empty list with the length that is wanted.

use toml::{Table, Value};
use vocabulary::Section;
use wording::nearest::names;

use super::complaint::quoted_names;

/// No key and no choice has this name.
const NOBODY: &str = "?";

/// What to give at `path` of a section as given, whose reader has complained in serde's words; none where these say it.
pub(super) fn wanted<T: Section>(given: &Value, path: &str, complaint: &str) -> Option<String> {
    let answer = |probe: Value| answer::<T>(given, path, probe);
    let table = || {
        let probe = Table::from_iter([(NOBODY.to_owned(), Value::from(0))]);
        let said = answer(probe.into())?;
        let quoted = quoted_names(&said);
        match said.split(' ').next() {
            Some("unknown") => Some(names(quoted.get(1..)?)),
            // A table that takes any key asks for those that it needs, one after the other.
            Some("missing") => Some(names(&quoted)),
            _ => None,
        }
    };
    let choices = || {
        let said = answer(NOBODY.into()).filter(|said| said.starts_with("unknown variant"))?;
        Some(names(quoted_names(&said).get(1..)?))
    };
    let length = || {
        let said = answer(Value::Array(Vec::new()))?;
        Some(
            said.strip_prefix("invalid length 0, expected an array of length ")?
                .to_owned(),
        )
    };
    let (_, expected) = complaint
        .rsplit_once(", expected ")
        .unwrap_or(("", complaint));
    if expected.contains("from = …") {
        // A value that may move.
        let one = length().map_or("a number".to_owned(), |length| {
            format!("a list of {length} numbers")
        });
        return Some(format!("give {}", expected.replacen("a value", &one, 1)));
    }
    if expected.contains("struct variant") {
        let choice = path.rsplit('.').next().unwrap_or(path);
        let keys = table()?;
        return Some(format!(
            "`{choice}` has parameters: give it a table of {keys}"
        ));
    }
    if expected.starts_with("struct ") {
        return Some(format!("give a table of keys: {}", table()?));
    }
    if expected.contains("fewer elements") {
        return Some(format!("give a list of {} values", length()?));
    }
    let choose = ["string only", "unit variant"].contains(&expected)
        || complaint.starts_with("wanted exactly 1 element");
    choose
        .then(choices)?
        .map(|choices| format!("name one choice: {choices}"))
}

/// The complaint of a section's reader about something else at `path`; none if it has none.
fn answer<T: Section>(given: &Value, path: &str, probe: Value) -> Option<String> {
    let mut probed = given.clone();
    let mut place = &mut probed;
    for part in path.split(['.', '[', ']']).filter(|part| !part.is_empty()) {
        // A choice that was given as a word is no table yet.
        if place.is_str() {
            *place = Value::Table(Table::from_iter([(part.to_owned(), Value::from(0))]));
        }
        place = match part.parse::<usize>() {
            Ok(index) => place.get_mut(index)?,
            Err(_) => place.get_mut(part)?,
        };
    }
    *place = probe;
    let read: Result<T, toml::de::Error> = T::deserialize(probed);
    read.err().map(|error| error.message().to_owned())
}

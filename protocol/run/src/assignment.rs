//! `--set key.path=value`: one value given on the command line.
//!
//! Separate from the configuration because it is a small language of its own: a dotted path, and a TOML value that may
//! leave out the quotes of a word.

use toml::{Table, Value};

/// A parsed `key.path=value`.
#[derive(Debug, PartialEq)]
pub(crate) struct Assignment {
    pub(crate) path: Vec<String>,
    pub(crate) value: Value,
}

/// Keys that are asked for so often that they go without their section.
const SHORT: [(&str, &str); 1] = [("physics", "fleet")];

/// What a preset says of presets, above its sections.
pub(crate) const LAYERING: [&str; 2] = ["on", "unset"];

/// Parses one assignment. A key without a dot is one of `[run]`: `seed=7` means `run.seed=7`; or one
/// of the few of `SHORT`: `physics=batched` means `fleet.physics=batched`.
pub(crate) fn parse(text: &str) -> Result<Assignment, String> {
    let Some((key, value)) = text.split_once('=') else {
        return Err("expected key=value, as in ppo.epochs=4".to_owned());
    };
    let mut path: Vec<String> = key.split('.').map(|part| part.trim().to_owned()).collect();
    if path.iter().any(String::is_empty) {
        return Err(format!(
            "`{key}` is not a key; expected section.key, as in ppo.epochs=4"
        ));
    }
    if LAYERING.contains(&&*path[0]) {
        return Err(format!(
            "`{}` belongs into the file of a preset, above its first section, and no option can set it: write such a \
             file and give it with --preset",
            path[0]
        ));
    }
    let value = parse_value(value.trim())?;
    if path.len() == 1 && !value.is_table() {
        let of_another = SHORT.iter().find(|(key, _)| *key == path[0]);
        let section = of_another.map_or("run", |(_, section)| section);
        path.insert(0, section.to_owned());
    }
    Ok(Assignment { path, value })
}

fn parse_value(text: &str) -> Result<Value, String> {
    if text.is_empty() {
        return Err("the value is missing".to_owned());
    }
    match toml::from_str::<Table>(&format!("value = {text}")) {
        Ok(mut table) if table.len() == 1 => {
            table.remove("value").ok_or_else(|| "no value".to_owned())
        }
        _ if is_whole(text) => Err(format!(
            "the number is too large: whole numbers go from {} to {}",
            i64::MIN,
            i64::MAX
        )),
        // `overlapped` for `"overlapped"`: shells eat quotes, so a bare word is taken as text.
        _ if !text.starts_with(['[', '{', '"', '\'']) && !text.contains('\n') => {
            Ok(Value::String(text.to_owned()))
        }
        Ok(_) => Err("expected one value".to_owned()),
        Err(error) => Err(format!("the value is not TOML: {}", error.message())),
    }
}

/// Whether it is a whole number, however long.
fn is_whole(text: &str) -> bool {
    let digits = text.strip_prefix(['+', '-']).unwrap_or(text);
    // 007 is a word: TOML knows no such number, and it may be a name.
    !digits.starts_with('0') && !digits.is_empty() && digits.bytes().all(|b| b.is_ascii_digit())
}

/// Puts the value at its path, making the tables on the way. A table as value replaces what was there: an enum has one
/// variant, and merging two would make it ambiguous.
pub(crate) fn put(table: &mut Table, path: &[String], value: Value) -> Result<(), String> {
    let Some((last, parents)) = path.split_last() else {
        return Err("a value needs a key".to_owned());
    };
    let mut table = table;
    for name in parents {
        let entry = table
            .entry(name.as_str())
            .or_insert_with(|| Value::Table(Table::new()));
        if entry.is_array() {
            return Err(format!(
                "`{name}` is a list; give the whole list, as in {name}=[…]"
            ));
        }
        if !entry.is_table() {
            *entry = Value::Table(Table::new());
        }
        let Value::Table(inner) = entry else {
            unreachable!("just made a table")
        };
        table = inner;
    }
    table.insert(last.clone(), value);
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parsed(text: &str) -> (String, Value) {
        let assignment = parse(text).unwrap();
        (assignment.path.join("."), assignment.value)
    }

    #[test]
    fn values_have_their_toml_types() {
        assert_eq!(parsed("seed=7"), ("run.seed".to_owned(), Value::Integer(7)));
        assert_eq!(
            parsed("ppo.clip = 0.2"),
            ("ppo.clip".to_owned(), Value::Float(0.2))
        );
        assert_eq!(
            parsed("motion.mirror=false"),
            ("motion.mirror".to_owned(), Value::Boolean(false))
        );
        assert_eq!(
            parsed("run.mode=overlapped").1,
            Value::String("overlapped".to_owned())
        );
        assert_eq!(
            parsed("run.mode=\"overlapped\"").1,
            Value::String("overlapped".to_owned())
        );
        assert_eq!(
            parsed("policy.hidden=[8, 4]").1,
            Value::Array(vec![Value::Integer(8), Value::Integer(4)])
        );
    }

    #[test]
    fn malformed_assignments_say_what_was_expected() {
        assert!(parse("seed").unwrap_err().contains("key=value"));
        assert!(parse("ppo.=1").unwrap_err().contains("section.key"));
        assert!(parse("ppo.clip=").unwrap_err().contains("missing"));
        assert!(parse("policy.hidden=[1,").unwrap_err().contains("not TOML"));
        // 2⁶³, one more than there is.
        let large = parse("seed=9223372036854775808").unwrap_err();
        assert!(large.contains("too large"), "{large}");
        assert_eq!(parsed("seed=9223372036854775807").1, i64::MAX.into());
    }

    #[test]
    fn what_a_preset_says_of_presets_is_no_value() {
        for given in ["on=g1", "unset=[\"ppo.epochs\"]", "unset={}", "on.x=1"] {
            let said = parse(given).unwrap_err();
            assert!(
                said.contains("file of a preset") && said.contains("--preset"),
                "{said}"
            );
        }
    }

    #[test]
    fn a_table_replaces_and_a_path_goes_inside() {
        let mut table: Table =
            toml::from_str("[scheduler]\nmethod = { amp = { style_weight = 0.5 } }").unwrap();
        let inside = parse("scheduler.method.amp.style_weight=0.7").unwrap();
        put(&mut table, &inside.path, inside.value).unwrap();
        assert_eq!(
            table["scheduler"]["method"]["amp"]["style_weight"].as_float(),
            Some(0.7)
        );

        let whole = parse("scheduler.method={ ampco = {} }").unwrap();
        put(&mut table, &whole.path, whole.value).unwrap();
        assert_eq!(table["scheduler"]["method"].as_table().unwrap().len(), 1);
    }

    #[test]
    fn a_list_cannot_be_entered() {
        let mut table: Table = toml::from_str("[motion]\nclips = [{ gait = \"walk\" }]").unwrap();
        let entry = parse("motion.clips.weight=2").unwrap();
        assert!(
            put(&mut table, &entry.path, entry.value)
                .unwrap_err()
                .contains("is a list")
        );
    }
}

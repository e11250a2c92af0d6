//! What serde says of a value of the wrong kind, in the words of TOML.
//!
//! Separate because whoever writes a file knows whole numbers, lists and tables; `usize`, sequences and structs are words of
//! the program's language.

use crate::nearest;

/// A complaint of serde about a value, as what to give instead; any other words as they are.
pub fn plain(words: &str) -> String {
    for (unknown, thing) in [("unknown field ", "key"), ("unknown variant ", "choice")] {
        let names: Vec<&str> = words.split('`').skip(1).step_by(2).collect();
        if let (true, Some(name)) = (words.starts_with(unknown), names.first()) {
            let remedy = match &names[1..] {
                [] => "there is none in its place; take it away".to_owned(),
                known => nearest::remedy(name, known),
            };
            return format!("unknown {thing} `{name}`; {remedy}");
        }
    }
    if let Some(field) = words.strip_prefix("missing field ") {
        return format!("{field} is missing; give it as well");
    }
    if let Some(field) = words.strip_prefix("duplicate field ") {
        return format!("{field} is given twice; keep one of the two");
    }
    if words.starts_with("wanted exactly 1 element")
        || words.starts_with("expected table with exactly 1 entry")
    {
        return "name one choice, and one alone".to_owned();
    }
    let kinds = ["invalid type: ", "invalid value: ", "invalid length "];
    let found = kinds.iter().any(|kind| words.starts_with(kind));
    match words.rsplit_once(", expected ") {
        Some((_, expected)) if found => format!("give {}", kind(expected)),
        _ => words.to_owned(),
    }
}

/// What serde expects, as TOML calls it.
fn kind(expected: &str) -> String {
    let whole = |most: &str| format!("a whole number from 0 to {most}");
    let said = match expected {
        "u8" => return whole("255"),
        "u16" => return whole("65535"),
        "u32" => return whole("4294967295"),
        // There are more of them than in TOML.
        "u64" | "usize" | "u128" => "a whole number from 0 on",
        "i8" | "i16" | "i32" | "i64" | "isize" | "i128" => "a whole number",
        "f32" | "f64" => "a number",
        "a boolean" => "true or false",
        "a string" | "a borrowed string" | "path string" | "a character" => {
            "text in quotation marks"
        }
        "a sequence" => "a list, in square brackets",
        "fewer elements in array" | "fewer elements in sequence" => "a list of fewer values",
        "a map" => "a table of keys",
        "string only" | "unit variant" => "the name of one choice, as text in quotation marks",
        _ => "",
    };
    if !said.is_empty() {
        return said.to_owned();
    }
    let length = ["an array of length ", "a tuple of size "];
    if let Some(length) = length.iter().find_map(|start| expected.strip_prefix(start)) {
        return format!("a list of {length} values");
    }
    let starts = |start: &str| expected.starts_with(start);
    if starts("struct variant") || starts("newtype variant") || starts("tuple variant") {
        return "this choice with a table of its parameters".to_owned();
    }
    if starts("struct ") || starts("internally tagged") || starts("adjacently tagged") {
        return "a table of keys".to_owned();
    }
    if starts("enum ") {
        return "the name of one choice".to_owned();
    }
    expected.to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_wrong_kind_is_told_in_words_of_toml() {
        for (said, expected) in [
            (
                "invalid type: floating point `1.5`, expected usize",
                "give a whole number from 0 on",
            ),
            (
                "invalid value: integer `-1`, expected u32",
                "give a whole number from 0 to 4294967295",
            ),
            (
                "invalid type: string \"a, expected b\", expected f32",
                "give a number",
            ),
            (
                "invalid type: integer `3`, expected a sequence",
                "give a list, in square brackets",
            ),
            (
                "invalid length 3, expected an array of length 2",
                "give a list of 2 values",
            ),
            (
                "invalid type: integer `3`, expected struct Row",
                "give a table of keys",
            ),
            (
                "invalid type: integer `3`, expected struct variant Method::Amp",
                "give this choice with a table of its parameters",
            ),
            (
                "invalid type: integer `3`, expected a boolean",
                "give true or false",
            ),
            (
                "unknown field `titel`, expected one of `title`, `stages`",
                "unknown key `titel`; did you mean `title`?",
            ),
            (
                "unknown variant `zzz`, expected `a` or `b`",
                "unknown choice `zzz`; known: `a`, `b`",
            ),
            (
                "missing field `range`",
                "`range` is missing; give it as well",
            ),
            (
                "wanted exactly 1 element, more than 1 element",
                "name one choice, and one alone",
            ),
        ] {
            assert_eq!(plain(said), expected);
        }
    }

    #[test]
    fn other_words_stay() {
        for words in ["give more", "key with no value, expected `=`"] {
            assert_eq!(plain(words), words);
        }
    }
}

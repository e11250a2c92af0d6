//! How messages to people are worded: counts, what is shown of a file's content, what a file is that is not what its
//! name says, the closest names, and the complaints of a reader of TOML in TOML's words.
//!
//! Separate, and below everything, because whatever reads a file echoes what it could not use: motion, configuration,
//! studies, metrics. A file that is something else may be a single line of megabytes, with bytes that a terminal obeys.

#![forbid(unsafe_code)]

mod foreign;
pub mod nearest;
mod plain;

pub use foreign::{Foreign, foreign};
pub use plain::plain;

use std::fmt::Display;
use std::ops::Range;

/// Most characters of a file's content that a message shows.
pub const SHOWN: usize = 100;

/// Most characters of the words of a parser, which may quote content.
pub const SAID: usize = 600;

/// So much before the place of an error is shown of its line.
const BEFORE: usize = 30;

/// "1 actor", "2 actors", "0 processes", "2 entries". In a phrase of several words the last one takes the plural.
pub fn count<N: Display + PartialEq + From<u8>>(number: N, thing: &str) -> String {
    if number == N::from(1) {
        return format!("1 {thing}");
    }
    let before_y = thing.strip_suffix('y');
    match before_y.filter(|stem| !stem.ends_with(['a', 'e', 'i', 'o', 'u'])) {
        Some(stem) => format!("{number} {stem}ies"),
        None if ["s", "x", "ch", "sh"]
            .iter()
            .any(|end| thing.ends_with(end)) =>
        {
            format!("{number} {thing}es")
        }
        None => format!("{number} {thing}s"),
    }
}

/// The first line of `text` in at most [`SHOWN`] characters; … says that there was more. What a terminal would obey is
/// escaped.
pub fn line(text: &str) -> String {
    cut(text.trim(), SHOWN, false)
}

/// As [`line()`], in quotation marks, with those inside escaped: for a word or a cell of a file.
pub fn quoted(text: &str) -> String {
    format!("\"{}\"", cut(text, SHOWN - 2, true))
}

/// A message of any number of lines without what a terminal would obey: whoever chose the name of a file that it names
/// chose that too.
pub fn harmless(message: &str) -> String {
    let mut shown = String::with_capacity(message.len());
    for c in message.chars() {
        if c.is_control() && !matches!(c, '\n' | '\t') {
            shown.extend(c.escape_debug());
        } else {
            shown.push(c);
        }
    }
    shown
}

/// The words of a parser or of another library in one line of at most [`SAID`] characters; each thing that they quote
/// has at most [`SHOWN`].
pub fn said(words: &str) -> String {
    let mut shown = String::new();
    let mut rest = words.trim();
    let mut inside = false;
    while !rest.is_empty() {
        let end = rest.find(['`', '"']).unwrap_or(rest.len());
        let (piece, from) = rest.split_at(end);
        let piece = piece.replace(['\n', '\r'], " ");
        shown += &if inside {
            cut(&piece, SHOWN, false)
        } else {
            // The parser's own words, unless content has quotation marks in it; but a number may have 300 digits.
            let words: Vec<String> = piece
                .split(' ')
                .map(|word| cut(word, SHOWN, false))
                .collect();
            cut(&words.join(" "), 2 * SHOWN, false)
        };
        let mark = from.chars().next();
        shown.extend(mark);
        rest = &from[mark.map_or(0, char::len_utf8)..];
        inside = !inside;
    }
    if length(&shown) <= SAID {
        return shown;
    }
    // The end often says what was expected.
    let tail: String = shown.chars().skip(length(&shown) - SAID / 3).collect();
    format!("{} {tail}", cut(&shown, SAID - SAID / 3 - 1, false))
}

/// Why `text` cannot be parsed, in one line: what the file is instead, if that is known; else line, column, the words of
/// the parser and a piece of the line. `place` is in bytes.
pub fn refusal(text: &str, place: Option<Range<usize>>, words: &str) -> String {
    if let Some(foreign) = foreign(text.as_bytes()) {
        return foreign.to_string();
    }
    let words = said(words);
    let Some(at) = place.map(|place| text.floor_char_boundary(place.start)) else {
        return words;
    };
    let start = text[..at].rfind('\n').map_or(0, |newline| newline + 1);
    let number = text[..at].matches('\n').count() + 1;
    let column = length(&text[start..at]) + 1;
    let before: Vec<usize> = text[start..at]
        .char_indices()
        .map(|(i, _)| start + i)
        .collect();
    let from = before
        .len()
        .checked_sub(BEFORE)
        .map_or(start, |i| before[i]);
    let piece = text[from..].split('\n').next().unwrap_or_default();
    format!(
        "line {number}, column {column}: {words}, in {}",
        quoted(piece.trim_end())
    )
}

/// The text of a file, or what it is instead.
///
/// # Errors
/// What the bytes are, where they are not UTF-8.
pub fn text(bytes: Vec<u8>) -> Result<String, Foreign> {
    String::from_utf8(bytes).map_err(|error| {
        foreign(error.as_bytes()).unwrap_or(Foreign {
            what: "no text (it is not UTF-8)",
            remedy: "save it as UTF-8, or give another file",
        })
    })
}

/// The first line of `text` in at most `most` characters, escapes counted as they are written.
fn cut(text: &str, most: usize, quotes: bool) -> String {
    let (mut shown, mut count) = (String::new(), 0);
    // Up to where it is kept if … has to follow.
    let mut kept = 0;
    let mut characters = text.chars();
    while let Some(c) = characters.next() {
        let ends = matches!(c, '\n' | '\r');
        if ends && characters.all(char::is_whitespace) {
            return shown;
        }
        let plain = !quotes && matches!(c, '"' | '\'' | '\\');
        let written: String = if plain {
            c.into()
        } else {
            c.escape_debug().collect()
        };
        count += length(&written);
        if ends || count > most {
            shown.truncate(kept);
            shown.push('…');
            return shown;
        }
        shown += &written;
        if count < most {
            kept = shown.len();
        }
    }
    shown
}

fn length(text: &str) -> usize {
    text.chars().count()
}

#[cfg(test)]
mod tests;

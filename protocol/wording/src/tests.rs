//! Content that nobody wants to see whole, and files that are something else.

use super::*;

#[test]
fn one_is_not_many() {
    assert_eq!(count(1_usize, "actor"), "1 actor");
    assert_eq!(count(0_u64, "actor"), "0 actors");
    assert_eq!(count(2, "process"), "2 processes");
    assert_eq!(count(3, "entry"), "3 entries");
    assert_eq!(count(3, "day"), "3 days");
    assert_eq!(count(2, "Git branch"), "2 Git branches");
    assert_eq!(count(1, "process"), "1 process");
}

#[test]
fn a_short_word_is_shown_as_it_is() {
    assert_eq!(quoted("knee"), "\"knee\"");
    assert_eq!(line("  knee, hip\n"), "knee, hip");
    assert_eq!(line(""), "");
}

#[test]
fn one_line_and_a_hundred_characters_are_shown() {
    // 98 between the quotation marks: 97 letters and the sign that there is more.
    assert_eq!(
        quoted(&"a".repeat(1_800_000)),
        format!("\"{}…\"", "a".repeat(97))
    );
    assert_eq!(line(&"é".repeat(500)), format!("{}…", "é".repeat(99)));
    assert_eq!(line(&"a".repeat(100)), "a".repeat(100));
    assert_eq!(quoted("first\nsecond"), "\"first…\"");
    assert_eq!(line("first\n\n"), "first");
}

#[test]
fn what_a_terminal_would_obey_is_escaped() {
    assert_eq!(line("\x1b[2Jgone\x07\tx"), "\\u{1b}[2Jgone\\u{7}\\tx");
    // Text that would run from right to left.
    assert_eq!(quoted("a\u{202e}b"), "\"a\\u{202e}b\"");
    assert_eq!(quoted("say \"a\\b\""), "\"say \\\"a\\\\b\\\"\"");
    assert_eq!(line("say \"a\\b\""), "say \"a\\b\"");
    // An escape is not cut in two: nine of ten characters fit, and … .
    assert_eq!(cut("abcd\x1b\x1b", 10, false), "abcd…");
}

#[test]
fn a_message_keeps_its_lines_and_moves_no_cursor() {
    assert_eq!(
        harmless("a:\n\tb \x1b[2K\r\u{9b}"),
        "a:\n\tb \\u{1b}[2K\\r\\u{9b}"
    );
}

#[test]
fn a_parser_keeps_its_words_but_not_what_it_quotes() {
    let long = "x".repeat(5_000);
    let words = format!("unknown field `{long}`, expected one of `a`, `b`");
    let expected = format!(
        "unknown field `{}…`, expected one of `a`, `b`",
        "x".repeat(99)
    );
    assert_eq!(said(&words), expected);
    assert_eq!(said("one\ntwo"), "one two");
    let far = said(&format!("a place 1{} m away", "0".repeat(300)));
    assert_eq!(far, format!("a place 1{}… m away", "0".repeat(98)));
    // Content that is full of quotation marks, and content that is not quoted at all.
    for hostile in [
        "\"` ".repeat(9_000),
        "y ".repeat(9_000),
        format!("`{}", "\x1b".repeat(900)),
    ] {
        let shown = said(&hostile);
        assert!(shown.chars().count() <= SAID, "{}", shown.chars().count());
        assert!(!shown.contains(char::is_control), "{shown:?}");
    }
}

#[test]
fn a_refusal_names_line_and_column_and_shows_a_piece() {
    let text = "a = 1\nb = = 2\n";
    let place = text.find("= 2").map(|at| at..at + 1);
    assert_eq!(
        refusal(text, place, "no value"),
        "line 2, column 5: no value, in \"b = = 2\""
    );
    assert_eq!(refusal(text, None, "no value"), "no value");
    // The end of a text without a last line break, and a place within a letter.
    assert_eq!(
        refusal("é", Some(1..2), "no"),
        "line 1, column 1: no, in \"é\""
    );
    assert_eq!(
        refusal("ab", Some(9..9), "no"),
        "line 1, column 3: no, in \"ab\""
    );
    // 30 letters before the place are shown of a long line.
    let long = format!("{}!{}", "a".repeat(9_000), "b".repeat(9_000));
    let piece = format!("{}!{}…", "a".repeat(30), "b".repeat(66));
    assert_eq!(
        refusal(&long, Some(9_000..9_001), "no"),
        format!("line 1, column 9001: no, in \"{piece}\"")
    );
    let page = refusal("<!DOCTYPE html><p>", Some(0..1), "no");
    assert!(page.starts_with("it is a web page (HTML);"), "{page}");
}

fn what(bytes: &[u8]) -> Option<&'static str> {
    foreign(bytes).map(|foreign| foreign.what)
}

#[test]
fn files_are_known_by_their_first_bytes() {
    let pointer = b"version https://git-lfs.github.com/spec/v1\noid sha256:4d7a\nsize 12345\n";
    assert_eq!(
        what(pointer),
        Some("a Git LFS pointer and not the file itself")
    );
    assert_eq!(what(b"Kaydara FBX Binary  \0\x1a\0"), Some("an FBX file"));
    assert_eq!(
        what(b"; FBX 7.4.0 project file\n"),
        Some("an FBX file (as text)")
    );
    assert_eq!(what(b"\x1f\x8b\x08\0"), Some("compressed (gzip)"));
    assert_eq!(what(b"\xff\xfex\0,\0"), Some("text in UTF-16"));
    assert_eq!(what(b""), Some("empty"));
    assert!(what(&[0; 100]).is_some_and(|what| what.contains("zeros")));
    let mut c3d = [0; 512];
    (c3d[0], c3d[1]) = (2, 0x50);
    assert!(what(&c3d).is_some_and(|what| what.contains("C3D")));
}

#[test]
fn pages_are_known_behind_what_may_stand_before_them() {
    let page = Some("a web page (HTML)");
    assert_eq!(what(b"<!DOCTYPE html>\n<html>"), page);
    assert_eq!(what(b"\xef\xbb\xbf\r\n  <HTML lang=en>"), page);
    assert_eq!(what(b"<!-- saved from x -->\n<html>"), page);
    assert_eq!(what(b"<?xml version=\"1.0\"?><html xmlns=\"x\">"), page);
    let denied = b"<?xml version=\"1.0\"?>\n<Error><Code>AccessDenied</Code></Error>";
    assert_eq!(what(denied), Some("the error message of a server (XML)"));
    assert_eq!(what(b"<a/>"), Some("XML"));
}

#[test]
fn what_may_be_motion_or_configuration_is_left_alone() {
    for bytes in [
        &b"PK\x03\x04"[..],
        b"\x93NUMPY\x01\0",
        b"\x80\x04\x95",
        b"HIERARCHY\nROOT Hips",
        b"#!OML:ASF x\n:FULLY-SPECIFIED\n",
        b"x,y,z\n1,2,3",
        b"1,2,3",
        b"{\"Frames\": []}",
        b"[run]\nseed = 1",
        b"version = 1",
    ] {
        assert_eq!(what(bytes), None, "{}", String::from_utf8_lossy(bytes));
    }
    assert_eq!(text(b"[run]".to_vec()), Ok("[run]".to_owned()));
    let refused = text(vec![b'a', 0xff]).unwrap_err();
    assert!(refused.what.contains("UTF-8"));
}

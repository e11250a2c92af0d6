//! `ampco motions import` of many files, good and bad: what is said, what is written, on one core and on all.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::process::Command;

use serde_json::Value;

use crate::harness::{Process, Runs, program};

/// Files of which none can be imported, and a part of the reason.
const BAD: [(&str, &[u8], &str); 12] = [
    (
        "a_pointer.npz",
        b"version https://git-lfs.github.com/spec/v1\noid sha256:4d7a\nsize 9\n",
        "Git LFS pointer",
    ),
    (
        "b_page.bvh",
        b"<!DOCTYPE html><html><body>Sign in</body></html>",
        "web page",
    ),
    ("c_empty.csv", b"", "is empty"),
    ("d_fbx.bvh", b"Kaydara FBX Binary  \0\x1a\0", "FBX"),
    ("e_cut.npz", b"PK\x03\x04 cut off", "archive"),
    ("f_short.csv", b"1,2,3\n", "3 columns"),
    ("g_one.csv", b"7\n", "1 column;"),
    ("h_words.csv", b"x,y,z\n1,2,3\n", "column"),
    (
        "i_alone.amc",
        b":FULLY-SPECIFIED\n:DEGREES\n1\nroot 0 0 0 0 0 0\n",
        "skeleton",
    ),
    ("j_code.pkl", b"\x80\x04cos\nsystem\n(tR.", "os.system"),
    ("k_zeros.npy", &[0; 64], "zeros"),
    (
        "l_cut.bvh",
        b"HIERARCHY\nROOT Hips\n{\nOFFSET 0 0 0\n",
        "cut off",
    ),
];

/// Built-in gaits as tables: sound clips.
const GOOD: usize = 18;

/// 30 files, good and bad in turns as their names have it.
fn files(folder: &Path) {
    fs::create_dir(folder).expect("made");
    for (name, bytes, _) in BAD {
        fs::write(folder.join(name), bytes).expect("written");
    }
    for i in 0..GOOD {
        let mut clip = motion::gait::walk(0.4 + 0.05 * i as f64)
            .expect("a gait")
            .unrolled(4.0);
        clip.frames.truncate(200);
        let letter = char::from(b'a' + i as u8);
        let table = motion::export::to_csv(&clip, &[]);
        fs::write(folder.join(format!("{letter}_walk.csv")), table).expect("written");
    }
}

/// Status, standard output and standard error of an import of all files.
fn import(place: &Path, arguments: &[&str]) -> (Option<i32>, String, String) {
    let mut command = Command::new(program("ampco"));
    command
        .args(["motions", "import"])
        .args(arguments)
        .current_dir(place);
    let mut process = Process::start(command);
    let status = process.end();
    (status.code(), process.stdout.text(), process.stderr.text())
}

fn content(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let entries = fs::read_dir(folder).expect("a folder").flatten();
    let file = |entry: fs::DirEntry| {
        let name = entry.file_name().to_string_lossy().into_owned();
        (name, fs::read(entry.path()).expect("readable"))
    };
    entries.map(file).collect()
}

#[test]
fn thirty_mixed_files_end_with_a_summary() {
    let place = Runs::new();
    files(&place.path().join("mixed"));
    let (status, out, err) = import(place.path(), &["mixed", "--out", "clips"]);
    assert_eq!(status, Some(1), "{err}");
    assert!(
        out.contains("\n30 files: 18 imported without defects, 12 failed\n"),
        "{out}"
    );
    assert!(out.contains("\n18 clips, 1.2 min, in clips\n"), "{out}"); // 18 × 4 s
    assert_eq!(
        out.lines().filter(|line| line.contains("_walk ")).count(),
        GOOD,
        "{out}"
    );
    let complaint = err.split("ampco: ").last().expect("a complaint");
    assert!(
        complaint.starts_with("12 of 30 files not imported:\n"),
        "{err}"
    );
    // A line per file, in their order.
    let lines: Vec<&str> = complaint.lines().skip(1).collect();
    assert_eq!(lines.len(), BAD.len(), "{complaint}");
    for (line, (name, _, reason)) in lines.iter().zip(BAD) {
        assert!(line.starts_with(&format!("  mixed/{name}")), "{line}");
        assert!(line.contains(reason) && line.len() < 400, "{line}");
    }
    // A clip and its account per good file.
    assert_eq!(content(&place.path().join("clips")).len(), 2 * GOOD);
}

#[test]
fn many_at_once_write_the_same_bytes_in_the_same_order_as_one_by_one() {
    let place = Runs::new();
    files(&place.path().join("mixed"));
    let one = import(
        place.path(),
        &["mixed", "--out", "one", "--jobs", "1", "--verbose"],
    );
    let many = import(
        place.path(),
        &["mixed", "--out", "all", "--jobs", "16", "--verbose"],
    );
    assert_eq!(one.0, Some(1), "{}", one.2);
    assert_eq!(one.0, many.0);
    let renamed = many
        .1
        .replace("in all\n", "in one\n")
        .replace("\"all\"", "\"one\"");
    assert_eq!(one.1, renamed);
    let complaint = |said: &str| said.split("ampco: ").last().map(str::to_owned);
    assert_eq!(complaint(&one.2), complaint(&many.2));
    let (one, many) = (
        content(&place.path().join("one")),
        content(&place.path().join("all")),
    );
    assert!(one == many, "{:?} and {:?}", one.keys(), many.keys());
    let (status, _, said) = import(place.path(), &["mixed", "--out", "none", "--jobs", "0"]);
    assert_eq!(status, Some(2), "{said}");
}

#[test]
fn programs_read_what_became_of_every_file() {
    let place = Runs::new();
    files(&place.path().join("mixed"));
    let (status, out, _) = import(place.path(), &["mixed", "--out", "clips", "--json"]);
    assert_eq!(status, Some(1));
    let rows: Vec<Value> = serde_json::from_str(&out).expect("one JSON array");
    assert_eq!(rows.len(), 30);
    let outcome = |outcome: &str| rows.iter().filter(|row| row["outcome"] == outcome).count();
    assert_eq!((outcome("imported"), outcome("failed")), (GOOD, BAD.len()));
    let sources: Vec<&str> = rows
        .iter()
        .filter_map(|row| row["source"].as_str())
        .collect();
    assert!(sources.is_sorted(), "{sources:?}");
    let first = &rows[0];
    assert_eq!(
        (&first["source"], &first["outcome"]),
        (&"mixed/a_pointer.npz".into(), &"failed".into())
    );
    assert!(
        first["problem"]
            .as_str()
            .is_some_and(|words| words.contains("Git LFS")),
        "{first}"
    );
}

#[test]
fn one_file_is_told_of_without_counts() {
    let place = Runs::new();
    files(&place.path().join("mixed"));
    let (status, out, err) = import(place.path(), &["mixed/c_empty.csv", "--out", "clips"]);
    assert_eq!((status, out.as_str()), (Some(1), ""));
    assert_eq!(
        err,
        "ampco: mixed/c_empty.csv: is empty; download or export it again\n"
    );
    assert!(
        !place.path().join("clips").exists(),
        "an empty folder is left behind"
    );
    let (status, out, err) = import(place.path(), &["mixed/a_walk.csv", "--out", "clips"]);
    assert_eq!(status, Some(0), "{err}");
    assert!(out.contains("1 clip, 0.1 min, in clips"), "{out}");
}

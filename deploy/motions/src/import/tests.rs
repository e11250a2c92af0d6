//! Imports as users type them, again and again.

use super::*;
use clap::Parser;
use std::fmt::Write as _;
use std::fs;

#[derive(Debug, Parser)]
struct Line {
    #[command(flatten)]
    import: Import,
}

/// Runs `import` with arguments.
fn import(arguments: &[&str]) -> Result<(), String> {
    let line = Line::try_parse_from(std::iter::once(&"import").chain(arguments));
    let line = line.map_err(|e| e.to_string())?;
    line.import.run().map_err(|e| format!("{e:#}"))
}

/// A table as Unitree's: 36 columns, no header, the scalar of quaternions last.
fn unitree() -> String {
    let mut text = String::new();
    for frame in motion::gait::walk(1.0).unwrap().unrolled(2.0).frames {
        let (p, q, j) = (frame.position, frame.orientation, frame.joint_positions);
        write!(
            text,
            "{},{},{},{},{},{},{}",
            p.x, p.y, p.z, q.i, q.j, q.k, q.w
        )
        .unwrap();
        // Six joints more: roll and pitch of the waist after its yaw, two at each wrist.
        let waist = j[..13].iter().chain(&[0.0; 2]);
        let arms = j[13..]
            .chunks(5)
            .flat_map(|arm| arm.iter().chain(&[0.0; 2]));
        waist
            .chain(arms)
            .for_each(|q| write!(text, ",{q}").unwrap());
        text.push('\n');
    }
    text
}

#[test]
fn a_source_stays_as_it_is_however_often_it_is_imported() {
    let folder = tempfile::tempdir().unwrap();
    let g1 = folder.path().join("g1");
    fs::create_dir(&g1).unwrap();
    let source = g1.join("a.csv");
    fs::write(&source, unitree()).unwrap();
    let (file, own) = (source.to_str().unwrap(), g1.to_str().unwrap());
    for paths in [file, own] {
        for _ in 0..2 {
            let message = import(&[paths, "--fps", "30", "--out", own]).unwrap_err();
            assert!(
                message.contains("is one of the files that are read"),
                "{message}"
            );
            assert_eq!(fs::read_to_string(&source).unwrap(), unitree());
            assert_eq!(fs::read_dir(&g1).unwrap().count(), 1);
        }
    }
}

#[test]
fn imported_twice_it_is_the_same_and_its_clips_are_not_slowed() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    fs::create_dir(at("unitree")).unwrap();
    fs::write(at("unitree/a.csv"), unitree()).unwrap();
    let words = ["--fps", "30", "--out"];
    let line = |from: &str, out: &str| {
        import(&[&[at(from).as_str()], &words[..], &[at(out).as_str()]].concat())
    };
    line("unitree/a.csv", "g1").unwrap();
    let first = fs::read(at("g1/a.csv")).unwrap();
    line("unitree/a.csv", "g1").unwrap();
    assert_eq!(fs::read(at("g1/a.csv")).unwrap(), first);
    // Its clip states 50 frames a second: 30 would slow it.
    let message = line("g1/a.csv", "again").unwrap_err();
    assert!(message.contains("0.60 times as fast"), "{message}");
    import(&[&at("g1/a.csv"), "--out", &at("again")]).unwrap();
    let numbers = |bytes: &[u8]| -> Vec<String> {
        let text = String::from_utf8_lossy(bytes).into_owned();
        let lines = text.lines().filter(|line| !line.starts_with('#'));
        lines.map(String::from).collect()
    };
    let again = fs::read(at("again/a.csv")).unwrap();
    assert_eq!(numbers(&again), numbers(&first));
}

#[test]
fn a_folder_that_is_imported_into_itself_does_not_grow() {
    let folder = tempfile::tempdir().unwrap();
    let root = folder.path().to_str().unwrap();
    fs::write(folder.path().join("a.npz"), "PK").unwrap(); // no motion, but a file
    fs::create_dir(folder.path().join("in")).unwrap();
    fs::write(folder.path().join("in/b.csv"), unitree()).unwrap();
    for _ in 0..2 {
        let message = import(&[root, "--fps", "30", "--out", root]).unwrap_err();
        assert!(message.contains("1 of 2 files not imported"), "{message}");
        let mut names: Vec<String> = fs::read_dir(root)
            .unwrap()
            .map(|entry| entry.unwrap().file_name().into_string().unwrap())
            .collect();
        names.sort();
        assert_eq!(names, ["a.npz", "in", "in_b.csv", "in_b.json"]);
    }
}

#[test]
fn a_report_of_somebody_else_stops_it_before_anything_is_written() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    fs::write(at("a.csv"), unitree()).unwrap();
    fs::create_dir(at("out")).unwrap();
    fs::write(at("out/a.json"), "{\"mine\": 1}").unwrap();
    let message = import(&[&at("a.csv"), "--fps", "30", "--out", &at("out")]).unwrap_err();
    assert!(
        message.contains("a.json is there and was not written"),
        "{message}"
    );
    assert_eq!(
        fs::read_to_string(at("out/a.json")).unwrap(),
        "{\"mine\": 1}"
    );
    assert!(!folder.path().join("out/a.csv").exists());
    assert!(
        import(&[&at("a.csv"), "--force-fps", "--out", &at("out")])
            .unwrap_err()
            .contains("--fps")
    );
}

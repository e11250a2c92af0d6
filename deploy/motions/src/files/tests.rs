//! Which files are found, and in which order they come back.

use super::super::output::Output;
use super::*;
use std::fs;
use std::os::unix::fs::symlink;
use std::process::Command;

fn sources(paths: Vec<PathBuf>) -> Sources {
    Sources {
        paths,
        format: None,
        fps: None,
        force_fps: false,
        quaternion: None,
        skeleton: None,
        jobs: None,
        no_ground: false,
    }
}

#[test]
fn folders_are_searched_and_their_names_kept() {
    let folder = tempfile::tempdir().unwrap();
    let root = folder.path();
    fs::create_dir_all(root.join("CMU/02")).unwrap();
    for file in [
        "CMU/02/b.npz",
        "CMU/02/a.NPZ",
        "walk.csv",
        "walk_0.50.csv",
        "walk_0.98.csv",
        "notes.txt",
        "CMU/readme",
    ] {
        fs::write(root.join(file), "").unwrap();
    }
    let found = sources(vec![root.into()]).found().unwrap();
    let names: Vec<&str> = found.iter().map(|s| s.name.as_str()).collect();
    assert_eq!(
        names,
        ["CMU_02_a", "CMU_02_b", "walk", "walk_0.50", "walk_0.98"]
    );
    // Given again, by whatever name, they are taken once.
    let again = vec![root.into(), root.join("CMU/../walk.csv"), root.into()];
    assert_eq!(sources(again).found().unwrap(), found);
    let empty = tempfile::tempdir().unwrap();
    assert!(sources(vec![empty.path().into()]).found().is_err());
}

/// A zip archive of empty files.
fn archive(names: &[&str]) -> Vec<u8> {
    let (mut files, mut directory) = (Vec::<u8>::new(), Vec::<u8>::new());
    for name in names {
        // Version 2.0, no flags, stored, 1 January 1980, and no bytes, whose checksum is 0.
        let mut about = vec![20, 0, 0, 0, 0, 0, 0, 0, 0x21, 0];
        about.extend([0; 12]);
        about.extend((name.len() as u16).to_le_bytes());
        about.extend([0, 0]);
        let offset = (files.len() as u32).to_le_bytes();
        files.extend(b"PK\x03\x04".iter().chain(&about).chain(name.as_bytes()));
        directory.extend(b"PK\x01\x02\x14\0".iter().chain(&about).chain(&[0; 10]));
        directory.extend(offset.iter().chain(name.as_bytes()));
    }
    let (count, at) = (names.len() as u16, files.len() as u32);
    let size = (directory.len() as u32).to_le_bytes();
    files.extend(directory);
    files.extend(b"PK\x05\x06\0\0\0\0");
    files.extend(count.to_le_bytes().repeat(2));
    files.extend(size.iter().chain(&at.to_le_bytes()).chain(&[0, 0]));
    files
}

#[test]
fn shapes_and_texts_that_are_no_motion_are_passed_over() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    fs::write(path("shape.npz"), archive(&["betas.npy", "gender.npy"])).unwrap();
    fs::write(
        path("poses.npz"),
        archive(&["betas.npy", "poses.npy", "trans.npy"]),
    )
    .unwrap();
    fs::write(path("walk.motion"), "").unwrap();
    fs::write(path("run.txt"), "{\"FrameDuration\": 0.02, \"Frames\": []}").unwrap();
    fs::write(path("license.txt"), "Frames of this data may be used").unwrap();
    fs::write(path("poses.json"), "{\"name\": \"poses\", \"frames\": 3}").unwrap();
    let found = sources(vec![folder.path().into()]).found().unwrap();
    let names: Vec<&str> = found.iter().map(|s| s.name.as_str()).collect();
    assert_eq!(names, ["poses", "run", "walk"]);
    // Named, it is not passed over, and fails with the reason.
    let reads = sources(vec![path("shape.npz")]).read().unwrap();
    let message = reads[0].outcome.as_ref().err().unwrap().to_string();
    assert!(
        message.contains("shape of a body and no motion"),
        "{message}"
    );
    // A folder of nothing else holds no motion.
    fs::remove_file(path("poses.npz")).unwrap();
    fs::remove_file(path("walk.motion")).unwrap();
    fs::remove_file(path("run.txt")).unwrap();
    assert!(sources(vec![folder.path().into()]).found().is_err());
}

#[test]
fn files_are_read_at_once_and_kept_in_order() {
    let folder = tempfile::tempdir().unwrap();
    let walk = motion::gait::walk(1.0).unwrap();
    for i in 0..8 {
        let clip = Clip {
            name: format!("walk{i}"),
            ..walk.clone()
        };
        let output = Output::new(folder.path(), &clip.name, "made".into());
        output.write(&clip, &[]).unwrap();
    }
    fs::write(folder.path().join("walk3.csv"), "broken").unwrap();
    let reads = sources(vec![folder.path().into()]).read().unwrap();
    assert_eq!(reads.len(), 8);
    for (i, read) in reads.iter().enumerate() {
        assert_eq!(read.source.name, format!("walk{i}"));
        assert_eq!(read.outcome.is_err(), i == 3);
    }
}

#[test]
fn links_lead_to_no_file_a_second_time() {
    let folder = tempfile::tempdir().unwrap();
    let root = folder.path();
    fs::create_dir(root.join("sub")).unwrap();
    fs::write(root.join("b.csv"), "").unwrap();
    fs::write(root.join("sub/c.csv"), "").unwrap();
    symlink(".", root.join("self")).unwrap();
    symlink("..", root.join("sub/up")).unwrap();
    symlink("sub", root.join("a")).unwrap();
    symlink("b.csv", root.join("a.csv")).unwrap();
    fs::hard_link(root.join("b.csv"), root.join("z.csv")).unwrap();
    symlink("loop", root.join("loop")).unwrap();
    let found = sources(vec![root.into()]).found().unwrap();
    let names: Vec<&str> = found.iter().map(|s| s.name.as_str()).collect();
    assert_eq!(names, ["b", "sub_c"]);
}

#[test]
fn files_of_one_name_are_told_apart_by_their_paths() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    for name in ["a.bvh", "a.csv", "b.csv"] {
        fs::write(path(name), "").unwrap();
    }
    let reads = sources(vec![folder.path().into()]).read().unwrap();
    let names: Vec<&str> = reads.iter().map(|r| r.source.name.as_str()).collect();
    let (bvh, csv) = (shown(&path("a.bvh")), shown(&path("a.csv")));
    assert_eq!(names, [bvh.as_str(), csv.as_str(), "b"]);
}

/// Why a file cannot be read.
fn refusal(options: Sources) -> String {
    let reads = options.read().unwrap();
    describe(reads[0].outcome.as_ref().err().unwrap())
}

#[test]
fn a_file_that_is_not_there_is_named_as_it_was_typed() {
    assert_eq!(
        refusal(sources(vec!["no/such.bvh".into()])),
        "no/such.bvh: cannot be read: No such file or directory (os error 2); check its name"
    );
}

#[test]
fn what_is_no_regular_file_is_refused_and_not_waited_at() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    let pipe = |name: &str| {
        let made = Command::new("mkfifo").arg(path(name)).status().unwrap();
        assert!(made.success());
    };
    for name in ["a.csv", "b.json", "c.txt", "d.npz"] {
        pipe(name);
    }
    symlink("/dev/zero", path("e.bvh")).unwrap();
    // Texts that are looked into are passed over.
    let reads = sources(vec![folder.path().into()]).read().unwrap();
    let names: Vec<&str> = reads.iter().map(|r| r.source.name.as_str()).collect();
    assert_eq!(names, ["a", "d", "e"]);
    for read in reads {
        let message = describe(&read.outcome.err().unwrap());
        assert!(
            message.contains("is a pipe, a socket or a device"),
            "{message}"
        );
        assert!(message.starts_with(&shown(&read.source.path)), "{message}");
    }
    // The report beside a table, and a skeleton, are opened too.
    fs::write(path("b.csv"), "").unwrap();
    let message = refusal(sources(vec![path("b.csv")]));
    assert!(message.contains("b.json: is a pipe"), "{message}");
    fs::write(path("walk.amc"), "").unwrap();
    let with_skeleton = Sources {
        skeleton: Some(path("a.csv")),
        ..sources(vec![path("walk.amc")])
    };
    let message = refusal(with_skeleton);
    assert!(message.contains("a.csv: is a pipe"), "{message}");
}

#[test]
fn a_name_of_several_lines_is_shown_in_one() {
    let folder = tempfile::tempdir().unwrap();
    let sub = folder.path().join("x\ny");
    fs::create_dir(&sub).unwrap();
    let path = sub.join("a\n\tb\x1b.csv");
    fs::write(&path, "1,2\n").unwrap();
    let reads = sources(vec![folder.path().into()]).read().unwrap();
    assert_eq!(reads[0].source.name, "x_y_a__b_");
    let message = describe(reads[0].outcome.as_ref().err().unwrap());
    assert!(message.contains("x\\ny/a\\n\\tb\\u{1b}.csv"), "{message}");
    assert!(!message.contains(char::is_control), "{message:?}");
    assert!(!few(&[path], "read").contains(char::is_control));
}

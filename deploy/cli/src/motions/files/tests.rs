//! Which files are found, and in which order they come back.

use super::super::output::Output;
use super::*;

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
    let twice = sources(vec![root.into(), root.join("walk.csv")])
        .read()
        .err()
        .unwrap();
    assert!(twice.to_string().contains("same name"), "{twice}");
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

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

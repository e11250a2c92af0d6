//! Places that are free, and places that are taken.

use super::*;
use motion::gait;
use std::os::unix::fs::symlink;

/// The outputs of importing files, each named by its stem.
fn outputs(out: &Path, sources: &[&Path]) -> Vec<Output> {
    sources
        .iter()
        .map(|source| {
            let name = source.file_stem().unwrap().to_string_lossy();
            Output::new(out, &name, origin("from", source)).with_report()
        })
        .collect()
}

fn claimed(out: &Path, sources: &[&Path]) -> Result<(), String> {
    claim(out, &outputs(out, sources), sources).map_err(|e| e.to_string())
}

fn file(path: PathBuf, text: &str) -> PathBuf {
    fs::create_dir_all(path.parent().unwrap()).unwrap();
    fs::write(&path, text).unwrap();
    path
}

/// Says that a claim is refused with some words, and that nothing changed in a folder.
fn refused(out: &Path, sources: &[&Path], words: &[&str]) {
    let before = listing(out);
    let message = claimed(out, sources).unwrap_err();
    for word in words {
        assert!(message.contains(word), "{word:?} is not in {message:?}");
    }
    assert_eq!(listing(out), before);
}

fn listing(out: &Path) -> Vec<(PathBuf, Option<Vec<u8>>)> {
    let Ok(entries) = fs::read_dir(out) else {
        return Vec::new();
    };
    let mut all: Vec<_> = entries
        .map(|entry| entry.unwrap().path())
        .map(|path| (path.clone(), fs::read(path).ok()))
        .collect();
    all.sort();
    all
}

#[test]
fn a_source_is_never_written_over_under_any_name() {
    let folder = tempfile::tempdir().unwrap();
    let root = folder.path();
    let source = file(root.join("g1/a.csv"), "1,2,3");
    let words = ["a.csv is one of the files that are read", "another --out"];
    // Its own folder, the folder through a link and through "..", a link to it, a second name of it.
    refused(&root.join("g1"), &[&source], &words);
    symlink(root.join("g1"), root.join("linked")).unwrap();
    refused(&root.join("linked"), &[&source], &words);
    refused(&root.join("g1/../g1"), &[&source], &words);
    fs::create_dir(root.join("out")).unwrap();
    symlink(&source, root.join("out/a.csv")).unwrap();
    refused(&root.join("out"), &[&source], &words);
    refused(&root.join("out"), &[&root.join("out/a.csv")], &words);
    fs::remove_file(root.join("out/a.csv")).unwrap();
    fs::hard_link(&source, root.join("out/a.csv")).unwrap();
    refused(&root.join("out"), &[&source], &words);
    // Another source of the same command.
    let other = file(root.join("b/a.bvh"), "HIERARCHY");
    refused(&root.join("g1"), &[&other, &source], &words);
    // A source that is where the report would be.
    let json = file(root.join("json/walk.json"), "{}");
    let words = ["walk.json is one of the files that are read"];
    refused(&root.join("json"), &[&json], &words);
    // Elsewhere all is well, and the folder is made.
    claimed(&root.join("new/out"), &[&source]).unwrap();
    assert!(root.join("new/out").is_dir());
}

#[test]
fn what_somebody_else_wrote_is_never_written_over() {
    let folder = tempfile::tempdir().unwrap();
    let root = folder.path();
    let out = root.join("out");
    let source = file(root.join("a.bvh"), "HIERARCHY");
    let (clip, report) = (out.join("a.csv"), out.join("a.json"));
    let words = ["not written by this command", "another --out"];
    for text in ["", "1,2,3\n", "# fps = 50\n", "\n# ampco motion\n"] {
        file(clip.clone(), text);
        refused(&out, &[&source], &words);
    }
    fs::remove_file(&clip).unwrap();
    for text in [
        "{}",
        "",
        "[1]",
        "{\"written_by\": \"me\"}",
        "{\"name\": \"a\"}",
    ] {
        file(report.clone(), text);
        refused(&out, &[&source], &words);
    }
    fs::remove_file(&report).unwrap();
    fs::create_dir(&clip).unwrap();
    refused(&out, &[&source], &["a.csv is a folder"]);
    fs::remove_dir(&clip).unwrap();
    symlink(root.join("nowhere"), &clip).unwrap();
    refused(&out, &[&source], &["a.csv is a link"]);
    fs::remove_file(&clip).unwrap();
    let written = |source: &Path| {
        let source = source.display();
        format!("{{\"written_by\": \"ampco motions import\", \"source\": \"{source}\"}}")
    };
    // The report of its mirror image is of another clip.
    let image = written(&source).replace("motions import", "motions mirror");
    file(report.clone(), &image);
    refused(&out, &[&source], &["a.json is of another clip (mirrored "]);
    file(report.clone(), &written(&root.join("b.bvh")));
    refused(&out, &[&source], &["a.json is of another clip (from "]);
    file(report, &written(&source));
    claimed(&out, &[&source]).unwrap();
    // The folder itself may be a file.
    let file = file(root.join("file"), "");
    for out in [file.clone(), file.join("below")] {
        let message = claimed(&out, &[&source]).unwrap_err();
        assert!(message.ends_with("is no folder"), "{message}");
    }
}

#[test]
fn a_clip_is_replaced_by_a_newer_one_of_the_same_origin_only() {
    let folder = tempfile::tempdir().unwrap();
    let root = folder.path();
    let out = root.join("out");
    let first = file(root.join("first/walk.bvh"), "HIERARCHY");
    let second = file(root.join("second/walk.bvh"), "HIERARCHY");
    let clip = gait::stand();
    claimed(&out, &[&first]).unwrap();
    outputs(&out, &[&first])[0]
        .write(&clip, &["more".into()])
        .unwrap();
    claimed(&out, &[&first]).unwrap();
    claimed(&out, &[&root.join("first/../first/walk.bvh")]).unwrap();
    let words = [
        "walk.csv is of another clip (from ",
        "first/walk.bvh)",
        "remove it",
    ];
    refused(&out, &[&second], &words);
    // A mirror image and a made clip are other origins too.
    for other in [origin("mirrored", &first), "the built-in gait walk".into()] {
        let output = [Output::new(&out, "walk", other)];
        assert!(claim(&out, &output, &[&first]).is_err());
        output[0].write(&clip, &[]).unwrap();
        claim(&out, &output, &[&first]).unwrap();
        refused(&out, &[&first], &["is of another clip"]);
    }
    // Where the first source is gone, its clip is the only one left of it.
    outputs(&out, &[&first])[0].write(&clip, &[]).unwrap();
    fs::remove_file(&first).unwrap();
    refused(&out, &[&second], &["is of another clip"]);
}

#[test]
fn two_clips_of_one_command_need_two_names() {
    let folder = tempfile::tempdir().unwrap();
    let root = folder.path();
    let out = root.join("out");
    let a = file(root.join("a/walk.bvh"), "HIERARCHY");
    let b = file(root.join("b/walk.csv"), "1,2,3");
    refused(
        &out,
        &[&a, &b],
        &["walk.csv would hold two clips", "a/walk.bvh", "b/walk.csv"],
    );
    let upper = file(root.join("c/WALK.npz"), "PK");
    refused(&out, &[&a, &upper], &["WALK.csv would hold two clips"]);
    // Folders and separators become the same sign.
    let slashed = [
        Output::new(&out, "a/walk", "one".into()),
        Output::new(&out, "a_walk", "two".into()),
    ];
    assert!(claim(&out, &slashed, &[]).is_err());
    let many: Vec<Output> = (0..9).map(|_| slashed[0].clone()).collect();
    let message = claim(&out, &many, &[]).unwrap_err().to_string();
    assert_eq!(message.lines().count(), 6, "{message}");
    assert!(message.ends_with("and 3 more"), "{message}");
    assert!(!out.exists());
}

#[test]
fn clips_in_the_folder_that_they_were_written_to_are_told() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path();
    let output = Output::new(out, "walk", "made".into());
    output.write(&gait::stand(), &[]).unwrap();
    assert!(is_output(&output.clip, out));
    assert!(is_output(
        &output.clip,
        &out.join("../").join(out.file_name().unwrap())
    ));
    assert!(!is_output(&output.clip, &out.join("sub")));
    assert!(!is_output(&file(out.join("other.csv"), "1,2,3"), out));
    assert!(!is_output(
        &file(out.join("a.bvh"), "# ampco motion\n"),
        out
    ));
}

#[test]
fn what_a_killed_command_left_half_written_goes_and_nothing_else() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path();
    let mut ended = std::process::Command::new("true").spawn().unwrap();
    let gone = ended.id();
    ended.wait().unwrap();
    let draft = file(out.join(format!(".w10.json.{gone}.new")), "{");
    let other = file(out.join(format!(".notes.{gone}.new")), "mine");
    let source = file(out.join("in/walk.bvh"), "HIERARCHY");
    // Refused, it changes nothing.
    let clip = file(out.join("walk.csv"), "mine");
    refused(out, &[&source], &["not written by this command"]);
    assert!(draft.exists());
    fs::remove_file(clip).unwrap();
    claimed(out, &[&source]).unwrap();
    assert!(!draft.exists() && other.exists());
}

#[test]
fn a_pipe_is_no_clip_that_was_written_here() {
    let folder = tempfile::tempdir().unwrap();
    let pipe = folder.path().join("a.csv");
    let made = std::process::Command::new("mkfifo").arg(&pipe).status();
    assert!(made.unwrap().success());
    assert!(!is_output(&pipe, folder.path()));
}

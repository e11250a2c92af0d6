//! Checkpoints as a run meets them: written, damaged, replaced, pruned.

use std::fs;
use std::path::Path;

use run::checkpoint::{CONFIG, CheckpointError, FORMAT_VERSION, Instead, Refusal};
use run::{Checkpoint, Checkpoints, Contents};

const SHAPE: &str = "policy 82-8-23";

/// Two checkpoints, of iterations 10 and 20, of two parts each.
fn two() -> (tempfile::TempDir, Checkpoints) {
    let folder = tempfile::tempdir().unwrap();
    let checkpoints = Checkpoints::new(folder.path().join("checkpoints"));
    for iteration in [10, 20] {
        let parts: [(&str, &[u8]); 2] = [("actor.bin", b"weights"), ("optimizer.bin", &[7; 100])];
        checkpoints.write(iteration, SHAPE, &parts).unwrap();
    }
    (folder, checkpoints)
}

/// Why the newest is refused, and what is named instead.
fn refusal(checkpoints: &Checkpoints, shape: &str) -> (Refusal, Instead) {
    parts(checkpoints.open_newest(Some(shape)).unwrap_err())
}

fn parts(error: CheckpointError) -> (Refusal, Instead) {
    match error {
        CheckpointError::Refused {
            reason, instead, ..
        } => (reason, instead),
        other => panic!("{other}"),
    }
}

#[test]
fn what_was_written_comes_back() {
    let (_folder, checkpoints) = two();
    assert_eq!(checkpoints.list(), [10, 20]);
    let newest = checkpoints.open_newest(Some(SHAPE)).unwrap();
    assert_eq!(newest.iteration, 20);
    assert_eq!(newest.part("actor.bin"), Some(b"weights".as_slice()));
    assert_eq!(newest.part("optimizer.bin"), Some([7_u8; 100].as_slice()));
    assert_eq!(newest.part("critic.bin"), None);
}

#[test]
fn a_truncated_part_is_refused_and_the_previous_good_one_named() {
    let (_folder, checkpoints) = two();
    fs::write(checkpoints.path(20).join("optimizer.bin"), [7; 99]).unwrap();
    let (reason, instead) = refusal(&checkpoints, SHAPE);
    let expected = Refusal::Truncated {
        part: "optimizer.bin".to_owned(),
        expected: 100,
        found: 99,
    };
    assert_eq!(reason, expected);
    assert_eq!(instead, Instead::Earlier(checkpoints.path(10)));
    let words = checkpoints
        .open_newest(Some(SHAPE))
        .unwrap_err()
        .to_string();
    assert!(
        words.contains("99 bytes of 100") && words.contains("00000010"),
        "{words}"
    );
}

#[test]
fn one_flipped_bit_is_refused() {
    let (_folder, checkpoints) = two();
    let mut bytes = vec![7; 100];
    bytes[50] ^= 1;
    fs::write(checkpoints.path(20).join("optimizer.bin"), bytes).unwrap();
    assert_eq!(
        refusal(&checkpoints, SHAPE).0,
        Refusal::Corrupt("optimizer.bin".to_owned())
    );
}

#[test]
fn a_missing_part_is_refused_and_with_both_damaged_none_is_named() {
    let (_folder, checkpoints) = two();
    for iteration in [10, 20] {
        fs::remove_file(checkpoints.path(iteration).join("actor.bin")).unwrap();
    }
    let (reason, instead) = refusal(&checkpoints, SHAPE);
    assert_eq!(reason, Refusal::Missing("actor.bin".to_owned()));
    assert_eq!(instead, Instead::NoneGood);
}

#[test]
fn another_shape_is_refused_with_both_named() {
    let (_folder, checkpoints) = two();
    let (reason, instead) = refusal(&checkpoints, "policy 82-16-23");
    let words = reason.to_string();
    assert!(
        words.contains("82-8-23") && words.contains("82-16-23"),
        "{words}"
    );
    assert_eq!(instead, Instead::NoneGood);
}

#[test]
fn a_newer_format_a_foreign_folder_and_an_edited_manifest_are_refused() {
    let (_folder, checkpoints) = two();
    let manifest = checkpoints.path(20).join("manifest.json");
    let text = fs::read_to_string(&manifest).unwrap();

    let newer = FORMAT_VERSION + 1;
    let newer_text = text.replace("\"version\": 1", &format!("\"version\": {newer}"));
    assert_ne!(newer_text, text);
    fs::write(&manifest, newer_text).unwrap();
    assert_eq!(
        refusal(&checkpoints, SHAPE).0,
        Refusal::Newer { found: newer }
    );

    fs::write(
        &manifest,
        text.replace("\"iteration\": 20", "\"iteration\": 21"),
    )
    .unwrap();
    assert_eq!(refusal(&checkpoints, SHAPE).0, Refusal::Manifest);

    fs::write(&manifest, "{\"format\": \"something else\"}").unwrap();
    assert!(matches!(
        refusal(&checkpoints, SHAPE).0,
        Refusal::Foreign(_)
    ));
    fs::remove_file(&manifest).unwrap();
    assert!(matches!(
        refusal(&checkpoints, SHAPE).0,
        Refusal::Foreign(_)
    ));
}

#[test]
fn a_manifest_cannot_lead_out_of_its_folder() {
    let (_folder, checkpoints) = two();
    let manifest = checkpoints.path(20).join("manifest.json");
    let text = fs::read_to_string(&manifest).unwrap();
    fs::write(
        &manifest,
        text.replace("actor.bin", "../00000010/actor.bin"),
    )
    .unwrap();
    assert_eq!(refusal(&checkpoints, SHAPE).0, Refusal::Manifest);
}

#[test]
fn a_draft_left_by_a_crash_is_no_checkpoint_and_is_cleared() {
    let (folder, checkpoints) = two();
    let draft = folder.path().join("checkpoints/.00000030.new");
    fs::create_dir(&draft).unwrap();
    fs::write(draft.join("actor.bin"), b"half").unwrap();
    assert_eq!(checkpoints.list(), [10, 20]);
    checkpoints.prune(2).unwrap();
    assert!(!draft.exists());
    assert_eq!(checkpoints.list(), [10, 20]);
}

#[test]
fn the_same_iteration_is_replaced_and_old_ones_are_pruned() {
    let (_folder, checkpoints) = two();
    checkpoints
        .write(20, SHAPE, &[("actor.bin", b"newer")])
        .unwrap();
    checkpoints.prune(1).unwrap();
    assert_eq!(checkpoints.list(), [20]);
    let checkpoint = Checkpoint::open(&checkpoints.path(20)).unwrap();
    assert_eq!(checkpoint.part("actor.bin"), Some(b"newer".as_slice()));
    assert_eq!(checkpoint.part("optimizer.bin"), None);
}

#[test]
fn an_attachment_is_checked_by_itself() {
    let (_folder, checkpoints) = two();
    assert_eq!(checkpoints.attachment(20, "fleet-0.bin").unwrap(), None);
    checkpoints.attach(20, "fleet-0.bin", b"worlds").unwrap();
    let back = checkpoints.attachment(20, "fleet-0.bin").unwrap();
    assert_eq!(back.as_deref(), Some(b"worlds".as_slice()));
    checkpoints.open_newest(Some(SHAPE)).unwrap();

    let file = checkpoints.path(20).join("fleet-0.bin");
    let mut bytes = fs::read(&file).unwrap();
    bytes.pop();
    fs::write(&file, bytes).unwrap();
    let words = checkpoints
        .attachment(20, "fleet-0.bin")
        .unwrap_err()
        .to_string();
    assert!(words.contains("5 bytes of 6"), "{words}");
}

#[test]
fn an_unwritable_folder_is_an_error_and_leaves_the_others() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("checkpoints");
    fs::write(&path, b"a file where the folder should be").unwrap();
    let error = Checkpoints::new(path)
        .write(1, SHAPE, &[("a", b"b")])
        .unwrap_err();
    assert!(matches!(error, CheckpointError::Io { .. }), "{error}");
}

#[test]
fn a_damaged_folder_that_is_opened_by_itself_names_the_good_one_before_it() {
    let (folder, checkpoints) = two();
    checkpoints
        .write(30, SHAPE, &[("actor.bin", b"weights")])
        .unwrap();
    fs::write(checkpoints.path(30).join("actor.bin"), b"weight").unwrap();
    let opened = |path: &Path| parts(Checkpoint::open(path).unwrap_err()).1;
    let newest = checkpoints.path(30);
    assert_eq!(opened(&newest), Instead::Earlier(checkpoints.path(20)));
    // The one in the middle is damaged as well, in another way.
    fs::remove_file(checkpoints.path(20).join("manifest.json")).unwrap();
    assert_eq!(opened(&newest), Instead::Earlier(checkpoints.path(10)));
    assert_eq!(
        opened(&checkpoints.path(20)),
        Instead::Earlier(checkpoints.path(10))
    );
    fs::write(checkpoints.path(10).join("optimizer.bin"), []).unwrap();
    assert_eq!(opened(&newest), Instead::NoneGood);
    // Before the oldest there is none, and beside one that lies alone neither.
    assert_eq!(opened(&checkpoints.path(10)), Instead::NoneEarlier);
    let alone = folder.path().join("judge");
    fs::rename(&newest, &alone).unwrap();
    assert_eq!(opened(&alone), Instead::NoneEarlier);
    let words = Checkpoint::open(&alone).unwrap_err().to_string();
    assert!(
        words.ends_with("there is no earlier one beside it"),
        "{words}"
    );
}

#[test]
fn a_checkpoint_knows_the_configuration_it_was_trained_under() {
    let (_folder, checkpoints) = two();
    let hidden = |iteration: u64| {
        let checkpoint = Checkpoint::open(&checkpoints.path(iteration)).unwrap();
        let config = checkpoint.config().unwrap()?;
        config.given("policy.hidden").map(ToString::to_string)
    };
    assert_eq!(hidden(20), None, "written by an older program");
    // What is put beside the parts is taken where there is no part of its own, and never in its place.
    let beside = |iteration| checkpoints.path(iteration).join("config.toml");
    fs::write(beside(20), "[policy]\nhidden = [16]").unwrap();
    assert_eq!(hidden(20).as_deref(), Some("[16]"));
    let text = b"[policy]\nhidden = [8, 8]".as_slice();
    checkpoints.write(30, SHAPE, &[(CONFIG, text)]).unwrap();
    fs::write(beside(30), "[policy]\nhidden = [16]").unwrap();
    assert_eq!(hidden(30).as_deref(), Some("[8, 8]"));
}

#[test]
fn scores_of_another_task_do_not_count() {
    let folder = tempfile::tempdir().unwrap();
    let checkpoints = Checkpoints::new(folder.path().to_owned());
    let write = |iteration, kernel: &str, score| {
        let config = format!("[task]\nkernel = {kernel}\n[ppo]\nepochs = {iteration}");
        let contents = Contents {
            shape: SHAPE,
            parts: &[(CONFIG, config.as_bytes())],
            score,
            ..Contents::default()
        };
        checkpoints.write_contents(iteration, &contents).unwrap();
    };
    write(10, "0.25", Some(90.0));
    write(20, "2.0", Some(50.0));
    write(30, "2.0", Some(60.0));
    write(40, "2.0", Some(55.0));
    assert_eq!(checkpoints.best(), Some(30));
    // One without a score says nothing of the task either way.
    write(50, "0.25", None);
    assert_eq!(checkpoints.best(), Some(30));
    write(60, "0.25", Some(1.0));
    assert_eq!(checkpoints.best(), Some(10));
}

/// A checkpoint of one part, of this score, for which `actor-0.bin` is awaited.
fn awaiting(checkpoints: &Checkpoints, iteration: u64, score: f64) {
    let contents = Contents {
        shape: SHAPE,
        parts: &[("actor.bin", b"weights")],
        awaited: &["actor-0.bin".to_owned()],
        score: Some(score),
    };
    checkpoints.write_contents(iteration, &contents).unwrap();
}

#[test]
fn what_others_never_attached_is_passed_over_for_an_older_one_that_is_whole() {
    let folder = tempfile::tempdir().unwrap();
    let checkpoints = Checkpoints::new(folder.path().join("checkpoints"));
    let opened = || checkpoints.open_whole(Some(SHAPE)).unwrap().iteration;
    awaiting(&checkpoints, 10, 0.0);
    assert_eq!(opened(), 10, "rather one without its actors than none");
    checkpoints.attach(10, "actor-0.bin", b"robots").unwrap();
    awaiting(&checkpoints, 20, 0.0);
    assert_eq!(opened(), 10);
    checkpoints.attach(20, "actor-0.bin", b"robots").unwrap();
    assert_eq!(opened(), 20);
    assert_eq!(checkpoints.newest_whole(), Some(20));
    // Half an attachment is none.
    let file = checkpoints.path(20).join("actor-0.bin");
    let bytes = fs::read(&file).unwrap();
    fs::write(&file, &bytes[..bytes.len() - 1]).unwrap();
    assert_eq!(opened(), 10);
    checkpoints.forget_after(10).unwrap();
    assert_eq!(checkpoints.list(), [10]);
}

#[test]
fn the_best_is_kept_beside_the_newest() {
    let folder = tempfile::tempdir().unwrap();
    let checkpoints = Checkpoints::new(folder.path().join("checkpoints"));
    assert_eq!(checkpoints.best(), None);
    for (iteration, score) in [(10, 1.0), (20, 3.0), (30, 3.0), (40, -2.0), (50, f64::NAN)] {
        awaiting(&checkpoints, iteration, score);
        checkpoints.prune(2).unwrap();
    }
    assert_eq!(checkpoints.best(), Some(20), "of equals the oldest");
    assert_eq!(checkpoints.list(), [20, 40, 50]);
}

#[test]
fn one_is_removed_also_while_robots_are_added_to_it() {
    let (_folder, checkpoints) = two();
    let late = checkpoints.clone();
    let (done, ended) = std::sync::mpsc::channel::<()>();
    let adding = std::thread::spawn(move || {
        let mut added = 0_u32;
        while ended.try_recv() == Err(std::sync::mpsc::TryRecvError::Empty) {
            for actor in 0..8 {
                let robots = late.attach(20, &format!("actor-{actor}.bin"), b"robots");
                added += u32::from(robots.is_ok());
            }
        }
        added
    });
    for _ in 0..300 {
        checkpoints.write(20, SHAPE, &[("a", b"b")]).unwrap();
        checkpoints.forget_after(10).unwrap();
        assert_eq!(checkpoints.list(), [10]);
    }
    drop(done);
    assert!(adding.join().unwrap() > 0, "nothing was ever added");
}

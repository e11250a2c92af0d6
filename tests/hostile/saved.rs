//! What a run has saved, damaged: checkpoints, the state of learner and fleet, metrics, journals.

use std::fs;

use amp::{DiscriminatorConfig, Learning, LearningConfig, PolicyConfig};
use motion::{Dataset, MotionConfig};
use observation::Tables;
use proptest::collection::vec;
use proptest::prelude::*;
use run::{Checkpoint, Checkpoints, Contents, metrics};
use sim::{Fleet, Physics, RandomizationConfig, Starts, TaskConfig};

use crate::damage::{blows, damaged};
use crate::{always, assert_clear};

const SHAPE: &str = "policy 82-8-23";

#[test]
fn a_damaged_checkpoint_is_refused_and_an_older_one_is_gone_on_from() {
    let folder = tempfile::tempdir().unwrap();
    let checkpoints = Checkpoints::new(folder.path().to_owned());
    let awaited = ["actor-0.bin".to_owned()];
    let contents = Contents {
        shape: SHAPE,
        parts: &[("a.bin", &[7; 300]), ("b.bin", b"weights")],
        awaited: &awaited,
        score: Some(1.0),
    };
    for iteration in [10, 20] {
        checkpoints.write_contents(iteration, &contents).unwrap();
        checkpoints
            .attach(iteration, &awaited[0], &[9; 200])
            .unwrap();
    }
    let files = ["manifest.json", "a.bin", "b.bin", "actor-0.bin"];
    let sound = files.map(|file| fs::read(checkpoints.path(20).join(file)).unwrap());
    let inputs = (0..files.len(), blows());
    always(300, &inputs, |(file, blows)| {
        let path = checkpoints.path(20).join(files[file]);
        let bytes = damaged(&sound[file], &blows);
        fs::write(&path, &bytes).unwrap();
        let is_sound = bytes == sound[file];
        let opened = Checkpoint::open(&checkpoints.path(20));
        match opened {
            Err(error) => {
                assert!(!is_sound, "{error}");
                assert_clear(&error);
                let refusal = checkpoints.open_whole(Some(SHAPE)).unwrap_err().to_string();
                assert!(refusal.contains("00000010"), "{refusal}");
            }
            // An attachment is checked when it is asked for; JSON may be spaced in many ways.
            Ok(_) if file == 3 && !is_sound => {
                assert!(!matches!(checkpoints.attachment(20, files[3]), Ok(Some(_))));
                assert_eq!(checkpoints.open_whole(Some(SHAPE)).unwrap().iteration, 10);
            }
            Ok(checkpoint) => assert_eq!(checkpoint.part("b.bin"), Some(&b"weights"[..])),
        }
        fs::write(&path, &sound[file]).unwrap();
    });
}

#[test]
fn a_damaged_state_of_the_learner_is_refused_and_leaves_it_as_it_was() {
    let config = LearningConfig {
        policy: PolicyConfig {
            hidden: vec![4],
            critic_hidden: vec![4],
            ..PolicyConfig::default()
        },
        discriminator: DiscriminatorConfig {
            hidden: vec![4],
            replay_capacity: 4,
            replay_insert: 4,
            ..DiscriminatorConfig::default()
        },
        ..LearningConfig::default()
    };
    let learning = Learning::new(config, learner::robot(&Tables::default()), 1).unwrap();
    let sound = learning.save();
    let learning = std::cell::RefCell::new(learning);
    always(200, &blows(), |blows| {
        let mut learning = learning.borrow_mut();
        if let Err(error) = learning.load(&damaged(&sound, &blows)) {
            assert_clear(&error);
            assert!(learning.save() == sound, "a refused state has changed it");
        }
        learning.load(&sound).unwrap();
    });
}

#[test]
fn a_damaged_fleet_is_refused_or_restored() {
    let dataset = Dataset::load(&MotionConfig::default(), ".".as_ref()).unwrap();
    let starts: Starts = dataset.frames().map(|(s, c, w)| (*s, c, w)).collect();
    for physics in [Physics::Rapier, Physics::Batched] {
        let task = TaskConfig::default();
        let randomization = RandomizationConfig::table_one();
        let fleet = Fleet::new(physics, &task, &randomization, starts.clone(), 1, 1).unwrap();
        let sound = fleet.save();
        let fleet = std::cell::RefCell::new(fleet);
        always(100, &blows(), |blows| {
            let restored = fleet.borrow_mut().restore(&damaged(&sound, &blows));
            if let Err(error) = restored {
                assert_clear(&error);
            }
        });
    }
}

#[test]
fn damaged_metrics_are_read_or_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("metrics.jsonl");
    let lines: String = (1..=9)
        .map(|at| format!("{{\"iteration\":{at},\"style_mean\":0.5,\"timing\":{{}}}}\n"))
        .collect();
    let inputs = (blows(), any::<u64>());
    always(300, &inputs, |(blows, iteration)| {
        fs::write(&path, damaged(lines.as_bytes(), &blows)).unwrap();
        if let Err(error) = metrics::read::<serde_json::Value>(&path) {
            assert_clear(&error);
        }
        let _ = metrics::newest(&path);
        metrics::Tail::from_start(&path).poll().unwrap();
        match metrics::truncate_after(&path, iteration) {
            Err(error) => assert_clear(&error),
            Ok(()) => {
                let kept = metrics::read::<serde_json::Value>(&path).unwrap();
                let later = |line: &serde_json::Value| line["iteration"].as_u64() > Some(iteration);
                assert!(!kept.iter().any(later));
            }
        }
        // A writer goes on after whatever it finds.
        run::Metrics::open(&path).unwrap().append(&5).unwrap();
    });
}

#[test]
fn a_damaged_journal_gives_an_account() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("learner.rollouts");
    let lines = "begun 7 0\nsending 0 100 0\nsent 0 100 0 delivered\nreceived 7 1 0 100 0 used\n\
                 begun 8 1\nsending 0 100 1\nreceived 8 2 0 100 1 stale\n";
    let inputs = vec(blows(), 1..3);
    always(300, &inputs, |several| {
        let bytes = several
            .iter()
            .fold(lines.as_bytes().to_vec(), |bytes, blows| {
                damaged(&bytes, blows)
            });
        fs::write(&path, bytes).unwrap();
        let journals = run::journal::read(folder.path()).unwrap();
        let account = run::journal::account::account(&journals);
        assert!(account.used <= account.sent);
    });
}

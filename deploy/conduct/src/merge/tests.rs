//! Studies that were shared, brought together.

use super::*;
use crate::records::tests::finished;
use std::fs;

fn study(methods: &str, seeds: &str, more: &str) -> StudyFile {
    let text = format!(
        "title = 't'\nmethods = {methods}\nseeds = {seeds}\niterations = 130\n[override.fleet]\nenvironments = 8\n\
         steps = 25\nactors = 1\n{more}[evaluate]\ncommands = [[0.5, 0.0, 0.0]]\nepisodes = 2\nseconds = 1.0\n"
    );
    StudyFile::parse(&text).unwrap()
}

#[test]
fn parts_by_seed_and_by_method_become_one_study() {
    let place = tempfile::tempdir().unwrap();
    let path = |name: &str| place.path().join(name);
    let (first, _) = finished(&path("first"), &study("['ampco', 'amp-0.5']", "[1]", ""));
    let (second, _) = finished(&path("second"), &study("['ampco', 'adamimic']", "[2]", ""));
    let said = merge(&path("all"), &[first, second]).unwrap();
    assert!(said.starts_with("4 records taken over"), "{said}");
    let all = StudyFolder::open(&path("all")).unwrap();
    assert_eq!(all.records().all().unwrap().len(), 4);
    assert_eq!(all.file().unwrap().methods, ["ampco", "amp-0.5"]);
    // Once more, nothing is new.
    let first = StudyFolder::open(&path("first")).unwrap();
    assert!(
        merge(&path("all"), &[first])
            .unwrap()
            .starts_with("0 records")
    );
}

#[test]
fn what_does_not_belong_together_is_refused_and_nothing_is_written() {
    let place = tempfile::tempdir().unwrap();
    let path = |name: &str| place.path().join(name);
    finished(&path("first"), &study("['ampco']", "[1]", ""));
    finished(
        &path("other"),
        &study("['ampco']", "[2]", "[override.ppo]\nclip = 0.25\n"),
    );
    let open = |name: &str| StudyFolder::open(&path(name)).unwrap();
    let refused = |from: &[&str]| {
        let from: Vec<StudyFolder> = from.iter().map(|name| open(name)).collect();
        let refused = merge(&path("all"), &from).unwrap_err().to_string();
        assert!(!path("all").exists());
        refused
    };
    let told = refused(&["first", "other"]);
    assert!(
        told.contains("study.toml") && told.contains("another folder"),
        "{told}"
    );
    // The same study file, and a record that was made otherwise all the same.
    fs::copy(path("first/study.toml"), path("other/study.toml")).unwrap();
    let told = refused(&["first", "other"]);
    assert!(
        told.contains("`clip = 0.25`") && told.contains("ampco-seed2.json"),
        "{told}"
    );
    // One run, two outcomes.
    let records = open("first").records();
    let mut record = records.read("ampco-seed1").unwrap().unwrap();
    record.origin.policy_sha256 = "0".into();
    fs::create_dir(path("twice")).unwrap();
    fs::copy(path("first/study.toml"), path("twice/study.toml")).unwrap();
    open("twice").records().write(&record).unwrap();
    let told = refused(&["first", "twice"]);
    assert!(
        told.contains("contradicts") && told.contains("policy"),
        "{told}"
    );
    // Made once more elsewhere, more slowly: the same run.
    let mut record = records.read("ampco-seed1").unwrap().unwrap();
    record.told.seconds *= 3.0;
    record.origin.processor = "another".into();
    open("twice").records().write(&record).unwrap();
    let from = [open("first"), open("twice")];
    assert!(
        merge(&path("all"), &from)
            .unwrap()
            .starts_with("1 record taken over")
    );
}

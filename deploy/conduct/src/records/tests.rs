//! Records as files: made, refused, brought along, and enough for a report.

use super::*;
use crate::{plan, read};
use ::study::{StudyFile, report};
use serde_json::json;
use std::fs;

const STUDY: &str = "title = 't'\nmethods = ['ampco', 'amp-0.5']\nseeds = [1, 2]\niterations = 130\n\
                     [override.fleet]\nenvironments = 8\nsteps = 25\nactors = 1\n\
                     [evaluate]\ncommands = [[0.5, 0.0, 0.0]]\nepisodes = 2\nseconds = 1.0\n";

fn file() -> StudyFile {
    StudyFile::parse(STUDY).unwrap()
}

/// A study's folder, as `study run` begins it.
pub(crate) fn begun(place: &Path, file: &StudyFile) -> (StudyFolder, Vec<Planned>) {
    let folder = StudyFolder::create(place).unwrap();
    let planned = plan::plan(file, Path::new("."), "a test").unwrap();
    let all = plan::together(file, &planned, &folder, Path::new("."), "a test").unwrap();
    folder.begin(file, &planned, &all).unwrap();
    (folder, planned)
}

/// Makes a run as training and judging leave it; `value` is what its numbers are made of.
fn make(folder: &StudyFolder, planned: &Planned, judging: &Judging, value: f64) -> Folder {
    let run = Folder::create(&folder.runs(), &planned.name).unwrap();
    planned.config.write(&run.config_path(), "a test").unwrap();
    let mut metrics = run::Metrics::open(&run.metrics_path()).unwrap();
    for iteration in 1..=planned.target {
        let line = json!({
            "iteration": iteration, "samples": 200 * iteration, "rmse": value, "energy_j": 1000.0 * value,
            "style_mean": value / 7.0, "episode_share": 0.9, "switched_at": (iteration > 60).then_some(60),
            "timing": { "seconds": 0.1 * iteration as f64, "iteration_seconds": 0.1, "decision_seconds": 1e-6,
                        "learning": { "weighting": 1e-5 } },
        });
        metrics.append(&line).unwrap();
    }
    run.checkpoints()
        .write(planned.target, "a shape", &[(POLICY, b"weights")])
        .unwrap();
    let draft = Judgement::path(&run).with_extension("draft");
    fs::create_dir_all(draft.parent().unwrap()).unwrap();
    let row = json!([{ "command": [0.5, 0.0, 0.0], "survival": 1.0, "rmse": value, "rmse_yaw_rate": 0.2,
                       "energy_j": 900.0 * value, "gait": "walk", "stride_rate_hz": 1.0 + value }]);
    fs::write(&draft, row.to_string()).unwrap();
    Judgement::keep(&run, judging, &draft).unwrap();
    run
}

/// All runs of a study with their records.
pub(crate) fn finished(place: &Path, file: &StudyFile) -> (StudyFolder, Vec<Planned>) {
    let (folder, planned) = begun(place, file);
    let judging = Judging::of(file, place).unwrap().unwrap();
    for (index, run) in planned.iter().enumerate() {
        let made = make(&folder, run, &judging, 0.25 + 0.01 * index as f64);
        let record = of(&made, run, Some(&judging)).unwrap();
        folder.records().write(&record).unwrap();
    }
    (folder, planned)
}

fn pages(folder: &StudyFolder) -> Vec<report::File> {
    report::files(&read::results(folder, |path| format!("../{path}")).unwrap())
}

#[test]
fn a_report_stands_on_records_alone_and_is_the_same_to_the_byte() {
    let place = tempfile::tempdir().unwrap();
    let (folder, _) = finished(place.path(), &file());
    let before = pages(&folder);
    for gone in [
        "runs",
        "configs",
        "logs",
        "failed",
        "runs.json",
        "origin.json",
    ] {
        let gone = place.path().join(gone);
        if gone.is_dir() {
            fs::remove_dir_all(gone)
        } else {
            fs::remove_file(gone)
        }
        .unwrap();
    }
    assert_eq!(pages(&folder), before);
    assert_eq!(pages(&StudyFolder::open(place.path()).unwrap()), before);
    let page = &before
        .iter()
        .find(|file| file.name == "report.html")
        .unwrap()
        .text;
    assert!(
        page.contains("href=\"../records/ampco-seed1.json\"")
            && page.contains("4 of 4 runs finished")
    );
    let records = folder.records().all().unwrap();
    assert_eq!(records.len(), 4);
    assert_eq!(records[3].told.episode_share_at_switch, Some(0.9));
    for record in records {
        let bytes = fs::metadata(folder.records().path(&record.run_name()))
            .unwrap()
            .len();
        assert!(bytes <= ::study::record::LIMIT as u64, "{bytes}");
    }
}

#[test]
fn who_has_a_record_does_not_make_the_run_again() {
    let (here, there) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
    let (known, _) = finished(there.path(), &file());
    let (folder, planned) = begun(here.path(), &file());
    let judging = Judging::of(&file(), here.path()).unwrap();
    let stand = |folder: &StudyFolder| {
        let stands = planned
            .iter()
            .map(|run| stands(folder, &run.name, judging.as_ref()).unwrap());
        stands.filter(|stands| *stands).count()
    };
    assert_eq!(stand(&folder), 0);
    bring(&folder, &planned, Some(&known.records()), judging.as_ref()).unwrap();
    assert_eq!(stand(&folder), 4);
    // Asked for otherwise, and no run is here that could be judged anew.
    let mut other = Judging::of(&file(), here.path()).unwrap().unwrap();
    other.evaluation.episodes = 3;
    assert!(!stands(&folder, "ampco-seed1", Some(&other)).unwrap());
    let refused = bring(&folder, &planned, None, Some(&other))
        .unwrap_err()
        .to_string();
    assert!(
        refused.contains("ampco-seed1.json") && refused.contains("[evaluate]"),
        "{refused}"
    );
    // Where the run is, it is judged anew.
    bring(&known, &planned, None, Some(&other)).unwrap();
}

#[test]
fn a_record_of_another_configuration_is_refused_with_the_difference() {
    let (here, there) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
    let (known, _) = finished(there.path(), &file());
    let other = StudyFile::parse(&STUDY.replace("steps = 25", "steps = 50")).unwrap();
    let (folder, planned) = begun(here.path(), &other);
    let refused = bring(&folder, &planned, Some(&known.records()), None)
        .unwrap_err()
        .to_string();
    for part in [
        "ampco-seed1.json",
        "`steps = 25`",
        "`steps = 50`",
        "--records",
    ] {
        assert!(refused.contains(part), "{refused}");
    }
    assert!(folder.records().all().unwrap().is_empty());
    // Nor is such a study begun in a folder that has the records.
    let planned = plan::plan(&other, Path::new("."), "a test").unwrap();
    fs::remove_dir_all(there.path().join("runs")).unwrap();
    let refused = plan::together(&other, &planned, &known, Path::new("."), "a test").unwrap_err();
    assert!(
        format!("{refused:#}").contains("ampco-seed1.json"),
        "{refused:#}"
    );
}

#[test]
fn what_is_no_record_is_named_and_drafts_are_passed_over() {
    let place = tempfile::tempdir().unwrap();
    let (folder, _) = finished(place.path(), &file());
    let records = folder.records();
    let path = records.path("ampco-seed1");
    let text = fs::read_to_string(&path).unwrap();
    fs::write(place.path().join("records/.ampco-seed9.json.1.new"), "half").unwrap();
    assert_eq!(records.all().unwrap().len(), 4);
    for torn in ["", &text[..text.len() / 2], "<html>"] {
        fs::write(&path, torn).unwrap();
        let refused = format!("{:#}", records.all().unwrap_err());
        assert!(
            refused.contains("ampco-seed1.json: ") && refused.contains("fetch it anew"),
            "{refused}"
        );
    }
    fs::write(&path, &text).unwrap();
    fs::rename(&path, records.path("ampco-seed7")).unwrap();
    let refused = records.all().unwrap_err().to_string();
    assert!(
        refused.contains("ampco-seed7.json") && refused.contains("rename it to ampco-seed1.json"),
        "{refused}"
    );
}

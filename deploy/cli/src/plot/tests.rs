//! Curves of runs made of a few lines.

use super::*;
use serde_json::json;

/// A run whose iterations 3 and 4 are of Phase II, and whose iteration 2 was refused.
fn run(runs: &Path, name: &str) -> Folder {
    let folder = Folder::create(runs, name).unwrap();
    std::fs::write(folder.config_path(), "").unwrap();
    let mut metrics = run::Metrics::open(&folder.metrics_path()).unwrap();
    for iteration in 1..=4_u64 {
        let samples = 1_000_000 * iteration;
        let record = if iteration == 2 {
            json!({ "iteration": 2, "samples": samples, "fault": "loss" })
        } else {
            let phase = if iteration < 3 { 1 } else { 2 };
            json!({ "iteration": iteration, "samples": samples, "phase": phase,
                        "episode_length": null, "rmse": 0.5, "hip_correlation": -0.5,
                        "timing": { "iteration_seconds": 30.0 } })
        };
        metrics.append(&record).unwrap();
    }
    folder
}

#[test]
fn phase_two_is_marked_and_a_refused_iteration_is_a_gap() {
    let runs = tempfile::tempdir().unwrap();
    let lines = records(&run(runs.path(), "walk")).unwrap();
    // Half a minute each, of which the refused one has told nothing.
    let over_time = Over::Minutes.place(lines.clone());
    assert_eq!(switch(&over_time), Some(1.0));
    let records = Over::Samples.place(lines);
    assert_eq!(switch(&records), Some(3.0));
    assert_eq!(switch(&records[..2]), None);
    let all = [("walk".to_owned(), records)];
    let chart = chart(&all, &CURVES[4], Over::Samples, true);
    let errors: Vec<_> = chart.lines[0].points.iter().map(|point| point.1).collect();
    assert!(errors[1].is_nan() && errors[0] == 0.5 && errors[3] == 0.5);
    assert_eq!(chart.marks.len(), 1);
}

#[test]
fn curves_of_several_runs_are_written_to_one_file() {
    let runs = tempfile::tempdir().unwrap();
    run(runs.path(), "one");
    run(runs.path(), "two");
    let plot = Plot {
        runs: vec!["one".into(), "two".into()],
        place: Place {
            runs_dir: runs.path().to_owned(),
        },
        out: None,
        minutes: false,
    };
    plot.run().unwrap();
    let svg = std::fs::read_to_string(runs.path().join("one/curves.svg")).unwrap();
    for text in [
        "Learning: one, two",
        "Phase II",
        "hip correlation",
        "million samples",
    ] {
        assert!(svg.contains(text), "{text}");
    }
}

#[test]
fn a_run_without_iterations_is_refused_in_words() {
    let runs = tempfile::tempdir().unwrap();
    let folder = Folder::create(runs.path(), "new").unwrap();
    let error = records(&folder).unwrap_err().to_string();
    assert!(error.contains("`new`") && error.contains("no iteration yet"));
}

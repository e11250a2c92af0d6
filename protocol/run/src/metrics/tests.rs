//! Torn lines, damage, resumption and followers.

use super::*;
use serde_json::json;

fn iterations(path: &Path) -> Vec<u64> {
    let records: Vec<Value> = read(path).unwrap();
    records
        .iter()
        .map(|record| record["iteration"].as_u64().unwrap())
        .collect()
}

fn three(folder: &tempfile::TempDir) -> PathBuf {
    let path = folder.path().join("metrics.jsonl");
    let mut metrics = Metrics::open(&path).unwrap();
    for iteration in 1..=3 {
        metrics
            .append(&json!({ "iteration": iteration, "style_mean": 0.5 }))
            .unwrap();
    }
    path
}

fn tear(path: &Path) {
    let mut file = OpenOptions::new().append(true).open(path).unwrap();
    file.write_all(b"{\"iteration\": 4, \"sty").unwrap();
}

#[test]
fn a_torn_last_line_is_passed_over_by_readers_and_removed_by_the_writer() {
    let folder = tempfile::tempdir().unwrap();
    let path = three(&folder);
    tear(&path);
    assert_eq!(iterations(&path), [1, 2, 3]);
    assert_eq!(newest(&path).unwrap().unwrap()["iteration"], 3);

    Metrics::open(&path)
        .unwrap()
        .append(&json!({ "iteration": 4 }))
        .unwrap();
    assert_eq!(iterations(&path), [1, 2, 3, 4]);
}

#[test]
fn damage_before_the_last_line_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let path = three(&folder);
    tear(&path);
    let mut file = OpenOptions::new().append(true).open(&path).unwrap();
    file.write_all(b"\n{\"iteration\": 5}\n").unwrap();
    let error = read::<Value>(&path).unwrap_err();
    assert!(
        matches!(error, MetricsError::Malformed { line: 4, .. }),
        "{error}"
    );
}

#[test]
fn resuming_drops_later_iterations_and_no_file_is_no_records() {
    let folder = tempfile::tempdir().unwrap();
    let path = three(&folder);
    truncate_after(&path, 2).unwrap();
    assert_eq!(iterations(&path), [1, 2]);
    assert_eq!(iterations(&folder.path().join("none")), [0u64; 0]);
}

#[test]
fn a_follower_sees_each_whole_line_once_across_a_truncation() {
    let folder = tempfile::tempdir().unwrap();
    let path = three(&folder);
    let mut tail = Tail::from_start(&path);
    assert_eq!(tail.poll().unwrap().len(), 3);
    tear(&path);
    assert_eq!(tail.poll().unwrap().len(), 0);

    truncate_after(&path, 1).unwrap();
    assert_eq!(tail.poll().unwrap().len(), 0);
    let mut metrics = Metrics::open(&path).unwrap();
    metrics.append(&json!({ "iteration": 2 })).unwrap();
    assert_eq!(tail.poll().unwrap(), [json!({ "iteration": 2 })]);
}

#[test]
fn figures_come_back_bit_for_bit() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("metrics.jsonl");
    let figure = 0.1_f64 + 0.2;
    Metrics::open(&path)
        .unwrap()
        .append(&json!({ "iteration": 1, "x": figure }))
        .unwrap();
    let back = newest(&path).unwrap().unwrap()["x"].as_f64().unwrap();
    assert_eq!(back.to_bits(), figure.to_bits());
}

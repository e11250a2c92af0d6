//! Event files read back by TensorBoard's own reader.
//!
//! Where no Python has the package `tensorboard` there is nothing to read with: see `needs`. The format itself is tested
//! without it, beside its code.

use std::process::Command;

use run::Events;
use serde_json::{Value, json};

const READ: &str = "\
import json, sys
from tensorboard.backend.event_processing.event_accumulator import EventAccumulator
events = EventAccumulator(sys.argv[1])
events.Reload()
print(json.dumps({tag: [[e.step, e.value] for e in events.Scalars(tag)] for tag in events.Tags()['scalars']}))
";

#[test]
fn tensorboard_shows_what_was_written_and_forgets_what_a_resume_repeats() {
    let Some(python) = needs::python(&["tensorboard"]) else {
        return;
    };
    let folder = tempfile::tempdir().unwrap();
    let line = |iteration: u64, length: f64| json!({ "iteration": iteration, "episode_length": length, "phase": 1 });
    let mut first = Events::create(folder.path(), 0, 1_700_000_000.0).unwrap();
    for (iteration, length) in [(1, 20.0), (2, 30.0), (3, 40.0)] {
        first
            .append(&line(iteration, length), 1_700_000_000.0 + iteration as f64)
            .unwrap();
    }
    // A resume from iteration 2 tells iteration 3 again.
    let mut second = Events::create(folder.path(), 2, 1_700_000_100.0).unwrap();
    second.append(&line(3, 45.0), 1_700_000_101.0).unwrap();

    let output = Command::new(python)
        .args(["-c", READ])
        .arg(folder.path())
        .output()
        .unwrap();
    assert!(
        output.status.success(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    let read: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(
        read["Train/mean_episode_length"],
        json!([[1, 20.0], [2, 30.0], [3, 45.0]])
    );
    assert_eq!(read["AMPCO/phase"], json!([[1, 1.0], [2, 1.0], [3, 1.0]]));
}

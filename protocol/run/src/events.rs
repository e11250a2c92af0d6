//! TensorBoard event files beside `metrics.jsonl`: the same figures under the names that the field uses.
//!
//! Separate from the metrics because those are the record and these are a view: a file that cannot be written costs a
//! picture, never a run. `tensorboard --logdir runs` shows every run under its name.
//!
//! An event file is a sequence of records (`events/frame.rs`), each a protocol buffer (`events/message.rs`); which
//! figure gets which name is in `events/tags.rs`.

mod frame;
mod message;
mod tags;

use std::fs::{File, OpenOptions};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use prost::Message;
use serde_json::Value;

use message::{Event, SessionLog, Summary, SummaryValue};

/// The writer of one start of a run. Every start has a file of its own, which is how TensorBoard wants it.
#[derive(Debug)]
pub struct Events {
    file: File,
    path: PathBuf,
}

impl Events {
    /// Begins a file in the run's folder. `now` is the time, s since 1970; whatever earlier files say of iterations
    /// after `iteration` is about to happen again, and TensorBoard is told to forget it.
    ///
    /// # Errors
    /// When the file cannot be made or written.
    pub fn create(folder: &Path, iteration: u64, now: f64) -> io::Result<Self> {
        let name = format!(
            "events.out.tfevents.{:010}.ampco.{}",
            now as u64,
            std::process::id()
        );
        let path = folder.join(name);
        let file = OpenOptions::new().append(true).create(true).open(&path)?;
        let mut events = Self { file, path };
        events.write(&Event {
            wall_time: now,
            file_version: Some("brain.Event:2".to_owned()),
            ..Event::default()
        })?;
        events.write(&Event {
            wall_time: now,
            step: iteration as i64 + 1,
            session_log: Some(SessionLog::START),
            ..Event::default()
        })?;
        Ok(events)
    }

    /// Where it writes.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Appends every number of a record of metrics, at its iteration. Records without one are passed over.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn append(&mut self, record: &Value, now: f64) -> io::Result<()> {
        let Some(iteration) = record["iteration"].as_u64() else {
            return Ok(());
        };
        let value = tags::scalars(record)
            .into_iter()
            .map(|(tag, value)| SummaryValue {
                tag,
                simple_value: Some(value as f32),
            })
            .collect();
        self.write(&Event {
            wall_time: now,
            step: iteration as i64,
            summary: Some(Summary { value }),
            ..Event::default()
        })
    }

    /// One record in one write, so that a reader never meets half of one from a living writer.
    fn write(&mut self, event: &Event) -> io::Result<()> {
        self.file.write_all(&frame::wrap(&event.encode_to_vec()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    fn events(path: &Path) -> Vec<Event> {
        let bytes = std::fs::read(path).unwrap();
        frame::unwrap_all(&bytes)
            .unwrap()
            .into_iter()
            .map(|data| Event::decode(data).unwrap())
            .collect()
    }

    #[test]
    fn figures_come_back_at_their_iteration_under_their_names() {
        let folder = tempfile::tempdir().unwrap();
        let mut writer = Events::create(folder.path(), 41, 1_700_000_000.5).unwrap();
        let record =
            json!({ "iteration": 42, "value_loss": 0.25, "style_mean": 0.5, "lower_bound": null });
        writer.append(&record, 1_700_000_001.0).unwrap();
        writer.append(&json!({ "no": "iteration" }), 0.0).unwrap();

        let read = events(writer.path());
        assert_eq!(read.len(), 3);
        assert_eq!(read[0].file_version.as_deref(), Some("brain.Event:2"));
        assert_eq!(
            (read[1].step, read[1].session_log),
            (42, Some(SessionLog::START))
        );
        let summary = read[2].summary.clone().unwrap();
        let mut values: Vec<_> = summary
            .value
            .iter()
            .map(|value| (value.tag.as_str(), value.simple_value.unwrap()))
            .collect();
        values.sort_by(|a, b| a.0.cmp(b.0));
        assert_eq!(read[2].step, 42);
        assert_eq!(
            values,
            [("AMPCO/style_mean", 0.5), ("Loss/value_function", 0.25)]
        );
    }

    #[test]
    fn every_start_has_its_own_file_that_tensorboard_finds() {
        let folder = tempfile::tempdir().unwrap();
        let first = Events::create(folder.path(), 0, 1_700_000_000.0).unwrap();
        let second = Events::create(folder.path(), 10, 1_700_000_100.0).unwrap();
        assert_ne!(first.path(), second.path());
        assert!(first.path().to_str().unwrap().contains("tfevents"));
    }
}

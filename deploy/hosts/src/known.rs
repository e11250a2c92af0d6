//! `hosts.json`: what the gate knows of the hosts, for whoever looks at the run.

use std::path::Path;

use anyhow::{Context, Result};
use run::Folder;
use serde::{Deserialize, Serialize};
use wording::count;

/// Name of the file in the folder of a run.
pub const FILE: &str = "hosts.json";

/// What a gate knows.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Known {
    /// Where it listens.
    pub listens: String,
    /// Peers that were turned away.
    pub refused: u64,
    /// The hosts that are here.
    pub hosts: Vec<Host>,
}

/// A host.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Host {
    /// Name of the machine.
    pub host: String,
    /// Where its last connection came from.
    pub from: String,
    /// Numbers of its actors.
    pub actors: Vec<u32>,
    /// Since it joined, s.
    pub seconds: f64,
    /// Since it was heard, s.
    pub silent_seconds: f64,
    /// Rollouts passed on to the learner.
    pub rollouts: u64,
    /// Bytes of rollouts and robots that came from it.
    pub bytes_in: u64,
    /// Bytes of weights, robots and files that went to it.
    pub bytes_out: u64,
    /// As the host says: rollouts that it sent once more.
    pub resent: u64,
    /// As the host says: connections beyond the first.
    pub reconnects: u64,
    /// As the host says: from sending a rollout to its acknowledgement, mean of the latest, s.
    pub acknowledgement_seconds: f32,
}

impl Known {
    /// What stands in the folder of a run; `None` where no gate was.
    pub fn read(folder: &Path) -> Option<Self> {
        let text = std::fs::read(folder.join(FILE)).ok()?;
        serde_json::from_slice(&text).ok()
    }

    /// What is known while a gate lives.
    ///
    /// # Errors
    /// A folder that cannot be read.
    pub fn now(folder: &Folder) -> Result<Option<Self>> {
        let alive = folder.holder("gate")?.is_some();
        Ok(alive.then(|| Self::read(folder.path())).flatten())
    }

    /// Writes it down; a reader sees the old file or the new one.
    pub(crate) fn write(&self, folder: &Path) -> Result<()> {
        let text = serde_json::to_vec_pretty(self).context("writing what is known of hosts")?;
        let path = folder.join(FILE);
        run::replace_file(&path, &text).with_context(|| path.display().to_string())
    }

    /// A line about the gate and one about every host.
    pub fn lines(&self) -> Vec<String> {
        let turned = match self.refused {
            0 => String::new(),
            refused => format!(", {} turned away", count(refused, "peer")),
        };
        let hosts = count(self.hosts.len(), "host");
        let mut lines = vec![format!("gate on {}: {hosts}{turned}", self.listens)];
        lines.extend(self.hosts.iter().map(Host::line));
        lines
    }
}

impl Host {
    fn line(&self) -> String {
        let actors: Vec<String> = self.actors.iter().map(u32::to_string).collect();
        let named = match actors.as_slice() {
            [] => "no actor".to_owned(),
            [one] => format!("actor {one}"),
            many => format!("actors {}", many.join(" ")),
        };
        let silent = if self.silent_seconds < 10.0 {
            String::new()
        } else {
            format!(", silent for {:.0} s", self.silent_seconds)
        };
        format!(
            "  {} ({named}): {}, {:.1} MB in, {:.1} MB out, acknowledged in {:.0} ms, {}, {} sent again{silent}",
            self.host,
            count(self.rollouts, "rollout"),
            self.bytes_in as f64 / 1e6,
            self.bytes_out as f64 / 1e6,
            1e3 * self.acknowledgement_seconds,
            count(self.reconnects, "reconnect"),
            self.resent,
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hosts_are_told_in_a_line_each_while_a_gate_lives() {
        let runs = tempfile::tempdir().unwrap();
        let folder = Folder::create(runs.path(), "walk").unwrap();
        let known = Known {
            listens: "0.0.0.0:7000".to_owned(),
            refused: 2,
            hosts: vec![Host {
                host: "node7".to_owned(),
                actors: vec![2, 3],
                rollouts: 40,
                bytes_in: 118_000_000,
                bytes_out: 2_000_000,
                acknowledgement_seconds: 0.0123,
                silent_seconds: 12.0,
                reconnects: 1,
                ..Host::default()
            }],
        };
        known.write(folder.path()).unwrap();
        assert_eq!(Known::now(&folder).unwrap(), None);
        let _gate = folder.lock("gate").unwrap();
        assert_eq!(Known::now(&folder).unwrap(), Some(known.clone()));
        assert_eq!(
            known.lines(),
            [
                "gate on 0.0.0.0:7000: 1 host, 2 peers turned away",
                "  node7 (actors 2 3): 40 rollouts, 118.0 MB in, 2.0 MB out, acknowledged in 12 ms, 1 reconnect, 0 sent \
                 again, silent for 12 s",
            ]
        );
    }
}

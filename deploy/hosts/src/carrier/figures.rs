//! How it goes on this host: counted, told to the gate, shown to whoever watches.

use std::path::Path;
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use hosts::{Figures, LineFigures};
use wording::count;

use crate::local::Local;

/// Name of the file whose text `ampco join` shows.
pub(crate) const SHOWN: &str = "carrier.line";
/// Between two changes of it.
const SHOWING: Duration = Duration::from_millis(500);
/// What the newest acknowledgement weighs in the mean.
const NEWEST: f32 = 0.1;

/// What is counted.
pub(super) struct Counted {
    counts: Mutex<Counts>,
    /// Samples of a rollout.
    samples: usize,
    began: Instant,
}

#[derive(Debug, Default)]
struct Counts {
    delivered: u64,
    resent: u64,
    acknowledgement_seconds: f32,
    /// Of the newest weights.
    version: u64,
    /// Of those that the newest acknowledged rollout acted with.
    acted: u64,
    away: Option<String>,
    shown: Option<(Instant, u64)>,
}

impl Counted {
    pub(super) fn new(local: &Local) -> Self {
        let layout = local.layout();
        Self {
            counts: Mutex::default(),
            samples: layout.environments * layout.steps,
            began: Instant::now(),
        }
    }

    pub(super) fn acknowledged(&self, version: u64, seconds: f32) {
        let mut counts = self.lock();
        counts.away = None;
        let mean = if counts.delivered == 0 {
            seconds
        } else {
            counts.acknowledgement_seconds
        };
        counts.acknowledgement_seconds = (1.0 - NEWEST) * mean + NEWEST * seconds;
        counts.delivered += 1;
        counts.acted = version;
    }

    pub(super) fn again(&self) {
        self.lock().resent += 1;
    }

    /// The newest weights are of this version.
    pub(super) fn weights(&self, version: u64) {
        self.lock().version = version;
    }

    /// The gate is here, or away and why. True if that is new.
    pub(super) fn away(&self, why: Option<String>) -> bool {
        let mut counts = self.lock();
        let new = counts.away.is_some() != why.is_some();
        counts.away = why;
        new
    }

    pub(super) fn told(&self, line: LineFigures) -> Figures {
        let counts = self.lock();
        Figures {
            delivered: counts.delivered,
            resent: counts.resent,
            reconnects: line.reconnects,
            bytes_sent: line.sent,
            bytes_received: line.received,
            acknowledgement_seconds: counts.acknowledgement_seconds,
        }
    }

    /// Writes the line, when it is time to.
    pub(super) fn show(&self, folder: &Path, line: LineFigures) {
        let mut counts = self.lock();
        let (since, before) = counts.shown.unwrap_or((self.began, 0));
        if counts.shown.is_some() && since.elapsed() < SHOWING {
            return;
        }
        let rate = self.samples as f64 * (counts.delivered - before) as f64
            / since.elapsed().as_secs_f64().max(1e-3);
        counts.shown = Some((Instant::now(), counts.delivered));
        let state = match &counts.away {
            None => format!("{rate:.0} samples/s"),
            Some(why) => format!("the gate is away ({why})"),
        };
        let text = format!(
            "{state} · {}, {} sent again · {:.1} MB out, {:.1} MB in · weights {}, {} behind · acknowledged in {:.0} ms · {}",
            count(counts.delivered, "rollout"),
            counts.resent,
            line.sent as f64 / 1e6,
            line.received as f64 / 1e6,
            counts.version,
            counts.version.saturating_sub(counts.acted),
            1e3 * counts.acknowledgement_seconds,
            count(line.reconnects, "reconnect"),
        );
        drop(counts);
        // It is only shown: a full disk costs no rollout.
        let _ = run::replace_file(&folder.join(SHOWN), text.as_bytes());
    }

    fn lock(&self) -> MutexGuard<'_, Counts> {
        self.counts.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

//! The table of streams: name, depth, overflow. What each carries is said where the message is.
//!
//! Separate because the first process that opens a stream fixes its limits for all others; every
//! process must therefore read them here. A change of this table is a new
//! [`crate::PROTOCOL_VERSION`].

use std::fmt::Debug;

use iceoryx2::prelude::ZeroCopySend;

/// Most actors of one run.
pub const MAX_ACTORS: usize = 64;

/// Places for actors that died and whose place is not yet clean while they come back.
const RESTARTING: usize = 16;

/// Places for programs that only look: status, plots, tests.
const MONITORS: usize = 8;

/// Most processes in one domain: actors, learner, scheduler, supervisor, monitors.
pub(crate) const MAX_NODES: usize = MAX_ACTORS + RESTARTING + 2 * MONITORS;

/// Limits of one stream.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Spec {
    /// Name of the service; its event has the same name.
    pub(crate) name: &'static str,
    /// Most writers at a time.
    pub(crate) publishers: usize,
    /// Most readers at a time.
    pub(crate) subscribers: usize,
    /// Messages waiting for each reader, of each writer.
    pub(crate) buffer: usize,
    /// Messages each reader may hold at a time, of each writer.
    pub(crate) borrowed: usize,
    /// Messages a writer may fill at a time.
    pub(crate) loaned: usize,
    /// Sent messages a late reader still receives.
    pub(crate) history: usize,
    /// A full buffer loses its oldest message (true) or holds the writer up (false).
    pub(crate) overflow: bool,
    /// Messages that a writer reserves memory for, where that is fewer than could exist.
    pub(crate) reserve: Option<usize>,
}

impl Spec {
    /// Messages that a writer reserves memory for.
    pub(crate) fn messages(&self) -> usize {
        // Most that can exist at a time: with so many, iceoryx2 promises every loan.
        let most = self.subscribers * (self.buffer + self.borrowed) + self.history + self.loaned;
        self.reserve.unwrap_or(most)
    }
}

/// What a stream carries, and its row in the table.
pub(crate) trait Stream: Debug + 'static {
    /// Item of the payload, which is a slice.
    type Item: ZeroCopySend + Copy + Debug + Send + Sync + 'static;
    /// Header beside the payload; `()` where the payload says everything.
    type Header: ZeroCopySend + Copy + Debug + Default + Send + Sync + 'static;
    /// Limits.
    const SPEC: Spec;
}

/// Actors → learner. Nothing may be lost silently: a full buffer holds the actor up.
///
/// One reader, so a second learner of the same run is refused.
pub(crate) const ROLLOUTS: Spec = Spec {
    name: "rollouts",
    publishers: MAX_ACTORS + RESTARTING,
    subscribers: 1,
    buffer: 2,
    borrowed: 2,
    loaned: 2,
    history: 0,
    overflow: false,
    reserve: None,
};

/// Learner → actors. Only the newest counts, and a late actor still gets it.
///
/// All readers share the newest message, so far fewer exist than the worst case of 354: the newest,
/// the one being written, and a few held by readers that are copying an older one.
pub(crate) const WEIGHTS: Spec = Spec {
    name: "weights",
    publishers: 1,
    subscribers: MAX_ACTORS + RESTARTING + MONITORS,
    buffer: 1,
    // One in use, one found newer, one found newer still.
    borrowed: 3,
    loaned: 1,
    history: 1,
    overflow: true,
    reserve: Some(16),
};

/// Learner → scheduler. Every report counts; gaps show in the sequence number.
pub(crate) const REWARDS: Spec = Spec {
    name: "rewards",
    publishers: 1,
    subscribers: MONITORS,
    buffer: 64,
    borrowed: 1,
    loaned: 1,
    history: 0,
    overflow: true,
    reserve: None,
};

/// Scheduler → learner. As weights: the newest wins and is kept for late readers.
pub(crate) const DIRECTIVES: Spec = Spec {
    name: "directives",
    publishers: 1,
    subscribers: MONITORS,
    buffer: 1,
    // One found, one found newer.
    borrowed: 2,
    loaned: 1,
    history: 1,
    overflow: true,
    reserve: None,
};

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn memory_is_reserved_for_the_worst_case_except_for_weights() {
        assert_eq!(ROLLOUTS.messages(), 6); // 1·(2 + 2) + 0 + 2
        assert_eq!(REWARDS.messages(), 521); // 8·(64 + 1) + 0 + 1
        assert_eq!(DIRECTIVES.messages(), 26); // 8·(1 + 2) + 1 + 1
        assert_eq!(WEIGHTS.messages(), 16); // instead of 88·(1 + 3) + 1 + 1
    }
}

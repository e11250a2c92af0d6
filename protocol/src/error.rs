//! Why a stream cannot be joined or used: the facts, and what to do.
//!
//! Separate because these are the sentences that people read when a run does not start.

use crate::domain::DomainError;

/// Why a stream cannot be joined or used.
#[derive(Debug, thiserror::Error)]
pub enum PortError {
    /// The domain itself cannot be used.
    #[error("joining the domain of the run")]
    Domain(#[from] DomainError),
    /// iceoryx2 refused this process.
    #[error("joining the domain of the run as {role}: {cause}")]
    Join {
        /// Role of this process.
        role: String,
        /// What iceoryx2 said.
        cause: String,
    },
    /// The run was started by programs of another version.
    #[error(
        "stream {stream} of this run speaks protocol version {theirs}, this program speaks {ours}: \
         stop the run, then start all its programs from one build"
    )]
    Version {
        /// Name of the stream.
        stream: &'static str,
        /// Version of the running processes.
        theirs: String,
        /// Version of this program.
        ours: u32,
    },
    /// All places of the stream are held by living processes.
    #[error(
        "stream {stream} has {limit} place(s) for a {side} and all are taken by living processes: \
         {remedy}"
    )]
    Taken {
        /// Name of the stream.
        stream: &'static str,
        /// `writer` or `reader`.
        side: &'static str,
        /// How many places there are.
        limit: usize,
        /// What to do.
        remedy: &'static str,
    },
    /// Shared memory is full.
    #[error(
        "{stream}: {needed} bytes of shared memory needed, /dev/shm has {free} free: enlarge it \
         (docker run --shm-size, mount -o remount,size=… /dev/shm), lower the number of environments \
         per actor, or delete what dead runs left there (/dev/shm/ampco_*)"
    )]
    Memory {
        /// Name of the stream.
        stream: &'static str,
        /// Bytes needed, a margin included.
        needed: u64,
        /// Bytes free.
        free: u64,
    },
    /// A message does not have the size that its header or the configuration promises.
    #[error("stream {stream}: a message of {got} numbers where {expected} were expected")]
    Length {
        /// Name of the stream.
        stream: &'static str,
        /// Numbers expected.
        expected: usize,
        /// Numbers found.
        got: usize,
    },
    /// A rollout whose rows hold something else than this process' lists say.
    #[error(
        "actor {actor} sends other observations than this run's configuration says: {difference}; restart the group so \
         that all processes read the same config.toml"
    )]
    Lists {
        /// Index of the actor.
        actor: u32,
        /// How its lists differ from ours.
        difference: String,
    },
    /// Anything else that the middleware or the system refused.
    #[error("stream {stream}: {action}: {cause}")]
    System {
        /// Name of the stream.
        stream: &'static str,
        /// What was tried.
        action: &'static str,
        /// What was said.
        cause: String,
    },
}

//! The messages of the calls, as protocol buffers from plain structs.
//!
//! Separate because other programs may read them by these numbers; a changed meaning is a new [`crate::VERSION`].

use prost::Message;
use prost::bytes::Bytes;

/// A host that wants to take part.
#[derive(Clone, PartialEq, Message)]
pub struct Join {
    /// [`crate::VERSION`] of the host.
    #[prost(uint32, tag = "1")]
    pub version: u32,
    /// [`protocol::PROTOCOL_VERSION`] of the host.
    #[prost(uint32, tag = "2")]
    pub protocol: u32,
    /// Version of the programs.
    #[prost(string, tag = "3")]
    pub programs: String,
    /// Name of the machine.
    #[prost(string, tag = "4")]
    pub host: String,
    /// Which stay it is: random, and the same after a restart in the same folder.
    #[prost(string, tag = "5")]
    pub life: String,
    /// How many actors it wants to run; 0 for those of `numbers` alone.
    #[prost(uint32, tag = "6")]
    pub actors: u32,
    /// The numbers that its actors have already.
    #[prost(uint32, repeated, tag = "7")]
    pub numbers: Vec<u32>,
    /// [`crate::features`] of the host.
    #[prost(string, repeated, tag = "8")]
    pub features: Vec<String>,
}

/// What a host that takes part needs to know.
#[derive(Clone, PartialEq, Message)]
pub struct Joined {
    /// Name of the run.
    #[prost(string, tag = "1")]
    pub run: String,
    /// Its `config.toml`.
    #[prost(string, tag = "2")]
    pub config: String,
    /// The files of its reference motion.
    #[prost(message, repeated, tag = "3")]
    pub motion: Vec<MotionFile>,
    /// The numbers of the host's actors.
    #[prost(uint32, repeated, tag = "4")]
    pub numbers: Vec<u32>,
    /// What is to be told to whoever joins.
    #[prost(string, repeated, tag = "5")]
    pub notices: Vec<String>,
}

/// A file of the reference motion.
#[derive(Clone, PartialEq, Message)]
pub struct MotionFile {
    /// Where it is on the learner's machine.
    #[prost(string, tag = "1")]
    pub path: String,
    /// SHA-256 of its bytes, in hexadecimal.
    #[prost(string, tag = "2")]
    pub sha256: String,
    /// Its length in bytes.
    #[prost(uint64, tag = "3")]
    pub length: u64,
}

/// Which piece of a motion file is wanted.
#[derive(Clone, PartialEq, Message)]
pub struct PieceWanted {
    /// The file's hash.
    #[prost(string, tag = "1")]
    pub sha256: String,
    /// From which byte on.
    #[prost(uint64, tag = "2")]
    pub offset: u64,
}

/// A piece of a file: at most [`crate::PIECE`] bytes; none behind its end.
#[derive(Clone, PartialEq, Message)]
pub struct Piece {
    /// The bytes.
    #[prost(bytes = "bytes", tag = "1")]
    pub bytes: Bytes,
}

/// Which weights a host has; it wants others.
#[derive(Clone, PartialEq, Message)]
pub struct Wanted {
    /// The host's stay.
    #[prost(string, tag = "1")]
    pub life: String,
    /// Learner, version and order of the weights that it has; nothing if it has none.
    #[prost(uint64, repeated, tag = "2")]
    pub has: Vec<u64>,
    /// How it goes there.
    #[prost(message, optional, tag = "3")]
    pub figures: Option<Figures>,
}

/// How it goes on a host.
#[derive(Clone, Copy, PartialEq, Message)]
pub struct Figures {
    /// Rollouts that were acknowledged.
    #[prost(uint64, tag = "1")]
    pub delivered: u64,
    /// Rollouts that were sent once more, because the answer never came or was "again".
    #[prost(uint64, tag = "2")]
    pub resent: u64,
    /// Connections beyond the first.
    #[prost(uint64, tag = "3")]
    pub reconnects: u64,
    /// Bytes of rollouts and robots that were sent, those sent once more included.
    #[prost(uint64, tag = "4")]
    pub bytes_sent: u64,
    /// Bytes of weights and files that were received.
    #[prost(uint64, tag = "5")]
    pub bytes_received: u64,
    /// From the first sending of a rollout to its acknowledgement, mean of the latest, s.
    #[prost(float, tag = "6")]
    pub acknowledgement_seconds: f32,
}

/// Weights as they are sent: the header's fields, and the numbers.
#[derive(Clone, PartialEq, Message)]
pub struct Newest {
    /// Whether there are others than the host has; else the other fields say nothing.
    #[prost(bool, tag = "1")]
    pub fresh: bool,
    /// Incarnation of the learner.
    #[prost(fixed64, tag = "2")]
    pub learner: u64,
    /// Version of the weights.
    #[prost(uint64, tag = "3")]
    pub version: u64,
    /// The run's clock.
    #[prost(uint64, tag = "4")]
    pub samples: u64,
    /// What to do.
    #[prost(uint32, tag = "5")]
    pub order: u32,
    /// Widths of the hidden layers.
    #[prost(uint32, repeated, tag = "6")]
    pub hidden: Vec<u32>,
    /// N of the rollouts wanted.
    #[prost(uint32, tag = "7")]
    pub environments: u32,
    /// T of the rollouts wanted.
    #[prost(uint32, tag = "8")]
    pub steps: u32,
    /// Whether each version is answered by exactly one rollout.
    #[prost(bool, tag = "9")]
    pub lockstep: bool,
    /// What normalised observations are cut to.
    #[prost(float, tag = "10")]
    pub observation_clip: f32,
    /// What the rows of the rollouts hold.
    #[prost(fixed64, repeated, tag = "11")]
    pub lists: Vec<u64>,
    /// The numbers, f32, the least significant byte first.
    #[prost(bytes = "bytes", tag = "12")]
    pub flat: Bytes,
}

/// A rollout as it is sent: the header's fields, and the lean rows.
#[derive(Clone, PartialEq, Message)]
pub struct Delivery {
    /// The host's stay.
    #[prost(string, tag = "1")]
    pub life: String,
    /// Number of the actor.
    #[prost(uint32, tag = "2")]
    pub actor: u32,
    /// N, environments.
    #[prost(uint32, tag = "3")]
    pub environments: u32,
    /// T, control steps.
    #[prost(uint32, tag = "4")]
    pub steps: u32,
    /// Life of the actor.
    #[prost(fixed64, tag = "5")]
    pub incarnation: u64,
    /// Rollouts of this life before this one.
    #[prost(uint64, tag = "6")]
    pub sequence: u64,
    /// Incarnation of the learner whose weights were used.
    #[prost(fixed64, tag = "7")]
    pub learner: u64,
    /// Version of those weights.
    #[prost(uint64, tag = "8")]
    pub policy_version: u64,
    /// Seconds of observing, of physics, of the policy, of waiting, and from the first step to the last.
    #[prost(float, repeated, tag = "9")]
    pub seconds: Vec<f32>,
    /// Names of the task's terms, each filled up with zeros.
    #[prost(bytes = "vec", repeated, tag = "10")]
    pub terms: Vec<Vec<u8>>,
    /// The means of those terms.
    #[prost(float, repeated, tag = "11")]
    pub means: Vec<f32>,
    /// What the rows hold.
    #[prost(fixed64, repeated, tag = "12")]
    pub lists: Vec<u64>,
    /// The rows, lean.
    #[prost(bytes = "bytes", tag = "13")]
    pub rows: Bytes,
}

/// The answer to a rollout.
#[derive(Clone, Copy, PartialEq, Message)]
pub struct Delivered {
    /// The learner's buffer has it. Otherwise it is to be sent again.
    #[prost(bool, tag = "1")]
    pub taken: bool,
}

/// A piece of an actor's robots, for a checkpoint.
#[derive(Clone, PartialEq, Message)]
pub struct Robots {
    /// The host's stay.
    #[prost(string, tag = "1")]
    pub life: String,
    /// Number of the actor.
    #[prost(uint32, tag = "2")]
    pub actor: u32,
    /// Iteration of the checkpoint.
    #[prost(uint64, tag = "3")]
    pub version: u64,
    /// Where the piece begins.
    #[prost(uint64, tag = "4")]
    pub offset: u64,
    /// Length of the whole.
    #[prost(uint64, tag = "5")]
    pub whole: u64,
    /// The piece.
    #[prost(bytes = "bytes", tag = "6")]
    pub bytes: Bytes,
}

/// The answer to a piece of an actor's robots.
#[derive(Clone, Copy, PartialEq, Message)]
pub struct Attached {
    /// How many bytes are there by now; go on from here.
    #[prost(uint64, tag = "1")]
    pub so_far: u64,
}

/// Which piece of an actor's robots is wanted; answered by a [`Piece`].
#[derive(Clone, PartialEq, Message)]
pub struct RobotsWanted {
    /// The host's stay.
    #[prost(string, tag = "1")]
    pub life: String,
    /// Number of the actor.
    #[prost(uint32, tag = "2")]
    pub actor: u32,
    /// Iteration of the checkpoint.
    #[prost(uint64, tag = "3")]
    pub version: u64,
    /// From which byte on.
    #[prost(uint64, tag = "4")]
    pub offset: u64,
}

/// Actors that are gone, and nothing of them is on its way.
#[derive(Clone, PartialEq, Message)]
pub struct Leave {
    /// The host's stay.
    #[prost(string, tag = "1")]
    pub life: String,
    /// Their numbers.
    #[prost(uint32, repeated, tag = "2")]
    pub numbers: Vec<u32>,
}

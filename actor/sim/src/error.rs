//! Why a fleet cannot be built or restored.

use crate::physics::Physics;
use vocabulary::Invalid;

/// Why a fleet cannot be built or restored.
#[derive(Debug, thiserror::Error)]
pub enum SimError {
    /// A configuration value is not usable.
    #[error(transparent)]
    Invalid(#[from] Invalid),
    /// The bytes are no snapshot of a fleet of this build.
    #[error("a fleet snapshot of {bytes} bytes cannot be read")]
    Snapshot {
        /// Length of what was given.
        bytes: usize,
        /// What the decoder met.
        #[source]
        source: bincode::error::DecodeError,
    },
    /// The snapshot is of another number of environments.
    #[error("the snapshot holds {found} environments, this fleet has {expected}")]
    Count {
        /// Environments in the snapshot.
        found: usize,
        /// Environments of this fleet.
        expected: usize,
    },
    /// The snapshot is of the other physics engine.
    #[error("the snapshot is of robots in {found:?}, this fleet's are in {expected:?}")]
    Engine {
        /// Engine of the snapshot.
        found: Physics,
        /// Engine of this fleet.
        expected: Physics,
    },
    /// The snapshot is of a program that kept more or less of each robot.
    #[error("the snapshot is of a program that kept more or less of each robot")]
    Program,
}

impl SimError {
    /// Whether a snapshot is good and of another fleet: as configured, and no fault of a disk or a program.
    pub fn is_of_another_fleet(&self) -> bool {
        matches!(self, Self::Count { .. } | Self::Engine { .. })
    }
}

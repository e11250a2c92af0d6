//! The physics engines by name, and what may touch in them, as options of commands.

use sim::{Mechanics, Physics};

/// What moves the robots.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum Engine {
    /// The general engine, one robot at a time: the judge
    Rapier,
    /// The solver for this one robot, sixteen at a time
    Batched,
}

/// Whether the parts of a robot meet each other.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum SelfCollision {
    /// Legs, arms and trunk meet, as a robot's do
    On,
    /// They pass through each other
    Off,
}

impl SelfCollision {
    /// With an engine.
    pub fn within(self, engine: Engine) -> Mechanics {
        Mechanics {
            physics: engine.into(),
            self_collision: self == Self::On,
        }
    }
}

impl From<Engine> for Physics {
    fn from(engine: Engine) -> Self {
        match engine {
            Engine::Rapier => Self::Rapier,
            Engine::Batched => Self::Batched,
        }
    }
}

//! The physics engines by name, as options of commands.

use sim::Physics;

/// What moves the robots.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum Engine {
    /// The general engine, one robot at a time: the judge
    Rapier,
    /// The solver for this one robot, sixteen at a time
    Batched,
}

impl From<Engine> for Physics {
    fn from(engine: Engine) -> Self {
        match engine {
            Engine::Rapier => Self::Rapier,
            Engine::Batched => Self::Batched,
        }
    }
}

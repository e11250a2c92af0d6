//! What a term is.

use crate::scene::Scene;

/// Writes what is seen of a scene, as many numbers as there is room for.
pub type Writer = fn(&Scene<'_>, &mut [f32]);

/// A named part of an observation.
#[derive(Debug)]
pub struct Term {
    /// Its name in the configuration.
    pub name: &'static str,
    /// A name for each of its numbers; there are as many numbers as names.
    pub labels: &'static [&'static str],
    /// Writes its numbers, in its unit, of a scene.
    pub write: Writer,
    /// Where number `i` of the left–right reflected term comes from within the term, and its sign.
    pub mirror: fn(usize) -> (usize, f32),
    /// What it measures.
    pub kind: Kind,
    /// Its unit.
    pub unit: &'static str,
    /// The frame that it is in.
    pub frame: &'static str,
    /// In words.
    pub meaning: &'static str,
}

/// What a term measures: by it Table I blurs what the actor sees, and the discriminator knows what is no difference.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Where parts of the robot are, m.
    Length,
    /// How fast it goes, m/s.
    LinearVelocity,
    /// How fast it turns, rad/s.
    AngularVelocity,
    /// Where down is, a unit vector.
    Gravity,
    /// Positions of joints, rad.
    JointPosition,
    /// Velocities of joints, rad/s.
    JointVelocity,
    /// What reference motion has not: commands, actions, what only a simulation knows.
    Beside,
}

impl Term {
    /// How many numbers it has.
    pub fn width(&self) -> usize {
        self.labels.len()
    }

    /// Whether reference motion has it too, as all that the discriminator sees must be.
    pub fn is_of_motion(&self) -> bool {
        self.kind != Kind::Beside
    }
}

//! The lists of a run together, and every width that follows from them.

use crate::table::{Reflection, Table};
use crate::terms::{ACTOR, PAPER_ACTOR, PAPER_DISCRIMINATOR};
use std::ops::Range;

/// The lists of a run.
#[derive(Clone, Debug)]
pub struct Tables {
    /// What the policy sees.
    pub actor: Table,
    /// What the critic sees; none where that is what the policy sees.
    pub critic: Option<Critic>,
    /// What the discriminator sees of a state.
    pub discriminator: Table,
    /// What measures of the gait and the discriminator's view of the command need, in units, and none of the lists
    /// shows so. Of the state after a step and the command during it; empty with the paper's lists.
    pub measured: Table,
}

/// A list of the critic's own.
#[derive(Clone, Debug)]
pub struct Critic {
    /// Whether its rows begin with the actor's.
    pub sees_actor: bool,
    /// The terms beside that.
    pub own: Table,
}

/// Numbers of a row of each kind.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Widths {
    /// What the policy sees.
    pub observation: usize,
    /// What the critic sees beside that, or instead; 0 where it sees what the policy does.
    pub critic: usize,
    /// What the discriminator sees of a state.
    pub features: usize,
    /// What is measured beside, see [`Tables::measured`].
    pub measured: usize,
}

/// Which row holds something, and where.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Place {
    /// What the policy sees.
    Observation(Range<usize>),
    /// What the discriminator sees of the state after the step.
    Features(Range<usize>),
    /// What is measured beside.
    Measured(Range<usize>),
}

/// Where the learner finds what measures are made of.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Places {
    /// The command in force during a step.
    pub command: Place,
    /// Direction of gravity in the base frame: of what the policy saw before the step, of what was measured after it.
    pub gravity: Place,
    /// The paper's features of the state after a step, in units.
    pub features: Place,
}

impl Default for Tables {
    /// The paper's.
    fn default() -> Self {
        let (actor, discriminator) = (&PAPER_ACTOR, &PAPER_DISCRIMINATOR);
        let plain = |names: &[&str]| Table::plain(names.iter().copied());
        Self::new(plain(actor), None, plain(discriminator))
    }
}

impl Tables {
    pub(crate) fn new(actor: Table, critic: Option<Critic>, discriminator: Table) -> Self {
        let mut lacking = Vec::new();
        lacking.extend(actor.in_units("command").is_none().then_some("command"));
        if !shows_paper(&discriminator) {
            lacking.extend(PAPER_DISCRIMINATOR);
        }
        lacking.extend(actor.in_units("gravity").is_none().then_some("gravity"));
        Self {
            actor,
            critic,
            discriminator,
            measured: Table::plain(lacking),
        }
    }

    /// Numbers of a row of each kind.
    pub fn widths(&self) -> Widths {
        Widths {
            observation: self.actor.width(),
            critic: self.critic.as_ref().map_or(0, |critic| critic.own.width()),
            features: self.discriminator.width(),
            measured: self.measured.width(),
        }
    }

    /// Numbers of a whole row of the critic's, what it sees of the actor's included.
    pub fn critic_width(&self) -> usize {
        match &self.critic {
            None => self.actor.width(),
            Some(critic) => critic.own.width() + self.shared_width(),
        }
    }

    /// Numbers of the critic's row that are the actor's.
    pub fn shared_width(&self) -> usize {
        let shares = self.critic.as_ref().is_none_or(|critic| critic.sees_actor);
        if shares { self.actor.width() } else { 0 }
    }

    /// The reflection of a whole row of the critic's.
    pub fn critic_reflection(&self) -> Reflection {
        let Some(critic) = &self.critic else {
            return self.actor.reflection();
        };
        let mut whole = if critic.sees_actor {
            self.actor.reflection()
        } else {
            Reflection::default()
        };
        let (start, own) = (whole.index.len(), critic.own.reflection());
        whole
            .index
            .extend(own.index.iter().map(|from| start + from));
        whole.sign.extend(own.sign);
        whole
    }

    /// Where the learner finds what measures are made of.
    pub fn places(&self) -> Places {
        let measured = |name: &str| self.measured.in_units(name).expect("measured for this");
        let seen = |name: &str| match self.actor.in_units(name) {
            Some(place) => Place::Observation(place),
            None => Place::Measured(measured(name)),
        };
        let width = Table::plain(PAPER_DISCRIMINATOR).width();
        Places {
            command: seen("command"),
            gravity: seen("gravity"),
            features: if shows_paper(&self.discriminator) {
                Place::Features(0..width)
            } else {
                let start = measured(PAPER_DISCRIMINATOR[0]).start;
                Place::Measured(start..start + width)
            },
        }
    }

    /// Where the discriminator's rows hold velocity forward and leftward (m/s) and yaw rate (rad/s), if they do.
    pub fn velocities(&self) -> Option<[usize; 3]> {
        let linear = self.discriminator.in_units("linear_velocity")?;
        let angular = self.discriminator.in_units("angular_velocity")?;
        Some([linear.start, linear.start + 1, angular.end - 1])
    }

    /// The same lists without noise of their own.
    #[must_use]
    pub fn exact(&self) -> Self {
        let critic = |critic: &Critic| Critic {
            own: critic.own.exact(),
            ..*critic
        };
        Self {
            actor: self.actor.exact(),
            critic: self.critic.as_ref().map(critic),
            ..self.clone()
        }
    }

    /// All lists in a line.
    pub fn words(&self) -> String {
        let critic = match &self.critic {
            None => ACTOR.to_owned(),
            Some(Critic {
                sees_actor: true,
                own,
            }) => format!("{ACTOR}, {}", own.words()),
            Some(Critic { own, .. }) => own.words(),
        };
        format!(
            "actor [{}] critic [{critic}] discriminator [{}]",
            self.actor.words(),
            self.discriminator.words()
        )
    }

    /// Whether the actor's list is the paper's, as that of a policy without a list is.
    pub fn is_papers_actor(&self) -> bool {
        is_plain(&self.actor, &PAPER_ACTOR) && self.actor.entries().len() == PAPER_ACTOR.len()
    }
}

/// Whether rows begin with the paper's features, in units.
fn shows_paper(discriminator: &Table) -> bool {
    is_plain(discriminator, &PAPER_DISCRIMINATOR)
}

fn is_plain(table: &Table, names: &[&str]) -> bool {
    let entries = table.entries();
    entries.len() >= names.len()
        && entries.iter().zip(names).all(|(entry, name)| {
            let as_it_is = entry.scale == 1.0 && entry.clip.is_none() && entry.past == 0;
            entry.term.name == *name && as_it_is
        })
}

#[cfg(test)]
mod tests;

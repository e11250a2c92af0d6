//! How a fleet begins.

use super::Fleet;
use crate::actuator::Gains;
use crate::env::{Environment, Setting};
use crate::error::SimError;
use crate::event::EventConfig;
use crate::physics::{Bodies, Mechanics};
use crate::randomization::{RandomizationConfig, Table};
use crate::start::{Pools, Starts};
use crate::task::TaskConfig;
use crate::terms::Sums;
use observation::Tables;
use vocabulary::Section;
use vocabulary::invalid::within;

/// What a fleet is of, whatever it does.
pub(super) struct Make {
    pub(super) mechanics: Mechanics,
    pub(super) gains: Gains,
    pub(super) tables: Tables,
}

/// How robots and their worlds differ from the tables.
#[derive(Clone, Debug, Default)]
pub struct Varied {
    /// Table I.
    pub randomization: RandomizationConfig,
    /// What befalls them.
    pub event: EventConfig,
}

impl From<&RandomizationConfig> for Varied {
    /// Nothing befalls them.
    fn from(randomization: &RandomizationConfig) -> Self {
        (randomization, &EventConfig::default()).into()
    }
}

impl From<(&RandomizationConfig, &EventConfig)> for Varied {
    fn from((randomization, event): (&RandomizationConfig, &EventConfig)) -> Self {
        Self {
            randomization: randomization.clone(),
            event: event.clone(),
        }
    }
}

impl Fleet {
    /// Environments at the start of their first episodes, seen as in the paper. An engine alone means robots whose parts
    /// meet each other.
    pub fn new(
        mechanics: impl Into<Mechanics>,
        task: &TaskConfig,
        varied: impl Into<Varied>,
        starts: Starts,
        environments: usize,
        seed: u64,
    ) -> Result<Self, SimError> {
        Self::seen_by(
            &Tables::default(),
            mechanics,
            task,
            varied,
            starts,
            environments,
            seed,
        )
    }

    /// The same, seen as lists say.
    pub fn seen_by(
        tables: &Tables,
        mechanics: impl Into<Mechanics>,
        task: &TaskConfig,
        varied: impl Into<Varied>,
        starts: Starts,
        environments: usize,
        seed: u64,
    ) -> Result<Self, SimError> {
        let make = Make {
            mechanics: mechanics.into(),
            gains: Gains::of_the_robot(),
            tables: tables.clone(),
        };
        Self::build(make, task, varied, starts, environments, seed)
    }

    pub(super) fn build(
        make: Make,
        task: &TaskConfig,
        varied: impl Into<Varied>,
        starts: Starts,
        environments: usize,
        seed: u64,
    ) -> Result<Self, SimError> {
        let Make {
            mechanics,
            gains,
            tables,
        } = make;
        task.validate()?;
        let Varied {
            randomization,
            event,
        } = varied.into();
        randomization.validate()?;
        within(EventConfig::NAME, event.validate())?;
        within(EventConfig::NAME, event.check_beside(&randomization))?;
        starts.validate()?;
        vocabulary::invalid::require(
            environments > 0,
            "environments",
            environments,
            "give at least 1",
        )?;
        let setting = Setting {
            task: task.clone(),
            table: Table::of(randomization, &tables),
            plain: Table::of(RandomizationConfig::default(), &tables.exact()),
            pools: Pools::of(&starts),
            event: event.has_rows().then_some(event),
            starts,
            tables,
            robots: environments,
            ground: task.ground.map(|ground| ground.lay(seed)),
        };
        let widths = setting.tables.widths();
        let own = setting.tables.critic.as_ref().map(|critic| &critic.own);
        let frame = own.map_or(0, observation::Table::frame_width);
        let frame = frame.max(setting.tables.actor.frame_width());
        let mut bodies = Bodies::new(mechanics, &gains, environments, setting.ground.as_ref());
        let mut fleet = Self {
            environments: (0..environments)
                .map(|index| Environment::new(&setting, &mut bodies, seed, index))
                .collect(),
            setting,
            physics: mechanics.physics,
            bodies,
            acted: vec![true; environments],
            observations: vec![0.0; environments * widths.observation],
            critic: vec![0.0; environments * widths.critic],
            features: vec![0.0; environments * widths.features],
            frame: vec![0.0; frame],
            last: Vec::new(),
            sums: Sums::default(),
            faults: 0,
        };
        fleet.forget_last_steps();
        for index in 0..environments {
            fleet.look(index);
        }
        Ok(fleet)
    }
}

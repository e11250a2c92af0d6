//! What the environments of a fleet share.

use crate::event::EventConfig;
use crate::ground::Ground;
use crate::randomization::{self, Table};
use crate::start::{Pools, Starts};
use crate::task::TaskConfig;
use g1::RobotState;
use observation::Tables;

/// What all environments of a fleet have in common.
pub(crate) struct Setting {
    pub(crate) task: TaskConfig,
    pub(crate) table: Table,
    /// The table of robots that it leaves alone: every row off.
    pub(crate) plain: Table,
    /// What befalls robots; none where nothing does.
    pub(crate) event: Option<EventConfig>,
    pub(crate) starts: Starts,
    /// The starts by kind of command.
    pub(crate) pools: Pools,
    /// What is seen of a robot.
    pub(crate) tables: Tables,
    /// Robots of the fleet.
    pub(crate) robots: usize,
    /// Hills and bumps, where the floor is not level.
    pub(crate) ground: Option<Ground>,
}

impl Setting {
    /// A state of an engine as it is told.
    #[inline]
    pub(super) fn told(&self, state: RobotState) -> RobotState {
        match &self.ground {
            None => state,
            Some(ground) => ground.level(state),
        }
    }

    /// Table I as it counts for a robot.
    pub(crate) fn table(&self, robot: usize) -> &Table {
        if self.table.rows.spares(robot) {
            &self.plain
        } else {
            &self.table
        }
    }

    /// What befalls a robot.
    pub(crate) fn event(&self, robot: usize) -> Option<&EventConfig> {
        let event = self.event.as_ref()?;
        (!randomization::spares(event.plain_share, robot)).then_some(event)
    }
}

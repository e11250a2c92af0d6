//! What a discriminator is shown of robots that go: windows of their last states.
//!
//! Separate because whoever judges and whoever teaches a judge look at the same windows.

use amp::DiscriminatorConfig;
use g1::RobotState;
use observation::{Scene, Table};

/// The memory of some robots' last states.
pub(super) struct Windows {
    /// States that a window has, and steps from one to the next.
    frames: usize,
    spacing: usize,
    /// Whether a window ends with the command.
    sees_command: bool,
    /// What it sees of a state; its own list, whatever the policy's says.
    table: Table,
    /// The last states of each robot but the newest, as it sees them, `[robot][(frames − 1)·spacing][numbers]`, oldest
    /// first.
    seen: Vec<f32>,
    /// The newest state as it sees it; memory that is used again.
    newest: Vec<f32>,
    /// How many of these are of the episode.
    known: Vec<usize>,
}

impl Windows {
    /// As a discriminator of this kind sees them, by its list of terms.
    pub(super) fn new(config: &DiscriminatorConfig, table: Table) -> Self {
        Self {
            frames: config.frames,
            spacing: config.spacing,
            sees_command: config.command_blur.is_some(),
            table,
            seen: Vec::new(),
            newest: Vec::new(),
            known: Vec::new(),
        }
    }

    /// Numbers of a window: `[frames][numbers]`, then the command if that is seen.
    pub(super) fn width(&self) -> usize {
        let command = if self.sees_command { 3 } else { 0 };
        self.frames * self.table.width() + command
    }

    /// Takes one step of one robot, the states before and after it, and appends its window with the command in force. What
    /// an episode has not yet seen is as the oldest state of the window that it has, as in training.
    pub(super) fn take(
        &mut self,
        robot: usize,
        first: bool,
        [before, after]: [&RobotState; 2],
        command: &[f32; 3],
        out: &mut Vec<f32>,
    ) {
        let features = self.table.width();
        let depth = (self.frames - 1) * self.spacing;
        let size = depth * features;
        if self.known.len() <= robot {
            self.known.resize(robot + 1, 0);
            self.seen.resize((robot + 1) * size, 0.0);
        }
        let seen = &mut self.seen[robot * size..][..size];
        seen.copy_within(features.., 0);
        look(&self.table, before, &mut seen[size - features..]);
        let newest = &mut self.newest;
        newest.resize(features, 0.0);
        look(&self.table, after, newest);
        let known = if first { 1 } else { self.known[robot] + 1 }.min(depth);
        self.known[robot] = known;
        // States of the window before the newest that there are.
        let real = known / self.spacing;
        for back in (1..self.frames).rev() {
            let state = match back.min(real) {
                0 => newest,
                there => &seen[size - there * self.spacing * features..][..features],
            };
            out.extend_from_slice(state);
        }
        out.extend_from_slice(newest);
        if self.sees_command {
            out.extend_from_slice(command);
        }
    }
}

/// Writes what is seen of a state.
fn look(table: &Table, state: &RobotState, out: &mut [f32]) {
    table.measure(&Scene::of(state), out);
    table.adjust(out);
}

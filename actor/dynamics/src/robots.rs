//! Many robots: the face of this crate.
//!
//! Separate because callers think of robot 37, while the solver thinks of lane 5 of block 2.

use crate::block::{Block, Build, LANES, Row, row};
use crate::condition::{Condition, Own};
use crate::contact::{self, Contacts};
use crate::drive::Motors;
use crate::ground::Ground;
use crate::group::Tally;
use crate::lane::{Packed, boundary};
use crate::step::{Crew, Setting, step};
use crate::tree::Tree;
use g1::{JOINTS, RobotState};
use nalgebra::Vector3;
use pulp::{Arch, Simd, WithSimd};
use serde::{Deserialize, Serialize};

/// Beyond these speeds (m/s, rad/s) a state is taken for a blown-up one.
const SPEED_LIMIT: f32 = 1_000.0;

/// How steps are taken.
#[derive(Clone, Debug, PartialEq)]
pub struct Solver {
    /// Length of a physics step, s.
    pub dt: f32,
    /// Gauss–Seidel sweeps over the contacts.
    pub sweeps: usize,
    /// The motors.
    pub motors: Motors<f32>,
    /// The ground.
    pub ground: Ground,
    /// Whether limbs and trunk meet each other ([`g1::collision`]); they pass through each other otherwise.
    pub self_collision: bool,
}

/// What a control step took and felt, per robot.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Effort {
    /// Positive mechanical work of the motors, J.
    pub energy: f32,
    /// Vertical force on the left and the right sole, mean over the step, N.
    pub foot_forces: [f32; 2],
}

/// Greatest torque and speed of every joint in a control step, without sign.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Peaks {
    /// N·m.
    pub torques: [f32; JOINTS],
    /// rad/s.
    pub speeds: [f32; JOINTS],
}

/// Robots that are stepped together. A robot's numbers never depend on its neighbours, on the
/// machine's vectors, or on its place.
#[derive(Clone)]
pub struct Robots {
    solver: Solver,
    tree: Tree<f32>,
    arch: Arch,
    blocks: Vec<Block<f32>>,
    targets: Vec<[Row<f32>; JOINTS]>,
    /// Targets of the steps after the first, where any robot has others then.
    later: Vec<Vec<[Row<f32>; JOINTS]>>,
    /// What robots have of their own, block by block; nothing while none ever had.
    own: Vec<Own<Row<f32>>>,
    tallies: Vec<Tally<f32>>,
    count: usize,
}

/// All that the future of [`Robots`] depends on, the solver's settings aside.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Saved {
    count: usize,
    blocks: Vec<Block<f32>>,
}

impl Robots {
    /// Nominal robots, standing at rest.
    pub fn new(solver: Solver, count: usize) -> Self {
        Self::with_arch(solver, count, Arch::new())
    }

    /// With vectors of another width than the machine's best; the numbers are the same.
    pub fn with_arch(solver: Solver, count: usize, arch: Arch) -> Self {
        let blocks = count.div_ceil(LANES);
        Self {
            tree: contact::tree(solver.self_collision),
            solver,
            arch,
            blocks: vec![Block::new(); blocks],
            targets: vec![[Row::default(); JOINTS]; blocks],
            later: Vec::new(),
            own: Vec::new(),
            tallies: vec![Tally::default(); blocks],
            count,
        }
    }

    /// How many.
    pub fn len(&self) -> usize {
        self.count
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.count == 0
    }

    /// How steps are taken.
    pub fn solver(&self) -> &Solver {
        &self.solver
    }

    /// Puts a robot into a state; its contacts begin anew, and nothing else is left of its past.
    pub fn set_state(&mut self, robot: usize, state: &RobotState) {
        let (block, lane) = self.place(robot);
        self.blocks[block].set_state(lane, state);
    }

    /// Makes a robot of something else.
    pub fn set_build(&mut self, robot: usize, build: &Build) {
        let (block, lane) = self.place(robot);
        self.blocks[block].set_build(lane, build);
    }

    /// A robot's state.
    #[inline]
    pub fn state(&self, robot: usize) -> RobotState {
        let (block, lane) = self.place(robot);
        self.blocks[block].state(lane)
    }

    /// Adds to the velocity of a whole robot, world frame, m/s.
    pub fn push(&mut self, robot: usize, change: Vector3<f32>) {
        let (block, lane) = self.place(robot);
        for axis in 0..3 {
            self.blocks[block].state[row::LINEAR + axis].0[lane] += change[axis];
        }
    }

    /// Target positions of a robot's joints, rad, until others are given.
    #[inline]
    pub fn set_targets(&mut self, robot: usize, targets: &[f32; JOINTS]) {
        let (block, lane) = self.place(robot);
        aim(&mut self.targets[block], lane, targets);
        for later in &mut self.later {
            aim(&mut later[block], lane, targets);
        }
    }

    /// Target positions of a robot's joints, rad, in each of the coming steps; those of the last hold from then on.
    ///
    /// # Panics
    /// If there are none.
    pub fn set_targets_by_step(&mut self, robot: usize, steps: &[[f32; JOINTS]]) {
        let (block, lane) = self.place(robot);
        let (first, rest) = steps.split_first().expect("targets for one step at least");
        while self.later.len() < rest.len() {
            // Whoever said nothing of these steps goes on as before.
            let as_before = self.later.last().unwrap_or(&self.targets).clone();
            self.later.push(as_before);
        }
        aim(&mut self.targets[block], lane, first);
        for (step, later) in self.later.iter_mut().enumerate() {
            let targets = rest.get(step).or(rest.last()).unwrap_or(first);
            aim(&mut later[block], lane, targets);
        }
    }

    /// Gives a robot a condition of its own, or takes it away. No force acts on it any more. [`Robots::save`] leaves
    /// conditions out: whoever restores robots gives them again.
    pub fn set_condition(&mut self, robot: usize, condition: Option<&Condition>) {
        let (block, lane) = self.place(robot);
        if condition.is_none() && self.own.is_empty() {
            return;
        }
        let nominal = Condition::nominal(self.solver.motors.clone());
        if self.own.is_empty() {
            self.own = vec![Own::of(&nominal); self.blocks.len()];
        }
        self.own[block].set(lane, condition.unwrap_or(&nominal));
    }

    /// A force on the centre of mass of a robot's torso, world frame, N, until another is given.
    ///
    /// # Panics
    /// If no robot has a condition.
    pub fn set_force(&mut self, robot: usize, force: [f32; 3]) {
        let (block, lane) = self.place(robot);
        for (row, force) in self.own[block].force.iter_mut().zip(force) {
            row.0[lane] = force;
        }
    }

    /// Advances all robots by `steps` physics steps toward their targets. Does not allocate.
    pub fn advance(&mut self, steps: usize) {
        self.arch.dispatch(Advance {
            setting: Setting {
                tree: &self.tree,
                ground: &self.solver.ground,
                motors: &self.solver.motors,
                dt: self.solver.dt,
                sweeps: self.solver.sweeps,
            },
            steps,
            blocks: &mut self.blocks,
            targets: &self.targets,
            later: &self.later,
            own: &self.own,
            tallies: &mut self.tallies,
        });
    }

    /// What the last [`Robots::advance`] took from a robot and felt, over its `steps`.
    #[inline]
    pub fn effort(&self, robot: usize, steps: usize) -> Effort {
        let (block, lane) = self.place(robot);
        let tally = &self.tallies[block];
        let time = self.solver.dt * steps as f32;
        Effort {
            energy: tally.work.0[lane],
            foot_forces: [tally.soles[0].0[lane] / time, tally.soles[1].0[lane] / time],
        }
    }

    /// Greatest torques and speeds of a robot's joints during the last [`Robots::advance`].
    pub fn peaks(&self, robot: usize) -> Peaks {
        let (block, lane) = self.place(robot);
        let tally = &self.tallies[block];
        Peaks {
            torques: tally.torques.map(|row| row.0[lane]),
            speeds: tally.speeds.map(|row| row.0[lane]),
        }
    }

    /// Whether a robot's numbers can be used after the last [`Robots::advance`]: finite, and no faster than anything
    /// real.
    #[inline]
    pub fn is_sound(&self, robot: usize) -> bool {
        let (block, lane) = self.place(robot);
        let tally = &self.tallies[block];
        tally.odd.0[lane] == 0.0 && tally.fastest.0[lane] < SPEED_LIMIT
    }

    /// Everything that the future depends on.
    pub fn save(&self) -> Saved {
        Saved {
            count: self.count,
            blocks: self.blocks.clone(),
        }
    }

    /// Goes on from what was saved; false, and nothing changed, if that is of another number of
    /// robots or not whole.
    pub fn restore(&mut self, saved: Saved) -> bool {
        let whole = saved.count == self.count
            && saved.blocks.len() == self.blocks.len()
            && saved
                .blocks
                .iter()
                .zip(&self.blocks)
                .all(|(a, b)| a.state.len() == b.state.len() && a.torso.len() == b.torso.len());
        if whole {
            self.blocks = saved.blocks;
        }
        whole
    }

    #[inline]
    fn place(&self, robot: usize) -> (usize, usize) {
        assert!(robot < self.count, "robot {robot} of {}", self.count);
        (robot / LANES, robot % LANES)
    }
}

fn aim(rows: &mut [Row<f32>; JOINTS], lane: usize, targets: &[f32; JOINTS]) {
    for (row, target) in rows.iter_mut().zip(targets) {
        row.0[lane] = *target;
    }
}

/// Steps of all blocks in the machine's widest vectors.
struct Advance<'a> {
    setting: Setting<'a, f32>,
    steps: usize,
    blocks: &'a mut [Block<f32>],
    targets: &'a [[Row<f32>; JOINTS]],
    later: &'a [Vec<[Row<f32>; JOINTS]>],
    own: &'a [Own<Row<f32>>],
    tallies: &'a mut [Tally<f32>],
}

impl WithSimd for Advance<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        match S::F32_LANES {
            16 => self.run::<S, boundary::By64>(simd),
            8 => self.run::<S, boundary::By32>(simd),
            4 => self.run::<S, boundary::By16>(simd),
            _ => self.run::<S, boundary::By4>(simd),
        }
    }
}

impl Advance<'_> {
    #[inline(always)]
    fn run<S: Simd, A: Copy>(self, simd: S) {
        let per_block = LANES / S::F32_LANES;
        let count = self.blocks.len() * per_block;
        let place = |group: usize| (group / per_block, group % per_block * S::F32_LANES);
        // By name, for an array made by a function is copied several times on its way here.
        let mut one = Crew::<Packed<S, A>>::new(simd);
        let mut other = Crew::new(simd);
        let mut contacts_of_one = Contacts::none(simd);
        let mut contacts_of_other = Contacts::none(simd);
        let crews = &mut [&mut one, &mut other];
        let contacts = &mut [&mut contacts_of_one, &mut contacts_of_other];
        for first in (0..count).step_by(crews.len()) {
            let some = crews.len().min(count - first);
            let (crews, contacts) = (&mut crews[..some], &mut contacts[..some]);
            for (i, crew) in crews.iter_mut().enumerate() {
                let (block, lane) = place(first + i);
                let (own, targets) = (self.own.get(block), &self.targets[block]);
                crew.group
                    .load(simd, &self.blocks[block], targets, own, lane);
            }
            for at in 0..self.steps {
                if let Some(targets) = at.checked_sub(1).and_then(|later| self.later.get(later)) {
                    for (i, crew) in crews.iter_mut().enumerate() {
                        let (block, lane) = place(first + i);
                        crew.group.aim(simd, &targets[block], lane);
                    }
                }
                step(simd, &self.setting, crews, contacts);
            }
            for (i, crew) in crews.iter().enumerate() {
                let (block, lane) = place(first + i);
                let (block, tally) = (&mut self.blocks[block], &mut self.tallies[block]);
                crew.group.store(block, tally, lane);
            }
        }
    }
}

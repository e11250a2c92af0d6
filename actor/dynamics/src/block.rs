//! Where the robots' numbers live: rows of sixteen, one number of sixteen robots each.
//!
//! Separate because the layout is the same on every machine: vectors of sixteen take a row at once,
//! vectors of eight take halves. So a fleet saved on one machine continues on another.

use crate::lane::{Lane, Real};
use crate::tree::{POINTS, inertial};
use g1::{JOINTS, RobotState, links::TORSO};
use nalgebra::{Quaternion, UnitQuaternion, Vector3};
use serde::{Deserialize, Serialize};

/// Robots in a block.
pub const LANES: usize = 16;

/// One number of sixteen robots.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[repr(C, align(64))]
pub struct Row<T>(pub(crate) [T; LANES]);

impl<T: Real> Row<T> {
    #[inline(always)]
    pub(crate) fn get<L: Lane<Scalar = T>>(&self, token: L::Token, lane: usize) -> L {
        L::load(token, &self.0[lane..lane + L::WIDTH])
    }
    #[inline(always)]
    pub(crate) fn set<L: Lane<Scalar = T>>(&mut self, lane: usize, value: L) {
        value.store(&mut self.0[lane..lane + L::WIDTH]);
    }
}

/// First rows of the parts of a block's state.
pub(crate) mod row {
    use super::{JOINTS, POINTS};
    /// Pelvis origin, world, m.
    pub(crate) const POSITION: usize = 0;
    /// w, i, j, k.
    pub(crate) const QUATERNION: usize = 3;
    /// Of the pelvis origin, world, m/s.
    pub(crate) const LINEAR: usize = 7;
    /// World, rad/s.
    pub(crate) const ANGULAR: usize = 10;
    /// rad.
    pub(crate) const JOINT: usize = 13;
    /// rad/s.
    pub(crate) const SPEED: usize = JOINT + JOINTS;
    /// Impulses of the last step: normal and two tangential of each point, N·s.
    pub(crate) const IMPULSE: usize = SPEED + JOINTS;
    /// Rows of a state.
    pub(crate) const STATE: usize = IMPULSE + 3 * POINTS;
    /// Numbers of a body in the model: mass, centre of mass, inertia.
    pub(crate) const PER_BODY: usize = 10;
}

/// What is different about one robot and its floor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Build {
    /// Added to the torso's mass, kg; its inertia grows in proportion.
    pub torso_mass: f32,
    /// Added to the torso's centre of mass, torso frame, m.
    pub torso_com: [f32; 3],
    /// Friction coefficient of all points.
    pub friction: f32,
}

impl Build {
    /// The robot of the tables on a floor of friction 1.
    pub const NOMINAL: Self = Self {
        torso_mass: 0.0,
        torso_com: [0.0; 3],
        friction: 1.0,
    };
}

/// Sixteen robots: their states and what each is made of.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Block<T> {
    /// [`row::STATE`] rows.
    pub(crate) state: Vec<Row<T>>,
    /// Mass, centre of mass and inertia of the torso.
    pub(crate) torso: Vec<Row<T>>,
    pub(crate) friction: Row<T>,
}

impl<T: Real> Block<T> {
    /// Sixteen nominal robots standing at rest.
    pub(crate) fn new() -> Self {
        let mut block = Self {
            state: vec![Row::default(); row::STATE],
            torso: vec![Row::default(); row::PER_BODY],
            friction: Row::default(),
        };
        for lane in 0..LANES {
            block.set_build(lane, &Build::NOMINAL);
            block.set_state(lane, &RobotState::standing());
        }
        block
    }

    /// The state as rows of known number, so that none of them has to be looked for.
    #[inline(always)]
    pub(crate) fn rows(&self) -> &[Row<T>; row::STATE] {
        self.state.as_slice().try_into().expect("a whole state")
    }

    /// Likewise, to be written.
    #[inline(always)]
    pub(crate) fn rows_mut(&mut self) -> &mut [Row<T>; row::STATE] {
        self.state.as_mut_slice().try_into().expect("a whole state")
    }

    /// The rows of the torso, likewise.
    #[inline(always)]
    pub(crate) fn torso(&self) -> &[Row<T>; row::PER_BODY] {
        self.torso.as_slice().try_into().expect("a whole torso")
    }

    /// Makes one robot of something else. Only the torso varies.
    pub(crate) fn set_build(&mut self, lane: usize, build: &Build) {
        let numbers = inertial(
            TORSO,
            f64::from(build.torso_mass),
            build.torso_com.map(f64::from),
        );
        for (row, number) in self.torso.iter_mut().zip(numbers) {
            row.0[lane] = T::of(number);
        }
        self.friction.0[lane] = T::of(f64::from(build.friction));
    }

    /// Puts one robot into a state; its contacts begin anew.
    pub(crate) fn set_state(&mut self, lane: usize, state: &RobotState) {
        let q = state.orientation;
        let base = [
            state.position.x,
            state.position.y,
            state.position.z,
            q.w,
            q.i,
            q.j,
            q.k,
            state.linear_velocity.x,
            state.linear_velocity.y,
            state.linear_velocity.z,
            state.angular_velocity.x,
            state.angular_velocity.y,
            state.angular_velocity.z,
        ];
        let numbers = base
            .into_iter()
            .chain(state.joint_positions)
            .chain(state.joint_velocities)
            .chain(std::iter::repeat_n(0.0, 3 * POINTS));
        for (row, number) in self.state.iter_mut().zip(numbers) {
            row.0[lane] = T::of(f64::from(number));
        }
    }

    /// The state of one robot.
    pub(crate) fn state(&self, lane: usize) -> RobotState {
        let rows = self.rows();
        let number = |row: usize| rows[row].0[lane].to_f64() as f32;
        let vector = |row: usize| Vector3::new(number(row), number(row + 1), number(row + 2));
        let q = row::QUATERNION;
        // Not by a function of the index, which becomes a call for each joint of every robot and step.
        let (mut positions, mut velocities) = ([0.0; JOINTS], [0.0; JOINTS]);
        for i in 0..JOINTS {
            positions[i] = number(row::JOINT + i);
            velocities[i] = number(row::SPEED + i);
        }
        RobotState {
            position: vector(row::POSITION),
            orientation: UnitQuaternion::new_unchecked(Quaternion::new(
                number(q),
                number(q + 1),
                number(q + 2),
                number(q + 3),
            )),
            linear_velocity: vector(row::LINEAR),
            angular_velocity: vector(row::ANGULAR),
            joint_positions: positions,
            joint_velocities: velocities,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_state_comes_back_and_leaves_the_others_alone() {
        let mut block = Block::<f32>::new();
        let mut state = RobotState::standing();
        state.position.x = 2.0;
        state.orientation = UnitQuaternion::from_euler_angles(0.1, 0.2, 0.3);
        state.angular_velocity.z = -1.0;
        state.joint_positions[22] = 0.5;
        state.joint_velocities[0] = 7.0;
        block.set_state(5, &state);
        assert_eq!(block.state(5), state);
        assert_eq!(block.state(4), RobotState::standing());
        assert_eq!(block.state(6), RobotState::standing());
    }
}

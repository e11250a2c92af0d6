//! How fast robots go and turn, beside how fast they are asked to, and what they do that nobody asked for.
//!
//! Separate because a mean velocity over mixed commands says nothing, and a velocity error does not
//! say whether a robot goes too slowly or merely sways.

/// From this commanded planar speed on (m/s) a robot is asked to go somewhere.
const GOING: f64 = 0.1;
/// From this commanded yaw rate on (rad/s) a robot is asked to turn.
const TURNING: f64 = 0.1;

/// What a command asks for in the first place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Aim {
    /// To go somewhere, turning or not.
    Go,
    /// To turn on the spot.
    Turn,
    /// To stay.
    Stay,
}

impl Aim {
    /// Of a command: forward, leftward velocity (m/s), yaw rate (rad/s).
    pub fn of(command: [f32; 3]) -> Self {
        let [forward, left, yaw_rate] = command.map(f64::from);
        if forward.hypot(left) >= GOING {
            Self::Go
        } else if yaw_rate.abs() >= TURNING {
            Self::Turn
        } else {
            Self::Stay
        }
    }
}

/// Sums from which the measures follow.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Pace {
    steps: f64,
    velocity: [f64; 3],
    going_steps: f64,
    commanded: f64,
    along: f64,
    forward: f64,
    sideways: f64,
    turning_steps: f64,
    commanded_turn: f64,
    turned: f64,
    /// Velocity that was not asked for, of the stretch that goes on: across the way (the second number is then 0) or, where
    /// no way is asked for, in the plane; and the yaw rate where none is asked for.
    astray: [f64; 2],
    swerve: f64,
    /// The size of either, of stretches that are closed.
    closed: [f64; 2],
}

impl Pace {
    /// Adds one robot's control step: its command and its velocity, both forward and leftward in the heading frame (m/s)
    /// and about the vertical (rad/s).
    pub fn add(&mut self, command: [f32; 3], velocity: [f32; 3]) {
        let [ahead, left, turn] = command.map(f64::from);
        let [vx, vy, yaw_rate] = velocity.map(f64::from);
        self.steps += 1.0;
        for (sum, part) in self.velocity.iter_mut().zip([vx, vy, yaw_rate]) {
            *sum += part;
        }
        let asked = ahead.hypot(left);
        if asked >= GOING {
            self.going_steps += 1.0;
            self.commanded += asked;
            self.along += (ahead * vx + left * vy) / asked;
            self.forward += ahead.abs();
            self.sideways += left.abs();
            self.astray[0] += (ahead * vy - left * vx) / asked;
        } else {
            self.astray[0] += vx - ahead;
            self.astray[1] += vy - left;
        }
        if turn.abs() >= TURNING {
            self.turning_steps += 1.0;
            self.commanded_turn += turn.abs();
            self.turned += yaw_rate * turn.signum();
        } else {
            self.swerve += yaw_rate - turn;
        }
    }

    /// Ends a stretch of one robot under one command: what went astray in it no longer cancels what goes astray
    /// elsewhere. Robots that drift apart do not stay where they are on average.
    pub fn close(&mut self) {
        self.closed[0] += self.astray[0].hypot(self.astray[1]);
        self.closed[1] += self.swerve.abs();
        self.astray = [0.0; 2];
        self.swerve = 0.0;
    }

    /// Adds the steps of another sum.
    pub fn merge(&mut self, other: &Self) {
        self.steps += other.steps;
        self.going_steps += other.going_steps;
        self.commanded += other.commanded;
        self.along += other.along;
        self.forward += other.forward;
        self.sideways += other.sideways;
        self.turning_steps += other.turning_steps;
        self.commanded_turn += other.commanded_turn;
        self.turned += other.turned;
        self.swerve += other.swerve;
        for axis in 0..3 {
            self.velocity[axis] += other.velocity[axis];
        }
        for i in 0..2 {
            self.astray[i] += other.astray[i];
            self.closed[i] += other.closed[i];
        }
    }

    /// Steps that were added.
    pub fn steps(&self) -> f64 {
        self.steps
    }

    /// Mean velocity over all steps: forward, leftward (m/s), yaw rate (rad/s).
    pub fn velocity(&self) -> Option<[f64; 3]> {
        (self.steps > 0.0).then(|| self.velocity.map(|sum| sum / self.steps))
    }

    /// Whether the velocity asked for is more lateral than forward.
    pub fn is_sideways(&self) -> bool {
        self.sideways > self.forward
    }

    /// Mean speed asked for where one is asked for, and mean speed along that direction, m/s.
    pub fn speeds(&self) -> Option<(f64, f64)> {
        let going = self.going_steps;
        (going > 0.0).then(|| (self.commanded / going, self.along / going))
    }

    /// Mean yaw rate asked for where one is asked for, and mean yaw rate that way round, rad/s.
    pub fn turns(&self) -> Option<(f64, f64)> {
        let turning = self.turning_steps;
        (turning > 0.0).then(|| (self.commanded_turn / turning, self.turned / turning))
    }

    /// Mean speed that is not asked for, m/s: across the way that is asked for, or in any direction where none is.
    pub fn astray(&self) -> f64 {
        let open = self.astray[0].hypot(self.astray[1]);
        (self.closed[0] + open) / self.steps.max(1.0)
    }

    /// Mean yaw rate where none is asked for, rad/s.
    pub fn swerve(&self) -> f64 {
        let straight = self.steps - self.turning_steps;
        (self.closed[1] + self.swerve.abs()) / straight.max(1.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn close(got: f64, expected: f64) -> bool {
        (got - expected).abs() < 1e-6
    }

    fn pace(steps: &[([f32; 3], [f32; 3])]) -> Pace {
        let mut pace = Pace::default();
        for (command, velocity) in steps {
            pace.add(*command, *velocity);
        }
        pace
    }

    #[test]
    fn the_aim_is_that_of_the_whole_command() {
        assert_eq!(Aim::of([0.0, -0.3, 0.0]), Aim::Go);
        assert_eq!(Aim::of([0.08, 0.07, 1.0]), Aim::Go); // 0.11 m/s
        assert_eq!(Aim::of([0.05, 0.0, -0.1]), Aim::Turn);
        assert_eq!(Aim::of([0.05, 0.05, 0.09]), Aim::Stay); // 0.07 m/s
    }

    #[test]
    fn speed_counts_along_the_direction_asked_for() {
        assert_eq!(Pace::default().speeds(), None);
        let going = pace(&[
            ([-0.5, 0.0, 0.0], [-0.4, 0.3, 0.0]), // 0.4 the right way
            ([0.0, 0.25, 0.0], [0.7, -0.1, 0.0]), // 0.1 the wrong way
            ([0.0, 0.0, 1.0], [0.0, 0.1, 0.0]),   // nothing planar asked
        ]);
        assert!(!going.is_sideways());
        let (commanded, along) = going.speeds().unwrap();
        assert!(close(commanded, 0.375)); // (0.5 + 0.25) / 2
        assert!(close(along, 0.15)); // (0.4 − 0.1) / 2
        let velocity = going.velocity().unwrap();
        assert!(close(velocity[0], 0.1) && close(velocity[1], 0.1));
    }

    #[test]
    fn turns_count_the_way_round_that_is_asked_for() {
        let turning = pace(&[
            ([0.0, 0.0, 1.0], [0.0, 0.0, 0.8]),
            ([0.5, 0.0, -0.5], [0.5, 0.0, -0.4]), // 0.4 the right way
            ([0.5, 0.0, -0.6], [0.5, 0.0, 0.3]),  // 0.3 the wrong way
            ([0.5, 0.0, 0.0], [0.5, 0.0, 9.0]),   // none asked
        ]);
        let (commanded, turned) = turning.turns().unwrap();
        assert!(close(commanded, 0.7)); // (1 + 0.5 + 0.6) / 3
        assert!(close(turned, 0.3)); // (0.8 + 0.4 − 0.3) / 3
        assert!(close(turning.swerve(), 9.0)); // of the one step that asks for none
        assert!(close(turning.velocity().unwrap()[2], 2.425)); // (0.8 − 0.4 + 0.3 + 9) / 4
    }

    #[test]
    fn what_goes_astray_is_across_the_way_and_all_of_it_where_there_is_none() {
        // To the left at 0.3 while 0.2 forward is not asked for, half of it swaying back.
        let aside = pace(&[
            ([0.0, 0.3, 0.0], [0.3, 0.3, 0.0]),
            ([0.0, 0.3, 0.0], [0.1, 0.3, 0.0]),
        ]);
        assert!(close(aside.astray(), 0.2));
        // (0.3, −0.4) m/s where nothing is asked for, and 0.2 rad/s.
        let stay = pace(&[([0.0; 3], [0.3, -0.4, 0.2]), ([0.0; 3], [0.3, -0.4, -0.6])]);
        assert!(close(stay.astray(), 0.5) && close(stay.swerve(), 0.2));
        // A command that is too small to count is still no drift.
        let slow = pace(&[([0.05, 0.0, 0.05], [0.05, 0.0, 0.05])]);
        assert!(close(slow.astray(), 0.0) && close(slow.swerve(), 0.0));
    }

    #[test]
    fn robots_that_drift_apart_do_not_stay() {
        let drifting = |speed: f32| pace(&[([0.0; 3], [speed, 0.0, speed])]);
        let (mut one, mut other) = (drifting(0.3), drifting(-0.3));
        let mut open = one;
        open.merge(&other);
        assert!(close(open.astray(), 0.0) && close(open.swerve(), 0.0));
        one.close();
        other.close();
        one.merge(&other);
        assert!(close(one.astray(), 0.3) && close(one.swerve(), 0.3));
    }
}

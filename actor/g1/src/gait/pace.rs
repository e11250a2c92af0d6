//! How fast robots go, beside how fast they are asked to go.
//!
//! Separate because a mean velocity over mixed commands says nothing, and a velocity error does not
//! say whether a robot goes too slowly or merely sways.

/// From this commanded planar speed on (m/s) a robot is asked to go somewhere.
const GOING: f64 = 0.1;

/// Sums from which the measures follow.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Pace {
    steps: f64,
    going_steps: f64,
    commanded: f64,
    along: f64,
    forward: f64,
    sideways: f64,
    velocity: [f64; 2],
}

impl Pace {
    /// Adds one robot's control step: its command (m/s, m/s, rad/s) and its planar velocity, heading
    /// frame, m/s.
    pub fn add(&mut self, command: [f32; 3], velocity: [f32; 2]) {
        let (command, velocity) = (command.map(f64::from), velocity.map(f64::from));
        self.steps += 1.0;
        self.velocity[0] += velocity[0];
        self.velocity[1] += velocity[1];
        let asked = command[0].hypot(command[1]);
        if asked >= GOING {
            self.going_steps += 1.0;
            self.commanded += asked;
            self.along += (command[0] * velocity[0] + command[1] * velocity[1]) / asked;
            self.forward += command[0].abs();
            self.sideways += command[1].abs();
        }
    }

    /// Adds the steps of another sum.
    pub fn merge(&mut self, other: &Self) {
        self.steps += other.steps;
        self.going_steps += other.going_steps;
        self.commanded += other.commanded;
        self.along += other.along;
        self.forward += other.forward;
        self.sideways += other.sideways;
        for axis in 0..2 {
            self.velocity[axis] += other.velocity[axis];
        }
    }

    /// Mean planar velocity over all steps, m/s.
    pub fn velocity(&self) -> Option<[f64; 2]> {
        (self.steps > 0.0).then(|| self.velocity.map(|sum| sum / self.steps))
    }

    /// Whether most steps ask for a planar velocity.
    pub fn is_going(&self) -> bool {
        2.0 * self.going_steps > self.steps
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
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn speed_counts_along_the_direction_asked_for() {
        let mut pace = Pace::default();
        assert_eq!(pace.speeds(), None);
        pace.add([-0.5, 0.0, 0.0], [-0.4, 0.3]); // 0.4 the right way
        pace.add([0.0, 0.25, 0.0], [0.7, -0.1]); // 0.1 the wrong way
        pace.add([0.0, 0.0, 1.0], [0.0, 0.1]); // nothing planar asked
        assert!(pace.is_going() && !pace.is_sideways());
        let (commanded, along) = pace.speeds().unwrap();
        assert!((commanded - 0.375).abs() < 1e-7); // (0.5 + 0.25) / 2
        assert!((along - 0.15).abs() < 1e-7); // (0.4 − 0.1) / 2
        let velocity = pace.velocity().unwrap();
        assert!((velocity[0] - 0.1).abs() < 1e-7 && (velocity[1] - 0.1).abs() < 1e-7);
        let mut standing = Pace::default();
        standing.add([0.0; 3], [0.0; 2]);
        standing.add([0.0; 3], [0.0; 2]);
        pace.merge(&standing);
        assert!(!pace.is_going()); // 2 of 5
    }
}

//! How far a robot's mean velocity is off its command, over whole strides.
//!
//! Separate because it remembers where a stride began. A pelvis sways and surges within a stride, a person's too, and so
//! does every velocity error measured step by step; what a whole stride comes to is where the robot goes.

use super::{in_contact, landings};

/// One robot under one command: sums over the whole strides so far, and since.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Strides {
    whole: Sum,
    since: Sum,
    begun: bool,
}

/// Velocities added up: forward and leftward (m/s, heading frame), yaw rate (rad/s).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Sum {
    steps: f64,
    velocity: [f64; 3],
}

impl Sum {
    fn add(&mut self, other: &Self) {
        self.steps += other.steps;
        for (sum, part) in self.velocity.iter_mut().zip(other.velocity) {
            *sum += part;
        }
    }
}

impl Strides {
    /// Adds a control step: velocity forward, leftward (m/s) and yaw rate (rad/s) at its end, foot forces (N; left, right)
    /// at its end and one step before. A stride goes from one landing of the left foot to the next.
    pub fn add(&mut self, velocity: [f32; 3], forces: [f32; 2], before: Option<[f32; 2]>) {
        self.since.add(&Sum {
            steps: 1.0,
            velocity: velocity.map(f64::from),
        });
        if landings(forces, before)[0] && in_contact(forces)[0] {
            if self.begun {
                self.whole.add(&self.since);
            }
            self.begun = true;
            self.since = Sum::default();
        }
    }

    /// What it comes to, and the steps behind it; none of no step. Of a robot that made no whole stride, as one that stands,
    /// all steps count.
    pub fn off(&self, command: [f32; 3]) -> Option<Off> {
        let mut sum = self.whole;
        if sum.steps == 0.0 {
            sum = self.since;
        }
        let away: [f64; 3] =
            std::array::from_fn(|i| sum.velocity[i] / sum.steps - f64::from(command[i]));
        (sum.steps > 0.0).then(|| Off {
            steps: sum.steps,
            planar: sum.steps * away[0].hypot(away[1]),
            turning: sum.steps * away[2].abs(),
        })
    }
}

/// Distances of mean velocities from commands, weighted by steps: adds up over robots and commands.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Off {
    steps: f64,
    planar: f64,
    turning: f64,
}

impl Off {
    /// Adds another robot's, or another command's.
    pub fn merge(&mut self, other: &Self) {
        self.steps += other.steps;
        self.planar += other.planar;
        self.turning += other.turning;
    }

    /// Mean distance of a robot's mean planar velocity from its command, m/s.
    pub fn planar(&self) -> Option<f64> {
        (self.steps > 0.0).then(|| self.planar / self.steps)
    }

    /// The same of the yaw rate, rad/s.
    pub fn turning(&self) -> Option<f64> {
        (self.steps > 0.0).then(|| self.turning / self.steps)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const DOWN: [f32; 2] = [300.0, 0.0];
    const UP: [f32; 2] = [0.0, 300.0];

    /// Steps of a robot whose left foot is down where the flag says so.
    fn walked(steps: &[(bool, [f32; 3])]) -> Strides {
        let (mut strides, mut before) = (Strides::default(), None);
        for (down, velocity) in steps {
            let forces = if *down { DOWN } else { UP };
            strides.add(*velocity, forces, before);
            before = Some(forces);
        }
        strides
    }

    #[test]
    fn what_sways_within_a_stride_is_no_error() {
        let (fast, slow) = ([1.5, 0.25, 0.5], [0.5, -0.25, -0.5]);
        // Landings after the second, the fourth and the sixth step; the last step is of no whole stride.
        let strides = walked(&[
            (false, [9.0, 9.0, 9.0]),
            (true, fast),
            (false, slow),
            (true, fast),
            (false, slow),
            (true, fast),
            (false, slow),
        ]);
        let off = strides.off([1.0, 0.0, 0.0]).unwrap();
        assert_eq!((off.planar(), off.turning()), (Some(0.0), Some(0.0)));
        let other = strides.off([0.7, 0.4, 0.1]).unwrap();
        // (0.3, −0.4): 0.5; 0.1
        assert!((other.planar().unwrap() - 0.5).abs() < 1e-7);
        assert!((other.turning().unwrap() - 0.1).abs() < 1e-7);
    }

    #[test]
    fn a_robot_that_stands_is_measured_all_the_same() {
        let strides = walked(&[(true, [0.25, 0.0, 0.0]); 4]);
        let off = strides.off([0.0; 3]).unwrap();
        assert_eq!(off.planar(), Some(0.25));
        assert_eq!(Strides::default().off([0.0; 3]), None);
    }

    #[test]
    fn errors_of_two_robots_do_not_cancel() {
        let mut both = walked(&[(true, [1.25, 0.0, 0.0]); 3])
            .off([1.0, 0.0, 0.0])
            .unwrap();
        both.merge(
            &walked(&[(true, [0.75, 0.0, 0.0]); 1])
                .off([1.0, 0.0, 0.0])
                .unwrap(),
        );
        assert_eq!(both.planar(), Some(0.25));
        assert_eq!(Off::default().planar(), None);
    }
}

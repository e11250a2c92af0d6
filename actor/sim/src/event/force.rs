//! Pushes that last: a force on the torso for a while, now and then.
//!
//! Separate because it acts on the body, for a time that need not be whole steps.

use super::spell::Spell;
use crate::command;
use crate::randomization::uniform;
use crate::time::CONTROL_STEP;
use rand::Rng;
use serde::{Deserialize, Serialize};
use std::f32::consts::TAU;

/// A robot that is pushed now and then.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub(crate) struct Pressed {
    /// Control steps until the next push; none while it is pushed, or where nobody pushes.
    wait: Option<u32>,
    /// How long the push still lasts, s.
    left: f32,
    /// World frame, N.
    force: [f32; 3],
}

impl Pressed {
    /// At the start of an episode.
    pub(crate) fn new(row: Option<&Spell>, rng: &mut impl Rng) -> Self {
        Self {
            wait: row.map(|row| command::steps(row.seconds, rng)),
            ..Self::default()
        }
    }

    /// The force of the coming control step, and whether a push begins with it. A push that ends within a step is as much
    /// weaker in it as it is shorter: its momentum F·t is exact.
    pub(crate) fn step(&mut self, row: Option<&Spell>, rng: &mut impl Rng) -> ([f32; 3], bool) {
        let Some(row) = row else {
            *self = Self::default();
            return ([0.0; 3], false);
        };
        let mut begins = false;
        if self.left <= 0.0 {
            let wait = self
                .wait
                .get_or_insert_with(|| command::steps(row.seconds, rng));
            *wait = wait.saturating_sub(1);
            if *wait > 0 {
                return ([0.0; 3], false);
            }
            self.wait = None;
            self.left = uniform(row.duration, rng);
            let (size, way) = (uniform(row.range, rng), uniform([0.0, TAU], rng));
            self.force = [size * way.cos(), size * way.sin(), 0.0];
            begins = true;
        }
        let share = (self.left / CONTROL_STEP).min(1.0);
        self.left -= CONTROL_STEP;
        // What rounding leaves of a whole number of steps is no push.
        if self.left < 1e-6 {
            self.left = 0.0;
        }
        (self.force.map(|part| part * share), begins)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng;
    use rand_pcg::Pcg64Mcg;

    #[test]
    fn a_push_has_its_momentum_and_the_next_comes_in_time() {
        let row = Spell {
            range: [100.0, 100.0],
            duration: [0.05, 0.05],
            seconds: [1.0, 1.0],
        };
        let mut rng = Pcg64Mcg::seed_from_u64(1);
        let mut pressed = Pressed::new(Some(&row), &mut rng);
        let mut steps = Vec::new();
        for step in 1..=160 {
            let ([x, y, z], begins) = pressed.step(Some(&row), &mut rng);
            assert_eq!(z, 0.0);
            if x != 0.0 || y != 0.0 {
                steps.push((step, x.hypot(y)));
            }
            assert_eq!(begins, [50, 102, 154].contains(&step), "{step}");
        }
        // 1 s are 50 steps; 50 ms are two steps and a half: 100 N·(20 + 20 + 10) ms = 5 N·s.
        let momentum: f32 = steps[..3]
            .iter()
            .map(|(_, force)| force * CONTROL_STEP)
            .sum();
        assert!((momentum - 5.0).abs() < 1e-3, "{momentum}");
        assert_eq!(
            steps[..3].iter().map(|s| s.0).collect::<Vec<_>>(),
            [50, 51, 52]
        );
        assert_eq!(steps[3].0, 102);
        // Without its row nothing is left of it.
        assert_eq!(pressed.step(None, &mut rng), ([0.0; 3], false));
    }
}

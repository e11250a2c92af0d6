//! `ampco bench sim`: control steps per second of one core, with and without the policy.
//!
//! Separate because samples are the project's scarcest good: this says how fast they can come at
//! all, by the code that an actor runs (`sim::Fleet`, `policy::Policy`) with nothing around it.

mod measured;

use std::time::Instant;

use amp::PolicyConfig;
use anyhow::{Context, Result, ensure};
use observation::Tables;
use policy::{Policy, Shape};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;
use serde_json::{Value, json};
use sim::{Fleet, Physics, RandomizationConfig, Starts, StepRows, TaskConfig};
use terminal::{Engine, SelfCollision};

use measured::{Measured, cpu_seconds, resident_bytes};

/// Standard deviation of the benchmark's actions; 0.25 rad per unit, as a policy in training moves.
const EXPLORATION: f32 = 0.5;
/// Steps until a robot's random actions come again.
const DRAWN: usize = 1_000;

/// Control steps per second of one core: physics and task alone, then with the policy.
#[derive(Debug, clap::Args)]
pub(crate) struct SimBench {
    /// Seconds to measure each of the two for
    #[arg(long, default_value_t = 5.0)]
    seconds: f64,
    /// Robots in the fleet
    #[arg(long, default_value_t = 64)]
    environments: usize,
    /// Fleets at once, each on a thread of its own, as actors are processes of their own
    #[arg(long, default_value_t = 1)]
    fleets: usize,
    /// Widths of the policy's hidden layers
    #[arg(long, value_delimiter = ',', default_values_t = [256, 128, 64])]
    hidden: Vec<usize>,
    /// What moves the robots: rapier, or the batched solver
    #[arg(long, value_enum, default_value_t = Engine::Rapier)]
    physics: Engine,
    /// Whether legs, arms and trunk meet each other
    #[arg(long, value_enum, default_value_t = SelfCollision::On)]
    self_collision: SelfCollision,
    /// Simulate without the domain randomisation of Table I
    #[arg(long)]
    plain: bool,
    /// Seed of the fleet and of the actions
    #[arg(long, default_value_t = 1)]
    seed: u64,
}

impl SimBench {
    pub(crate) fn run(&self) -> Result<Value> {
        ensure!(
            self.seconds > 0.0 && self.environments > 0 && self.fleets > 0,
            "give --seconds, --environments and --fleets above 0"
        );
        ensure!(
            self.hidden.iter().all(|&width| width > 0),
            "give --hidden widths above 0, for example 256,128,64"
        );
        let physics = self.together(None)?;
        let policy = self.policy()?;
        let acting = self.together(Some(&policy))?;
        Ok(json!({
            "control_steps_per_second": physics.per_second(physics.wall) * self.fleets as f64,
            "control_steps_per_second_per_core": physics.per_second(physics.wall),
            "with_inference_per_second_per_core": acting.per_second(acting.wall),
            // On a machine that others use, the time on the core says more than the clock.
            "control_steps_per_cpu_second": physics.cpu.map(|cpu| physics.per_second(cpu)),
            "with_inference_per_cpu_second": acting.cpu.map(|cpu| acting.per_second(cpu)),
            "microseconds_per_physics_step":
                1e6 * physics.wall / (physics.steps * sim::world::SUBSTEPS) as f64,
            "inference_share": acting.inference / acting.wall,
            "control_steps_measured": physics.steps,
            "wall_seconds": physics.wall,
            "cpu_seconds": physics.cpu,
            "resets": physics.resets,
            "faults": physics.faults,
            "physics": Physics::from(self.physics),
            "self_collision": self.self_collision == SelfCollision::On,
            "environments": self.environments,
            "fleets": self.fleets,
            // What the process grew by, the fleet's rows of a step included.
            "bytes_per_robot": physics.bytes.map(|bytes| bytes / self.environments),
            "hidden": self.hidden,
            "randomization": !self.plain,
            "physics_hz": 1.0 / sim::world::PHYSICS_STEP,
            "policy_hz": 1.0 / sim::world::CONTROL_STEP,
        }))
    }

    /// Random small weights: a standing robot's actions stay near zero, as an untrained policy's.
    fn policy(&self) -> Result<Policy> {
        let shape = Shape::new(Tables::default().actor.width(), &self.hidden);
        let mut flat = vec![0.0; shape.len()];
        let mut random = Pcg64Mcg::seed_from_u64(self.seed);
        flat[shape.inverse_deviation()].fill(1.0);
        flat[shape.sigma()].fill(EXPLORATION);
        for weight in &mut flat[shape.sigma().end..] {
            *weight = 0.05 * (2.0 * random.random::<f32>() - 1.0);
        }
        let mut policy = Policy::new(shape, PolicyConfig::default().observation_clip);
        policy.load(&flat).context("loading random weights")?;
        Ok(policy)
    }

    /// Every fleet on a thread of its own; the mean of them all.
    fn together(&self, policy: Option<&Policy>) -> Result<Measured> {
        let measured: Vec<Result<Measured>> = std::thread::scope(|scope| {
            let threads: Vec<_> = (0..self.fleets)
                .map(|_| scope.spawn(|| self.measure(policy.cloned().as_mut())))
                .collect();
            threads
                .into_iter()
                .map(|thread| thread.join().expect("a measurement does not panic"))
                .collect()
        });
        let mut mean = Measured::default();
        for one in measured {
            mean.add(one?);
        }
        Ok(mean.over(self.fleets))
    }

    /// Steps a new fleet for the time asked, with a policy or with random actions drawn beforehand.
    fn measure(&self, mut policy: Option<&mut Policy>) -> Result<Measured> {
        let randomization = if self.plain {
            RandomizationConfig::default()
        } else {
            RandomizationConfig::table_one()
        };
        let n = self.environments;
        let before = resident_bytes();
        let mut fleet = Fleet::new(
            self.self_collision.within(self.physics),
            &TaskConfig::default(),
            &randomization,
            Starts::default(),
            n,
            self.seed,
        )
        .context("building the fleet")?;
        let mut random = Pcg64Mcg::seed_from_u64(self.seed);
        let mut rows = Rows::new(&fleet, &mut random);
        let mut measured = Measured::default();
        // Fresh robots stand; after half a second they do what random actions make them do.
        for warm in [true, false] {
            let (begun, account) = (Instant::now(), cpu_seconds());
            loop {
                let elapsed = begun.elapsed().as_secs_f64();
                if warm && measured.steps >= 25 * n {
                    measured = Measured::default();
                    break;
                }
                if !warm && elapsed >= self.seconds {
                    measured.wall = elapsed;
                    measured.cpu = cpu_seconds().zip(account).map(|(now, then)| now - then);
                    break;
                }
                let thinking = Instant::now();
                match &mut policy {
                    Some(policy) => policy.sample(
                        fleet.observations(),
                        0,
                        &mut random,
                        &mut rows.actions,
                        &mut rows.means,
                        &mut rows.log_probs,
                    ),
                    None => rows.shake(),
                }
                measured.inference += thinking.elapsed().as_secs_f64();
                rows.step(&mut fleet);
                measured.steps += n;
                measured.resets += rows.outcome.ends.iter().filter(|end| **end != 0.0).count();
            }
        }
        measured.faults = fleet.faults();
        measured.bytes = resident_bytes()
            .zip(before)
            .map(|(now, before)| now.saturating_sub(before));
        Ok(measured)
    }
}

/// Room for one step of the fleet.
struct Rows {
    actions: Vec<f32>,
    means: Vec<f32>,
    log_probs: Vec<f32>,
    outcome: StepRows,
    /// Random actions, uniform with the deviation of the exploring policy.
    drawn: Vec<f32>,
    /// Where among them the last step's were.
    at: usize,
}

impl Rows {
    fn new(fleet: &Fleet, random: &mut Pcg64Mcg) -> Self {
        let n = fleet.len();
        let size = EXPLORATION * 3_f32.sqrt();
        let number = |_| size * (2.0 * random.random::<f32>() - 1.0);
        Self {
            actions: vec![0.0; n * g1::ACTION],
            means: vec![0.0; n * g1::ACTION],
            log_probs: vec![0.0; n],
            outcome: StepRows::of(fleet, 0.0),
            drawn: (0..(n + DRAWN) * g1::ACTION).map(number).collect(),
            at: 0,
        }
    }

    /// Other random actions for everyone.
    fn shake(&mut self) {
        self.at = (self.at + g1::ACTION) % (DRAWN * g1::ACTION);
        let size = self.actions.len();
        self.actions.copy_from_slice(&self.drawn[self.at..][..size]);
    }

    fn step(&mut self, fleet: &mut Fleet) {
        fleet.step(&self.actions, &mut self.outcome.out());
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_short_measurement_counts_its_steps() {
        let bench = SimBench {
            seconds: 0.05,
            environments: 2,
            fleets: 2,
            hidden: vec![8],
            physics: Engine::Batched,
            self_collision: SelfCollision::On,
            plain: false,
            seed: 1,
        };
        let result = bench.run().unwrap();
        let number = |key: &str| result[key].as_f64().unwrap();
        // steps / wall by its definition, and the policy never makes it faster than free.
        let expected = number("control_steps_measured") / number("wall_seconds");
        assert_eq!(number("control_steps_per_second_per_core"), expected);
        assert_eq!(number("control_steps_per_second"), 2.0 * expected);
        assert!(number("with_inference_per_second_per_core") > 0.0);
        assert!((0.0..1.0).contains(&number("inference_share")));
        assert_eq!(number("faults"), 0.0);
    }
}

//! What an actor works with: its fleet, its policy, its noise, and how they are saved and restored.
//!
//! A worker is born with the first weights it receives, because they say how it begins: anew, or
//! where a checkpoint left it.

use anyhow::{Context, Result, ensure};
use policy::{Policy, Shape};
use protocol::{RolloutViewMut, WeightsHeader, WeightsOrder};
use rand::SeedableRng;
use rand_pcg::Pcg64Mcg;
use run::Checkpoints;
use run::checkpoint::robots_of;
use serde::{Deserialize, Serialize};
use sim::{Fleet, SimError};
use tracing::{info, warn};

use crate::collect::{Timing, collect};
use crate::config::ActorConfig;

/// The living half of an actor.
pub(crate) struct Worker {
    fleet: Fleet,
    policy: Policy,
    /// Robots that explore calmly.
    calm: usize,
    generator: Pcg64Mcg,
}

/// A worker on the disk: all that its future depends on beside the weights.
#[derive(Serialize, Deserialize)]
struct Snapshot {
    fleet: Vec<u8>,
    generator: Pcg64Mcg,
}

impl Worker {
    /// Begins with the `weights` numbers of `header`: where their checkpoint left this actor if it has a
    /// snapshot of it, else anew.
    ///
    /// A worker that begins anew is seeded by run, actor and version: an actor that comes back in
    /// the middle of a run does not live its first episodes again.
    pub(crate) fn begin(
        config: &ActorConfig,
        index: u32,
        header: &WeightsHeader,
        weights: usize,
        checkpoints: &Checkpoints,
    ) -> Result<Self> {
        let seed = mix(mix(config.seed, u64::from(index) + 1), header.version);
        let fleet = Fleet::seen_by(
            &config.tables,
            config.mechanics,
            &config.task.at(header.samples as f64),
            (
                &config.randomization.at(header.samples as f64),
                &config.event.at(header.samples as f64),
            ),
            config.starts.clone(),
            config.layout.environments,
            seed,
        )
        .context("setting up the fleet")?;
        let (shape, clip) = network(config, header, weights)?;
        let mut worker = Self {
            fleet,
            policy: Policy::new(shape, clip),
            calm: config.calm,
            generator: Pcg64Mcg::seed_from_u64(mix(seed, 0)),
        };
        if header.order() != Some(WeightsOrder::Collect) {
            worker.restore_or_save(index, header.version, checkpoints, "new episodes begin");
        }
        Ok(worker)
    }

    /// Takes the state that this actor had at checkpoint `version`. Where there is none, the run goes
    /// on with the state as it is now, and so it belongs to the checkpoint: it is saved. `otherwise` says what is then.
    pub(crate) fn restore_or_save(
        &mut self,
        index: u32,
        version: u64,
        checkpoints: &Checkpoints,
        otherwise: &str,
    ) {
        if !self.restore(index, version, checkpoints, otherwise) {
            self.save(index, version, checkpoints);
        }
    }

    /// Whether there was a state to be taken; what cannot be read is left, and said: a checkpoint
    /// without an actor's fleet is still a good checkpoint.
    fn restore(
        &mut self,
        index: u32,
        version: u64,
        checkpoints: &Checkpoints,
        otherwise: &str,
    ) -> bool {
        let decoded = match checkpoints.attachment(version, &robots_of(index)) {
            Ok(None) => {
                info!(
                    version,
                    "the checkpoint has no robots of this actor: {otherwise}"
                );
                return false;
            }
            Ok(Some(bytes)) => self.decode(&bytes),
            Err(error) => Err(error.into()),
        };
        let Err(error) = decoded else {
            info!(version, "fleet restored");
            return true;
        };
        let why = format!("{error:#}");
        let other = error.downcast_ref::<SimError>();
        if other.is_some_and(SimError::is_of_another_fleet) {
            // `ampco train` has told of it, once for all actors.
            info!(
                version,
                why, "the checkpoint's robots do not fit: {otherwise}"
            );
        } else {
            warn!(
                version,
                why, "the checkpoint's robots cannot be read: {otherwise}"
            );
        }
        false
    }

    fn decode(&mut self, bytes: &[u8]) -> Result<()> {
        let (snapshot, _): (Snapshot, usize) =
            bincode::serde::decode_from_slice(bytes, bincode::config::standard())
                .context("reading the snapshot")?;
        self.fleet.restore(&snapshot.fleet)?;
        self.generator = snapshot.generator;
        Ok(())
    }

    /// Writes this actor's state beside the parts of checkpoint `version`. A disk that refuses
    /// costs the snapshot, not the run.
    pub(crate) fn save(&self, index: u32, version: u64, checkpoints: &Checkpoints) {
        let snapshot = Snapshot {
            fleet: self.fleet.save(),
            generator: self.generator.clone(),
        };
        let bytes = bincode::serde::encode_to_vec(&snapshot, bincode::config::standard())
            .expect("a snapshot can be written to memory");
        if let Err(error) = checkpoints.attach(version, &robots_of(index), &bytes) {
            warn!(version, %error, "snapshot of this actor not written");
        }
    }

    /// Takes over new weights; another shape or clip is another policy.
    pub(crate) fn adopt(
        &mut self,
        config: &ActorConfig,
        header: &WeightsHeader,
        flat: &[f32],
    ) -> Result<()> {
        let samples = header.samples as f64;
        self.fleet.set_task(config.task.at(samples));
        if config.randomization.strength.moves() {
            self.fleet
                .set_randomization(config.randomization.at(samples));
        }
        if config.event.strength.moves() {
            self.fleet.set_event(&config.event.at(samples));
        }
        let (shape, clip) = network(config, header, flat.len())?;
        if (self.policy.shape(), self.policy.clip()) != (&shape, clip) {
            self.policy = Policy::new(shape, clip);
        }
        self.policy
            .load(flat)
            .with_context(|| format!("loading policy version {}", header.version))
    }

    /// Fills one rollout.
    pub(crate) fn collect(&mut self, rollout: &mut RolloutViewMut<'_>) -> Timing {
        collect(
            &mut self.fleet,
            &mut self.policy,
            self.calm,
            &mut self.generator,
            rollout,
        )
    }

    /// Means of the task's terms since they were last taken.
    pub(crate) fn take_terms(&mut self) -> Vec<(&'static str, f32)> {
        self.fleet.take_terms()
    }

    /// Steps thrown away because something was not finite.
    pub(crate) fn faults(&self) -> u64 {
        self.fleet.faults()
    }
}

/// The policy's shape, if so many weights have it (nothing is reserved for one that they have not), and what it cuts
/// observations to.
fn network(config: &ActorConfig, header: &WeightsHeader, weights: usize) -> Result<(Shape, f32)> {
    let hidden: Vec<usize> = header
        .hidden()
        .iter()
        .map(|&width| width as usize)
        .collect();
    let shape = Shape {
        inputs: config.tables.actor.width(),
        hidden,
    };
    ensure!(
        shape.fits(weights),
        "policy version {} is of {weights} numbers, its header says hidden layers {:?} for observations of {}; use \
         programs of one build",
        header.version,
        shape.hidden,
        shape.inputs
    );
    Policy::check_clip(header.observation_clip).with_context(|| {
        let version = header.version;
        format!("policy version {version} cannot be used; use programs of one build")
    })?;
    Ok((shape, header.observation_clip))
}

/// One well-mixed number of two (SplitMix64's finaliser), so that neighbours share no stream.
fn mix(seed: u64, salt: u64) -> u64 {
    let mut x = seed ^ salt.wrapping_mul(0x9E37_79B9_7F4A_7C15);
    x = (x ^ (x >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    x = (x ^ (x >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    x ^ (x >> 31)
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use observation::Tables;
    use protocol::{Lists, RolloutLayout};
    use sim::{EventConfig, Physics, RandomizationConfig, StartConfig, Starts, TaskConfig};
    use vocabulary::Ramp;

    use super::*;

    #[test]
    fn a_policy_acts_with_the_clip_that_comes_with_its_weights() {
        let config = growing();
        let header = |version: u64, clip: f32| {
            let (order, layout) = (WeightsOrder::Collect, config.layout);
            WeightsHeader::new(version, order, &[4], clip, layout, true)
        };
        let nowhere = Checkpoints::new(std::path::PathBuf::new());
        let flat = vec![0.5; Shape::new(config.tables.actor.width(), &[4]).len()];
        let mut worker = Worker::begin(&config, 0, &header(0, 5.0), flat.len(), &nowhere).unwrap();
        worker.adopt(&config, &header(1, 1.5), &flat).unwrap();
        assert_eq!(worker.policy.clip(), 1.5);
        // Of the same shape, but from a learner that was resumed with another configuration.
        worker.adopt(&config, &header(2, 8.0), &flat).unwrap();
        assert_eq!(worker.policy.clip(), 8.0);
        for none in [0.0, f32::NAN] {
            let refused = worker.adopt(&config, &header(3, none), &flat).unwrap_err();
            let words = format!("{refused:#}");
            assert!(
                words.contains("clip") && words.contains("one build"),
                "{words}"
            );
        }
        assert_eq!(worker.policy.clip(), 8.0);
    }

    /// Starts from motion that go from all to half, and a Table I that grows, between 1,000 and 3,000 samples.
    fn growing() -> ActorConfig {
        ActorConfig {
            seed: 1,
            layout: RolloutLayout {
                environments: 1,
                steps: 8,
                lists: Lists::default(),
            },
            calm: 0,
            mechanics: Physics::Rapier.into(),
            tables: Tables::default(),
            task: TaskConfig {
                start: StartConfig {
                    reference_share: Ramp::moving(1.0, 0.5, [1e3, 3e3]),
                    ..StartConfig::default()
                },
                ..TaskConfig::default()
            },
            event: EventConfig::default(),
            randomization: RandomizationConfig {
                strength: Ramp::moving(0.0, 1.0, [1e3, 3e3]),
                ..RandomizationConfig::table_one()
            },
            starts: Starts::default(),
            send_patience: Duration::ZERO,
            journal: false,
        }
    }

    #[test]
    fn the_clock_is_what_the_learner_has_used_however_many_actors_made_it() {
        let config = growing();
        let folder = tempfile::tempdir().unwrap();
        let run = run::Folder::create(folder.path(), "clock").unwrap();
        let shape = Shape::new(config.tables.actor.width(), &[4]);
        let flat = vec![0.5; shape.len()];
        let header = |version, samples| {
            let order = WeightsOrder::Collect;
            WeightsHeader::new(version, order, &shape.hidden, 5.0, config.layout, true)
                .after(samples)
        };
        let begin = |header: &WeightsHeader| {
            Worker::begin(&config, 0, header, flat.len(), &run.checkpoints()).unwrap()
        };
        // Versions of two, of twenty and of two hundred rows: half of the way is gone in all of them. An actor that
        // begins anew there is as far as one that was there before.
        for version in [1_000, 100, 10] {
            let mut worker = begin(&header(0, 0));
            assert_eq!(
                worker.fleet.task().start.reference_share,
                Ramp::Constant(1.0)
            );
            worker
                .adopt(&config, &header(version, 2_000), &flat)
                .unwrap();
            for worker in [&worker, &begin(&header(version, 2_000))] {
                assert_eq!(
                    worker.fleet.task().start.reference_share,
                    Ramp::Constant(0.75)
                );
                // Half of Table I's 0.5 kg.
                let mass = worker.fleet.randomization().mass_variation;
                assert_eq!(mass.map(|row| row.range), Some([-0.25, 0.25]));
            }
        }
    }

    #[test]
    fn neighbouring_actors_and_versions_get_seeds_of_their_own() {
        let seeds: std::collections::BTreeSet<u64> = (0..8)
            .flat_map(|actor| (0..8).map(move |version| mix(mix(7, actor + 1), version)))
            .collect();
        assert_eq!(seeds.len(), 64);
    }
}

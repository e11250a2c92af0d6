//! `ampco export`: a trained policy for other programs, and the robot for MuJoCo.

mod ship;

use std::io::Write;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result};
use export::{Description, Network, Origin, deploy_yaml, metadata, network, onnx, tensors};
use g1::mjcf;
use judge::Kept;
use sim::RandomizationConfig;
use sim::world::{CONTROL_STEP, GRAVITY, PHYSICS_STEP};
use terminal::failure::usage;
use terminal::{Place, SelfCollision, console};

/// The robot's file.
const MODEL: &str = "g1.xml";

/// Take a trained policy out: ONNX, safetensors, a description, and the robot as MJCF
///
/// Writes policy.onnx (observation normalisation and deterministic action inside, any batch), policy.safetensors,
/// policy.json (joints, gains, observation layout, rates, origin), deploy.yaml (the same in the layout of Unitree's
/// controllers) and g1.xml (the robot for MuJoCo).
#[derive(Debug, clap::Args)]
pub(crate) struct Export {
    /// A run's name or folder, a checkpoint's folder, or the folder of a shipped policy
    #[arg(required_unless_present = "mjcf")]
    run: Option<String>,
    #[command(flatten)]
    place: Place,
    /// Folder to write to; made if it is not there
    #[arg(long, value_name = "DIR", required_unless_present = "mjcf")]
    out: Option<PathBuf>,
    /// Write instead a folder that `evaluate`, `play`, `export` and `train --from` take like a run, about a
    /// megabyte: policy, critic, the discriminator that judges its style, and the configuration
    #[arg(long, requires = "run")]
    ship: bool,
    /// Write the robot alone, to DIR/g1.xml or to standard output
    #[arg(long, conflicts_with = "run")]
    mjcf: bool,
    /// Whether legs, arms and trunk meet each other in the robot's file
    #[arg(long, value_enum, default_value_t = SelfCollision::On, conflicts_with = "ship")]
    self_collision: SelfCollision,
}

impl Export {
    pub(crate) fn run(&self) -> Result<()> {
        let mut out = console::results();
        let written = match (&self.run, &self.out) {
            (None, None) => {
                write!(out, "{}", model(self.self_collision))?;
                return Ok(());
            }
            (None, Some(folder)) => {
                write_all(folder, &[(MODEL, model(self.self_collision).into_bytes())])?
            }
            (Some(run), Some(folder)) if self.ship => {
                ship::write(&Kept::open(&self.place, run)?, folder)?
            }
            (Some(run), Some(folder)) => write_all(
                folder,
                &files(&Kept::open(&self.place, run)?, self.self_collision)?,
            )?,
            (Some(_), None) => return Err(usage("--out DIR: say where to write")),
        };
        for (path, bytes) in written {
            writeln!(out, "{:>9} bytes  {}", bytes, path.display())?;
        }
        Ok(())
    }
}

/// The robot in the simulation's own step, gravity and nominal friction.
fn model(self_collision: SelfCollision) -> String {
    let decimal = |x: f32| f64::from((x * 1e6).round()) / 1e6;
    mjcf::document(&mjcf::Physics {
        timestep: decimal(PHYSICS_STEP),
        gravity: decimal(GRAVITY),
        friction: f64::from(sim::Variation::NOMINAL.friction),
        self_collision: self_collision == SelfCollision::On,
    })
}

/// Every file of an export with its bytes; the description, which names the others, comes last.
fn files(kept: &Kept, self_collision: SelfCollision) -> Result<Vec<(&'static str, Vec<u8>)>> {
    let place = kept.path.display();
    let (shape, flat) = kept.weights()?;
    let clip = kept.learning.policy.observation_clip;
    let network = Network::new(shape, clip, flat)
        .with_context(|| format!("checking policy.bin of {place}"))?;
    let rate = |step: f32| f64::from((1.0 / step).round());
    let task = kept.task()?;
    let mut description = Description::new(
        &network,
        &kept.tables.actor,
        origin(kept, &network)?,
        [rate(CONTROL_STEP), rate(PHYSICS_STEP)],
        task.command.widest(),
        serde_json::to_value(&task)?,
        serde_json::to_value(RandomizationConfig::table_one())?,
    );
    let properties = metadata::properties(&description);
    let mut files = vec![
        (MODEL, model(self_collision).into_bytes()),
        ("policy.onnx", onnx::model(&network, &properties)),
        (
            "policy.safetensors",
            tensors::file(&network).context("writing safetensors")?,
        ),
        ("deploy.yaml", deploy_yaml::text(&description).into_bytes()),
    ];
    description.origin.files_sha256 = files
        .iter()
        .map(|(name, bytes)| ((*name).to_owned(), network::sha256(bytes)))
        .collect();
    let mut text = serde_json::to_vec_pretty(&description)?;
    text.push(b'\n');
    files.push(("policy.json", text));
    Ok(files)
}

fn origin(kept: &Kept, network: &Network) -> Result<Origin> {
    Ok(Origin {
        run: kept.run_name()?,
        iteration: kept.iteration,
        weights_sha256: network.hash(),
        config_sha256: network::sha256(kept.config().to_toml().as_bytes()),
        ..Origin::default()
    })
}

/// Writes each file beside, then renames it; gives the paths and sizes.
fn write_all(folder: &Path, files: &[(&str, Vec<u8>)]) -> Result<Vec<(PathBuf, usize)>> {
    std::fs::create_dir_all(folder).with_context(|| format!("making {}", folder.display()))?;
    let mut written = Vec::new();
    for (name, bytes) in files {
        let path = folder.join(name);
        run::replace_file(&path, bytes).with_context(|| format!("writing {}", path.display()))?;
        written.push((path, bytes.len()));
    }
    Ok(written)
}

#[cfg(test)]
mod tests {
    use super::*;
    use judge::Subject;

    /// A copy of a shipped policy with another line in its configuration.
    fn shipped_with(folder: &Path, line: &str, instead: &str) -> Result<Subject> {
        let walk = Path::new(env!("CARGO_MANIFEST_DIR")).join("../policies/walk");
        for name in ["manifest.json", "policy.bin", "judge.bin", "critic.bin"] {
            std::fs::copy(walk.join(name), folder.join(name))?;
        }
        let config = std::fs::read_to_string(walk.join("config.toml"))?;
        assert_eq!(config.matches(line).count(), 1);
        std::fs::write(folder.join("config.toml"), config.replace(line, instead))?;
        let place = Place {
            runs_dir: "runs".into(),
        };
        Subject::open(&place, folder.to_str().context("text")?)
    }

    #[test]
    fn an_export_cuts_observations_as_the_policy_was_trained() {
        let folder = tempfile::tempdir().unwrap();
        let clip = "observation_clip = 5.0";
        let subject = shipped_with(folder.path(), clip, "observation_clip = 1.5").unwrap();
        assert_eq!(subject.policy().unwrap().clip(), 1.5);
        let files = files(&subject.kept, SelfCollision::On).unwrap();
        let (_, text) = files
            .iter()
            .find(|(name, _)| *name == "policy.json")
            .unwrap();
        let description: Description = serde_json::from_slice(text).unwrap();
        assert_eq!(description.network.clip, 1.5);
        // And its example is what the policy that acts here does.
        let mut action = [0.0; policy::OUTPUTS];
        let observation = &description.example.observation;
        subject.policy().unwrap().means(observation, 1, &mut action);
        assert_eq!(description.example.action, action);

        let refused = shipped_with(folder.path(), clip, "observation_clip = -1.0");
        let words = format!("{:#}", refused.err().unwrap());
        assert!(
            words.contains("config.toml") && words.contains("observation_clip"),
            "{words}"
        );
    }

    #[test]
    fn the_task_is_the_one_that_its_ramps_had_come_to() {
        let folder = tempfile::tempdir().unwrap();
        // `walk` has 4.01 million samples behind it: past the end of its ramp, where the kernel is 4.
        let kernel = |instead| {
            let samples = "samples = [1500000.0, 2100000.0]\nto = 4.0";
            let subject = shipped_with(folder.path(), samples, instead).unwrap();
            subject.task.reward.track.unwrap().kernel.now()
        };
        assert_eq!(kernel("samples = [1.5e6, 2.1e6]\nto = 4.0"), 4.0);
        // A millionth of the way from 2 to 4.
        let later = kernel("samples = [0.0, 4.01e12]\nto = 4.0");
        assert!(later > 2.0 && later < 2.001, "{later}");
    }

    #[test]
    fn the_model_steps_as_the_simulation_does() {
        let text = model(SelfCollision::On);
        assert!(
            text.contains(r#"timestep="0.005" gravity="0 0 -9.81""#),
            "{text}"
        );
        let folder = tempfile::tempdir().unwrap();
        let inner = folder.path().join("a/b");
        let written = write_all(&inner, &[(MODEL, text.clone().into_bytes())]).unwrap();
        assert_eq!(written, [(inner.join(MODEL), text.len())]);
        assert_eq!(std::fs::read_to_string(inner.join(MODEL)).unwrap(), text);
    }
}

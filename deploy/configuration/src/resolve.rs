//! From a preset and a few options to a configuration in which every value is written out.
//!
//! Separate from `train` because this is where every section meets its owner: each is read and
//! checked strictly before anything is started, so that a mistake costs a second and not an hour.

use std::path::Path;
use std::thread;

use amp::{DiscriminatorConfig, ExplorationConfig, PolicyConfig, PpoConfig};
use ampco::ScheduleConfig;
use anyhow::{Context, Result};
use motion::MotionConfig;
use run::{Config, FleetConfig, RunConfig};
use serde::Serialize;
use serde::de::DeserializeOwned;
use sim::{RandomizationConfig, TaskConfig};
use toml::Value;
use vocabulary::Checked;

/// Every section there is.
const SECTIONS: [&str; 10] = [
    "run",
    "fleet",
    "task",
    "randomization",
    "motion",
    "policy",
    "exploration",
    "ppo",
    "discriminator",
    "scheduler",
];

/// What `train` itself needs of a resolved configuration.
#[derive(Debug)]
pub struct Resolved {
    /// Section `run`.
    pub run: RunConfig,
    /// Section `fleet`, actors written out.
    pub fleet: FleetConfig,
    /// Section `motion`.
    pub motion: MotionConfig,
    /// Section `policy`.
    pub policy: PolicyConfig,
}

/// Reads and checks every section, and writes its defaults out into `config`.
pub fn resolve(config: &mut Config) -> Result<Resolved> {
    config.check_sections(&SECTIONS)?;
    let run = settle(config, "run", RunConfig::validate)?;
    let mut fleet = settle(config, "fleet", FleetConfig::validate)?;
    if fleet.actors == 0 {
        fleet.actors = cores().min(fleet.environments).min(protocol::MAX_ACTORS);
        config.resolve("fleet", &fleet);
    }
    settle(config, "task", TaskConfig::validate)?;
    settle(config, "randomization", RandomizationConfig::validate)?;
    let motion = settle(config, "motion", MotionConfig::validate)?;
    let policy = settle(config, "policy", PolicyConfig::validate)?;
    settle(config, "exploration", ExplorationConfig::validate)?;
    settle(config, "ppo", PpoConfig::validate)?;
    settle(config, "discriminator", DiscriminatorConfig::validate)?;
    settle(config, "scheduler", ScheduleConfig::validate)?;
    Ok(Resolved {
        run,
        fleet,
        motion,
        policy,
    })
}

/// Makes the files that the configuration names absolute: a preset's start from its own folder,
/// those of `--set` from the present one. The run's processes start wherever they like.
pub fn anchor_files(config: &mut Config, preset: Option<&Path>) -> Result<()> {
    let Some(Value::Array(clips)) = config.given("motion.clips") else {
        return Ok(());
    };
    let mut clips = clips.clone();
    let origin = config.origin("motion.clips").unwrap_or_default().to_owned();
    let here = std::env::current_dir().context("finding the present folder")?;
    let of_preset = preset.filter(|file| origin == file.display().to_string());
    let folder = of_preset.and_then(Path::parent).unwrap_or(&here);
    for clip in &mut clips {
        for key in ["file", "folder"] {
            if let Some(Value::String(path)) = clip.get_mut(key) {
                *path = folder.join(&*path).to_string_lossy().into_owned();
            }
        }
    }
    config.put("motion.clips", clips, &origin);
    Ok(())
}

/// The first lines in which two resolved configurations differ, the one that is there and the one that is meant; a
/// line that one of them has not is empty.
pub fn difference(theirs: &Config, ours: &Config) -> Option<(String, String)> {
    let (theirs, ours) = (theirs.to_toml(), ours.to_toml());
    let (mut theirs, mut ours) = (theirs.lines(), ours.lines());
    loop {
        match (theirs.next(), ours.next()) {
            (None, None) => return None,
            (theirs, ours) if theirs == ours => {}
            (theirs, ours) => {
                let line = |line: Option<&str>| line.unwrap_or_default().to_owned();
                return Some((line(theirs), line(ours)));
            }
        }
    }
}

/// Reads a section, has it checked, and writes its defaults out.
fn settle<T>(config: &mut Config, name: &str, validate: fn(&T) -> Checked) -> Result<T>
where
    T: DeserializeOwned + Default + Serialize,
{
    let section = config.checked(name, validate)?;
    config.resolve(name, &section);
    Ok(section)
}

/// How many actors fit this machine: one a core.
fn cores() -> usize {
    thread::available_parallelism().map_or(1, usize::from)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::presets;

    fn complaint(text: &str) -> String {
        let mut config = Config::parse(text, "my.toml").unwrap();
        format!("{:#}", resolve(&mut config).unwrap_err())
    }

    #[test]
    fn every_preset_resolves_and_its_written_form_resolves_to_the_same() {
        for name in presets::names() {
            let mut config = presets::find(name).unwrap().config;
            let resolved = resolve(&mut config).unwrap();
            assert!(resolved.fleet.actors > 0, "{name}: actors are written out");

            let text = config.to_toml();
            let mut again = Config::parse(&text, "config.toml").unwrap();
            resolve(&mut again).unwrap();
            assert_eq!(again.to_toml(), text, "{name}");
            for section in SECTIONS {
                assert!(
                    text.contains(&format!("[{section}")),
                    "{name} lacks [{section}]"
                );
            }
        }
    }

    #[test]
    fn every_section_is_read_strictly() {
        for section in SECTIONS {
            let message = complaint(&format!("[{section}]\nno_such_key = 1"));
            assert!(
                message.starts_with(&format!(
                    "my.toml: unknown key `no_such_key` in [{section}]"
                )),
                "{message}"
            );
        }
        assert!(complaint("[discriminater]").contains("`discriminator`"));
    }

    #[test]
    fn keys_of_older_files_are_refused_with_their_new_spelling() {
        for (old, now) in run::config::moved() {
            let mut config = Config::default();
            config.set(&format!("{old}=1")).unwrap();
            let said = format!("{:#}", resolve(&mut config).unwrap_err());
            assert!(said.contains(&format!("as in {now}")), "{said}");
            // The new spelling is one, and changes what the run does.
            let mut config = Config::default();
            config.set(&now.replacen(" = ", "=", 1)).unwrap();
            resolve(&mut config).unwrap();
            let mut defaults = Config::default();
            resolve(&mut defaults).unwrap();
            assert!(difference(&config, &defaults).is_some(), "{now}");
        }
        let said = complaint("[task.curriculum]\nkernel = 4.0");
        assert!(
            said.starts_with("my.toml: unknown key `curriculum`"),
            "{said}"
        );
    }

    #[test]
    fn values_out_of_range_are_refused_with_their_origin() {
        for (section, line, mentioned) in [
            ("run", "minutes = -1.0", "minutes"),
            ("fleet", "environments = 0", "environments"),
            ("task", "reward.track.kernel = -1.0", "reward.track.kernel"),
            ("randomization", "mass_range = [1.0, -1.0]", "mass_range"),
            ("motion", "clips = []", "clips"),
            ("policy", "hidden = []", "hidden"),
            ("exploration", "sigma = 0.0", "sigma"),
            ("ppo", "epochs = 0", "epochs"),
            (
                "discriminator",
                "gradient_penalty = nan",
                "gradient_penalty",
            ),
            ("scheduler", "percentile = 95.0", "percentile"),
        ] {
            let message = complaint(&format!("[{section}]\n{line}"));
            let named = message.starts_with(&format!("my.toml: [{section}]"));
            assert!(named && message.contains(mentioned), "{message}");
        }
    }

    #[test]
    fn a_presets_files_start_from_its_folder_and_those_of_set_from_here() {
        let preset = Path::new("/presets/my.toml");
        let text = "[motion]\nclips = [{ file = \"x.csv\", fps = 60 }, { gait = \"stand\" }]";
        let mut config = Config::parse(text, "/presets/my.toml").unwrap();
        anchor_files(&mut config, Some(preset)).unwrap();
        let clip = |config: &Config| match config.given("motion.clips") {
            Some(Value::Array(clips)) => clips[0]["file"].as_str().unwrap().to_owned(),
            other => panic!("{other:?}"),
        };
        assert_eq!(clip(&config), "/presets/x.csv");

        config
            .set("motion.clips=[{ file = \"y.csv\", fps = 60 }]")
            .unwrap();
        anchor_files(&mut config, Some(preset)).unwrap();
        let here = std::env::current_dir().unwrap().join("y.csv");
        assert_eq!(clip(&config), here.to_string_lossy());
    }
}

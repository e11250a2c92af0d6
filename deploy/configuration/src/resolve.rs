//! From a preset and a few options to a configuration in which every value is written out.
//!
//! Separate from `train` because this is where every section meets its owner: each is read and
//! checked strictly before anything is started, so that a mistake costs a second and not an hour.

use std::sync::LazyLock;
use std::thread;

use amp::{DiscriminatorConfig, ExplorationConfig, PolicyConfig, PpoConfig};
use ampco::ScheduleConfig;
use anyhow::{Context, Result};
use motion::MotionConfig;
use observation::{ObservationConfig, Tables};
use run::{Config, FleetConfig, RunConfig};
use schemars::{Schema, SchemaGenerator};
use sim::{EventConfig, RandomizationConfig, TaskConfig};
use toml::Value;
use vocabulary::Section;

/// A section, whichever it is.
pub struct Known {
    /// Its name in a configuration.
    pub name: &'static str,
    /// Reads it, checks it, and writes its defaults out.
    settle: fn(&mut Config) -> Result<()>,
    /// Its keys, with the doc comments of their fields.
    pub schema: fn(&mut SchemaGenerator) -> Schema,
}

/// Every section there is.
pub const SECTIONS: [Known; 12] = [
    known::<RunConfig>(),
    known::<FleetConfig>(),
    known::<TaskConfig>(),
    known::<RandomizationConfig>(),
    known::<EventConfig>(),
    known::<ObservationConfig>(),
    known::<MotionConfig>(),
    known::<PolicyConfig>(),
    known::<ExplorationConfig>(),
    known::<PpoConfig>(),
    known::<DiscriminatorConfig>(),
    known::<ScheduleConfig>(),
];

const fn known<T: Section>() -> Known {
    Known {
        name: T::NAME,
        settle: settle::<T>,
        schema: T::json_schema,
    }
}

fn settle<T: Section>(config: &mut Config) -> Result<()> {
    let section: T = config.section()?;
    config.resolve(&section);
    Ok(())
}

/// What `train` itself needs of a resolved configuration.
#[derive(Debug)]
pub struct Resolved {
    /// Section `run`.
    pub run: RunConfig,
    /// Section `fleet`, actors written out.
    pub fleet: FleetConfig,
    /// Section `observation`, made ready.
    pub tables: Tables,
    /// Section `motion`.
    pub motion: MotionConfig,
    /// Section `policy`.
    pub policy: PolicyConfig,
    /// What is to be said of it: accepted, and odd.
    pub notices: Vec<String>,
}

/// Reads and checks every section, and writes its defaults out into `config`.
pub fn resolve(config: &mut Config) -> Result<Resolved> {
    settle_all(config)?;
    let mut fleet: FleetConfig = config.section()?;
    if fleet.actors == 0 {
        fleet.actors = cores().min(fleet.environments).min(protocol::MAX_ACTORS);
        config.resolve(&fleet);
    }
    let observation: ObservationConfig = config.section()?;
    let tables = observation.tables().expect("a section that was checked");
    let event: EventConfig = config.section()?;
    event
        .check_beside(&config.section()?)
        .map_err(|invalid| config.refuse(EventConfig::NAME, &invalid.path, &invalid))?;
    let discriminator: DiscriminatorConfig = config.section()?;
    if discriminator.command_blur.is_some() && tables.velocities().is_none() {
        return Err(config
            .refuse(
                "discriminator",
                "command_blur",
                "command_blur needs the velocities that a command asks for: name linear_velocity and angular_velocity in \
                 observation.discriminator.terms, without scale or clip, or leave command_blur out",
            )
            .into());
    }
    Ok(Resolved {
        run: config.section()?,
        fleet,
        notices: tables.oddities(),
        tables,
        motion: config.section()?,
        policy: config.section()?,
    })
}

/// The value or table that a dotted key has where nothing sets it.
pub fn default(path: &str) -> Option<Value> {
    static DEFAULTS: LazyLock<Config> = LazyLock::new(|| {
        let mut config = Config::default();
        settle_all(&mut config).expect("the defaults hold");
        config
    });
    DEFAULTS.given(path).cloned()
}

/// As [`resolve`], with what this machine decides left open.
pub fn settle_all(config: &mut Config) -> Result<()> {
    for section in &SECTIONS {
        // `--set randomization=3` means the section, and is no key of [run]: its reader says what it is made of.
        let path = format!("{}.{}", RunConfig::NAME, section.name);
        let value = config.given(&path).filter(|value| !value.is_table());
        if let Some(value) = value.cloned() {
            let origin = config.origins(&path).join(" with ");
            config.remove(&path);
            config.put(section.name, value, &origin);
        }
    }
    config.check_sections(&SECTIONS.map(|section| section.name))?;
    SECTIONS
        .iter()
        .try_for_each(|section| (section.settle)(config))
}

/// Makes the files absolute that `--set` names: they start from the present folder, and the run's processes start
/// wherever they like. Those of a preset start from its own folder, and are absolute by now.
pub fn anchor_files(config: &mut Config) -> Result<()> {
    config.anchor_files(&std::env::current_dir().context("finding the present folder")?);
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
                    text.contains(&format!("[{}", section.name)),
                    "{name} lacks [{}]",
                    section.name
                );
            }
        }
    }

    #[test]
    fn every_section_is_read_strictly() {
        for section in SECTIONS {
            let message = complaint(&format!("[{}]\nno_such_key = 1", section.name));
            assert!(
                message.starts_with(&format!(
                    "my.toml: unknown key `no_such_key` in [{}]",
                    section.name
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
        for gone in run::config::gone() {
            let (section, key) = gone.split_once('.').unwrap();
            let said = complaint(&format!("[{section}]\n{key} = 1"));
            let named = said.starts_with(&format!("my.toml: unknown key `{key}` in [{section}]"));
            assert!(named && said.contains("take the line away"), "{said}");
        }
        let said = complaint("[task.curriculum]\nkernel = 4.0");
        assert!(
            said.starts_with("my.toml: unknown key `curriculum`"),
            "{said}"
        );
    }

    #[test]
    fn a_section_that_is_given_one_value_is_told_its_keys() {
        for section in SECTIONS {
            let mut config = Config::default();
            config.set(&format!("{}=3", section.name)).unwrap();
            let said = format!("{:#}", resolve(&mut config).unwrap_err());
            let named = format!(
                "--set {0}=3: `{0}` = 3 in [{0}]: give a table",
                section.name
            );
            assert!(said.starts_with(&named), "{said}");
            let said = complaint(&format!("{} = 3", section.name));
            assert!(
                said.starts_with("my.toml: ") && said.contains("give a table"),
                "{said}"
            );
        }
        let mut config = Config::default();
        config.set("randomization=3").unwrap();
        let said = format!("{:#}", resolve(&mut config).unwrap_err());
        assert!(
            said.contains("keys: `strength`, `plain_share`, `mass_variation`, "),
            "{said}"
        );
        // A table of that name in [run] is not taken for the section.
        let said = complaint("[run.ppo]\nepochs = 3");
        assert!(said.contains("unknown key `ppo` in [run]"), "{said}");
    }

    #[test]
    fn lists_that_leave_out_what_they_are_for_are_told() {
        let notices = |text: &str| {
            let mut config = Config::parse(text, "my.toml").unwrap();
            resolve(&mut config).unwrap().notices
        };
        assert_eq!(notices(""), [""; 0]);
        let said = notices("[observation]\nactor.terms = ['joint_angle', 'gravity']");
        assert!(said[0].contains("actor.terms has no `command`"), "{said:?}");
        for name in presets::names() {
            let mut config = presets::find(name).unwrap().config;
            assert_eq!(resolve(&mut config).unwrap().notices, [""; 0], "{name}");
        }
    }

    #[test]
    fn values_out_of_range_are_refused_with_their_origin() {
        for (section, line, mentioned) in [
            ("run", "minutes = -1.0", "minutes"),
            ("fleet", "environments = 0", "environments"),
            ("task", "reward.track.kernel = -1.0", "reward.track.kernel"),
            ("observation", "actor.terms = ['hight']", "actor.terms"),
            ("observation", "actor.past = 99", "actor.past"),
            (
                "observation",
                "discriminator.terms = ['push']",
                "reference motion",
            ),
            (
                "randomization",
                "friction = { range = [1.0, -1.0] }",
                "friction.range",
            ),
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
    fn a_discriminator_that_is_to_see_the_command_off_needs_velocities() {
        let lists = "[observation.discriminator]\nterms = ['key_bodies']";
        let said = complaint(&format!(
            "{lists}\n[discriminator]\ncommand_blur = [0.1, 0.1, 0.1]"
        ));
        assert!(
            said.starts_with("my.toml: [discriminator]") && said.contains("linear_velocity"),
            "{said}"
        );
        let mut config = Config::parse(lists, "my.toml").unwrap();
        resolve(&mut config).unwrap();
    }

    #[test]
    fn files_of_set_start_from_here() {
        let mut config = Config::default();
        let clips = "motion.clips=[{ file = \"y.csv\", fps = 60 }, { file = \"/x.csv\" }]";
        config.set(clips).unwrap();
        anchor_files(&mut config).unwrap();
        let clips = config.given("motion.clips").unwrap();
        let here = std::env::current_dir().unwrap().join("y.csv");
        assert_eq!(clips[0]["file"].as_str(), here.to_str());
        assert_eq!(clips[1]["file"].as_str(), Some("/x.csv"));
        let origin = config.origin("motion.clips").unwrap();
        assert!(origin.starts_with("--set motion.clips="), "{origin}");
    }
}

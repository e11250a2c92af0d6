//! Configuration files and `--set`.

use amp::{DiscriminatorConfig, ExplorationConfig, PolicyConfig, PpoConfig};
use ampco::ScheduleConfig;
use motion::MotionConfig;
use proptest::collection::vec;
use proptest::prelude::*;
use run::{Config, ConfigError, FleetConfig, RunConfig};
use sim::{EventConfig, RandomizationConfig, TaskConfig};
use vocabulary::Section;

use crate::damage::{blows, damaged};
use crate::{always, assert_clear};

/// A file with every value of every section, as `ampco train` writes it.
fn whole() -> String {
    let mut config = Config::default();
    config.resolve(&RunConfig::default());
    config.resolve(&FleetConfig::default());
    config.resolve(&TaskConfig::default());
    config.resolve(&RandomizationConfig::default());
    config.resolve(&EventConfig::default());
    config.resolve(&MotionConfig::default());
    config.resolve(&PolicyConfig::default());
    config.resolve(&ExplorationConfig::default());
    config.resolve(&PpoConfig::default());
    config.resolve(&DiscriminatorConfig::default());
    config.resolve(&ScheduleConfig::default());
    config.to_toml()
}

/// Reads all that is in it, as `ampco train` does.
#[expect(clippy::result_large_err, reason = "one error per input, at most")]
fn read(config: &Config) -> Result<(), ConfigError> {
    #[expect(clippy::result_large_err, reason = "as above")]
    fn section<T: Section>(config: &Config) -> Result<(), ConfigError> {
        let section: T = config.section()?;
        // What was accepted can be written out again.
        config.clone().resolve(&section);
        Ok(())
    }
    config.check_sections(&[
        "run",
        "fleet",
        "task",
        "randomization",
        "event",
        "motion",
        "policy",
        "exploration",
        "ppo",
        "discriminator",
        "scheduler",
    ])?;
    section::<RunConfig>(config)?;
    section::<FleetConfig>(config)?;
    section::<TaskConfig>(config)?;
    section::<RandomizationConfig>(config)?;
    section::<EventConfig>(config)?;
    section::<MotionConfig>(config)?;
    section::<PolicyConfig>(config)?;
    section::<ExplorationConfig>(config)?;
    section::<PpoConfig>(config)?;
    section::<DiscriminatorConfig>(config)?;
    section::<ScheduleConfig>(config)
}

fn read_text(text: &str) {
    let config = Config::parse(text, "hostile.toml");
    let read = match &config {
        Ok(config) => read(config),
        Err(error) => return assert_clear(error),
    };
    if let Err(error) = read {
        assert_clear(&error);
    }
}

/// Values that are no good in most places.
fn values() -> impl Strategy<Value = String> {
    let fixed = [
        "nan",
        "inf",
        "-inf",
        "0",
        "-1",
        "1e308",
        "-1e-308",
        "9223372036854775807",
        "-9223372036854775808",
        "1",
        "0.5",
        "true",
        "\"\"",
        "\"walk\"",
        "[]",
        "[[]]",
        "[nan, inf]",
        "[-1, 0]",
        "{}",
        "{ x = 1 }",
        "1979-05-27T07:32:00Z",
        "[{ gait = \"walk\", speed = 1e30 }]",
        "[{ file = \"/dev/null\", fps = 1e-9 }]",
        "{ amp = { style_weight = nan } }",
    ];
    prop_oneof![
        3 => proptest::sample::select(fixed.to_vec()).prop_map(str::to_owned),
        1 => any::<f64>().prop_map(|number| format!("{number:?}")),
        1 => any::<i64>().prop_map(|number| number.to_string()),
    ]
}

#[test]
fn a_damaged_file_is_read_or_refused() {
    let whole = whole();
    read(&Config::parse(&whole, "whole").unwrap()).unwrap();
    always(400, &blows(), |blows| {
        let bytes = damaged(whole.as_bytes(), &blows);
        read_text(&String::from_utf8_lossy(&bytes));
    });
}

#[test]
fn any_value_in_any_place_is_accepted_or_refused() {
    let whole = Config::parse(&whole(), "whole").unwrap();
    let paths: Vec<String> = whole.paths().map(str::to_owned).collect();
    let assignments = vec((proptest::sample::select(paths), values()), 1..4);
    always(600, &assignments, |assignments| {
        let mut config = whole.clone();
        for (path, value) in assignments {
            if let Err(error) = config.set(&format!("{path}={value}")) {
                assert_clear(&error);
            }
        }
        if let Err(error) = read(&config) {
            assert_clear(&error);
        }
    });
}

#[test]
fn any_words_are_read_or_refused() {
    let marks: Vec<char> = "[]{}=.,\"'#\n\\ax1-_:é∞\u{0}".chars().collect();
    let words = vec(proptest::sample::select(marks), 0..120);
    always(1000, &words, |words| {
        let text: String = words.into_iter().collect();
        read_text(&text);
        if let Err(error) = Config::default().set(&text) {
            assert_clear(&error);
        }
    });
}

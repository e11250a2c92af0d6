//! Configuration as a user meets it: presets, `--set`, and what an error says.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use run::{Config, ConfigError, FleetConfig, Mode, RunConfig};
use vocabulary::invalid::require;
use vocabulary::{Checked, Section};

/// A section with what real ones have: a number, a choice, a table, a list, an option.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
struct Walk {
    speed: f32,
    steps: usize,
    method: Method,
    limit: Limit,
    clips: Vec<Limit>,
    #[serde(skip_serializing_if = "Option::is_none")]
    label: Option<String>,
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
enum Method {
    Plain,
    Amp { style_weight: f32 },
}

#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
struct Limit {
    lower: f32,
    upper: f32,
}

impl Default for Walk {
    fn default() -> Self {
        Self {
            speed: 0.95,
            steps: 24,
            method: Method::Plain,
            limit: Limit::default(),
            clips: Vec::new(),
            label: None,
        }
    }
}

impl Section for Walk {
    const NAME: &'static str = "walk";

    fn validate(&self) -> Checked {
        require(self.speed <= 2.0, "speed", self.speed, "use at most 2")
    }
}

fn config(text: &str) -> Config {
    Config::parse(text, "preset walk").unwrap()
}

fn complaint(config: &Config) -> String {
    config.section::<Walk>().unwrap_err().to_string()
}

#[test]
fn nothing_given_is_the_defaults() {
    assert_eq!(config("").section::<Walk>().unwrap(), Walk::default());
}

#[test]
fn a_preset_changes_only_what_it_mentions_and_set_wins() {
    let mut config = config("[walk]\nsteps = 8\nlimit = { lower = 0.1 }");
    config.merge(Config::parse("[walk.limit]\nupper = 0.9", "b.toml").unwrap());
    config.set("walk.speed=1.5").unwrap();
    config.set("walk.method.amp.style_weight=0.7").unwrap();
    let walk: Walk = config.section().unwrap();
    let expected = Walk {
        speed: 1.5,
        steps: 8,
        method: Method::Amp { style_weight: 0.7 },
        limit: Limit {
            lower: 0.1,
            upper: 0.9,
        },
        ..Walk::default()
    };
    assert_eq!(walk, expected);
}

#[test]
fn an_unknown_key_names_its_origin_its_value_and_the_closest() {
    let message = complaint(&config("[walk]\nsped = 2"));
    assert_eq!(
        message,
        "preset walk: unknown key `sped` in [walk] (value 2); did you mean `speed`?"
    );
}

#[test]
fn an_unknown_key_inside_a_table_and_inside_a_list_is_found() {
    let message = complaint(&config("[walk.limit]\nuper = 2"));
    assert!(
        message.contains("`limit.uper`") && message.contains("`upper`"),
        "{message}"
    );
    let message = complaint(&config("[walk]\nclips = [{}, { lowr = 3 }]"));
    assert!(message.contains("`clips[1].lowr`"), "{message}");
    assert!(
        message.contains("(value 3)") && message.contains("`lower`"),
        "{message}"
    );
}

#[test]
fn a_wrong_type_names_the_assignment_that_gave_it() {
    let mut config = config("[walk]\nsteps = 8");
    config.set("walk.steps=many").unwrap();
    let message = complaint(&config);
    assert!(
        message.starts_with("--set walk.steps=many: `steps` = \"many\""),
        "{message}"
    );
    assert!(message.contains("give a whole number"), "{message}");
}

#[test]
fn a_negative_count_is_refused() {
    let message = complaint(&config("[walk]\nsteps = -8"));
    assert!(message.contains("`steps` = -8"), "{message}");
}

#[test]
fn an_unknown_choice_lists_the_choices() {
    let message = complaint(&config("[walk]\nmethod = \"plan\""));
    assert!(
        message.contains("unknown choice `plan`; did you mean `plain`?"),
        "{message}"
    );
}

#[test]
fn an_unknown_section_is_answered_with_the_closest() {
    let error = config("[wlak]\nsteps = 1")
        .check_sections(&["walk", "run"])
        .unwrap_err();
    let message = error.to_string();
    assert!(
        message.contains("[wlak]") && message.contains("`walk`"),
        "{message}"
    );
    assert!(config("[walk]").check_sections(&["walk"]).is_ok());
}

#[test]
fn an_owners_refusal_names_where_the_key_was_given() {
    let mut config = config("[walk]\nsteps = 8");
    config.set("walk.speed=3").unwrap();
    let error = config.section::<Walk>().unwrap_err();
    assert!(matches!(error, ConfigError::Refused { .. }));
    let message = error.to_string();
    assert!(
        message.starts_with("--set walk.speed=3: [walk] speed = 3"),
        "{message}"
    );
    // An entry of a list, and something inside a table, are where the list and the table were given.
    config.set("walk.clips=[]").unwrap();
    for (path, origin) in [
        ("clips[0].lower", "--set walk.clips=[]"),
        ("steps", "preset walk"),
    ] {
        let message = config
            .refuse("walk", path, format!("{path} = 1"))
            .to_string();
        assert!(
            message.starts_with(&format!("{origin}: [walk] {path} = 1")),
            "{message}"
        );
    }
}

#[test]
fn bad_toml_names_file_and_line() {
    let error = Config::parse("[walk]\nspeed = = 1", "my.toml")
        .unwrap_err()
        .to_string();
    assert!(
        error.contains("my.toml") && error.contains("line 2"),
        "{error}"
    );
}

#[test]
fn the_resolved_file_reads_back_as_the_same_values() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("config.toml");
    let mut given =
        config("[walk]\nclips = [{ upper = 0.3 }]\nmethod = { amp = { style_weight = 0.1 } }");
    let walk: Walk = given.section().unwrap();
    given.resolve(&walk);
    given.resolve(&RunConfig::default());
    given.resolve(&FleetConfig::default());
    given.write(&path, "Made by a test.").unwrap();

    let text = std::fs::read_to_string(&path).unwrap();
    assert!(text.starts_with("# Made by a test.\n"), "{text}");
    assert!(
        text.contains("speed = 0.95\n"),
        "an f32 keeps its own digits: {text}"
    );
    let back = Config::read(&path).unwrap();
    assert_eq!(back.section::<Walk>().unwrap(), walk);
    assert_eq!(back.section::<RunConfig>().unwrap(), RunConfig::default());
    assert_eq!(
        back.section::<FleetConfig>().unwrap(),
        FleetConfig::default()
    );
}

#[test]
fn a_key_without_a_section_belongs_to_the_run() {
    let mut config = config("");
    config.set("seed=7").unwrap();
    config.set("mode=overlapped").unwrap();
    config.put("run.iterations", 50, "--iterations 50");
    let run: RunConfig = config.section().unwrap();
    assert_eq!(
        (run.seed, run.mode, run.iterations),
        (7, Mode::Overlapped, 50)
    );
    config.set("sed=7").unwrap();
    let message = config.section::<RunConfig>().unwrap_err().to_string();
    assert!(
        message.starts_with("--set sed=7: unknown key `sed` in [run]"),
        "{message}"
    );
    assert!(message.contains("`seed`"), "{message}");
}

/// In one line, short, without what a terminal would obey and without a long run of the content.
fn assert_short(said: &str) {
    assert!(said.chars().count() < 900, "{said:.1000}");
    assert!(!said.contains(char::is_control), "{said:?}");
    assert!(!said.contains(&"A".repeat(101)), "{said}");
}

#[test]
fn a_file_that_is_no_configuration_is_named_and_not_echoed() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("mine.toml");
    let refused = |bytes: &[u8]| {
        std::fs::write(&path, bytes).unwrap();
        Config::read(&path).unwrap_err().to_string()
    };
    let long = "A".repeat(1_800_000);
    let pointer = refused(b"version https://git-lfs.github.com/spec/v1\noid sha256:4d7a\n");
    assert!(
        pointer.contains("mine.toml") && pointer.contains("a Git LFS pointer"),
        "{pointer}"
    );
    let page = refused(format!("<!DOCTYPE html>{long}").as_bytes());
    assert!(page.contains("a web page (HTML)"), "{page}");
    let picture = refused(b"\x89PNG\r\n\x1a\n\xff");
    assert!(picture.contains("a picture (PNG)"), "{picture}");
    let empty_value = refused(b"[run]\nseed =\n");
    // TOML expects a value behind the sign of equality: column 7 of the second line.
    assert!(empty_value.contains("line 2, column 7: "), "{empty_value}");
    assert!(empty_value.ends_with(", in \"seed =\""), "{empty_value}");
    for hostile in [
        long.clone(),
        format!("[run]\nseed = {long}"),
        format!("[run]\nseed = \"{long}"),
        format!("a = 1\n\"{long}\" = 2\n\"{long}\" = 3"),
        "\x1b[2J".repeat(100_000),
    ] {
        assert_short(&refused(hostile.as_bytes()));
    }
}

#[test]
fn a_value_of_megabytes_is_refused_in_a_line() {
    let long = "A".repeat(1_800_000);
    for text in [
        format!("[walk]\nspeed = \"{long}\""),
        format!("[walk]\n{long} = 1"),
        format!("[walk]\nmethod = \"{long}\""),
        format!("[walk.limit]\n\"{long}\\u001b\" = 1"),
        "[walk]\nspeed = \"\\u001b[2J\"".to_owned(),
    ] {
        assert_short(&config(&text).section::<Walk>().unwrap_err().to_string());
    }
    let unknown = config(&format!("[{long}]\nx = 1"));
    assert_short(&unknown.check_sections(&["walk"]).unwrap_err().to_string());
    let mut given = config("");
    assert_short(&given.set(&format!("{long}.=1")).unwrap_err().to_string());
}

#[test]
fn a_table_over_a_word_is_blamed_on_who_gave_it() {
    let mut config = Config::parse("[walk]\nmethod = \"plain\"", "a file").unwrap();
    config.set("walk.method.plain.alpha=0.5").unwrap();
    let error = config.section::<Walk>().unwrap_err().to_string();
    assert!(
        error.contains("--set walk.method.plain.alpha=0.5"),
        "{error}"
    );
    assert!(!error.contains("a file"), "{error}");
}

#[test]
fn a_configuration_has_settled_when_its_last_ramp_has_arrived() {
    let settled = |text: &str| {
        Config::parse(text, "a test")
            .unwrap()
            .settled_but(&["fleet"])
    };
    let ramps = "[ppo]\nmirrored_share = { from = 0.5, to = 0.0, samples = [1, 1300000] }\n\
                 [task.start]\nreference_share = { from = 1.0, to = 0.25, samples = [1.5e6, 2.1e6] }\n";
    assert_eq!(settled(ramps), 2.1e6);
    let of_fleet = "[fleet]\nx = { from = 0.0, to = 1.0, samples = [1e6, 9e6] }\n";
    assert_eq!(settled(&format!("{ramps}{of_fleet}")), 2.1e6);
    // What is called samples elsewhere is no ramp.
    assert_eq!(settled("[bench]\nsamples = [1, 2]\n"), 0.0);
}

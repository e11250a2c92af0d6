//! Values of the wrong kind or size, told in words of TOML with what the place would take.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use run::Config;
use vocabulary::{Checked, Ramp, Section};

#[derive(Clone, Debug, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
struct Hike {
    steps: usize,
    few: u32,
    speed: f32,
    seconds: f64,
    stop: bool,
    widths: Vec<usize>,
    pair: [f32; 2],
    kernel: Ramp<f32>,
    forward: Ramp<[f32; 2]>,
    row: Option<Row>,
    rows: Vec<Row>,
    method: Method,
}

#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct Row {
    range: [f32; 2],
    #[serde(default)]
    name: String,
}

#[derive(Clone, Debug, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
enum Method {
    #[default]
    Plain,
    Amp {
        style_weight: f32,
    },
}

impl Section for Hike {
    const NAME: &'static str = "hike";

    fn validate(&self) -> Checked {
        Ok(())
    }
}

fn said(text: &str) -> String {
    let config = Config::parse(text, "my.toml").unwrap();
    config.section::<Hike>().unwrap_err().to_string()
}

#[test]
fn every_kind_is_asked_for_in_words_of_toml() {
    let whole = "give a whole number from 0 on";
    for (line, remedy) in [
        ("steps = -1", whole),
        ("steps = 1.5", whole),
        ("steps = 'many'", whole),
        // 2³², one too many.
        (
            "few = 4294967296",
            "give a whole number from 0 to 4294967295",
        ),
        ("speed = 'fast'", "give a number"),
        ("speed = [1.0]", "give a number"),
        ("stop = 1", "give true or false"),
        ("widths = 3", "give a list, in square brackets"),
        ("widths = [-3]", whole),
        ("pair = 3", "give a list of 2 values"),
        ("pair = [1]", "give a list of 2 values"),
        ("pair = [1, 2, 3]", "give a list of 2 values"),
        ("kernel = true", "give a number, or { from = "),
        ("forward = 'far'", "give a list of 2 numbers, or { from = "),
        (
            "kernel = { from = 1.0, to = 2.0, samples = 3 }",
            "give a list of 2 values",
        ),
        (
            "kernel = { from = 1.0, samples = [0, 1] }",
            "`to` is missing",
        ),
        ("row = 3", "give a table of keys: `range`, `name`"),
        ("row = {}", "`range` is missing; give it as well"),
        (
            "row = { range = [0, 1], name = 3 }",
            "give text in quotation marks",
        ),
        ("rows = [3]", "give a table of keys: `range`, `name`"),
        ("method = 3", "name one choice: `plain`, `amp`"),
        ("method = {}", "name one choice: `plain`, `amp`"),
        (
            "method = { plain = {}, amp = {} }",
            "name one choice: `plain`, `amp`",
        ),
        (
            "method = 'amp'",
            "`amp` has parameters: give it a table of `style_weight`",
        ),
        (
            "method = { amp = 3 }",
            "`amp` has parameters: give it a table of `style_weight`",
        ),
    ] {
        let said = said(&format!("[hike]\n{line}"));
        let key = line.split(' ').next().unwrap();
        let named = said.starts_with(&format!("my.toml: `{key}"));
        assert!(named && said.contains(remedy), "{line}: {said}");
        for word in [
            "usize", "u32", "f32", "struct", "sequence", "variant", "invalid", "expected", "(none)",
        ] {
            assert!(!said.contains(word), "{line}: {said}");
        }
    }
    let whole = said("hike = 3");
    assert!(
        whole.starts_with("my.toml: `hike` = 3 in [hike]: give a table of keys: `steps`, "),
        "{whole}"
    );
}

#[test]
fn a_number_beyond_those_of_the_program_is_told_as_it_was_written() {
    for (line, value, remedy) in [
        ("speed = 1e300", "1e300", "too large"),
        ("seconds = -1e300", "-1e300", "too large"),
        ("pair = [0.0, 4e38]", "4e38", "too large"),
        ("row = { range = [1e39, 1.0] }", "1e39", "too large"),
        ("speed = 1e-300", "1e-300", "too small"),
    ] {
        let said = said(&format!("[hike]\n{line}"));
        assert!(
            said.contains(&format!(" = {value} in")) && said.contains(remedy),
            "{line}: {said}"
        );
        assert!(!said.contains("inf"), "{said}");
    }
    let fits = "[hike]\nspeed = 3e38\nseconds = 0.0\npair = [-0.0, 1.2e-38]\nkernel = inf";
    Config::parse(fits, "my.toml")
        .unwrap()
        .section::<Hike>()
        .unwrap();
}

#[test]
fn what_a_preset_says_of_presets_stands_above_its_sections() {
    let said = said("[hike]\nsteps = 3\nunset = ['hike.rows']");
    assert!(
        said.contains("`unset` in [hike]") && said.contains("above the first [section]"),
        "{said}"
    );
}

#[test]
fn what_an_empty_table_lacks_is_told_of_who_gave_the_table() {
    let mut config =
        Config::parse("[hike]\nrow = { range = [0, 1] }\nsteps = 3", "a file").unwrap();
    config.set("hike.row={}").unwrap();
    let said = config.section::<Hike>().unwrap_err().to_string();
    assert!(
        said.starts_with("--set hike.row={}: `row` = {} in [hike]: `range` is missing"),
        "{said}"
    );
}

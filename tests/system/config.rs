//! `ampco config`: what it prints can be read again, runs of older programs are understood, mistakes are named.

use std::fs;
use std::process::{Command, Stdio};

use serde_json::Value;

use crate::harness::{Runs, finish, program};

/// A run's configuration in the words of an older program.
const OLDER: &str = "[task]\nphysics = \"batched\"\n\
    [randomization]\nfriction = true\nfriction_range = [0.6, 0.9]\n\
    mass_variation = false\nmass_range = [-0.5, 0.5]\n\
    [ppo]\nkl_band = 1.5\nepochs = 7\n";

struct Config(Runs);

impl Config {
    fn new() -> Self {
        Self(Runs::new())
    }

    /// What `ampco config` says and complains of.
    fn run(&self, arguments: &[&str]) -> (bool, String, String) {
        let mut command = Command::new(program("ampco"));
        command.arg("config").args(arguments);
        command.current_dir(self.0.path());
        command.arg("--runs-dir").arg(self.0.path());
        finish(command)
    }

    fn said(&self, arguments: &[&str]) -> String {
        let (success, said, complaint) = self.run(arguments);
        assert!(success, "{arguments:?}: {complaint}");
        said
    }

    fn refused(&self, arguments: &[&str]) -> String {
        let (success, said, complaint) = self.run(arguments);
        assert!(!success && said.is_empty(), "{arguments:?}: {said}");
        complaint
    }

    fn write(&self, name: &str, text: &str) -> String {
        let path = self.0.run(name);
        fs::create_dir_all(path.parent().expect("a folder")).expect("made");
        fs::write(&path, text).expect("written");
        path.display().to_string()
    }
}

#[test]
fn what_is_printed_is_a_preset_of_the_same_values() {
    let config = Config::new();
    let printed = config.said(&["g1"]);
    for part in [
        "# Sharpness k, s²/m².\nkernel = { from = 2.0, to = 4.0, samples = [1500000.0, 2100000.0] } # s²/m²; preset recipe\n",
        "window = 400 # preset g1\n",
        "percentile = 0.95 # default\n",
    ] {
        assert!(printed.contains(part), "{part}\n{printed}");
    }
    let file = config.write("again.toml", &printed);
    let same = config.said(&[&file, "--diff", "g1"]);
    assert!(
        same.ends_with("and preset g1 do not differ.\non = \"g1\"\n"),
        "{same}"
    );
}

#[test]
fn a_difference_is_a_preset_on_the_other() {
    let config = Config::new();
    for (one, other) in [
        ("ampco", "g1"),
        ("g1", "ampco"),
        ("recipe", "ampco-literal"),
        ("ampco-literal", "recipe"),
        ("amp-roger", "smoke"),
        ("amp-0.5", "ampco"),
    ] {
        let file = config.write("between.toml", &config.said(&[one, "--diff", other]));
        let same = config.said(&[&file, "--diff", one]);
        assert!(same.contains("do not differ"), "{one}, {other}: {same}");
    }
}

#[test]
fn two_configurations_are_told_apart_key_by_key() {
    let config = Config::new();
    config.write(
        "mine.toml",
        "on = \"smoke\"\nunset = [\"fleet.actors\"]\n[ppo]\nepochs = 3\n",
    );
    let told = config.said(&["mine.toml", "--diff", "smoke"]);
    let mut lines: Vec<&str> = told
        .lines()
        .filter(|line| line.contains(" = ") && !line.starts_with('#'))
        .collect();
    assert_eq!(lines.len(), 3, "{told}");
    assert_eq!(lines.remove(0), "on = \"smoke\"");
    assert!(lines[0].starts_with("actors = 0 # default"), "{told}");
    assert!(
        lines[1].starts_with("epochs = 3 # ") && lines[1].ends_with("mine.toml"),
        "{told}"
    );
    assert!(
        told.contains("# in preset smoke: 2, preset smoke\n"),
        "{told}"
    );
}

#[test]
fn a_run_of_an_older_program_is_understood_and_told_from_a_preset() {
    let config = Config::new();
    config.write("old/config.toml", OLDER);
    let json = config.said(&["old", "--diff", "ampco-literal", "--json"]);
    let json: Value = serde_json::from_str(&json).expect("JSON");
    let entry = |key: &str| {
        let keys = json["keys"].as_array().expect("a list");
        keys.iter()
            .find(|entry| entry["key"] == key)
            .cloned()
            .unwrap_or_default()
    };
    assert_eq!(entry("fleet.physics")["value"], "batched");
    assert_eq!(entry("fleet.physics")["other"], "rapier");
    assert_eq!(entry("fleet.physics")["origin"], "run old");
    assert_eq!(entry("ppo.epochs")["value"], 7);
    let friction = entry("randomization.friction.range");
    assert_eq!(friction["value"], serde_json::json!([0.6, 0.9]));
    assert_eq!(friction["other_origin"], "preset ampco-literal");
    let mass = entry("randomization.mass_variation.range");
    assert_eq!(
        (&mass["value"], &mass["unit"]),
        (&Value::Null, &"kg".into())
    );
    // The folder's name says whose it is.
    let told = config.said(&["old"]);
    assert!(told.contains("physics = \"batched\" # run old"), "{told}");
    // Written by a person, the same words are refused with today's.
    let file = config.write("old.toml", OLDER);
    let said = config.refused(&[&file]);
    assert!(
        said.contains("old.toml") && said.contains("fleet.physics = \"batched\""),
        "{said}"
    );
}

#[test]
fn mistakes_are_named_with_what_was_meant() {
    let config = Config::new();
    config.write("walk-1/config.toml", "");
    config.write("a.toml", "on = \"b.toml\"");
    config.write("b.toml", "on = \"a.toml\"");
    config.write("gone.toml", "[ppo]\nkl_band = 2.0");
    config.write("deep/other.toml", "");
    config.write("picture.toml", "GIF8");
    for (arguments, parts) in [
        (
            &["reciep"][..],
            ["no preset, no file and no run `reciep`", "`recipe`"],
        ),
        (&["walk-2"], ["no run `walk-2`", "`walk-1`"]),
        (
            &["g1", "--diff", "smok"],
            ["`smok`", "did you mean `smoke`"],
        ),
        (&["a.toml"], ["circle", "b.toml on"]),
        (&["gone.toml"], ["kl_band", "always 1.5"]),
        (&["./nowhere"], ["nowhere", "is not a folder"]),
        (&[""], ["name of the preset is empty", "a file"]),
        (
            &["deep"],
            ["`deep` is a folder without config.toml", "TOML file"],
        ),
        (&["./deep"], ["`./deep` is a folder", "a run's name"]),
        (
            &["/dev/null"],
            ["`/dev/null` is no file", "standard input, as `-`"],
        ),
        (&["picture.toml"], ["picture.toml", "a picture (GIF)"]),
    ] {
        let said = config.refused(arguments);
        assert!(parts.iter().all(|part| said.contains(part)), "{said}");
        assert_eq!(said.lines().count(), 1, "{said}");
    }
}

#[test]
fn what_is_taken_of_several_of_one_name_is_told() {
    let config = Config::new();
    let told = |name: &str| {
        let (success, said, told) = config.run(&[name]);
        assert!(success, "{told}");
        (said.lines().next().unwrap_or_default().to_owned(), told)
    };
    config.write("smoke/config.toml", "[ppo]\nepochs = 9");
    let run = config.0.run("smoke").display().to_string();
    let (said, other) = told("smoke");
    assert!(said.starts_with("# preset smoke: "), "{said}");
    assert_eq!(
        other,
        format!("`smoke` is the preset here; the run is {run}\n")
    );
    assert!(told(&run).0.starts_with("# run smoke: "));
    config.write("g1", "on = \"smoke\"");
    let (said, other) = told("g1");
    assert!(said.starts_with("# preset g1: "), "{said}");
    assert_eq!(other, "`g1` is the preset here; the file is ./g1\n");
    let (said, other) = told("./g1");
    assert!(said.contains("/g1: ") && other.is_empty(), "{said} {other}");
}

#[test]
fn a_preset_is_read_from_standard_input_and_one_that_says_nothing_is_told() {
    let config = Config::new();
    let file = config.write("in.toml", "on = \"smoke\"\n[ppo]\nepochs = 9\n");
    let mut command = Command::new(program("ampco"));
    command.args(["config", "-", "--diff", "smoke"]);
    command.stdin(fs::File::open(file).expect("opened"));
    let output = command.output().expect("ended");
    let said = String::from_utf8_lossy(&output.stdout);
    assert!(
        output.status.success() && said.contains("epochs = 9 # standard input"),
        "{said}"
    );
    config.write("comment.toml", "# [ppo]");
    let (success, _, told) = config.run(&["comment.toml"]);
    assert!(
        success && told.contains("comment.toml: nothing is set in it"),
        "{told}"
    );
}

#[test]
fn keys_are_counted() {
    let config = Config::new();
    let count: usize = config.said(&["--count"]).trim().parse().expect("a number");
    assert!((60..=110).contains(&count), "{count} keys");
    let json: Value = serde_json::from_str(&config.said(&["--count", "--json"])).expect("JSON");
    assert_eq!(json["keys"], count);
    let of = |name| {
        config
            .said(&[name, "--count"])
            .trim()
            .parse::<usize>()
            .expect("a number")
    };
    // A preset has no keys of terms that it does not list.
    assert!(of("ampco") < count && of("smoke") < count);
    assert_eq!(config.said(&["g1", "--diff", "g1", "--count"]).trim(), "0");
}

#[test]
fn a_reader_that_has_seen_enough_is_no_failure() {
    let mut child = Command::new(program("ampco"))
        .args(["config", "g1"])
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("started");
    drop(child.stdout.take());
    let output = child.wait_with_output().expect("ended");
    assert!(output.status.success() && output.stderr.is_empty());
}

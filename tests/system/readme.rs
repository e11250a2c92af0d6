//! The README's commands, in the order in which they stand, on what a fresh clone is.
//!
//! Each is made short and otherwise given as it is. What a reader must bring (motion of his own) or would wait for (a study)
//! is not run, nor is what needs that.

use std::collections::BTreeSet;
use std::fs;
use std::os::unix::fs::symlink;
use std::path::Path;
use std::process::Command;

use crate::harness::{Runs, finish, program, repository};

#[path = "../shell.rs"]
mod shell;

/// A command to be run, or why it is not.
#[derive(Debug, PartialEq)]
enum Plan {
    Run(Vec<String>),
    /// It would have made these.
    Not(Vec<String>),
}

/// Sets an option's value, or adds it.
fn put(arguments: &mut Vec<String>, option: &str, value: &str) {
    match arguments.iter().position(|word| word == option) {
        Some(at) => arguments[at + 1] = value.to_owned(),
        None => arguments.extend([option.to_owned(), value.to_owned()]),
    }
}

fn value<'a>(arguments: &'a [String], option: &str) -> Option<&'a str> {
    let at = arguments.iter().position(|word| word == option)?;
    arguments.get(at + 1).map(String::as_str)
}

/// The same command in a second or two. `trained` is how many trainings came before, `missing` what was not made.
fn plan(arguments: &[String], place: &Path, trained: u32, missing: &BTreeSet<String>) -> Plan {
    let mut short = arguments.to_vec();
    let made = || {
        Plan::Not(
            value(arguments, "--out")
                .map(str::to_owned)
                .into_iter()
                .collect(),
        )
    };
    let needs_missing = arguments.iter().any(|word| {
        let quoted = word.split('"').nth(1).unwrap_or(word);
        missing.contains(word) || missing.contains(quoted)
    });
    let placeholder =
        |word: &String| word.len() > 1 && word.chars().all(|c| c.is_ascii_uppercase() || c == '…');
    if needs_missing || arguments.iter().any(placeholder) {
        return made();
    }
    match arguments[0].as_str() {
        "train" => {
            if value(&short, "--preset").is_none() && !short.iter().any(|word| word == "--resume") {
                put(&mut short, "--preset", "smoke");
            }
            if let Some(at) = short.iter().position(|word| word == "--minutes") {
                short.drain(at..at + 2);
            }
            put(&mut short, "--iterations", &(2 * (trained + 1)).to_string());
            put(&mut short, "--actors", "1");
            // The first shows that they can be drawn.
            let plain = "--no-pictures".to_owned();
            if trained > 0 && !short.contains(&plain) {
                short.push(plain);
            }
        }
        "evaluate" => {
            put(&mut short, "--seconds", "0.04");
            put(&mut short, "--episodes", "1");
        }
        "play" => put(&mut short, "--seconds", "0.1"),
        "stages" if short.len() > 1 => short.push("--dry-run".to_owned()),
        "study" if short[1] == "run" => {
            let stem = Path::new(&short[2])
                .file_stem()
                .unwrap_or_default()
                .to_string_lossy();
            let folder = value(&short, "--out").map_or(format!("studies/{stem}"), str::to_owned);
            return Plan::Not(vec![folder]);
        }
        "motions" if short[1] == "import" && !place.join(&short[2]).exists() => return made(),
        // They take their time, or a second terminal.
        "bench" | "judge" | "soak" | "actor" | "join" => return made(),
        _ => {}
    }
    Plan::Run(short)
}

#[test]
fn the_commands_of_the_readme_work_in_their_order() {
    let place = Runs::new();
    symlink(repository().join("deploy"), place.path().join("deploy")).expect("a link");
    let readme = fs::read_to_string(repository().join("README.md")).expect("the README");
    let (mut missing, mut trained, mut ran) = (BTreeSet::new(), 0, 0);
    for command in shell::commands(&readme)
        .into_iter()
        .filter(|command| command.typed)
    {
        let Some(arguments) = shell::arguments(&command.words).filter(|words| !words.is_empty())
        else {
            continue;
        };
        match plan(&arguments, place.path(), trained, &missing) {
            Plan::Not(makes) => missing.extend(makes),
            Plan::Run(short) => {
                trained += u32::from(short[0] == "train");
                let mut ampco = Command::new(program("ampco"));
                ampco.args(&short).current_dir(place.path());
                let (success, _, said) = finish(ampco);
                let (line, given, short) = (command.line, command.words.join(" "), short.join(" "));
                assert!(
                    success,
                    "README.md line {line}, {given} (as ampco {short}): {said}"
                );
                ran += 1;
            }
        }
    }
    assert!(ran >= 8, "only {ran} commands were run");
}

#[test]
fn commands_are_shortened_and_otherwise_left_as_they_are() {
    let place = Runs::new();
    let missing = BTreeSet::from(["walks".to_owned()]);
    let of = |line: &str| {
        let words: Vec<String> = shlex::split(line).expect("words");
        plan(&words, place.path(), 1, &missing)
    };
    let run = |line: &str| Plan::Run(shlex::split(line).expect("words"));
    assert_eq!(
        of("train --run x --minutes 20"),
        run("train --run x --preset smoke --iterations 4 --actors 1 --no-pictures")
    );
    assert_eq!(
        of("evaluate x --episodes 32"),
        run("evaluate x --episodes 1 --seconds 0.04")
    );
    assert_eq!(of("plot x"), run("plot x"));
    assert_eq!(of("motions check walks"), Plan::Not(Vec::new()));
    assert_eq!(
        of("train --set 'motion.clips=[{folder=\"walks\"}]'"),
        Plan::Not(Vec::new())
    );
    assert_eq!(
        of("motions import CMU/02 --out w"),
        Plan::Not(vec!["w".to_owned()])
    );
    assert_eq!(
        of("study run a/b.toml"),
        Plan::Not(vec!["studies/b".to_owned()])
    );
}

//! Every command that a README or a help text shows can be typed: it parses, its keys and presets exist, and so do the
//! files of the repository that it names.

use std::path::{Path, PathBuf};

use clap::CommandFactory;
use clap::error::ErrorKind;
use configuration::{presets, resolve};

use super::*;

#[path = "../../../tests/shell.rs"]
mod shell;

fn repository() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// Every README of the repository: its folder, its name for messages, its text.
fn readmes() -> Vec<(PathBuf, String, String)> {
    fn search(folder: &Path, found: &mut Vec<PathBuf>) {
        for entry in std::fs::read_dir(folder).unwrap().flatten() {
            let (path, name) = (entry.path(), entry.file_name());
            if name == "README.md" {
                found.push(path);
            } else if path.is_dir() && name != "target" && !name.to_string_lossy().starts_with('.')
            {
                search(&path, found);
            }
        }
    }
    // What is ours: a checkout may hold runs and data of its user.
    let mut found = vec![repository().join("README.md")];
    for folder in FOLDERS {
        search(&repository().join(folder), &mut found);
    }
    let of = |path: PathBuf| {
        let name = path
            .strip_prefix(repository())
            .unwrap()
            .display()
            .to_string();
        let text = std::fs::read_to_string(&path).unwrap();
        (path.parent().unwrap().to_owned(), name, text)
    };
    found.into_iter().map(of).collect()
}

/// The folders of the repository.
const FOLDERS: [&str; 6] = [
    "deploy",
    "tests",
    "learner",
    "actor",
    "protocol",
    "scheduler",
];

/// What is wrong with the arguments of a command. One within a sentence may leave out what the sentence is not about.
fn complaint(arguments: &[String], typed: bool) -> Option<String> {
    let given = std::iter::once("ampco").chain(arguments.iter().map(String::as_str));
    let command = match Arguments::try_parse_from(given) {
        Ok(arguments) => arguments.command,
        Err(error) => {
            let partial = matches!(
                error.kind(),
                ErrorKind::MissingRequiredArgument
                    | ErrorKind::MissingSubcommand
                    | ErrorKind::DisplayHelpOnMissingArgumentOrSubcommand
            );
            // `ampco play --json` of a sentence.
            let partial = partial || error.to_string().contains("a value is required for");
            let help = matches!(
                error.kind(),
                ErrorKind::DisplayHelp | ErrorKind::DisplayVersion
            );
            return (!help && (typed || !partial)).then(|| error.to_string());
        }
    };
    // A preset of a run that is still to be made is not there yet.
    let named = |option: &str| {
        let at = arguments.iter().position(|word| word == option)?;
        let name = arguments.get(at + 1)?;
        (!name.starts_with("runs/") && !is_placeholder(name)).then_some(name.as_str())
    };
    let found = presets::find(named("--preset").unwrap_or("ampco"));
    let mut config = match found {
        Ok(preset) => preset.config,
        Err(error) => return Some(format!("{error:#}")),
    };
    for pair in arguments.windows(2).filter(|pair| pair[0] == "--set") {
        let (key, value) = pair[1].split_once('=').unwrap_or((&pair[1], ""));
        if is_placeholder(value) || is_placeholder(key) || key == "key" {
            continue;
        }
        if let Err(error) = config.set(&pair[1]) {
            return Some(format!("{error:#}"));
        }
    }
    if let Err(error) = resolve::resolve(&mut config) {
        return Some(format!("{error:#}"));
    }
    if let (Command::Stages(_), Some(name)) = (&command, arguments.get(1))
        && !name.starts_with('-')
        && let Err(error) = stages::check(name)
    {
        return Some(format!("{error:#}"));
    }
    None
}

/// A word that a reader replaces by one of his own: `FILE`, `N`, `NAME|FILE`, `FILE…`.
fn is_placeholder(word: &str) -> bool {
    !word.is_empty()
        && word
            .chars()
            .all(|c| c.is_ascii_uppercase() || "|…,/".contains(c))
}

/// A path of the repository that a word names, without the signs around it.
fn path(word: &str) -> Option<&str> {
    let path = word.split(['=', ':']).next_back()?;
    let plain = |c: char| c.is_ascii_alphanumeric() || "/._-".contains(c);
    let (first, rest) = path.split_once('/')?;
    (FOLDERS.contains(&first) && !rest.is_empty() && path.chars().all(plain)).then_some(path)
}

#[test]
fn every_command_of_a_readme_can_be_typed() {
    let mut wrong = Vec::new();
    let mut parsed = 0;
    for (_, readme, text) in readmes() {
        for command in shell::commands(&text) {
            let shown = format!(
                "{readme} line {}, {}",
                command.line,
                command.words.join(" ")
            );
            for path in command.words.iter().filter_map(|word| path(word)) {
                if !repository().join(path).exists() {
                    wrong.push(format!("{shown}: there is no {path}"));
                }
            }
            let is_word = command.words.len() == 1;
            let arguments = shell::arguments(&command.words);
            let Some(arguments) = arguments.filter(|_| command.typed || !is_word) else {
                continue;
            };
            parsed += 1;
            if let Some(words) = complaint(&arguments, command.typed) {
                wrong.push(format!("{shown}: {words}"));
            }
        }
    }
    assert!(parsed >= 20, "only {parsed} commands were found");
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn every_link_of_a_readme_leads_somewhere() {
    let mut links = 0;
    for (folder, readme, text) in readmes() {
        for rest in text.split("](").skip(1) {
            let link = rest.split(')').next().unwrap_or_default();
            let path = link.split('#').next().unwrap_or_default();
            if link.contains("://") || path.is_empty() {
                continue;
            }
            links += 1;
            assert!(folder.join(path).exists(), "{readme}: there is no {path}");
        }
    }
    assert!(links > 0);
}

#[test]
fn scripts_know_the_options_that_a_readme_gives_them() {
    for (_, readme, text) in readmes() {
        for command in shell::commands(&text) {
            let Some((program, arguments)) = command.words.split_first() else {
                continue;
            };
            if !(program.starts_with("deploy/") && program.ends_with(".py")) {
                continue;
            }
            let read = |path: PathBuf| std::fs::read_to_string(path).unwrap();
            let mut script = read(repository().join(program));
            if script.contains("from transfer") {
                let modules = std::fs::read_dir(repository().join("deploy/transfer")).unwrap();
                let paths = modules.map(|entry| entry.unwrap().path());
                let python = paths.filter(|path| path.extension().is_some_and(|end| end == "py"));
                script.extend(python.map(read));
            }
            for option in arguments.iter().filter(|word| word.starts_with("--")) {
                let known = script.contains(&format!("\"{option}\""));
                assert!(known, "{readme}: {program} does not know {option}");
            }
        }
    }
}

/// The examples in the help of a command and of those below it.
fn examples(command: &clap::Command, found: &mut Vec<String>) {
    let texts = [
        command.get_after_help(),
        command.get_long_about(),
        command.get_about(),
    ];
    for text in texts.into_iter().flatten() {
        let text = text.to_string();
        let lines = text
            .lines()
            .filter_map(|line| line.strip_prefix("  ampco "));
        // What is behind two spaces says what the command does.
        found.extend(lines.map(|line| line.split("  ").next().unwrap_or_default().to_owned()));
    }
    for command in command.get_subcommands() {
        examples(command, found);
    }
}

#[test]
fn every_example_of_the_help_can_be_typed() {
    let mut found = Vec::new();
    examples(&Arguments::command(), &mut found);
    assert!(found.len() >= 15, "{found:?}");
    for example in found {
        let words = shlex::split(&example).unwrap();
        assert_eq!(complaint(&words, true), None, "ampco {example}");
        for path in words.iter().filter_map(|word| path(word)) {
            assert!(
                repository().join(path).exists(),
                "ampco {example}: there is no {path}"
            );
        }
    }
}

#[test]
fn what_cannot_be_typed_is_noticed() {
    let complaint = |text: &str| complaint(&shlex::split(text).unwrap(), true);
    assert_eq!(complaint("train --preset smoke --set seed=7"), None);
    assert!(complaint("train --preset smke").unwrap().contains("smoke"));
    assert!(
        complaint("train --set ppo.gama=0.9")
            .unwrap()
            .contains("gamma")
    );
    assert!(complaint("train --minuts 3").is_some());
    assert!(complaint("evaluate").is_some());
    assert!(complaint("stages athlet").is_some());
    assert_eq!(path("--preset=deploy/x.toml"), Some("deploy/x.toml"));
    assert_eq!(path("runs/x"), None);
}

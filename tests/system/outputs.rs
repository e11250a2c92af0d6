//! Where results go: to files by bare names, and to readers that have seen enough.

use std::fs;
use std::path::Path;
use std::process::{Command, Output, Stdio};

use crate::harness::{Runs, finish, program, repository};

/// A run with a line of metrics, in `runs/` of a folder.
fn run_with_metrics(folder: &Path, name: &str) {
    let run = run::Folder::create(&folder.join("runs"), name).expect("a folder");
    fs::write(run.config_path(), "").expect("written");
    let mut metrics = run::Metrics::open(&run.metrics_path()).expect("a file");
    let record = serde_json::json!({ "iteration": 1, "samples": 100, "rmse": 0.5 });
    metrics.append(&record).expect("written");
}

/// Commands that print and write, with what each writes, from a folder with a run and clips. All names are bare.
fn commands() -> Vec<(Vec<String>, Vec<&'static str>)> {
    let policy = repository()
        .join("deploy/policies/walk")
        .display()
        .to_string();
    let study = repository()
        .join("deploy/studies/smoke.toml")
        .display()
        .to_string();
    let of = |line: &str, written: &[&'static str]| {
        let words = line.split(' ').map(|word| match word {
            "POLICY" => policy.clone(),
            "STUDY" => study.clone(),
            word => word.to_owned(),
        });
        (words.collect(), written.to_vec())
    };
    vec![
        of("stages", &[]),
        of("status one --json", &[]),
        of("plot one --out two.svg", &["two.svg"]),
        of(
            "play walk:0.8 --seconds 0.1 --html gait.html --json gait.json",
            &["gait.html", "gait.json"],
        ),
        of(
            "play POLICY --seconds 0.1 --html policy.html",
            &["policy.html"],
        ),
        of(
            "export POLICY --out exported",
            &["exported/policy.onnx", "exported/policy.json"],
        ),
        of(
            "export POLICY --ship --out shipped",
            &["shipped/policy.bin", "shipped/config.toml"],
        ),
        of("export --mjcf --out robot", &["robot/g1.xml"]),
        of("export --mjcf", &[]),
        of(
            "motions synth --walk 1.0 --seconds 1 --out made",
            &["made/walk_1.00.csv"],
        ),
        of(
            "motions import clips --out imported",
            &["imported/walk_1.00.csv", "imported/walk_1.00.json"],
        ),
        of(
            "motions inspect clips --plots figures",
            &["figures/walk_1.00.svg"],
        ),
        of(
            "motions mirror clips --out mirrored",
            &["mirrored/walk_1.00_mirrored.csv"],
        ),
        of("motions check clips", &[]),
        of(
            "evaluate POLICY --seconds 0.1 --episodes 1 --out judged",
            &["judged/report.json", "judged/report.md"],
        ),
        of(
            "bench fidelity --robots 1 --cases cases.json",
            &["cases.json"],
        ),
        of("study run STUDY --dry-run", &[]),
    ]
}

/// A folder in which all of [`commands`] can be given.
fn workplace() -> Runs {
    let place = Runs::new();
    run_with_metrics(place.path(), "one");
    let clip = motion::gait::walk(1.0).expect("a gait").unrolled(2.0);
    fs::create_dir(place.path().join("clips")).expect("made");
    let table = motion::export::to_csv(&clip, &[]);
    fs::write(place.path().join("clips/walk_1.00.csv"), table).expect("written");
    place
}

fn assert_written(place: &Path, arguments: &[String], written: &[&str]) {
    for name in written {
        let length = fs::metadata(place.join(name)).map_or(0, |facts| facts.len());
        assert!(
            length > 0,
            "ampco {}: {name} is not there",
            arguments.join(" ")
        );
    }
}

#[test]
fn bare_names_are_files_of_the_present_folder() {
    let place = workplace();
    for (arguments, written) in commands() {
        let mut command = Command::new(program("ampco"));
        command.args(&arguments).current_dir(place.path());
        let (success, _, said) = finish(command);
        assert!(success, "ampco {}: {said}", arguments.join(" "));
        assert_written(place.path(), &arguments, &written);
    }
    // Drafts are gone.
    let names = fs::read_dir(place.path()).expect("readable");
    let drafts = names
        .flatten()
        .filter(|entry| entry.file_name().to_string_lossy().ends_with(".new"));
    assert_eq!(drafts.count(), 0);
}

#[test]
fn a_folder_that_is_not_there_is_named_before_any_work() {
    let place = workplace();
    for line in [
        "plot one --out no/two.svg",
        "play walk:0.8 --html no/page.html",
    ] {
        let mut command = Command::new(program("ampco"));
        command.args(line.split(' ')).current_dir(place.path());
        let (success, _, said) = finish(command);
        assert!(
            !success && said.contains("there is no folder no; make it first"),
            "{line}: {said}"
        );
    }
}

/// Runs `ampco` with standard output going somewhere.
fn into(place: &Path, arguments: &[String], stdout: impl Into<Stdio>) -> Output {
    let mut command = Command::new(program("ampco"));
    command
        .args(arguments)
        .current_dir(place)
        .stdin(Stdio::null());
    command.stdout(stdout).stderr(Stdio::piped());
    command.output().expect("it starts")
}

#[test]
fn a_reader_that_has_seen_enough_breaks_nothing() {
    let place = workplace();
    for (arguments, written) in commands() {
        let (reader, writer) = std::io::pipe().expect("a pipe");
        drop(reader);
        let output = into(place.path(), &arguments, writer);
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        let line = arguments.join(" ");
        assert!(
            output.status.success(),
            "ampco {line}: {} {said}",
            output.status
        );
        assert!(
            !said.contains("pipe") && !said.contains("panic"),
            "ampco {line}: {said}"
        );
        assert_written(place.path(), &arguments, &written);
    }
}

#[test]
fn results_that_find_no_room_are_a_failure() {
    let place = workplace();
    for line in ["stages", "export --mjcf", "motions inspect clips"] {
        let arguments: Vec<String> = line.split(' ').map(str::to_owned).collect();
        let full = fs::File::options()
            .write(true)
            .open("/dev/full")
            .expect("there on Linux");
        let output = into(place.path(), &arguments, full);
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(1), "ampco {line}: {said}");
        assert!(said.contains("No space left"), "ampco {line}: {said}");
    }
}

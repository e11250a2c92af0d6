//! A study from its file to its report: stopped in the middle, gone on with, and every number checked against the runs.

use std::collections::HashMap;
use std::fs;
use std::path::Path;
use std::process::Command;
use std::time::Duration;

use rustix::process::Signal;
use serde_json::Value;

use crate::harness::{Process, Runs, finish, metrics, program, repository, until_iteration};

/// Six runs and six evaluations on a busy machine.
const WHOLE: Duration = Duration::from_secs(600);

fn study(file: &Path, out: &Path) -> Process {
    let mut command = Command::new(program("ampco"));
    command
        .args(["study", "run"])
        .arg(file)
        .arg("--out")
        .arg(out);
    Process::start(command)
}

fn report(folder: &Path) -> String {
    let mut command = Command::new(program("ampco"));
    command.args(["study", "report"]).arg(folder);
    let (done, said, complained) = finish(command);
    assert!(done, "{complained}");
    fs::read_to_string(said.trim()).expect("the report")
}

/// A CSV file of numbers and plain words: a row per line, by the names of its columns.
fn table(path: &Path) -> Vec<HashMap<String, String>> {
    let text = fs::read_to_string(path).expect("a table");
    let mut lines = text.lines();
    let names: Vec<&str> = lines.next().expect("a head").split(',').collect();
    lines
        .map(|line| {
            let cells = line.split(',').map(str::to_owned);
            names
                .iter()
                .map(|name| (*name).to_owned())
                .zip(cells)
                .collect()
        })
        .collect()
}

fn number(row: &HashMap<String, String>, key: &str) -> f64 {
    row[key]
        .parse()
        .unwrap_or_else(|_| panic!("{key} is {:?}", row[key]))
}

fn assert_near(found: f64, expected: f64, what: &str) {
    assert!(
        (found - expected).abs() <= 1e-12 * expected.abs(),
        "{what}: {found} is not {expected}"
    );
}

/// Final and peak of a metric, straight from the lines: 25 steps an iteration, so windows of 40.
fn final_and_peak(lines: &[Value], key: &str) -> (f64, f64) {
    let of = |window: &[Value]| {
        let values = window
            .iter()
            .map(|line| line[key].as_f64().expect("a number"));
        let n = window.len() as f64;
        if key == "rmse" {
            (values.map(|x| x * x).sum::<f64>() / n).sqrt()
        } else {
            values.sum::<f64>() / n
        }
    };
    let later = (40..=lines.len() - 40).map(|from| of(&lines[from..from + 40]));
    (
        of(&lines[lines.len() - 40..]),
        later.fold(f64::MIN, f64::max),
    )
}

#[test]
fn the_smoke_study_survives_a_stop_and_its_report_says_what_the_runs_say() {
    let place = Runs::new();
    let out = place.run("smoke");
    let file = repository().join("deploy/studies/smoke.toml");
    let first = out.join("runs/ampco-seed1");

    let mut began = study(&file, &out);
    until_iteration(&first, 15);
    let early = metrics(&first)[9].clone();
    began.signal(Signal::INT);
    assert!(began.end().success(), "{}", began.stderr.text());
    assert!(
        began.stderr.text().contains("stopped: "),
        "{}",
        began.stderr.text()
    );
    assert!(metrics(&first).len() < 120, "it was stopped before its end");

    let mut resumed = study(&file, &out);
    assert!(
        resumed.end_within(WHOLE).success(),
        "{}",
        resumed.stderr.text()
    );
    // The lines from before the stop are still there, times included: nothing was begun anew.
    assert_eq!(metrics(&first)[9], early);

    let page = report(&out);
    let rows = table(&out.join("report/runs.csv"));
    assert_eq!(rows.len(), 6);
    for row in &rows {
        assert_eq!(
            (row["state"].as_str(), row["iterations"].as_str()),
            ("finished", "120")
        );
        let lines = metrics(&out.join("runs").join(&row["run"]));
        for (key, column) in [
            ("rmse", "rmse"),
            ("energy_j", "energy_j"),
            ("style_mean", "style"),
        ] {
            let (last, peak) = final_and_peak(&lines, key);
            assert_near(number(row, &format!("{column}_final")), last, &row["run"]);
            assert_near(number(row, &format!("{column}_peak")), peak, &row["run"]);
        }
        let switched = lines[119]["switched_at"].as_u64();
        assert_eq!(row["switched_at"].parse().ok(), switched);
        assert!(number(row, "decision_share") > 0.0 && number(row, "weighting_share") > 0.0);
        let record = format!("records/{}.json", row["run"]);
        assert!(page.contains(&format!("href=\"../{record}\"")));
        let length = fs::metadata(out.join(record)).expect("a record").len();
        assert!(length <= 60_000, "{length} bytes");
    }
    for method in table(&out.join("report/methods.csv")) {
        let of_method = rows.iter().filter(|row| row["method"] == method["method"]);
        let values: Vec<f64> = of_method.map(|row| number(row, "energy_j_final")).collect();
        let [a, b] = values[..] else {
            panic!("two seeds")
        };
        assert_near(
            number(&method, "energy_j_final_mean"),
            0.5 * (a + b),
            "mean",
        );
        // Of two numbers: |a − b| / √2.
        let deviation = number(&method, "energy_j_final_std");
        assert!((deviation - (a - b).abs() / 2.0_f64.sqrt()).abs() < 1e-9 * a);
    }
    for part in [
        "Table III",
        "Table IV",
        "smallest reachable p = 0.5",
        "Phase II",
        "ampco bench scheduler",
        "Without exploration, in rapier",
    ] {
        assert!(page.contains(part), "{part}");
    }

    // Without its runs the study has the same report, and goes on in another folder from its records.
    fs::remove_dir_all(out.join("runs")).expect("removed");
    assert_eq!(report(&out), page);
    let elsewhere = place.run("elsewhere");
    let mut command = Command::new(program("ampco"));
    command
        .args(["study", "run"])
        .arg(&file)
        .arg("--out")
        .arg(&elsewhere);
    command
        .args(["--jobs", "2", "--records"])
        .arg(out.join("records"));
    let (done, _, said) = finish(command);
    assert!(done && said.contains("6 of 6 runs done"), "{said}");
    assert!(
        !elsewhere.join("runs/ampco-seed1").exists(),
        "no run was made again"
    );
    let mut command = Command::new(program("ampco"));
    command
        .args(["study", "merge"])
        .arg(place.run("all"))
        .args([&out, &elsewhere]);
    let (done, said, complained) = finish(command);
    assert!(
        done && said.starts_with("6 records taken over"),
        "{complained}"
    );
}

#[test]
fn a_run_that_fails_is_named_and_the_others_go_on() {
    let place = Runs::new();
    let smoke = fs::read_to_string(repository().join("deploy/presets/smoke.toml")).expect("smoke");
    let bad = smoke.replace(
        "clips = [{ gait = \"stand\" }, { gait = \"walk\", speed = 0.8 }]",
        "clips = [{ file = \"none.csv\", fps = 50 }]",
    );
    assert_ne!(bad, smoke);
    fs::write(place.run("bad.toml"), bad).expect("written");
    fs::write(place.run("good.toml"), smoke).expect("written");
    let text =
        "title = 'half of it'\nmethods = ['bad.toml', 'good.toml']\nseeds = [1]\niterations = 3\n";
    fs::write(place.run("half.toml"), text).expect("written");

    let out = place.run("half");
    let mut process = study(&place.run("half.toml"), &out);
    assert!(!process.end_within(WHOLE).success());
    let said = process.stderr.text();
    assert!(
        said.contains("bad-seed1 failed and the others go on"),
        "{said}"
    );
    assert!(
        said.contains("good-seed1 is done") && said.contains("none.csv"),
        "{said}"
    );
    assert_eq!(metrics(&out.join("runs/good-seed1")).len(), 3);
    let page = report(&out);
    assert!(page.contains("failed: ") && page.contains("none.csv"));
}

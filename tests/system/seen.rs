//! Lists of the configuration's own from training to a file that others read.

use std::fs;
use std::process::Command;

use serde_json::Value;

use crate::harness::{Runs, finish, metrics, program};

/// A policy that sees what a robot measures, of six control steps, and a critic that knows more.
const LISTS: [&str; 6] = [
    "--set",
    "observation.actor.terms=['angular_velocity','gravity','command','joint_position','joint_velocity','previous_action']",
    "--set",
    "observation.actor.past=5",
    "--set",
    "observation.critic.terms=['actor','linear_velocity','height','friction','payload','foot_forces']",
];

fn ampco(runs: &Runs, line: &str) -> (bool, String, String) {
    let mut command = Command::new(program("ampco"));
    command.args(line.split(' ')).current_dir(runs.path());
    finish(command)
}

fn succeeds(runs: &Runs, line: &str) -> String {
    let (success, printed, said) = ampco(runs, line);
    assert!(success, "{line}: {said}");
    printed
}

#[test]
fn a_policy_with_lists_of_its_own_is_trained_judged_shipped_and_gone_on_with() {
    let runs = Runs::new();
    let once = [&["--actors", "1", "--iterations", "2"], &LISTS[..]].concat();
    let mut group = runs.train("blind", &once);
    assert!(group.end().success(), "{}", group.stderr.text());
    assert_eq!(metrics(&runs.run("blind")).len(), 2);

    succeeds(&runs, "export blind --runs-dir . --ship --out shipped");
    let judged = succeeds(
        &runs,
        "evaluate shipped --seconds 0.2 --episodes 2 --command 0.5,0,0 --json",
    );
    let judged: Value = serde_json::from_str(&judged).expect("JSON");
    assert!(judged.to_string().contains("rmse"), "{judged}");
    succeeds(&runs, "play shipped --seconds 0.2 --json walk.json");
    let text = fs::read_to_string(runs.path().join("walk.json")).expect("recorded");
    let recorded: Value = serde_json::from_str(&text).expect("JSON");
    // (3 + 3 + 3 + 23 + 23 + 23) numbers of six steps.
    let seen = recorded["frames"][0]["observation"]
        .as_array()
        .expect("numbers");
    assert_eq!(seen.len(), 78 * 6);

    succeeds(&runs, "export shipped --out exported");
    let text = fs::read_to_string(runs.path().join("exported/policy.json")).expect("exported");
    let described: Value = serde_json::from_str(&text).expect("JSON");
    let terms = described["observation"].as_array().expect("terms");
    assert_eq!(terms.len(), 6);
    assert_eq!(
        (&terms[1]["name"], &terms[1]["past"], &terms[1]["start"]),
        (&"gravity".into(), &5.into(), &18.into())
    );
    assert_eq!(
        described["example"]["observation"]
            .as_array()
            .expect("numbers")
            .len(),
        78 * 6
    );

    // Another list is another network: said before anything is started, on resume and on beginning with it.
    let longer = ["--iterations", "4", "--set", "observation.actor.past=4"];
    let mut group = runs.resume("blind", &longer);
    assert!(!group.end().success());
    let said = group.stderr.text();
    assert!(
        said.contains("observation.actor.past: 5 → 4") && said.contains("--from"),
        "{said}"
    );
    let from = runs.path().join("shipped");
    let from = [
        "--actors",
        "1",
        "--iterations",
        "1",
        "--from",
        from.to_str().expect("text"),
    ];
    let mut group = runs.train("other", &from);
    assert!(!group.end().success());
    let said = group.stderr.text();
    assert!(
        said.contains("observation.actor") && said.contains("height"),
        "{said}"
    );
    // Where the critic alone sees something else, it begins anew.
    let other_critic = [
        "--set",
        "observation.critic.terms=['actor','linear_velocity']",
    ];
    let mut group = runs.train("again", &[&from[..], &LISTS[..4], &other_critic].concat());
    assert!(group.end().success(), "{}", group.stderr.text());
    let kept = fs::read_to_string(runs.run("again").join("config.toml")).expect("kept");
    assert!(kept.contains("critic_first = 1000000.0"), "{kept}");
}

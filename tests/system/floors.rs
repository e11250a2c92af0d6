//! The house: what stands on what, read from the manifests.
//!
//! A crate may lean on its own floor and on those below. The floor follows from the folder: what processes share lies
//! under `protocol/`; crates nested in a process are pure; the process itself is a shell; `deploy/` and the crates
//! nested in `tests/` use all of them, and the tests themselves are above.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use toml::{Table, Value};

use crate::harness::repository;

/// Which floor the crate in a folder of the workspace stands on; `None` of a folder that belongs nowhere.
fn floor(folder: &str) -> Option<u8> {
    let (top, nested) = match folder.split_once('/') {
        Some((top, _)) => (top, true),
        None => (folder, false),
    };
    match (top, nested) {
        ("protocol", _) => Some(0),
        ("actor" | "learner" | "scheduler", true) => Some(1),
        ("actor" | "learner" | "scheduler", false) => Some(2),
        ("deploy" | "tests", true) => Some(3),
        ("tests", false) => Some(4),
        _ => None,
    }
}

/// A crate of the workspace, and what its manifest asks for.
struct Member {
    folder: String,
    needed: Vec<String>,
    needed_by_tests: Vec<String>,
}

/// By name every crate of the workspace.
fn members() -> BTreeMap<String, Member> {
    let root = manifest(&repository());
    let folders = root["workspace"]["members"].as_array().expect("members");
    folders
        .iter()
        .map(|folder| {
            let folder = folder.as_str().expect("a folder").to_owned();
            let manifest = manifest(&repository().join(&folder));
            let name = manifest["package"]["name"].as_str().expect("a name");
            let names = |section: &str| -> Vec<String> {
                let table = manifest.get(section).and_then(Value::as_table);
                table.into_iter().flat_map(Table::keys).cloned().collect()
            };
            let mut needed = names("dependencies");
            needed.extend(names("build-dependencies"));
            let needed_by_tests = names("dev-dependencies");
            let member = Member {
                folder,
                needed,
                needed_by_tests,
            };
            (name.to_owned(), member)
        })
        .collect()
}

fn manifest(folder: &Path) -> Table {
    let path = folder.join("Cargo.toml");
    let text = fs::read_to_string(&path).unwrap_or_else(|error| panic!("{path:?}: {error}"));
    text.parse()
        .unwrap_or_else(|error| panic!("{path:?}: {error}"))
}

/// What in these crates points from a lower floor to a higher one.
fn upward(members: &BTreeMap<String, Member>) -> Vec<String> {
    let mut found = Vec::new();
    for (name, member) in members {
        let Some(own) = floor(&member.folder) else {
            found.push(format!("{name} in {} has no floor", member.folder));
            continue;
        };
        // What tests need of a machine is in no program, and tests of every floor ask it.
        let tests = member.needed_by_tests.iter().filter(|it| *it != "needs");
        for needed in member.needed.iter().chain(tests) {
            let theirs = members.get(needed).and_then(|other| floor(&other.folder));
            if theirs > Some(own) {
                found.push(format!("{name} (floor {own}) leans on {needed} above it"));
            }
        }
    }
    found
}

#[test]
fn no_crate_leans_on_a_higher_floor() {
    let members = members();
    assert!(members.len() > 20, "only {} crates", members.len());
    let found = upward(&members);
    assert!(found.is_empty(), "{found:#?}");
}

/// Who alone may name a library, as folders; crates nested in them are others.
const HOLDERS: &[(&str, &[&str])] = &[
    ("iceoryx2", &["protocol"]),
    ("rapier3d", &["actor/sim"]),
    ("burn", &["learner/networks", "learner/amp"]),
    ("tonic", &["protocol/hosts"]),
    ("rcgen", &["protocol/hosts"]),
];

/// The one crate of the lowest floor that talks: what hosts say to each other are the streams' messages.
const BETWEEN_HOSTS: &str = "protocol/hosts";

#[test]
fn libraries_are_seen_where_the_readme_says() {
    for (name, member) in members() {
        for (library, holders) in HOLDERS {
            let sees = member.needed.iter().any(|needed| needed == library);
            assert!(
                !sees || holders.contains(&member.folder.as_str()),
                "{name} names {library}, which only {holders:?} may"
            );
        }
        let talks = member.needed.iter().any(|needed| needed == "protocol");
        assert!(
            !talks || floor(&member.folder) >= Some(2) || member.folder == BETWEEN_HOSTS,
            "{name} names protocol: crates below the shells never talk"
        );
    }
}

#[test]
fn an_arrow_upward_is_found_also_one_of_tests() {
    let member = |folder: &str, needed: &[&str], needed_by_tests: &[&str]| Member {
        folder: folder.to_owned(),
        needed: needed.iter().map(|name| (*name).to_owned()).collect(),
        needed_by_tests: needed_by_tests.iter().map(|it| (*it).to_owned()).collect(),
    };
    let house = |low: Member| {
        BTreeMap::from([
            ("low".to_owned(), low),
            ("high".to_owned(), member("actor/high", &["serde"], &[])),
            ("needs".to_owned(), member("tests/needs", &[], &[])),
        ])
    };
    let count = |low| upward(&house(low)).len();
    assert_eq!(count(member("protocol/low", &["serde"], &["needs"])), 0);
    assert_eq!(count(member("protocol/low", &["high"], &[])), 1);
    assert_eq!(count(member("protocol/low", &[], &["high"])), 1);
    assert_eq!(count(member("protocol/low", &["needs"], &[])), 1);
    assert_eq!(count(member("learner", &["high"], &[])), 0);
    assert_eq!(count(member("elsewhere", &[], &[])), 1);
}

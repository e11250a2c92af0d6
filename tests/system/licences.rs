//! Licences of everything that is linked in, checked against the one list in deny.toml.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::process::Command;

use serde_json::Value;
use spdx::{Expression, LicenseReq, ParseMode};

use crate::harness::{finish, repository};

/// The lists of deny.toml: licences that every crate may have, and those of single crates.
struct Lists {
    all: BTreeSet<String>,
    exceptions: BTreeMap<String, BTreeSet<String>>,
}

impl Lists {
    fn read() -> Self {
        let text = fs::read_to_string(repository().join("deny.toml")).expect("deny.toml");
        let list: toml::Table = text.parse().expect("TOML");
        let exceptions = list["licenses"]["exceptions"].as_array().expect("an array");
        Self {
            all: names(&list["licenses"]["allow"]),
            exceptions: exceptions
                .iter()
                .map(|entry| {
                    let name = entry["crate"].as_str().expect("a name").to_owned();
                    (name, names(&entry["allow"]))
                })
                .collect(),
        }
    }

    fn allow(&self, package: &Package) -> bool {
        let own = self.exceptions.get(&package.name);
        let permits = |requirement: &LicenseReq| {
            let name = requirement.to_string();
            self.all.contains(&name) || own.is_some_and(|own| own.contains(&name))
        };
        // Lax, because old manifests separate licences with a slash.
        let expression = Expression::parse_mode(&package.licence, ParseMode::LAX);
        expression.is_ok_and(|expression| expression.evaluate(permits))
    }
}

fn names(list: &toml::Value) -> BTreeSet<String> {
    let names = list.as_array().expect("an array").iter();
    names
        .map(|name| name.as_str().expect("a name").to_owned())
        .collect()
}

/// A package and what it says of its licence; nothing if it says nothing.
#[derive(Clone, Debug)]
struct Package {
    name: String,
    licence: String,
}

/// Packages that the workspace's programs and their builds depend on on this platform.
fn dependencies() -> Vec<Package> {
    let mut command = Command::new(env!("CARGO"));
    command
        .current_dir(repository())
        .args(["metadata", "--format-version", "1", "--locked", "--offline"])
        .args(["--filter-platform", "x86_64-unknown-linux-gnu"]);
    let (success, out, err) = finish(command);
    assert!(success, "{err}");
    let metadata: Value = serde_json::from_str(&out).expect("JSON");
    let packages: BTreeMap<&str, Package> = metadata["packages"]
        .as_array()
        .expect("packages")
        .iter()
        .map(|package| {
            let id = package["id"].as_str().expect("an id");
            let name = package["name"].as_str().expect("a name").to_owned();
            let licence = package["license"].as_str().unwrap_or_default().to_owned();
            (id, Package { name, licence })
        })
        .collect();
    let edges: BTreeMap<&str, &Value> = metadata["resolve"]["nodes"]
        .as_array()
        .expect("nodes")
        .iter()
        .map(|node| (node["id"].as_str().expect("an id"), &node["deps"]))
        .collect();
    let mut waiting: Vec<&str> = metadata["workspace_members"]
        .as_array()
        .expect("members")
        .iter()
        .map(|id| id.as_str().expect("an id"))
        .collect();
    let mut reached = BTreeMap::new();
    while let Some(id) = waiting.pop() {
        if reached.insert(id, packages[id].clone()).is_some() {
            continue;
        }
        for dependency in edges[id].as_array().expect("dependencies") {
            // What only tests use is not shipped.
            let kinds = dependency["dep_kinds"].as_array().expect("kinds");
            if kinds.iter().any(|kind| kind["kind"] != "dev") {
                waiting.push(dependency["pkg"].as_str().expect("an id"));
            }
        }
    }
    reached.into_values().collect()
}

#[test]
fn every_dependency_has_a_licence_that_deny_toml_allows() {
    let lists = Lists::read();
    let mut refused = dependencies();
    refused.retain(|package| !lists.allow(package));
    assert!(refused.is_empty(), "not allowed by deny.toml: {refused:#?}");
}

#[test]
fn a_licence_that_is_not_on_the_list_is_found() {
    let lists = Lists::read();
    let package = |name: &str, licence: &str| Package {
        name: name.to_owned(),
        licence: licence.to_owned(),
    };
    assert!(lists.allow(&package("any", "MIT OR GPL-3.0-only")));
    assert!(!lists.allow(&package("any", "GPL-3.0-only")));
    assert!(!lists.allow(&package("any", "")));
}

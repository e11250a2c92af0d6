//! Licences of everything that is linked in, checked against the one list in deny.toml.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::process::Command;

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

/// Everything that is compiled for a build or a test on this platform.
///
/// `cargo tree` and not `cargo metadata`: the latter also lists three hundred packages of features
/// that are off and never compiled.
fn dependencies() -> Vec<Package> {
    let mut command = Command::new(env!("CARGO"));
    command
        .current_dir(repository())
        .args(["tree", "--workspace", "--edges", "normal,build,dev"])
        .args(["--prefix", "none", "--format", "{p}\t{l}\t"])
        .args(["--locked", "--offline"]);
    let (success, out, err) = finish(command);
    assert!(success, "{err}");
    let packages: BTreeMap<&str, &str> = out
        .lines()
        .filter(|line| !line.is_empty())
        .map(|line| {
            let mut fields = line.split('\t');
            let package = fields.next().expect("name and version");
            (package, fields.next().expect("a licence"))
        })
        .collect();
    packages
        .into_iter()
        .map(|(package, licence)| Package {
            name: package.split(' ').next().expect("a name").to_owned(),
            licence: licence.to_owned(),
        })
        .collect()
}

#[test]
fn every_dependency_has_a_licence_that_deny_toml_allows() {
    let lists = Lists::read();
    let mut refused = dependencies();
    assert!(
        refused.len() > 100,
        "only {} packages were found",
        refused.len()
    );
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

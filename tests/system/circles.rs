//! Modules of a crate lean on each other in one direction: read from what their files name of `crate::`.
//!
//! A module is a file or folder right below `src/`. What tests name does not count.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

use crate::harness::repository;

/// By module the modules that it names.
type Graph = BTreeMap<String, BTreeSet<String>>;

/// Every Rust file below a folder, but those of tests.
fn sources(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        let path = entry.path();
        let stem = path.file_stem().unwrap_or_default().to_string_lossy();
        if stem == "tests" || stem.ends_with("_tests") {
            continue;
        }
        if path.is_dir() {
            sources(&path, found);
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            found.push(path);
        }
    }
}

/// What is compiled of a file: no comments, and nothing after its module of tests begins.
fn code(text: &str) -> String {
    let end = text.find("#[cfg(test)]\nmod tests {");
    let lines = text[..end.unwrap_or(text.len())].lines();
    let code = lines.map(|line| line.split("//").next().unwrap_or_default());
    code.collect::<Vec<_>>().join("\n")
}

/// The first name of each path that follows `prefix`, also of paths in braces.
fn named(code: &str, prefix: &str) -> BTreeSet<String> {
    let first = |path: &str| -> String {
        let letter = |c: &char| c.is_alphanumeric() || *c == '_';
        path.trim_start().chars().take_while(letter).collect()
    };
    let mut names = BTreeSet::new();
    for (at, _) in code.match_indices(prefix) {
        let rest = &code[at + prefix.len()..];
        let Some(group) = rest.strip_prefix('{') else {
            names.insert(first(rest));
            continue;
        };
        let (mut depth, mut begin) = (0, 0);
        for (place, letter) in group.char_indices() {
            match letter {
                '{' => depth += 1,
                '}' if depth > 0 => depth -= 1,
                ',' | '}' if depth == 0 => {
                    names.insert(first(&group[begin..place]));
                    begin = place + 1;
                    if letter == '}' {
                        break;
                    }
                }
                _ => {}
            }
        }
    }
    names
}

/// The modules of a crate and which others each names, also by what `lib.rs` passes on.
fn graph(src: &Path) -> Graph {
    let mut files = Vec::new();
    sources(src, &mut files);
    let module = |path: &Path| -> String {
        let inside = path.strip_prefix(src).expect("below src");
        let top = inside.components().next().expect("a file").as_os_str();
        top.to_string_lossy().trim_end_matches(".rs").to_owned()
    };
    let modules: BTreeSet<String> = files.iter().map(|path| module(path)).collect();
    let root = fs::read_to_string(src.join("lib.rs")).unwrap_or_default();
    let passed_on = |name: &str| {
        let by =
            |module: &&String| named(&code(&root), &format!("pub use {module}::")).contains(name);
        modules.iter().find(by).cloned()
    };
    let mut graph = Graph::new();
    for path in &files {
        let own = module(path);
        if own == "lib" || own == "main" {
            continue;
        }
        let text = fs::read_to_string(path).expect("a source");
        let others = named(&code(&text), "crate::").into_iter();
        let others = others.filter_map(|name| match modules.contains(&name) {
            true => Some(name),
            false => passed_on(&name),
        });
        let others = others.filter(|other| *other != own).collect::<Vec<_>>();
        graph.entry(own).or_default().extend(others);
    }
    graph
}

/// Modules that lead back to themselves, and those that lead to them.
fn circles(mut graph: Graph) -> Graph {
    loop {
        let leaves: Vec<String> = graph
            .iter()
            .filter(|(_, others)| others.iter().all(|other| !graph.contains_key(other)))
            .map(|(module, _)| module.clone())
            .collect();
        if leaves.is_empty() {
            return graph;
        }
        graph.retain(|module, _| !leaves.contains(module));
    }
}

#[test]
fn no_crate_has_modules_in_a_circle() {
    let text = fs::read_to_string(repository().join("Cargo.toml")).expect("the workspace");
    let workspace: toml::Table = text.parse().expect("TOML");
    let members = workspace["workspace"]["members"]
        .as_array()
        .expect("members");
    let mut looked_at = 0;
    for folder in members {
        let folder = folder.as_str().expect("a folder");
        let graph = graph(&repository().join(folder).join("src"));
        looked_at += graph.len();
        let circles = circles(graph);
        assert!(
            circles.is_empty(),
            "{folder}: one of these arrows has to go: {circles:#?}"
        );
    }
    assert!(looked_at > 150, "only {looked_at} modules");
}

#[test]
fn a_circle_is_found_however_its_arrows_are_written() {
    let files = [
        ("lib.rs", "mod a;\nmod b;\nmod c;\npub use c::{D, Thing};\n"),
        ("a.rs", "use crate::{b::{self, X}, Thing};\n"),
        (
            "b.rs",
            "// crate::a in a comment\n#[cfg(test)]\nmod tests {\n use crate::a;\n}\n",
        ),
        ("c.rs", "pub struct Thing;\n"),
    ];
    let folder = tempfile::tempdir().expect("a folder");
    for (name, text) in files {
        fs::write(folder.path().join(name), text).expect("written");
    }
    let found = graph(folder.path());
    let names: Vec<&str> = found["a"].iter().map(String::as_str).collect();
    assert_eq!(names, ["b", "c"]);
    assert!(circles(found).is_empty());

    fs::create_dir(folder.path().join("c")).expect("made");
    fs::write(
        folder.path().join("c/deep.rs"),
        "fn f() { crate::a::g(); }\n",
    )
    .expect("written");
    let found = circles(graph(folder.path()));
    let names: Vec<&str> = found.keys().map(String::as_str).collect();
    assert_eq!(names, ["a", "c"]);
}

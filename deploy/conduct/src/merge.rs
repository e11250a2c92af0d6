//! `ampco study merge`: the records of several folders in one, if they are of one study.
//!
//! Everything is read and compared before anything is written: a merge that is refused has changed nothing.

use std::collections::BTreeMap;
use std::path::Path;

use ::study::{Record, StudyFile};
use anyhow::{Result, bail};
use configuration::resolve;
use run::Config;
use terminal::failure::usage;
use wording::count;

use crate::folder::StudyFolder;
use crate::records::{self, Records};

/// Copies what `from` have and `into` lacks; how many records came in, in words.
pub(super) fn merge(into: &Path, from: &[StudyFolder]) -> Result<String> {
    let Some(first) = from.first() else {
        bail!(usage(
            "nothing to merge is given; name the folders after the one that they go into"
        ));
    };
    let there = into.join("study.toml").is_file();
    let file = if there {
        StudyFolder::open(into)?.file()?
    } else {
        first.file()?
    };
    let ours = Records::new(into.join(records::FOLDER));
    let mut gathered: BTreeMap<String, (Record, Records)> = BTreeMap::new();
    for record in ours.all()? {
        gathered.insert(record.run_name(), (record, ours.clone()));
    }
    let before: Vec<String> = gathered.keys().cloned().collect();
    for folder in from {
        same_study(&file, folder)?;
        let theirs = folder.records();
        for record in theirs.all()? {
            let name = record.run_name();
            match gathered.get(&name) {
                Some((known, place)) => same_run((known, place), (&record, &theirs))?,
                None => {
                    gathered.insert(name, (record, theirs.clone()));
                }
            }
        }
    }
    same_methods(&gathered)?;
    let folder = StudyFolder::create(into)?;
    if !there {
        folder.write("study.toml", &file.to_toml())?;
    }
    for folder_of in from {
        if let (None, Some(bench)) = (
            folder.json("overhead.json")?,
            folder_of.json("overhead.json")?,
        ) {
            folder.write("overhead.json", &format!("{bench}\n"))?;
        }
    }
    let new = gathered.iter().filter(|(name, _)| !before.contains(name));
    let mut taken = 0;
    for (_, (record, _)) in new {
        folder.records().write(record)?;
        taken += 1;
    }
    let shown = into.display();
    Ok(format!(
        "{} taken over; {shown} has {}",
        count(taken, "record"),
        count(gathered.len(), "record")
    ))
}

/// Refuses a folder whose study makes its runs otherwise; which methods and seeds it has is its own affair.
fn same_study(file: &StudyFile, folder: &StudyFolder) -> Result<()> {
    let theirs = folder.file()?;
    let bare = |file: &StudyFile| StudyFile {
        title: String::new(),
        note: String::new(),
        methods: Vec::new(),
        seeds: Vec::new(),
        jobs: 1,
        sweeps: Vec::new(),
        ..file.clone()
    };
    let (ours, theirs) = (bare(file).to_toml(), bare(&theirs).to_toml());
    let Some((ours, theirs)) = first_difference(&ours, &theirs) else {
        return Ok(());
    };
    Err(usage(format!(
        "{}: its study says `{theirs}` and the one that it goes into `{ours}`; merge it into another folder",
        folder.path().join("study.toml").display()
    )))
}

fn first_difference<'a>(ours: &'a str, theirs: &'a str) -> Option<(&'a str, &'a str)> {
    let (mut ours, mut theirs) = (ours.lines(), theirs.lines());
    loop {
        match (ours.next(), theirs.next()) {
            (None, None) => return None,
            (a, b) if a == b => {}
            (a, b) => return Some((a.unwrap_or_default(), b.unwrap_or_default())),
        }
    }
}

/// Refuses two records of one run that were made otherwise, or say otherwise. Where and how fast a run was made may differ.
fn same_run(
    (known, place): (&Record, &Records),
    (other, there): (&Record, &Records),
) -> Result<()> {
    let name = known.run_name();
    let (ours, theirs) = (place.path(&name), there.path(&name));
    let configs = (
        records::configuration(known, &ours)?,
        records::configuration(other, &theirs)?,
    );
    refuse_other(&configs.0, &configs.1, &ours, &theirs)?;
    let what = [
        (
            "metrics",
            known.measured != other.measured || known.told.curves != other.told.curves,
        ),
        (
            "policy",
            known.origin.policy_sha256 != other.origin.policy_sha256,
        ),
        ("judgement", known.judgement != other.judgement),
    ];
    match what.iter().find(|(_, differ)| *differ) {
        None => Ok(()),
        Some((what, _)) => Err(usage(format!(
            "{}: it contradicts {}, of the same run and configuration, in its {what}; move one of the two away",
            theirs.display(),
            ours.display()
        ))),
    }
}

/// Refuses records of one method that differ in more than the seed.
fn same_methods(gathered: &BTreeMap<String, (Record, Records)>) -> Result<()> {
    let mut first: BTreeMap<&str, (Config, &str)> = BTreeMap::new();
    for (name, (record, place)) in gathered {
        let mut config = records::configuration(record, &place.path(name))?;
        config.remove("run.seed");
        match first.get(record.entry.name.as_str()) {
            None => {
                first.insert(&record.entry.name, (config, name));
            }
            Some((known, of)) => {
                let known_place = &gathered[*of].1;
                refuse_other(known, &config, &known_place.path(of), &place.path(name))?;
            }
        }
    }
    Ok(())
}

fn refuse_other(ours: &Config, theirs: &Config, known: &Path, other: &Path) -> Result<()> {
    match resolve::difference(theirs, ours) {
        None => Ok(()),
        Some((theirs, ours)) => Err(usage(format!(
            "{}: this run was made with `{theirs}` and {} with `{ours}`; merge it into another folder",
            other.display(),
            known.display()
        ))),
    }
}

#[cfg(test)]
mod tests;

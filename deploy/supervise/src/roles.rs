//! The roles of a group: which there are, and what programs with which arguments take them.

use std::ffi::OsString;
use std::path::PathBuf;

use anyhow::Result;
use run::Folder;
use tokio::sync::mpsc::UnboundedSender;

use crate::child::{Child, Words};
use crate::{Launch, Members, programs};

pub(crate) const LEARNER: &str = "learner";
pub(crate) const SCHEDULER: &str = "scheduler";
/// Lets other machines in.
pub(crate) const GATE: &str = "gate";
/// Stands in for a learner on another machine.
pub(crate) const CARRIER: &str = "carrier";
/// The program of the last two.
const HOSTS: &str = "ampco-gate";

pub(crate) fn is_actor(role: &str) -> bool {
    role.starts_with("actor-")
}

/// Whether a process of a role belongs to a group; others only look.
pub(crate) fn is_member(role: &str) -> bool {
    matches!(role, LEARNER | SCHEDULER | GATE | CARRIER) || is_actor(role)
}

/// Who is started of a launch; any order would do.
pub(crate) fn children(launch: &Launch<'_>, words: &UnboundedSender<Words>) -> Result<Vec<Child>> {
    let child = |role: &str, program: &str, arguments: Vec<OsString>| -> Result<Child> {
        Ok(Child::new(
            role.to_owned(),
            programs::find(program)?,
            arguments,
            words.clone(),
        ))
    };
    let with = |words: &[&str]| -> Vec<OsString> {
        let mut arguments = run_dir(launch.folder);
        arguments.extend(words.iter().map(OsString::from));
        arguments
    };
    let end = |end: &str, words: &[&str]| -> Vec<OsString> {
        let mut arguments = vec![OsString::from(end)];
        arguments.extend(with(words));
        arguments
    };
    let mut children = Vec::new();
    if !launch.members.are_guests() {
        children.push(child(SCHEDULER, "ampco-scheduler", with(&[]))?);
        let arguments = learner_arguments(launch, launch.resume);
        children.push(child(LEARNER, "ampco-learner", arguments)?);
    }
    let actors: Vec<u32> = match launch.members {
        Members::All => (0..launch.fleet.actors as u32).collect(),
        Members::Hosts { here, listen } => {
            let first = here.to_string();
            let arguments = end(GATE, &["--listen", listen, "--here", &first]);
            children.push(child(GATE, HOSTS, arguments)?);
            (0..here as u32).collect()
        }
        Members::Guests { numbers, .. } => {
            children.push(child(CARRIER, HOSTS, end(CARRIER, &[]))?);
            numbers.to_vec()
        }
    };
    for number in actors {
        let arguments = with(&["--index", &number.to_string()]);
        children.push(child(&format!("actor-{number}"), "ampco-actor", arguments)?);
    }
    Ok(children)
}

pub(crate) fn learner_arguments(launch: &Launch<'_>, resume: bool) -> Vec<OsString> {
    let mut arguments = run_dir(launch.folder);
    if resume {
        arguments.push("--resume".into());
    }
    arguments
}

/// Where a role writes its log.
pub(crate) fn log(folder: &Folder, role: &str) -> PathBuf {
    folder.logs().join(format!("{role}.log"))
}

/// The argument that every program of the group takes.
pub fn run_dir(folder: &Folder) -> Vec<OsString> {
    vec!["--run-dir".into(), folder.path().into()]
}

pub(crate) fn has_checkpoint(launch: &Launch<'_>) -> bool {
    !launch.folder.checkpoints().list().is_empty()
}

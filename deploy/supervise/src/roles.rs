//! The roles of a group: which there are, and what programs with which arguments take them.

use std::ffi::OsString;
use std::path::PathBuf;

use anyhow::Result;
use run::Folder;
use tokio::sync::mpsc::UnboundedSender;

use crate::child::{Child, Words};
use crate::{Launch, programs};

pub(crate) const LEARNER: &str = "learner";
pub(crate) const SCHEDULER: &str = "scheduler";

pub(crate) fn is_actor(role: &str) -> bool {
    role.starts_with("actor-")
}

/// Scheduler, learner and actors of a launch; any order would do.
pub(crate) fn children(launch: &Launch<'_>, words: &UnboundedSender<Words>) -> Result<Vec<Child>> {
    let child = |role: String, program: &str, arguments| -> Result<Child> {
        Ok(Child::new(
            role,
            programs::find(program)?,
            arguments,
            words.clone(),
        ))
    };
    let mut children = vec![
        child(
            SCHEDULER.to_owned(),
            "ampco-scheduler",
            run_dir(launch.folder),
        )?,
        child(
            LEARNER.to_owned(),
            "ampco-learner",
            learner_arguments(launch, launch.resume),
        )?,
    ];
    for index in 0..launch.fleet.actors {
        let mut arguments = run_dir(launch.folder);
        arguments.extend(["--index".into(), index.to_string().into()]);
        children.push(child(format!("actor-{index}"), "ampco-actor", arguments)?);
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

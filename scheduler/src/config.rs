//! What the scheduler reads of the run's configuration: the section `[scheduler]`, which `ampco` declares.

use ampco::ScheduleConfig;
use anyhow::{Context, Result};
use run::Folder;

/// Reads and checks the section.
pub(crate) fn read(folder: &Folder) -> Result<ScheduleConfig> {
    let config = folder.config().context("reading the run's configuration")?;
    let section = config.checked("scheduler", ScheduleConfig::validate);
    section.context("reading the section [scheduler]")
}

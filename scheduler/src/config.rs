//! What the scheduler reads of the run's configuration: the section `[scheduler]`, which `ampco` declares.

use ampco::ScheduleConfig;
use anyhow::{Context, Result};
use run::Folder;

/// Reads the section.
pub(crate) fn read(folder: &Folder) -> Result<ScheduleConfig> {
    let config = folder.config().context("reading the run's configuration")?;
    config.section().context("reading the section [scheduler]")
}

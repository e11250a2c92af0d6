//! What the scheduler reads of the run's configuration: the section `[scheduler]`, which `ampco` declares, and when the
//! run's ramps have arrived.

use ampco::{Schedule, ScheduleConfig};
use anyhow::{Context, Result};
use run::{Config, FleetConfig, Folder};

/// A schedule that has seen nothing, as the run is configured.
pub(crate) fn read(folder: &Folder) -> Result<Schedule> {
    let config = folder.config().context("reading the run's configuration")?;
    let section: ScheduleConfig = config
        .section()
        .context("reading the section [scheduler]")?;
    let schedule = Schedule::new(section).context("section [scheduler]")?;
    Ok(schedule.settling(settled(&config)?))
}

/// What disturbs robots may grow on after imitation: it is not what they imitate.
const DISTURBANCES: [&str; 2] = ["randomization", "event"];

/// The iteration in which the last ramp of the run arrives, but for those of what disturbs robots: from then on the task
/// stands still. Counted in whole batches, as the learner uses one in each iteration.
fn settled(config: &Config) -> Result<u64> {
    let fleet: FleetConfig = config.section().context("reading the section [fleet]")?;
    let robots = fleet.environments_per_actor() * fleet.actors.max(1);
    Ok((config.settled_but(&DISTURBANCES) / (robots * fleet.steps) as f64).ceil() as u64)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_run_has_settled_when_its_last_ramp_has_arrived() {
        let text = "[fleet]\nenvironments = 9\nactors = 2\nsteps = 100\n\n[exploration]\n\
                    sigma = { from = 0.6, to = 0.2, samples = [1e3, 2.5e3] }\n\n[randomization]\n\
                    strength = { from = 0.0, to = 1.0, samples = [1e3, 9e3] }\n";
        let config = Config::parse(text, "a test").unwrap();
        // Two actors of five robots make 1,000 samples a batch: 2,500 of them are there with the third.
        assert_eq!(settled(&config).unwrap(), 3);
        assert_eq!(settled(&Config::default()).unwrap(), 0);
    }
}

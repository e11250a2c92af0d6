//! `ampco train --from`: what a run begins with, and what of it cannot be taken over.
//!
//! Separate because two runs meet here: all that the other's policy does not fit is refused or told before anything starts.

use amp::{PolicyConfig, PpoConfig};
use anyhow::{Context, Result};
use judge::Kept;
use observation::{ObservationConfig, Print};
use run::Config;
use terminal::Place;
use terminal::console::say;
use terminal::failure::usage;

/// Makes a run's configuration begin with the policy of another run, or of a checkpoint's folder.
pub(super) fn begin_with(place: &Place, from: &str, config: &mut Config) -> Result<()> {
    let kept = Kept::open(place, from)?;
    let origin = format!("--from {from}");
    let observation: ObservationConfig = config.section()?;
    let tables = observation.tables().context("section [observation]")?;
    let seen = Print::of_actor(&kept.tables);
    if let Some(difference) = seen.difference(&Print::of_actor(&tables)) {
        // A shipped policy has the first, a run's checkpoint the second.
        let has = ["config.toml", run::checkpoint::CONFIG].map(|name| kept.path.join(name));
        let has = has.iter().find(|path| path.exists()).unwrap_or(&kept.path);
        return Err(usage(format!(
            "--from {from}: this run's policy is to see something else than that one does: {difference}; set \
             observation.actor as it was, `{}` has it",
            has.display()
        )));
    }
    let own: PolicyConfig = config.section()?;
    let theirs = &kept.learning.policy;
    if (&own.hidden, &own.critic_hidden) != (&theirs.hidden, &theirs.critic_hidden) {
        return Err(usage(format!(
            "--from {from}: its networks are policy.hidden={:?} and policy.critic_hidden={:?}; set both like that",
            theirs.hidden, theirs.critic_hidden
        )));
    }
    let other_critic = Print::of_critic(&kept.tables) != Print::of_critic(&tables);
    let has = |part: &&str| kept.part(part).is_ok();
    let why = if other_critic {
        Some("is to see something else than that one's did")
    } else if !["learning.bin", "critic.bin"].iter().any(has) {
        Some("does not come with that policy")
    } else {
        None
    };
    if let Some(why) = why {
        if config.given("ppo.critic_first").is_none() {
            config.put("ppo.critic_first", 1e6, &origin);
        }
        let first = config.section::<PpoConfig>()?.critic_first;
        say(&format!(
            "--from {from}: this run's critic {why}: {}",
            anew(first)
        ));
    }
    if own.observation_clip != theirs.observation_clip {
        say(&format!(
            "--from {from}: its observations were cut to ±{}, here it will be policy.observation_clip={}",
            theirs.observation_clip, own.observation_clip
        ));
    }
    let path = std::path::absolute(&kept.path).context("finding the policy to begin with")?;
    let path = path.to_str().context("the path of --from is not text")?;
    config.put("run.from", path, &origin);
    Ok(())
}

/// How a critic begins that knows nothing yet.
fn anew(first: f64) -> String {
    if first == 0.0 {
        return "it begins anew, and learns beside the policy from the start (ppo.critic_first = 0)".to_owned();
    }
    format!("it begins anew, and learns alone for {first} samples (ppo.critic_first)")
}

#[cfg(test)]
mod tests {
    use super::anew;

    #[test]
    fn how_long_a_new_critic_learns_alone_is_told() {
        assert!(anew(1e6).contains("alone for 1000000 samples"));
        assert!(anew(0.0).contains("from the start"));
    }
}

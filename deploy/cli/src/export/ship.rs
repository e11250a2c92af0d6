//! `ampco export --ship`: a trained policy as a small folder that is opened like a checkpoint.
//!
//! Separate because the other exports are for other programs, and this one is for our own: a checkpoint without
//! what only training needs (optimizers, memory, robots in mid-step).

use std::path::{Path, PathBuf};

use amp::Learning;
use anyhow::{Context, Result};
use run::Checkpoints;

use crate::evaluate::judge::Judge;
use crate::evaluate::subject::Kept;
use crate::failure::usage;

const CRITIC: &str = "critic.bin";

/// Writes the folder whole or not at all; gives its files and their sizes.
pub(super) fn write(kept: &Kept, folder: &Path) -> Result<Vec<(PathBuf, usize)>> {
    if folder.exists() {
        return Err(usage(format!(
            "{} is there already; remove it or give another --out",
            folder.display()
        )));
    }
    let mut draft = folder.as_os_str().to_owned();
    draft.push(".new");
    let draft = PathBuf::from(draft);
    std::fs::create_dir_all(&draft).with_context(|| format!("making {}", draft.display()))?;
    let (judge, judge_bytes) = Judge::of(kept)?.part();
    let critic = critic(kept)?;
    let mut parts = vec![
        ("policy.bin", kept.part("policy.bin")?),
        (judge, &judge_bytes[..]),
    ];
    parts.extend(critic.as_deref().map(|bytes| (CRITIC, bytes)));
    let written = Checkpoints::new(draft.clone())
        .write(kept.iteration, "shipped", &parts)
        .context("writing the policy")?;
    let config = kept.config_path()?;
    let text = std::fs::read_to_string(&config)
        .with_context(|| format!("reading {}", config.display()))?;
    run::replace_file(
        &written.join("config.toml"),
        without_origin(&text).as_bytes(),
    )
    .with_context(|| format!("writing {}", written.display()))?;
    std::fs::rename(&written, folder)
        .with_context(|| format!("moving the policy to {}", folder.display()))?;
    std::fs::remove_dir(&draft).with_context(|| format!("removing {}", draft.display()))?;
    let mut files = Vec::new();
    for entry in std::fs::read_dir(folder)? {
        let entry = entry?;
        files.push((entry.path(), entry.metadata()?.len() as usize));
    }
    files.sort();
    Ok(files)
}

/// The critic's weights, little-endian numbers like those of the policy. Runs that begin with this policy need them; what
/// was shipped without has none.
fn critic(kept: &Kept) -> Result<Option<Vec<u8>>> {
    if let Ok(bytes) = kept.part(CRITIC) {
        return Ok(Some(bytes.to_vec()));
    }
    let Ok(bytes) = kept.part("learning.bin") else {
        return Ok(None);
    };
    let mut learning = Learning::new(kept.learning.clone(), learner::robot(), 0)
        .context("setting up the networks")?;
    learning
        .load(bytes)
        .with_context(|| format!("loading learning.bin of {}", kept.path.display()))?;
    let numbers = learning.critic().iter().flat_map(|x| x.to_le_bytes());
    Ok(Some(numbers.collect()))
}

/// A resolved configuration, one key a line, without `run.from`: a folder that nobody else has.
fn without_origin(text: &str) -> String {
    let mut section = "";
    let kept = text.split_inclusive('\n').filter(|line| {
        if line.starts_with('[') {
            section = line.trim_end();
        }
        !(section == "[run]" && line.starts_with("from = "))
    });
    kept.collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evaluate::subject::Subject;
    use crate::place::Place;

    #[test]
    fn where_a_run_began_is_not_shipped() {
        let text = "# Resolved\n[run]\nfrom = \"/a/b\"\nseed = 1\n\n[other]\nfrom = 2\n";
        let shipped = "# Resolved\n[run]\nseed = 1\n\n[other]\nfrom = 2\n";
        assert_eq!(without_origin(text), shipped);
    }

    #[test]
    fn a_shipped_policy_opens_like_a_checkpoint_and_ships_again() {
        let walk = concat!(env!("CARGO_MANIFEST_DIR"), "/../policies/walk");
        let place = Place {
            runs_dir: "runs".into(),
        };
        let subject = Subject::open(&place, walk).unwrap();
        // It acts: the mean action on a standing robot's observation is finite and not nothing.
        let mut policy = subject.policy().unwrap();
        let (observation, mut action) = ([0.1; policy::INPUTS], [0.0; policy::OUTPUTS]);
        policy.means(&observation, 1, &mut action);
        assert!(action.iter().all(|a| a.is_finite()) && action.iter().any(|a| a.abs() > 0.01));

        let folder = tempfile::tempdir().unwrap();
        let again = folder.path().join("policies/walk");
        let files = write(&subject.kept, &again).unwrap();
        // Shipped before critics were, it has none to pass on.
        assert_eq!(files.len(), 4);
        for name in ["policy.bin", "judge.bin", "config.toml"] {
            let bytes = |folder: &Path| std::fs::read(folder.join(name)).unwrap();
            assert_eq!(bytes(&again), bytes(Path::new(walk)), "{name}");
        }
        assert_eq!(
            Kept::open(&place, again.to_str().unwrap())
                .unwrap()
                .iteration,
            subject.kept.iteration
        );
        // Nothing is written over.
        let error = write(&subject.kept, &again).unwrap_err().to_string();
        assert!(error.contains("is there already"), "{error}");
        assert_eq!(
            std::fs::read_dir(folder.path().join("policies"))
                .unwrap()
                .count(),
            1
        );
    }
}

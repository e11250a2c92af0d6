//! `ampco export --ship`: a trained policy as a small folder that is opened like a checkpoint.
//!
//! Separate because the other exports are for other programs, and this one is for our own: a checkpoint without
//! what only training needs (optimizers, memory, robots in mid-step).

use std::path::{Path, PathBuf};

use amp::Learning;
use anyhow::{Context, Result};
use judge::{Judge, Kept};
use motion::{ClipConfig, MotionConfig};
use run::motion::{Learned, Print};
use run::{Checkpoints, Config};
use terminal::failure::usage;

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
    let learned = kept.learned_from()?.map(named);
    let files = learned.as_ref().map_or(&[][..], |learned| &learned.files);
    let (config, comment) = configuration(kept, files)?;
    config.write(&written.join("config.toml"), &comment)?;
    if let Some(learned) = &learned {
        run::motion::write(&written, std::slice::from_ref(learned))?;
    }
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
    let mut learning = Learning::new(kept.learning.clone(), learner::robot(&kept.tables), 0)
        .context("setting up the networks")?;
    learning
        .load(bytes)
        .with_context(|| format!("loading learning.bin of {}", kept.path.display()))?;
    let numbers = learning.critic().iter().flat_map(|x| x.to_le_bytes());
    Ok(Some(numbers.collect()))
}

/// The configuration without what only this machine has, and the comment above it: no folder that the run began with,
/// and no motion file, which may not even be passed on. What was learned from is told by names and hashes.
fn configuration(kept: &Kept, learned: &[Print]) -> Result<(Config, String)> {
    let mut config = kept.config().clone();
    config.remove("run.from");
    let mut comment = format!(
        "Resolved configuration of run {}: every value, defaults included.\n\
         Written by `ampco export --ship`.",
        kept.run_name()?
    );
    let motion: MotionConfig = config.section()?;
    let (built_in, files): (Vec<_>, Vec<_>) =
        motion.clips.into_iter().partition(ClipConfig::is_built_in);
    // A policy that was shipped before has the hashes alone.
    let from_files = !files.is_empty() || !learned.is_empty();
    if !files.is_empty() {
        let rest = MotionConfig {
            clips: built_in,
            ..motion
        };
        config.resolve(&rest);
        if rest.clips.is_empty() {
            // No clip at all is refused by whoever reads it; without the key the default walks stand in.
            config.remove("motion.clips");
        }
    }
    if from_files {
        comment.push_str(
            "\nIt has learned from motion files, which are not part of it; [motion] has the rest.",
        );
    }
    for print in learned {
        comment.push_str(&format!("\n  {} {}", print.sha256, print.file.display()));
    }
    Ok((config, comment))
}

/// What it learned from, by names alone.
fn named(learned: Learned) -> Learned {
    let name = |print: Print| Print {
        file: print.file.file_name().unwrap_or_default().into(),
        ..print
    };
    Learned {
        since: 0,
        files: learned.files.into_iter().map(name).collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use judge::Subject;
    use terminal::Place;

    #[test]
    fn a_shipped_policy_opens_like_a_checkpoint_and_ships_again() {
        let walk = concat!(env!("CARGO_MANIFEST_DIR"), "/../policies/walk");
        let place = Place {
            runs_dir: "runs".into(),
        };
        let subject = Subject::open(&place, walk).unwrap();
        // It acts: the mean action on a standing robot's observation is finite and not nothing.
        let mut policy = subject.policy().unwrap();
        assert!(subject.kept.tables.is_papers_actor());
        let (observation, mut action) = ([0.1; g1::OBSERVATION], [0.0; policy::OUTPUTS]);
        policy.means(&observation, 1, &mut action);
        assert!(action.iter().all(|a| a.is_finite()) && action.iter().any(|a| a.abs() > 0.01));

        let folder = tempfile::tempdir().unwrap();
        let again = folder.path().join("policies/walk");
        let files = write(&subject.kept, &again).unwrap();
        assert_eq!(files.len(), 5);
        for name in ["policy.bin", "judge.bin", "critic.bin"] {
            let bytes = |folder: &Path| std::fs::read(folder.join(name)).unwrap();
            assert_eq!(bytes(&again), bytes(Path::new(walk)), "{name}");
        }
        let leaves = |folder: &Path| Config::read(&folder.join("config.toml")).unwrap().leaves();
        assert_eq!(leaves(&again), leaves(Path::new(walk)));
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

    /// Every text in a configuration, in lists as well.
    fn texts(value: &toml::Value, found: &mut Vec<String>) {
        match value {
            toml::Value::String(text) => found.push(text.clone()),
            toml::Value::Array(list) => list.iter().for_each(|value| texts(value, found)),
            toml::Value::Table(table) => table.values().for_each(|value| texts(value, found)),
            _ => {}
        }
    }

    #[test]
    fn nothing_that_only_this_machine_has_is_shipped() {
        let place = Place {
            runs_dir: "runs".into(),
        };
        let walk = concat!(env!("CARGO_MANIFEST_DIR"), "/../policies/walk");
        let folder = tempfile::tempdir().unwrap();
        let run = run::Folder::create(folder.path(), "mine").unwrap();
        let mut config = Config::read(&Path::new(walk).join("config.toml")).unwrap();
        config.put("run.from", "/home/me/runs/first", "a test");
        for (clips, left) in [
            ("[{folder='/home/me/walks'},{gait='stand',weight=0.5}]", 1),
            ("[{file='/home/me/a.csv',fps=50.0}]", 5),
        ] {
            config.set(&format!("motion.clips={clips}")).unwrap();
            config.write(&run.config_path(), "a test").unwrap();
            let at = run.checkpoints().path(30);
            std::fs::create_dir_all(&at).unwrap();
            for name in ["manifest.json", "policy.bin", "judge.bin", "critic.bin"] {
                std::fs::copy(Path::new(walk).join(name), at.join(name)).unwrap();
            }
            let print = Print {
                file: "/home/me/walks/a.csv".into(),
                sha256: "0123".into(),
            };
            run.note_motion(0, vec![print]).unwrap();
            let shipped = folder.path().join(format!("shipped-{left}"));
            let kept = Kept::open(&place, run.path().to_str().unwrap()).unwrap();
            write(&kept, &shipped).unwrap();

            let subject = Subject::open(&place, shipped.to_str().unwrap()).unwrap();
            let mut found = Vec::new();
            for value in subject.kept.config().leaves().values() {
                texts(value, &mut found);
            }
            assert!(
                !found.is_empty() && found.iter().all(|text| !text.contains('/')),
                "{found:?}"
            );
            for file in std::fs::read_dir(&shipped).unwrap() {
                let bytes = std::fs::read(file.unwrap().path()).unwrap();
                assert!(!bytes.windows(8).any(|window| window == b"/home/me"));
            }
            // What it learned from is known by name and hash, and that it cannot be had is no hindrance.
            let learned = subject.kept.learned_from().unwrap().unwrap();
            assert_eq!(
                learned.files,
                [Print {
                    file: "a.csv".into(),
                    sha256: "0123".into()
                }]
            );
            let motion: MotionConfig = subject.kept.config().section().unwrap();
            assert_eq!(motion.clips.len(), left);
            assert!(!subject.starts([0.5, 0.0, 0.0]).states.is_empty());
            // Shipped again it is the same.
            let again = folder.path().join(format!("again-{left}"));
            write(&subject.kept, &again).unwrap();
            let leaves =
                |folder: &Path| Config::read(&folder.join("config.toml")).unwrap().leaves();
            assert_eq!(leaves(&again), leaves(&shipped));
            let text = std::fs::read_to_string(again.join("config.toml")).unwrap();
            assert!(
                text.contains("# It has learned from motion files"),
                "{text}"
            );
            assert_eq!(
                run::motion::read(&again).unwrap(),
                run::motion::read(&shipped).unwrap()
            );
        }
    }
}

//! The run's motion files, copied here by their hashes, and the configuration that names the copies.

use std::fs;
use std::path::{Path, PathBuf};
use std::time::Duration;

use anyhow::{Context, Result, ensure};
use hosts::{Joined, Line, MotionFile, PIECE, Piece, PieceWanted};
use run::Config;
use run::motion::Print;
use sha2::{Digest, Sha256};
use toml::Value;

/// Longest that a piece may be on its way.
const PATIENCE: Duration = Duration::from_secs(60);

/// Brings the files that are not here yet, each whole and as it was on the learner's machine.
pub(super) async fn bring(line: &Line, joined: &Joined, folder: &Path) -> Result<()> {
    for file in &joined.motion {
        let path = copy_of(folder, Path::new(&file.path));
        let there = path.is_file() && Print::of(&path)?.sha256 == file.sha256;
        if !there {
            let bytes = fetch(line, file).await?;
            let place = path.parent().context("a folder for motion")?;
            fs::create_dir_all(place).with_context(|| place.display().to_string())?;
            run::replace_file(&path, &bytes).with_context(|| path.display().to_string())?;
        }
    }
    Ok(())
}

async fn fetch(line: &Line, file: &MotionFile) -> Result<Vec<u8>> {
    let mut bytes = Vec::new();
    loop {
        let wanted = PieceWanted {
            sha256: file.sha256.clone(),
            offset: bytes.len() as u64,
        };
        let Piece { bytes: piece } = line.call("Motion", wanted, PATIENCE).await?;
        bytes.extend_from_slice(&piece);
        if piece.len() < PIECE || bytes.len() as u64 > file.length {
            break;
        }
    }
    let digest = hexadecimal(&Sha256::digest(&bytes));
    ensure!(
        digest == file.sha256,
        "{} is no longer what the run began with: start the run again there",
        file.path
    );
    Ok(bytes)
}

/// Names the copies where the configuration names files of the learner's machine.
pub(super) fn point_to_copies(config: &mut Config, folder: &Path) {
    const CLIPS: &str = "motion.clips";
    let Some(Value::Array(clips)) = config.given(CLIPS) else {
        return;
    };
    let mut clips = clips.clone();
    for clip in &mut clips {
        if let Some(Value::String(file)) = clip.get_mut("file") {
            *file = copy_of(folder, Path::new(&*file)).display().to_string();
        }
        if let Some(Value::String(there)) = clip.get_mut("folder") {
            *there = copy_of_folder(folder, Path::new(&*there))
                .display()
                .to_string();
        }
    }
    config.put(CLIPS, clips, "ampco join");
}

/// Where the copy of a file is. Files of one folder stay together, since importers look beside them.
fn copy_of(folder: &Path, file: &Path) -> PathBuf {
    let place = file.parent().unwrap_or(Path::new(""));
    copy_of_folder(folder, place).join(file.file_name().unwrap_or_default())
}

fn copy_of_folder(folder: &Path, there: &Path) -> PathBuf {
    // Components alone, so that a slash at the end makes no other folder.
    let whole: PathBuf = there.components().collect();
    let digest = Sha256::digest(whole.as_os_str().as_encoded_bytes());
    folder.join("motion").join(&hexadecimal(&digest)[..16])
}

fn hexadecimal(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn clips_name_the_copies_and_files_of_a_folder_stay_together() {
        let text = "[motion]\nclips = [{ file = \"/m/a.csv\" }, { folder = \"/m/\" }, { gait = \"stand\" }]";
        let mut config = Config::parse(text, "config.toml").unwrap();
        let here = Path::new("/runs/walk.node");
        point_to_copies(&mut config, here);
        let clips = config.given("motion.clips").unwrap();
        let file = clips[0]["file"].as_str().unwrap();
        let folder = clips[1]["folder"].as_str().unwrap();
        assert!(file.starts_with("/runs/walk.node/motion/"), "{file}");
        assert_eq!(file, format!("{folder}/a.csv"));
        assert_eq!(clips[2]["gait"].as_str(), Some("stand"));
        let beside = copy_of(here, Path::new("/m/a.asf"));
        assert_eq!(beside.parent(), Path::new(file).parent());
        let elsewhere = copy_of(here, Path::new("/n/a.csv"));
        assert_ne!(elsewhere.parent(), Path::new(file).parent());
    }
}

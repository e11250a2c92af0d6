//! The motion that a policy was taught by, if it is still to be had.
//!
//! Separate because nobody who judges, plays or exports a policy needs it: files go, change, and are not shipped. Then
//! built-in gaits stand in for it, and never other motion that happens to lie where it lay.

use motion::{ClipConfig, Dataset, MotionConfig};

use super::subject::Kept;

/// The dataset of a policy, and if it is not the one that it learned from, why.
pub(super) fn dataset(kept: &Kept, motion: &MotionConfig) -> (Dataset, Option<String>) {
    match same(kept, motion) {
        Ok(dataset) => (dataset, None),
        Err(lack) => (stand_in(motion), Some(lack)),
    }
}

/// The motion itself, or what it lacks.
fn same(kept: &Kept, motion: &MotionConfig) -> Result<Dataset, String> {
    let text = |error: anyhow::Error| format!("{error:#}");
    let learned = kept.learned_from().map_err(text)?;
    let home = kept.home();
    let files = Dataset::files(motion, &home).map_err(|error| text(error.into()))?;
    if let Some(learned) = learned {
        let now = run::motion::Print::of_all(&files).map_err(|error| text(error.into()))?;
        let differences = run::motion::differences(&learned.files, &now);
        if let Some(first) = differences.first() {
            let all = differences.len();
            let more = if all > 1 {
                format!(", and {} more", all - 1)
            } else {
                String::new()
            };
            return Err(format!(
                "the motion that it learned from is not to be had as it was, {first}{more}"
            ));
        }
    }
    Dataset::load(motion, &home).map_err(|error| text(error.into()))
}

/// Of the same motion what the program makes itself, or where that is nothing, the default walks.
fn stand_in(motion: &MotionConfig) -> Dataset {
    let built_in: Vec<ClipConfig> = motion
        .clips
        .iter()
        .filter(|clip| clip.is_built_in())
        .cloned()
        .collect();
    let rest = MotionConfig {
        clips: built_in,
        ..motion.clone()
    };
    let none = std::path::Path::new(".");
    Dataset::load(&rest, none).unwrap_or_else(|_| {
        Dataset::load(&MotionConfig::default(), none).expect("the default gaits can be made")
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use run::motion::{Learned, Print};
    use std::path::Path;
    use terminal::Place;

    /// The shipped walk as if it had learned from a folder of tables.
    fn walk(place: &Path, clips: &str) -> Kept {
        let from = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../policies/walk"));
        for name in ["manifest.json", "policy.bin", "judge.bin", "critic.bin"] {
            std::fs::copy(from.join(name), place.join(name)).unwrap();
        }
        let mut config = run::Config::read(&from.join("config.toml")).unwrap();
        config.set(&format!("motion.clips={clips}")).unwrap();
        config.write(&place.join("config.toml"), "a test").unwrap();
        let runs = Place {
            runs_dir: "runs".into(),
        };
        Kept::open(&runs, place.to_str().unwrap()).unwrap()
    }

    fn motion(clips: &str) -> MotionConfig {
        toml::from_str(&format!("clips = {clips}")).unwrap()
    }

    fn names(dataset: &Dataset) -> Vec<String> {
        let clips = dataset.clips().iter().map(|clip| clip.name.clone());
        clips.filter(|name| !name.ends_with("mirrored")).collect()
    }

    fn table(path: &Path, knee: f32) {
        let mut row = [0.0_f32; 30];
        (row[2], row[3], row[10]) = (0.78, 1.0, knee);
        let row = row.map(|x| x.to_string()).join(",");
        std::fs::write(path, format!("{row}\n").repeat(60)).unwrap();
    }

    #[test]
    fn files_that_are_as_they_were_are_read_and_others_never() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("a.csv");
        table(&file, 0.3);
        let clips = "[{file=\"a.csv\",fps=50.0,quaternion=\"wxyz\"},{gait=\"walk\",speed=0.5}]";
        let kept = walk(folder.path(), clips);
        let learned = [Learned {
            since: 0,
            files: vec![Print::of(&file).unwrap()],
        }];
        run::motion::write(folder.path(), &learned).unwrap();
        let (there, lack) = dataset(&kept, &motion(clips));
        assert_eq!((names(&there)[0].as_str(), lack), ("a", None));

        table(&file, 0.5);
        let (changed, lack) = dataset(&kept, &motion(clips));
        assert_eq!(names(&changed).len(), 1);
        assert!(names(&changed)[0].contains("walk"), "{:?}", names(&changed));
        assert!(lack.unwrap().ends_with("a.csv has changed"));

        std::fs::remove_file(&file).unwrap();
        let (gone, lack) = dataset(&kept, &motion(clips));
        assert_eq!(names(&gone), names(&changed));
        assert!(lack.unwrap().contains("a.csv"));
    }

    #[test]
    fn default_walks_stand_in_where_there_were_files_alone() {
        let folder = tempfile::tempdir().unwrap();
        let clips = "[{folder=\"/nowhere/walks\"}]";
        let kept = walk(folder.path(), clips);
        let (dataset, lack) = dataset(&kept, &motion(clips));
        assert_eq!(names(&dataset).len(), 5);
        assert!(lack.unwrap().contains("/nowhere/walks"));
        // Built-in motion is what it always was, and nothing is said.
        let gaits = "[{gait=\"stand\"}]";
        let (stand, lack) = super::dataset(&kept, &motion(gaits));
        assert_eq!((names(&stand).len(), lack), (1, None));
    }
}

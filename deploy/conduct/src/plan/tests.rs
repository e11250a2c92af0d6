//! Studies as they are planned.

use super::*;

/// The study files that come with the project.
fn ours() -> Vec<(String, StudyFile)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../studies");
    let mut files = Vec::new();
    for entry in std::fs::read_dir(folder).unwrap().map(Result::unwrap) {
        let path = entry.path();
        if path
            .extension()
            .is_some_and(|extension| extension == "toml")
        {
            let text = std::fs::read_to_string(&path).unwrap();
            let name = path.file_stem().unwrap().to_string_lossy().into_owned();
            files.push((name, StudyFile::parse(&text).unwrap()));
        }
    }
    files.sort_by(|a, b| a.0.cmp(&b.0));
    files
}

#[test]
fn every_study_of_ours_can_be_planned() {
    let counts: Vec<(String, usize)> = ours()
        .iter()
        .map(|(name, file)| {
            let planned = plan(file, Path::new("."), name).unwrap();
            (name.clone(), planned.len())
        })
        .collect();
    let counts: Vec<(&str, usize)> = counts.iter().map(|(name, n)| (name.as_str(), *n)).collect();
    // 4 × 6, 8 × 10, 8 × 10, (9 + 2 + 2 + 1 settings) × 3, 3 × 2
    let expected = [
        ("flagship", 24),
        ("paper", 80),
        ("paper-pair", 80),
        ("sensitivity", 42),
        ("smoke", 6),
    ];
    assert_eq!(counts, expected);
}

#[test]
fn the_papers_study_has_its_sizes() {
    let files = ours();
    let (_, file) = files.iter().find(|(name, _)| name == "paper").unwrap();
    let planned = plan(file, Path::new("."), "paper").unwrap();
    assert_eq!((planned[0].target, planned[0].rows), (20_000, 4096 * 24));
    let window = planned[0].config.given("scheduler.window").unwrap();
    assert_eq!(window.as_integer(), Some(1000));
}

#[test]
fn a_run_that_was_made_otherwise_is_not_gone_on_with() {
    let place = tempfile::tempdir().unwrap();
    let folder = StudyFolder::create(place.path()).unwrap();
    let files = ours();
    let (_, smoke) = files.iter().find(|(name, _)| name == "smoke").unwrap();
    let planned = plan(smoke, Path::new("."), "smoke").unwrap();
    let run = run::Folder::create(&folder.runs(), &planned[0].name).unwrap();
    check_unchanged(&planned[0], &folder).unwrap();
    planned[0]
        .config
        .write(&run.config_path(), "a test")
        .unwrap();
    check_unchanged(&planned[0], &folder).unwrap();

    let mut other = planned[0].config.clone();
    other.put("task.reward.track.kernel", 0.125, "a test");
    other.write(&run.config_path(), "a test").unwrap();
    let refused = check_unchanged(&planned[0], &folder)
        .unwrap_err()
        .to_string();
    assert!(
        refused.contains("kernel = 0.125") && refused.contains("--out"),
        "{refused}"
    );
}

#[test]
fn earlier_runs_stay_in_the_study_unless_they_were_made_otherwise() {
    let place = tempfile::tempdir().unwrap();
    let folder = StudyFolder::create(place.path()).unwrap();
    let files = ours();
    let (_, smoke) = files.iter().find(|(name, _)| name == "smoke").unwrap();
    let here = Path::new(".");
    // As `study run` does, up to the runs themselves.
    let ask = |file: &StudyFile| -> Result<Vec<String>> {
        let planned = plan(file, here, "smoke")?;
        let all = together(file, &planned, &folder, here, "smoke")?;
        folder.begin(file, &planned, &all)?;
        for run in &planned {
            let made = run::Folder::create(&folder.runs(), &run.name)?;
            run.config.write(&made.config_path(), "a test")?;
        }
        Ok(all.iter().map(Cell::run_name).collect())
    };
    let with = |seeds: &[u64]| StudyFile {
        methods: vec!["ampco".into()],
        seeds: seeds.to_vec(),
        ..smoke.clone()
    };
    assert_eq!(ask(&with(&[1, 2])).unwrap(), ["ampco-seed1", "ampco-seed2"]);
    let all = ["ampco-seed1", "ampco-seed2", "ampco-seed3"];
    assert_eq!(ask(&with(&[3])).unwrap(), all);
    let asked: Vec<String> = folder.cells().unwrap().iter().map(Cell::run_name).collect();
    assert_eq!(asked, all);
    assert_eq!(
        folder.file().unwrap().seeds,
        [3],
        "as it was last asked for"
    );

    // Other values would mix what does not belong together, and nothing is written.
    let mut other = with(&[4]);
    other.iterations = Some(other.iterations.unwrap_or(0) + 1);
    let refused = format!("{:#}", ask(&other).unwrap_err());
    assert!(
        refused.contains("ampco-seed1") && refused.contains("iterations"),
        "{refused}"
    );
    assert_eq!(folder.file().unwrap().seeds, [3]);

    std::fs::remove_dir_all(folder.runs().join("ampco-seed2")).unwrap();
    assert_eq!(ask(&with(&[1])).unwrap(), ["ampco-seed1", "ampco-seed3"]);
    // A folder of an older program knows what was asked for last.
    std::fs::remove_file(place.path().join("runs.json")).unwrap();
    assert_eq!(ask(&with(&[5])).unwrap(), ["ampco-seed1", "ampco-seed5"]);
}

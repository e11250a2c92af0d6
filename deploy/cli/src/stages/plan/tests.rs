//! Plans of our own stages, of a foreign file, and of one with mistakes.

use super::*;

#[test]
fn those_of_ours_can_all_be_run() {
    for (name, _) in EMBEDDED {
        let plan = Plan::new(name, None, Some(2), &[]).unwrap();
        assert!(plan.stages.len() > 1, "{name}");
        let last = plan.stages.last().unwrap();
        assert_eq!(last.run, format!("{name}-{name}"));
        assert!(plan.describe().ends_with("transitions"), "{name}");
    }
}

#[test]
fn a_file_of_stages_has_presets_beside_it_and_values_of_its_own() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(
        folder.path().join("mine.toml"),
        "[task.reward.track]\nkernel = 5.0\n",
    )
    .unwrap();
    let path = folder.path().join("two.toml");
    let text = "title = \"Two\"\n\
            [[stages]]\nname = \"smoke\"\niterations = 3\non = \"smoke\"\n\
            [[stages]]\nname = \"b\"\non = \"mine.toml\"\niterations = 4\nppo.epochs = 9\nppo.minibatch = 32\n\
            [[stages]]\nname = \"c\"\niterations = 5\nunset = [\"ppo.minibatch\"]\nppo.gamma = 0.98\n";
    std::fs::write(&path, text).unwrap();
    let set = ["seed=7".to_owned(), "ppo.epochs=3".to_owned()];
    let plan = Plan::new(path.to_str().unwrap(), Some("x"), Some(2), &set).unwrap();
    let number = |stage: usize, key: &str| {
        let value = plan.stages[stage].config.given(key).unwrap();
        value
            .as_float()
            .or(value.as_integer().map(|x| x as f64))
            .unwrap()
    };
    assert_eq!(
        [plan.stages[0].run.as_str(), &plan.stages[1].run],
        ["x-smoke", "x-b"]
    );
    assert_eq!(
        [number(0, "run.iterations"), number(1, "run.iterations")],
        [3.0, 4.0]
    );
    assert_eq!(number(1, "task.reward.track.kernel"), 5.0);
    assert_eq!([number(0, "run.seed"), number(1, "run.seed")], [7.0, 7.0]);
    // What was typed goes before what the file says.
    assert_eq!(number(1, "ppo.epochs"), 3.0);
    // Without a preset of its own it lies on the stage before, and not on what was typed for that.
    assert_eq!(number(2, "task.reward.track.kernel"), 5.0);
    assert_eq!(
        [number(2, "ppo.minibatch"), number(2, "ppo.gamma")],
        [2048.0, 0.98]
    );
    assert_eq!(number(1, "ppo.minibatch"), 32.0);
    let told = plan.describe();
    let line =
        "x-c: on the stage before, unset = [\"ppo.minibatch\"], ppo.gamma = 0.98, 5 iterations of ";
    assert!(told.contains(line), "{told}");
    // Of a run folder only where it began may differ.
    let mut theirs = Config::parse(&plan.stages[1].config.to_toml(), "theirs").unwrap();
    theirs.put("run.from", "/somewhere", "theirs");
    assert_eq!(plan.stages[1].differs_from(&theirs), None);
    theirs.put("task.reward.track.kernel", 6.0, "theirs");
    let differs = plan.stages[1].differs_from(&theirs).unwrap();
    assert_eq!(
        differs,
        ("kernel = 6.0".to_owned(), "kernel = 5.0".to_owned())
    );
}

#[test]
fn stages_of_ours_come_before_others() {
    let stage = "[[stages]]\nname = \"mine\"\niterations = 1\n";
    let file = parse(&format!("title = \"t\"\nafter = \"pushed\"\n{stage}")).unwrap();
    let names: Vec<_> = file.stages.iter().map(|stage| &stage.name).collect();
    assert_eq!(names, ["walk", "pushed", "mine"]);
    let problem = |stages: &str| parse(&format!("title = \"t\"\n{stages}")).unwrap_err();
    let unknown = problem(&format!("after = \"pushd\"\n{stage}"));
    assert!(
        unknown.contains("after: there are no stages `pushd`; did you mean `pushed`"),
        "{unknown}"
    );
    let twice = problem(&format!(
        "after = \"pushed\"\n{}",
        stage.replace("mine", "walk")
    ));
    assert!(twice.contains("stage walk: there are two"), "{twice}");
}

#[test]
fn mistakes_are_named_with_the_stage() {
    let problem = |stages: &str| parse(&format!("title = \"t\"\n{stages}")).unwrap_err();
    let stage = "[[stages]]\nname = \"a\"\niterations = 1\non = \"smoke\"\n";
    assert!(problem("stages = []").contains("at least one"));
    assert!(problem(&stage.repeat(2)).contains("stage a: there are two"));
    assert!(problem(&stage.replace('1', "0")).contains("iterations = 0"));
    assert!(problem(&stage.replace("on = \"smoke\"\n", "")).contains("no stage is before it"));
    for (old, now) in [
        ("preset = \"smoke\"", "on = "),
        ("set = [\"ppo.epochs=9\"]", "ppo.epochs = 9"),
    ] {
        let told = problem(&format!("{stage}{old}\n"));
        assert!(told.contains("stage a: ") && told.contains(now), "{told}");
    }
    let folder = tempfile::tempdir().unwrap();
    let planned = |stages: &str| {
        let path = folder.path().join("mine.toml");
        std::fs::write(&path, format!("title = \"t\"\n{stages}")).unwrap();
        format!(
            "{:#}",
            Plan::new(path.to_str().unwrap(), None, None, &[]).unwrap_err()
        )
    };
    for (stages, parts) in [
        (format!("{stage}itrations = 2"), ["stage a", "itrations"]),
        (format!("{stage}ppo.epohcs = 2"), ["stage a", "epochs"]),
        (
            format!("{stage}unset = [\"ppo.epohcs\"]"),
            ["stage a", "did you mean `ppo.epochs`"],
        ),
        (
            stage.replace("\"smoke\"", "\"smok\""),
            ["stage a: on = \"smok\"", "did you mean `smoke`"],
        ),
    ] {
        let told = planned(&stages);
        assert!(parts.iter().all(|part| told.contains(part)), "{told}");
    }
    let unknown = Plan::new("pushd", None, None, &[]).unwrap_err().to_string();
    assert!(unknown.contains("did you mean `pushed`"), "{unknown}");
}

//! Presets of ours, and files that lie on one another, rightly and wrongly.

mod odd;

use super::*;

/// What a preset of ours lies on, and what it sets itself.
fn layer(text: &str) -> (Config, Config) {
    let mut table: toml::Table = toml::from_str(text).unwrap();
    let mut below = Config::default();
    if let Some(on) = table.remove("on") {
        lay_over(&mut below, on.as_str().unwrap()).unwrap();
    }
    for path in table
        .remove("unset")
        .iter()
        .flat_map(|list| list.as_array().unwrap())
    {
        below.remove(path.as_str().unwrap());
    }
    let own = Config::parse(&toml::to_string(&table).unwrap(), "a layer").unwrap();
    (below, own)
}

#[test]
fn a_preset_holds_only_what_differs_from_what_it_lies_on() {
    let mut defaults = Config::default();
    resolve::resolve(&mut defaults).unwrap();
    // The default is "one per core"; what that comes to is this machine's business.
    defaults.put("fleet.actors", 0, "the test");
    for (name, text) in EMBEDDED {
        let (below, own) = layer(text);
        for path in own.paths() {
            // What moves is one value.
            let ends = [".from", ".to", ".samples"];
            let path = ends
                .iter()
                .find_map(|end| path.strip_suffix(end))
                .unwrap_or(path);
            let given = own.given(path);
            let before = below.given(path).or_else(|| defaults.given(path));
            assert_ne!(given, before, "preset {name}: {path}");
        }
    }
}

#[test]
fn a_misspelt_preset_is_answered_with_the_closest() {
    let error = find("smok").unwrap_err().to_string();
    assert!(error.contains("did you mean `smoke`?"), "{error}");
}

#[test]
fn a_file_is_a_preset_and_names_its_runs() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("my walk.toml");
    std::fs::write(&path, "[run]\nseed = 3").unwrap();
    let preset = find(path.to_str().unwrap()).unwrap();
    assert_eq!(preset.name, "my-walk");
    assert_eq!(
        preset.config.given("run.seed").and_then(|v| v.as_integer()),
        Some(3)
    );
    let origin = path.canonicalize().unwrap().display().to_string();
    assert_eq!(preset.config.origin("run.seed"), Some(&*origin));
}

/// A folder with presets that are files.
struct Files(tempfile::TempDir);

impl Files {
    fn new(files: &[(&str, &str)]) -> Self {
        let folder = tempfile::tempdir().unwrap();
        for (name, text) in files {
            let path = folder.path().join(name);
            std::fs::create_dir_all(path.parent().unwrap()).unwrap();
            std::fs::write(path, text).unwrap();
        }
        Self(folder)
    }

    fn path(&self, name: &str) -> String {
        let path = self.0.path().canonicalize().unwrap().join(name);
        path.display().to_string()
    }

    fn find(&self, name: &str) -> Result<Config> {
        find(&self.path(name)).map(|preset| preset.config)
    }

    fn refused(&self, name: &str) -> String {
        format!("{:#}", self.find(name).unwrap_err())
    }
}

#[test]
fn a_file_lies_on_another_beside_it_and_that_on_one_of_ours() {
    let files = Files::new(&[
        (
            "deep/top.toml",
            "on = \"../base.toml\"\nunset = [\"randomization.impulse\", \"motion.clips\"]\n[ppo]\nepochs = 7",
        ),
        (
            "base.toml",
            "on = \"g1\"\n[ppo]\nepochs = 5\nminibatch = 64\n[motion]\nclips = [{ file = \"x.csv\" }]",
        ),
    ]);
    let (top, base) = (
        files.find("deep/top.toml").unwrap(),
        files.find("base.toml").unwrap(),
    );
    let number = |config: &Config, path: &str| config.given(path).and_then(|v| v.as_integer());
    assert_eq!(number(&top, "ppo.epochs"), Some(7));
    assert_eq!(number(&top, "ppo.minibatch"), Some(64));
    // `g1` has windows, pushes and clips of its own.
    assert_eq!(number(&top, "scheduler.window"), Some(400));
    let pushes = |config: &Config| config.given("randomization.impulse").is_some();
    assert!(pushes(&base) && !pushes(&top));
    assert!(top.given("motion.clips").is_none());
    for (path, origin) in [
        ("ppo.epochs", files.path("deep/top.toml")),
        ("ppo.minibatch", files.path("base.toml")),
        ("scheduler.window", "preset g1".to_owned()),
    ] {
        assert_eq!(top.origin(path), Some(&*origin), "{path}");
    }
    // What a file names lies beside that file, not beside the one on top of it.
    let clip = base.given("motion.clips").unwrap()[0]["file"]
        .as_str()
        .unwrap()
        .to_owned();
    assert_eq!(clip, files.path("x.csv"));
    // A mistake below is told of the file that it stands in.
    let mut wrong = top;
    wrong.put("ppo.epochs", -1, "the test");
    assert!(resolve::resolve(&mut wrong).is_err());
}

#[test]
fn a_circle_is_told_with_all_that_are_in_it() {
    let files = Files::new(&[
        ("a.toml", "on = \"./b.toml\""),
        ("b.toml", "on = \"c/../a.toml\""),
        ("c/self.toml", "on = \"self.toml\""),
    ]);
    let told = files.refused("a.toml");
    let (a, b) = (files.path("a.toml"), files.path("b.toml"));
    assert!(
        told.contains(&format!("`on` leads in a circle, {a} on {b} on {a}")),
        "{told}"
    );
    assert!(files.refused("c/self.toml").contains("circle"));
}

#[test]
fn what_is_not_there_is_named_with_the_closest() {
    let files = Files::new(&[
        ("on.toml", "on = \"reciep\""),
        (
            "unset.toml",
            "on = \"g1\"\nunset = [\"randomization.impuls\"]",
        ),
        ("nothing.toml", "unset = [\"ppo.epochs\"]"),
        ("term.toml", "unset = [\"task.reward.track\"]"),
        ("table.toml", "unset = [\"task.command\"]"),
        ("absent.toml", "unset = [\"task.gate.effort\"]"),
        ("kind.toml", "on = [\"g1\"]"),
        ("list.toml", "on = \"g1\"\nunset = \"task.gate\""),
        ("mixed.toml", "on = \"g1\"\nunset = [1]"),
        ("broken.toml", "on = \"below.toml\""),
        ("below.toml", "[ppo\n"),
    ]);
    for (name, parts) in [
        ("on.toml", ["on = \"reciep\"", "did you mean `recipe`"]),
        (
            "unset.toml",
            [
                "randomization.impuls",
                "did you mean `randomization.impulse`",
            ],
        ),
        (
            "nothing.toml",
            ["ppo.epochs", "it is 4 by default; take the line away"],
        ),
        (
            "term.toml",
            [
                "`task.reward.track`; it is there by default",
                "task.reward.track.weight = 0",
            ],
        ),
        (
            "table.toml",
            ["`task.command`", "by default; take the line away"],
        ),
        ("absent.toml", ["`task.gate.effort`", "take the line away"]),
        ("kind.toml", ["on = ", "on = \"ampco\""]),
        (
            "list.toml",
            ["unset = \"task.gate\"", "write a list of keys"],
        ),
        ("mixed.toml", ["unset = [1]", "write a list of keys"]),
        ("broken.toml", ["below.toml: not valid TOML", "line 1"]),
    ] {
        let told = files.refused(name);
        assert!(
            parts.iter().all(|part| told.contains(part)),
            "{name}: {told}"
        );
    }
}

#[test]
fn another_method_takes_the_place_of_the_one_below() {
    let files = Files::new(&[
        (
            "other.toml",
            "on = \"amp-0.5\"\n[scheduler.method.amp_roger]\nlower = 0.1\nupper = 0.6",
        ),
        (
            "same.toml",
            "on = \"other.toml\"\n[scheduler.method.amp_roger]\nupper = 0.7",
        ),
        (
            "plain.toml",
            "on = \"same.toml\"\n[scheduler]\nmethod = \"adamimic\"",
        ),
    ]);
    let method = |name| {
        let mut config = files.find(name).unwrap();
        resolve::resolve(&mut config).unwrap();
        config.given("scheduler.method").unwrap().to_string()
    };
    // `amp-0.5` has the method amp.
    assert_eq!(
        method("other.toml"),
        "{ amp_roger = { lower = 0.1, upper = 0.6 } }"
    );
    assert_eq!(
        method("same.toml"),
        "{ amp_roger = { lower = 0.1, upper = 0.7 } }"
    );
    assert_eq!(method("plain.toml"), "\"adamimic\"");
    let config = files.find("plain.toml").unwrap();
    assert_eq!(
        config.origin("scheduler.method"),
        Some(&*files.path("plain.toml"))
    );
}

#[test]
fn a_method_on_another_base_keeps_its_own_and_has_the_rest_of_the_base() {
    let leaves = |config: &Config| {
        let mut config = config.clone();
        resolve::settle_all(&mut config).unwrap();
        config.leaves()
    };
    let base = leaves(&find("pair").unwrap().config);
    for name in [
        "amp-0.5",
        "amp-0.7",
        "amp-0.8",
        "amp-roger",
        "adamimic",
        "ampco",
        "ampco-without-aig",
        "ampco-without-roger",
    ] {
        let (own, moved) = (find(name).unwrap(), find_on(name, "pair").unwrap());
        assert_eq!((moved.name.as_str(), moved.notices.len()), (name, 0));
        let (own, moved) = (leaves(&own.config), leaves(&moved.config));
        let is_method = |path: &str| path.starts_with("scheduler.method");
        let rest = |of: &std::collections::BTreeMap<String, toml::Value>, method: bool| {
            let mut of = of.clone();
            of.retain(|path, _| is_method(path) == method);
            of
        };
        assert_eq!(rest(&moved, true), rest(&own, true), "{name}");
        assert_eq!(rest(&moved, false), rest(&base, false), "{name}");
        assert_eq!(
            moved["discriminator.frames"].as_integer(),
            Some(2),
            "{name}"
        );
    }
}

#[test]
fn a_base_with_a_method_lends_it_to_nobody() {
    let method = |given: &str| {
        let mut config = find_on(given, "amp-0.5").unwrap().config;
        resolve::resolve(&mut config).unwrap();
        config.given("scheduler.method").unwrap().to_string()
    };
    // `amp-0.5` has the method amp.
    assert_eq!(method("ampco"), "\"ampco\"");
    assert_eq!(method("adamimic"), "\"adamimic\"");
    let files = Files::new(&[
        ("mine.toml", "on = \"amp-0.8\"\n[ppo]\nepochs = 7"),
        (
            "vain.toml",
            "on = \"recipe\"\nunset = [\"exploration.sigma\"]",
        ),
    ]);
    // What it sets, on the base; the method is that of the preset by itself.
    let mine = find_on(&files.path("mine.toml"), "pair").unwrap().config;
    assert_eq!(
        mine.given("ppo.epochs").and_then(|v| v.as_integer()),
        Some(7)
    );
    assert_eq!(
        mine.given("scheduler.method").unwrap()["amp"]["style_weight"].as_float(),
        Some(0.8)
    );
    // What it takes away has to be there.
    let told = format!(
        "{:#}",
        find_on(&files.path("vain.toml"), "pair").unwrap_err()
    );
    assert!(
        told.contains("exploration.sigma") && told.contains("vain.toml"),
        "{told}"
    );
}

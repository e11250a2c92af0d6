//! Presets that leave something broken, say nothing, or are no files.

use super::*;

#[test]
fn what_unset_leaves_broken_is_blamed_on_it() {
    let files = Files::new(&[
        (
            "range.toml",
            "on = \"ampco-literal\"\nunset = [\"randomization.friction.range\"]",
        ),
        (
            "method.toml",
            "on = \"amp-0.5\"\nunset = [\"scheduler.method.amp.style_weight\"]",
        ),
        (
            "choice.toml",
            "on = \"amp-0.5\"\nunset = [\"scheduler.method.amp\"]",
        ),
        // Nothing is left that pays.
        (
            "pay.toml",
            "on = \"pay-below.toml\"\nunset = [\"task.reward.track_wide\"]",
        ),
        (
            "pay-below.toml",
            "[task.reward]\ntrack = { weight = 0.0 }\ntrack_wide = { weight = 1.0 }",
        ),
        // At odds with a value that was taken away elsewhere in the section.
        (
            "kinds.toml",
            "on = \"kinds-below.toml\"\nunset = [\"task.command.forward\"]",
        ),
        (
            "kinds-below.toml",
            "[task.command]\nforward = [-0.5, 1.0]\nkinds = { backward = 1.0 }",
        ),
        (
            "again.toml",
            "on = \"range.toml\"\n[randomization.friction]\nrange = [0.5, 1.0]",
        ),
    ]);
    let told = |name: &str| {
        let mut config = files.find(name).unwrap();
        format!("{:#}", resolve::resolve(&mut config).unwrap_err())
    };
    let range = told("range.toml");
    let place = files.path("range.toml");
    assert!(range.starts_with(&place), "{range}");
    let says = "`range` is missing; unset takes \"randomization.friction.range\" away there: give it another value, or \
                unset all of \"randomization.friction\"";
    assert!(range.ends_with(says), "{range}");
    for (name, path) in [
        ("method.toml", "scheduler.method.amp.style_weight"),
        ("choice.toml", "scheduler.method.amp"),
        ("pay.toml", "task.reward.track_wide"),
    ] {
        let said = told(name);
        let blamed = said.starts_with(&files.path(name));
        assert!(
            blamed && said.contains(&format!("unset takes \"{path}\" away")),
            "{said}"
        );
    }
    let kinds = told("kinds.toml");
    assert!(
        kinds.starts_with(&files.path("kinds-below.toml"))
            && kinds.contains(&format!(
                "unset of {} takes \"task.command.forward\" away",
                files.path("kinds.toml")
            )),
        "{kinds}"
    );
    // What is set again is not missed.
    let mut again = files.find("again.toml").unwrap();
    resolve::resolve(&mut again).unwrap();
    again.put("randomization.friction.range", vec![2.0, 1.0], "the test");
    let said = resolve::resolve(&mut again).unwrap_err().to_string();
    assert!(
        said.starts_with("the test: ") && !said.contains("unset"),
        "{said}"
    );
}

#[test]
fn a_preset_that_says_nothing_is_told() {
    let files = Files::new(&[
        ("empty.toml", ""),
        ("comment.toml", "# on = \"g1\"\n[ppo]\n"),
        ("term.toml", "[task.gate.effort]\n"),
        ("on.toml", "on = \"g1\""),
        ("below.toml", "on = \"empty.toml\"\n[ppo]\nepochs = 3"),
        (
            "stays.toml",
            "on = \"ampco\"\nunset = [\"task.reward.track\"]",
        ),
    ]);
    let notices = |name: &str| find(&files.path(name)).unwrap().notices;
    for (name, told) in [
        ("empty.toml", Some(("empty.toml", "changes nothing"))),
        ("comment.toml", Some(("comment.toml", "changes nothing"))),
        ("below.toml", Some(("empty.toml", "changes nothing"))),
        (
            "stays.toml",
            Some(("stays.toml", "set task.reward.track.weight = 0")),
        ),
        ("term.toml", None),
        ("on.toml", None),
    ] {
        let said = notices(name);
        match told {
            Some((file, words)) => assert!(
                said.len() == 1
                    && said[0].starts_with(&files.path(file))
                    && said[0].contains(words),
                "{name}: {said:?}"
            ),
            None => assert_eq!(said, [""; 0], "{name}"),
        }
    }
}

#[test]
fn what_is_no_file_is_told_for_what_it_is() {
    let files = Files::new(&[("folder/inside.toml", "")]);
    for (given, what) in [
        (files.path("folder"), "is a folder and no preset"),
        (
            "/dev/null".to_owned(),
            "give its text on standard input, as `-`",
        ),
        (String::new(), "the name of the preset is empty"),
        (files.path("nowhere"), "there is no preset and no file"),
    ] {
        let said = format!("{:#}", find(&given).unwrap_err());
        assert!(said.contains(what), "{given}: {said}");
    }
}

//! What a run that goes on may change of its configuration, and what not.
//!
//! A checkpoint holds networks of certain sizes, draws of certain generators and a schedule that has decided. A value that
//! would have to change those is refused before anything is written; any other counts from the first iteration on.
//! Separate because train asks it, and learner and command line are tested against it key by key.

use std::collections::BTreeMap;
use std::fmt;

use toml::Value;

use crate::config::Config;

/// Whether a key of a run that goes on may change.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rule {
    /// It may, and counts from the first iteration on.
    Free,
    /// It may not; why.
    Fixed(&'static str),
    /// It may take another value, but neither be added nor taken away; why.
    Present(&'static str),
    /// It may while another key has a value, and not otherwise; why.
    While(&'static str, &'static str, &'static str),
    /// It may until Phase II has begun; why.
    PhaseOne(&'static str),
}

use Rule::{Fixed, Free, PhaseOne, Present, While};

const SHAPE: &str = "networks keep the shape that their checkpoint has";
const SEEN: &str = "networks and their statistics are of what was seen so far";
const WIDTH: Rule = While(
    "exploration.kind",
    "scheduled",
    "learned exploration began with it and has its own widths by now",
);

/// Section, rule, and the keys that it holds for; no key stands for all that have no row of their own. Sections on which
/// nothing in a checkpoint depends but the robots, which begin anew where they do not fit, need no more than that.
const TABLE: &[(&str, Rule, &[&str])] = &[
    (
        "run",
        Free,
        &[
            "mode",
            "max_lag",
            "iterations",
            "minutes",
            "deadlines",
            "journal",
        ],
    ),
    ("run", Free, &["checkpoint_every", "keep_checkpoints"]),
    (
        "run",
        Fixed("random draws go on from where they are"),
        &["seed"],
    ),
    (
        "run",
        Fixed("the run has begun, and with what is settled"),
        &["from"],
    ),
    ("fleet", Free, &[]),
    ("task", Free, &[]),
    ("randomization", Free, &[]),
    ("event", Free, &[]),
    ("motion", Free, &[]),
    ("observation", Fixed(SEEN), &[]),
    ("policy", Fixed(SHAPE), &["hidden", "critic_hidden"]),
    ("policy", Free, &["observation_clip"]),
    (
        "exploration",
        Fixed("the widths of one kind are not those of the other"),
        &["kind"],
    ),
    (
        "exploration",
        WIDTH,
        &["sigma", "waist_factor", "arm_factor"],
    ),
    ("ppo", Free, &["gamma", "lambda", "reward_scale", "clip"]),
    ("ppo", Free, &["epochs", "minibatch"]),
    ("ppo", Free, &["learning_rate", "schedule", "kl_target"]),
    (
        "ppo",
        Free,
        &[
            "mirrored_share",
            "critic_first",
            "symmetry_weight",
            "symmetry_share",
        ],
    ),
    ("ppo", Free, &["off_policy", "threads"]),
    ("discriminator", Fixed(SHAPE), &["frames", "hidden"]),
    (
        "discriminator",
        Fixed("the discriminator knows states that are so far apart"),
        &["spacing"],
    ),
    (
        "discriminator",
        Fixed("the numbers of a discriminator mean something else with another loss"),
        &["loss"],
    ),
    ("discriminator", Present(SHAPE), &["command_blur"]),
    (
        "discriminator",
        Free,
        &["steps", "batch", "learning_rate", "gradient_penalty"],
    ),
    ("discriminator", Free, &["replay_capacity", "replay_insert"]),
    (
        "scheduler",
        PhaseOne("Phase II was entered by it, and nothing leads back"),
        &[],
    ),
];

/// The rule of a dotted key; `None` for one that no row speaks of.
pub fn rule(path: &str) -> Option<Rule> {
    let (section, key) = path.split_once('.').unwrap_or((path, ""));
    let first = key.split('.').next().unwrap_or(key);
    let rows = TABLE.iter().filter(|(name, ..)| *name == section);
    let own = rows.clone().find(|(_, _, keys)| keys.contains(&first));
    let whole = || rows.clone().find(|(_, _, keys)| keys.is_empty());
    own.or_else(whole).map(|(_, rule, _)| *rule)
}

/// A value that is another than before; as text, what it was and is.
#[derive(Clone, Debug, PartialEq)]
pub struct Change {
    /// The dotted key.
    pub path: String,
    /// The value in the checkpoint's configuration.
    pub before: Option<Value>,
    /// The value from now on.
    pub after: Option<Value>,
}

impl fmt::Display for Change {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let text = |value: &Option<Value>| value.as_ref().map_or("none".to_owned(), shortened);
        write!(
            f,
            "{}: {} → {}",
            self.path,
            text(&self.before),
            text(&self.after)
        )
    }
}

/// A list of clips would bury a line.
fn shortened(value: &Value) -> String {
    let text = value.to_string();
    match text.char_indices().nth(80) {
        Some((end, _)) => format!("{}…", &text[..end]),
        None => text,
    }
}

/// Values that a run that goes on cannot take.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error(
    "a resumed run cannot change {}; leave it as it was, or begin a new run (`ampco train --from` takes this one's policy)",
    .0.join(", nor ")
)]
pub struct Refused(Vec<String>);

/// What differs between two resolved configurations, by key.
pub fn changes(before: &Config, after: &Config) -> Vec<Change> {
    let (before, after) = (before.leaves(), after.leaves());
    let paths: BTreeMap<&String, ()> = before
        .keys()
        .chain(after.keys())
        .map(|path| (path, ()))
        .collect();
    let change = |path: &String| Change {
        path: path.clone(),
        before: before.get(path).cloned(),
        after: after.get(path).cloned(),
    };
    paths
        .keys()
        .map(|path| change(path))
        .filter(|change| change.before != change.after)
        .collect()
}

/// The changes that make the configuration `before` of a checkpoint, resolved, to `after`, if a run may go on with all of
/// them; `in_phase_two` is asked only where it matters.
pub fn check(
    before: &Config,
    after: &Config,
    in_phase_two: impl FnOnce() -> bool,
) -> Result<Vec<Change>, Refused> {
    let changes = changes(before, after);
    let is_of_phase_one = |change: &Change| matches!(rule(&change.path), None | Some(PhaseOne(_)));
    let two = changes.iter().any(is_of_phase_one) && in_phase_two();
    let mut refused = Vec::new();
    for change in &changes {
        let why = match rule(&change.path) {
            Some(Free) => None,
            Some(Fixed(why)) => Some(why),
            Some(Present(why)) => {
                let there = |config: &Config| config.given(&change.path).is_some();
                (there(before) != there(after)).then_some(why)
            }
            Some(While(key, value, why)) => {
                let is = before.given(key).and_then(Value::as_str) == Some(value);
                (!is).then_some(why)
            }
            Some(PhaseOne(why)) => two.then_some(why),
            None => Some("nothing is known of it"),
        };
        if let Some(why) = why {
            let origin = after.origin(&change.path);
            let origin = origin.map_or(String::new(), |origin| format!(" from {origin}"));
            refused.push(format!("{change}{origin} ({why})"));
        }
    }
    if refused.is_empty() {
        Ok(changes)
    } else {
        Err(Refused(refused))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn config(text: &str) -> Config {
        Config::parse(text, "a test").unwrap()
    }

    fn outcome(before: &str, after: &str, two: bool) -> Result<Vec<String>, String> {
        let checked = check(&config(before), &config(after), || two);
        checked
            .map(|changes| changes.iter().map(ToString::to_string).collect())
            .map_err(|refused| refused.to_string())
    }

    #[test]
    fn a_rate_may_change_and_a_shape_may_not() {
        let before = "[ppo]\nlearning_rate = 0.0003\n[policy]\nhidden = [8, 8]";
        let rate = before.replace("0.0003", "0.00002");
        assert_eq!(
            outcome(before, &rate, false).unwrap(),
            ["ppo.learning_rate: 0.0003 → 0.00002"]
        );
        assert_eq!(outcome(before, before, false).unwrap(), [""; 0]);
        let both = rate.replace("[8, 8]", "[32, 32]");
        let refused = outcome(before, &both, false).unwrap_err();
        assert!(
            refused.contains("policy.hidden: [8, 8] → [32, 32] from a test")
                && refused.contains("--from")
                && !refused.contains("learning_rate"),
            "{refused}"
        );
    }

    #[test]
    fn a_value_inside_may_change_where_its_presence_may_not() {
        let blurred = "[discriminator]\ncommand_blur = [0.1, 0.1, 0.1]";
        let wider = "[discriminator]\ncommand_blur = [0.2, 0.1, 0.1]";
        assert_eq!(outcome(blurred, wider, true).unwrap().len(), 1);
        for (before, after) in [(blurred, ""), ("", wider)] {
            let refused = outcome(before, after, false).unwrap_err();
            assert!(
                refused.contains("none") && refused.contains("shape"),
                "{refused}"
            );
        }
    }

    #[test]
    fn what_is_seen_stays() {
        let before = "[observation.actor]\nterms = ['height']\npast = 0";
        for (from, to) in [
            ("past = 0", "past = 4"),
            ("['height']", "['height', 'gravity']"),
        ] {
            let refused = outcome(before, &before.replace(from, to), false).unwrap_err();
            assert!(
                refused.contains("observation.actor")
                    && refused.contains("seen so far")
                    && refused.contains("--from"),
                "{refused}"
            );
        }
        assert_eq!(
            rule("observation.critic.term.height.scale"),
            Some(Fixed(SEEN))
        );
    }

    #[test]
    fn first_widths_count_only_where_a_schedule_draws_on_them() {
        for (kind, free) in [("scheduled", true), ("learned", false)] {
            let before = format!("[exploration]\nkind = \"{kind}\"\nsigma = 0.6");
            let after = before.replace("0.6", "0.5");
            assert_eq!(outcome(&before, &after, false).is_ok(), free, "{kind}");
        }
    }

    #[test]
    fn the_schedule_may_change_until_it_has_decided() {
        let (before, after) = ("[scheduler]\nwindow = 4", "[scheduler]\nwindow = 5");
        assert!(outcome(before, after, false).is_ok());
        let refused = outcome(before, after, true).unwrap_err();
        assert!(
            refused.contains("scheduler.window") && refused.contains("Phase II"),
            "{refused}"
        );
        let other = "[ppo]\nepochs = 4";
        let asked = check(&config(""), &config(other), || panic!("of no matter here"));
        assert_eq!(asked.unwrap().len(), 1);
    }

    #[test]
    fn a_key_without_a_rule_is_refused() {
        assert_eq!(rule("optimizer.kind"), None);
        assert_eq!(rule("ppo.new_key"), None);
        assert_eq!(rule("exploration.sigma.from"), Some(WIDTH));
        assert!(outcome("", "[ppo]\nnew_key = 1", false).is_err());
    }
}

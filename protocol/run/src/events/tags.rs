//! Which figure of the metrics gets which name in TensorBoard.
//!
//! Separate because the names are a convention of the field: those of `rsl_rl`'s runners where it has one, `AMPCO/` for
//! what is this method's own.

use serde_json::Value;

/// Keys of a metrics line that have a name in the field; every other number is `AMPCO/<key>`.
const NAMES: [(&str, &str); 18] = [
    // Mean over the batch of what one step paid, not the sum over an episode.
    ("reward_mean", "Train/mean_reward"),
    ("episode_length", "Train/mean_episode_length"),
    ("value_loss", "Loss/value_function"),
    ("surrogate", "Loss/surrogate"),
    ("entropy", "Loss/entropy"),
    ("learning_rate", "Loss/learning_rate"),
    ("kl", "Loss/kl"),
    ("clip_fraction", "Loss/clip_fraction"),
    ("asymmetry", "Loss/asymmetry"),
    ("explained_variance", "Loss/explained_variance"),
    ("gradient_norm", "Loss/gradient_norm"),
    ("discriminator_loss", "Loss/discriminator"),
    ("gradient_penalty", "Loss/gradient_penalty"),
    ("sigma", "Policy/mean_noise_std"),
    ("timing.samples_per_second", "Perf/total_fps"),
    ("timing.gather_seconds", "Perf/collection_time"),
    ("timing.learn_seconds", "Perf/learning_time"),
    ("policy_lag", "Perf/policy_lag"),
];

/// Keys with a group of their own keep it.
const GROUPS: [&str; 3] = ["reward/", "gate/", "termination/"];

/// Every number of a record with its name. Inner objects are flattened; `iteration` is the axis and no figure.
pub(super) fn scalars(record: &Value) -> Vec<(String, f64)> {
    let mut found = Vec::new();
    collect("", record, &mut found);
    found
}

fn collect(prefix: &str, value: &Value, found: &mut Vec<(String, f64)>) {
    for (key, value) in value.as_object().into_iter().flatten() {
        let path = format!("{prefix}{key}");
        if let Some(number) = value.as_f64() {
            if path != "iteration" {
                found.push((name(&path), number));
            }
        } else if let Some(flag) = value.as_bool() {
            found.push((name(&path), f64::from(u8::from(flag))));
        } else {
            collect(&format!("{path}."), value, found);
        }
    }
}

fn name(path: &str) -> String {
    if GROUPS.iter().any(|group| path.starts_with(group)) {
        return path.to_owned();
    }
    let known = NAMES.iter().find(|(key, _)| *key == path);
    match (known, path.strip_prefix("timing.")) {
        (Some((_, name)), _) => (*name).to_owned(),
        (None, Some(timing)) => format!("Perf/{}", timing.replace('.', "_")),
        (None, None) => format!("AMPCO/{path}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn numbers_are_named_and_nothing_else_is_shown() {
        let record = json!({
            "iteration": 7, "reward_mean": 0.5, "style_weight": 0.7, "switched_at": null, "scheduler_away": true,
            "fault": "none", "termination/stray": 3, "reward/track": 0.5, "timing": { "samples_per_second": 9.0, "learning": { "ppo": 0.25 } },
        });
        let mut got = scalars(&record);
        got.sort_by(|a, b| a.0.cmp(&b.0));
        let expected = [
            ("AMPCO/scheduler_away", 1.0),
            ("AMPCO/style_weight", 0.7),
            ("Perf/learning_ppo", 0.25),
            ("Perf/total_fps", 9.0),
            ("Train/mean_reward", 0.5),
            ("reward/track", 0.5),
            ("termination/stray", 3.0),
        ];
        assert_eq!(got, expected.map(|(name, value)| (name.to_owned(), value)));
    }
}

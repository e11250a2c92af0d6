//! Keys that are spelt otherwise now: an older file is refused with the new spelling.

/// Section and key as they were, and how the same is said now.
const MOVED: [(&str, &str, &str); 30] = [
    ("motion", "stratify", "motion.draw = \"speeds\""),
    ("task", "physics", "fleet.physics = \"batched\""),
    ("task", "kernel", "task.reward.track.kernel = 2.0"),
    ("task", "wide_kernel", "task.reward.track_wide.kernel = 2.0"),
    (
        "task",
        "yaw_rate_weight",
        "task.reward.track.yaw_rate = 0.5",
    ),
    ("task", "effort_weight", "task.gate.effort.weight = 0.02"),
    ("task", "fall_height", "task.termination.fall.height = 0.5"),
    (
        "task",
        "fall_upright",
        "task.termination.fall.upright = 0.6",
    ),
    (
        "task",
        "episode_steps",
        "task.termination.time_out.steps = 300",
    ),
    (
        "task",
        "staggered",
        "task.termination.time_out.staggered = false",
    ),
    ("task", "stray", "task.termination.stray = { share = 0.4 }"),
    (
        "task",
        "curriculum",
        "task.reward.track.kernel = { from = 2.0, to = 4.0, samples = [1.5e6, 2.1e6] }",
    ),
    ("exploration", "initial_sigma", SIGMA),
    ("exploration", "final_sigma", SIGMA),
    ("exploration", "hold_samples", SIGMA),
    ("exploration", "final_samples", SIGMA),
    (
        "ppo",
        "kl_settle",
        "ppo.kl_target = { from = 0.03, to = 0.003, samples = [8e6, 60e6] }",
    ),
    (
        "ppo",
        "mirrored_fade",
        "ppo.mirrored_share = { from = 0.5, to = 0.0, samples = [1e6, 2e6] }",
    ),
    ("randomization", "mass_range", MASS),
    ("randomization", "friction_range", FRICTION),
    (
        "randomization",
        "com_range",
        "randomization.com_offset = { range = [-0.1, 0.1] }",
    ),
    ("randomization", "impulse_range", IMPULSE),
    ("randomization", "impulse_seconds", IMPULSE),
    (
        "randomization",
        "linear_velocity_range",
        "randomization.linear_velocity_noise = { range = [-0.1, 0.1] }",
    ),
    (
        "randomization",
        "angular_velocity_range",
        "randomization.angular_velocity_noise = { range = [-0.2, 0.2] }",
    ),
    (
        "randomization",
        "gravity_range",
        "randomization.gravity_noise = { range = [-0.05, 0.05] }",
    ),
    (
        "randomization",
        "joint_position_range",
        "randomization.joint_position_noise = { range = [-0.01, 0.01] }",
    ),
    (
        "randomization",
        "joint_velocity_range",
        "randomization.joint_velocity_noise = { range = [-1.5, 1.5] }",
    ),
    ("randomization", "from_samples", STRENGTH),
    ("randomization", "to_samples", STRENGTH),
];

const SIGMA: &str = "exploration.sigma = { from = 0.6, to = 0.3, samples = [1e6, 3e6] }";
const MASS: &str = "randomization.mass_variation = { range = [-0.5, 0.5] }";
const FRICTION: &str = "randomization.friction = { range = [0.5, 1.0] }";
const IMPULSE: &str = "randomization.impulse = { range = [0.0, 0.5], seconds = [5.0, 10.0] }";
const STRENGTH: &str = "randomization.strength = { from = 0.0, to = 1.0, samples = [0.0, 3e6] }";

/// Keys that no choice is left of, and what they are now, as TOML; `none` of what is not there any more.
pub(super) const GONE: [(&str, &str); 20] = [
    ("ppo.value_clip", "none"),
    ("ppo.value_coefficient", "1.0"),
    ("ppo.entropy_coefficient", "0.0"),
    ("ppo.kl_band", "1.5"),
    ("ppo.rate_factor", "1.3"),
    ("ppo.min_learning_rate", "1e-5"),
    ("ppo.max_learning_rate", "1e-2"),
    ("ppo.gradient_norm", "1.0"),
    ("ppo.advantage_normalization", r#""batch""#),
    ("discriminator.decay", "1e-3"),
    ("discriminator.head_decay", "1e-2"),
    ("discriminator.replay_share", "0.5"),
    ("discriminator.feature_clip", "5.0"),
    (
        "discriminator.floors",
        "{ height = 0.03, linear_velocity = 0.3, angular_velocity = 0.5, joint_position = 0.1, joint_velocity = 2.0 }",
    ),
    ("policy.last_gain", "0.01"),
    ("policy.observation_floor", "0.02"),
    ("scheduler.rise_share", "0.1"),
    ("scheduler.last_share", "0.8"),
    ("exploration.min_sigma", "0.05"),
    ("exploration.max_sigma", "1.0"),
];

/// The keys that no choice is left of.
pub fn gone() -> impl Iterator<Item = &'static str> {
    GONE.iter().map(|(path, _)| *path)
}

/// The keys that moved, with an example of how each is said now.
pub fn moved() -> impl Iterator<Item = (String, &'static str)> {
    MOVED
        .iter()
        .map(|(section, key, now)| (format!("{section}.{key}"), *now))
}

/// How a key of an older file is said now; none if it never was one.
pub(super) fn remedy(section: &str, key: &str) -> Option<String> {
    let given = format!("{section}.{key}");
    let inside = |old: &str| {
        given
            .strip_prefix(old)
            .is_some_and(|rest| rest.is_empty() || rest.starts_with('.'))
    };
    if let Some((_, fixed)) = GONE.iter().find(|(old, _)| inside(old)) {
        return Some(match *fixed {
            "none" => "there is no such thing any more; take the line away".to_owned(),
            fixed => format!("it is no choice any more, and always {fixed}; take the line away"),
        });
    }
    let (old, now) = moved().find(|(old, _)| inside(old))?;
    let moves = match &*old {
        "task.curriculum" => "what moves over the samples says so itself",
        _ => "it is spelt otherwise now",
    };
    Some(format!("{moves}, as in {now}"))
}

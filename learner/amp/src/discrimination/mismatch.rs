//! Reference motion beside a command that it does not follow: what the discriminator is shown as wrong besides.
//!
//! Separate because the policy alone need not show it. Where robots obey, nothing they do tells the discriminator what
//! disobeying looks like, and it rates motion that it has never seen beside a command by how human it is: a robot that
//! stands still where it is told to step aside earned two thirds of the style reward. A conditional discriminator that
//! is trained on true pairs that do not belong together (Reed et al. 2016, "Generative Adversarial Text to Image
//! Synthesis", matching-aware) learns the command from the first iteration on.

use crate::COMMAND;

/// How many of the policy's commands are looked at for one that differs.
const TRIES: usize = 16;

/// Appends to `out` each expert window, `[row][width]`, with the command of a window of the policy instead of its own.
///
/// The command is the first that lies further off the window's own than `blur` (m/s, m/s, rad/s) in one part, from the policy's
/// window of the same row on: what lies nearer is as good. Where none of the next ones does, as with one command for all, the
/// policy's own window stands there.
pub(crate) fn mismatch(
    experts: &[f32],
    policy: &[f32],
    width: usize,
    blur: [f32; COMMAND],
    out: &mut Vec<f32>,
) {
    let states = width - COMMAND;
    let rows = policy.len() / width;
    let command = |row: usize| &policy[row % rows * width + states..][..COMMAND];
    for (row, expert) in experts.chunks_exact(width).enumerate() {
        let (moved, own) = expert.split_at(states);
        let differs = |other: &&[f32]| {
            let mut parts = own.iter().zip(*other).zip(blur);
            parts.any(|((own, other), blur)| (own - other).abs() > blur)
        };
        match (row..row + TRIES).map(command).find(differs) {
            Some(other) => {
                out.extend_from_slice(moved);
                out.extend_from_slice(other);
            }
            None => out.extend_from_slice(&policy[row % rows * width..][..width]),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const BLUR: [f32; COMMAND] = [0.1, 0.1, 0.2];

    #[test]
    fn a_window_gets_the_next_command_that_is_not_nearly_its_own() {
        // Windows of one number and a command. The second of the policy is within the blur of both experts, the third turns.
        let experts = [7.0, 1.0, 0.0, 0.0, 8.0, 0.95, 0.0, 0.0];
        let policy = [1.0, 0.5, 0.0, 0.0, 2.0, 1.05, 0.0, 0.0, 3.0, 1.0, 0.0, 0.3];
        let mut out = vec![];
        mismatch(&experts, &policy, 4, BLUR, &mut out);
        assert_eq!(out, [7.0, 0.5, 0.0, 0.0, 8.0, 1.0, 0.0, 0.3]);
    }

    #[test]
    fn without_another_command_the_policy_s_own_window_stands_there() {
        let experts = [7.0, 1.0, 0.0, 0.0, 8.0, 1.0, 0.0, 0.0];
        let policy = [1.0, 1.05, 0.0, 0.1, 2.0, 0.95, 0.0, 0.0];
        let mut out = vec![];
        mismatch(&experts, &policy, 4, BLUR, &mut out);
        assert_eq!(out, policy);
    }
}

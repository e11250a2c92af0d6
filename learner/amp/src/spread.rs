//! How far the gaits of robots differ that were told the same: the deviation for the bounds of Eq. 13 with
//! `scheduler.bounds_from = "robots"`.
//!
//! Separate because robots are hardly ever told the same. Style differs by the command (standing earns more than running), and
//! the plain deviation over robots of many commands is mostly that: ± 0.6 about the mean, bounds that bind nothing. Of a robot
//! and the one whose command is nearest to its own, the squared difference of two numbers is twice their variance on average
//! (Rice 1984, "Bandwidth choice for nonparametric regression", Eq. 2.2, in more than one dimension).

use crate::COMMAND;

/// σ of the robots' `means` beside others of nearly the same command (m/s, m/s, rad/s):  σ² = 1/(2n)·Σ (x_i − x_j(i))²,
/// where j(i) is the robot whose command is nearest to that of i, of several the next one after i. 0 of fewer than two robots.
pub(crate) fn deviation_at_a_command(means: &[f32], commands: &[[f32; COMMAND]]) -> f64 {
    let n = means.len().min(commands.len());
    if n < 2 {
        return 0.0;
    }
    let distance = |i: usize, j: usize| -> f32 {
        let parts = commands[i].iter().zip(&commands[j]);
        parts.map(|(a, b)| (a - b).powi(2)).sum()
    };
    let squared = |i: usize| {
        let others = (1..n).map(|step| (i + step) % n);
        let nearest = others.min_by(|a, b| distance(i, *a).total_cmp(&distance(i, *b)));
        nearest.map_or(0.0, |j| f64::from(means[i] - means[j]).powi(2))
    };
    ((0..n).map(squared).sum::<f64>() / (2 * n) as f64).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_the_command_makes_of_it_does_not_count() {
        // Two that stand and two that walk. Standing earns .5 more, and each pair differs by .25: four squares of 1/16 over 8.
        let means = [0.875, 0.25, 0.625, 0.5];
        let commands = [[0.0; 3], [1.0, 0.0, 0.0], [0.0; 3], [1.1, 0.0, 0.0]];
        let by_hand = (4.0 / 16.0 / 8.0_f64).sqrt();
        assert!((deviation_at_a_command(&means, &commands) - by_hand).abs() < 1e-9);
    }

    #[test]
    fn of_one_command_it_is_the_deviation_to_the_next() {
        // 0 1 1: squares 1, 0 and 1 over 6. One robot differs from none.
        let by_hand = (2.0 / 6.0_f64).sqrt();
        let told = [[1.0, 0.0, 0.0]; 3];
        assert!((deviation_at_a_command(&[0.0, 1.0, 1.0], &told) - by_hand).abs() < 1e-9);
        assert_eq!(deviation_at_a_command(&[0.5], &told[..1]), 0.0);
    }
}

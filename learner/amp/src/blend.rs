//! From two rewards to one, by the scheduler's rule (Eq. 1 and 2).

use ampco::{Granularity, Rule, Weights};

/// Writes r = wᴳ·rᴳ + wˢ·rˢ of every transition to `blended`; returns the mean wˢ.
///
/// `means` are those of style and task reward over the batch: with [`Granularity::Mean`] they decide the weights for all.
pub fn blend(
    rule: Rule,
    granularity: Granularity,
    style_rewards: &[f32],
    task_rewards: &[f32],
    means: (f32, f32),
    blended: &mut Vec<f32>,
) -> f64 {
    let common = match granularity {
        Granularity::Mean => Some(rule.weights(means.0, means.1)),
        Granularity::Sample => None,
    };
    let mut style_weights = 0.0;
    blended.clear();
    blended.extend(style_rewards.iter().zip(task_rewards).map(|(style, task)| {
        let weights: Weights = common.unwrap_or_else(|| rule.weights(*style, *task));
        style_weights += f64::from(weights.style());
        weights.blend(*task, *style)
    }));
    style_weights / blended.len().max(1) as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_transition_or_all_at_once() {
        // Guided, ceiling 1: wᴳ = rˢ². Samples: style 0 → wᴳ 0, r = 0;  style 1 → wᴳ 1, r = task = 0.4.
        let rule = Rule::Guided { ceiling: 1.0 };
        let mut blended = Vec::new();
        let style = [0.0, 1.0];
        let task = [0.8, 0.4];
        let weight = blend(
            rule,
            Granularity::Sample,
            &style,
            &task,
            (0.5, 0.6),
            &mut blended,
        );
        assert_eq!((weight, blended.as_slice()), (0.5, &[0.0, 0.4][..]));
        // By the mean style 0.5: wᴳ = 0.25, wˢ = 0.75: r = 0.25·0.8 = 0.2 and 0.25·0.4 + 0.75 = 0.85
        let weight = blend(
            rule,
            Granularity::Mean,
            &style,
            &task,
            (0.5, 0.6),
            &mut blended,
        );
        assert_eq!(weight, 0.75);
        assert!((blended[0] - 0.2).abs() < 1e-6 && (blended[1] - 0.85).abs() < 1e-6);
    }
}

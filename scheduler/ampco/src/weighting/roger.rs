//! Constrained weighting after ROGER, AMPCO's phase II: Eq. 12.
//!
//! ROGER as published works on advantages per reward channel. The paper's Eq. 12 is its simplification to rewards, and
//! it is what both the AMPCO method and the "AMP + ROGER" baseline use here.

/// Style weight inside the bounds:  wˢ = clip((μ_upper − rˢ) / (μ_upper − μ_lower), 0, 1)   (Eq. 12)
///
/// At the upper bound the task has everything; a policy that sinks to the lower bound is led back by style alone.
/// `lower < upper` is the caller's promise, see [`crate::Rule::validate`].
#[inline]
pub fn style_weight(style_reward: f32, lower: f32, upper: f32) -> f32 {
    ((upper - style_reward) / (upper - lower)).clamp(0.0, 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_weight_runs_from_the_upper_to_the_lower_bound() {
        assert_eq!(style_weight(0.75, 0.25, 0.75), 0.0);
        assert_eq!(style_weight(0.5, 0.25, 0.75), 0.5); // the middle, where both weights are ½
        assert_eq!(style_weight(0.375, 0.25, 0.75), 0.75); // 0.375 / 0.5
        assert_eq!(style_weight(0.25, 0.25, 0.75), 1.0);
    }

    #[test]
    fn outside_the_bounds_the_weight_is_clipped() {
        assert_eq!(style_weight(0.9, 0.25, 0.75), 0.0);
        assert_eq!(style_weight(0.1, 0.25, 0.75), 1.0);
    }
}

//! The style reward: Eq. 7.

/// Style reward of a transition:  rˢ = max\[0, 1 − 0.25·(D(o_t, o_{t+1}) − 1)²\]   (Eq. 7)
///
/// 1 where the discriminator says "expert" (+1), 0 where it says "policy" (−1) or further away.
pub fn style_reward(score: f32) -> f32 {
    (1.0 - 0.25 * (score - 1.0).powi(2)).max(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_is_one_for_experts_and_zero_for_the_policy() {
        assert_eq!(style_reward(1.0), 1.0);
        assert_eq!(style_reward(-1.0), 0.0); // 1 − 0.25·4
        assert_eq!(style_reward(0.0), 0.75); // 1 − 0.25
        assert_eq!(style_reward(2.0), 0.75); // beyond expert is no better
        assert_eq!([style_reward(-5.0), style_reward(4.0)], [0.0; 2]);
    }
}

//! The AdaMimic baseline: Eq. 9's law fed by the task reward.
//!
//! The paper says that AMPCO inverts AdaMimic's focus on the task reward and gives no formula for the baseline. We read
//! it as the same square law with the task reward in the style reward's place.

/// Task weight of AdaMimic:  wᴳ = min((rᴳ / R*)², 1)   (Eq. 9 with rᴳ for rˢ)
///
/// Task performance admits more task, however the motion looks.
#[inline]
pub fn task_weight(task_reward: f32, ceiling: f32) -> f32 {
    (task_reward / ceiling).powi(2).min(1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_task_half_done_gets_a_quarter_of_the_reward() {
        assert_eq!(task_weight(0.5, 1.0), 0.25); // (1/2)²
        assert_eq!(task_weight(2.0, 1.0), 1.0); // 4, cut to 1
    }
}

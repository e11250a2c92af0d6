//! The two weights and the blended reward: Eq. 1 and Eq. 2.
//!
//! A type of its own so that Eq. 2 cannot be broken: only the style weight is stored, the task weight is what is left.

/// Shares of the style and the task reward, both in \[0, 1\]:  wᴳ = 1 − wˢ   (Eq. 2)
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Weights {
    style: f32,
}

impl Weights {
    /// Both rewards weigh the same.
    pub const EQUAL: Self = Self { style: 0.5 };

    /// Weights with this style share; a value outside \[0, 1\] becomes the nearer end.
    #[inline]
    pub fn from_style(style: f32) -> Self {
        Self {
            style: style.clamp(0.0, 1.0),
        }
    }

    /// Weights with this task share; a value outside \[0, 1\] becomes the nearer end.
    #[inline]
    pub fn from_task(task: f32) -> Self {
        Self::from_style(1.0 - task)
    }

    /// wˢ
    #[inline]
    pub fn style(self) -> f32 {
        self.style
    }

    /// wᴳ = 1 − wˢ   (Eq. 2)
    #[inline]
    pub fn task(self) -> f32 {
        1.0 - self.style
    }

    /// Reward of a transition: r = wᴳ·rᴳ + wˢ·rˢ   (Eq. 1)
    #[inline]
    pub fn blend(self, task_reward: f32, style_reward: f32) -> f32 {
        self.task() * task_reward + self.style * style_reward
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_task_gets_what_style_leaves() {
        assert_eq!(Weights::from_style(0.75).task(), 0.25);
        assert_eq!(Weights::from_task(0.75).style(), 0.25);
        assert_eq!(Weights::EQUAL.task(), Weights::EQUAL.style());
    }

    #[test]
    fn shares_outside_the_unit_interval_become_its_ends() {
        assert_eq!(Weights::from_style(1.5).task(), 0.0);
        assert_eq!(Weights::from_style(-0.5).task(), 1.0);
    }

    #[test]
    fn the_blend_is_the_weighted_sum() {
        // 0.25·0.8 + 0.75·0.4 = 0.2 + 0.3
        assert!((Weights::from_style(0.75).blend(0.8, 0.4) - 0.5).abs() < 1e-6);
        assert_eq!(Weights::from_style(1.0).blend(123.0, 0.4), 0.4);
        assert_eq!(Weights::from_style(0.0).blend(0.8, 123.0), 0.8);
    }
}

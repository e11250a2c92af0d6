//! Robots that explore calmly: fewer tries, and a policy that does not wait for noise to set it going.
//!
//! Actors draw by it and the learner takes densities by it, so both have to count the same robots.

/// σ of a robot that explores calmly, in parts of the others'.
pub const CALM: f32 = 0.5;

/// How many robots of a rollout explore calmly, if this `share` of them does: the last ones.
pub fn calm(environments: usize, share: f32) -> usize {
    (share * environments as f32).round() as usize
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_share_is_rounded_to_robots() {
        assert_eq!(calm(128, 0.25), 32);
        assert_eq!(
            [calm(3, 0.5), calm(3, 0.1), calm(7, 1.0), calm(7, 0.0)],
            [2, 0, 7, 0]
        );
    }
}

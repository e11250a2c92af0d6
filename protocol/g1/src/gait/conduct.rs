//! What robots do, by what they are asked: steps that ask to go, to turn on the spot and to stay are judged apart.
//!
//! Separate because signs of one are faults of another (a robot that turns on the spot steps, one that stands does not),
//! and because hips that rest while a robot stands, counted among those of its walk, make any correlation.

use super::{Aim, Gait, Pace, Signs, Verdict};

/// Steps that ask for something are judged if they are at least this share of all.
const LEAST_SHARE: f64 = 0.05;

/// Sums of steps, apart by what they ask for.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Conduct {
    parts: [(Gait, Pace); 3],
}

impl Conduct {
    /// Adds one robot's control step: its command and its velocity, as of [`Pace::add`], the features (53) and the foot
    /// forces, as of [`Gait::add`].
    pub fn add(
        &mut self,
        command: [f32; 3],
        velocity: [f32; 3],
        features: &[f32],
        forces: [f32; 2],
        before: Option<[f32; 2]>,
    ) {
        let (gait, pace) = &mut self.parts[Aim::of(command) as usize];
        gait.add(features, forces, before);
        pace.add(command, velocity);
    }

    /// Ends a stretch of one robot under one command, see [`Pace::close`].
    pub fn close(&mut self) {
        self.parts.iter_mut().for_each(|(_, pace)| pace.close());
    }

    /// Adds the steps of another sum.
    pub fn merge(&mut self, other: &Self) {
        for ((gait, pace), (other_gait, other_pace)) in self.parts.iter_mut().zip(&other.parts) {
            gait.merge(other_gait);
            pace.merge(other_pace);
        }
    }

    /// Whether no step was added.
    pub fn is_empty(&self) -> bool {
        self.steps() == 0.0
    }

    /// The gait of all steps together.
    pub fn gait(&self) -> Gait {
        let mut all = Gait::default();
        self.parts.iter().for_each(|(gait, _)| all.merge(gait));
        all
    }

    /// The pace of all steps together.
    pub fn pace(&self) -> Pace {
        let mut all = Pace::default();
        self.parts.iter().for_each(|(_, pace)| all.merge(pace));
        all
    }

    /// What it is, by the whole command: of what is asked for, the first that is not done, the one that is asked for
    /// most coming first; if all is done, what was asked for most. `seconds_upright` is the mean time to a fall or to the
    /// end, s, if somebody's time ended; a second has `control_hz` steps.
    pub fn verdict(&self, seconds_upright: Option<f64>, control_hz: f64) -> Verdict {
        let mut parts = self.parts;
        parts.sort_by(|(_, a), (_, b)| b.steps().total_cmp(&a.steps()));
        let least = LEAST_SHARE * self.steps();
        let mut verdicts = parts
            .iter()
            .enumerate()
            .filter(|(i, (_, pace))| *i == 0 || pace.steps() > 0.0 && pace.steps() >= least)
            .map(|(_, (gait, pace))| {
                Verdict::of(&Signs::of(gait, pace, seconds_upright, control_hz))
            });
        let most = verdicts.next().expect("there are three parts");
        if !most.is_good() {
            return most;
        }
        verdicts.find(|other| !other.is_good()).unwrap_or(most)
    }

    fn steps(&self) -> f64 {
        self.parts.iter().map(|(_, pace)| pace.steps()).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::FEATURES;
    use crate::observation::{FEATURE_JOINT_POSITION, HEIGHT};

    const LEFT: [f32; 2] = [300.0, 0.0];
    const RIGHT: [f32; 2] = [0.0, 300.0];
    const BOTH: [f32; 2] = [157.0; 2];

    fn features(hips: [f32; 2]) -> [f32; FEATURES] {
        let mut features = [0.0; FEATURES];
        features[HEIGHT] = 0.75;
        features[FEATURE_JOINT_POSITION.start] = hips[0];
        features[FEATURE_JOINT_POSITION.start + 6] = hips[1];
        features
    }

    /// A robot that takes a stride in 40 steps, for `strides` strides.
    fn stepping(command: [f32; 3], velocity: [f32; 3], strides: usize) -> Conduct {
        let mut conduct = Conduct::default();
        let mut before = None;
        for step in 0..40 * strides {
            let (hip, forces) = if step % 40 < 20 {
                (0.3, LEFT)
            } else {
                (-0.3, RIGHT)
            };
            conduct.add(command, velocity, &features([hip, -hip]), forces, before);
            before = Some(forces);
        }
        conduct
    }

    /// A robot with both feet down, its left hip at `hip`.
    fn standing(command: [f32; 3], velocity: [f32; 3], hip: f32, steps: usize) -> Conduct {
        let mut conduct = Conduct::default();
        for _ in 0..steps {
            conduct.add(command, velocity, &features([hip; 2]), BOTH, Some(BOTH));
        }
        conduct
    }

    fn said(conduct: &Conduct) -> (String, bool) {
        let verdict = conduct.verdict(Some(20.0), 50.0);
        (verdict.to_string(), verdict.is_good())
    }

    fn good(word: &str) -> (String, bool) {
        (word.to_owned(), true)
    }

    fn bad(words: &str) -> (String, bool) {
        (words.to_owned(), false)
    }

    #[test]
    fn turning_on_the_spot_is_judged_by_the_turn() {
        let told = [0.0, 0.0, 1.0];
        let turns = stepping(told, [0.0, 0.0, 0.87], 3);
        assert_eq!(said(&turns), good("turn"));
        let stands = standing(told, [0.0, 0.0, 0.01], 0.1, 120);
        assert_eq!(said(&stands), bad("still: 0.01 of 1.00 rad/s"));
        let steps_on_the_spot = stepping(told, [0.0, 0.0, 0.01], 3);
        assert_eq!(said(&steps_on_the_spot), bad("still: 0.01 of 1.00 rad/s"));
        let the_wrong_way = stepping(told, [0.0, 0.0, -0.87], 3);
        assert_eq!(said(&the_wrong_way), bad("still: -0.87 of 1.00 rad/s"));
        let goes_besides = stepping(told, [0.3, 0.0, 0.9], 3);
        assert_eq!(said(&goes_besides), bad("drift: 0.30 m/s, asked to stay"));
        let to_the_right = stepping([0.0, 0.0, -1.0], [0.0, 0.0, -0.87], 3);
        assert_eq!(said(&to_the_right), good("turn"));
    }

    #[test]
    fn a_walk_is_judged_by_all_three_parts_of_its_command() {
        let told = [0.5, 0.0, 0.5];
        assert_eq!(said(&stepping(told, [0.5, 0.0, 0.45], 3)), good("walk"));
        let straight_on = stepping(told, [0.5, 0.0, -0.01], 3);
        assert_eq!(said(&straight_on), bad("veer: -0.01 of 0.50 rad/s"));
        let in_circles = stepping([0.5, 0.0, 0.0], [0.5, 0.0, 0.4], 3);
        assert_eq!(
            said(&in_circles),
            bad("veer: 0.40 rad/s, asked to go straight")
        );
        let slanting = stepping([0.5, 0.0, 0.0], [0.5, -0.3, 0.0], 3);
        assert_eq!(said(&slanting), bad("sidle: 0.30 m/s off its way"));
        let aside = [0.0, 0.3, 0.0];
        assert_eq!(said(&stepping(aside, [0.02, 0.28, 0.0], 3)), good("walk"));
        let ahead = stepping(aside, [0.4, 0.3, 0.0], 3);
        assert_eq!(said(&ahead), bad("sidle: 0.40 m/s off its way"));
    }

    #[test]
    fn who_is_told_to_stand_and_spins_does_not_stand() {
        let spins = standing([0.0; 3], [0.0, 0.0, 0.5], 0.1, 120);
        assert_eq!(said(&spins), bad("spin: 0.50 rad/s, asked to stay"));
    }

    #[test]
    fn standing_between_walks_spoils_no_walk_and_is_judged_itself() {
        // Told apart by kind: alone both hips at −2 among the swings of a walk would look like a hop.
        let mut both = stepping([1.0, 0.0, 0.0], [1.0, 0.0, 0.0], 3);
        both.merge(&standing([0.0; 3], [0.0; 3], -2.0, 60));
        assert!(both.gait().hip_correlation().unwrap() > 0.3);
        assert_eq!(said(&both), good("walk"));
        let mut fidgets = stepping([1.0, 0.0, 0.0], [1.0, 0.0, 0.0], 3);
        fidgets.merge(&stepping([0.0; 3], [0.0; 3], 1));
        // One landing of one foot, so half a stride in 40 steps of 20 ms.
        assert_eq!(
            said(&fidgets),
            bad("step in place: 0.6 strides/s, asked to stand")
        );
        // A few steps among many are no kind of their own: 4 of 124.
        let mut brief = stepping([1.0, 0.0, 0.0], [1.0, 0.0, 0.0], 3);
        brief.merge(&standing([0.0, 0.0, 1.0], [0.0; 3], 0.1, 4));
        assert_eq!(said(&brief), good("walk"));
    }

    #[test]
    fn sums_of_parts_are_the_sum_of_all() {
        let told = [0.5, 0.0, 0.5];
        let mut halves = stepping(told, [0.5, 0.0, 0.45], 1);
        halves.merge(&stepping(told, [0.5, 0.0, 0.45], 1));
        let pace = halves.pace();
        assert_eq!(pace.steps(), 80.0);
        let (asked, turned) = pace.turns().unwrap();
        assert!((asked - 0.5).abs() < 1e-6 && (turned - 0.45).abs() < 1e-6);
        assert_eq!(halves.gait().duty_factor(), Some(0.5));
        assert!(!halves.is_empty() && Conduct::default().is_empty());
    }
}

//! Imitation that pauses has not ended.

use super::*;

#[test]
fn a_pause_while_robots_fall_is_no_convergence_where_episodes_have_to_last() {
    for seed in 0..5 {
        // As seen in training: style falls to 0.3 and stays there, up and down, while robots learn to stay up; once they do
        // it climbs to 0.6.
        let style = noisy(seed, 3000, |t| {
            let first = 0.25 + 0.05 * (t / 300.0).min(1.0);
            first + 0.3 * ((t - 1500.0) / 500.0).clamp(0.0, 1.0)
        });
        // Episodes last a tenth of what they may, three tenths when the pause ends, all of it 200 iterations later.
        let share = |t: f64| {
            0.1 + 0.2 * (t / 1500.0).min(1.0) + 0.7 * ((t - 1500.0) / 200.0).clamp(0.0, 1.0)
        };
        let switch = |arm| {
            let mut schedule = Schedule::new(ScheduleConfig { arm, ..short() }).unwrap();
            let decisions = (1..).zip(&style).map(|(iteration, reward)| {
                schedule.observe(Report {
                    episode_share: Some(share(iteration as f64)),
                    ..report(iteration, *reward)
                })
            });
            decisions.last().unwrap().unwrap().switched_at()
        };
        assert!(switch(ArmKind::AfterRise).unwrap() < 1500, "seed {seed}");
        let switched = switch(ArmKind::EpisodesLast).unwrap();
        // Not before the climb ends; soon after.
        assert!((2000..2600).contains(&switched), "seed {seed}: {switched}");
    }
}

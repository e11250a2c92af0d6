//! Gait measures of a batch: the one place that knows how its rows follow each other in time.

use amp::Batch;
use g1::FEATURES;
use g1::gait::Gait;

/// Measures of all robots of a batch together.
pub(crate) fn of(batch: &Batch) -> Gait {
    let mut gait = Gait::default();
    let mut row = 0;
    for segment in batch.segments() {
        let robots = segment.environments;
        for step in 0..segment.steps {
            for robot in 0..robots {
                let forces =
                    |row: usize| [batch.foot_forces[2 * row], batch.foot_forces[2 * row + 1]];
                let began = step == 0 || batch.ends[row - robots] != 0.0;
                gait.add(
                    &batch.next_features[row * FEATURES..][..FEATURES],
                    forces(row),
                    (!began).then(|| forces(row - robots)),
                );
                row += 1;
                let _ = robot;
            }
        }
    }
    gait
}

//! What stresses amount to: rows of `[event]` with one value, ground, and what is withheld or asked for.
//!
//! Separate from the table because here is what each does.

use g1::COMMAND;
use g1::state::STANDING_HEIGHT;
use observation::Table;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;
use sim::event::Spell;
use sim::randomization::Row;
use sim::{EventConfig, GroundConfig};

/// Greatest change of the yaw rate that is asked for beside, rad/s.
const TURN: f32 = 0.5;

/// All that acts on the robots of a row.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Acting {
    pub(crate) event: EventConfig,
    /// Height of the bumps, m.
    bumps: f32,
    /// Share of the pelvis' velocity, and of its height above that of standing, that the policy is told.
    told: f32,
    /// Time between commands, s.
    every: Option<f32>,
}

impl Default for Acting {
    fn default() -> Self {
        Self {
            event: EventConfig::default(),
            bumps: 0.0,
            told: 1.0,
            every: None,
        }
    }
}

fn exactly(value: f32) -> Option<Row> {
    Some(Row {
        range: [value, value],
    })
}

impl Acting {
    pub(super) fn delay(&mut self, milliseconds: f32) {
        self.event.action_delay = exactly(milliseconds / 1_000.0);
    }

    pub(super) fn gains(&mut self, factor: f32) {
        self.event.stiffness = exactly(factor);
        self.event.damping = exactly(factor);
    }

    pub(super) fn strength(&mut self, factor: f32) {
        self.event.motor_strength = exactly(factor);
    }

    pub(super) fn payload(&mut self, mass: f32) {
        self.event.payload = exactly(mass);
    }

    pub(super) fn friction(&mut self, coefficient: f32) {
        self.event.ground_friction = exactly(coefficient);
    }

    pub(super) fn slope(&mut self, degrees: f32) {
        self.event.slope = exactly(degrees.to_radians());
    }

    pub(super) fn bumps(&mut self, centimetres: f32) {
        self.bumps = centimetres / 100.0;
    }

    pub(super) fn push(&mut self, newtons: f32) {
        self.event.force = Some(Spell {
            range: [newtons, newtons],
            duration: [0.05, 0.05],
            seconds: [3.0, 5.0],
        });
    }

    pub(super) fn encoder(&mut self, radians: f32) {
        self.event.encoder_offset = Some(Row {
            range: [-radians, radians],
        });
    }

    pub(super) fn imu(&mut self, degrees: f32) {
        self.event.imu_tilt = exactly(degrees.to_radians());
    }

    pub(super) fn dry(&mut self, torque: f32) {
        self.event.joint_friction = exactly(torque);
    }

    pub(super) fn velocity(&mut self, share: f32) {
        self.told = share;
    }

    pub(super) fn commands(&mut self, seconds: f32) {
        self.every = Some(seconds);
    }

    /// The ground, where it is `under` them otherwise.
    pub(crate) fn ground(&self, under: Option<GroundConfig>) -> Option<GroundConfig> {
        if self.bumps == 0.0 {
            return under;
        }
        Some(GroundConfig {
            bumps: self.bumps,
            ..under.unwrap_or_default()
        })
    }

    /// Leaves of what the policy is told of its velocity and height what is told: of rows of a list.
    pub(crate) fn withhold(&self, list: &Table, rows: &mut [f32]) {
        if self.told == 1.0 {
            return;
        }
        for (entry, place) in list.in_row() {
            let at_rest = match entry.term.name {
                "linear_velocity" => 0.0,
                "height" => STANDING_HEIGHT as f32 * entry.scale,
                _ => continue,
            };
            for row in rows.chunks_exact_mut(list.width()) {
                for number in &mut row[place.clone()] {
                    *number = at_rest + self.told * (*number - at_rest);
                }
            }
        }
    }

    /// The commands of one episode; none where they are those that are asked for.
    pub(crate) fn orders(&self, seed: u64, taught: [f32; 2]) -> Option<Orders> {
        self.every.map(|seconds| Orders {
            every: ((seconds * 50.0).round() as u32).max(1),
            random: Pcg64Mcg::seed_from_u64(seed),
            taught,
            now: None,
        })
    }
}

/// Commands that change within an episode, for one robot.
pub(crate) struct Orders {
    /// Control steps.
    every: u32,
    random: Pcg64Mcg,
    /// Least and greatest yaw rate that the policy was ever asked for, rad/s.
    taught: [f32; 2],
    now: Option<[f32; COMMAND]>,
}

impl Orders {
    /// The command of a step; to be asked for every step, in order.
    pub(crate) fn at(&mut self, step: u32, asked: [f32; COMMAND]) -> [f32; COMMAND] {
        if step > 0 && step.is_multiple_of(self.every) {
            let turn = asked[2] + self.random.random_range(-TURN..TURN);
            // No turn that it was never taught, unless it is asked for.
            let [least, most] = self.taught;
            let turn = turn.clamp(least.min(asked[2]), most.max(asked[2]));
            let share: f32 = self.random.random();
            self.now = Some([share * asked[0], share * asked[1], turn]);
        }
        self.now.unwrap_or(asked)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use g1::OBSERVATION;
    use g1::observation::{HEIGHT, LINEAR_VELOCITY};
    use observation::Tables;

    #[test]
    fn velocity_and_height_are_told_by_their_share() {
        let mut half = Acting::default();
        half.velocity(0.5);
        let mut row = vec![1.0; 2 * OBSERVATION];
        half.withhold(&Tables::default().actor, &mut row);
        for robot in row.chunks_exact(OBSERVATION) {
            let height = robot[HEIGHT];
            assert!((height - 0.5 * (1.0 + STANDING_HEIGHT as f32)).abs() < 1e-6);
            assert_eq!(robot[LINEAR_VELOCITY], [0.5; 3]);
            assert!(robot[LINEAR_VELOCITY.end..].iter().all(|x| *x == 1.0));
        }
    }

    #[test]
    fn commands_change_in_time_and_stay_within_what_was_taught() {
        let mut often = Acting::default();
        assert!(often.orders(1, [0.0, 0.0]).is_none());
        often.commands(0.1);
        let mut orders = often.orders(1, [-0.2, 0.2]).unwrap();
        let asked = [1.0, -0.4, 0.3];
        let told: Vec<_> = (0..1_000).map(|step| orders.at(step, asked)).collect();
        assert_eq!(told[4], asked);
        for (step, pair) in told.windows(2).enumerate() {
            // 0.1 s are 5 steps.
            assert_eq!(pair[0] != pair[1], (step + 1) % 5 == 0, "{step}");
            let [forward, left, turn] = pair[1];
            assert!((0.0..=1.0).contains(&forward) && (-0.2..=0.3).contains(&turn));
            assert!((left + 0.4 * forward).abs() < 1e-6);
        }
    }
}

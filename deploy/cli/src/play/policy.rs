//! One robot that follows its policy until it lies on the ground or the time is over.

use anyhow::Result;
use g1::ACTION;
use judge::Subject;
use playback::{Frame, Recording};
use sim::world::CONTROL_STEP;
use sim::{FallConfig, Fleet, Mechanics, RandomizationConfig, Starts, StepRows, TimeOutConfig};
use vocabulary::{RUNNING, Ramp};

/// Height of the pelvis at which a fall has been seen to its end, m.
const LYING: f32 = 0.25;

/// What one robot is to do.
#[derive(Clone, Debug)]
pub(crate) struct Show {
    /// Forward and leftward velocity in m/s, yaw rate in rad/s: followed one after another, each for an equal share of
    /// the time.
    pub(crate) commands: Vec<[f32; 3]>,
    pub(crate) seconds: f64,
    pub(crate) randomization: RandomizationConfig,
    /// Begin in a frame of the reference motion instead of standing.
    pub(crate) from_reference: bool,
    pub(crate) mechanics: Mechanics,
    pub(crate) seed: u64,
    /// A robot that lies is put up again for the next command; the recording ends there otherwise.
    pub(crate) again: bool,
}

impl Show {
    fn steps(&self) -> u32 {
        (self.seconds / f64::from(CONTROL_STEP)).round() as u32
    }

    /// Which command holds in a step.
    fn command(&self, step: u32) -> usize {
        step as usize * self.commands.len() / (self.steps() as usize + 1)
    }

    /// The step in which the command after that of a step begins, if there is one.
    fn next(&self, step: u32) -> Option<u32> {
        (step + 1..=self.steps()).find(|later| self.command(*later) > self.command(step))
    }
}

/// One robot of `subject` that does what `show` says.
pub(crate) fn record(subject: &Subject, show: &Show) -> Result<Recording> {
    let steps = show.steps();
    let mut task = subject.task.clone();
    task.termination.time_out = TimeOutConfig {
        steps: steps + 1,
        staggered: false,
    };
    task.start.reference_share = Ramp::Constant(f32::from(u8::from(show.from_reference)));
    // One who watches wants to see the fall; when it counts as one is noted by the run's own rule.
    task.termination.fall = FallConfig {
        height: LYING,
        upright: -1.0,
    };
    let starts = if show.from_reference {
        subject.starts(show.commands[0])
    } else {
        Starts::default()
    };
    // Exact sensors where nothing is randomised.
    let tables = match show.randomization == RandomizationConfig::default() {
        true => subject.kept.tables.exact(),
        false => subject.kept.tables.clone(),
    };
    let begin = |seed| {
        Fleet::seen_by(
            &tables,
            show.mechanics,
            &task,
            &show.randomization,
            starts.clone(),
            1,
            seed,
        )
    };
    let mut fleet = begin(show.seed)?;
    let mut policy = subject.policy()?;
    let mut rows = StepRows::of(&fleet, 0.0);
    let mut recording = Recording {
        title: format!("{}, {}", subject.kept.run_name()?, asked(&show.commands)),
        source: format!("iteration {}", subject.kept.iteration),
        frame_seconds: f64::from((CONTROL_STEP * 1e6).round()) / 1e6,
        ..Recording::default()
    };
    let (mut foot_forces, mut energy) = (None, None);
    let mut step = 0;
    loop {
        let command = show.commands[show.command(step)];
        fleet.hold_command(0, command);
        let mut action = vec![0.0; ACTION];
        policy.means(fleet.observations(), 1, &mut action);
        let state = *fleet.state(0);
        if recording.fell_at.is_none() && subject.task.termination.fall.has_fallen(&state) {
            recording.fell_at = Some(recording.frames.len() as f64 * recording.frame_seconds);
        }
        recording.frames.push(Frame {
            foot_forces,
            energy,
            observation: Some(fleet.observations().to_vec()),
            action: (step < steps).then(|| action.clone()),
            ..Frame::of(&state, command)
        });
        if step == steps {
            break;
        }
        fleet.step(&action, &mut rows.out());
        if rows.ends[0] == RUNNING {
            foot_forces = Some([rows.foot_forces[0], rows.foot_forces[1]]);
            energy = Some(rows.energies[0]);
            step += 1;
            continue;
        }
        // The robot lies, or its numbers broke: what the fleet shows now is another episode.
        match show.next(step).filter(|_| show.again) {
            Some(next) => {
                fleet = begin(show.seed + u64::from(next))?;
                (foot_forces, energy) = (None, None);
                step = next;
            }
            None => break,
        }
    }
    // Before the first step nothing was felt; it is shown as what follows, so that the traces begin there.
    for later in (1..recording.frames.len()).rev() {
        let felt = recording.frames[later].foot_forces;
        let frame = &mut recording.frames[later - 1];
        frame.foot_forces = frame.foot_forces.or(felt);
    }
    Ok(recording)
}

/// The commands in words.
pub(crate) fn asked(commands: &[[f32; 3]]) -> String {
    let words: Vec<String> = commands
        .iter()
        .map(|&[forward, left, yaw]| {
            let mut words = format!("{forward} m/s");
            if left != 0.0 {
                words += &format!(" left {left} m/s");
            }
            if yaw != 0.0 {
                words += &format!(" turning {yaw} rad/s");
            }
            words
        })
        .collect();
    words.join(", then ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn commands_share_the_time_and_follow_each_other() {
        let show = Show {
            commands: vec![[0.0; 3], [0.5, 0.0, 0.0], [1.0, 0.0, 0.0]],
            seconds: 0.1,
            randomization: RandomizationConfig::default(),
            from_reference: false,
            mechanics: sim::Physics::Rapier.into(),
            seed: 1,
            again: true,
        };
        // 0.1 s are 5 steps of 20 ms, with 6 frames: two for each command.
        let held: Vec<usize> = (0..=show.steps()).map(|step| show.command(step)).collect();
        assert_eq!(held, [0, 0, 1, 1, 2, 2]);
        let next: Vec<Option<u32>> = (0..=5).map(|step| show.next(step)).collect();
        assert_eq!(next, [Some(2), Some(2), Some(4), Some(4), None, None]);
    }
}

//! One robot that follows its policy until it lies on the ground or the time is over.

use anyhow::Result;
use g1::ACTION;
use judge::Subject;
use playback::{Frame, Recording};
use sim::world::CONTROL_STEP;
use sim::{FallConfig, Fleet, RandomizationConfig, Starts, StepRows, TimeOutConfig};
use vocabulary::{RUNNING, Ramp};

use super::Play;

/// Height of the pelvis at which a fall has been seen to its end, m.
const LYING: f32 = 0.25;

pub(super) fn record(play: &Play) -> Result<Recording> {
    let subject = Subject::open(&play.place, &play.what)?;
    let steps = (play.seconds / f64::from(CONTROL_STEP)).round() as u32;
    let mut task = subject.task.clone();
    task.termination.time_out = TimeOutConfig {
        steps: steps + 1,
        staggered: false,
    };
    task.start.reference_share = Ramp::Constant(f32::from(u8::from(play.from_reference)));
    // One who watches wants to see the fall; when it counts as one is noted by the run's own rule.
    task.termination.fall = FallConfig {
        height: LYING,
        upright: -1.0,
    };
    task.physics = play.physics.into();
    let randomization = if play.randomize {
        RandomizationConfig::default()
    } else {
        RandomizationConfig::none()
    };
    let commands = play.commands();
    let starts = if play.from_reference {
        subject.starts(commands[0])
    } else {
        Starts::default()
    };
    let mut fleet = Fleet::new(&task, &randomization, starts, 1, play.seed)?;
    let mut policy = subject.policy()?;
    let mut rows = StepRows::filled(1, 0.0);
    let mut recording = Recording {
        title: format!("{}, {}", subject.kept.run_name()?, asked(&commands)),
        source: format!("iteration {}", subject.kept.iteration),
        frame_seconds: f64::from((CONTROL_STEP * 1e6).round()) / 1e6,
        ..Recording::default()
    };
    let (mut foot_forces, mut energy) = (None, None);
    for step in 0..=steps {
        let share = step as usize * commands.len() / (steps as usize + 1);
        fleet.hold_command(0, commands[share]);
        let mut action = vec![0.0; ACTION];
        policy.means(fleet.observations(), 1, &mut action);
        let state = *fleet.state(0);
        if recording.fell_at.is_none() && subject.task.termination.fall.has_fallen(&state) {
            recording.fell_at = Some(f64::from(step) * recording.frame_seconds);
        }
        recording.frames.push(Frame {
            foot_forces,
            energy,
            observation: Some(fleet.observations().to_vec()),
            action: (step < steps).then(|| action.clone()),
            ..Frame::of(&state, commands[share])
        });
        if step == steps {
            break;
        }
        fleet.step(&action, &mut rows.out());
        if rows.ends[0] != RUNNING {
            // The robot lies, or its numbers broke: what the fleet shows now is another episode.
            break;
        }
        foot_forces = Some([rows.foot_forces[0], rows.foot_forces[1]]);
        energy = Some(rows.energies[0]);
    }
    // Before the first step nothing was felt; it is shown as what follows, so that the traces begin there.
    if let [first, second, ..] = recording.frames.as_mut_slice() {
        first.foot_forces = second.foot_forces;
    }
    Ok(recording)
}

/// The commands in words.
fn asked(commands: &[[f32; 3]]) -> String {
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

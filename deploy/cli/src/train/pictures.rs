//! What there is to look at when a run ends: what its policy does, and how it learned.
//!
//! Separate because a picture that cannot be drawn is a warning: what was trained is safe by then.

use std::path::PathBuf;

use anyhow::{Context, Result};
use playback::page;
use run::Folder;
use sim::{CommandConfig, RandomizationConfig};

use judge::Subject;
use terminal::console::say;
use terminal::{Place, file};

use crate::play::policy::{Show, asked, record};
use crate::plot;

/// Each command is followed so long, s.
const SECONDS: f64 = 4.0;

/// Draws both pictures of a run into its folder, and says where they are.
pub(super) fn draw(place: &Place, folder: &Folder) {
    match page_of(place, folder) {
        Ok((path, shown)) => say(&format!("{}: {shown}", path.display())),
        Err(problem) => say(&format!("play.html is not drawn: {problem:#}")),
    }
    let curves = folder.path().join(plot::CURVES_FILE);
    match plot::draw(folder, &curves) {
        Ok(()) => say(&format!("{}: how it learned", curves.display())),
        Err(problem) => say(&format!("{} is not drawn: {problem:#}", plot::CURVES_FILE)),
    }
}

/// The page on which the newest policy follows commands of its run, four at most, in the engine that it was trained in.
fn page_of(place: &Place, folder: &Folder) -> Result<(PathBuf, String)> {
    let checkpoints = folder.checkpoints();
    let newest = checkpoints.list().pop().context("there is no checkpoint")?;
    let checkpoint = checkpoints.path(newest);
    let name = checkpoint.to_str().context("the run's path is not text")?;
    let subject = Subject::open(place, name)?;
    let commands = shown(&subject.task.command);
    let recording = record(
        &subject,
        &Show {
            seconds: SECONDS * commands.len() as f64,
            commands: commands.clone(),
            randomization: RandomizationConfig::default(),
            from_reference: false,
            mechanics: subject.mechanics,
            seed: 1,
            again: true,
        },
    )?;
    let path = folder.path().join("play.html");
    file::write(&path, page::html(&recording).as_bytes())?;
    let mut shown = format!("the policy at {}", asked(&commands));
    if let Some(at) = recording.fell_at {
        shown += &format!("; it falls after {at:.1} s, and is put up again for the next");
    }
    Ok((path, shown))
}

/// What is shown of the commands that a run has asked for, each once: of a narrow range that is fewer than four.
fn shown(commanded: &CommandConfig) -> Vec<[f32; 3]> {
    let mut shown = Vec::new();
    for command in four(commanded) {
        if !shown.contains(&command) {
            shown.push(command);
        }
    }
    shown
}

/// Four commands that a run has asked for: at rest or slowest, in the middle, fastest, and one that turns, steps aside or
/// goes back; slowest again where nothing else was ever asked.
fn four(commanded: &CommandConfig) -> [[f32; 3]; 4] {
    let [forward, lateral, yaw_rate] =
        [commanded.forward, commanded.lateral, commanded.yaw_rate].map(|range| range.now());
    let fastest = farthest(forward);
    // Of a range through 0 the half in which the fastest lies.
    let slowest = [forward[0], forward[1]]
        .into_iter()
        .find(|end| *end != fastest && end * fastest > 0.0)
        .unwrap_or(if forward[0] == forward[1] {
            fastest
        } else {
            0.0
        });
    let middle = rounded((slowest + fastest) / 2.0);
    let kinds = commanded.kinds.as_ref();
    let stands = slowest == 0.0
        || commanded.standing_share.now() > 0.0
        || kinds.is_some_and(|kinds| kinds.standing > 0.0);
    let first = if stands { 0.0 } else { rounded(slowest) };
    let alone = commanded.pure_share.now() > 0.0 || kinds.is_some();
    let ahead = if alone { 0.0 } else { middle };
    let back = [forward[0], forward[1]]
        .into_iter()
        .find(|end| end * fastest < 0.0);
    let (turn, aside) = (farthest(yaw_rate), farthest(lateral));
    let last = match back {
        _ if turn != 0.0 => [ahead, 0.0, rounded(turn)],
        _ if aside != 0.0 => [ahead, rounded(aside), 0.0],
        Some(back) => [rounded(back), 0.0, 0.0],
        None => [first, 0.0, 0.0],
    };
    let straight = |speed| [speed, 0.0, 0.0];
    [
        straight(first),
        straight(middle),
        straight(rounded(fastest)),
        last,
    ]
}

/// The end of a range that is farther from 0; of both the greater.
fn farthest([least, greatest]: [f32; 2]) -> f32 {
    if -least > greatest { least } else { greatest }
}

/// To a hundredth, as it is said.
fn rounded(value: f32) -> f32 {
    (value * 100.0).round() / 100.0
}

#[cfg(test)]
mod tests {
    use sim::KindsConfig;

    use super::*;

    fn ranges(forward: [f32; 2], lateral: [f32; 2], yaw_rate: [f32; 2]) -> CommandConfig {
        CommandConfig {
            forward: forward.into(),
            lateral: lateral.into(),
            yaw_rate: yaw_rate.into(),
            ..CommandConfig::default()
        }
    }

    #[test]
    fn commands_are_those_that_a_run_asks_for() {
        // A walk straight on, never standing: slowest, middle, fastest, slowest again.
        assert_eq!(
            four(&ranges([0.4, 1.2], [0.0; 2], [0.0; 2])),
            [
                [0.4, 0.0, 0.0],
                [0.8, 0.0, 0.0],
                [1.2, 0.0, 0.0],
                [0.4, 0.0, 0.0]
            ]
        );
        // One speed alone.
        assert_eq!(
            four(&ranges([0.8; 2], [0.0; 2], [0.0; 2])),
            [[0.8, 0.0, 0.0]; 4]
        );
        // Every direction at once: standing lies in the range, a turn is made while walking.
        assert_eq!(
            four(&ranges([-0.5, 1.0], [-0.3, 0.3], [-1.0, 0.5])),
            [[0.0; 3], [0.5, 0.0, 0.0], [1.0, 0.0, 0.0], [0.5, 0.0, -1.0]]
        );
        // Back, where nothing turns and nothing goes aside.
        assert_eq!(
            four(&ranges([-0.5, 1.0], [0.0; 2], [0.0; 2]))[3],
            [-0.5, 0.0, 0.0]
        );
        // Backward alone.
        assert_eq!(
            four(&ranges([-0.6, -0.2], [0.0; 2], [0.0; 2])),
            [
                [-0.2, 0.0, 0.0],
                [-0.4, 0.0, 0.0],
                [-0.6, 0.0, 0.0],
                [-0.2, 0.0, 0.0]
            ]
        );
    }

    #[test]
    fn each_command_is_shown_once() {
        let straight = |forward| shown(&ranges(forward, [0.0; 2], [0.0; 2]));
        let ahead = |speeds: &[f32]| -> Vec<[f32; 3]> {
            speeds.iter().map(|speed| [*speed, 0.0, 0.0]).collect()
        };
        assert_eq!(straight([0.5; 2]), ahead(&[0.5]));
        // All of it is 0.5 to a hundredth.
        assert_eq!(straight([0.499, 0.501]), ahead(&[0.5]));
        assert_eq!(straight([0.4, 1.2]), ahead(&[0.4, 0.8, 1.2]));
        assert_eq!(straight([0.0; 2]), ahead(&[0.0]));
        assert_eq!(
            shown(&ranges([0.5; 2], [0.0; 2], [-1.0, 1.0])),
            [[0.5, 0.0, 0.0], [0.5, 0.0, 1.0]]
        );
    }

    #[test]
    fn kinds_turn_on_the_spot_and_stand() {
        let mut config = ranges([0.4, 1.2], [0.0; 2], [-1.0, 1.0]);
        config.kinds = Some(KindsConfig {
            standing: 1.0,
            turning: 1.0,
            ..KindsConfig::default()
        });
        assert_eq!(
            four(&config),
            [[0.0; 3], [0.8, 0.0, 0.0], [1.2, 0.0, 0.0], [0.0, 0.0, 1.0]]
        );
        config.kinds = None;
        config.standing_share = 0.1.into();
        assert_eq!(
            (four(&config)[0], four(&config)[3]),
            ([0.0; 3], [0.8, 0.0, 1.0])
        );
    }
}

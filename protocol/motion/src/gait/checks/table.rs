//! The table of measured figures in `gait.rs`.

use super::commands::{STEADY, TRANSITIONS};
use super::measures::{clearance, gap, stance_slip};
use super::*;

/// Prints the table of `gait.rs`: run it with `--ignored --nocapture` after a change of figures.
#[test]
#[ignore = "prints a table"]
#[expect(clippy::print_stdout, reason = "a table to be read")]
fn table() {
    type Belongs = fn(&str) -> bool;
    let kinds = ["walk", "run", "start", "stop"];
    for kind in kinds {
        let clips = STEADY.iter().chain(TRANSITIONS.iter());
        let clips: Vec<_> = clips.filter(|c| c.name.starts_with(kind)).collect();
        let groups: [(&str, Belongs); 5] = [
            ("straight", |n| !n.contains(',') && !n.contains('-')),
            ("backward", |n| !n.contains(',') && n.contains('-')),
            ("turning", |n| {
                n.contains("turning") && n.matches(',').count() == 1
            }),
            ("aside", |n| n.contains(',') && !n.contains("turning")),
            ("both", |n| n.matches(',').count() == 2),
        ];
        for (group, belongs) in groups {
            let clips: Vec<_> = clips.iter().filter(|c| belongs(&c.name)).collect();
            if clips.is_empty() {
                continue;
            }
            let most = |measure: &dyn Fn(&Clip) -> f32| {
                clips.iter().map(|c| measure(c)).fold(0.0, f32::max)
            };
            let least = |measure: &dyn Fn(&Clip) -> f32| {
                clips
                    .iter()
                    .map(|c| measure(c))
                    .fold(f32::INFINITY, f32::min)
            };
            let feet = [LEFT_FOOT, RIGHT_FOOT];
            println!(
                "//! | {kind} {group} | {} | {:.3} | {:.1} | {:.1} | {:.3} | {:.2} |",
                clips.len(),
                most(&|c| feet
                    .map(|foot| stance_slip(c, foot))
                    .into_iter()
                    .fold(0.0, f32::max)),
                100.0
                    * least(&|c| feet
                        .map(|foot| clearance(c, foot))
                        .into_iter()
                        .fold(9.0, f32::min)),
                100.0 * least(&gap),
                least(&margin),
                most(&speed_use),
            );
        }
    }
}

/// Least distance of a joint to a limit, rad.
fn margin(clip: &Clip) -> f32 {
    let margin = |f: &RobotState| {
        let of =
            |(q, joint): (&f32, &g1::Joint)| (q - joint.lower as f32).min(joint.upper as f32 - q);
        let margins = f.joint_positions.iter().zip(&JOINT_TABLE).map(of);
        margins.fold(f32::INFINITY, f32::min)
    };
    clip.frames.iter().map(margin).fold(f32::INFINITY, f32::min)
}

/// Greatest joint speed as a share of its motor's.
fn speed_use(clip: &Clip) -> f32 {
    let of = |f: &RobotState| {
        let shares = f.joint_velocities.iter().zip(&JOINT_TABLE);
        let shares = shares.map(|(speed, joint)| speed.abs() / joint.velocity_limit as f32);
        shares.fold(0.0, f32::max)
    };
    clip.frames.iter().map(of).fold(0.0, f32::max)
}

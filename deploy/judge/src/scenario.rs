//! What is tried: commands over an episode, where it begins, what disturbs it.
//!
//! Separate so that the standard suite can be read as a list.

use std::f32::consts::TAU;

use g1::COMMAND;
use sim::randomization::ROWS;

use super::stress::Row;

/// One thing that robots are tried at.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Scenario {
    /// A name that can be a file's.
    pub(super) name: String,
    /// Held one after another for equal parts of the episode.
    pub(super) commands: Vec<[f32; COMMAND]>,
    /// Begin in frames of the reference motion instead of standing.
    pub(super) from_reference: bool,
    /// Rows of Table I that vary robots, by their keys.
    pub(super) rows: Vec<String>,
    /// Size of the pushes, m/s.
    pub(super) push: Option<f32>,
    /// What stresses the robots.
    pub(super) stress: Option<Row>,
}

/// Pushes come at these shares of an episode: every 4 s of 20.
const PUSHES: [f32; 4] = [0.2, 0.4, 0.6, 0.8];

impl Scenario {
    /// A command held for the whole episode, from standing, undisturbed.
    pub(super) fn holding(name: impl Into<String>, command: [f32; COMMAND]) -> Self {
        Self {
            name: name.into(),
            commands: vec![command],
            from_reference: false,
            rows: Vec::new(),
            push: None,
            stress: None,
        }
    }

    /// The same under stress.
    pub(super) fn under(&self, row: &Row) -> Self {
        Self {
            name: format!("{} {}", self.name, row.label),
            stress: Some(row.clone()),
            ..self.clone()
        }
    }

    /// The command at a step of an episode of `steps`.
    pub(super) fn command(&self, step: u32, steps: u32) -> [f32; COMMAND] {
        let count = self.commands.len();
        let part = step as usize * count / steps.max(1) as usize;
        self.commands[part.min(count - 1)]
    }

    /// The push before a step, world x and y, m/s. Directions are spread evenly over the episodes,
    /// and each push of an episode comes a quarter turn after the one before.
    pub(super) fn push(
        &self,
        step: u32,
        steps: u32,
        episode: usize,
        of: usize,
    ) -> Option<[f32; 2]> {
        let size = self.push?;
        let at = |share: f32| (share * steps as f32).round() as u32;
        let which = PUSHES.iter().position(|share| at(*share) == step)?;
        let angle = TAU * (episode as f32 / of as f32 + which as f32 / PUSHES.len() as f32);
        Some([size * angle.cos(), size * angle.sin()])
    }

    /// The condition that it is tried under, in words.
    pub(super) fn condition(&self) -> String {
        if self.push.is_some() {
            return "pushed".to_owned();
        }
        let start = if self.from_reference {
            "from reference frames"
        } else {
            "from standing"
        };
        if let Some(row) = self.stress.as_ref().filter(|row| !row.values.is_empty()) {
            return format!("{start}, {}", row.label);
        }
        match self.rows.len() {
            0 => start.to_owned(),
            count if count == ROWS.len() => format!("{start}, Table I"),
            _ => format!("{start}, {} of Table I", self.rows.join(" and ")),
        }
    }
}

/// The standard suite.
///
/// - Speeds from standing still to a run, and backwards, which no reference motion shows.
/// - Sideways without forward velocity, for a gait of its own is needed; ±, for a policy may have
///   learnt one side only.
/// - Turning while walking at 0.5 m/s, an arc of 1 m: what a steered walk needs; on the spot; and at a run, in curves of
///   5 m. To both sides.
/// - Each of these from standing and from frames of the nearest reference motion, because a policy
///   that was always started in motion may not know how to begin; and each without and with Table I.
/// - Changes inside an episode: through all speeds and to a stop, through all directions, and through turns of all kinds.
/// - Pushes of 0.5 m/s, the greatest of Table I, from all sides.
pub(super) fn standard() -> Vec<Scenario> {
    let held = [
        ("stand", [0.0, 0.0, 0.0]),
        ("forward-0.5", [0.5, 0.0, 0.0]),
        ("forward-1.0", [1.0, 0.0, 0.0]),
        ("forward-1.5", [1.5, 0.0, 0.0]),
        ("forward-2.0", [2.0, 0.0, 0.0]),
        ("backward-0.5", [-0.5, 0.0, 0.0]),
        ("left-0.3", [0.0, 0.3, 0.0]),
        ("right-0.3", [0.0, -0.3, 0.0]),
        ("turn-left-0.5", [0.5, 0.0, 0.5]),
        ("turn-right-0.5", [0.5, 0.0, -0.5]),
        ("spot-left-0.8", [0.0, 0.0, 0.8]),
        ("spot-right-0.8", [0.0, 0.0, -0.8]),
        ("curve-left-2.0", [2.0, 0.0, 0.4]),
        ("curve-right-2.0", [2.0, 0.0, -0.4]),
    ];
    let forward = |speed: f32| [speed, 0.0, 0.0];
    let changing = [
        (
            "speeds",
            [0.0, 0.5, 1.0, 1.5, 2.0, 1.0, 0.0].map(forward).to_vec(),
        ),
        (
            "directions",
            vec![
                [0.5, 0.0, 0.0],
                [0.5, 0.0, 0.5],
                [0.5, 0.0, -0.5],
                [0.0, 0.3, 0.0],
                [0.0, -0.3, 0.0],
                [-0.5, 0.0, 0.0],
                [0.0, 0.0, 0.0],
            ],
        ),
        (
            "turns",
            vec![
                [0.0, 0.0, 0.8],
                [0.0, 0.0, -0.8],
                [2.0, 0.0, 0.4],
                [2.0, 0.0, -0.4],
                [0.0, 0.0, 0.0],
            ],
        ),
    ];
    let mut suite = Vec::new();
    let all = ROWS.map(str::to_owned).to_vec();
    for rows in [Vec::new(), all] {
        for from_reference in [false, true] {
            let under = |name: &str, commands: Vec<[f32; COMMAND]>| Scenario {
                name: format!(
                    "{name}{}{}",
                    if from_reference { "-reference" } else { "" },
                    if rows.is_empty() { "" } else { "-table-1" }
                ),
                commands,
                from_reference,
                rows: rows.clone(),
                push: None,
                stress: None,
            };
            suite.extend(held.map(|(name, command)| under(name, vec![command])));
            if !from_reference {
                let changing = changing.iter().cloned();
                suite.extend(changing.map(|(name, commands)| under(name, commands)));
            }
        }
    }
    for (name, speed) in [("stand", 0.0), ("forward-0.5", 0.5), ("forward-1.0", 1.0)] {
        suite.push(Scenario {
            push: Some(0.5),
            ..Scenario::holding(format!("{name}-pushed"), forward(speed))
        });
    }
    suite
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn commands_take_equal_parts_of_an_episode() {
        let scenario = Scenario {
            commands: vec![[0.0; 3], [1.0, 0.0, 0.0]],
            ..Scenario::holding("x", [0.0; 3])
        };
        let at = |step| scenario.command(step, 10)[0];
        assert_eq!([at(0), at(4), at(5), at(9)], [0.0, 0.0, 1.0, 1.0]);
        // An episode shorter than its list of commands, and one of a single step.
        assert_eq!(scenario.command(0, 1)[0], 0.0);
    }

    #[test]
    fn pushes_come_from_all_sides() {
        let scenario = Scenario {
            push: Some(0.5),
            ..Scenario::holding("x", [0.0; 3])
        };
        let steps = 1_000;
        let pushed: Vec<u32> = (0..steps)
            .filter(|step| scenario.push(*step, steps, 0, 4).is_some())
            .collect();
        assert_eq!(pushed, [200, 400, 600, 800]);
        let near = |got: [f32; 2], x: f32, y: f32| {
            assert!(
                (got[0] - x).abs() < 1e-6 && (got[1] - y).abs() < 1e-6,
                "{got:?}"
            );
        };
        near(scenario.push(200, steps, 0, 4).unwrap(), 0.5, 0.0);
        near(scenario.push(200, steps, 1, 4).unwrap(), 0.0, 0.5);
        near(scenario.push(400, steps, 1, 4).unwrap(), -0.5, 0.0);
        assert_eq!(
            Scenario::holding("x", [0.0; 3]).push(200, steps, 0, 4),
            None
        );
    }

    #[test]
    fn a_condition_says_which_rows_of_table_1() {
        let under = |rows: &[&str]| {
            let rows = rows.iter().map(ToString::to_string).collect();
            let scenario = Scenario {
                rows,
                ..Scenario::holding("x", [0.0; 3])
            };
            scenario.condition()
        };
        assert_eq!(under(&[]), "from standing");
        assert_eq!(under(&ROWS), "from standing, Table I");
        assert_eq!(
            under(&["impulse", "friction"]),
            "from standing, impulse and friction of Table I"
        );
    }

    #[test]
    fn the_standard_suite_has_one_of_each_name() {
        let suite = standard();
        let names: BTreeSet<_> = suite.iter().map(|scenario| &scenario.name).collect();
        assert_eq!(names.len(), suite.len());
        // Fourteen commands under four conditions, three changing ones under two, three pushed.
        assert_eq!(suite.len(), 14 * 4 + 3 * 2 + 3);
        let plain = |name: &str| *name == *"forward-1.0";
        assert_eq!(names.iter().filter(|name| plain(name)).count(), 1);
        assert!(names.iter().all(|name| !name.contains(['/', ' '])));
    }

    #[test]
    fn the_standard_suite_asks_for_every_turn_to_both_sides() {
        let suite = standard();
        for from_reference in [false, true] {
            for rows in [0, ROWS.len()] {
                let asked: Vec<[f32; COMMAND]> = suite
                    .iter()
                    .filter(|scenario| scenario.commands.len() == 1 && scenario.push.is_none())
                    .filter(|s| s.from_reference == from_reference && s.rows.len() == rows)
                    .map(|scenario| scenario.commands[0])
                    .collect();
                let turning = |speed: std::ops::RangeInclusive<f32>, left: bool| {
                    asked.iter().any(|&[forward, aside, yaw_rate]| {
                        let turns = yaw_rate != 0.0 && (yaw_rate > 0.0) == left;
                        speed.contains(&forward) && aside == 0.0 && turns
                    })
                };
                // On the spot, at a walk, and from 1.8 m/s on, where the reference runs.
                for speed in [0.0..=0.0, 0.3..=1.0, 1.8..=2.5] {
                    assert!(turning(speed.clone(), true), "left at {speed:?}");
                    assert!(turning(speed.clone(), false), "right at {speed:?}");
                }
                // What is asked for on one side is asked for on the other.
                for [forward, aside, yaw_rate] in &asked {
                    let mirrored = [*forward, -aside, -yaw_rate];
                    assert!(asked.contains(&mirrored), "{mirrored:?}");
                }
            }
        }
        let inside = |name: &str| suite.iter().find(|s| s.name == name).unwrap();
        assert_eq!(inside("turns").command(0, 1000), [0.0, 0.0, 0.8]);
        // A fifth of an episode each: the third from step 400 on.
        assert_eq!(inside("turns").command(400, 1000), [2.0, 0.0, 0.4]);
    }
}

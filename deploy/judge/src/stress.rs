//! `--stress`: what a real robot and a real floor do to a policy, one after another, each with a size.
//!
//! Separate because it is a language of its own, that of `deploy/sim2sim.py`: the same names, sizes and lists, so that the
//! figures of three engines can stand beside each other. What a stress amounts to here is a row of `[event]` with one value,
//! for all episodes alike.

mod acting;

pub(super) use acting::Acting;

use std::collections::BTreeSet;
use std::str::FromStr;

/// A stress: its name, and a number for how much.
pub(super) struct Stress {
    pub(super) name: &'static str,
    unit: &'static str,
    default: f32,
    /// What changes nothing; infinite of what comes every so many seconds.
    neutral: f32,
    limits: [f32; 2],
    help: &'static str,
    set: fn(&mut Acting, f32),
}

const fn stress(
    name: &'static str,
    (unit, default, neutral): (&'static str, f32, f32),
    limits: [f32; 2],
    set: fn(&mut Acting, f32),
    help: &'static str,
) -> Stress {
    Stress {
        name,
        unit,
        default,
        neutral,
        limits,
        help,
        set,
    }
}

/// Every stress, in the order of the standard list.
static STRESSES: [Stress; 13] = [
    stress(
        "delay",
        ("ms", 20.0, 0.0),
        [0.0, 40.0],
        Acting::delay,
        "actions reach the motors later",
    ),
    stress(
        "gains",
        ("times", 0.8, 1.0),
        [0.1, 10.0],
        Acting::gains,
        "both gains of the motors",
    ),
    stress(
        "strength",
        ("times", 0.9, 1.0),
        [0.1, 10.0],
        Acting::strength,
        "greatest torque of the motors",
    ),
    stress(
        "payload",
        ("kg", 4.0, 0.0),
        [0.0, 30.0],
        Acting::payload,
        "at the torso's centre of mass",
    ),
    stress(
        "friction",
        ("", 0.3, 1.0),
        [0.0, 3.0],
        Acting::friction,
        "sliding friction of floor and feet",
    ),
    stress(
        "slope",
        ("degrees", 5.0, 0.0),
        [0.0, 20.0],
        Acting::slope,
        "gravity is turned, uphill in any direction",
    ),
    stress(
        "bumps",
        ("cm", 2.0, 0.0),
        [0.0, 2.0],
        Acting::bumps,
        "uneven ground, from valley to peak",
    ),
    stress(
        "push",
        ("N", 250.0, 0.0),
        [0.0, 2000.0],
        Acting::push,
        "on the trunk for 50 ms, every 3 to 5 s, in any horizontal direction",
    ),
    stress(
        "encoder",
        ("rad", 0.02, 0.0),
        [0.0, 0.5],
        Acting::encoder,
        "joints read wrong by up to this, each by its own",
    ),
    stress(
        "imu",
        ("degrees", 2.0, 0.0),
        [0.0, 28.0],
        Acting::imu,
        "the IMU is mounted aslant, about any horizontal axis",
    ),
    stress(
        "dry",
        ("N·m", 1.0, 0.0),
        [0.0, 20.0],
        Acting::dry,
        "dry friction in every joint",
    ),
    stress(
        "velocity",
        ("share", 0.0, 1.0),
        [0.0, 10.0],
        Acting::velocity,
        "of the pelvis' velocity and change of height that the policy is told",
    ),
    stress(
        "commands",
        ("s", 2.0, f32::INFINITY),
        [0.02, 3600.0],
        Acting::commands,
        "another command as often: less of it, and ±0.5 rad/s",
    ),
];

impl Stress {
    fn named(name: &str) -> Option<&'static Self> {
        STRESSES.iter().find(|stress| stress.name == name)
    }

    /// The value of half strength; what comes every so often comes half as often.
    fn half(&self) -> f32 {
        if self.neutral.is_infinite() {
            2.0 * self.default
        } else {
            0.5 * (self.default + self.neutral)
        }
    }
}

/// Stresses that act at once, with what they are called.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Row {
    /// As it was typed, values written out; `none` for none.
    pub(super) label: String,
    pub(super) values: Vec<(&'static str, f32)>,
}

impl Row {
    fn of(values: Vec<(&'static str, f32)>) -> Self {
        let words: Vec<String> = values
            .iter()
            .map(|(name, value)| format!("{name}={value}"))
            .collect();
        Self {
            label: words.join("+"),
            values,
        }
    }

    fn all(label: &str, value: fn(&Stress) -> f32) -> Self {
        Self {
            label: label.to_owned(),
            values: STRESSES
                .iter()
                .map(|stress| (stress.name, value(stress)))
                .collect(),
        }
    }

    /// What it amounts to.
    pub(super) fn acting(&self) -> Acting {
        let mut acting = Acting::default();
        for (name, value) in &self.values {
            let stress = Stress::named(name).expect("a name that was looked up");
            (stress.set)(&mut acting, *value);
        }
        acting
    }
}

/// What `--stress` asks for.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Stresses {
    /// To be told what there is.
    Help,
    /// Rows of a table, the first without any.
    Rows(Vec<Row>),
}

impl FromStr for Stresses {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        if text == "help" {
            return Ok(Self::Help);
        }
        let mut rows = vec![Row {
            label: "none".to_owned(),
            values: Vec::new(),
        }];
        for part in text.split(',').map(str::trim) {
            for row in read(part)? {
                if !rows.contains(&row) {
                    rows.push(row);
                }
            }
        }
        Ok(Self::Rows(rows))
    }
}

/// The rows of one word of a list.
fn read(part: &str) -> Result<Vec<Row>, String> {
    Ok(match part {
        "none" => Vec::new(),
        "all" => vec![Row::all("all", |stress| stress.default)],
        "half" => vec![Row::all("half", Stress::half)],
        "standard" => {
            let single = |stress: &Stress| Row::of(vec![(stress.name, stress.default)]);
            let half = Row::all("half", Stress::half);
            STRESSES.iter().map(single).chain([half]).collect()
        }
        _ => {
            let values: Vec<_> = part
                .split('+')
                .map(|word| one(word.trim()))
                .collect::<Result<_, _>>()?;
            let names: BTreeSet<_> = values.iter().map(|(name, _)| name).collect();
            if names.len() < values.len() {
                return Err(format!("`{part}` names a stress twice: give it one value"));
            }
            vec![Row::of(values)]
        }
    })
}

/// A stress with its value, as in `push=300`.
fn one(word: &str) -> Result<(&'static str, f32), String> {
    let (name, number) = word
        .split_once('=')
        .map_or((word, None), |(name, number)| (name, Some(number)));
    let Some(stress) = Stress::named(name) else {
        let names: Vec<&str> = STRESSES.iter().map(|stress| stress.name).collect();
        return Err(format!(
            "`{name}` is no stress; there are {}, standard, all, half, none (`--stress help` explains them)",
            names.join(", ")
        ));
    };
    let Some(number) = number else {
        return Ok((stress.name, stress.default));
    };
    let [least, most] = stress.limits;
    match number.parse::<f32>() {
        Ok(value) if (least..=most).contains(&value) => Ok((stress.name, value)),
        _ => Err(format!(
            "`{word}`: give {name} a number from {least} to {most} {}",
            stress.unit
        )
        .trim_end()
        .to_owned()),
    }
}

/// What `--stress help` says.
pub(super) fn explained() -> String {
    let mut text = format!(
        "{:<10} {:>7}  {:<8} {:>8}  what\n",
        "stress", "default", "unit", "nothing"
    );
    for stress in &STRESSES {
        let nothing = if stress.neutral.is_infinite() {
            "never".to_owned()
        } else {
            stress.neutral.to_string()
        };
        let line = format!(
            "{:<10} {:>7}  {:<8} {nothing:>8}  {}\n",
            stress.name, stress.default, stress.unit, stress.help
        );
        text.push_str(&line);
    }
    text.push_str(
        "\n--stress delay,push=300       a row for each, after one without stress; `delay` alone means its default\n\
         --stress gains=0.8+payload=4  both at once\n\
         --stress standard             each alone at its default, then all at half strength\n\
         --stress all, --stress half   all at once; half is halfway to where a stress changes nothing\n",
    );
    text
}

#[cfg(test)]
mod tests;

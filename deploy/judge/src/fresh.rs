//! `ampco judge`: a discriminator trained afresh against finished policies, that none of them has trained against.
//!
//! Separate because whoever evaluates takes a judge as it is. A run's own discriminator finds its own policy graceful, and
//! that of another run has never met it; this one has met all of them alike.

mod walks;

use std::path::PathBuf;
use std::time::Instant;

use amp::{
    DiscriminatorConfig, ExplorationConfig, Learning, LearningConfig, PolicyConfig, PpoConfig,
};
use anyhow::{Context, Result};
use clap::builder::NonEmptyStringValueParser;
use motion::Dataset;
use observation::ObservationConfig;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;
use run::{Checkpoints, Config};
use serde::Serialize;
use terminal::Place;
use terminal::console::{self, Console};
use terminal::failure::usage;

use super::Command;
use super::judge::JUDGE;
use super::subject::Subject;
use super::windows::Windows;
use walks::Walks;

/// Rounds of training, each as many steps as the discriminator makes in an iteration of a run.
const ROUNDS: u64 = 400;

/// Commands to walk by if none are given: what every walking policy has learnt.
const COMMANDS: [[f32; 3]; 2] = [[0.5, 0.0, 0.0], [1.0, 0.0, 0.0]];

const LONG: &str = "\
Train a judge of style afresh, against finished policies

Every run trains a discriminator of its own and finds itself graceful. This trains a new one, on reference motion
against the walks of all policies that are named, each with the same share: none of them has trained against
it. Then it scores other episodes of each, and other windows of the reference motion. The first two seconds, in which a
robot sets off, do not count. Reference motion is that of the first policy, drawn for the commands.

  ampco judge my-run walk --out judge        train it, and keep it
  ampco evaluate my-run --judge judge        use it again";

/// Train a judge of style afresh, against finished policies
#[derive(Debug, clap::Args)]
#[command(long_about = LONG)]
pub struct Fresh {
    /// Runs, checkpoints or shipped policies
    #[arg(required = true, value_name = "POLICY", value_parser = NonEmptyStringValueParser::new())]
    policies: Vec<String>,
    #[command(flatten)]
    place: Place,
    /// Command to walk by: forward and leftward velocity in m/s, yaw rate in rad/s; may be repeated
    /// [default: 0.5,0,0 and 1,0,0]
    #[arg(long = "command", value_name = "VX,VY,WZ", allow_hyphen_values = true)]
    commands: Vec<Command>,
    /// Folder to keep the judge in, for `ampco evaluate --judge`
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Episodes of 10 s per policy and command, to learn from and as many others to judge by
    #[arg(long, value_name = "N", default_value_t = 8, value_parser = clap::value_parser!(u32).range(1..=256))]
    episodes: u32,
    /// Seed of the first weights, of what is drawn, and of the episodes
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// End with JSON: an object per policy, and one for the reference
    #[arg(long)]
    json: bool,
}

/// What is found of one policy, or of the reference motion.
#[derive(Debug, Serialize)]
struct Found {
    policy: String,
    /// Mean rˢ (Eq. 7) for each command, in their order; `None` where no robot stayed up long enough.
    style: Vec<Option<f64>>,
}

impl Fresh {
    /// Trains, scores, prints and keeps.
    pub fn run(&self) -> Result<()> {
        if let Some(folder) = self.out.as_ref().filter(|folder| folder.exists()) {
            return Err(usage(format!(
                "--out {}: is there already; remove it or give another",
                folder.display()
            )));
        }
        let subjects = self.policies.iter().map(|name| {
            Subject::open(&self.place, name).with_context(|| format!("opening {name}"))
        });
        let subjects = subjects.collect::<Result<Vec<_>>>()?;
        let commands = self.commands();
        let mut console = Console::on_stderr();
        let mut walks = |seed: u64, what: &str| -> Result<Vec<Walks>> {
            let mut all = Vec::new();
            for (index, subject) in subjects.iter().enumerate() {
                let line = format!(
                    "{what} of {} · {} of {}",
                    self.policies[index],
                    index + 1,
                    subjects.len()
                );
                console.show(&line, Instant::now());
                all.push(Walks::of(subject, &commands, self.episodes as usize, seed)?);
            }
            console.finish();
            Ok(all)
        };
        let learned = walks(self.seed, "walks to learn from")?;
        let others = walks(self.seed.wrapping_add(1), "walks to judge")?;
        for (name, walks) in self.policies.iter().zip(&learned) {
            if walks.is_empty() {
                return Err(usage(format!(
                    "{name}: no robot stays up for the two seconds after which a walk counts; leave it out"
                )));
            }
        }
        let motion = subjects[0].dataset();
        let mut learning = new_judge(self.seed)?;
        let mut generator = Pcg64Mcg::seed_from_u64(self.seed);
        train(
            &mut learning,
            &motion,
            &learned,
            &commands,
            &mut generator,
            ROUNDS,
        )?;
        let mut found = vec![reference(&mut learning, &motion, &commands, &mut generator)];
        for (name, walks) in self.policies.iter().zip(&others) {
            let style = walks.each(|windows| mean(&mut learning, windows));
            found.push(Found {
                policy: name.clone(),
                style,
            });
        }
        if let Some(folder) = &self.out {
            keep(&learning, folder)?;
        }
        self.print(&found, &commands)
    }

    fn commands(&self) -> Vec<[f32; 3]> {
        match self.commands.as_slice() {
            [] => COMMANDS.to_vec(),
            given => given.iter().map(|&Command(command)| command).collect(),
        }
    }

    fn print(&self, found: &[Found], commands: &[[f32; 3]]) -> Result<()> {
        if self.json {
            return console::print(&format!("{}\n", serde_json::to_string(found)?));
        }
        let mut text = format!("{:<32}", "style by a fresh judge");
        for [x, y, turn] in commands {
            text.push_str(&format!("{:>14}", format!("{x},{y},{turn}")));
        }
        for Found { policy, style } in found {
            text.push_str(&format!("\n{policy:<32}"));
            for style in style {
                let cell = style.map_or_else(|| "-".to_owned(), |style| format!("{style:.3}"));
                text.push_str(&format!("{cell:>14}"));
            }
        }
        if let Some(folder) = &self.out {
            text.push_str(&format!("\n\nkept in {}", folder.display()));
        }
        console::print(&(text + "\n"))
    }
}

/// What the walking recipe has, which its card gives the reasons for.
fn discriminator() -> DiscriminatorConfig {
    DiscriminatorConfig {
        frames: 6,
        spacing: 3,
        command_blur: Some([0.1, 0.06, 0.2]),
        learning_rate: 3e-4,
        gradient_penalty: 10.0,
        ..DiscriminatorConfig::default()
    }
}

fn new_judge(seed: u64) -> Result<Learning> {
    let config = LearningConfig {
        policy: PolicyConfig::default(),
        exploration: ExplorationConfig::default(),
        ppo: PpoConfig::default(),
        discriminator: discriminator(),
    };
    let tables = ObservationConfig::default().tables()?;
    Learning::new(config, learner::robot(&tables), seed).context("setting up the networks")
}

/// As many windows of reference motion as `out` holds, each of a command drawn among `commands`.
fn draw(motion: &Dataset, commands: &[[f32; 3]], generator: &mut Pcg64Mcg, out: &mut [f32]) {
    let judge = discriminator();
    let states = judge.frames * motion.width();
    for row in out.chunks_exact_mut(judge.width(motion.width())) {
        let (window, seen) = row.split_at_mut(states);
        let told = commands[generator.random_range(0..commands.len())];
        let obeyed = motion.sample_window_near(told, generator, judge.spacing, window);
        for (i, blur) in judge.command_blur.iter().flatten().enumerate() {
            seen[i] = obeyed[i] + generator.random_range(-blur..=*blur);
        }
    }
}

fn train(
    learning: &mut Learning,
    motion: &Dataset,
    walks: &[Walks],
    commands: &[[f32; 3]],
    generator: &mut Pcg64Mcg,
    rounds: u64,
) -> Result<()> {
    let judge = discriminator();
    let width = judge.width(motion.width());
    let mut experts = vec![0.0; judge.steps * judge.batch * width];
    let mut others = experts.clone();
    let mut console = Console::on_stderr();
    for round in 0..rounds {
        draw(motion, commands, generator, &mut experts);
        for row in others.chunks_exact_mut(width) {
            let policy = generator.random_range(0..walks.len());
            row.copy_from_slice(walks[policy].draw(generator));
        }
        let figures = learning.teach_judge(&experts, &others)?;
        let line = format!(
            "training the judge · {} % · reference {:.2}, policies {:.2}",
            100 * round / rounds,
            figures.expert_score,
            figures.policy_score
        );
        console.show(&line, Instant::now());
    }
    console.finish();
    Ok(())
}

/// Mean rˢ of windows; `None` of none.
fn mean(learning: &mut Learning, windows: &[f32]) -> Option<f64> {
    let mut rewards = Vec::new();
    learning.style_rewards(windows, &mut rewards);
    let sum: f64 = rewards.iter().copied().map(f64::from).sum();
    (!rewards.is_empty()).then(|| sum / rewards.len() as f64)
}

/// What reference motion earns that was drawn anew.
fn reference(
    learning: &mut Learning,
    motion: &Dataset,
    commands: &[[f32; 3]],
    generator: &mut Pcg64Mcg,
) -> Found {
    let width = discriminator().width(motion.width());
    let style = commands.iter().map(|command| {
        let mut windows = vec![0.0; 1_024 * width];
        draw(motion, &[*command], generator, &mut windows);
        mean(learning, &windows)
    });
    Found {
        policy: "the reference motion".to_owned(),
        style: style.collect(),
    }
}

/// Writes the folder whole or not at all.
fn keep(learning: &Learning, folder: &std::path::Path) -> Result<()> {
    let mut draft = folder.as_os_str().to_owned();
    draft.push(".new");
    let draft = PathBuf::from(draft);
    let bytes = learning.save_judge();
    let written = Checkpoints::new(draft.clone())
        .write(0, "judge", &[(JUDGE, &bytes)])
        .context("writing the judge")?;
    let mut config = Config::default();
    config.resolve(&discriminator());
    config.write(
        &written.join("config.toml"),
        "A judge of style.\nWritten by `ampco judge`.",
    )?;
    std::fs::rename(&written, folder)
        .with_context(|| format!("moving the judge to {}", folder.display()))?;
    std::fs::remove_dir(&draft).with_context(|| format!("removing {}", draft.display()))
}

/// As the judge sees robots.
fn windows() -> Result<Windows> {
    let tables = ObservationConfig::default().tables()?;
    Ok(Windows::new(&discriminator(), tables.discriminator))
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::Parser;

    #[derive(Parser)]
    struct Typed {
        #[command(flatten)]
        fresh: Fresh,
    }

    fn typed(words: &[&str]) -> Fresh {
        let walk = concat!(env!("CARGO_MANIFEST_DIR"), "/../policies/walk");
        Typed::parse_from([&["judge", walk], words].concat()).fresh
    }

    fn walk() -> Subject {
        let walk = typed(&[]).policies.remove(0);
        let place = Place {
            runs_dir: "runs".into(),
        };
        Subject::open(&place, &walk).unwrap()
    }

    #[test]
    fn windows_begin_after_two_seconds_and_end_with_the_command() {
        let commands = [[0.5, 0.0, 0.0], [1.0, 0.0, 0.0]];
        let walks = Walks::of(&walk(), &commands, 1, 1).unwrap();
        // Six states of 53 numbers and a command; 500 steps less 100.
        let sizes = walks.each(<[f32]>::len);
        assert_eq!(sizes, [400 * 321, 400 * 321]);
        let ends = walks.each(|windows| windows[318..321].to_vec());
        assert_eq!(ends, commands.map(|command| command.to_vec()));
    }

    #[test]
    fn a_judge_learns_to_tell_a_robot_that_walks_the_reference_from_one_that_does_not() {
        let commands = [[1.0, 0.0, 0.0]];
        let subject = walk();
        let walks = [Walks::of(&subject, &commands, 1, 1).unwrap()];
        let motion = subject.dataset();
        let mut generator = Pcg64Mcg::seed_from_u64(1);
        let mut learning = new_judge(1).unwrap();
        train(&mut learning, &motion, &walks, &commands, &mut generator, 6).unwrap();
        let found = reference(&mut learning, &motion, &commands, &mut generator);
        let style = walks[0].each(|windows| mean(&mut learning, windows));
        let gap = found.style[0].unwrap() - style[0].unwrap();
        assert!(gap > 0.1, "{gap}");
        assert_eq!(mean(&mut learning, &[]), None);

        let folder = tempfile::tempdir().unwrap();
        let kept = folder.path().join("judge");
        keep(&learning, &kept).unwrap();
        // Whoever evaluates by it finds the same.
        let place = Place {
            runs_dir: "runs".into(),
        };
        let opened = super::super::Kept::open(&place, kept.to_str().unwrap()).unwrap();
        assert_eq!(opened.learning.discriminator, discriminator());
        let (_, bytes) = super::super::Judge::of(&opened).unwrap().part();
        assert_eq!(bytes, learning.save_judge());
        let again = typed(&["--out", kept.to_str().unwrap()]).run();
        assert!(again.unwrap_err().to_string().contains("is there already"));
    }
}

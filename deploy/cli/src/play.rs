//! `ampco play`: watch a policy or a reference motion.
//!
//! What is watched becomes a recording first; a page or a data file is made of that, so nothing here draws.

mod clip;
pub(crate) mod policy;

use std::path::PathBuf;

use anyhow::Result;
use judge::{Command, Subject};
use playback::{Recording, page};
use policy::Show;
use sim::RandomizationConfig;
use terminal::failure::usage;
use terminal::{Engine, Place, SelfCollision, console, file};

/// Watch a policy or a reference motion: a page for any browser, or the frames as data
///
/// The page is one file that needs no network: orbit with the mouse, scrub, pause. Of a policy it shows one robot that
/// acts without exploration noise, of a motion file or a built-in gait the reference itself.
#[derive(Debug, clap::Args)]
pub(crate) struct Play {
    /// A run's name or folder, a checkpoint's folder, a motion file, or a built-in gait with its speed in m/s:
    /// walk:0.8, run:2.2, stand:0
    what: String,
    #[command(flatten)]
    place: Place,
    /// Write a page that plays it
    #[arg(long, value_name = "FILE", required_unless_present = "json")]
    html: Option<PathBuf>,
    /// Write the frames as JSON
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
    /// Length; a motion file plays once
    #[arg(long, value_name = "S", default_value_t = 10.0)]
    seconds: f64,
    /// Command to follow: forward and leftward velocity in m/s, yaw rate in rad/s; several follow each other, each for
    /// an equal share of the time [default: 0.8,0,0]
    #[arg(long = "command", value_name = "VX,VY,WZ", allow_hyphen_values = true)]
    commands: Vec<Command>,
    /// Apply every row of the paper's domain randomisation (Table I)
    #[arg(long)]
    randomize: bool,
    /// Begin in a frame of the reference motion instead of standing
    #[arg(long)]
    from_reference: bool,
    /// Engine that moves the robot, whatever the policy was trained in
    #[arg(long, value_enum, default_value_t = Engine::Rapier)]
    physics: Engine,
    /// Whether legs, arms and trunk meet each other, whatever the policy was trained with
    #[arg(long, value_enum, default_value_t = SelfCollision::On)]
    self_collision: SelfCollision,
    /// Seed of the episode
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Frames per second of a motion file
    #[arg(long)]
    fps: Option<f64>,
}

impl Play {
    pub(crate) fn run(&self) -> Result<()> {
        if !(0.02..=600.0).contains(&self.seconds) {
            return Err(usage(format!(
                "--seconds {}: give 0.02 to 600",
                self.seconds
            )));
        }
        for path in [&self.html, &self.json].into_iter().flatten() {
            file::check_place(path)?;
        }
        let recording = match clip::Source::parse(&self.what) {
            Some(source) => clip::record(&source, self.fps, self.seconds)?,
            None => policy::record(&Subject::open(&self.place, &self.what)?, &self.show())?,
        };
        if let Some(path) = &self.html {
            file::write(path, page::html(&recording).as_bytes())?;
        }
        if let Some(path) = &self.json {
            file::write(path, &serde_json::to_vec(&recording)?)?;
        }
        say(&recording)
    }

    fn show(&self) -> Show {
        Show {
            commands: match self.commands.as_slice() {
                [] => vec![[0.8, 0.0, 0.0]],
                given => given.iter().map(|command| command.0).collect(),
            },
            seconds: self.seconds,
            randomization: if self.randomize {
                RandomizationConfig::table_one()
            } else {
                RandomizationConfig::default()
            },
            from_reference: self.from_reference,
            mechanics: self.self_collision.within(self.physics),
            seed: self.seed,
            again: false,
        }
    }
}

fn say(recording: &Recording) -> Result<()> {
    use std::io::Write;
    let seconds = (recording.frames.len() - 1) as f64 * recording.frame_seconds;
    let ending = match recording.fell_at {
        Some(at) => format!(", fell after {at:.2} s"),
        None => String::new(),
    };
    let mut out = console::results();
    writeln!(
        out,
        "{} · {}: {seconds:.2} s{ending}",
        recording.title, recording.source
    )?;
    Ok(())
}

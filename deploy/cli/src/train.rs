//! `ampco train`: from options to a running group.

mod from;
mod pictures;
mod resumed;

use std::net::SocketAddr;
use std::path::Path;

use anyhow::{Context, Result, bail};
use clap::Args;
use configuration::presets;
use configuration::resolve::{self, Resolved};
use motion::Dataset;
use motion::dataset::Reference;
use motion::quality::{Severity, line, severity};
use protocol::RolloutLayout;
use run::motion::Print;
use run::{Config, Folder};
use supervise::{Ending, Launch, Members};
use terminal::Place;
use terminal::console::say;
use terminal::failure::usage;
use wording::count;

use resumed::GoingOn;

/// Train: start scheduler, learner and actors, watch them, end them in order on Ctrl-C
///
/// Without --run the run is named after its preset and numbered. Everything is checked before
/// anything starts. A live line shows how it goes; metrics and logs are in the run's folder.
#[derive(Debug, Args)]
pub(crate) struct Train {
    /// Preset: ampco, one of the methods it is compared with, smoke, or a TOML file (- reads it from standard input); with --resume it is laid over the
    /// run's own configuration [default: ampco]
    #[arg(long, value_name = "NAME|FILE")]
    preset: Option<String>,
    /// Name of the run, a new one unless --resume [default: the preset's, numbered]
    #[arg(long, value_name = "NAME")]
    run: Option<String>,
    #[command(flatten)]
    place: Place,
    /// Actor processes [default: one per core]
    #[arg(long, value_name = "N")]
    actors: Option<u32>,
    /// Let other machines take part: `ampco join` there, with the file from the run's join/ folder
    #[arg(long, value_name = "ADDRESS:PORT")]
    listen: Option<String>,
    /// Of the actors so many on this machine, the others are to join [default: all]
    #[arg(long, value_name = "N", requires = "listen")]
    here: Option<usize>,
    /// End at this iteration, counted from the run's first
    #[arg(long, value_name = "N")]
    iterations: Option<u32>,
    /// End after so many minutes
    #[arg(long, value_name = "M")]
    minutes: Option<f64>,
    /// Set one value of the configuration, as in ppo.epochs=4 or seed=7; may be repeated
    #[arg(long = "set", value_name = "KEY=VALUE")]
    set: Vec<String>,
    /// Begin with the policy of another run, or of a checkpoint's folder: its networks, their optimizer, statistics of
    /// observations. Of a shipped policy its networks; one without critic.bin gets a new critic, which learns alone for a
    /// million samples (ppo.critic_first)
    #[arg(long, value_name = "RUN|FOLDER", conflicts_with = "resume")]
    from: Option<String>,
    /// Draw nothing at the end: else play.html (the policy at up to four commands) and curves.svg are written to the run's folder
    #[arg(long)]
    no_pictures: bool,
    /// Go on from the last checkpoint of --run, or of the newest run; without one, from its start. What is set otherwise
    /// than before is told and counts from there on; what a checkpoint cannot take, such as other networks, is refused
    #[arg(long)]
    resume: bool,
}

impl Train {
    pub(crate) fn run(&self) -> Result<()> {
        // A soak or a study starts us as its child, and takes us along when it ends.
        protocol::end_with_supervisor()?;
        if let Some(listen) = &self.listen
            && listen.parse::<SocketAddr>().is_err()
        {
            return Err(usage(format!(
                "--listen {listen}: give ADDRESS:PORT, as in 0.0.0.0:7000 for every network of this machine"
            )));
        }
        let ready = if self.resume {
            self.resumed()?
        } else {
            self.new_run()?
        };
        let (folder, resolved) = (&ready.folder, &ready.resolved);
        let here = self.here.unwrap_or(resolved.fleet.actors);
        if here > resolved.fleet.actors {
            return Err(usage(format!(
                "--here {here}: the run has {}",
                count(resolved.fleet.actors, "actor")
            )));
        }
        let _supervisor = folder.lock("supervisor")?;
        if !self.resume && has_history(folder) {
            // Looked at again under the lock: another start may have been quicker.
            return Err(taken(folder));
        }
        ready.tell()?;
        resolved.notices.iter().for_each(|notice| say(notice));
        folder.note_motion(ready.iteration(), ready.motion.clone())?;
        let comment = format!(
            "Resolved configuration of run {}: every value, defaults included.\n\
             Written by `ampco train` at each start; change values with --set.",
            folder.name()
        );
        ready.config.write(&folder.config_path(), &comment)?;
        say(&format!(
            "run {} in {} · {} × {} × {} · Ctrl-C ends it in order",
            folder.name(),
            folder.path().display(),
            count(resolved.fleet.actors, "actor"),
            count(resolved.fleet.environments_per_actor(), "environment"),
            count(resolved.fleet.steps, "step"),
        ));
        let ending = supervise::supervise(&Launch {
            folder,
            run: &resolved.run,
            fleet: &resolved.fleet,
            resume: !folder.checkpoints().list().is_empty(),
            members: match &self.listen {
                None => Members::All,
                Some(listen) => Members::Hosts { here, listen },
            },
        })?;
        if ending == Ending::InOrder && !self.no_pictures {
            pictures::draw(&self.place, folder);
        }
        Ok(())
    }

    fn new_run(&self) -> Result<Ready> {
        let preset = presets::find(self.preset.as_deref().unwrap_or("ampco"))?;
        preset.notices.iter().for_each(|notice| say(notice));
        let mut config = preset.config;
        self.apply(&mut config)?;
        if let Some(from) = &self.from {
            from::begin_with(&self.place, from, &mut config)?;
        }
        resolve::anchor_files(&mut config)?;
        let resolved = resolve::resolve(&mut config)?;
        let motion = check(&config, &resolved)?;
        let name = match &self.run {
            Some(name) => name.clone(),
            None => self.place.free_name(&preset.name),
        };
        let folder =
            Folder::create(&self.place.runs_dir, &name).context("making the run's folder")?;
        if has_history(&folder) {
            return Err(taken(&folder));
        }
        Ok(Ready {
            folder,
            config,
            resolved,
            motion,
            going_on: None,
        })
    }

    /// Lays the options over what is there.
    fn apply(&self, config: &mut Config) -> Result<()> {
        for assignment in &self.set {
            config.set(assignment)?;
        }
        if let Some(actors) = self.actors {
            if actors == 0 {
                return Err(usage(
                    "--actors 0: a group needs at least one; leave it out for one per core",
                ));
            }
            config.put(
                "fleet.actors",
                i64::from(actors),
                &format!("--actors {actors}"),
            );
        }
        // One of the two given alone lifts the other: "twenty minutes" means whatever fits in them.
        if let Some(iterations) = self.iterations {
            let origin = format!("--iterations {iterations}");
            config.put("run.iterations", i64::from(iterations), &origin);
            if self.minutes.is_none() {
                config.put("run.minutes", 0.0, &origin);
            }
        }
        if let Some(minutes) = self.minutes {
            let origin = format!("--minutes {minutes}");
            config.put("run.minutes", minutes, &origin);
            if self.iterations.is_none() {
                config.put("run.iterations", 0, &origin);
            }
        }
        Ok(())
    }
}

/// What is about to be started; nothing is written yet.
struct Ready {
    folder: Folder,
    config: Config,
    resolved: Resolved,
    /// The motion files as they are now.
    motion: Vec<Print>,
    /// Of a run that has a checkpoint.
    going_on: Option<GoingOn>,
}

/// Reads the reference motion, and asks the machine whether it can do what is asked for; the files that were read.
fn check(config: &Config, resolved: &Resolved) -> Result<Vec<Print>> {
    // Files are absolute by now, so the folder they would start from does not matter.
    let here = Path::new(".");
    let files = Dataset::read(&resolved.motion, here).and_then(|references| {
        report_defects(&references);
        Dataset::files(&resolved.motion, here)
    });
    // Its causes belong to the line: which row of which file.
    let files = files.map_err(|error| {
        let path = error.path().to_owned();
        config.refuse("motion", &path, format!("{:#}", anyhow::Error::from(error)))
    })?;
    let prints = Print::of_all(&files)?;
    let layout = RolloutLayout {
        environments: resolved.fleet.environments_per_actor(),
        steps: resolved.fleet.steps,
        lists: (&resolved.tables).into(),
    };
    let shape = policy::Shape::new(resolved.tables.actor.width(), &resolved.policy.hidden);
    let needed = protocol::reserved_bytes(resolved.fleet.actors, layout, shape.len());
    let free = free_shared_memory()?;
    if needed > free {
        bail!(
            "the group needs {} MB of shared memory and /dev/shm has {} MB free; use fewer \
             fleet.environments or fleet.steps, or make room",
            needed.div_ceil(1_000_000),
            free / 1_000_000
        );
    }
    Ok(prints)
}

/// A line per clip from a file that has defects.
///
/// Not a refusal: whoever names a file may know better what it is for than a threshold does, one clip of hundreds must
/// not keep a night's run from starting, and `ampco motions check` is there to refuse.
fn report_defects(references: &[Reference]) {
    let mut unfit = 0;
    for reference in references {
        let defects = reference.defects();
        if defects.is_empty() {
            continue;
        }
        unfit += usize::from(severity(&defects) == Some(Severity::Unfit));
        say(&format!("motion {}", line(&reference.clip.name, &defects)));
    }
    if unfit > 0 {
        say(&format!(
            "motion: {unfit} of {} clips are UNFIT to train on, and are trained on all the same; `ampco motions check` \
             says what to do about each",
            references.len()
        ));
    }
}

/// Bytes free in /dev/shm.
fn free_shared_memory() -> Result<u64> {
    let facts = rustix::fs::statvfs("/dev/shm").context("measuring free space of /dev/shm")?;
    // A tmpfs without a limit reports no blocks at all.
    Ok(match facts.f_blocks {
        0 => u64::MAX,
        _ => facts.f_bavail.saturating_mul(facts.f_frsize),
    })
}

/// Whether something has been learned in this folder that a new run would overwrite.
fn has_history(folder: &Folder) -> bool {
    let metrics = std::fs::metadata(folder.metrics_path());
    metrics.is_ok_and(|file| file.len() > 0) || !folder.checkpoints().list().is_empty()
}

fn taken(folder: &Folder) -> anyhow::Error {
    let name = folder.name();
    usage(format!(
        "run {name} exists already: go on with `--run {name} --resume`, or choose another name"
    ))
}

//! The learner's loop: gather, learn, log, report, save, broadcast.

use std::path::Path;
use std::time::Instant;

use amp::{Batch, IterationReport, LearningError, Saturation};
use anyhow::{Context, Result};
use protocol::{Shutdown, WeightsOrder};
use run::{Folder, Lock};
use tracing::{error, info, warn};
use vocabulary::Cause;

use crate::config::LearnerConfig;
use crate::cores::Cores;
use crate::gait::{Measures, Places, Watch};
use crate::gathering::Gathered;
use crate::guidance::Guide;
use crate::lines::Lines;
use crate::record::{self, DecisionFigures, Record, Refused, Timing, Traffic};
use crate::robot::robot;
use crate::state::State;

/// Updates refused in a row after which something is broken for good.
const MOST_REFUSALS: u64 = 5;

/// Learns for the run in `run_dir` until its iterations are done or it is told to stop.
pub fn run(run_dir: &Path, resume: bool) -> Result<()> {
    protocol::end_with_supervisor()?;
    crate::pages::keep_small();
    let folder = Folder::open(run_dir)?;
    run::log::init(&folder.logs(), "learner")?;
    let held = folder.lock("learner")?;
    let config = LearnerConfig::read(&folder)?;
    let shutdown = Shutdown::on_signals()?;
    let mut state = State::begin(&folder, &config, resume)?;
    let mut lines = Lines::open(&folder, &config, &mut state)?;
    let mut batch = Batch::new(robot(&config.tables).widths());
    batch.calm_share = config.fleet.calm_share;
    let mut learner = Loop {
        started: Instant::now(),
        refusals: 0,
        watch: Watch::default(),
        saturation: Saturation::default(),
        places: Places::of(&config.tables),
        cores: Cores::default(),
        held,
        folder,
        config,
    };
    info!(iteration = state.iteration, resume, "learning");

    let mut order = if resume {
        WeightsOrder::RestoreThenCollect
    } else {
        WeightsOrder::Collect
    };
    while !shutdown.requested() && !learner.is_complete(&state) {
        let began = Instant::now();
        lines.broadcast(&mut state, &learner.config, order)?;
        let broadcast_seconds = began.elapsed().as_secs_f64();
        let Some(gathered) = lines
            .intake
            .gather(state.iteration, &mut batch, &shutdown)?
        else {
            break;
        };
        let gather_seconds = began.elapsed().as_secs_f64() - broadcast_seconds;
        let guide = lines.guide(&mut state)?;
        let learned = state.learn(&batch, &learner.config, &guide);
        let span = Span {
            began,
            broadcast_seconds,
            gather_seconds,
            gathered,
        };
        learner.tell(&mut lines, &state, &batch, &guide, &learned, &span)?;
        let actors: Vec<u32> = lines.intake.members().collect();
        if learner.is_hopeless() {
            learner.save(&mut state, &actors);
            return Err(learned.expect_err("refused")).context(format!(
                "{MOST_REFUSALS} updates in a row were refused; the last good weights are in {}",
                learner.folder.checkpoints().path(state.iteration).display()
            ));
        }
        order = WeightsOrder::Collect;
        if state
            .iteration
            .is_multiple_of(learner.config.run.checkpoint_every)
            && learner.save(&mut state, &actors)
        {
            order = WeightsOrder::SaveThenCollect;
        }
    }
    lines.sync();
    let actors: Vec<u32> = lines.intake.members().collect();
    learner.save(&mut state, &actors);
    lines.broadcast(&mut state, &learner.config, WeightsOrder::SaveThenStop)?;
    info!(iteration = state.iteration, "done");
    Ok(())
}

/// What stays the same while the loop turns.
struct Loop {
    folder: Folder,
    config: LearnerConfig,
    started: Instant,
    refusals: u64,
    watch: Watch,
    saturation: Saturation,
    /// Where a batch holds what gait measures are made of.
    places: Places,
    cores: Cores,
    held: Lock,
}

/// One turn of the loop, from its broadcast on.
struct Span {
    began: Instant,
    broadcast_seconds: f64,
    gather_seconds: f64,
    gathered: Gathered,
}

impl Loop {
    fn is_complete(&self, state: &State) -> bool {
        let limit = self.config.run.iterations;
        limit > 0 && state.iteration >= limit
    }

    fn is_hopeless(&self) -> bool {
        self.refusals >= MOST_REFUSALS
    }

    fn seconds(&self, state: &State) -> f64 {
        state.seconds_before + self.started.elapsed().as_secs_f64()
    }

    /// Writes a checkpoint, to which `actors` are to add their robots; a disk that refuses stops the writing, not the training.
    fn save(&self, state: &mut State, actors: &[u32]) -> bool {
        let seconds = self.seconds(state);
        match state.save(&self.folder, &self.config, actors, seconds) {
            Ok(()) => true,
            Err(problem) => {
                let problem = anyhow::Error::from(problem);
                warn!(
                    iteration = state.iteration,
                    problem = format!("{problem:#}"),
                    "checkpoint not written; training goes on"
                );
                false
            }
        }
    }

    /// One line for the log, one report for the scheduler.
    fn tell(
        &mut self,
        lines: &mut Lines,
        state: &State,
        batch: &Batch,
        guide: &Guide,
        learned: &Result<IterationReport, LearningError>,
        span: &Span,
    ) -> Result<()> {
        match learned {
            Ok(report) => {
                self.refusals = 0;
                let ended = &report.terminations;
                // Episodes that mostly ended otherwise say nothing of how long robots stay up.
                let mostly_falls = 2 * ended.by(Cause::Fall) > ended.total();
                let fell_after = report.episode_length.filter(|_| mostly_falls);
                let measures = Measures::of(batch, fell_after, &self.places);
                self.watch.take(state.iteration, &measures);
                self.tell_saturation(report);
                let idle_share = self.cores.idle_share();
                let mut record = self.record(lines, state, &measures, guide, report, span);
                record.timing.idle_share = idle_share;
                lines.log(&record);
                self.held.at_work();
                lines.report(state)
            }
            Err(problem) => {
                self.refusals += 1;
                error!(iteration = state.iteration, %problem, "update refused; the last good weights stay");
                lines.log(&Refused {
                    iteration: state.iteration,
                    samples: state.samples(),
                    fault: problem.to_string(),
                });
                Ok(())
            }
        }
    }

    /// Says when the discriminator begins to tell every transition apart, and when it no longer does.
    fn tell_saturation(&mut self, report: &IterationReport) {
        let (iteration, scores) = (report.iteration, report.scores());
        match self.saturation.take(&scores) {
            Some(true) => warn!(iteration, "{scores}"),
            Some(false) => info!(iteration, "{scores}"),
            None => {}
        }
    }

    fn record(
        &self,
        lines: &Lines,
        state: &State,
        measures: &Measures,
        guide: &Guide,
        report: &IterationReport,
        span: &Span,
    ) -> Record {
        let iteration_seconds = span.began.elapsed().as_secs_f64();
        let gathered = &span.gathered;
        Record {
            iteration: state.iteration,
            samples: state.samples(),
            phase: guide.directive.map_or(1, |directive| directive.phase),
            task_weight: 1.0 - report.style_weight,
            episode_share: self.config.episode_share(report),
            learning: record::figures(report),
            terms: gathered.terms.clone(),
            decision: DecisionFigures::of(guide, lines.is_scheduler_away()),
            gait: measures.into(),
            traffic: Traffic::of(
                gathered,
                lines.intake.ledger().totals(),
                lines.intake.unused(),
            ),
            timing: Timing {
                seconds: self.seconds(state),
                iteration_seconds,
                samples_per_second: report.rows as f64 / iteration_seconds,
                decision_seconds: guide.directive.and_then(|told| told.decision_seconds()),
                gather_seconds: span.gather_seconds,
                broadcast_seconds: span.broadcast_seconds,
                copy_seconds: gathered.copy_seconds,
                learn_seconds: iteration_seconds - span.broadcast_seconds - span.gather_seconds,
                learning: report.seconds,
                collect_seconds: gathered.collect_seconds,
                physics_seconds: gathered.physics_seconds,
                observation_seconds: gathered.observation_seconds,
                inference_seconds: gathered.inference_seconds,
                waiting_seconds: gathered.waiting_seconds,
                idle_share: None,
            },
        }
    }
}

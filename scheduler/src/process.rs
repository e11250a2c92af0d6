//! The scheduler's loop: a report arrives, a directive answers.

use std::path::Path;
use std::time::{Duration, Instant};

use ampco::{Decision, Report, Schedule};
use anyhow::{Context, Result};
use protocol::{
    Directive, DirectivePublisher, Domain, Node, RewardArrival, RewardSubscriber, Shutdown, Wake,
};
use run::{Folder, Lock};
use tracing::{info, warn};

use crate::desk::Desk;
use crate::message;

/// Longest sleep without a report. The wait itself looks for dead processes and for the request to stop.
const SLEEP: Duration = Duration::from_secs(1);

/// Decides for the run in `run_dir` until it is told to stop.
pub fn run(run_dir: &Path) -> Result<()> {
    protocol::end_with_supervisor()?;
    let folder = Folder::open(run_dir)?;
    run::log::init(&folder.logs(), "scheduler").context("opening the log")?;
    let mut held = folder.lock("scheduler")?;
    let schedule = crate::config::read(&folder)?;
    let shutdown = Shutdown::on_signals()?;
    let node = Node::join(&Domain::for_run(folder.path())?, "scheduler", &shutdown)?;
    serve(&folder, schedule, &node, &mut held)?;
    info!("told to stop");
    Ok(())
}

/// Answers reports until the node's shutdown is requested.
fn serve(folder: &Folder, fresh: Schedule, node: &Node, held: &mut Lock) -> Result<()> {
    let mut reports =
        RewardSubscriber::new(node).context("opening the stream of reward reports")?;
    let mut directives =
        DirectivePublisher::new(node).context("opening the stream of directives")?;
    // After the streams are open: a report that is sent meanwhile waits in them.
    let mut desk = begin(folder, fresh)?;
    while reports.wait(SLEEP)? != Wake::Shutdown {
        while let Some(arrival) = reports.receive()? {
            let started = Instant::now();
            let decision = answer(&mut desk, &arrival, folder)?;
            directives.send(Directive {
                decision_seconds: started.elapsed().as_secs_f64(),
                ..message::directive(arrival.report.learner, &decision)
            })?;
            held.at_work();
        }
    }
    Ok(())
}

fn begin(folder: &Folder, fresh: Schedule) -> Result<Desk> {
    let records = records(folder)?;
    let desk = Desk::open(fresh, &records);
    let schedule = desk.schedule();
    info!(
        method = ?schedule.config().method,
        window = schedule.config().window,
        recorded = records.len(),
        newest = ?schedule.newest_iteration(),
        phase = schedule.phase().number(),
        "ready"
    );
    Ok(desk)
}

fn answer(desk: &mut Desk, arrival: &RewardArrival, folder: &Folder) -> Result<Decision> {
    let report = message::report(&arrival.report);
    let reply = desk.answer(report, || records(folder))?;
    let decision = reply.decision;
    if reply.rebuilt {
        let (iteration, phase) = (decision.iteration, decision.phase.number());
        info!(
            iteration,
            phase,
            missed = arrival.missed,
            "state rebuilt from the metrics"
        );
    }
    if let Some(refused) = reply.refused {
        warn!(iteration = report.iteration, %refused, "report refused; the last directive stays in force");
    } else if decision.just_switched() {
        tell_switch(&decision);
    }
    Ok(decision)
}

/// The event of a run: convergence was found.
fn tell_switch(decision: &Decision) {
    let iteration = decision.iteration;
    let (lower, upper) = decision
        .bounds()
        .map(|bounds| (bounds.lower(), bounds.upper()))
        .unzip();
    let (breakout_rate, threshold, trend) =
        (decision.breakout_rate, decision.threshold, decision.trend);
    info!(iteration, ?breakout_rate, threshold, ?trend, ?lower, ?upper, rule = ?decision.rule, "phase two");
    for warning in decision.warning().into_iter().chain(decision.idle_bounds()) {
        warn!(iteration, "{warning}");
    }
}

fn records(folder: &Folder) -> Result<Vec<Report>> {
    run::metrics::read(&folder.metrics_path()).context("reading the run's metrics")
}

#[cfg(test)]
mod tests;

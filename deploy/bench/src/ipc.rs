//! Messages: wake-up latency, throughput, and how soon new weights act.
//!
//! Measured through the very streams that training uses, between two members of a domain of its own,
//! each on its own thread. Nothing needs the scheduler or the learner to run.

use std::hint::black_box;
use std::path::PathBuf;
use std::sync::mpsc::channel;
use std::time::{Duration, Instant};

use anyhow::{Context, Result, bail, ensure};
use policy::{Policy, Shape};
use protocol::{
    Domain, Lists, Node, RolloutHeader, RolloutLayout, RolloutPublisher, RolloutSubscriber,
    SendOutcome, Shutdown, Wake, Weights, WeightsHeader, WeightsOrder, WeightsPublisher,
    WeightsSubscriber,
};
use serde_json::{Value, json};

/// Longest time any single message may take.
const DEADLINE: Duration = Duration::from_secs(10);

/// Hidden layers of the policy that is adopted.
const HIDDEN: [usize; 3] = [256, 128, 64];
/// What it cuts observations to; of no influence on the time.
const CLIP: f32 = 5.0;

/// 1·(1082·242 + 164) numbers of four bytes: a message of 1.05 million bytes.
fn mebibyte() -> RolloutLayout {
    RolloutLayout {
        environments: 1,
        steps: 1082,
        lists: Lists::default(),
    }
}

/// Measure latency and throughput of the messages between processes.
#[derive(Debug, clap::Args)]
pub(crate) struct IpcBench {
    /// Wake-ups measured
    #[arg(long, default_value_t = 5000)]
    wakes: usize,
    /// Messages of 1 MiB written and read
    #[arg(long, default_value_t = 4000)]
    messages: usize,
    /// Adoptions of new weights measured
    #[arg(long, default_value_t = 500)]
    adoptions: usize,
}

impl IpcBench {
    /// One-way wake latency in µs, throughput in GB/s, time until weights act in ms.
    pub(crate) fn run(&self) -> Result<Value> {
        let wires = Wires::new()?;
        let wakes = wake(&wires, self.wakes)?;
        let gigabytes = throughput(&wires, self.messages)?;
        let adoptions = adoption(&wires, self.adoptions)?;
        Ok(json!({
            "wake_p50_us": micros(percentile(&wakes, 0.50)),
            "wake_p99_us": micros(percentile(&wakes, 0.99)),
            "gigabytes_per_second": gigabytes,
            "adoption_ms": micros(percentile(&adoptions, 0.50)) / 1000.0,
            "adoption_p99_ms": micros(percentile(&adoptions, 0.99)) / 1000.0,
        }))
    }
}

/// A domain for this benchmark alone, removed with its folder at the end.
struct Wires {
    folder: PathBuf,
    domain: Domain,
}

impl Wires {
    fn new() -> Result<Self> {
        let name = format!("ampco-bench-{}", std::process::id());
        let folder = std::env::temp_dir().join(name);
        std::fs::create_dir(&folder)
            .with_context(|| format!("creating the folder {}", folder.display()))?;
        let domain = Domain::for_run(&folder)?;
        Ok(Self { folder, domain })
    }

    fn join(&self, role: &str) -> Result<Node> {
        Ok(Node::join(&self.domain, role, &Shutdown::manual())?)
    }
}

impl Drop for Wires {
    fn drop(&mut self) {
        // Nothing to be done about a failure but to say it.
        if let Err(error) = self.domain.remove() {
            tracing::warn!(%error, "removing the domain of the benchmark");
        }
        if let Err(error) = std::fs::remove_dir(&self.folder) {
            tracing::warn!(%error, "removing the folder of the benchmark");
        }
    }
}

/// From a send to the return of a blocked wait, one way.
fn wake(wires: &Wires, count: usize) -> Result<Vec<Duration>> {
    exchange(wires, count, &[0.0], |woken, _| Ok(woken))
}

/// From the learner's broadcast to the policy of a waiting actor having loaded the weights.
fn adoption(wires: &Wires, count: usize) -> Result<Vec<Duration>> {
    let shape = Shape::new(mebibyte().lists.widths.observation, &HIDDEN);
    // The time does not depend on the values, which only have to be finite and σ positive.
    let flat = vec![0.01; shape.len()];
    let mut policy = Policy::new(shape, CLIP);
    exchange(wires, count, &flat, move |_, weights| {
        policy.load(weights).context("loading the weights")?;
        Ok(Instant::now())
    })
}

/// Broadcasts `flat` `count` times to a sleeping reader and returns the sorted times from the
/// broadcast to the moment that `adopt` names, given the moment of waking and the weights.
fn exchange(
    wires: &Wires,
    count: usize,
    flat: &[f32],
    mut adopt: impl FnMut(Instant, &[f32]) -> Result<Instant> + Send,
) -> Result<Vec<Duration>> {
    let (learner, actor) = (wires.join("bench-learner")?, wires.join("bench-actor")?);
    let publisher = WeightsPublisher::new(&learner, flat.len())?;
    let subscriber = WeightsSubscriber::new(&actor)?;
    let (adopted, moments) = channel();
    std::thread::scope(|scope| {
        let reader = scope.spawn(move || -> Result<()> {
            for version in 0..count as u64 {
                let (woken, weights) = next(&subscriber)?;
                ensure!(weights.header().version == version, "weights were skipped");
                let moment = adopt(woken, weights.flat())?;
                adopted.send(moment).context("the writer has ended")?;
            }
            Ok(())
        });
        let mut spans = Vec::with_capacity(count);
        for version in 0..count as u64 {
            // Lets the reader fall asleep; unequal, so as not to keep step with the system's clock.
            std::thread::sleep(Duration::from_micros(100 + version % 7 * 30));
            let header = WeightsHeader::new(
                version,
                WeightsOrder::Collect,
                &HIDDEN,
                CLIP,
                mebibyte(),
                true,
            );
            let sent = Instant::now();
            publisher.broadcast(header, flat)?;
            let Ok(moment) = moments.recv_timeout(DEADLINE) else {
                break;
            };
            spans.push(moment.saturating_duration_since(sent));
        }
        reader.join().expect("the reader does not panic")?;
        spans.sort_unstable();
        Ok(spans)
    })
}

/// Sleeps until weights are there.
fn next(subscriber: &WeightsSubscriber) -> Result<(Instant, Weights)> {
    loop {
        if subscriber.wait(DEADLINE)? == Wake::Timeout {
            bail!("no weights within {DEADLINE:?}");
        }
        let woken = Instant::now();
        // A writer that comes wakes as well and brings nothing.
        if let Some(weights) = subscriber.newest()? {
            return Ok((woken, weights));
        }
    }
}

/// 10⁹ bytes per second of messages that are written in place, sent, and read in place.
fn throughput(wires: &Wires, count: usize) -> Result<f64> {
    let (actor, learner) = (wires.join("bench-actor")?, wires.join("bench-learner")?);
    let subscriber = RolloutSubscriber::new(&learner, Lists::default())?;
    let mut publisher = RolloutPublisher::new(&actor, 0, mebibyte(), DEADLINE)?;
    // Connects, so that a full buffer holds the writer up from the first message on.
    ensure!(
        subscriber.receive()?.is_none(),
        "a message before the first"
    );
    std::thread::scope(|scope| {
        let reader = scope.spawn(move || -> Result<()> {
            let mut received = 0;
            while received < count {
                let Some(rollout) = subscriber.receive()? else {
                    if subscriber.wait(DEADLINE)? == Wake::Timeout {
                        bail!("no message within {DEADLINE:?}");
                    }
                    continue;
                };
                black_box(checksum(rollout.numbers()));
                received += 1;
            }
            Ok(())
        });
        let start = Instant::now();
        for message in 0..count {
            let mut loan = publisher.loan()?;
            loan.numbers_mut().fill(message as f32);
            let outcome = publisher.send(loan, RolloutHeader::default())?;
            if outcome != SendOutcome::Delivered {
                bail!("message {message}: {outcome:?}");
            }
        }
        reader.join().expect("the reader does not panic")?;
        let bytes = count * mebibyte().len() * size_of::<f32>();
        Ok(bytes as f64 / start.elapsed().as_secs_f64() / 1e9)
    })
}

/// Touches every number; on their bits, because sums of floats may not be reordered and would be
/// slower than the memory.
fn checksum(numbers: &[f32]) -> u32 {
    numbers
        .iter()
        .fold(0, |sum: u32, number| sum.wrapping_add(number.to_bits()))
}

fn percentile(sorted: &[Duration], share: f64) -> Duration {
    let index = (sorted.len() as f64 * share) as usize;
    sorted
        .get(index.min(sorted.len().saturating_sub(1)))
        .copied()
        .unwrap_or_default()
}

fn micros(duration: Duration) -> f64 {
    duration.as_nanos() as f64 / 1000.0
}

#[cfg(test)]
mod tests;

//! One end of a stream: open it, then loan and send, or receive and wait.
//!
//! Separate because loans, back-pressure and waiting are the same for each stream. The typed ends are in
//! [`crate::rollout`], [`crate::weights`], [`crate::reward`] and [`crate::directive`].

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU8, Ordering};
use std::time::{Duration, Instant};

use iceoryx2::port::BackpressureAction;
use iceoryx2::port::listener::{Listener, ListenerWaitError};
use iceoryx2::port::notifier::Notifier;
use iceoryx2::port::update_connections::UpdateConnections;
use iceoryx2::port::{LoanError, ReceiveError, SendError};
use iceoryx2::prelude::{AllocationStrategy, BackpressureStrategy};
use iceoryx2::sample::Sample;
use iceoryx2::sample_mut::SampleMut;

use crate::domain::Service;
use crate::error::PortError;
use crate::presence::{Node, TICK, Tend};
use crate::room;
use crate::service::{self, TAKEOVER};
use crate::stream::Stream;

/// Why waiting ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Wake {
    /// A message was sent, or a writer came or went: receive until nothing is left.
    Message,
    /// The time is over.
    Timeout,
    /// This process was asked to stop. Each port says so once; after that it waits as before, for a
    /// process that has something to bring to its end.
    Shutdown,
}

/// What became of a message.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SendOutcome {
    /// A reader has it.
    Delivered,
    /// Nobody reads this stream now: the message is lost.
    Lost,
    /// The reader's buffer stayed full for the whole patience: the message is lost.
    Dropped,
    /// This process was asked to stop while the buffer was full: the message is lost.
    Interrupted,
}

/// A message being written in shared memory.
pub(crate) type Loan<S> = SampleMut<Service, [<S as Stream>::Item], <S as Stream>::Header>;
/// A message being read in shared memory.
pub(crate) type Received<S> = Sample<Service, [<S as Stream>::Item], <S as Stream>::Header>;

type RawPublisher<S> =
    iceoryx2::port::publisher::Publisher<Service, [<S as Stream>::Item], <S as Stream>::Header>;
type RawSubscriber<S> =
    iceoryx2::port::subscriber::Subscriber<Service, [<S as Stream>::Item], <S as Stream>::Header>;

/// Below this a wait only looks: the system counts microseconds and takes none for eternity.
const SHORTEST_WAIT: Duration = Duration::from_micros(10);

const WAITING: u8 = 0;
const OUT_OF_PATIENCE: u8 = 1;
const INTERRUPTED: u8 = 2;

/// Writing end.
#[derive(Debug)]
pub(crate) struct Publisher<S: Stream> {
    raw: Arc<Tended<RawPublisher<S>>>,
    bell: Notifier<Service>,
    node: Node,
    verdict: Arc<AtomicU8>,
}

impl<S: Stream> Publisher<S> {
    /// Opens the stream for messages of exactly `len` items; a send to a full buffer is given up
    /// after `patience`.
    pub(crate) fn open(node: &Node, len: usize, patience: Duration) -> Result<Self, PortError> {
        let (spec, member) = (S::SPEC, node.membership());
        room::require(spec.name, reserved_bytes::<S>(len))?;
        let messages = service::messages::<S>(member)?;
        let events = service::events(member, &spec)?;
        let verdict = Arc::new(AtomicU8::new(WAITING));
        let raw = service::place(member, &spec, "writer", spec.publishers, || {
            // Not the node itself: its thread may be the one that drops this port.
            let (verdict, member) = (Arc::clone(&verdict), Arc::clone(member));
            messages
                .publisher_builder()
                .initial_max_slice_len(len)
                .allocation_strategy(AllocationStrategy::Static)
                .max_loaned_samples(spec.loaned)
                .override_sample_preallocation(move |worst_case| spec.messages().min(worst_case))
                .backpressure_strategy(BackpressureStrategy::RetryUntilDelivered)
                .set_backpressure_handler(move |state| {
                    let end = if member.shutdown().requested() {
                        INTERRUPTED
                    } else if state.elapsed_time >= patience {
                        OUT_OF_PATIENCE
                    } else {
                        // A reader that was killed is still counted until someone cleans up.
                        member.clean_when_due();
                        return BackpressureAction::Retry;
                    };
                    verdict.store(end, Ordering::Relaxed);
                    BackpressureAction::DiscardDataAndFail
                })
                .create()
        })?;
        let segment = format!("_{}.data", raw.id().value());
        room::commit(spec.name, node.domain().prefix(), &segment)?;
        let bell = service::place(member, &spec, "writer", spec.publishers, || {
            events.notifier_builder().create()
        })?;
        let raw = Arc::new(Tended(raw));
        let weak = Arc::downgrade(&raw);
        member.register(weak);
        Ok(Self {
            raw,
            bell,
            node: node.clone(),
            verdict,
        })
    }

    /// Memory for one message of `len` items; its content is whatever was there before.
    pub(crate) fn loan(&self, len: usize) -> Result<Loan<S>, PortError> {
        let deadline = Instant::now() + TAKEOVER;
        loop {
            match self.raw.0.loan_slice_uninit(len) {
                // SAFETY: the items are plain numbers for which every bit pattern is a value, and
                // the memory is a mapped file, which the kernel has filled with zeros.
                Ok(sample) => return Ok(unsafe { sample.assume_init() }),
                // Dead or slow readers hold the other messages; both end.
                Err(LoanError::OutOfMemory) if Instant::now() < deadline => {
                    self.node.tick();
                    std::thread::yield_now();
                }
                Err(error) => return Err(system::<S>("loaning memory", error)),
            }
        }
    }

    /// Sends, then wakes the readers.
    pub(crate) fn send(&self, loan: Loan<S>) -> Result<SendOutcome, PortError> {
        self.verdict.store(WAITING, Ordering::Relaxed);
        let sent = loan.send();
        self.ring();
        match sent {
            Ok(0) => Ok(SendOutcome::Lost),
            Ok(_) => Ok(SendOutcome::Delivered),
            Err(SendError::UnableToDeliver) => Ok(match self.verdict.load(Ordering::Relaxed) {
                INTERRUPTED => SendOutcome::Interrupted,
                _ => SendOutcome::Dropped,
            }),
            // A reader came or went in this moment; the next message finds it settled.
            Err(SendError::ConnectionError(error)) => {
                tracing::warn!(stream = S::SPEC.name, ?error, "message lost");
                Ok(SendOutcome::Lost)
            }
            // A signal came while it waited for room, mostly the one to stop; the middleware tells it
            // from nothing worse.
            Err(SendError::InternalError) => Ok(SendOutcome::Interrupted),
            Err(error) => Err(system::<S>("sending", error)),
        }
    }

    /// Wakes everyone who waits on this stream.
    fn ring(&self) {
        // Fails when a listener died just now or has not emptied its queue: it is awake then.
        if let Err(error) = self.bell.notify() {
            tracing::debug!(stream = S::SPEC.name, ?error, "waking readers");
        }
    }
}

/// Reading end.
#[derive(Debug)]
pub(crate) struct Subscriber<S: Stream> {
    raw: Arc<Tended<RawSubscriber<S>>>,
    ear: Listener<Service>,
    node: Node,
    /// The request to stop has been passed on.
    told: AtomicBool,
}

impl<S: Stream> Subscriber<S> {
    /// Opens the stream.
    pub(crate) fn open(node: &Node) -> Result<Self, PortError> {
        let (spec, member) = (S::SPEC, node.membership());
        room::require(spec.name, 0)?;
        let messages = service::messages::<S>(member)?;
        let events = service::events(member, &spec)?;
        // The ear first: a message that arrives in between is then heard as well as received.
        let ear = service::place(member, &spec, "reader", spec.subscribers, || {
            events.listener_builder().create()
        })?;
        let raw = service::place(member, &spec, "reader", spec.subscribers, || {
            messages.subscriber_builder().create()
        })?;
        let raw = Arc::new(Tended(raw));
        let weak = Arc::downgrade(&raw);
        member.register(weak);
        Ok(Self {
            raw,
            ear,
            node: node.clone(),
            told: AtomicBool::new(false),
        })
    }

    /// The next message, if there is one.
    pub(crate) fn receive(&self) -> Result<Option<Received<S>>, PortError> {
        let mut refused = None;
        // A writer that died while connecting fails once and is then forgotten.
        for _ in 0..3 {
            match self.raw.0.receive() {
                Ok(sample) => return Ok(sample),
                Err(error @ ReceiveError::ConnectionFailure(_)) => {
                    self.node.membership().clean();
                    refused = Some(error);
                }
                Err(error) => return Err(system::<S>("receiving", error)),
            }
        }
        tracing::warn!(stream = S::SPEC.name, error = ?refused, "a writer cannot be reached");
        Ok(None)
    }

    /// The newest message of those waiting, if there is one.
    pub(crate) fn newest(&self) -> Result<Option<Received<S>>, PortError> {
        let mut newest = None;
        while let Some(sample) = self.receive()? {
            newest = Some(sample);
        }
        Ok(newest)
    }

    /// Whether this process was asked to stop.
    pub(crate) fn is_stopping(&self) -> bool {
        self.node.shutdown().requested()
    }

    /// Sleeps until something was sent, the time is over, or this process should stop; ticks.
    pub(crate) fn wait(&self, timeout: Duration) -> Result<Wake, PortError> {
        let deadline = Instant::now() + timeout;
        loop {
            // Said once: a process that still brings something to its end waits on as before.
            if self.node.shutdown().requested() && !self.told.swap(true, Ordering::Relaxed) {
                return Ok(Wake::Shutdown);
            }
            self.node.tick();
            let mut woken = false;
            let slice = deadline.saturating_duration_since(Instant::now()).min(TICK);
            let heard = if slice < SHORTEST_WAIT {
                self.ear.try_wait(|_| woken = true)
            } else {
                self.ear.timed_wait(|_| woken = true, slice)
            };
            match heard {
                Ok(_) | Err(ListenerWaitError::InterruptSignal) => {}
                Err(error) => return Err(system::<S>("waiting", error)),
            }
            if woken {
                return Ok(Wake::Message);
            }
            if Instant::now() >= deadline {
                return Ok(Wake::Timeout);
            }
        }
    }
}

/// A port that connects to new peers on every tick of its node.
#[derive(Debug)]
struct Tended<P>(P);

impl<P: UpdateConnections + Send + Sync> Tend for Tended<P> {
    fn tend(&self) {
        if let Err(error) = self.0.update_connections() {
            tracing::debug!(?error, "connecting to new peers");
        }
    }
}

/// Bytes of shared memory that one writer of messages of `len` items reserves.
pub(crate) fn reserved_bytes<S: Stream>(len: usize) -> u64 {
    // iceoryx2's own header, ours, and the rounding of each message and of the whole segment.
    const OVERHEAD: usize = 256;
    let message = len * size_of::<S::Item>() + size_of::<S::Header>() + OVERHEAD;
    (S::SPEC.messages() * message) as u64 + 64 * 1024
}

fn system<S: Stream>(action: &'static str, error: impl std::fmt::Debug) -> PortError {
    PortError::System {
        stream: S::SPEC.name,
        action,
        cause: format!("{error:?}"),
    }
}

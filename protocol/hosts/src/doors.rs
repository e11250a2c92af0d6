//! Letting hosts in: connections, their passes, and what a stranger may cost.

use std::collections::HashMap;
use std::future::Future;
use std::io;
use std::net::{IpAddr, SocketAddr};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

use hyper::server::conn::http2;
use hyper::service::service_fn;
use hyper_util::rt::{TokioExecutor, TokioIo, TokioTimer};
use rustls::{CertificateError, ServerConfig};
use tokio::net::{TcpListener, TcpStream};
use tokio::sync::Semaphore;
use tokio::time::{sleep, timeout};
use tokio_rustls::TlsAcceptor;
use tracing::{info, warn};

use crate::desk::{Desk, answer};

/// A connection whose bytes nobody confirms for so long is given up, ms.
pub(crate) const UNCONFIRMED_MS: u32 = 4_000;
/// Bytes of one message that may be on their way before they are taken.
pub(crate) const STREAM_WINDOW: u32 = 16 << 20;
/// Bytes of one connection that may be on their way before they are taken.
pub(crate) const CONNECTION_WINDOW: u32 = 32 << 20;
/// Bytes of a frame.
pub(crate) const FRAME: u32 = 1 << 20;
/// A ping asks for its answer after all that was sent before it: at 4 Mbit/s a full window takes 64 s.
pub(crate) const PING_PATIENCE: Duration = Duration::from_secs(120);
/// Between two lines about strangers.
const SILENCE: Duration = Duration::from_secs(10);

/// What peers may cost.
#[derive(Clone, Copy, Debug)]
pub struct Limits {
    /// Connections of hosts at a time.
    pub hosts: usize,
    /// Connections at a time that have not shown a pass yet.
    pub strangers: usize,
    /// Of those the most from one address.
    pub strangers_of_one: usize,
    /// How long showing a pass may take.
    pub greeting: Duration,
    /// How long a call may take, its message's arrival included.
    pub call: Duration,
    /// Most bytes of a message.
    pub message: usize,
    /// Calls of a connection at a time.
    pub calls: u32,
}

impl Limits {
    /// For rollouts of at most `rollout` bytes.
    pub fn of(rollout: usize) -> Self {
        Self {
            hosts: 128,
            strangers: 64,
            strangers_of_one: 16,
            greeting: Duration::from_secs(5),
            call: Duration::from_secs(120),
            message: rollout + crate::desk::SLACK,
            calls: 2 * protocol::MAX_ACTORS as u32,
        }
    }
}

/// Where hosts come in.
pub struct Doors<D> {
    listener: TcpListener,
    tls: TlsAcceptor,
    desk: Arc<D>,
    limits: Limits,
    strangers: Arc<Semaphore>,
    hosts: Arc<Semaphore>,
    of_one: Arc<Mutex<HashMap<IpAddr, usize>>>,
    refused: Arc<Mutex<Refused>>,
}

impl<D> std::fmt::Debug for Doors<D> {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let mut doors = formatter.debug_struct("Doors");
        doors.field("limits", &self.limits).finish_non_exhaustive()
    }
}

/// Peers that were turned away, so that a thousand of them do not fill a log.
#[derive(Debug, Default)]
struct Refused {
    count: u64,
    silent: u64,
    said: Option<Instant>,
}

impl<D: Desk> Doors<D> {
    /// Doors on a bound socket.
    pub fn new(
        listener: TcpListener,
        tls: Arc<ServerConfig>,
        desk: Arc<D>,
        limits: Limits,
    ) -> Self {
        Self {
            listener,
            tls: TlsAcceptor::from(tls),
            desk,
            limits,
            strangers: Arc::new(Semaphore::new(limits.strangers)),
            hosts: Arc::new(Semaphore::new(limits.hosts)),
            of_one: Arc::default(),
            refused: Arc::default(),
        }
    }

    /// Lets hosts in until `end` comes.
    pub async fn open(&self, end: impl Future<Output = ()>) {
        let mut end = std::pin::pin!(end);
        loop {
            let accepted = tokio::select! {
                () = &mut end => return,
                accepted = self.listener.accept() => accepted,
            };
            match accepted {
                Ok((stream, from)) => self.greet(stream, from),
                // Out of descriptors, mostly: those that are open end some time.
                Err(error) => {
                    warn!(%error, "taking a connection");
                    sleep(Duration::from_millis(100)).await;
                }
            }
        }
    }

    /// How many peers were turned away.
    pub fn refused(&self) -> u64 {
        lock(&self.refused).count
    }

    fn greet(&self, stream: TcpStream, from: SocketAddr) {
        let Ok(stranger) = Arc::clone(&self.strangers).try_acquire_owned() else {
            return refuse(&self.refused, from, "too many strangers are at the door");
        };
        let Some(place) = Place::of(&self.of_one, from.ip(), self.limits.strangers_of_one) else {
            return refuse(&self.refused, from, "too many strangers of its address");
        };
        let (tls, desk, limits) = (self.tls.clone(), Arc::clone(&self.desk), self.limits);
        let (hosts, refused) = (Arc::clone(&self.hosts), Arc::clone(&self.refused));
        tokio::spawn(async move {
            let greeted = async {
                settle(&stream)?;
                tls.accept(stream).await
            };
            let stream = match timeout(limits.greeting, greeted).await {
                Ok(Ok(stream)) => stream,
                Ok(Err(error)) => return refuse(&refused, from, &reason(&error)),
                Err(_) => return refuse(&refused, from, "it showed no pass in time"),
            };
            drop((stranger, place));
            let Ok(_seat) = hosts.try_acquire() else {
                return refuse(&refused, from, "too many hosts are here");
            };
            info!(%from, "a host is connected");
            let service = service_fn(move |request| {
                answer(
                    Arc::clone(&desk),
                    from,
                    request,
                    limits.message,
                    limits.call,
                )
            });
            let ended = http2::Builder::new(TokioExecutor::new())
                .timer(TokioTimer::new())
                .initial_stream_window_size(STREAM_WINDOW)
                .initial_connection_window_size(CONNECTION_WINDOW)
                .max_frame_size(FRAME)
                .max_concurrent_streams(limits.calls)
                .max_header_list_size(16 << 10)
                .keep_alive_interval(Duration::from_secs(5))
                .keep_alive_timeout(PING_PATIENCE)
                .serve_connection(TokioIo::new(stream), service)
                .await;
            match ended {
                Ok(()) => info!(%from, "a host's connection ended"),
                Err(error) => info!(%from, %error, "a host's connection broke"),
            }
        });
    }
}

/// How both ends want lost packets to be taken: not as a sign to slow down by half. Over 20 ms with 1 % loss the kernel's
/// usual way, cubic, fills a tenth of a line that this one fills.
const CONGESTION: &str = "bbr";

/// What both ends want of a connection.
pub(crate) fn settle(stream: &TcpStream) -> io::Result<()> {
    stream.set_nodelay(true)?;
    // A kernel may not have it, or not let everyone have it (net.ipv4.tcp_allowed_congestion_control): then as usual.
    let _ = rustix::net::sockopt::set_tcp_congestion(stream, CONGESTION);
    Ok(rustix::net::sockopt::set_tcp_user_timeout(
        stream,
        UNCONFIRMED_MS,
    )?)
}

/// A stranger's place among those of its address, given back when dropped.
struct Place(Arc<Mutex<HashMap<IpAddr, usize>>>, IpAddr);

impl Place {
    fn of(places: &Arc<Mutex<HashMap<IpAddr, usize>>>, ip: IpAddr, most: usize) -> Option<Self> {
        let mut taken = lock(places);
        let count = taken.entry(ip).or_insert(0);
        if *count >= most {
            return None;
        }
        *count += 1;
        Some(Self(Arc::clone(places), ip))
    }
}

impl Drop for Place {
    fn drop(&mut self) {
        let mut taken = lock(&self.0);
        if let Some(count) = taken.get_mut(&self.1) {
            *count -= 1;
            if *count == 0 {
                taken.remove(&self.1);
            }
        }
    }
}

fn refuse(refused: &Mutex<Refused>, from: SocketAddr, reason: &str) {
    let mut refused = lock(refused);
    refused.count += 1;
    if refused.said.is_some_and(|said| said.elapsed() < SILENCE) {
        refused.silent += 1;
        return;
    }
    refused.said = Some(Instant::now());
    let others = std::mem::take(&mut refused.silent);
    warn!(%from, others, "turned away: {reason}");
}

/// Why TLS failed, in words.
pub(crate) fn reason(error: &io::Error) -> String {
    let inner = error.get_ref().and_then(|inner| inner.downcast_ref());
    match inner {
        Some(rustls::Error::NoCertificatesPresented) => "it showed no pass".to_owned(),
        Some(rustls::Error::InvalidCertificate(
            CertificateError::UnknownIssuer | CertificateError::BadSignature,
        )) => "its pass is another run's".to_owned(),
        Some(rustls::Error::InvalidMessage(_)) => "it does not speak TLS".to_owned(),
        Some(rustls::Error::AlertReceived(alert)) => format!("it refused: {alert:?}"),
        _ => error.to_string(),
    }
}

fn lock<T>(mutex: &Mutex<T>) -> std::sync::MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

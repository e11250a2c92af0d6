//! A host's line to the gate: one connection, made again whenever it breaks.

use std::error::Error;
use std::io;
use std::pin::Pin;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::task::{Context, Poll};
use std::time::Duration;

use http::uri::{PathAndQuery, Uri};
use hyper::body::Incoming;
use hyper::client::conn::http2::{self, SendRequest};
use hyper_util::rt::{TokioExecutor, TokioIo, TokioTimer};
use prost::Message;
use rustls::ClientConfig;
use rustls::pki_types::ServerName;
use tokio::net::TcpStream;
use tokio::time::timeout;
use tokio_rustls::TlsConnector;
use tonic::body::Body;
use tonic::client::Grpc;
use tonic::{Code, Request, Status};
use tonic_prost::ProstCodec;
use tower_service::Service;
use tracing::info;

use crate::desk::SERVICE;
use crate::doors::{CONNECTION_WINDOW, FRAME, PING_PATIENCE, STREAM_WINDOW, reason, settle};
use crate::messages::{Join, Joined};
use crate::passes::GATE;

/// Longest that reaching the gate's machine may take.
const REACHING: Duration = Duration::from_secs(2);
/// Longest that the two may take to know each other.
const GREETING: Duration = Duration::from_secs(5);
/// Longest that joining may take.
const JOINING: Duration = Duration::from_secs(30);
/// Between two pings of a connection, so that one that is cut is noticed also while nothing is said.
const PINGS: Duration = Duration::from_secs(2);

/// Why a call came to nothing.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum CallError {
    /// The gate cannot be reached, or not now: call again.
    #[error("{0}")]
    Away(String),
    /// The gate has refused, and would again.
    #[error("{0}")]
    Refused(String),
}

/// What went over a line.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct LineFigures {
    /// Connections beyond the first.
    pub reconnects: u64,
    /// Bytes of messages sent.
    pub sent: u64,
    /// Bytes of messages received.
    pub received: u64,
}

/// A line to the gate at an address.
pub struct Line {
    address: String,
    tls: TlsConnector,
    hello: Mutex<Join>,
    live: tokio::sync::Mutex<Option<Live>>,
    made: AtomicU64,
    sent: AtomicU64,
    received: AtomicU64,
}

impl std::fmt::Debug for Line {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let mut line = formatter.debug_struct("Line");
        line.field("address", &self.address)
            .field("figures", &self.figures())
            .finish_non_exhaustive()
    }
}

/// A connection, and what the gate said when it was made.
#[derive(Clone)]
struct Live {
    channel: Channel,
    number: u64,
    joined: Arc<Joined>,
    broke: Broke,
}

/// Why a connection broke, once it has.
type Broke = Arc<Mutex<Option<CallError>>>;

impl Line {
    /// A line to `address`, HOST:PORT; nothing is said yet. Every connection begins with `hello`.
    pub fn new(address: &str, tls: Arc<ClientConfig>, hello: Join) -> Self {
        Self {
            address: address.to_owned(),
            tls: TlsConnector::from(tls),
            hello: Mutex::new(hello),
            live: tokio::sync::Mutex::default(),
            made: AtomicU64::new(0),
            sent: AtomicU64::new(0),
            received: AtomicU64::new(0),
        }
    }

    /// What went over it so far.
    pub fn figures(&self) -> LineFigures {
        LineFigures {
            reconnects: self.made.load(Ordering::Relaxed).saturating_sub(1),
            sent: self.sent.load(Ordering::Relaxed),
            received: self.received.load(Ordering::Relaxed),
        }
    }

    /// What the gate says to those who join; connects if need be.
    ///
    /// # Errors
    /// A gate that is away, or refuses.
    pub async fn joined(&self) -> Result<Arc<Joined>, CallError> {
        Ok(self.live().await?.joined)
    }

    /// Calls `name` with a message and waits for the answer, for `time` at most.
    ///
    /// # Errors
    /// [`CallError::Away`] where it may be called again: the gate then may have had the message or not.
    pub async fn call<M, R>(&self, name: &str, message: M, time: Duration) -> Result<R, CallError>
    where
        M: Message + Default + Send + Sync + 'static,
        R: Message + Default + Send + Sync + 'static,
    {
        let live = self.live().await?;
        self.sent
            .fetch_add(message.encoded_len() as u64, Ordering::Relaxed);
        let called = timeout(time, call(live.channel, name, message)).await;
        let error = match called {
            Ok(Ok(answer)) => {
                let answer: R = answer;
                self.received
                    .fetch_add(answer.encoded_len() as u64, Ordering::Relaxed);
                return Ok(answer);
            }
            Ok(Err(status)) => match said(&status) {
                // It was the gate that said so: the connection is as good as before.
                Some(error) => return Err(error),
                None => broken(&live.broke, &status).await,
            },
            Err(_) => CallError::Away(format!("no answer within {} s", time.as_secs())),
        };
        let mut now = self.live.lock().await;
        if now.as_ref().is_some_and(|now| now.number == live.number) {
            info!(reason = %error, "the connection broke");
            *now = None;
        }
        Err(error)
    }

    async fn live(&self) -> Result<Live, CallError> {
        let mut live = self.live.lock().await;
        if let Some(live) = live.as_ref()
            && !live.channel.0.is_closed()
        {
            return Ok(live.clone());
        }
        let made = self.connect().await?;
        *live = Some(made.clone());
        Ok(made)
    }

    async fn connect(&self) -> Result<Live, CallError> {
        let away = |error: io::Error| CallError::Away(format!("{}: {error}", self.address));
        let late = || io::Error::from(io::ErrorKind::TimedOut);
        let stream = timeout(REACHING, TcpStream::connect(&self.address))
            .await
            .unwrap_or_else(|_| Err(late()))
            .map_err(away)?;
        settle(&stream).map_err(away)?;
        let congestion = rustix::net::sockopt::tcp_congestion(&stream).unwrap_or_default();
        let name = ServerName::try_from(GATE).expect("a constant name");
        let stream = timeout(GREETING, self.tls.connect(name, stream))
            .await
            .unwrap_or_else(|_| Err(late()))
            .map_err(|error| tls_failed(&error).unwrap_or_else(|| away(error)))?;
        let (sender, connection) = http2::Builder::new(TokioExecutor::new())
            .timer(TokioTimer::new())
            .initial_stream_window_size(STREAM_WINDOW)
            .initial_connection_window_size(CONNECTION_WINDOW)
            .max_frame_size(FRAME)
            .max_send_buf_size(FRAME as usize)
            .keep_alive_interval(PINGS)
            .keep_alive_timeout(PING_PATIENCE)
            .keep_alive_while_idle(true)
            .handshake(TokioIo::new(stream))
            .await
            .map_err(|error| CallError::Away(error.to_string()))?;
        let broke = Broke::default();
        let note = Arc::clone(&broke);
        tokio::spawn(async move {
            let Err(error) = connection.await else {
                return;
            };
            let cause = error.source().and_then(|cause| cause.downcast_ref());
            let words = CallError::Away(error.to_string());
            let failed = cause.and_then(tls_failed).unwrap_or(words);
            *note.lock().unwrap_or_else(PoisonError::into_inner) = Some(failed);
        });
        let channel = Channel(sender);
        let hello = self
            .hello
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
            .clone();
        let joined = match timeout(JOINING, call(channel.clone(), "Join", hello)).await {
            Ok(Ok(joined)) => joined,
            Ok(Err(status)) => {
                return Err(match said(&status) {
                    Some(error) => error,
                    None => broken(&broke, &status).await,
                });
            }
            Err(_) => return Err(away(late())),
        };
        let number = self.made.fetch_add(1, Ordering::Relaxed);
        info!(address = self.address, number, congestion, "connected");
        Ok(Live {
            channel,
            number,
            joined: Arc::new(joined),
            broke,
        })
    }
}

/// What the gate itself said; none where the connection failed.
fn said(status: &Status) -> Option<CallError> {
    let words = || status.message().to_owned();
    match status.code() {
        // The last two are of messages that are too long or cannot be read.
        Code::FailedPrecondition
        | Code::InvalidArgument
        | Code::Unimplemented
        | Code::OutOfRange
        | Code::ResourceExhausted => Some(CallError::Refused(words())),
        // tonic's own words for a connection that failed have a source; the gate's have none.
        Code::Unavailable | Code::DeadlineExceeded if status.source().is_none() => {
            Some(CallError::Away(words()))
        }
        _ => None,
    }
}

/// Why a call failed whose connection did: what ended the connection, which may be known a moment later.
async fn broken(broke: &Broke, status: &Status) -> CallError {
    for _ in 0..10 {
        let known = broke.lock().unwrap_or_else(PoisonError::into_inner).clone();
        if let Some(error) = known {
            return error;
        }
        tokio::time::sleep(Duration::from_millis(10)).await;
    }
    CallError::Away(status.message().to_owned())
}

/// What a failure of TLS means, if it will not go away.
fn tls_failed(error: &io::Error) -> Option<CallError> {
    let inner = error.get_ref()?.downcast_ref()?;
    let words = match inner {
        rustls::Error::InvalidCertificate(_) => {
            "the gate there is another run's: this join file is not for it"
        }
        rustls::Error::AlertReceived(
            rustls::AlertDescription::UnknownCA
            | rustls::AlertDescription::DecryptError
            | rustls::AlertDescription::BadCertificate
            | rustls::AlertDescription::CertificateUnknown
            | rustls::AlertDescription::CertificateRequired,
        ) => "the gate does not know this join file: it is another run's",
        rustls::Error::InvalidMessage(_) => "what answers there does not speak TLS",
        _ => return None,
    };
    Some(CallError::Refused(format!("{words} ({})", reason(error))))
}

async fn call<M, R>(channel: Channel, name: &str, message: M) -> Result<R, Status>
where
    M: Message + Default + Send + Sync + 'static,
    R: Message + Default + Send + Sync + 'static,
{
    let origin = Uri::from_static("https://gate.ampco");
    let mut grpc = Grpc::with_origin(channel, origin)
        .max_decoding_message_size(usize::MAX)
        .max_encoding_message_size(usize::MAX);
    grpc.ready()
        .await
        .map_err(|error| Status::from_error(error.into()))?;
    let path = PathAndQuery::try_from(format!("{SERVICE}{name}")).expect("a plain name");
    let codec = ProstCodec::<M, R>::default();
    let answer = grpc.unary(Request::new(message), path, codec).await?;
    Ok(answer.into_inner())
}

/// The connection as tonic asks for it.
#[derive(Clone)]
struct Channel(SendRequest<Body>);

impl Service<http::Request<Body>> for Channel {
    type Response = http::Response<Incoming>;
    type Error = hyper::Error;
    type Future = Pin<Box<dyn Future<Output = Result<Self::Response, Self::Error>> + Send>>;

    fn poll_ready(&mut self, context: &mut Context<'_>) -> Poll<Result<(), hyper::Error>> {
        self.0.poll_ready(context)
    }

    fn call(&mut self, request: http::Request<Body>) -> Self::Future {
        Box::pin(self.0.send_request(request))
    }
}

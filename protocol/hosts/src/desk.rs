//! What answers the calls of hosts, and how a call finds it.

use std::convert::Infallible;
use std::future::Future;
use std::net::SocketAddr;
use std::pin::Pin;
use std::sync::Arc;
use std::task::{Context, Poll};
use std::time::Duration;

use hyper::body::Incoming;
use prost::Message;
use tonic::body::Body;
use tonic::server::Grpc;
use tonic::{Request, Response, Status};
use tonic_prost::ProstCodec;
use tower_service::Service;

use crate::messages::{
    Attached, Delivered, Delivery, Join, Joined, Leave, Newest, Piece, PieceWanted, Robots,
    RobotsWanted, Wanted,
};

/// Beginning of the path of every call.
pub(crate) const SERVICE: &str = "/ampco.Hosts/";

/// Bytes that a message may have beside the rows of a rollout or a piece of a file.
pub(crate) const SLACK: usize = 64 << 10;

/// Why a call is answered with no.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Said {
    /// It would be refused again: who called should end.
    Refused(String),
    /// Not now: who called should wait a moment.
    Later(String),
    /// Whoever called is not known here, or no longer: it should connect and join again.
    Unknown(String),
}

/// What a call comes to.
pub type Answer<T> = Result<T, Said>;

impl From<Said> for Status {
    fn from(said: Said) -> Self {
        match said {
            Said::Refused(words) => Self::failed_precondition(words),
            Said::Later(words) => Self::unavailable(words),
            Said::Unknown(words) => Self::unauthenticated(words),
        }
    }
}

/// Who answers. Each call may come twice, also while the first is being answered.
pub trait Desk: Send + Sync + 'static {
    /// Takes a host in, and says what it needs to know. Versions were compared.
    fn join(
        self: Arc<Self>,
        from: SocketAddr,
        join: Join,
    ) -> impl Future<Output = Answer<Joined>> + Send;
    /// A piece of a motion file.
    fn motion(self: Arc<Self>, wanted: PieceWanted) -> impl Future<Output = Answer<Piece>> + Send;
    /// Weights other than the host has, or after some seconds none.
    fn newest(self: Arc<Self>, wanted: Wanted) -> impl Future<Output = Answer<Newest>> + Send;
    /// Passes a rollout on.
    fn deliver(
        self: Arc<Self>,
        delivery: Delivery,
    ) -> impl Future<Output = Answer<Delivered>> + Send;
    /// Adds an actor's robots to a checkpoint.
    fn attach(self: Arc<Self>, robots: Robots) -> impl Future<Output = Answer<Attached>> + Send;
    /// An actor's robots of a checkpoint.
    fn fetch(self: Arc<Self>, wanted: RobotsWanted) -> impl Future<Output = Answer<Piece>> + Send;
    /// Lets actors go.
    fn leave(self: Arc<Self>, leave: Leave) -> impl Future<Output = Answer<Leave>> + Send;
}

/// Answers one request of a peer at `from`, none longer than `most` bytes, within `time`.
pub(crate) async fn answer<D: Desk>(
    desk: Arc<D>,
    from: SocketAddr,
    request: http::Request<Incoming>,
    most: usize,
    time: Duration,
) -> Result<http::Response<Body>, Infallible> {
    let name = request
        .uri()
        .path()
        .strip_prefix(SERVICE)
        .map(str::to_owned);
    let piece = crate::PIECE + SLACK;
    let answered = async {
        match name.as_deref() {
            Some("Join") => {
                unary(request, SLACK, |join: Join| async move {
                    same_version(&join)?;
                    desk.join(from, join).await
                })
                .await
            }
            Some("Motion") => unary(request, SLACK, |m| async move { desk.motion(m).await }).await,
            Some("Newest") => unary(request, SLACK, |m| async move { desk.newest(m).await }).await,
            Some("Deliver") => unary(request, most, |m| async move { desk.deliver(m).await }).await,
            Some("Attach") => unary(request, piece, |m| async move { desk.attach(m).await }).await,
            Some("Fetch") => unary(request, SLACK, |m| async move { desk.fetch(m).await }).await,
            Some("Leave") => unary(request, SLACK, |m| async move { desk.leave(m).await }).await,
            _ => Status::unimplemented("no such call").into_http(),
        }
    };
    let answered = tokio::time::timeout(time, answered).await;
    Ok(answered.unwrap_or_else(|_| {
        Status::deadline_exceeded("the message took too long to arrive").into_http()
    }))
}

/// Whether a host speaks as we do.
fn same_version(join: &Join) -> Answer<()> {
    let ours = (
        crate::VERSION,
        protocol::PROTOCOL_VERSION,
        env!("CARGO_PKG_VERSION"),
    );
    let theirs = (join.version, join.protocol, join.programs.as_str());
    if ours == theirs {
        return Ok(());
    }
    let said = |(hosts, processes, programs): (u32, u32, &str)| {
        format!("version {programs} (hosts {hosts}, processes {processes})")
    };
    Err(Said::Refused(format!(
        "{} joins with {}, this run speaks {}: build the same sources on both machines",
        join.host,
        said(theirs),
        said(ours)
    )))
}

async fn unary<M, R, F, A>(
    request: http::Request<Incoming>,
    most: usize,
    call: F,
) -> http::Response<Body>
where
    M: Message + Default + Send + Sync + 'static,
    R: Message + Default + Send + Sync + 'static,
    F: FnOnce(M) -> A + Send,
    A: Future<Output = Answer<R>> + Send,
{
    let codec = ProstCodec::<R, M>::default();
    let mut grpc = Grpc::new(codec)
        .max_decoding_message_size(most)
        .max_encoding_message_size(usize::MAX);
    grpc.unary(Once(Some(call), std::marker::PhantomData), request)
        .await
}

/// A function as the service that tonic asks for.
struct Once<F, M>(Option<F>, std::marker::PhantomData<fn(M)>);

impl<M, R, F, A> Service<Request<M>> for Once<F, M>
where
    F: FnOnce(M) -> A,
    A: Future<Output = Answer<R>> + Send,
{
    type Response = Response<R>;
    type Error = Status;
    type Future = Answering<A>;

    fn poll_ready(&mut self, _: &mut Context<'_>) -> Poll<Result<(), Status>> {
        Poll::Ready(Ok(()))
    }

    fn call(&mut self, request: Request<M>) -> Self::Future {
        let call = self.0.take().expect("tonic calls a unary service once");
        Answering(Box::pin(call(request.into_inner())))
    }
}

/// The answer that is being made.
struct Answering<A>(Pin<Box<A>>);

impl<R, A: Future<Output = Answer<R>>> Future for Answering<A> {
    type Output = Result<Response<R>, Status>;

    fn poll(mut self: Pin<&mut Self>, context: &mut Context<'_>) -> Poll<Self::Output> {
        let answer = self.0.as_mut().poll(context);
        answer.map(|answer| answer.map(Response::new).map_err(Status::from))
    }
}

//! A gate that answers with constants, on a port of its own.

use std::net::SocketAddr;
use std::os::fd::AsFd;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, AtomicUsize, Ordering};
use std::time::Duration;

use hosts::{
    Answer, Attached, Delivered, Delivery, Desk, Doors, Join, Joined, Leave, Limits, Line, Newest,
    Pass, Passes, Piece, PieceWanted, Robots, RobotsWanted, Said, Wanted,
};
use tempfile::TempDir;
use tokio::net::TcpListener;

/// Counts what reaches it.
#[derive(Debug, Default)]
pub(crate) struct Counting {
    pub(crate) joined: AtomicUsize,
    pub(crate) rollouts: AtomicUsize,
    pub(crate) bytes: AtomicU64,
}

impl Desk for Counting {
    async fn join(self: Arc<Self>, _: SocketAddr, join: Join) -> Answer<Joined> {
        self.joined.fetch_add(1, Ordering::Relaxed);
        if join.host == "unwanted" {
            return Err(Said::Refused("not you".to_owned()));
        }
        Ok(Joined {
            run: "walk".to_owned(),
            numbers: join.numbers,
            ..Joined::default()
        })
    }

    async fn motion(self: Arc<Self>, _: PieceWanted) -> Answer<Piece> {
        Err(Said::Refused("no such motion file".to_owned()))
    }

    async fn newest(self: Arc<Self>, _: Wanted) -> Answer<Newest> {
        Ok(Newest::default())
    }

    async fn deliver(self: Arc<Self>, delivery: Delivery) -> Answer<Delivered> {
        self.rollouts.fetch_add(1, Ordering::Relaxed);
        let bytes = delivery.rows.len() as u64;
        self.bytes.fetch_add(bytes, Ordering::Relaxed);
        Ok(Delivered { taken: true })
    }

    async fn attach(self: Arc<Self>, robots: Robots) -> Answer<Attached> {
        let so_far = robots.offset + robots.bytes.len() as u64;
        Ok(Attached { so_far })
    }

    async fn fetch(self: Arc<Self>, _: RobotsWanted) -> Answer<Piece> {
        Ok(Piece::default())
    }

    async fn leave(self: Arc<Self>, leave: Leave) -> Answer<Leave> {
        Ok(leave)
    }
}

/// A run that listens.
pub(crate) struct Listening {
    pub(crate) desk: Arc<Counting>,
    pub(crate) doors: Arc<Doors<Counting>>,
    pub(crate) address: String,
    pub(crate) run: TempDir,
}

/// A socket on loopback, and its address; or where a wire is to lie in between, in the namespace `AMPCO_FAR` (a file as
/// `/run/netns/far`), which has the address `AMPCO_FAR_ADDRESS`.
fn listener() -> (TcpListener, String) {
    let bound = match std::env::var_os("AMPCO_FAR") {
        None => std::net::TcpListener::bind("127.0.0.1:0").map(|bound| {
            let address = bound.local_addr().expect("an address").to_string();
            (bound, address)
        }),
        // A thread has a namespace of its own, and a socket keeps that of the thread that made it.
        Some(far) => std::thread::spawn(move || {
            let far = std::fs::File::open(far)?;
            let network = rustix::thread::LinkNameSpaceType::Network;
            rustix::thread::move_into_link_name_space(far.as_fd(), Some(network))?;
            let bound = std::net::TcpListener::bind("0.0.0.0:0")?;
            let host = std::env::var("AMPCO_FAR_ADDRESS").expect("its address");
            let port = bound.local_addr()?.port();
            Ok((bound, format!("{host}:{port}")))
        })
        .join()
        .expect("no panic"),
    };
    let (bound, address) = bound.expect("a port");
    bound.set_nonblocking(true).expect("a socket");
    (TcpListener::from_std(bound).expect("a socket"), address)
}

/// Rollouts of the tests are smaller.
pub(crate) const ROLLOUT: usize = 4 << 20;

impl Listening {
    pub(crate) async fn begin() -> Self {
        let limits = Limits {
            greeting: Duration::from_millis(500),
            ..Limits::of(ROLLOUT)
        };
        let run = tempfile::tempdir().expect("a folder");
        let passes = Passes::of(run.path(), "walk").expect("passes");
        let (listener, address) = listener();
        let desk = Arc::new(Counting::default());
        let tls = passes.server().expect("TLS");
        let doors = Arc::new(Doors::new(listener, tls, Arc::clone(&desk), limits));
        let open = Arc::clone(&doors);
        tokio::spawn(async move { open.open(std::future::pending()).await });
        Self {
            desk,
            doors,
            address,
            run,
        }
    }

    /// A line with the pass of this run.
    pub(crate) fn line(&self, hello: Join) -> Line {
        self.line_with(&self.run, hello)
    }

    /// A line with the pass of some run.
    pub(crate) fn line_with(&self, run: &TempDir, hello: Join) -> Line {
        let pass = Pass::read(&run.path().join("join/walk.join")).expect("a pass");
        Line::new(&self.address, pass.client().expect("TLS"), hello)
    }
}

/// How a host of this version begins.
pub(crate) fn hello() -> Join {
    Join {
        version: hosts::VERSION,
        protocol: protocol::PROTOCOL_VERSION,
        programs: env!("CARGO_PKG_VERSION").to_owned(),
        host: "node".to_owned(),
        life: "life".to_owned(),
        numbers: vec![2, 3],
        ..Join::default()
    }
}

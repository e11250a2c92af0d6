//! Whoever is not of this run costs little, learns why, and disturbs nobody.

use std::sync::Arc;
use std::sync::atomic::Ordering;
use std::time::{Duration, Instant};

use hosts::{CallError, Delivered, Delivery, Passes};
use rustls::pki_types::ServerName;
use tokio::io::{AsyncReadExt, AsyncWriteExt};
use tokio::net::TcpStream;
use tokio::time::{sleep, timeout};
use tokio_rustls::TlsConnector;

use crate::harness::{Listening, ROLLOUT, hello};

const SECOND: Duration = Duration::from_secs(1);

/// A host of the run is served all the same.
async fn serves(gate: &Listening) {
    let line = gate.line(hello());
    let small = Delivery {
        rows: vec![7; 1000].into(),
        ..Delivery::default()
    };
    let until = Instant::now() + 10 * SECOND;
    loop {
        match line.call("Deliver", small.clone(), 5 * SECOND).await {
            Ok(Delivered { taken }) => return assert!(taken),
            // Too many strangers are at the door: they are thrown out after a while.
            Err(CallError::Away(why)) => assert!(Instant::now() < until, "{why}"),
            Err(refused) => panic!("{refused}"),
        }
        sleep(Duration::from_millis(100)).await;
    }
}

/// Waits until so many were turned away.
async fn turned_away(gate: &Listening, count: u64) {
    let until = Instant::now() + 10 * SECOND;
    while gate.doors.refused() < count {
        assert!(
            Instant::now() < until,
            "{} turned away",
            gate.doors.refused()
        );
        sleep(Duration::from_millis(20)).await;
    }
}

#[tokio::test]
async fn another_runs_pass_is_refused_with_the_reason() {
    let gate = Listening::begin().await;
    let other = tempfile::tempdir().unwrap();
    Passes::of(other.path(), "walk").unwrap();
    let refused = gate.line_with(&other, hello()).joined().await.unwrap_err();
    let said = refused.to_string();
    assert!(matches!(refused, CallError::Refused(_)), "{said}");
    assert!(said.contains("another run's"), "{said}");
    assert_eq!(gate.desk.joined.load(Ordering::Relaxed), 0);
    serves(&gate).await;
}

/// The authority of the run alone: the gate is known, and nothing is shown to it.
fn without_pass(gate: &Listening) -> TlsConnector {
    use rustls::pki_types::pem::PemObject;
    let file = gate.run.path().join("join/walk.join");
    let authority = rustls::pki_types::CertificateDer::from_pem_file(file).unwrap();
    let mut roots = rustls::RootCertStore::empty();
    roots.add(authority).unwrap();
    let provider = Arc::new(rustls::crypto::ring::default_provider());
    let config = rustls::ClientConfig::builder_with_provider(provider)
        .with_protocol_versions(&[&rustls::version::TLS13])
        .unwrap()
        .with_root_certificates(roots)
        .with_no_client_auth();
    TlsConnector::from(Arc::new(config))
}

#[tokio::test]
async fn no_pass_is_refused() {
    let gate = Listening::begin().await;
    let stream = TcpStream::connect(&gate.address).await.unwrap();
    let name = ServerName::try_from("gate.ampco").unwrap();
    let mut stream = without_pass(&gate).connect(name, stream).await.unwrap();
    let mut bytes = [0; 16];
    let read = stream.read(&mut bytes).await;
    assert!(read.is_err() || read.unwrap() == 0);
    turned_away(&gate, 1).await;
    serves(&gate).await;
}

#[tokio::test]
async fn a_plain_connection_is_refused_and_a_slow_one_thrown_out() {
    let gate = Listening::begin().await;
    let mut plain = TcpStream::connect(&gate.address).await.unwrap();
    plain
        .write_all(b"PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n")
        .await
        .unwrap();
    turned_away(&gate, 1).await;
    // A byte ten times a second: a greeting that never ends.
    let mut slow = TcpStream::connect(&gate.address).await.unwrap();
    let began = Instant::now();
    while slow.write_all(&[22]).await.is_ok() {
        assert!(began.elapsed() < 10 * SECOND, "never thrown out");
        sleep(Duration::from_millis(100)).await;
    }
    turned_away(&gate, 2).await;
    serves(&gate).await;
}

#[tokio::test]
async fn a_thousand_connections_cost_little_and_a_host_gets_in() {
    // Both ends of all of them are in this process.
    let limit = rustix::process::Rlimit {
        current: Some(4096),
        maximum: Some(4096),
    };
    let _ = rustix::process::setrlimit(rustix::process::Resource::Nofile, limit);
    let gate = Listening::begin().await;
    let here = gate.line(hello());
    here.joined().await.unwrap();
    let mut crowd = Vec::new();
    for _ in 0..1000 {
        // Some are turned away so soon that connecting fails.
        if let Ok(stream) = TcpStream::connect(&gate.address).await {
            crowd.push(stream);
        }
    }
    // Who is here is not disturbed.
    let big = Delivery {
        rows: vec![7; ROLLOUT].into(),
        ..Delivery::default()
    };
    let answer: Delivered = here.call("Deliver", big, 5 * SECOND).await.unwrap();
    assert!(answer.taken);
    serves(&gate).await;
    turned_away(&gate, 900).await;
    drop(crowd);
}

#[tokio::test]
async fn messages_that_are_too_long_are_refused_before_they_are_read() {
    let gate = Listening::begin().await;
    let line = gate.line(hello());
    let huge = Delivery {
        rows: vec![7; 2 * ROLLOUT].into(),
        ..Delivery::default()
    };
    let refused: Result<Delivered, _> = line.call("Deliver", huge, 10 * SECOND).await;
    let refused = refused.unwrap_err();
    assert!(matches!(refused, CallError::Refused(_)), "{refused}");
    assert_eq!(gate.desk.rollouts.load(Ordering::Relaxed), 0);
    serves(&gate).await;
}

/// A connection of HTTP/2 with a pass, for what no line of ours sends.
async fn raw(gate: &Listening) -> hyper::client::conn::http2::SendRequest<Sent> {
    let pass = hosts::Pass::read(&gate.run.path().join("join/walk.join")).unwrap();
    let stream = TcpStream::connect(&gate.address).await.unwrap();
    // Frames are small: nobody is to wait for the confirmation of the one before.
    stream.set_nodelay(true).unwrap();
    let name = ServerName::try_from("gate.ampco").unwrap();
    let tls = TlsConnector::from(pass.client().unwrap());
    let stream = tls.connect(name, stream).await.unwrap();
    let (sender, connection) = hyper::client::conn::http2::handshake(
        hyper_util::rt::TokioExecutor::new(),
        hyper_util::rt::TokioIo::new(stream),
    )
    .await
    .unwrap();
    tokio::spawn(connection);
    sender
}

type Sent = tonic::body::Body;

/// Sends bytes as the body of a call; the status of gRPC that comes back.
async fn call(
    sender: &mut hyper::client::conn::http2::SendRequest<Sent>,
    name: &str,
    bytes: Vec<u8>,
) -> Option<String> {
    let body = Sent::new(Whole(Some(bytes)));
    let request = http::Request::post(format!("https://gate.ampco/ampco.Hosts/{name}"))
        .header("content-type", "application/grpc")
        .body(body)
        .unwrap();
    let sent = timeout(5 * SECOND, sender.send_request(request)).await;
    let answer = sent.expect("an answer in time").ok()?;
    let status = answer.headers().get("grpc-status")?;
    Some(status.to_str().unwrap().to_owned())
}

/// A body of one piece.
struct Whole(Option<Vec<u8>>);

impl hyper::body::Body for Whole {
    type Data = prost::bytes::Bytes;
    type Error = tonic::Status;

    fn poll_frame(
        mut self: std::pin::Pin<&mut Self>,
        _: &mut std::task::Context<'_>,
    ) -> std::task::Poll<Option<Result<hyper::body::Frame<Self::Data>, Self::Error>>> {
        let piece = self
            .0
            .take()
            .map(|bytes| Ok(hyper::body::Frame::data(bytes.into())));
        std::task::Poll::Ready(piece)
    }
}

#[tokio::test]
async fn a_message_that_claims_four_gigabytes_takes_no_memory() {
    let gate = Listening::begin().await;
    let mut sender = raw(&gate).await;
    let before = resident();
    // Not compressed, 4 GiB − 1, and then nothing like it.
    let claim = [&[0, 0xff, 0xff, 0xff, 0xff][..], &[1; 100]].concat();
    for name in ["Deliver", "Join", "Newest", "Attach"] {
        let status = call(&mut sender, name, claim.clone()).await;
        assert_eq!(status.as_deref(), Some("11"), "{name}"); // out of range
    }
    // A length within the message: prost looks before it takes memory.
    let mut inside = vec![0, 0, 0, 0, 6];
    inside.extend([0x6a, 0xff, 0xff, 0xff, 0xff, 0x0f]);
    let status = call(&mut sender, "Deliver", inside).await;
    assert_eq!(status.as_deref(), Some("13")); // cannot be read
    assert!(
        resident() < before + (64 << 20),
        "{before} → {}",
        resident()
    );
    serves(&gate).await;
}

#[tokio::test]
async fn frames_at_random_do_no_harm() {
    let gate = Listening::begin().await;
    let count: usize = std::env::var("AMPCO_FRAMES").map_or(2_000, |n| n.parse().unwrap());
    let mut sender = raw(&gate).await;
    let names = [
        "Join", "Motion", "Newest", "Deliver", "Attach", "Fetch", "Leave", "None",
    ];
    let mut state = 88_172_645_463_325_252_u64;
    let mut random = move || {
        // Marsaglia's xorshift.
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        state
    };
    for turn in 0..count {
        let length = random() as usize % 300;
        let mut bytes = vec![0, 0, 0, (length >> 8) as u8, length as u8];
        bytes.extend((0..length).map(|_| random() as u8));
        // Some are cut, some have a header at random.
        match random() % 4 {
            0 => bytes.truncate(random() as usize % bytes.len()),
            1 => bytes[..5].copy_from_slice(&random().to_le_bytes()[..5]),
            _ => {}
        }
        let name = names[random() as usize % names.len()];
        let answered = call(&mut sender, name, bytes).await;
        if answered.is_none() && !sender.is_ready() {
            sender = raw(&gate).await;
        }
        if turn % 1000 == 0 {
            serves(&gate).await;
        }
    }
    serves(&gate).await;
}

/// Memory of this process, bytes.
fn resident() -> u64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap();
    let line = status.lines().find_map(|line| line.strip_prefix("VmRSS:"));
    let kilobytes = line.and_then(|line| line.split_whitespace().next());
    1024 * kilobytes.unwrap().parse::<u64>().unwrap()
}

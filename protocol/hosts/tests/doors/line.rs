//! Messages arrive, and a line that breaks is made again.

use std::sync::Arc;
use std::sync::atomic::Ordering;
use std::time::{Duration, Instant};

use hosts::{CallError, Delivered, Delivery, Join};

use crate::harness::{Listening, ROLLOUT, hello};

const SECOND: Duration = Duration::from_secs(1);

fn delivery(bytes: usize) -> Delivery {
    Delivery {
        rows: vec![7; bytes].into(),
        ..Delivery::default()
    }
}

/// Seconds of processor time that this process has used.
fn busy() -> f64 {
    let stat = std::fs::read_to_string("/proc/self/stat").unwrap();
    let fields: Vec<&str> = stat
        .rsplit(')')
        .next()
        .unwrap()
        .split_whitespace()
        .collect();
    // User and system time in hundredths of a second, proc_pid_stat(5).
    (fields[11].parse::<f64>().unwrap() + fields[12].parse::<f64>().unwrap()) / 100.0
}

#[tokio::test]
#[expect(clippy::print_stdout, reason = "a figure to be read")]
async fn a_rollout_arrives_and_is_acknowledged() {
    let gate = Listening::begin().await;
    let line = gate.line(hello());
    assert_eq!(line.joined().await.unwrap().numbers, [2, 3]);
    // As many actors at a time, each with one rollout on its way.
    let number = |name: &str, short| std::env::var(name).map_or(short, |n| n.parse().unwrap());
    let (each, actors): (u64, u64) = (number("AMPCO_ROLLOUTS", 3), number("AMPCO_ACTORS", 1));
    let count = each * actors;
    let line = Arc::new(line);
    let (began, before) = (Instant::now(), busy());
    let mut calls = tokio::task::JoinSet::new();
    for _ in 0..actors {
        let line = Arc::clone(&line);
        calls.spawn(async move {
            for _ in 0..each {
                let answer: Result<Delivered, _> =
                    line.call("Deliver", delivery(ROLLOUT), 60 * SECOND).await;
                assert!(answer.unwrap().taken);
            }
        });
    }
    while let Some(sent) = calls.join_next().await {
        sent.unwrap();
    }
    let (seconds, gigabytes) = (
        began.elapsed().as_secs_f64(),
        (count * ROLLOUT as u64) as f64 / 1e9,
    );
    println!(
        "{:.1} MB/s, both ends together {:.2} CPU-s/GB",
        1e3 * gigabytes / seconds,
        (busy() - before) / gigabytes
    );
    assert_eq!(gate.desk.rollouts.load(Ordering::Relaxed), count as usize);
    assert_eq!(
        gate.desk.bytes.load(Ordering::Relaxed),
        count * ROLLOUT as u64
    );
    // One connection for all of it.
    assert_eq!(gate.desk.joined.load(Ordering::Relaxed), 1);
    let figures = line.figures();
    assert_eq!(figures.reconnects, 0);
    assert!(figures.sent >= 3 * ROLLOUT as u64);
}

#[tokio::test]
async fn a_gate_that_is_away_is_told_from_one_that_refuses() {
    let gate = Listening::begin().await;
    let unwanted = Join {
        host: "unwanted".to_owned(),
        ..hello()
    };
    let refused = gate.line(unwanted).joined().await.unwrap_err();
    assert_eq!(refused, CallError::Refused("not you".to_owned()));
    let other = Join {
        protocol: protocol::PROTOCOL_VERSION + 1,
        ..hello()
    };
    let refused = gate.line(other).joined().await.unwrap_err();
    let said = refused.to_string();
    assert!(matches!(refused, CallError::Refused(_)), "{said}");
    assert!(said.contains("build the same sources"), "{said}");
    // Nobody listens there.
    let free = tokio::net::TcpListener::bind("127.0.0.1:0").await.unwrap();
    let address = free.local_addr().unwrap().to_string();
    drop(free);
    let pass = hosts::Pass::read(&gate.run.path().join("join/walk.join")).unwrap();
    let line = hosts::Line::new(&address, pass.client().unwrap(), hello());
    let away = line.joined().await.unwrap_err();
    assert!(matches!(away, CallError::Away(_)), "{away}");
}

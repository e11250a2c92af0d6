//! Messages arrive, and a line that breaks is made again.

use std::sync::atomic::Ordering;
use std::time::Duration;

use hosts::{CallError, Delivered, Delivery, Join};

use crate::harness::{Listening, ROLLOUT, hello};

const SECOND: Duration = Duration::from_secs(1);

fn delivery(bytes: usize) -> Delivery {
    Delivery {
        rows: vec![7; bytes].into(),
        ..Delivery::default()
    }
}

#[tokio::test]
async fn a_rollout_arrives_and_is_acknowledged() {
    let gate = Listening::begin().await;
    let line = gate.line(hello());
    assert_eq!(line.joined().await.unwrap().numbers, [2, 3]);
    for _ in 0..3 {
        let answer: Delivered = line.call("Deliver", delivery(ROLLOUT), 10 * SECOND).await.unwrap();
        assert!(answer.taken);
    }
    assert_eq!(gate.desk.rollouts.load(Ordering::Relaxed), 3);
    assert_eq!(gate.desk.bytes.load(Ordering::Relaxed), 3 * ROLLOUT as u64);
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

//! A host of the run itself that sends what is not of this run's layout.

use std::time::Duration;

use ::hosts::{CallError, Delivered, Delivery, Join, Line, Pass};
use protocol::{Lists, RolloutHeader, RolloutLayout};

use super::Spread;
use crate::harness::{metrics, until, until_iteration};

/// 16 environments of two actors, 8 steps: what the smoke preset asks of each.
const SIZES: (usize, usize) = (8, 8);

fn hello() -> Join {
    Join {
        version: ::hosts::VERSION,
        protocol: protocol::PROTOCOL_VERSION,
        programs: env!("CARGO_PKG_VERSION").to_owned(),
        host: "node".to_owned(),
        life: "life".to_owned(),
        actors: 1,
        ..Join::default()
    }
}

/// A rollout of zeros as such a layout's host would send it.
fn delivery(actor: u32, layout: RolloutLayout) -> Delivery {
    let header = RolloutHeader {
        actor,
        environments: layout.environments as u32,
        steps: layout.steps as u32,
        lists: layout.lists.into(),
        ..RolloutHeader::default()
    };
    let lean = ::hosts::Lean::new(layout, None);
    let rows = lean.strip(&vec![0.0; layout.len()]);
    ::hosts::sent_rollout("life", &header, rows)
}

#[test]
fn rollouts_of_another_layout_are_refused_with_the_reason_and_the_run_goes_on() {
    let spread = Spread::new();
    let mut group = spread.train(
        "spread",
        1,
        &["--actors", "2", "--set", "run.mode=overlapped"],
    );
    let run = spread.runs.run("spread");
    until_iteration(&run, 2);
    let pass = Pass::read(&run.join("join/spread.join")).expect("a pass");
    let tls = pass.client().expect("TLS");
    let line = Line::new(&format!("127.0.0.1:{}", spread.port), tls, hello());
    let (environments, steps) = SIZES;
    let of = |environments, steps| RolloutLayout {
        environments,
        steps,
        lists: Lists::default(),
    };
    let right = |actor| delivery(actor, of(environments, steps));
    let others = |actor| {
        let mut seen = right(actor);
        seen.lists[0] ^= 1;
        let sizes = "configuration says 8 environments by 8 steps";
        [
            (delivery(actor, of(environments + 1, steps)), sizes),
            // As many numbers, and not the same rows.
            (delivery(actor, of(environments / 2, steps * 2)), sizes),
            (seen, "sends other observations"),
        ]
    };
    let runtime = tokio::runtime::Builder::new_current_thread()
        .enable_all()
        .build()
        .expect("a loop");
    runtime.block_on(async {
        let joined = line.joined().await.expect("let in");
        let actor = *joined.numbers.first().expect("an actor");
        let call = async |delivery| -> Result<Delivered, CallError> {
            line.call("Deliver", delivery, Duration::from_secs(20))
                .await
        };
        for (other, reason) in others(actor) {
            let refused = call(other).await;
            let refused = refused.expect_err("another layout");
            let said = refused.to_string();
            assert!(matches!(refused, CallError::Refused(_)), "{said}");
            assert!(said.contains(reason), "{said}");
        }
        // One of this layout gets as far as the learner, which finds it stale.
        let taken = call(right(actor)).await;
        assert_eq!(taken.map(|answer| answer.taken), Ok(true));
    });
    let lines = metrics(&run).len();
    until("iterations after that", || {
        (metrics(&run).len() > lines + 2).then_some(())
    });
    group.signal(rustix::process::Signal::TERM);
    assert!(group.end().success(), "{}", group.stderr.text());
}

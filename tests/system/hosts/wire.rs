//! Two machines as namespaces of the network, with a wire between them that has a rate and is cut.

use std::fs;

use serde_json::Value;

use crate::harness::{Process, Runs, enclosed_alone, has_no_namespaces, length};

/// Makes the far machine, `$far COMMAND` runs there; the near one has 10.9.9.1.
const MACHINES: &str = r#"
mount -t tmpfs tmpfs /run && ip link set lo up && ip netns add far &&
ip link add near type veth peer name wire && ip link set wire netns far &&
ip addr add 10.9.9.1/24 dev near && ip link set near up &&
ip -n far addr add 10.9.9.2/24 dev wire && ip -n far link set wire up && ip -n far link set lo up || exit 9
far="ip netns exec far"
"#;

/// A run there and its actors here: $AMPCO is the program.
const RUN: &str = r#"
$AMPCO train --preset smoke --no-pictures --run spread --runs-dir /tmp/near --actors 2 --set run.iterations=0 \
    --set run.journal=true --set run.mode=overlapped --set run.deadlines.rollout_seconds=5 \
    --listen 10.9.9.1:7000 --here 0 >/tmp/train.txt 2>&1 &
train=$!
until [ -f /tmp/near/spread/join/spread.join ]; do sleep 0.1; done
$far $AMPCO join 10.9.9.1:7000 --file /tmp/near/spread/join/spread.join --actors 2 --runs-dir /tmp/far \
    >/tmp/join.txt 2>&1 &
join=$!
lines() { cat /tmp/near/spread/metrics.jsonl 2>/dev/null | wc -l; }
until [ "$(lines)" -ge 5 ]; do sleep 0.1; done
"#;

/// Ends both in order.
const END: &str = r#"
kill -TERM $train && wait $train && wait $join
"#;

/// Runs a script between two machines; false where namespaces are refused.
fn between(place: &Runs, script: &str) -> bool {
    let script = format!("{MACHINES}{RUN}{script}{END}");
    let mut process = Process::start(enclosed_alone(place.path(), &script));
    let status = process.end_within(std::time::Duration::from_secs(300));
    let said = process.stderr.text();
    if has_no_namespaces(&said) {
        return false;
    }
    let read = |name: &str| fs::read_to_string(place.path().join(name)).unwrap_or_default();
    assert!(
        status.success(),
        "{status}: {said}\n{}\n{}",
        read("train.txt"),
        read("join.txt")
    );
    true
}

fn account(place: &Runs) -> run::journal::Account {
    let mut journals = Vec::new();
    for folder in ["near", "far"] {
        for entry in fs::read_dir(place.path().join(folder))
            .expect("a folder")
            .flatten()
        {
            journals.extend(run::journal::read(&entry.path().join("logs")).expect("journals"));
        }
    }
    run::journal::account::account(&journals)
}

#[test]
fn a_wire_that_is_cut_loses_nothing() {
    let place = Runs::new();
    let seconds = length("AMPCO_CUT", 6.0);
    let script = format!(
        r#"
cut() {{ ip link set near down; sleep $1; ip link set near up; }}
cut {seconds}
since=$(date +%s%N); before=$(lines)
until [ "$(lines)" -gt $((before + 2)) ]; do sleep 0.05; done
echo $((($(date +%s%N) - since) / 1000000)) > /tmp/whole
"#
    );
    if !between(&place, &script) {
        return;
    }
    let account = account(&place);
    assert_eq!(account.uncounted, 0, "{account:?}");
    let whole = fs::read_to_string(place.path().join("whole")).expect("written");
    let milliseconds: u64 = whole.trim().parse().expect("a number");
    assert!(milliseconds < 8_000, "{milliseconds} ms; {account:?}");
}

#[test]
fn a_slow_wire_gets_the_newest_weights() {
    let place = Runs::new();
    let script = r#"
tc qdisc add dev near root tbf rate 4mbit burst 32kbit latency 400ms &&
$far tc qdisc add dev wire root tbf rate 4mbit burst 32kbit latency 400ms || exit 8
before=$(lines)
until [ "$(lines)" -gt $((before + 10)) ]; do sleep 0.1; done
$AMPCO status spread --runs-dir /tmp/near --json > /tmp/status.json
"#;
    if !between(&place, script) {
        return;
    }
    let account = account(&place);
    assert_eq!(account.uncounted, 0, "{account:?}");
    let status = fs::read_to_string(place.path().join("status.json")).expect("written");
    let status: Value = serde_json::from_str(&status).expect("JSON");
    let hosts = status["hosts"]["hosts"].as_array().expect("hosts");
    assert_eq!(hosts.len(), 1, "{status}");
    assert!(hosts[0]["rollouts"].as_u64() > Some(0), "{status}");
    // It was in use all the while: nothing was taken for dead.
    assert_eq!(hosts[0]["reconnects"], 0, "{status}");
}

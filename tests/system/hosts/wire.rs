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

/// The same over a wire in user space, which has a rate, a delay and losses as well: `$WIRE` is its command.
const MACHINES_FAR_APART: &str = r#"
mount -t tmpfs tmpfs /run && ip link set lo up && ip netns add far || exit 9
$WIRE & wire=$!
until ip link show wire >/dev/null 2>&1; do kill -0 $wire || exit 9; sleep 0.05; done
ip link set wire netns far &&
ip addr add 10.9.9.1 peer 10.9.9.2 dev near && ip link set near up &&
ip -n far addr add 10.9.9.2 peer 10.9.9.1 dev wire && ip -n far link set wire up && ip -n far link set lo up || exit 9
far="ip netns exec far"
"#;

/// A run there and its actors here: $AMPCO is the program.
const RUN: &str = r#"
$AMPCO train --preset smoke --no-pictures --run spread --runs-dir /tmp/near --actors 2 --set run.iterations=0 \
    --set run.journal=true --set run.mode=overlapped --set run.deadlines.rollout_seconds=5 $MORE \
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
    run_between(place, &format!("{MACHINES}{RUN}{script}{END}"))
}

fn run_between(place: &Runs, script: &str) -> bool {
    let mut process = Process::start(enclosed_alone(place.path(), script));
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
    let cuts = length("AMPCO_CUTS", 1.0);
    let script = format!(
        r#"
cut() {{ ip link set near down; sleep $1; ip link set near up; }}
memory() {{ for pid in $(pgrep -x ampco-gate -P $train,$join); do grep $1 /proc/$pid/status; done; }}
memory VmRSS > /tmp/rest
for i in $(seq {cuts}); do
    cut {seconds}
    since=$(date +%s%N); before=$(lines)
    until [ "$(lines)" -gt $((before + 2)) ]; do sleep 0.05; done
    echo $((($(date +%s%N) - since) / 1000000)) >> /tmp/whole
done
memory VmHWM > /tmp/most
"#
    );
    if !between(&place, &script) {
        return;
    }
    let account = account(&place);
    assert_eq!(account.uncounted, 0, "{account:?}");
    let whole = fs::read_to_string(place.path().join("whole")).expect("written");
    let took = whole.lines().map(|line| line.parse::<u64>().expect("ms"));
    let longest = took.max().expect("a cut");
    assert!(longest < 8_000, "{whole} ms; {account:?}");
    // Of gate and carrier, as they started: kB.
    let [rest, most] = ["rest", "most"].map(|name| {
        let said = fs::read_to_string(place.path().join(name)).expect("written");
        let number = |line: &str| line.split_whitespace().nth(1).and_then(|n| n.parse().ok());
        said.lines().filter_map(number).collect::<Vec<u64>>()
    });
    assert_eq!((rest.len(), most.len()), (2, 2), "gate and carrier");
    for (rest, most) in rest.iter().zip(&most) {
        assert!(*most < 2 * rest, "{rest} kB at rest, {most} at most");
    }
    println!("whole again after {longest} ms; memory {rest:?} kB at rest, {most:?} at most");
}

#[test]
fn a_long_wire_that_loses_packets_carries_rollouts() {
    let Some(python) = needs::python(&["fcntl"]) else {
        return;
    };
    if !fs::exists("/dev/net/tun").unwrap_or(false) {
        needs::absent("no /dev/net/tun");
        return;
    }
    let place = Runs::new();
    fs::write(place.path().join("wire.py"), include_str!("wire.py")).expect("written");
    // 100 Mbit/s, 20 ms each way, one packet of a hundred lost; rollouts of some 3 MB.
    let wire = std::env::var("AMPCO_WIRE").unwrap_or_else(|_| "100 20 0.01".to_owned());
    let head = format!(
        "WIRE='{python} /tmp/wire.py {wire}'
MORE='--set fleet.physics=batched --set fleet.environments=256 --set fleet.steps=32 --set ppo.minibatch=2048'\n"
    );
    let script = r#"
bytes() { $AMPCO status spread --runs-dir /tmp/near --json | tee /tmp/status.json | tr ',{' '\n\n' | sed -n 's/"bytes_in": *//p' | tail -1; }
sleep 3; first=$(bytes); since=$(date +%s%N); sleep 10; second=$(bytes)
echo "$first $second $((($(date +%s%N) - since) / 1000000))" > /tmp/carried
grep -ho 'congestion=[^ ]*' /tmp/far/*/logs/carrier.log | tail -1 > /tmp/congestion
"#;
    let end = format!("{END}kill $wire\n");
    if !run_between(
        &place,
        &format!("{head}{MACHINES_FAR_APART}{RUN}{script}{end}"),
    ) {
        return;
    }
    let account = account(&place);
    assert_eq!(account.uncounted, 0, "{account:?}");
    let carried = fs::read_to_string(place.path().join("carried")).expect("written");
    let numbers: Vec<u64> = carried
        .split_whitespace()
        .map(|number| number.parse().expect("bytes, bytes, ms"))
        .collect();
    let [first, second, milliseconds] = numbers[..] else {
        panic!("{carried}");
    };
    assert!(second > first, "nothing was carried: {carried}");
    let congestion = fs::read_to_string(place.path().join("congestion")).unwrap_or_default();
    let rate = (second - first) as f64 / 1e3 / milliseconds as f64;
    println!("{wire}: {rate:.2} MB/s of rollouts; {}", congestion.trim());
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

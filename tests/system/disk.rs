//! A disk that refuses: the writing stops and is missed, the training goes on.

use std::fs;
use std::os::unix::fs::PermissionsExt;

use rustix::process::Signal;

use crate::harness::{
    Process, Runs, enclosed, has_no_namespaces, holder, metrics, until, until_iteration,
};

/// A file system of a few megabytes that is filled while a group trains, and emptied again. Its content
/// vanishes with the namespace, so it is copied out at the end.
const FULL: &str = r#"
RUNS=/tmp/runs OUT=/tmp
mkdir "$RUNS" && mount -t tmpfs -o size=8m tmpfs "$RUNS" || exit 9
"$AMPCO" train --preset smoke --actors 1 --run full --runs-dir "$RUNS" --set run.iterations=0 \
    --set checkpoint_every=5 2> "$OUT/said" &
train=$!
trap 'kill -KILL $train' EXIT
run="$RUNS/full"
newest() { ls "$run/checkpoints" | tail -n 1; }
until [ -s "$run/metrics.jsonl" ]; do kill -0 $train || exit 10; sleep 0.05; done
dd if=/dev/zero of="$RUNS/filler" bs=64k 2> /dev/null
until grep -q 'checkpoint not written' "$OUT/said" && grep -q 'metrics not written' "$OUT/said"; do
    kill -0 $train || exit 11
    dd if=/dev/zero bs=4k 2> /dev/null >> "$RUNS/filler"
    sleep 0.05
done
rm "$RUNS/filler"
stopped=$(newest)
until [ "$(newest)" != "$stopped" ]; do kill -0 $train || exit 12; sleep 0.05; done
trap - EXIT
kill -TERM $train
wait $train
status=$?
cp -r "$run" "$OUT/run"
exit $status
"#;

#[test]
fn a_full_disk_stops_the_writing_and_not_the_training() {
    let out = Runs::new();
    let mut process = Process::start(enclosed(out.path(), FULL));
    let status = process.end();
    let said = process.stderr.text();
    if has_no_namespaces(&said) {
        return;
    }
    let train = fs::read_to_string(out.path().join("said")).expect("what it said");
    assert!(status.success(), "{status} {said} {train}");
    // The lines that found no room have followed: none is missing.
    let lines = metrics(&out.run("run"));
    let numbers: Vec<u64> = lines
        .iter()
        .filter_map(|line| line["iteration"].as_u64())
        .collect();
    let expected: Vec<u64> = (1..=numbers.len() as u64).collect();
    assert_eq!(numbers, expected);
    let newest = run::Folder::open(&out.run("run"))
        .expect("the folder")
        .checkpoints()
        .newest_whole();
    assert_eq!(newest, numbers.last().copied(), "the end was saved");
}

/// `ampco train` without the right to override permissions, which root has: a user namespace in which nobody has a number
/// takes that right away.
const BOUND_BY_PERMISSIONS: &str = r#"
exec unshare --user "$AMPCO" train --preset smoke --actors 1 --run still --runs-dir /tmp \
    --set run.iterations=0 --set checkpoint_every=5
"#;

#[test]
fn a_read_only_folder_stops_the_writing_and_not_the_training() {
    let runs = Runs::new();
    let run = runs.run("still");
    let mut group = Process::start(enclosed(runs.path(), BOUND_BY_PERMISSIONS));
    until("a first iteration or a refusal", || {
        let said = group.stderr.text();
        let refused = said.contains("unshare:") || said.contains("mount:");
        let begun = run.join("metrics.jsonl").exists() && !metrics(&run).is_empty();
        (refused || begun).then_some(())
    });
    if has_no_namespaces(&group.stderr.text()) {
        return;
    }
    // Sockets of a user without a number are in this test's folder and nobody else's.
    assert!(runs.path().join("ampco-65534").is_dir());
    let folders = [run.join("checkpoints"), run.clone()];
    let permit = |mode| {
        for folder in &folders {
            fs::set_permissions(folder, fs::Permissions::from_mode(mode)).expect("our folder");
        }
    };
    permit(0o555);
    until("the warning", || {
        group
            .stderr
            .text()
            .contains("checkpoint not written")
            .then_some(())
    });
    let checkpoints = run::Folder::open(&run).expect("the folder").checkpoints();
    let stopped = checkpoints.list().pop();
    let reached = metrics(&run).len() as u64;
    until_iteration(&run, reached + 10);
    assert_eq!(checkpoints.list().pop(), stopped);
    assert!(holder(&run, "learner").is_some());
    permit(0o755);
    until("another checkpoint", || {
        (checkpoints.list().pop() > stopped).then_some(())
    });
    permit(0o555);
    let saved = checkpoints.list().pop().expect("one at least");
    until_iteration(&run, saved + 10);
    group.signal(Signal::TERM);
    let status = group.end();
    permit(0o755);
    let said = group.stderr.text();
    assert!(!status.success(), "the end could not be saved: {said}");
    let last = checkpoints.list().pop().expect("as before");
    assert!(
        said.contains(&format!("iterations {} to ", last + 1)),
        "{said}"
    );
}

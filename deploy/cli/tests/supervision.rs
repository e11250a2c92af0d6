//! The supervisor with a group of stand-ins: shell scripts that die, disobey and refuse on request,
//! which the real programs do not. The real group is tried by the system tests.

use std::fs;
use std::os::unix::fs::PermissionsExt;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::sync::Mutex;
use std::time::{Duration, Instant};

use protocol::Domain;
use rustix::process::{Pid, Signal, kill_process};

/// Longest that anything here may take on a busy machine.
const PATIENCE: Duration = Duration::from_secs(60);

/// Lives until SIGTERM, which it obeys. What it does is written beside it, `ready` when it can be
/// signalled.
const OBEDIENT: &str =
    "trap 'echo $name >> $here/ended; kill $!; exit 0' TERM\nready\nsleep 1000 & wait $!\n";

/// Lives until it is killed.
const DEAF: &str = "trap '' TERM\nready\nexec sleep 1000\n";

/// Held while a file is written that is to be executed, and while a process is started. A process
/// started by another test would inherit the open file for a moment, and nobody can execute a file
/// that is open for writing.
static QUIET: Mutex<()> = Mutex::new(());

/// The program with stand-ins beside it.
struct Stage(tempfile::TempDir);

impl Stage {
    fn new(scheduler: &str, learner: &str, actor: &str) -> Self {
        let _nobody_starts = QUIET.lock();
        let stage = Self(tempfile::tempdir_in(env!("CARGO_TARGET_TMPDIR")).unwrap());
        // A hard link: the program looks beside the file that it really is.
        fs::hard_link(env!("CARGO_BIN_EXE_ampco"), stage.path("ampco")).unwrap();
        for (name, body) in [
            ("scheduler", scheduler),
            ("learner", learner),
            ("actor", actor),
        ] {
            let path = stage.path(&format!("ampco-{name}"));
            let text = format!(
                "#!/bin/sh\nname={name}\nhere=${{0%/*}}\nrun=$2\n\
                 ready() {{ echo $$ >> $here/{name}.pids; }}\necho \"$@\" >> $here/{name}.arguments\n{body}"
            );
            fs::write(&path, text).unwrap();
            fs::set_permissions(&path, fs::Permissions::from_mode(0o755)).unwrap();
        }
        stage
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    fn lines(&self, name: &str) -> Vec<String> {
        let text = fs::read_to_string(self.path(name)).unwrap_or_default();
        text.lines().map(str::to_owned).collect()
    }

    /// `ampco train` of the smoke preset with one actor.
    fn train(&self, arguments: &[&str]) -> Guard {
        self.ampco(&[&["--preset", "smoke", "--actors", "1"], arguments].concat())
    }

    /// `ampco train` of the run `play`.
    fn ampco(&self, arguments: &[&str]) -> Guard {
        let mut command = Command::new(self.path("ampco"));
        command
            .args(["train", "--run", "play", "--runs-dir"])
            .arg(self.path("runs"))
            .args(arguments)
            .stdin(Stdio::null())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped());
        let _nobody_writes = QUIET.lock();
        Guard(Some(command.spawn().unwrap()))
    }

    /// Waits until a stand-in has been started so many times, and returns the newest's process.
    fn started(&self, name: &str, times: usize) -> Pid {
        let since = Instant::now();
        loop {
            let pids = self.lines(&format!("{name}.pids"));
            if pids.len() >= times {
                return Pid::from_raw(pids[times - 1].parse().unwrap()).unwrap();
            }
            assert!(
                since.elapsed() < PATIENCE,
                "{name} was not started {times} times"
            );
            std::thread::yield_now();
        }
    }

    fn assert_nothing_is_left(&self) {
        for name in ["scheduler", "learner", "actor"] {
            for pid in self.lines(&format!("{name}.pids")) {
                assert!(
                    !Path::new("/proc").join(&pid).exists(),
                    "{name} {pid} is alive"
                );
            }
        }
        let domain = Domain::for_run(&self.path("runs/play")).unwrap();
        assert!(domain.leftovers().unwrap().is_empty());
    }
}

/// The supervisor; killed if a test fails before its end.
struct Guard(Option<Child>);

impl Guard {
    fn signal(&self, signal: Signal) {
        let child = self.0.as_ref().unwrap();
        kill_process(Pid::from_child(child), signal).unwrap();
    }

    /// Waits for its end: exit status, and what it said on standard error.
    fn end(mut self) -> (Option<i32>, String) {
        let Output { status, stderr, .. } = self.0.take().unwrap().wait_with_output().unwrap();
        (status.code(), String::from_utf8(stderr).unwrap())
    }
}

impl Drop for Guard {
    fn drop(&mut self) {
        if let Some(child) = &mut self.0 {
            let _ = child.kill();
            let _ = child.wait();
        }
    }
}

/// A learner that does three iterations of 128 samples and is done.
const BRIEF: &str = "ready\nfor i in 1 2 3; do echo \"{\\\"iteration\\\": $i, \\\"samples\\\": $((i * 128))}\" \
                     >> $run/metrics.jsonl; done\n";

#[test]
fn a_learner_that_is_done_ends_the_group() {
    let learner = format!("{BRIEF}mkdir -p $run/checkpoints/00000003\nexit 0\n");
    let stage = Stage::new(OBEDIENT, &learner, OBEDIENT);
    let (status, said) = stage.train(&[]).end();
    assert_eq!(status, Some(0), "{said}");
    assert!(said.contains("run play complete"), "{said}");
    assert!(said.contains("at iteration 3, 384 samples"), "{said}");
    assert!(
        said.contains("all processes ended, shared memory removed"),
        "{said}"
    );
    assert_eq!(
        stage.lines("actor.arguments")[0].split(' ').next_back(),
        Some("0")
    );
    stage.assert_nothing_is_left();
}

#[test]
fn a_learner_that_could_not_save_what_it_learnt_is_a_failure() {
    let learner = format!("{BRIEF}mkdir -p $run/checkpoints/00000002\nexit 0\n");
    let stage = Stage::new(OBEDIENT, &learner, OBEDIENT);
    let (status, said) = stage.train(&[]).end();
    assert_eq!(status, Some(1), "{said}");
    assert!(
        said.contains("what was learnt in iterations 3 to 3 is lost"),
        "{said}"
    );
    stage.assert_nothing_is_left();
}

#[test]
fn ctrl_c_ends_the_learner_first() {
    let stage = Stage::new(OBEDIENT, OBEDIENT, OBEDIENT);
    let train = stage.train(&["--set", "run.deadlines.stop_seconds=1.0"]);
    for name in ["scheduler", "learner", "actor"] {
        stage.started(name, 1);
    }
    train.signal(Signal::INT);
    let (status, said) = train.end();
    assert_eq!(status, Some(0), "{said}");
    let ended = stage.lines("ended");
    assert_eq!(ended.len(), 3, "{ended:?} {said}");
    assert_eq!(ended[0], "learner", "{ended:?}");
    stage.assert_nothing_is_left();
}

#[test]
fn who_is_killed_is_started_again() {
    let stage = Stage::new(OBEDIENT, OBEDIENT, OBEDIENT);
    let train = stage.train(&["--set", "run.deadlines.stop_seconds=1.0"]);
    for name in ["scheduler", "actor", "learner"] {
        kill_process(stage.started(name, 1), Signal::KILL).unwrap();
        stage.started(name, 2);
    }
    train.signal(Signal::TERM);
    let (status, said) = train.end();
    assert_eq!(status, Some(0), "{said}");
    assert!(
        said.contains("scheduler was killed by signal 9 (SIGKILL); restart 1"),
        "{said}"
    );
    // Without a checkpoint there is nothing that the learner could go on from.
    assert!(!stage.lines("learner.arguments")[1].contains("--resume"));
    stage.assert_nothing_is_left();
}

#[test]
fn a_restarted_learner_goes_on_from_its_checkpoint() {
    let stage = Stage::new(OBEDIENT, OBEDIENT, OBEDIENT);
    let train = stage.train(&["--set", "run.deadlines.stop_seconds=1.0"]);
    let learner = stage.started("learner", 1);
    let run = run::Folder::open(&stage.path("runs/play")).unwrap();
    run.checkpoints()
        .write(4, "any", &[("part", b"x")])
        .unwrap();
    kill_process(learner, Signal::KILL).unwrap();
    stage.started("learner", 2);
    train.signal(Signal::TERM);
    let (_, said) = train.end();
    assert!(
        stage.lines("learner.arguments")[1].contains("--resume"),
        "{said}"
    );
    assert!(said.contains("last checkpoint 00000004"), "{said}");
}

#[test]
fn a_refusal_at_the_first_start_is_passed_on_and_not_repeated() {
    let learner = "ready\necho 'ampco-learner: this cannot work' >&2\nexit 1\n";
    let stage = Stage::new(OBEDIENT, learner, OBEDIENT);
    let (status, said) = stage.train(&[]).end();
    assert_eq!(status, Some(1), "{said}");
    assert!(said.contains("ampco-learner: this cannot work"), "{said}");
    assert!(
        said.ends_with(
            "ampco: learner is given up; it failed with status 1: ampco-learner: this cannot work\n"
        ),
        "{said}"
    );
    assert_eq!(stage.lines("learner.pids").len(), 1);
    stage.assert_nothing_is_left();
}

#[test]
fn an_actor_that_always_dies_is_given_up() {
    let stage = Stage::new(OBEDIENT, OBEDIENT, "ready\nkill -9 $$\n");
    let (status, said) = stage
        .train(&["--set", "run.deadlines.stop_seconds=1.0"])
        .end();
    assert_eq!(status, Some(1), "{said}");
    assert_eq!(stage.lines("actor.pids").len(), 5);
    assert!(
        said.contains("actor-0 is given up; it was killed by signal 9 (SIGKILL); somebody sent it, or the kernel"),
        "{said}"
    );
    stage.assert_nothing_is_left();
}

#[test]
fn an_empty_log_is_not_pointed_to() {
    let log = "mkdir -p $run/logs\n: >> $run/logs/learner.log\n";
    let silent = Stage::new(OBEDIENT, &format!("{log}ready\nexit 1\n"), OBEDIENT);
    let (status, said) = silent.train(&[]).end();
    assert_eq!(status, Some(1), "{said}");
    let last = said.lines().last().unwrap_or_default();
    assert!(
        last.contains("learner is given up; it failed with status 1; it said nothing and "),
        "{said}"
    );
    assert!(
        last.ends_with("logs/learner.log is empty") && !last.contains("see "),
        "{said}"
    );
    silent.assert_nothing_is_left();

    let writes = format!("{log}echo why >> $run/logs/learner.log\nready\nexit 1\n");
    let logged = Stage::new(OBEDIENT, &writes, OBEDIENT);
    let (_, said) = logged.train(&[]).end();
    let last = said.lines().last().unwrap_or_default();
    assert!(
        last.contains("it failed with status 1; see ") && last.ends_with("logs/learner.log"),
        "{said}"
    );
    logged.assert_nothing_is_left();
}

#[test]
fn who_does_not_obey_is_killed_and_named() {
    let stage = Stage::new(OBEDIENT, DEAF, OBEDIENT);
    let train = stage.train(&["--set", "run.deadlines.stop_seconds=0.2"]);
    stage.started("learner", 1);
    train.signal(Signal::TERM);
    let (status, said) = train.end();
    assert_eq!(status, Some(0), "{said}");
    assert!(said.contains("killed: learner"), "{said}");
    stage.assert_nothing_is_left();
}

#[test]
fn a_second_ctrl_c_waits_for_nobody() {
    // The patience is an hour; the test ends because nobody has it.
    let stage = Stage::new(OBEDIENT, DEAF, OBEDIENT);
    let train = stage.train(&["--set", "run.deadlines.stop_seconds=3600"]);
    stage.started("learner", 1);
    train.signal(Signal::INT);
    // Signals of one kind are merged while one is pending; another kind is not.
    train.signal(Signal::TERM);
    let (status, said) = train.end();
    assert_eq!(status, Some(0), "{said}");
    assert!(said.contains("killed: "), "{said}");
    stage.assert_nothing_is_left();
}

#[test]
fn time_is_up_after_the_minutes() {
    let stage = Stage::new(OBEDIENT, OBEDIENT, OBEDIENT);
    let minutes = [
        "--minutes",
        "0.005",
        "--set",
        "run.deadlines.stop_seconds=1.0",
    ]; // 0.3 s
    let (status, said) = stage.train(&minutes).end();
    assert_eq!(status, Some(0), "{said}");
    assert!(said.contains("time is up"), "{said}");
    assert_eq!(
        stage.lines("ended").first().map(String::as_str),
        Some("learner")
    );
}

#[test]
fn bad_configuration_starts_nothing_and_exits_with_two() {
    let stage = Stage::new(OBEDIENT, OBEDIENT, OBEDIENT);
    for (arguments, words) in [
        (["--set", "ppo.epohcs=3"], "did you mean `epochs`?"),
        (["--set", "fleet.steps=0"], "steps = 0"),
        (["--preset", "smok"], "did you mean `smoke`?"),
        (
            ["--set", "motion.clips=[{file='none.csv',fps=50}]"],
            "none.csv",
        ),
    ] {
        let (status, said) = stage.ampco(&arguments).end();
        assert_eq!(status, Some(2), "{said}");
        assert!(said.contains(words), "{said}");
        assert_eq!(said.lines().count(), 1, "one clear line, not {said}");
    }
    assert!(!stage.path("runs").exists() && stage.lines("learner.pids").is_empty());
}

#[test]
fn a_run_is_not_overwritten_and_a_running_one_not_joined() {
    let learner = "echo '{\"iteration\": 1}' >> $run/metrics.jsonl\ntrap 'exit 0' TERM\nready\n\
                   sleep 1000 & wait $!\n";
    let stage = Stage::new(OBEDIENT, learner, OBEDIENT);
    let train = stage.train(&["--set", "run.deadlines.stop_seconds=0.5"]);
    stage.started("learner", 1);
    let (status, said) = stage.train(&[]).end();
    assert_eq!(status, Some(2), "{said}");
    assert!(
        said.contains("run play exists already") && said.contains("--resume"),
        "{said}"
    );

    let run = run::Folder::open(&stage.path("runs/play")).unwrap();
    run.checkpoints()
        .write(1, "any", &[("part", b"x")])
        .unwrap();
    let (status, said) = stage.ampco(&["--resume"]).end();
    assert_eq!(status, Some(1), "{said}");
    assert!(said.contains("already has a supervisor"), "{said}");

    train.signal(Signal::TERM);
    train.end();
}

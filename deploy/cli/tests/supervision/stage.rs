//! `ampco` with stand-ins beside it: shell scripts in place of the programs of the group.

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
pub(crate) const OBEDIENT: &str =
    "trap 'echo $name >> $here/ended; kill $!; exit 0' TERM\nready\nsleep 1000 & wait $!\n";

/// Lives until it is killed.
pub(crate) const DEAF: &str = "trap '' TERM\nready\nexec sleep 1000\n";

/// Held while a file is written that is to be executed, and while a process is started. A process
/// started by another test would inherit the open file for a moment, and nobody can execute a file
/// that is open for writing.
static QUIET: Mutex<()> = Mutex::new(());

/// The program with stand-ins beside it.
pub(crate) struct Stage(tempfile::TempDir);

impl Stage {
    pub(crate) fn new(scheduler: &str, learner: &str, actor: &str) -> Self {
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

    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    pub(crate) fn lines(&self, name: &str) -> Vec<String> {
        let text = fs::read_to_string(self.path(name)).unwrap_or_default();
        text.lines().map(str::to_owned).collect()
    }

    /// `ampco train` of the smoke preset with one actor.
    pub(crate) fn train(&self, arguments: &[&str]) -> Guard {
        self.ampco(&[&["--preset", "smoke", "--actors", "1"], arguments].concat())
    }

    /// `ampco train` of the run `play`.
    pub(crate) fn ampco(&self, arguments: &[&str]) -> Guard {
        let mut command = Command::new(self.path("ampco"));
        command
            .args(["train", "--no-pictures", "--run", "play", "--runs-dir"])
            .arg(self.path("runs"))
            .args(arguments)
            .stdin(Stdio::null())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped());
        let _nobody_writes = QUIET.lock();
        Guard(Some(command.spawn().unwrap()))
    }

    /// Waits until a stand-in has been started so many times, and returns the newest's process.
    pub(crate) fn started(&self, name: &str, times: usize) -> Pid {
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

    pub(crate) fn assert_nothing_is_left(&self) {
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
pub(crate) struct Guard(Option<Child>);

impl Guard {
    pub(crate) fn signal(&self, signal: Signal) {
        let child = self.0.as_ref().unwrap();
        kill_process(Pid::from_child(child), signal).unwrap();
    }

    /// Waits for its end: exit status, and what it said on standard error.
    pub(crate) fn end(mut self) -> (Option<i32>, String) {
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

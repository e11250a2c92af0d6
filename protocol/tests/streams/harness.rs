//! A run folder with its domain, and this binary as another process.

use std::io::{BufRead, BufReader, Write};
use std::process::{Child, ChildStdin, Command, Stdio};
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::time::{Duration, Instant};

use protocol::{Domain, Lists, Node, RolloutLayout, Shutdown};
use tempfile::TempDir;

/// Longest time that anything in these tests may take.
pub(crate) const DEADLINE: Duration = Duration::from_secs(15);

/// A small rollout: 2·(3·242 + 164) numbers.
pub(crate) fn layout() -> RolloutLayout {
    RolloutLayout {
        environments: 2,
        steps: 3,
        lists: Lists::default(),
    }
}

const ROLE: &str = "PROTOCOL_TEST_ROLE";
const RUN: &str = "PROTOCOL_TEST_RUN";

/// A run of its own. Dropping it removes its domain.
pub(crate) struct Run {
    pub(crate) folder: TempDir,
    pub(crate) domain: Domain,
}

impl Run {
    pub(crate) fn new() -> Self {
        let folder = tempfile::tempdir().unwrap();
        let domain = Domain::for_run(folder.path()).unwrap();
        Self { folder, domain }
    }

    pub(crate) fn join(&self, role: &str) -> Node {
        Node::join(&self.domain, role, &Shutdown::manual()).unwrap()
    }

    /// Starts this binary again; it runs the role of that name in [`crate::life`].
    pub(crate) fn start(&self, role: &str) -> Process {
        let mut child = command(role)
            .env(RUN, self.folder.path())
            .spawn()
            .expect("starting this binary again");
        let stdout = child.stdout.take().unwrap();
        let (sender, lines) = channel();
        std::thread::spawn(move || {
            for line in BufReader::new(stdout).lines().map_while(Result::ok) {
                // The test harness of the other process prints before the role does.
                if let Some((_, said)) = line.split_once("@ ") {
                    let _ = sender.send(said.to_owned());
                }
            }
        });
        let stdin = child.stdin.take();
        Process {
            child,
            stdin,
            lines,
        }
    }
}

impl Drop for Run {
    fn drop(&mut self) {
        // Children are declared after the run and die before it; their nodes may still be listed.
        let _ = self.domain.remove();
    }
}

/// The command that runs `role` of this binary.
pub(crate) fn command(role: &str) -> Command {
    let mut command = Command::new(std::env::current_exe().unwrap());
    command
        .args(["--ignored", "--exact", "life::other_process", "--nocapture"])
        .env(ROLE, role)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped());
    command
}

/// Role and domain that this process was started for.
pub(crate) fn assignment() -> (String, Domain) {
    let role = std::env::var(ROLE).expect("only other tests start this one");
    let run = std::env::var_os(RUN).unwrap();
    (role, Domain::for_run(run.as_ref()).unwrap())
}

/// Says a line to the process that started this one.
pub(crate) fn say(line: &str) {
    let mut stdout = std::io::stdout().lock();
    writeln!(stdout, "@ {line}").unwrap();
    stdout.flush().unwrap();
}

/// Waits until the process that started this one lets go or dies.
pub(crate) fn until_released() {
    let mut line = String::new();
    let _ = std::io::stdin().read_line(&mut line);
}

/// A process that does not outlive the test.
pub(crate) struct Process {
    child: Child,
    stdin: Option<ChildStdin>,
    lines: Receiver<String>,
}

impl Process {
    /// Waits for it to say `expected` next.
    pub(crate) fn expect(&self, expected: &str) {
        let said = self.lines.recv_timeout(DEADLINE);
        assert_eq!(said.as_deref(), Ok(expected));
    }

    /// Waits until it and all its children have ended.
    pub(crate) fn expect_silence(&self) {
        let said = self.lines.recv_timeout(DEADLINE);
        assert_eq!(said, Err(RecvTimeoutError::Disconnected));
    }

    /// SIGKILL, and it is gone when this returns.
    pub(crate) fn kill(&mut self) {
        self.child.kill().unwrap();
        self.child.wait().unwrap();
    }

    /// SIGTERM.
    pub(crate) fn terminate(&self) {
        let process = rustix::process::Pid::from_child(&self.child);
        rustix::process::kill_process(process, rustix::process::Signal::TERM).unwrap();
    }

    /// Lets it go on to its end and expects success.
    pub(crate) fn release(mut self) {
        drop(self.stdin.take());
        assert!(self.child.wait().unwrap().success());
    }
}

impl Drop for Process {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// Repeats `attempt`, which waits a little itself, until it gives something.
pub(crate) fn eventually<T>(what: &str, mut attempt: impl FnMut() -> Option<T>) -> T {
    let deadline = Instant::now() + DEADLINE;
    while Instant::now() < deadline {
        if let Some(result) = attempt() {
            return result;
        }
    }
    panic!("{what}: not within {DEADLINE:?}");
}

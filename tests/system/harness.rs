//! Programs under test: found, started in a folder of their own, waited for with a deadline,
//! killed when the test ends.

use std::fs;
use std::io::Read;
use std::os::unix::process::CommandExt;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::sync::{Arc, Mutex};
use std::thread;
use std::time::{Duration, Instant};

use run::config::{Source, lay};
use rustix::process::{Pid, Signal, kill_process, kill_process_group};
use serde_json::Value;
use tempfile::TempDir;

mod enclosed;
mod wait;

pub(crate) use enclosed::{enclosed, enclosed_alone, has_no_namespaces};
pub(crate) use wait::until;
use wait::{GLANCE, until_within};

/// Longest that anything here may take on a busy machine.
pub(crate) const PATIENCE: Duration = Duration::from_secs(90);

/// A folder of runs that vanishes with the test.
pub(crate) struct Runs(TempDir);

impl Runs {
    pub(crate) fn new() -> Self {
        Self(tempfile::tempdir().expect("a temporary folder"))
    }

    pub(crate) fn path(&self) -> &Path {
        self.0.path()
    }

    pub(crate) fn run(&self, name: &str) -> PathBuf {
        self.path().join(name)
    }

    /// `ampco train --resume` of a run.
    pub(crate) fn resume(&self, name: &str, arguments: &[&str]) -> Process {
        let mut command = Command::new(program("ampco"));
        command
            .args(["train", "--resume", "--no-pictures"])
            .args(["--run", name, "--runs-dir"])
            .arg(self.path())
            .args(arguments);
        Process::start(command)
    }

    /// `ampco train` of the smoke preset with further arguments.
    pub(crate) fn train(&self, name: &str, arguments: &[&str]) -> Process {
        let mut command = Command::new(program("ampco"));
        command
            .args(["train", "--preset", "smoke", "--no-pictures"])
            .args(["--run", name, "--runs-dir"])
            .arg(self.path())
            // Endless, unless the test says otherwise.
            .args(["--set", "run.iterations=0"])
            .args(arguments);
        Process::start(command)
    }
}

impl Drop for Runs {
    /// What a supervisor would clean up: tests kill theirs, and end processes that never had one. Members
    /// of a killed group take a moment to be gone.
    fn drop(&mut self) {
        for entry in fs::read_dir(self.path()).into_iter().flatten().flatten() {
            let Ok(domain) = protocol::Domain::for_run(&entry.path()) else {
                continue;
            };
            let deadline = Instant::now() + Duration::from_secs(5);
            while domain.remove().is_err() && Instant::now() < deadline {
                thread::sleep(GLANCE);
            }
        }
    }
}

/// A run's folder in which single processes are started by hand, without a supervisor.
pub(crate) struct Alone {
    _runs: Runs,
    folder: run::Folder,
}

impl Alone {
    /// The smoke preset for `actors` actors.
    pub(crate) fn new(actors: i64) -> Self {
        let runs = Runs::new();
        let folder = run::Folder::create(runs.path(), "alone").expect("a folder");
        let presets = repository().join("deploy/presets");
        let open = |name: &str| {
            let source = Source::read(&presets.join(format!("{name}.toml")));
            source.map_err(|error| error.to_string())
        };
        let mut config = run::Config::default();
        let smoke = open("smoke").expect("the smoke preset");
        lay(&mut config, smoke, |on, _| open(on), |_| None).expect("all that it lies on");
        config.put("fleet.actors", actors, "the test");
        config.put("run.iterations", 0, "the test");
        // `ampco train` writes every value out; this one a learner reads without its section's owner.
        config.put("task.termination.time_out.steps", 1000, "the test");
        config
            .write(&folder.config_path(), "test")
            .expect("written");
        Self {
            _runs: runs,
            folder,
        }
    }

    pub(crate) fn path(&self) -> &Path {
        self.folder.path()
    }

    /// Changes one value of the configuration, before anything is started.
    pub(crate) fn set(&self, key: &str, value: impl Into<toml::Value>) {
        let mut config = self.folder.config().expect("a configuration");
        config.put(key, value, "the test");
        config
            .write(&self.folder.config_path(), "test")
            .expect("written");
    }

    pub(crate) fn start(&self, name: &str, arguments: &[&str]) -> Process {
        let mut command = Command::new(program(name));
        command.arg("--run-dir").arg(self.path()).args(arguments);
        Process::start(command)
    }
}

/// The repository's top folder.
pub(crate) fn repository() -> PathBuf {
    let tests = Path::new(env!("CARGO_MANIFEST_DIR"));
    tests.parent().expect("a parent folder").to_owned()
}

/// A program of this workspace, beside the test binary's folder.
pub(crate) fn program(name: &str) -> PathBuf {
    let here = std::env::current_exe().expect("the test's own path");
    let path = here
        .parent()
        .and_then(Path::parent)
        .expect("target/<profile>/deps")
        .join(name);
    assert!(
        path.exists(),
        "{} is missing: build the programs first, as deploy/check.sh does",
        path.display()
    );
    path
}

/// A child that leads a process group of its own and does not outlive the test.
pub(crate) struct Process {
    child: Child,
    pub(crate) stdout: Captured,
    pub(crate) stderr: Captured,
}

/// Everything a stream said so far, read by a thread of its own.
pub(crate) struct Captured(Arc<Mutex<Vec<u8>>>, Option<thread::JoinHandle<()>>);

impl Captured {
    fn read(mut from: impl Read + Send + 'static) -> Self {
        let text = Arc::new(Mutex::new(Vec::new()));
        let into = text.clone();
        let reader = thread::spawn(move || {
            let mut chunk = [0; 4096];
            while let Ok(count @ 1..) = from.read(&mut chunk) {
                into.lock()
                    .expect("no panic while held")
                    .extend(&chunk[..count]);
            }
        });
        Self(text, Some(reader))
    }

    /// The same stream for another who reads it.
    fn again(&self) -> Self {
        Self(self.0.clone(), None)
    }

    pub(crate) fn text(&self) -> String {
        String::from_utf8_lossy(&self.0.lock().expect("no panic while held")).into_owned()
    }

    fn finish(&mut self) {
        if let Some(reader) = self.1.take() {
            reader.join().expect("the reader ends with its stream");
        }
    }
}

impl Process {
    pub(crate) fn start(mut command: Command) -> Self {
        let mut child = command
            .stdin(Stdio::null())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .process_group(0)
            .spawn()
            .unwrap_or_else(|error| panic!("{command:?}: {error}"));
        let stdout = Captured::read(child.stdout.take().expect("piped"));
        let stderr = Captured::read(child.stderr.take().expect("piped"));
        wait::started(Pid::from_child(&child), stderr.again());
        Self {
            child,
            stdout,
            stderr,
        }
    }

    pub(crate) fn pid(&self) -> Pid {
        Pid::from_child(&self.child)
    }

    /// Whether it has not ended by itself.
    pub(crate) fn is_alive(&mut self) -> bool {
        matches!(self.child.try_wait(), Ok(None))
    }

    /// Sends a signal to this process alone.
    pub(crate) fn signal(&self, signal: Signal) {
        kill_process(self.pid(), signal).expect("the process is alive");
    }

    /// Waits for the end, which must come within [`PATIENCE`].
    pub(crate) fn end(&mut self) -> ExitStatus {
        self.end_within(PATIENCE)
    }

    /// Waits for the end of what takes longer.
    pub(crate) fn end_within(&mut self, patience: Duration) -> ExitStatus {
        wait::awaited_end(self.pid());
        let status = until_within(patience, "the end of a process", || {
            self.child.try_wait().expect("a child can be waited for")
        });
        self.stdout.finish();
        self.stderr.finish();
        status
    }
}

impl Drop for Process {
    fn drop(&mut self) {
        wait::awaited_end(self.pid());
        if matches!(self.child.try_wait(), Ok(None)) {
            let _ = kill_process_group(self.pid(), Signal::KILL);
            let _ = self.child.kill();
            let _ = self.child.wait();
        }
    }
}

/// Runs a command to its end: success, what it said on standard output, on standard error.
pub(crate) fn finish(command: Command) -> (bool, String, String) {
    let mut process = Process::start(command);
    let status = process.end();
    (
        status.success(),
        process.stdout.text(),
        process.stderr.text(),
    )
}

/// All metrics of a run so far.
pub(crate) fn metrics(run: &Path) -> Vec<Value> {
    run::metrics::read(&run.join("metrics.jsonl")).expect("readable metrics")
}

/// Waits until a run has finished iteration `iteration` or a later one.
pub(crate) fn until_iteration(run: &Path, iteration: u64) -> Value {
    until(
        &format!("iteration {iteration} of {}", run.display()),
        || {
            metrics(run)
                .into_iter()
                .next_back()
                .filter(|line| line["iteration"].as_u64() >= Some(iteration))
        },
    )
}

/// The process that holds a role in a run, from its lock.
pub(crate) fn holder(run: &Path, role: &str) -> Option<Pid> {
    let folder = run::Folder::open(run).ok()?;
    let pid = folder.holder(role).ok()??;
    Pid::from_raw(pid.trim().parse().ok()?)
}

/// What two runs must agree on: every metric but the timings.
pub(crate) fn without_timing(mut line: Value) -> Value {
    line.as_object_mut().expect("a record").remove("timing");
    line
}

/// Memory of a process that belongs to no file, bytes.
pub(crate) fn own_memory(pid: Pid) -> u64 {
    let path = format!("/proc/{}/status", pid.as_raw_pid());
    let status = fs::read_to_string(path).expect("the process is alive");
    let line = status
        .lines()
        .find_map(|line| line.strip_prefix("RssAnon:"));
    let kilobytes = line.and_then(|line| line.split_whitespace().next());
    1024 * kilobytes
        .and_then(|number| number.parse::<u64>().ok())
        .expect("a number of kB")
}

/// An environment variable that lengthens a test, or what is enough beside all others.
pub(crate) fn length(variable: &str, short: f64) -> f64 {
    let given = std::env::var(variable).ok();
    given.map_or(short, |given| given.parse().expect("a number"))
}

/// The bytes of a file, or a panic that names it.
pub(crate) fn bytes(path: &Path) -> Vec<u8> {
    fs::read(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

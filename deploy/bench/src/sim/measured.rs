//! What a fleet took: steps, time by the clock and on a core, memory.

/// The kernel's account of this thread: nanoseconds on a core, then nanoseconds waiting for one.
const ACCOUNT: &str = "/proc/thread-self/schedstat";

#[derive(Default)]
pub(super) struct Measured {
    /// Control steps of one robot.
    pub(super) steps: usize,
    pub(super) wall: f64,
    /// None where the kernel keeps no account.
    pub(super) cpu: Option<f64>,
    pub(super) inference: f64,
    pub(super) resets: usize,
    pub(super) faults: u64,
    /// Growth of the process's memory; of the whole process, so that only one fleet tells its own.
    pub(super) bytes: Option<usize>,
}

impl Measured {
    pub(super) fn add(&mut self, other: Self) {
        self.steps += other.steps;
        self.wall += other.wall;
        self.cpu = match (self.cpu, other.cpu) {
            (Some(a), Some(b)) => Some(a + b),
            (None, cpu) | (cpu, None) => cpu,
        };
        self.inference += other.inference;
        self.resets += other.resets;
        self.faults += other.faults;
        self.bytes = other.bytes.or(self.bytes);
    }

    /// The mean of several.
    pub(super) fn over(self, fleets: usize) -> Self {
        let share = fleets as f64;
        Self {
            steps: self.steps / fleets,
            wall: self.wall / share,
            cpu: self.cpu.map(|cpu| cpu / share),
            inference: self.inference / share,
            resets: self.resets / fleets,
            bytes: self.bytes.filter(|_| fleets == 1),
            ..self
        }
    }

    pub(super) fn per_second(&self, seconds: f64) -> f64 {
        self.steps as f64 / seconds
    }
}

/// Memory of this process that is in the machine's, if the kernel tells.
pub(super) fn resident_bytes() -> Option<usize> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status
        .lines()
        .find_map(|line| line.strip_prefix("VmRSS:"))?;
    let kilobytes: usize = line.split_whitespace().next()?.parse().ok()?;
    Some(1024 * kilobytes)
}

/// Seconds that this thread has spent on a core.
pub(super) fn cpu_seconds() -> Option<f64> {
    let account = std::fs::read_to_string(ACCOUNT).ok()?;
    let nanoseconds: f64 = account.split_whitespace().next()?.parse().ok()?;
    Some(1e-9 * nanoseconds)
}

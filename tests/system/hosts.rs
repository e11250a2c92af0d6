//! A run that spans machines: here one machine plays all of them, over loopback or between namespaces.

#![expect(clippy::print_stdout, reason = "figures to be read")]

use std::net::TcpListener;
use std::path::PathBuf;
use std::process::Command;
use std::thread;

use crate::harness::{Process, Runs, program, until};

mod faults;
mod refused;
mod same;
mod wire;

/// A run that listens, and the folder of the machines that join it.
pub(super) struct Spread {
    pub(super) runs: Runs,
    pub(super) far: Runs,
    pub(super) port: u16,
}

impl Spread {
    pub(super) fn new() -> Self {
        Self {
            runs: Runs::new(),
            far: Runs::new(),
            port: free_port(),
        }
    }

    /// `ampco train` with `here` actors on the learner's machine.
    pub(super) fn train(&self, name: &str, here: u32, arguments: &[&str]) -> Process {
        let (listen, here) = (self.listen(), here.to_string());
        let spread = ["--listen", &listen, "--here", &here];
        self.runs.train(name, &[&spread[..], arguments].concat())
    }

    pub(super) fn resume(&self, name: &str, here: u32, arguments: &[&str]) -> Process {
        let (listen, here) = (self.listen(), here.to_string());
        let spread = ["--listen", &listen, "--here", &here];
        self.runs.resume(name, &[&spread[..], arguments].concat())
    }

    fn listen(&self) -> String {
        format!("127.0.0.1:{}", self.port)
    }

    /// `ampco join` with so many actors.
    pub(super) fn join(&self, name: &str, actors: u32) -> Process {
        self.join_at(name, actors, self.port)
    }

    /// As above, where a wire leads to the gate.
    pub(super) fn join_at(&self, name: &str, actors: u32, port: u16) -> Process {
        let file = self.runs.run(name).join(format!("join/{name}.join"));
        until("the join file", || file.is_file().then_some(()));
        let mut command = Command::new(program("ampco"));
        command
            .args(["join", &format!("127.0.0.1:{port}")])
            .arg("--file")
            .arg(file)
            .args(["--actors", &actors.to_string(), "--runs-dir"])
            .arg(self.far.path());
        Process::start(command)
    }

    /// The folders of the hosts that have joined, by name.
    pub(super) fn hosts(&self) -> Vec<PathBuf> {
        let entries = std::fs::read_dir(self.far.path()).expect("a folder");
        let mut folders: Vec<PathBuf> = entries.flatten().map(|entry| entry.path()).collect();
        folders.sort();
        folders
    }
}

/// A port that nobody had a moment ago.
fn free_port() -> u16 {
    let listener = TcpListener::bind("127.0.0.1:0").expect("a port");
    listener.local_addr().expect("an address").port()
}

/// Waits until a host's actor `number` has come to work.
pub(super) fn at_work(spread: &Spread, number: u32) {
    until(&format!("actor {number} on another machine"), || {
        let hosts = spread.hosts();
        hosts.iter().find_map(|host| {
            let text = std::fs::read_to_string(host.join(format!("actor-{number}.lock"))).ok()?;
            text.contains("at work").then_some(())
        })
    });
    thread::yield_now();
}

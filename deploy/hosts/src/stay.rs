//! `host.json`: what a host's own processes know of its stay in a run.

use std::fs;
use std::io::Read;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result};
use hosts::Join;
use serde::{Deserialize, Serialize};

/// Name of the file, in the folder that `ampco join` makes.
const FILE: &str = "host.json";
/// Name of the file with the stay's life alone, which outlives a stay.
const LIFE: &str = "life";

/// A host's stay in a run.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct Stay {
    /// The gate, HOST:PORT.
    pub(crate) gate: String,
    /// The join file.
    pub(crate) file: PathBuf,
    /// Name of this machine.
    pub(crate) host: String,
    /// By which the gate knows this host when it comes again.
    pub(crate) life: String,
    /// Numbers of the actors.
    pub(crate) numbers: Vec<u32>,
}

impl Stay {
    pub(crate) fn read(folder: &Path) -> Result<Self> {
        let path = folder.join(FILE);
        let text = fs::read(&path).with_context(|| path.display().to_string())?;
        serde_json::from_slice(&text).with_context(|| path.display().to_string())
    }

    pub(crate) fn write(&self, folder: &Path) -> Result<()> {
        let path = folder.join(FILE);
        let text = serde_json::to_vec_pretty(self).context("writing the stay")?;
        run::replace_file(&path, &text).with_context(|| path.display().to_string())
    }

    /// How every connection begins: of a host that wants `actors` actors, or that has its numbers.
    pub(crate) fn hello(&self, actors: u32) -> Join {
        Join {
            version: hosts::VERSION,
            protocol: protocol::PROTOCOL_VERSION,
            programs: env!("CARGO_PKG_VERSION").to_owned(),
            host: self.host.clone(),
            life: self.life.clone(),
            actors,
            numbers: self.numbers.clone(),
            features: hosts::features(),
        }
    }
}

/// The life of the host in a folder: the one that it had, else a new one.
pub(crate) fn life(folder: &Path) -> Result<String> {
    let path = folder.join(LIFE);
    if let Ok(life) = fs::read_to_string(&path)
        && !life.trim().is_empty()
    {
        return Ok(life.trim().to_owned());
    }
    let mut bytes = [0; 16];
    fs::File::open("/dev/urandom")
        .and_then(|mut random| random.read_exact(&mut bytes))
        .context("drawing a number for this stay")?;
    let life: String = bytes.iter().map(|byte| format!("{byte:02x}")).collect();
    run::replace_file(&path, life.as_bytes()).with_context(|| path.display().to_string())?;
    Ok(life)
}

/// This machine's name, in letters that a folder's name may have.
pub(crate) fn host() -> String {
    let name = rustix::system::uname();
    let name = name.nodename().to_string_lossy();
    let letters = |c: char| c.is_ascii_alphanumeric() || matches!(c, '-' | '_');
    let name: String = name.chars().filter(|c| letters(*c)).take(24).collect();
    if name.is_empty() {
        "host".to_owned()
    } else {
        name
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_host_that_comes_again_has_the_life_that_it_had() {
        let folder = tempfile::tempdir().unwrap();
        let first = life(folder.path()).unwrap();
        assert_eq!(first.len(), 32);
        assert_eq!(life(folder.path()).unwrap(), first);
        let elsewhere = tempfile::tempdir().unwrap();
        assert_ne!(life(elsewhere.path()).unwrap(), first);
    }

    #[test]
    fn a_stay_is_read_as_it_was_written() {
        let folder = tempfile::tempdir().unwrap();
        let stay = Stay {
            gate: "node1:7000".to_owned(),
            file: "/home/a/walk.join".into(),
            host: host(),
            life: "life".to_owned(),
            numbers: vec![2, 3],
        };
        stay.write(folder.path()).unwrap();
        assert_eq!(Stay::read(folder.path()).unwrap(), stay);
        let hello = stay.hello(0);
        assert_eq!((hello.actors, hello.numbers), (0, vec![2, 3]));
    }
}

//! The domain of a run: where its shared memory and sockets live, apart from every other run.
//!
//! Separate because two runs must never meet, and because after the last process nothing may
//! remain. A domain is a prefix for names under `/dev/shm` and a root folder for the rest; both are
//! derived from the canonical path of the run folder, so every process of a run finds the same
//! domain without being told.

use std::fs::{self, DirBuilder};
use std::io;
use std::os::unix::ffi::OsStrExt;
use std::os::unix::fs::{DirBuilderExt, MetadataExt};
use std::path::{Path, PathBuf};

use iceoryx2::node::NodeView;
use iceoryx2::prelude::{CallbackProgression, Config, FilePath, NodeState, SemanticString};

/// The flavour of iceoryx2: between processes, ports may be held by several threads.
pub(crate) type Service = iceoryx2::prelude::ipc_threadsafe::Service;

/// Version of everything that crosses a process boundary: headers, layouts, limits of the streams.
pub const PROTOCOL_VERSION: u32 = 5;

/// Folder of the system in which POSIX shared memory appears as files.
pub(crate) const SHARED_MEMORY: &str = "/dev/shm";

/// Folder that holds the roots of all users. A constant instead of `TMPDIR`: processes started from
/// different shells must agree, and socket paths may not exceed 107 bytes.
const TEMPORARY: &str = "/tmp";

/// Where the messages of one run live.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Domain {
    prefix: String,
    root: PathBuf,
    version: u32,
}

/// A process that joined a domain.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Member {
    /// Role under which it joined, for example `actor-3`; empty when its details are gone.
    pub role: String,
    /// Process id; 0 when its details are gone.
    pub process: u32,
    /// False when the process ended without leaving.
    pub alive: bool,
}

/// Why a domain cannot be used or removed.
#[derive(Debug, thiserror::Error)]
pub enum DomainError {
    /// The run folder does not exist or cannot be resolved.
    #[error("run folder {}: create it before its processes start", path.display())]
    RunFolder {
        /// The folder that was named.
        path: PathBuf,
        /// What the system said.
        #[source]
        source: io::Error,
    },
    /// The per-user folder is open to others or belongs to someone else.
    #[error(
        "{} belongs to user {owner} with mode {mode:o}, expected user {user} and 700: remove it or correct it",
        path.display()
    )]
    NotPrivate {
        /// The per-user folder.
        path: PathBuf,
        /// Its owner.
        owner: u32,
        /// Its permission bits.
        mode: u32,
        /// The user of this process.
        user: u32,
    },
    /// A file or folder of the domain cannot be created, read or removed.
    #[error("{}", path.display())]
    Files {
        /// What was touched.
        path: PathBuf,
        /// What the system said.
        #[source]
        source: io::Error,
    },
    /// iceoryx2 refused the configuration or could not list the members.
    #[error("domain {}: {cause}", root.display())]
    Middleware {
        /// Root of the domain.
        root: PathBuf,
        /// What iceoryx2 said.
        cause: String,
    },
    /// The domain may not be removed under a living process.
    #[error("domain {} is still used by {}: stop them first", root.display(), members.join(", "))]
    InUse {
        /// Root of the domain.
        root: PathBuf,
        /// Roles and process ids.
        members: Vec<String>,
    },
}

impl Domain {
    /// The domain of the run in `run_dir`, which must exist. Nothing is created yet.
    pub fn for_run(run_dir: &Path) -> Result<Self, DomainError> {
        let path = run_dir
            .canonicalize()
            .map_err(|source| DomainError::RunFolder {
                path: run_dir.to_owned(),
                source,
            })?;
        let user = rustix::process::getuid().as_raw();
        let key = fnv1a(
            path.as_os_str()
                .as_bytes()
                .iter()
                .chain(&user.to_le_bytes()),
        );
        Ok(Self {
            prefix: format!("ampco_{key:016x}_"),
            root: PathBuf::from(format!("{TEMPORARY}/ampco-{user}/{key:016x}")),
            version: PROTOCOL_VERSION,
        })
    }

    /// The same domain entered by a program that speaks `version`; for tests of the refusal.
    #[doc(hidden)]
    #[must_use]
    pub fn speaking(mut self, version: u32) -> Self {
        self.version = version;
        self
    }

    /// Beginning of the name of each shared-memory segment.
    pub fn prefix(&self) -> &str {
        &self.prefix
    }

    /// Folder of sockets and service files.
    pub fn root(&self) -> &Path {
        &self.root
    }

    /// Version that this program speaks.
    pub(crate) fn version(&self) -> u32 {
        self.version
    }

    /// Everyone who joined and did not leave, the dead included.
    pub fn members(&self) -> Result<Vec<Member>, DomainError> {
        if !self.root.exists() {
            return Ok(Vec::new());
        }
        let listed = members(&self.prepare()?)
            .map_err(|error| self.middleware(format!("listing its members: {error}")))?;
        let mut members: Vec<Member> = listed.into_iter().map(|listed| listed.member).collect();
        members.sort_by(|a, b| (&a.role, a.process).cmp(&(&b.role, b.process)));
        Ok(members)
    }

    /// Removes the root and every segment of shared memory, and says how many files that were.
    ///
    /// Call it before the first process starts (a machine that crashed leaves service files whose
    /// memory is gone) and after the last one ended. Refused while a member is alive.
    pub fn remove(&self) -> Result<usize, DomainError> {
        let members: Vec<String> = self
            .members()?
            .into_iter()
            .filter(|member| member.alive)
            .map(|member| format!("{} (process {})", member.role, member.process))
            .collect();
        if !members.is_empty() {
            let root = self.root.clone();
            return Err(DomainError::InUse { root, members });
        }
        let leftovers = self.leftovers()?;
        for path in &leftovers {
            let removed = if path == &self.root {
                fs::remove_dir_all(path)
            } else {
                fs::remove_file(path)
            };
            ignore_missing(removed).map_err(|source| files(path, source))?;
        }
        Ok(leftovers.len())
    }

    /// What of this domain exists now: its root folder and its shared-memory segments.
    pub fn leftovers(&self) -> Result<Vec<PathBuf>, DomainError> {
        let folder = Path::new(SHARED_MEMORY);
        let mut found = Vec::new();
        for entry in fs::read_dir(folder).map_err(|source| files(folder, source))? {
            let entry = entry.map_err(|source| files(folder, source))?;
            if entry
                .file_name()
                .as_bytes()
                .starts_with(self.prefix.as_bytes())
            {
                found.push(entry.path());
            }
        }
        found.sort();
        if self.root.exists() {
            found.push(self.root.clone());
        }
        Ok(found)
    }

    /// Creates the root and returns the configuration of iceoryx2 for this domain.
    ///
    /// The first domain of a process also becomes iceoryx2's global configuration: the clean-up of
    /// a dead node whose details are gone falls back on it, and would otherwise search elsewhere.
    pub(crate) fn prepare(&self) -> Result<Config, DomainError> {
        self.create_root()?;
        let file = self.root.join("iceoryx2.toml");
        let text = format!(
            "[global]\nroot-path = \"{}\"\nprefix = \"{}\"\n",
            self.root.display(),
            self.prefix
        );
        if fs::read_to_string(&file).ok().as_deref() != Some(&text) {
            // Written aside and renamed, so that a process starting beside us never reads half.
            let aside = self.root.join(format!("iceoryx2.{}", std::process::id()));
            fs::write(&aside, &text).map_err(|source| files(&aside, source))?;
            fs::rename(&aside, &file).map_err(|source| files(&file, source))?;
        }
        let path = FilePath::new(file.as_os_str().as_bytes())
            .map_err(|error| self.middleware(format!("its path: {error:?}")))?;
        let config = Config::from_file(&path)
            .map_err(|error| self.middleware(format!("its configuration: {error}")))?;
        Config::setup_global_config_from_file(&path)
            .map_err(|error| self.middleware(format!("the global configuration: {error}")))?;
        Ok(config)
    }

    fn create_root(&self) -> Result<(), DomainError> {
        let home = self.root.parent().expect("a root has a per-user folder");
        for folder in [home, &self.root] {
            let created = DirBuilder::new().mode(0o700).create(folder);
            ignore_existing(created).map_err(|source| files(folder, source))?;
        }
        // /tmp is open to everyone: someone else's folder of this name must not receive our sockets.
        let facts = fs::symlink_metadata(home).map_err(|source| files(home, source))?;
        let user = rustix::process::getuid().as_raw();
        if !facts.is_dir() || facts.uid() != user || facts.mode() & 0o077 != 0 {
            return Err(DomainError::NotPrivate {
                path: home.to_owned(),
                owner: facts.uid(),
                mode: facts.mode() & 0o7777,
                user,
            });
        }
        Ok(())
    }

    fn middleware(&self, cause: String) -> DomainError {
        let root = self.root.clone();
        DomainError::Middleware { root, cause }
    }
}

/// A member and the name under which iceoryx2 keeps it.
pub(crate) struct Listed {
    pub(crate) id: String,
    pub(crate) member: Member,
}

/// Everyone in the domain of `config`, in no order.
pub(crate) fn members(config: &Config) -> Result<Vec<Listed>, String> {
    let mut members = Vec::new();
    iceoryx2::node::Node::<Service>::list(config, |state| {
        let (id, details, alive) = match &state {
            NodeState::Alive(node) => (node.id(), node.details().as_ref(), true),
            NodeState::Dead(node) => (node.id(), node.details().as_ref(), false),
            NodeState::Inaccessible(id) | NodeState::Undefined(id) => (id, None, false),
        };
        members.push(Listed {
            id: id.value().to_string(),
            member: Member {
                role: details.map_or_else(String::new, |d| d.name().to_string()),
                process: details.map_or(0, |d| d.process_id().value().unsigned_abs()),
                alive,
            },
        });
        CallbackProgression::Continue
    })
    .map_err(|error| format!("{error:?}"))?;
    Ok(members)
}

fn files(path: &Path, source: io::Error) -> DomainError {
    let path = path.to_owned();
    DomainError::Files { path, source }
}

fn ignore_missing(result: io::Result<()>) -> io::Result<()> {
    match result {
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(()),
        other => other,
    }
}

fn ignore_existing(result: io::Result<()>) -> io::Result<()> {
    match result {
        Err(error) if error.kind() == io::ErrorKind::AlreadyExists => Ok(()),
        other => other,
    }
}

/// FNV-1a, 64 bits: short, stable between builds, and no secret is at stake.
fn fnv1a<'a>(bytes: impl Iterator<Item = &'a u8>) -> u64 {
    bytes.fold(0xcbf2_9ce4_8422_2325, |hash, byte| {
        (hash ^ u64::from(*byte)).wrapping_mul(0x0000_0100_0000_01b3)
    })
}

#[cfg(test)]
mod tests;

//! Noticing deaths cheaply.
//!
//! Separate because asking iceoryx2 who is dead reads several files per member, about 0.1 ms each:
//! with 66 processes doing so ten times a second, the looking alone would keep several cores busy.
//! The kernel tells it for one system call, through a descriptor of each process.

use std::collections::BTreeMap;
use std::fs;
use std::os::fd::OwnedFd;
use std::path::PathBuf;
use std::time::{Duration, Instant};

use rustix::event::{PollFd, PollFlags, Timespec, poll};
use rustix::process::{Pid, PidfdFlags, pidfd_open};

/// Time between two looks that trust nobody: for members whose process cannot be watched.
const THOROUGH: Duration = Duration::from_secs(10);

/// The members of a domain, each with its process where that can be watched.
#[derive(Debug)]
pub(crate) struct Watch {
    /// Folder with an entry per member, named by its id in digits.
    folder: PathBuf,
    members: BTreeMap<String, Option<OwnedFd>>,
    thorough: Instant,
}

impl Watch {
    /// Watches nobody yet; `folder` is where iceoryx2 keeps its nodes.
    pub(crate) fn new(folder: PathBuf) -> Self {
        Self {
            folder,
            members: BTreeMap::new(),
            thorough: Instant::now() + THOROUGH,
        }
    }

    /// Whether a member may have died since the last look. `list` names the members and their
    /// processes; it is asked only when somebody is new.
    pub(crate) fn suspects(&mut self, list: impl FnOnce() -> Vec<(String, u32)>) -> bool {
        let now = Instant::now();
        if now >= self.thorough {
            self.thorough = now + THOROUGH;
            // Whoever could not be watched gets another chance.
            self.members.retain(|_, process| process.is_some());
            return true;
        }
        let present = self.present();
        self.members.retain(|id, _| present.contains(id));
        if present.iter().any(|id| !self.members.contains_key(id)) {
            let mut listed: BTreeMap<String, u32> = list().into_iter().collect();
            for id in present {
                let process = listed.remove(&id);
                self.members
                    .entry(id)
                    .or_insert_with(|| process.and_then(descriptor));
            }
        }
        self.ended()
    }

    fn present(&self) -> Vec<String> {
        let Ok(entries) = fs::read_dir(&self.folder) else {
            return Vec::new();
        };
        entries
            .filter_map(|entry| entry.ok()?.file_name().into_string().ok())
            .filter(|name| name.bytes().all(|byte| byte.is_ascii_digit()))
            .collect()
    }

    /// Forgets the members whose process ended, and says whether there were any.
    fn ended(&mut self) -> bool {
        let watched: Vec<(&String, &OwnedFd)> = self
            .members
            .iter()
            .filter_map(|(id, process)| Some((id, process.as_ref()?)))
            .collect();
        let mut polled: Vec<PollFd<'_>> = watched
            .iter()
            .map(|(_, process)| PollFd::new(process, PollFlags::IN))
            .collect();
        let at_once = Timespec::default();
        if poll(&mut polled, Some(&at_once)).is_err() {
            return false;
        }
        let ended: Vec<String> = watched
            .iter()
            .zip(&polled)
            .filter(|(_, poll)| !poll.revents().is_empty())
            .map(|((id, _), _)| (*id).clone())
            .collect();
        for id in &ended {
            self.members.remove(id);
        }
        !ended.is_empty()
    }
}

/// A descriptor that becomes readable when the process ends.
fn descriptor(process: u32) -> Option<OwnedFd> {
    let process = Pid::from_raw(process.try_into().ok()?)?;
    pidfd_open(process, PidfdFlags::empty()).ok()
}

#[cfg(test)]
mod tests {
    use std::process::{Child, Command, Stdio};

    use super::*;

    fn sleeper() -> Child {
        // Reads its standard input until that closes.
        let mut command = Command::new("cat");
        command.stdin(Stdio::piped()).stdout(Stdio::null());
        command.spawn().unwrap()
    }

    #[test]
    fn a_death_is_suspected_once_and_life_never() {
        let folder = tempfile::tempdir().unwrap();
        fs::create_dir(folder.path().join("101")).unwrap();
        fs::create_dir(folder.path().join("102")).unwrap();
        fs::write(folder.path().join("run_101.monitor"), "").unwrap(); // no member
        let (mut dying, mut living) = (sleeper(), sleeper());
        let list = || {
            vec![
                ("101".to_owned(), dying.id()),
                ("102".to_owned(), living.id()),
            ]
        };
        let mut watch = Watch::new(folder.path().to_owned());
        let nobody_is_new = || unreachable!("nobody is new");
        assert!(!watch.suspects(list));
        assert!(!watch.suspects(nobody_is_new));

        dying.kill().unwrap();
        dying.wait().unwrap();
        assert!(watch.suspects(nobody_is_new));
        // Its entry is still there, as after a clean-up that failed: it is asked for again, cannot
        // be watched, and is left to the thorough look.
        assert!(!watch.suspects(|| vec![("101".to_owned(), dying.id())]));
        assert!(!watch.suspects(nobody_is_new));

        living.kill().unwrap();
        living.wait().unwrap();
        assert!(watch.suspects(nobody_is_new));
    }
}

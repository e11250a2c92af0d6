//! A shell that has every place outside its test's folder to itself.
//!
//! Separate because of what is at stake: programs keep sockets under /tmp/ampco-<user> and messages in /dev/shm. In a
//! namespace the user's number is another one (0, or 65534 for one without a number), and the folder of that number may
//! belong to somebody else; nor may a test leave one behind for others.

use std::path::Path;
use std::process::Command;

use super::program;

/// Makes the places; afterwards /tmp is the test's folder, and /dev/shm vanishes with the last program.
const OWN_PLACES: &str = r#"
mkdir -p "$PLACE/programs" &&
mount --bind "$PROGRAMS" "$PLACE/programs" &&
mount --rbind "$PLACE" /tmp &&
mount -t tmpfs tmpfs /dev/shm || exit 9
AMPCO=/tmp/programs/ampco
"#;

/// `unshare`, to run a script as root of a user namespace of its own. In it `/tmp` is `place`, so that what is written to
/// /tmp/x is `place/x` outside, and `$AMPCO` is the program.
pub(crate) fn enclosed(place: &Path, script: &str) -> Command {
    within(place, &["--user", "--map-root-user", "--mount"], script)
}

/// The same without a network but what the script makes.
pub(crate) fn enclosed_alone(place: &Path, script: &str) -> Command {
    let own = ["--user", "--map-root-user", "--mount", "--net"];
    within(place, &own, script)
}

fn within(place: &Path, own: &[&str], script: &str) -> Command {
    let programs = program("ampco");
    let mut command = Command::new("unshare");
    command
        .args(own)
        .args(["sh", "-c"])
        .arg(format!("{OWN_PLACES}{script}"))
        .env("PLACE", place)
        .env("PROGRAMS", programs.parent().expect("a folder of programs"))
        .current_dir("/");
    command
}

/// Whether a sandbox of the kernel was refused: a test that needs one can then not be held.
pub(crate) fn has_no_namespaces(said: &str) -> bool {
    let refused = said.contains("unshare:") || said.contains("mount:");
    // The message says which.
    assert!(
        !refused || said.contains("ermitted") || said.contains("denied"),
        "{said}"
    );
    if refused {
        needs::absent(&format!("no namespaces of one's own: {}", said.trim()));
    }
    refused
}

//! Verdicts over programs that ended, and their names.

use super::*;
use std::os::unix::process::ExitStatusExt;

const LONG: Duration = Duration::from_secs(60);
const SHORT: Duration = Duration::from_secs(1);

// A wait status holds the signal in its low seven bits and the exit code in the next byte.
fn killed() -> ExitStatus {
    ExitStatus::from_raw(9)
}

fn failed(code: i32) -> ExitStatus {
    ExitStatus::from_raw(code << 8)
}

/// So many lives of this length, one after the other, with work done in them or not.
fn lives(count: u32, lived: Duration, worked: bool) -> Lives {
    (0..count).fold(Lives::default(), |lives, _| lives.after(lived, worked))
}

#[test]
fn who_never_comes_to_work_comes_back_less_and_less_readily() {
    let again = |count| verdict(killed(), lives(count, SHORT, false), count - 1);
    assert_eq!(again(1), Verdict::Restart(Duration::from_millis(100)));
    assert_eq!(again(2), Verdict::Restart(Duration::from_millis(200)));
    assert_eq!(again(4), Verdict::Restart(Duration::from_millis(800)));
    assert_eq!(again(5), Verdict::GiveUp);
}

#[test]
fn who_works_comes_back_at_once_however_often_it_is_killed() {
    let at_once = Verdict::Restart(Duration::from_millis(100));
    for count in [1, 5, 39] {
        let lives = lives(count, SHORT, true);
        assert_eq!(verdict(killed(), lives, count - 1), at_once, "{count}");
    }
    // Unless every one of very many lives was brief.
    assert_eq!(
        verdict(killed(), lives(40, SHORT, true), 39),
        Verdict::GiveUp
    );
    assert_eq!(verdict(killed(), lives(500, LONG, true), 499), at_once);
}

#[test]
fn a_first_start_that_says_what_is_wrong_is_not_repeated() {
    let first = |status, lived, worked| verdict(status, lives(1, lived, worked), 0);
    assert_eq!(first(failed(1), SHORT, false), Verdict::GiveUp);
    assert_eq!(first(failed(2), SHORT, false), Verdict::GiveUp);
    // A panic is a bug, and may be one of chance.
    assert_ne!(first(failed(101), SHORT, false), Verdict::GiveUp);
    // After work was done, or long after the start, the same failure is an accident.
    assert_ne!(first(failed(1), SHORT, true), Verdict::GiveUp);
    assert_ne!(first(failed(1), LONG, false), Verdict::GiveUp);
    let again = verdict(failed(1), lives(1, SHORT, false), 1);
    assert_ne!(again, Verdict::GiveUp);
}

#[test]
fn who_ends_well_is_not_started_again() {
    assert_eq!(verdict(failed(0), lives(1, SHORT, false), 0), Verdict::Done);
}

#[test]
fn ends_are_named() {
    assert_eq!(describe(killed()), "was killed by signal 9 (SIGKILL)");
    // A real-time signal has no name.
    let nameless = ExitStatus::from_raw(40);
    assert_eq!(describe(nameless), "was killed by signal 40");
    assert_eq!(describe(failed(3)), "failed with status 3");
}

#[test]
fn an_empty_log_is_not_pointed_to() {
    let folder = tempfile::tempdir().unwrap();
    let log = folder.path().join("learner.log");
    let of = |status, said, before| account(status, said, &log, before);
    let missing = of(killed(), None, 0);
    assert!(
        missing.starts_with("was killed by signal 9 (SIGKILL); somebody sent it, or the kernel")
    );
    assert!(
        missing.ends_with("learner.log was never made") && !missing.contains("see "),
        "{missing}"
    );
    std::fs::write(&log, "").unwrap();
    let empty = of(failed(1), None, 0);
    assert!(
        empty.starts_with("failed with status 1; it said nothing and "),
        "{empty}"
    );
    assert!(
        empty.ends_with("learner.log is empty") && !empty.contains("see "),
        "{empty}"
    );
    let spoken = of(failed(1), Some("no motion"), 0);
    assert_eq!(spoken, "failed with status 1: no motion");
    std::fs::write(&log, "0123456789").unwrap();
    let silent = of(failed(3), None, 10);
    assert!(silent.contains("nothing of this time is in "), "{silent}");
    let logged = of(failed(3), None, 4);
    assert_eq!(
        logged,
        format!("failed with status 3; see {}", log.display())
    );
    let both = of(failed(3), Some("no"), 4);
    assert_eq!(
        both,
        format!("failed with status 3: no; see {}", log.display())
    );
}

#[test]
fn last_words_are_the_complaint_or_the_last_line_of_this_life() {
    let folder = tempfile::tempdir().unwrap();
    let log = folder.path().join("run.log");
    assert_eq!(last_words(&log, 0), None);
    let old = "ampco: an old complaint\n";
    std::fs::write(&log, old).unwrap();
    assert_eq!(last_words(&log, old.len() as u64), None);
    std::fs::write(&log, format!("{old}one\ntwo\n\n")).unwrap();
    assert_eq!(last_words(&log, old.len() as u64).unwrap(), "two");
    std::fs::write(&log, format!("{old}ampco: no disk\ntwo\n")).unwrap();
    assert_eq!(
        last_words(&log, old.len() as u64).unwrap(),
        "ampco: no disk"
    );
    assert_eq!(last_words(&log, 1_000), None);
}

#[test]
fn a_program_that_was_not_built_is_named_with_the_remedy() {
    let error = program("ampco-nothing").unwrap_err().to_string();
    assert!(
        error.contains("ampco-nothing") && error.contains("local.sh"),
        "{error}"
    );
}

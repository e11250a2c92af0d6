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

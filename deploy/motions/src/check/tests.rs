//! Sets of clips, checked.

use super::*;
use motion::gait;

#[test]
fn speeds_are_counted_in_quarters_of_a_metre_per_second() {
    let clips = [
        gait::walk(0.6).unwrap().unrolled(10.0),
        gait::walk(1.6).unwrap().unrolled(1.0),
    ];
    let seconds = seconds_at(clips.iter());
    assert!(seconds[2] > 9.5 && seconds[6] > 0.9, "{seconds:?}");
    // Nothing from 0.75 to 1.5; a second at 1.6 is more than a fifth of an even share, 0.4 s.
    assert_eq!(rare(&seconds), [3, 4, 5]);
    assert!(rare(&[0.0, 3.0, 4.0]).is_empty());
    assert!(rare(&[]).is_empty());
}

/// What is found in a walk that is changed from a frame on.
fn faults(from: usize, change: impl Fn(&mut g1::RobotState)) -> Faults {
    let mut clip = gait::walk(1.0).unwrap().unrolled(2.0);
    clip.frames[from..].iter_mut().for_each(change);
    let quality = motion::Quality::of(&clip);
    let found = motion::quality::defects(&clip, &quality, &motion::quality::Account::None);
    Faults {
        clips: vec![("a".into(), found)],
        ..Faults::default()
    }
}

#[test]
fn what_is_unfit_decides_and_what_is_odd_is_told() {
    assert_eq!(Faults::default().verdict(), None);
    let unfit = faults(50, |frame| frame.position.y += 5.0);
    assert!(unfit.verdict().unwrap().contains("1 unfit"));
    let rows = unfit.rows();
    assert_eq!(rows[0]["clip"], "a");
    assert_eq!(rows[0]["kind"], "teleport");
    assert_eq!(rows[0]["severity"], "unfit");
    assert_eq!(rows[0]["frames"]["worst"], 51);
    let odd = faults(0, |frame| frame.position.z -= 0.02);
    assert_eq!((odd.verdict(), odd.with(Severity::Odd)), (None, 1));
    assert_eq!(odd.rows()[0]["kind"], "penetration");
    let mut out = Vec::new();
    show(&mut out, &[], &[], &[], &odd).unwrap();
    assert!(
        String::from_utf8(out)
            .unwrap()
            .contains("a: odd\n    soles are")
    );
}

#[test]
fn no_clips_last_no_time_and_not_less() {
    let (mut out, faults) = (Vec::new(), Faults::default());
    show(&mut out, &[], &[], &[], &faults).unwrap();
    let text = String::from_utf8(out).unwrap();
    assert!(text.starts_with("0 clips, 0.0 min\n"), "{text}");
    let text = summary(&[], &[], &[], &faults).to_string();
    assert!(text.contains("\"seconds\":0.0,"), "{text}");
}

#[test]
fn rare_speeds_in_a_row_are_one_line() {
    let mut seconds = vec![5.0, 5.0];
    seconds.resize(400, 0.0);
    seconds.push(5.0);
    let mut out = Vec::new();
    let rare = rare(&seconds);
    show(&mut out, &[], &seconds, &rare, &Faults::default()).unwrap();
    let text = String::from_utf8(out).unwrap();
    assert!(
        text.contains("0.50–100.00      0.0    0.0 %    rare"),
        "{text}"
    );
    assert_eq!(text.lines().count(), 2 + 2 + 1 + 1 + 1, "{text}"); // heads, even, rare, even, a remedy
}

#[test]
fn files_that_cannot_be_used_and_doubles_are_defects_of_the_set() {
    let set = Faults {
        unreadable: vec![("b".into(), "b.csv: holds nothing".into())],
        doubles: vec![("c".into(), "c holds the same joint angles as a".into())],
        ..Faults::default()
    };
    assert_eq!(
        set.verdict().unwrap(),
        "of these clips 1 unreadable, 1 there twice"
    );
    let kinds: Vec<Value> = set.rows().iter().map(|row| row["kind"].clone()).collect();
    assert_eq!(kinds, ["unreadable", "double"]);
}

#[test]
fn the_same_clip_twice_is_found() {
    let walk = gait::walk(1.0).unwrap();
    let other = gait::walk(1.1).unwrap();
    assert!(doubles(&[walk.clone(), other]).is_empty());
    assert_eq!(doubles(&[walk.clone(), walk]).len(), 1);
}

//! Soles and the ground.

use super::*;

#[test]
fn a_flight_longer_than_any_jump_is_named() {
    // 60 frames, 1.2 s, at 10 cm, reached and left within ten frames.
    let hover = |frames: usize| {
        standing(150, |i, frame| {
            let up = (i as f32 - 20.0).min(20.0 + 10.0 + frames as f32 + 10.0 - i as f32);
            frame.position.z += 0.01 * up.clamp(0.0, 10.0);
        })
    };
    let defect = found(&hover(60), Kind::Flight);
    assert_eq!(defect.severity, Severity::Unfit);
    // Above 3 cm from the fourth frame of the rise on, to the fourth last of the fall.
    assert_eq!((defect.frames.first, defect.frames.last), (25, 97));
    assert!(
        (defect.value - 73.0 * 0.02).abs() < 1e-9,
        "{}",
        defect.value
    );
    assert!(!kinds(&hover(30)).contains(&Kind::Flight)); // 0.86 s
}

#[test]
fn a_drifting_floor_is_named() {
    // 1 cm a second for 10 s; the lowest of the first second is the first frame, of the last second 0.98 s before.
    let drift = standing(501, |i, frame| frame.position.z += 0.0002 * i as f32);
    let defect = found(&drift, Kind::Drift);
    assert_eq!(defect.severity, Severity::Unfit);
    assert!(
        (defect.value - 0.0002 * 451.0).abs() < 1e-5,
        "{}",
        defect.value
    );
    assert!(defect.says.contains("rises by 9 cm"), "{}", defect.says);
    // A third as fast it is a slope of 3 cm.
    let slow = standing(501, |i, frame| frame.position.z += 0.00007 * i as f32);
    assert_eq!(found(&slow, Kind::Drift).severity, Severity::Odd);
    let sinking = standing(501, |i, frame| {
        frame.position.z += 0.0002 * (500 - i) as f32
    });
    assert!(found(&sinking, Kind::Drift).says.contains("sinks"));
    // And under a walk.
    let mut walk = walk(1.0, 10.0);
    for (i, frame) in walk.frames.iter_mut().enumerate() {
        frame.position.z += 0.0002 * i as f32;
    }
    assert!(kinds(&walk).contains(&Kind::Drift));
}

#[test]
fn soles_in_the_ground_above_it_and_along_it_are_named() {
    let sunk = |by: f32| standing(100, |_, frame| frame.position.z -= by);
    let defect = found(&sunk(0.02), Kind::Penetration);
    assert_eq!(defect.severity, Severity::Odd);
    assert!((defect.value - 0.02).abs() < 1e-4);
    assert_eq!(
        found(&sunk(0.05), Kind::Penetration).severity,
        Severity::Unfit
    );
    let afloat = standing(30, |_, frame| frame.position.z += 0.3);
    assert!((found(&afloat, Kind::Float).value - 0.3).abs() < 1e-4);
    let sliding =
        |speed: f32| standing(100, |i, frame| frame.position.y += 0.02 * speed * i as f32);
    let defect = found(&sliding(0.3), Kind::Slip);
    assert_eq!(defect.severity, Severity::Odd);
    assert!((defect.value - 0.3).abs() < 1e-3);
    assert_eq!(found(&sliding(0.6), Kind::Slip).severity, Severity::Unfit);
    assert_eq!(found(&standing(10, |_, _| ()), Kind::Short).value, 0.18);
}

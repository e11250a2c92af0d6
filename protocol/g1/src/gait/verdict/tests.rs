//! Which gait is called what.

use super::*;

/// A good walk at 0.8 m/s.
const WALK: Signs = Signs {
    seconds_upright: Some(20.0),
    speeds: Some((0.8, 0.75)),
    turns: None,
    drift: 0.02,
    swerve: 0.02,
    sideways: false,
    hip_correlation: Some(-0.8),
    contact_correlation: Some(-0.6),
    stride_rate: 1.0,
    flight_share: 0.0,
    pelvis_height: 0.75,
};

fn said(signs: Signs) -> String {
    Verdict::of(&signs).to_string()
}

#[test]
fn what_is_asked_for_is_good() {
    let run = Signs {
        flight_share: 0.15,
        ..WALK
    };
    let stand = Signs {
        speeds: None,
        drift: 0.01,
        hip_correlation: Some(0.9), // both hips sway together, which is no hop
        stride_rate: 0.0,
        ..WALK
    };
    for (signs, word) in [(WALK, "walk"), (run, "run"), (stand, "stand")] {
        assert_eq!(said(signs), word);
        assert!(Verdict::of(&signs).is_good());
    }
}

#[test]
fn what_averages_do_not_see_is_said() {
    let hop = Signs {
        hip_correlation: Some(0.94),
        ..WALK
    };
    assert_eq!(said(hop), "hop: hips in phase (+0.94)");
    let still = Signs {
        speeds: Some((0.8, 0.02)),
        hip_correlation: None,
        stride_rate: 0.0,
        ..WALK
    };
    assert_eq!(said(still), "still: 0.02 of 0.80 m/s");
    let crawl = Signs {
        speeds: Some((0.8, 0.3)),
        ..WALK
    };
    assert_eq!(said(crawl), "crawl: 0.30 of 0.80 m/s");
    let backward = Signs {
        speeds: Some((0.8, -0.3)),
        ..WALK
    };
    assert_eq!(said(backward), "still: -0.30 of 0.80 m/s");
    let crouch = Signs {
        pelvis_height: 0.6,
        ..WALK
    };
    assert_eq!(said(crouch), "crouch: pelvis at 0.60 m");
    let shuffle = Signs {
        hip_correlation: Some(0.05),
        ..WALK
    };
    assert_eq!(said(shuffle), "shuffle: legs do not alternate (+0.05)");
    let fall = Signs {
        seconds_upright: Some(0.66),
        ..hop
    };
    assert_eq!(said(fall), "fall: after 0.7 s");
    for signs in [hop, still, crawl, crouch, shuffle, fall] {
        assert!(!Verdict::of(&signs).is_good());
    }
}

#[test]
fn too_much_is_not_what_was_asked_for_either() {
    let of = |asked: f64, done: f64| Signs {
        speeds: Some((asked, done)),
        ..WALK
    };
    assert_eq!(said(of(0.8, 1.3)), "rush: 1.30 of 0.80 m/s"); // above 1.2
    assert_eq!(said(of(0.8, 1.15)), "walk");
    // Of next to nothing half as much again is nothing: up to 0.1 m/s more is let pass.
    assert_eq!(said(of(0.1, 0.19)), "walk");
    assert_eq!(said(of(0.1, 0.21)), "rush: 0.21 of 0.10 m/s");
    let spun = Signs {
        speeds: None,
        turns: Some((1.0, 1.6)),
        ..WALK
    };
    assert_eq!(said(spun), "rush: 1.60 of 1.00 rad/s");
}

#[test]
fn a_turn_wants_steps_and_no_hop() {
    let turn = Signs {
        speeds: None,
        turns: Some((0.8, 0.7)),
        hip_correlation: Some(0.5),
        ..WALK
    };
    assert_eq!(said(turn), "turn");
    assert!(Verdict::of(&turn).is_good());
    let hop = Signs {
        contact_correlation: Some(0.6),
        ..turn
    };
    assert_eq!(said(hop), "hop: feet land together (+0.60)");
    let slide = Signs {
        stride_rate: 0.1,
        contact_correlation: None,
        ..turn
    };
    assert_eq!(said(slide), "shuffle: legs do not alternate (+0.00)");
    let crawl = Signs {
        turns: Some((0.8, 0.3)),
        ..turn
    };
    assert_eq!(said(crawl), "crawl: 0.30 of 0.80 rad/s");
    for signs in [hop, slide, crawl] {
        assert!(!Verdict::of(&signs).is_good());
    }
}

#[test]
fn a_way_may_be_off_by_a_quarter_of_its_speed_and_a_fifth_of_a_radian_per_second() {
    let run = Signs {
        speeds: Some((2.0, 1.9)),
        flight_share: 0.15,
        ..WALK
    };
    let off = |drift, swerve| Signs {
        drift,
        swerve,
        ..run
    };
    assert_eq!(said(off(0.49, 0.19)), "run");
    assert_eq!(said(off(0.51, 0.19)), "sidle: 0.51 m/s off its way");
    assert_eq!(
        said(off(0.49, 0.21)),
        "veer: 0.21 rad/s, asked to go straight"
    );
    let curve = |turned| Signs {
        turns: Some((0.5, turned)),
        ..run
    };
    assert_eq!(said(curve(0.26)), "run");
    assert_eq!(said(curve(0.24)), "veer: 0.24 of 0.50 rad/s");
    // Half as much again is 0.75.
    assert_eq!(said(curve(0.74)), "run");
    assert_eq!(said(curve(0.76)), "veer: 0.76 of 0.50 rad/s");
}

#[test]
fn standing_on_request_is_told_from_stepping_and_drifting() {
    let stay = Signs {
        speeds: None,
        drift: 0.01,
        stride_rate: 1.2,
        ..WALK
    };
    assert_eq!(said(stay), "step in place: 1.2 strides/s, asked to stand");
    let drift = Signs { drift: 0.2, ..stay };
    assert_eq!(said(drift), "drift: 0.20 m/s, asked to stay");
    let spin = Signs {
        swerve: 0.2,
        ..stay
    };
    assert_eq!(said(spin), "spin: 0.20 rad/s, asked to stay");
    for signs in [stay, drift, spin] {
        assert!(!Verdict::of(&signs).is_good());
    }
}

#[test]
fn sideways_the_contacts_tell() {
    let side = Signs {
        sideways: true,
        hip_correlation: Some(0.8),
        ..WALK
    };
    assert_eq!(said(side), "walk");
    let jump = Signs {
        contact_correlation: Some(0.7),
        ..side
    };
    assert_eq!(said(jump), "hop: feet land together (+0.70)");
}

#[test]
fn a_robot_that_stands_still_with_both_hips_swaying_does_not_hop() {
    let sway = Signs {
        speeds: Some((0.8, 0.01)),
        hip_correlation: Some(0.9),
        stride_rate: 0.0,
        ..WALK
    };
    assert_eq!(said(sway), "still: 0.01 of 0.80 m/s");
}

#[test]
fn signs_are_read_from_the_sums() {
    let (mut gait, mut pace) = (Gait::default(), Pace::default());
    let mut features = [0.0; crate::FEATURES];
    features[0] = 0.7;
    for (left, forces) in [(0.3, [300.0, 0.0]), (-0.3, [0.0, 300.0])] {
        features[7] = left;
        features[13] = -left;
        gait.add(&features, forces, None);
        pace.add([0.5, 0.0, 0.5], [0.4, 0.05, 0.45]);
    }
    let signs = Signs::of(&gait, &pace, Some(20.0), 50.0);
    let (asked, speed) = signs.speeds.unwrap();
    assert!((asked - 0.5).abs() < 1e-6 && (speed - 0.4).abs() < 1e-6);
    let (asked, turned) = signs.turns.unwrap();
    assert!((asked - 0.5).abs() < 1e-6 && (turned - 0.45).abs() < 1e-6);
    assert!((signs.drift - 0.05).abs() < 1e-6 && signs.swerve == 0.0);
    assert!((signs.pelvis_height - 0.7).abs() < 1e-6);
    assert!(signs.hip_correlation.unwrap() < -0.99);
    assert_eq!(Verdict::of(&signs), Verdict::Walk);
}

//! The path of a foot: no step, no slip, no scuff.

use super::super::way::Change;
use super::*;
use crate::velocity::Velocity;

/// A stride of 1 m in 1 s.
const WAY: Way = Way {
    velocity: Velocity {
        forward: 1.0,
        lateral: 0.0,
        yaw_rate: 0.0,
    },
    period: 1.0,
    change: Change::Steady,
};

/// Ahead, aside and turning at once.
const CURVE: Way = Way {
    velocity: Velocity {
        forward: 0.6,
        lateral: 0.3,
        yaw_rate: -0.8,
    },
    ..WAY
};

fn path() -> FootPath {
    FootPath {
        rocker: Rocker {
            stance: 0.6,
            contact_pitch: -0.2,
            heel_share: 0.1,
            toe_off_pitch: 0.5,
            toe_share: 0.2,
        },
        footing: Footing {
            centre: 0.0,
            half_width: 0.1,
            shift: 0.0,
        },
        swing_x: Harmonics::still(0.0),
        swing_lift: Harmonics::still(0.0),
        swing_pitch: Harmonics::still(0.0),
        clearance: 0.04,
    }
}

fn edge(sole: Sole, x: f64) -> (f64, f64) {
    let (sin, cos) = sole.pitch.sin_cos();
    (
        sole.x + x * cos - SOLE_DEPTH * sin,
        sole.z - x * sin - SOLE_DEPTH * cos,
    )
}

#[test]
fn the_touching_edge_moves_back_with_the_ground() {
    // A stride of 1 m: the ground passes at 1 m per unit of phase. Flat, the ankle is at
    // 0.3 − φ and stands 35 mm high; the heel is 50 mm behind it and the toe 120 mm ahead.
    for (phase, x) in [(0.0, HEEL), (0.05, HEEL), (0.5, TOE), (0.59, TOE)] {
        let (forward, height) = edge(path().at(Side::Right, phase, &WAY), x);
        assert!((forward - (0.3 - phase + x)).abs() < 1e-12, "phase {phase}");
        assert!(height.abs() < 1e-12, "phase {phase}");
    }
    let flat = path().at(Side::Right, 0.25, &WAY);
    assert!((flat.x - 0.05).abs() < 1e-12 && (flat.z - 0.035).abs() < 1e-12);
    assert_eq!(flat.pitch, 0.0);
}

#[test]
fn swing_joins_stance_without_a_step() {
    let h = 1e-6;
    for (way, phase) in [(WAY, 0.6), (WAY, 1.0), (CURVE, 0.6), (CURVE, 2.0)] {
        let [a, b, c, d] =
            [-2.0 * h, -h, h, 2.0 * h].map(|d: f64| path().at(Side::Right, phase + d, &way));
        for get in [
            |s: Sole| s.x,
            |s: Sole| s.y,
            |s: Sole| s.z,
            |s: Sole| s.yaw,
            |s: Sole| s.pitch,
        ] {
            assert!((get(c) - get(b)).abs() < 1e-4, "position at {phase}");
            let (before, after) = ((get(b) - get(a)) / h, (get(d) - get(c)) / h);
            assert!((before - after).abs() < 0.05, "{before} {after} at {phase}");
        }
    }
}

#[test]
fn swing_clears_the_ground() {
    for i in 1..40 {
        let sole = path().at(Side::Left, 0.1 + 0.01 * f64::from(i), &CURVE);
        let lowest = edge(sole, HEEL).1.min(edge(sole, TOE).1);
        assert!(lowest > 0.0, "{sole:?}");
    }
    let middle = path().at(Side::Left, 0.3, &CURVE);
    let (heel, toe) = (edge(middle, HEEL).1, edge(middle, TOE).1);
    assert!(heel.min(toe) > 0.035); // 4 cm asked for in mid-swing
}

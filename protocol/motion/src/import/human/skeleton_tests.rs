//! Skeletons whose names say nothing, and feet without toes.

use super::tests::STANDING;
use super::*;
use std::path::Path;

/// A whole skeleton of a human that stands and faces x, z up, m: parent and place. Hips, spine, chest,
/// neck, head; on each side a clavicle before the arm, a hand with two fingers, a foot with a toe.
fn skeleton() -> (Vec<Option<usize>>, Vec<[f64; 3]>) {
    let mut parents = vec![None, Some(0), Some(1), Some(2), Some(3)];
    let mut places = vec![
        [0.0, 0.0, 0.95],
        [0.0, 0.0, 1.1],
        [0.0, 0.0, 1.35],
        [0.0, 0.0, 1.5],
        [0.03, 0.0, 1.7],
    ];
    for side in [&STANDING[..7], &STANDING[7..]] {
        let at = places.len();
        let [hip, knee, ankle, toe, shoulder, elbow, wrist] = std::array::from_fn(|i| side[i].1);
        let clavicle = [0.0, shoulder[1] / 4.0, 1.42];
        let finger = |k: f64| [wrist[0] + 0.02 * k, wrist[1], wrist[2] - 0.1];
        for (parent, place) in [
            (0, hip),
            (at, knee),
            (at + 1, ankle),
            (at + 2, toe),
            (2, clavicle),
            (at + 4, shoulder),
            (at + 5, elbow),
            (at + 6, wrist),
            (at + 7, finger(0.0)),
            (at + 7, finger(1.0)),
        ] {
            parents.push(Some(parent));
            places.push(place);
        }
    }
    (parents, places)
}

fn joints(names: &dyn Fn(usize) -> String, turn: impl Fn([f64; 3]) -> [f64; 3]) -> Joints {
    let (parents, places) = skeleton();
    Joints {
        names: (0..places.len()).map(names).collect(),
        frames: vec![places.iter().map(|p| Vector3::from(turn(*p))).collect(); 4],
        parents,
        ..Joints::default()
    }
}

fn read(joints: &Joints) -> Result<(Capture, Vec<String>), String> {
    let file = File {
        path: Path::new("human.bvh"),
        bytes: b"",
    };
    let mut decisions = Vec::new();
    let capture = capture(&file, joints, 30.0, &mut decisions).map_err(|e| e.to_string())?;
    Ok((capture, decisions))
}

fn standing() -> Vec<Point3<f64>> {
    STANDING.iter().map(|(_, p)| Point3::from(*p)).collect()
}

#[test]
fn joints_without_telling_names_are_found_by_how_they_hang_together() {
    for turn in [
        |[x, y, z]: [f64; 3]| [x, y, z],
        // y up, facing −z, and facing −x with z up.
        |[x, y, z]: [f64; 3]| [-y, z, -x],
        |[x, y, z]: [f64; 3]| [-x, -y, z],
    ] {
        let (capture, told) = read(&joints(&|i| format!("joint_{i}"), turn)).unwrap();
        assert!(
            told[0].contains("by the hierarchy") && told[0].contains("hip joint_5"),
            "{told:?}"
        );
        let (expected, _) = {
            let mut named = joints(&|i| format!("joint_{i}"), turn);
            for (k, (name, _)) in STANDING.iter().enumerate() {
                let at = if k < 7 { 5 + k } else { 15 + k - 7 };
                // The clavicle stands between the toe and the arm.
                named.names[if k % 7 < 4 { at } else { at + 1 }] = (*name).into();
            }
            read(&named).unwrap()
        };
        assert_eq!(capture, expected);
    }
    let (capture, _) = read(&joints(&|i| format!("b{i}"), |p| p)).unwrap();
    for (point, expected) in capture.frames[0].0.iter().zip(standing()) {
        assert!((point - expected).norm() < 1e-9, "{point}");
    }
}

#[test]
fn names_that_contradict_the_hierarchy_are_not_followed() {
    // All knees and ankles are named the wrong way round.
    let mut swapped = joints(&|i| format!("joint_{i}"), |p| p);
    for (k, (name, _)) in STANDING.iter().enumerate() {
        let at = if k < 7 { 5 + k } else { 15 + k - 7 };
        swapped.names[if k % 7 < 4 { at } else { at + 1 }] = (*name).into();
    }
    swapped.names.swap(6, 7);
    swapped.names.swap(16, 17);
    let (capture, told) = read(&swapped).unwrap();
    assert!(told[0].contains("by the hierarchy"), "{told:?}");
    assert!((capture.frames[0].0[1] - standing()[1]).norm() < 1e-9);
}

#[test]
fn what_hangs_together_like_no_human_is_refused() {
    // A chain, a star, a skeleton without arms.
    let chain = Joints {
        names: (0..20).map(|i| format!("joint_{i}")).collect(),
        frames: vec![
            (0..20)
                .map(|i| Vector3::new(0.0, 0.0, f64::from(i)))
                .collect(),
        ],
        parents: (0..20).map(|i: usize| i.checked_sub(1)).collect(),
        ..Joints::default()
    };
    let mut star = chain.clone();
    star.parents = (0..20).map(|i| (i > 0).then_some(0)).collect();
    let mut armless = joints(&|i| format!("joint_{i}"), |p| p);
    for arm in [9, 19] {
        for joint in arm..arm + 6 {
            let at = armless.frames[0][2];
            armless
                .frames
                .iter_mut()
                .for_each(|frame| frame[joint] = at);
        }
    }
    for joints in [&chain, &star, &armless] {
        let message = read(joints).unwrap_err();
        assert!(
            message.contains("left hip") && message.contains("LeftUpLeg"),
            "{message}"
        );
    }
    // Parents that make no tree.
    let mut loops = chain.clone();
    loops.parents[1] = Some(5);
    assert!(read(&loops).is_err());
}

#[test]
fn feet_without_toes_point_to_where_the_hips_face() {
    // The ends of the feet are straight below the ankles, or in them.
    for below in [0.05, 0.0] {
        let mut joints = joints(&|i| format!("joint_{i}"), |p| p);
        for (k, (name, _)) in STANDING.iter().enumerate() {
            let at = if k < 7 { 5 + k } else { 15 + k - 7 };
            joints.names[if k % 7 < 4 { at } else { at + 1 }] = (*name).into();
        }
        for frame in &mut joints.frames {
            for ankle in [7, 17] {
                frame[ankle + 1] = frame[ankle] - Vector3::new(0.0, 0.0, below);
            }
        }
        let message = read(&joints).unwrap_err();
        assert!(message.contains("left toe"), "{message}");
        // The left foot turns by +20° and −20° about z in turn, the right one stands; both have some
        // orientation of their own in the file.
        let own = UnitQuaternion::from_euler_angles(0.3, -1.1, 2.0);
        let yaw = |degrees: f64| {
            (UnitQuaternion::from_euler_angles(0.0, 0.0, degrees.to_radians()) * own).cast::<f32>()
        };
        joints
            .turns
            .insert(7, [20.0, -20.0, 20.0, -20.0].map(yaw).into());
        joints.turns.insert(17, [0.0; 4].map(yaw).into());
        let (capture, told) = read(&joints).unwrap();
        assert!(told.iter().any(|t| t.contains("no toes")), "{told:?}");
        for (i, frame) in capture.frames.iter().enumerate() {
            let toe = |side| {
                let way = frame.of(side, Landmark::Toe) - frame.of(side, Landmark::Ankle);
                way.y.atan2(way.x).to_degrees()
            };
            let expected = if i % 2 == 0 { 20.0 } else { -20.0 };
            assert!(
                (toe(Side::Left) - expected).abs() < 0.01,
                "{i}: {}",
                toe(Side::Left)
            );
            assert!(toe(Side::Right).abs() < 0.01);
        }
    }
}

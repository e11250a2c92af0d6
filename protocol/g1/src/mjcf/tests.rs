//! The document read back: the tables come out of it again.

use super::*;
use crate::JOINTS;
use crate::links::total_mass;
use roxmltree::{Document, Node};

fn text() -> String {
    document(&Physics {
        timestep: 0.005,
        gravity: 9.81,
        friction: 1.0,
        self_collision: true,
    })
}

fn attribute<const N: usize>(node: Node<'_, '_>, name: &str) -> [f64; N] {
    let words = node.attribute(name).unwrap().split(' ');
    let numbers: Vec<f64> = words.map(|word| word.parse().unwrap()).collect();
    numbers.try_into().unwrap()
}

fn all<'a, 'input>(document: &'a Document<'input>, tag: &str) -> Vec<Node<'a, 'input>> {
    document
        .descendants()
        .filter(|node| node.has_tag_name(tag))
        .collect()
}

#[test]
fn the_tables_come_back_out_of_the_document() {
    let text = text();
    let document = Document::parse(&text).unwrap();
    let joints = all(&document, "joint");
    let motors = all(&document, "position");
    assert_eq!((joints.len(), motors.len()), (JOINTS, JOINTS));
    for (i, joint) in JOINT_TABLE.iter().enumerate() {
        let [lower, upper] = attribute(joints[i], "range");
        assert_eq!((lower, upper), (joint.lower, joint.upper), "{}", joint.name);
        assert_eq!(joints[i].attribute("name"), Some(joint.name));
        assert_eq!(attribute(joints[i], "axis"), joint.axis);
        assert_eq!(motors[i].attribute("joint"), Some(joint.name));
        assert_eq!(attribute(motors[i], "kp"), [joint.kp]);
        assert_eq!(attribute(motors[i], "kv"), [joint.kd]);
        assert_eq!(
            attribute(motors[i], "forcerange"),
            [-joint.effort, joint.effort]
        );
        let moved = joints[i].parent().unwrap();
        assert_eq!(attribute(moved, "pos"), joint.origin);
        assert_eq!(attribute(moved, "euler"), joint.rpy);
        let carrier = moved.parent().unwrap();
        assert_eq!(
            carrier.attribute("name"),
            Some(LINK_TABLE[joint.parent].name)
        );
    }
    let masses = all(&document, "inertial");
    let mass: f64 = masses.iter().map(|m| attribute::<1>(*m, "mass")[0]).sum();
    assert!((mass - total_mass()).abs() < 1e-12);
}

#[test]
fn limbs_and_trunk_meet_in_the_pairs_of_the_table() {
    let text = text();
    let document = Document::parse(&text).unwrap();
    let geoms = all(&document, "geom");
    let named = |name: &str| {
        let of = |geom: &&Node<'_, '_>| geom.attribute("name") == Some(name);
        *geoms.iter().find(of).unwrap()
    };
    let pairs = all(&document, "pair");
    assert_eq!(pairs.len(), PAIRS);
    for (pair, capsules) in pairs.iter().zip(collision::PAIR_TABLE) {
        assert_eq!(pair.attribute("condim"), Some("1"));
        for (side, capsule) in ["geom1", "geom2"].into_iter().zip(capsules) {
            let capsule = &CAPSULE_TABLE[capsule];
            let geom = named(pair.attribute(side).unwrap());
            let body = geom.parent().unwrap().attribute("name");
            assert_eq!(body, Some(LINK_TABLE[capsule.body].name));
            assert_eq!(attribute::<6>(geom, "fromto")[..], capsule.ends.concat());
            assert_eq!(attribute(geom, "size"), [capsule.radius]);
        }
    }
    let without = super::document(&Physics {
        timestep: 0.005,
        gravity: 9.81,
        friction: 1.0,
        self_collision: false,
    });
    let document = Document::parse(&without).unwrap();
    assert_eq!(all(&document, "pair").len(), 0);
    assert_eq!(
        all(&document, "geom").len(),
        geoms.len() - CAPSULE_TABLE.len()
    );
}

#[test]
fn of_all_geoms_only_soles_and_floor_touch() {
    let text = text();
    let document = Document::parse(&text).unwrap();
    let touching: Vec<&str> = all(&document, "geom")
        .into_iter()
        .filter(|geom| {
            attribute(*geom, "contype") != [0.0] || attribute(*geom, "conaffinity") != [0.0]
        })
        .map(|geom| geom.attribute("name").unwrap())
        .collect();
    assert_eq!(
        touching,
        [
            "floor",
            "left_ankle_roll_link_sole",
            "right_ankle_roll_link_sole"
        ]
    );
}

#[test]
fn the_keyframe_stands() {
    let text = text();
    let document = Document::parse(&text).unwrap();
    let key = all(&document, "key")[0];
    let qpos: [f64; 7 + JOINTS] = attribute(key, "qpos");
    assert_eq!(qpos[..7], [0.0, 0.0, STANDING_HEIGHT, 1.0, 0.0, 0.0, 0.0]);
    assert_eq!(qpos[7 + 3], 0.3); // left knee
    assert_eq!(attribute::<JOINTS>(key, "ctrl")[..], qpos[7..]);
}

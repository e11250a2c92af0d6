//! Skeletons of several makers, turned and scaled.

use super::*;
use std::path::Path;

/// Joints of a human that stands at a place, z up, m: `(name, position)` by the names of LAFAN1.
pub(in crate::import) const STANDING: [(&str, [f64; 3]); 14] = [
    ("LeftUpLeg", [0.0, 0.1, 0.9]),
    ("LeftLeg", [0.02, 0.1, 0.48]),
    ("LeftFoot", [0.0, 0.1, 0.08]),
    ("LeftToe", [0.14, 0.1, 0.02]),
    ("LeftArm", [0.0, 0.2, 1.4]),
    ("LeftForeArm", [0.0, 0.22, 1.12]),
    ("LeftHand", [0.05, 0.22, 0.88]),
    ("RightUpLeg", [0.0, -0.1, 0.9]),
    ("RightLeg", [0.02, -0.1, 0.48]),
    ("RightFoot", [0.0, -0.1, 0.08]),
    ("RightToe", [0.14, -0.1, 0.02]),
    ("RightArm", [0.0, -0.2, 1.4]),
    ("RightForeArm", [0.0, -0.22, 1.12]),
    ("RightHand", [0.05, -0.22, 0.88]),
];

fn standing(turn: impl Fn([f64; 3]) -> [f64; 3]) -> Joints {
    Joints {
        names: STANDING
            .iter()
            .map(|(name, _)| (*name).to_owned())
            .collect(),
        frames: vec![
            STANDING
                .iter()
                .map(|(_, p)| Vector3::from(turn(*p)))
                .collect();
            3
        ],
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

#[test]
fn up_and_unit_are_told_from_the_body() {
    let (upright, told) = read(&standing(|p| p)).unwrap();
    assert!(
        told[0].starts_with("z up") && told[1].starts_with("unit m"),
        "{told:?}"
    );
    // y up, z forward… whatever: x stays, y becomes z.
    for (unit, name) in [
        (100.0, "cm:"),
        (1000.0, "mm:"),
        (0.45 / 0.0254, "inches/0.45:"),
        (1.0 / 0.0254, "inches:"),
        (1.0 / 0.3048, "feet:"),
    ] {
        let turned = standing(|[x, y, z]| [unit * x, unit * z, -unit * y]);
        let (capture, told) = read(&turned).unwrap();
        assert!(told[0].starts_with("y up"), "{told:?}");
        assert!(!told[1].contains(" or "), "{told:?}");
        assert!(told[1].starts_with(&format!("unit {name}")), "{told:?}");
        for (a, b) in capture.frames[0].0.iter().zip(&upright.frames[0].0) {
            assert!((a - b).norm() < 1e-9);
        }
    }
}

/// The names that makers give hip, knee, ankle, toe, shoulder, elbow and wrist of the left, what becomes
/// what on the right, and a joint that is none of them.
const MAKERS: [(&str, &str, [&str; 2], &str); 15] = [
    (
        "mixamorig:LeftUpLeg,mixamorig:LeftLeg,mixamorig:LeftFoot,mixamorig:LeftToeBase",
        "mixamorig:LeftArm,mixamorig:LeftForeArm,mixamorig:LeftHand",
        ["Left", "Right"],
        "mixamorig:LeftShoulder",
    ),
    (
        "mixamorigLeftUpLeg,mixamorigLeftLeg,mixamorigLeftFoot,mixamorigLeftToeBase",
        "mixamorigLeftArm,mixamorigLeftForeArm,mixamorigLeftHand",
        ["Left", "Right"],
        "mixamorigLeftShoulder",
    ),
    // Rokoko
    (
        "LeftThigh,LeftShin,LeftFoot,LeftToe",
        "LeftArm,LeftForeArm,LeftHand",
        ["Left", "Right"],
        "LeftShoulder",
    ),
    // Sony's mocopi
    (
        "l_up_leg,l_low_leg,l_foot,l_toes",
        "l_up_arm,l_low_arm,l_hand",
        ["l_", "r_"],
        "l_shoulder",
    ),
    // OptiTrack
    (
        "Skeleton 001_LThigh,Skeleton 001_LShin,Skeleton 001_LFoot,Skeleton 001_LToe",
        "Skeleton 001_LUArm,Skeleton 001_LFArm,Skeleton 001_LHand",
        ["_L", "_R"],
        "Skeleton 001_LShoulder",
    ),
    // Daz, generations 2 and 8
    (
        "lThigh,lShin,lFoot,lToe",
        "lShldr,lForeArm,lHand",
        ["l", "r"],
        "lCollar",
    ),
    (
        "lThighBend,lShin,lFoot,lToe",
        "lShldrBend,lForearmBend,lHand",
        ["l", "r"],
        "lThighTwist",
    ),
    // Biped of 3ds Max
    (
        "Bip01 L Thigh,Bip01 L Calf,Bip01 L Foot,Bip01 L Toe0",
        "Bip01 L UpperArm,Bip01 L Forearm,Bip01 L Hand",
        [" L", " R"],
        "Bip01 L Clavicle",
    ),
    // VRM
    (
        "J_Bip_L_UpperLeg,J_Bip_L_LowerLeg,J_Bip_L_Foot,J_Bip_L_ToeBase",
        "J_Bip_L_UpperArm,J_Bip_L_LowerArm,J_Bip_L_Hand",
        ["_L", "_R"],
        "J_Bip_L_Shoulder",
    ),
    // Unreal
    (
        "thigh_l,calf_l,foot_l,ball_l",
        "upperarm_l,lowerarm_l,hand_l",
        ["_l", "_r"],
        "clavicle_l",
    ),
    // Blender
    (
        "DEF-thigh.L,DEF-shin.L,DEF-foot.L,DEF-toe.L",
        "DEF-upper_arm.L,DEF-forearm.L,DEF-hand.L",
        [".L", ".R"],
        "DEF-shoulder.L",
    ),
    // Bandai Namco
    (
        "UpperLeg_L,LowerLeg_L,Foot_L,Toes_L",
        "UpperArm_L,LowerArm_L,Hand_L",
        ["_L", "_R"],
        "Shoulder_L",
    ),
    (
        "LeftLeg,LeftShin,LeftFoot,LeftToeBase",
        "LeftArm,LeftForeArm,LeftHand",
        ["Left", "Right"],
        "LeftShoulder",
    ),
    // Acclaim
    (
        "lfemur,ltibia,lfoot,ltoes",
        "lhumerus,lradius,lwrist",
        ["l", "r"],
        "lclavicle",
    ),
    // SMPL
    (
        "L_Hip,L_Knee,L_Ankle,L_Toe",
        "L_Shoulder,L_Elbow,L_Wrist",
        ["L_", "R_"],
        "L_Collar",
    ),
];

#[test]
fn joints_are_found_under_the_names_of_many_makers() {
    let (upright, _) = read(&standing(|p| p)).unwrap();
    for (leg, arm, [left, right], other) in MAKERS {
        let mut joints = standing(|p| p);
        let of_left: Vec<&str> = leg.split(',').chain(arm.split(',')).collect();
        let of_right = of_left.iter().map(|name| name.replacen(left, right, 1));
        joints.names = of_left
            .iter()
            .map(|name| (*name).to_owned())
            .chain(of_right)
            .collect();
        // The other joint comes first, and is far from all.
        joints.names.insert(0, other.into());
        joints.names.insert(0, "Hips".into());
        for frame in &mut joints.frames {
            frame.insert(0, Vector3::new(9.0, 9.0, 9.0));
            frame.insert(0, Vector3::new(9.0, 9.0, 9.0));
        }
        let (capture, told) = read(&joints).unwrap_or_else(|e| panic!("{leg}: {e}"));
        assert_eq!(capture, upright, "{leg}");
        assert!(
            told.iter().all(|t| !t.contains("hierarchy")),
            "{leg}: {told:?}"
        );
    }
}

#[test]
fn a_unit_that_could_be_another_is_said() {
    // A child's legs of 0.52 m in cm are 1.32 m in inches, farther from an adult's 0.84; of 0.47 m they
    // are 1.19 m, and nearer.
    let of = |leg: f64| {
        let scale = leg / 0.821 * 100.0;
        read(&standing(|p| p.map(|x| scale * x))).unwrap().1[1].clone()
    };
    assert!(
        of(0.54).starts_with("unit cm:") && !of(0.54).contains(" or "),
        "{}",
        of(0.54)
    );
    let told = of(0.47);
    assert!(
        told.starts_with("unit inches: legs of 1.19") && told.contains("or cm: 0.4"),
        "{told}"
    );
}

#[test]
fn what_is_no_standing_human_is_refused() {
    let mut missing = standing(|p| p);
    missing.names[3] = "LeftNothing".into();
    let message = read(&missing).unwrap_err();
    assert!(
        message.contains("left toe") && message.contains("LeftUpLeg"),
        "{message}"
    );
    let message = read(&standing(|[x, y, z]| [z, y, x])).unwrap_err();
    assert!(message.contains("does not stand"), "{message}");
    // 0.82 m eight times over: too long in metres and feet, too short in all else.
    let message = read(&standing(|p| p.map(|x| 8.0 * x))).unwrap_err();
    assert!(
        message.contains("legs 6.5") && message.contains("metres"),
        "{message}"
    );
    let mut broken = standing(|p| p);
    broken.frames[1][2].y = f64::NAN;
    let message = read(&broken).unwrap_err();
    assert!(message.contains("human.bvh frame 2, LeftFoot"), "{message}");
    broken.frames.clear();
    assert!(read(&broken).unwrap_err().contains("no frames"));
}

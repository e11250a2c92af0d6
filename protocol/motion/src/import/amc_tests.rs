//! A skeleton of straight bones, whose poses can be worked out in the head, and broken files.

use super::*;
use std::fmt::Write as _;

/// A human of CMU's bone names that stands, y up, facing z, in inches/0.45.
pub(in crate::import) fn skeleton() -> String {
    let mut text = String::from(
        ":version 1.10\n:units\n  mass 1.0\n  length 0.45\n  angle deg\n:root\n  order TX TY TZ RX RY RZ\n  \
         axis XYZ\n  position 0 0 0\n  orientation 0 0 0\n:bonedata\n",
    );
    for (side, sign) in [("l", 1.0), ("r", -1.0)] {
        for (bone, direction, length, dof) in [
            ("hipjoint", [sign, 0.0, 0.0], 1.8, ""),
            ("femur", [0.0, -1.0, 0.0], 7.4, "dof rx ry rz"),
            ("tibia", [0.0, -1.0, 0.0], 7.2, "dof rx"),
            ("foot", [0.0, -0.4, 1.0], 2.3, "dof rx rz"),
            ("clavicle", [sign * 0.4, 1.0, 0.0], 9.0, "dof ry rz"),
            ("humerus", [sign, 0.0, 0.0], 4.9, "dof rx ry rz"),
            ("radius", [sign, 0.0, 0.0], 4.3, "dof rx"),
        ] {
            let [x, y, z] = direction;
            // The arm's own axes are turned, as CMU's are.
            let axis = if bone == "humerus" {
                "axis 0 0 90 XYZ"
            } else {
                "axis 0 0 0 XYZ"
            };
            let _ = write!(
                text,
                "  begin\n    id 1\n    name {side}{bone}\n    direction {x} {y} {z}\n    length {length}\n    {axis}\n    {dof}\n  end\n"
            );
        }
    }
    text.push_str(":hierarchy\n  begin\n    root lhipjoint rhipjoint lclavicle rclavicle\n");
    for side in ["l", "r"] {
        let _ = write!(
            text,
            "    {side}hipjoint {side}femur\n    {side}femur {side}tibia\n    {side}tibia {side}foot\n    \
             {side}clavicle {side}humerus\n    {side}humerus {side}radius\n"
        );
    }
    text.push_str("  end\n");
    text
}

/// Standing and sliding along z, one left knee bending.
pub(in crate::import) fn motion(frames: usize) -> String {
    let mut text = String::from("#!OML:ASF x\n:FULLY-SPECIFIED\n:DEGREES\n");
    for i in 0..frames {
        let _ = write!(text, "{}\nroot 0 15 {} 0 0 0\n", i + 1, 0.1 * i as f64);
        for side in ["l", "r"] {
            let knee = if side == "l" { i as f64 } else { 0.0 };
            let _ = write!(
                text,
                "{side}femur 0 0 0\n{side}tibia {knee}\n{side}foot 0 0\n{side}clavicle 0 0\n{side}humerus 0 0 0\n{side}radius 0\n"
            );
        }
    }
    text
}

fn read_in(folder: &Path, motion: &str) -> Result<Joints, String> {
    let path = folder.join("02_01.amc");
    let file = File {
        path: &path,
        bytes: motion.as_bytes(),
    };
    read(&file, None, &mut Vec::new()).map_err(|e| e.to_string())
}

fn joint(joints: &Joints, frame: usize, name: &str) -> Vector3<f64> {
    joints.frames[frame][joints.names.iter().position(|n| n == name).unwrap()]
}

#[test]
fn poses_follow_from_bones_and_angles() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("02.asf"), skeleton()).unwrap();
    let turned = motion(91).replace("lhumerus 0 0 0", "lhumerus 90 0 0");
    let joints = read_in(folder.path(), &turned).unwrap();
    let unit = 0.0254 / 0.45;
    let expected = Vector3::new(1.8, 15.0 - 7.4, 9.0) * unit; // slid 0.1 a frame
    assert!((joint(&joints, 90, "lknee") - expected).norm() < 1e-9);
    // A knee at 90° about x: the shin, −y, points along −z.
    let shin = joint(&joints, 90, "lankle") - joint(&joints, 90, "lknee");
    assert!(
        (shin - Vector3::new(0.0, 0.0, -7.2) * unit).norm() < 1e-9,
        "{shin}"
    );
    // The humerus turns about its own x, which the axis (90° about z) lays along the world's y:
    // +x goes to −z.
    let arm = joint(&joints, 0, "lelbow") - joint(&joints, 0, "larm");
    assert!(
        (arm - Vector3::new(0.0, 0.0, -4.9) * unit).norm() < 1e-9,
        "{arm}"
    );
}

#[test]
fn the_skeleton_is_found_or_asked_for() {
    let folder = tempfile::tempdir().unwrap();
    let message = read_in(folder.path(), &motion(3)).unwrap_err();
    assert!(
        message.contains("02.asf") && message.contains("--skeleton"),
        "{message}"
    );
    std::fs::write(folder.path().join("any.asf"), skeleton()).unwrap();
    assert!(read_in(folder.path(), &motion(3)).is_ok());
    std::fs::write(folder.path().join("other.asf"), skeleton()).unwrap();
    assert!(read_in(folder.path(), &motion(3)).is_err()); // which of the two?
}

#[test]
fn errors_name_frame_bone_and_line() {
    let folder = tempfile::tempdir().unwrap();
    let good = motion(3);
    std::fs::write(folder.path().join("02.asf"), skeleton()).unwrap();
    for (text, parts) in [
        (
            good.replace("3\nroot", "5\nroot"),
            ["line 32", "frame 5 follows frame 2", "follow"],
        ),
        (
            good.replace("ltibia 2", "ltibia nan"),
            ["frame 3, ltibia", "nan", "repair"],
        ),
        (
            good.replace("ltibia 2", "ltibia 2 3"),
            ["frame 3, ltibia", "2 numbers", "1"],
        ),
        (
            good.replacen("ltibia 1\n", "", 1),
            ["frame 2, ltibia", "missing", "cut off"],
        ),
        (
            good.replace("ltibia 1", "tail 1"),
            ["line", "tail", "skeleton"],
        ),
        (":DEGREES\n".into(), ["02_01.amc", "no frames", "again"]),
        ("root 1 2\n".into(), ["line 1", "root", "first frame"]),
    ] {
        let message = read_in(folder.path(), &text).unwrap_err();
        for part in parts {
            assert!(message.contains(part), "{part:?} is not in {message:?}");
        }
    }
    for (broken, part) in [
        (skeleton().replace("length 0.45", "length 0"), "line 4"),
        (skeleton().replace("dof rx ry rz", "dof rx ry rw"), "rw"),
        (skeleton().replace("ltibia lfoot", "ltibia lpaw"), "lpaw"),
        (
            skeleton().replace("lfemur ltibia", "lfemur lfemur"),
            "lfemur",
        ),
        (
            skeleton().replace("length 7.4", "length long"),
            "length needs 1",
        ),
        ("nothing".into(), ":root"),
    ] {
        std::fs::write(folder.path().join("02.asf"), broken).unwrap();
        let message = read_in(folder.path(), &good).unwrap_err();
        assert!(
            message.contains("02.asf") && message.contains(part),
            "{part:?} is not in {message:?}"
        );
    }
}

#[test]
fn no_cut_panics() {
    let folder = tempfile::tempdir().unwrap();
    let (asf, amc) = (skeleton(), motion(2));
    std::fs::write(folder.path().join("02.asf"), &asf).unwrap();
    for cut in 0..amc.len() {
        let _ = read_in(folder.path(), &amc[..cut]);
    }
    for cut in (0..asf.len()).step_by(7) {
        std::fs::write(folder.path().join("02.asf"), &asf[..cut]).unwrap();
        let _ = read_in(folder.path(), &amc);
    }
}

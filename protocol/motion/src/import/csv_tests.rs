//! Files as people make them, good and bad.

use super::*;
use crate::import::upright::reread;
use g1::JOINT_TABLE;

const BASE: [&str; 7] = ["x", "y", "z", "qw", "qx", "qy", "qz"];

fn table(text: &str) -> Result<Table, String> {
    let file = File {
        path: Path::new("walk.csv"),
        bytes: text.as_bytes(),
    };
    parse(&file).map_err(|e| e.to_string())
}

fn read(text: &str) -> Result<Vec<Row>, String> {
    table(text).map(|table| table.rows)
}

/// A line with numbers 0.00, 0.01, … as joints.
fn line(joints: usize) -> String {
    let joints = (0..joints).map(|i| format!(",{:.2}", i as f64 / 100.0));
    format!("1,2,0.75,1,0,0,0{}\n", joints.collect::<String>())
}

#[test]
fn plain_tables_are_in_robot_order() {
    let rows = read(&line(23).repeat(3)).unwrap();
    assert_eq!(rows.len(), 3);
    assert_eq!(rows[0].position, Vector3::new(1.0, 2.0, 0.75));
    assert_eq!(rows[0].orientation, UnitQuaternion::identity());
    assert_eq!((rows[0].joints[0], rows[0].joints[22]), (0.0, 0.22));
}

#[test]
fn the_29_joint_robot_loses_six_joints() {
    let rows = read(&line(29)).unwrap();
    // Waist yaw is 12, then left arm 15–19 and right arm 22–26 of the larger robot.
    assert_eq!(rows[0].joints[12..15], [0.12, 0.15, 0.16]);
    assert_eq!(rows[0].joints[17..19], [0.19, 0.22]);
    assert_eq!(rows[0].joints[22], 0.26);
    // Waist roll and pitch, then pitch and yaw of the wrists, are kept apart.
    assert_eq!(rows[0].dropped, [0.13, 0.14, 0.20, 0.21, 0.27, 0.28]);
    assert_eq!(read(&line(23)).unwrap()[0].dropped, [0.0; 6]);
}

#[test]
fn the_scalar_of_a_quaternion_may_come_last() {
    let text = line(23).replace("1,0,0,0", "0,0,0.6,0.8");
    let rows = reread(&read(&text).unwrap());
    assert!((rows[0].orientation.w - 0.8).abs() < 1e-12);
    assert!((rows[0].orientation.k - 0.6).abs() < 1e-12);
}

#[test]
fn a_header_maps_columns_by_name_whatever_the_order_and_line_ends() {
    let mut names: Vec<String> = JOINT_TABLE.iter().map(|j| j.name.to_string()).collect();
    names.extend(BASE.map(String::from));
    names.push("waist_roll_joint".into());
    names[0] = "left_hip_pitch".into(); // the suffix may be missing
    let values: Vec<String> = (0..23)
        .map(|i| format!("{:.2}", f64::from(i) / 100.0))
        .chain(["1", "2", "0.75", "1", "0", "0", "0", "9"].map(String::from))
        .collect();
    let text = format!(
        "\u{feff}{}\r\n\r\n# note\r\n{}\r\n",
        names.join(", "),
        values.join(" , ")
    );
    let mut rows = read(&text).unwrap();
    assert_eq!(rows[0].dropped, [9.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
    rows[0].dropped = [0.0; 6];
    assert_eq!(rows, read(&line(23)).unwrap());
}

#[test]
fn errors_name_file_line_column_and_remedy() {
    let good = line(23);
    let header = format!(
        "{},{}\n",
        BASE.join(","),
        JOINT_TABLE.map(|joint| joint.name).join(",")
    );
    for (text, parts) in [
        (String::new(), ["walk.csv", "no frames", "export"]),
        (
            "\n  \n# only a note\n".into(),
            ["walk.csv", "no frames", "export"],
        ),
        ("1,2,3\n".into(), ["line 1", "3 columns", "expected 30"]),
        (
            format!("{good}1,2\n"),
            ["line 2", "2 columns where the first line has 30", "same"],
        ),
        (
            format!("{good}{}", good.replace("0.75", "O.75")),
            ["line 2 column 3", "\"O.75\"", "number"],
        ),
        (
            format!("{good}{}", good.replace("0.22", "")),
            ["line 2 column 30", "\"\"", "number"],
        ),
        (
            good.replace("0.05", "NaN"),
            ["line 1 column 13", "NaN", "finite"],
        ),
        (
            good.replace("0.05", "-inf"),
            ["line 1 column 13", "inf", "finite"],
        ),
        (
            good.replace("0.05", "45.0"),
            ["line 1 column 13", "45 rad", "radians"],
        ),
        (
            good.replace("0.75", "1e300"),
            ["line 1 column 3", "away", "metres"],
        ),
        (
            good.replace("1,0,0,0", "0.5,0,0,0"),
            ["line 1 column 4", "length 0.500", "length 1"],
        ),
        (
            good.replace("1,0,0,0", "0,0,0,0"),
            ["line 1", "length 0.000", "length 1"],
        ),
        (header.clone(), ["walk.csv", "no frames", "export"]),
        (
            header.replace("left_knee", "left_nee"),
            ["line 1 column 11", "\"left_nee_joint\"", "URDF"],
        ),
        (
            header.replace("qz", "qx"),
            ["line 1 column 7", "twice", "keep one"],
        ),
        (
            header.replace("qz,", ""),
            ["line 1", "no column \"qz\"", "add it"],
        ),
        (
            header.replace(",waist_yaw_joint", ""),
            ["line 1", "no column \"waist_yaw_joint\"", "add"],
        ),
    ] {
        let message = read(&text).unwrap_err();
        for part in parts {
            assert!(message.contains(part), "{part:?} is not in {message:?}");
        }
    }
}

#[path = "csv_rate_tests.rs"]
mod rates;

#[test]
fn centimetres_and_degrees_are_known_by_their_header() {
    let joints = JOINT_TABLE
        .map(|joint| format!("{}_dof", joint.name))
        .join(",");
    let angles: Vec<String> = (0..23).map(|i| format!("{}", 2 * i)).collect();
    let text = format!(
        "Frame,root_translateX,root_translateY,root_translateZ,root_rotateX,root_rotateY,root_rotateZ,{joints}\n\
         0,100,200,75,0,0,90,{}\n",
        angles.join(",")
    );
    let rows = read(&text).unwrap();
    assert!((rows[0].position - Vector3::new(1.0, 2.0, 0.75)).norm() < 1e-12);
    // Facing y.
    assert!((rows[0].orientation * Vector3::x() - Vector3::y()).norm() < 1e-12);
    assert!((rows[0].joints[22] - 44f64.to_radians()).abs() < 1e-12);
}

#[test]
fn no_text_whatever_panics() {
    let good = line(23);
    for cut in 0..good.len() {
        let _ = read(&good[..cut]);
        let _ = read(&format!("{}\u{0}é,{}", &good[..cut], &good[cut..]));
    }
    for text in [
        "\u{feff}",
        ",",
        ",,,,\n",
        "\"",
        "x\n1",
        "qw\n",
        "\r\r\n",
        "1e999",
        &",".repeat(10_000),
    ] {
        assert!(read(text).is_err(), "{text:?}");
    }
}

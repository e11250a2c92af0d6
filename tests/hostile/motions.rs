//! Motion files: a table of the robot's motion and what it may become, and bytes that begin as other
//! formats do.

use std::fmt::Write;

use motion::import::{Options, load};
use proptest::collection::vec;
use proptest::prelude::*;

use crate::damage::{blows, damaged};
use crate::{always, assert_clear};

/// A robot that stands and sways, 30 columns, a header as some write it.
fn table(rows: usize, header: bool) -> String {
    let mut text = String::from("# fps = 50\n");
    if header {
        text += "x,y,z,qw,qx,qy,qz";
        for joint in 0..23 {
            write!(text, ",joint{joint}").unwrap();
        }
        text.push('\n');
    }
    for row in 0..rows {
        let sway = 0.01 * (row as f64 * 0.1).sin();
        write!(text, "{sway},0,0.78,1,0,0,0").unwrap();
        for _ in 0..23 {
            write!(text, ",{sway}").unwrap();
        }
        text.push('\n');
    }
    text
}

/// Reads bytes as a file of motion. What is accepted is finite and not longer than the file allows.
fn read(bytes: &[u8]) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("hostile.csv");
    std::fs::write(&path, bytes).unwrap();
    match load(&path, &Options::default()) {
        Err(error) => assert_clear(&error),
        Ok(clip) => {
            assert!(
                clip.frames.len() < 2_000_000,
                "{} frames",
                clip.frames.len()
            );
            let sound = |x: f32| x.is_finite();
            for frame in &clip.frames {
                assert!(frame.joint_positions.iter().all(|x| sound(*x)), "{frame:?}");
                assert!(
                    frame.joint_velocities.iter().all(|x| sound(*x)),
                    "{frame:?}"
                );
                assert!(frame.position.iter().all(|x| sound(*x)), "{frame:?}");
            }
        }
    }
}

#[test]
fn a_damaged_table_is_read_or_refused() {
    let table = table(12, false);
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("sound.csv");
    std::fs::write(&path, &table).unwrap();
    load(&path, &Options::default()).expect("the undamaged one is sound");
    always(300, &blows(), |blows| {
        read(&damaged(table.as_bytes(), &blows))
    });
}

#[test]
fn any_number_in_any_cell_is_read_or_refused() {
    let cells = [
        "nan",
        "inf",
        "-inf",
        "1e308",
        "-1e308",
        "1e-308",
        "",
        " ",
        "-0",
        "0x10",
        "1e",
        "9999999999",
        "3.2",
        "-3.2",
        "1,2",
        "\"1\"",
        "1;2",
        "#",
        "1_000",
    ];
    let rates = ["", "0", "-1", "nan", "inf", "1e-12", "1e12", "50", "1e308"];
    let changes = vec(
        (
            0..12_usize,
            0..30_usize,
            proptest::sample::select(cells.to_vec()),
        ),
        0..4,
    );
    let inputs = (
        changes,
        proptest::sample::select(rates.to_vec()),
        any::<bool>(),
    );
    always(400, &inputs, |(changes, rate, header)| {
        let text = table(12, header).replace("fps = 50", &format!("fps = {rate}"));
        let mut lines: Vec<String> = text.lines().map(str::to_owned).collect();
        for (row, column, cell) in changes {
            let line = &mut lines[1 + usize::from(header) + row];
            let mut cells: Vec<&str> = line.split(',').collect();
            if let Some(place) = cells.get_mut(column) {
                *place = cell;
            }
            *line = cells.join(",");
        }
        read(lines.join("\n").as_bytes());
    });
}

#[test]
fn bytes_that_begin_as_other_formats_do_are_refused() {
    let beginnings: [&[u8]; 7] = [
        b"PK\x03\x04",
        b"\x93NUMPY\x01\x00",
        b"\x80\x04\x95",
        b"HIERARCHY\nROOT Hips\n{\nOFFSET 0 0 0\nCHANNELS 6 Xposition\n",
        b":FULLY-SPECIFIED\n:DEGREES\n1\n",
        b"root_translateX,root_rotateX\n",
        b"",
    ];
    let inputs = (
        proptest::sample::select(beginnings.to_vec()),
        vec(any::<u8>(), 0..200),
    );
    always(500, &inputs, |(beginning, rest)| {
        read(&[beginning, &rest].concat());
    });
}

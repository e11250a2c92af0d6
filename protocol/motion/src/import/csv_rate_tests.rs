//! The rate of a table, and what is said twice.

use super::*;

fn header() -> String {
    export::header()
}

fn fps(table: &Table) -> Result<Option<f64>, String> {
    by(table, &Options::default())
}

fn by(table: &Table, options: &Options) -> Result<Option<f64>, String> {
    let file = File {
        path: Path::new("walk.csv"),
        bytes: b"",
    };
    table
        .fps(&file, options, &mut Vec::new())
        .map_err(|e| e.to_string())
}

/// A table with comments and a column of times.
fn timed(comments: &str, times: &[&str]) -> Result<Table, String> {
    let rows: Vec<String> = times.iter().map(|t| format!("{t},{}", line(23))).collect();
    table(&format!("{comments}Time,{}\n{}", header(), rows.concat()))
}

#[test]
fn the_rate_is_in_a_comment_or_in_times() {
    let stated = table(&format!("# a walk\n# fps = 60\n{}", line(23))).unwrap();
    assert_eq!((fps(&stated), stated.named), (Ok(Some(60.0)), false));
    let timed = |times: [f64; 4]| {
        let rows = times.map(|t| format!("{t},{}", line(23)));
        table(&format!("time,{}\n{}", header(), rows.concat()))
    };
    let even = timed([1.0, 1.02, 1.04, 1.06]).unwrap();
    assert!((fps(&even).unwrap().unwrap() - 50.0).abs() < 1e-6 && even.named);
    let message = timed([1.0, 1.02, 1.08, 1.10]).unwrap_err();
    for part in ["line 4", "1.08", "0.060000", "evenly"] {
        assert!(message.contains(part), "{message}");
    }
    // A counter says nothing of the rate, but a gap in it is one.
    let counted = |frames: [u32; 4]| {
        let rows = frames.map(|f| format!("{f},{}", line(23)));
        table(&format!("Frame,{}\n{}", header(), rows.concat()))
    };
    assert_eq!(fps(&counted([0, 1, 2, 3]).unwrap()), Ok(None));
    assert!(counted([0, 1, 2, 5]).unwrap_err().contains("line 5"));
    // Every fourth row of a recording: whose rate would be stated?
    let message = counted([8, 12, 16, 20]).unwrap_err();
    assert!(
        message.contains("steps of 4") && message.contains("number its rows"),
        "{message}"
    );
}

#[test]
fn a_rate_is_stated_in_many_words() {
    for (comment, expected) in [
        ("# fps = 60", Some(60.0)),
        ("#FPS:60", Some(60.0)),
        ("#  Frame Rate = 29.97 Hz", Some(29.97)),
        ("# frame_rate: 120fps", Some(120.0)),
        ("# fps 30", Some(30.0)),
        ("# fps = 30, resampled from 120", Some(30.0)),
        ("# dt = 0.02", Some(50.0)),
        ("# frame time: 20 ms", Some(50.0)),
        ("# note: fps = 30", None),
        ("# made at 30 fps = slow", None),
        ("# fps are in the paper", None),
    ] {
        let stated = table(&format!("{comment}\n{}", line(23))).unwrap();
        assert_eq!(fps(&stated), Ok(expected), "{comment}");
    }
    for comment in [
        "# fps = fast",
        "# fps =",
        "# fps = 20 ms",
        "# dt = 50 Hz",
        "# fps = nan",
    ] {
        let message = table(&format!("\n{comment}\n{}", line(23))).unwrap_err();
        for part in ["walk.csv line 2", "says no rate", "# fps = 50"] {
            assert!(message.contains(part), "{comment}: {message}");
        }
    }
}

#[test]
fn times_that_contradict_a_comment_are_an_error() {
    let steps = ["0.00", "0.02", "0.04", "0.06"];
    let agreed = timed("# fps = 50\n", &steps).unwrap();
    assert_eq!(fps(&agreed), Ok(Some(50.0)));
    let two = timed("# fps = 30\n", &steps).unwrap();
    let message = fps(&two).unwrap_err();
    for part in [
        "walk.csv: states two rates: 30",
        "line 1 (fps = 30)",
        "50 in the column of times (steps of 0.020000 s)",
        "remove the wrong one",
    ] {
        assert!(message.contains(part), "{part:?} is not in {message:?}");
    }
    // The user's word for one of them is not enough: was the comment wrong, or the times?
    let mut options = Options {
        fps: Some(50.0),
        ..Options::default()
    };
    assert!(by(&two, &options).is_err());
    // Above both it is, and what contradicts it is handed on to be said.
    options.force_fps = true;
    assert_eq!(by(&two, &options), Ok(Some(30.0)));
    let comments = table(&format!("# fps = 30\n{}# fps: 60\n", line(23))).unwrap();
    let message = fps(&comments).unwrap_err();
    assert!(
        message.contains("line 1") && message.contains("line 3"),
        "{message}"
    );
}

#[test]
fn of_two_rates_that_nearly_agree_the_one_that_is_passed_over_is_said() {
    let told = |comment: &str| {
        let table = timed(comment, &["0.00", "0.02", "0.04", "0.06"]).unwrap();
        let file = File {
            path: Path::new("walk.csv"),
            bytes: b"",
        };
        let mut decisions = Vec::new();
        let fps = table.fps(&file, &Options::default(), &mut decisions);
        (fps.unwrap().unwrap(), decisions)
    };
    for fps in [51.0, 50.4, 50.9] {
        let (taken, decisions) = told(&format!("# fps = {fps}\n"));
        assert_eq!(taken, fps);
        let [said] = decisions.as_slice() else {
            panic!("{decisions:?}");
        };
        assert!(
            said.starts_with(&format!("{fps} frames a second as line 1")),
            "{said}"
        );
        assert!(said.contains("passed over: 50 in the column"), "{said}");
    }
    assert!(told("# fps = 50\n").1.is_empty());
}

#[test]
fn times_in_milliseconds_are_even() {
    // 30 Hz rounded: steps of 0.033, 0.034, 0.033; over all of them 0.1 s for 3.
    let table = timed("# fps = 30\n", &["0.000", "0.033", "0.067", "0.100"]).unwrap();
    assert_eq!(fps(&table), Ok(Some(30.0)));
    let table = timed("", &["0.000", "0.033", "0.067", "0.100"]).unwrap();
    assert!((fps(&table).unwrap().unwrap() - 30.0).abs() < 1e-9);
    // A tenth of a second is one digit too few to excuse 0.2 after 0.1.
    assert!(timed("", &["0.0", "0.1", "0.3", "0.4"]).is_err());
}

#[test]
fn only_what_was_written_here_is_taken_as_it_is() {
    let walk = crate::gait::walk(1.0).unwrap();
    let text = export::to_csv(&walk, &["a walk".into()]);
    assert!(table(&text).unwrap().ours);
    for other in [
        text.replacen("# ampco motion", "# a motion", 1),
        text.replacen("# fps = 50", "# fps = 25", 1),
        text.replacen("# fps = 50\n", "", 1),
        text.replacen("left_knee_joint", "left_knee", 1),
    ] {
        assert!(!table(&other).unwrap().ours);
    }
}

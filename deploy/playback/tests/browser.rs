//! The page in a real Chromium, without a window: it draws a robot and its time runs.
//!
//! Where no Chromium is installed there is nothing to test with: see `needs`.

use std::path::Path;
use std::process::Command;

use g1::RobotState;
use playback::{Frame, Recording, page};

/// Twenty seconds of walking on the spot: the knees bend in turn.
fn recording() -> Recording {
    let frames = (0..1000).map(|i| {
        let mut state = RobotState::standing();
        let swing = (i as f32 * 0.2).sin().max(0.0);
        state.joint_positions[3] += swing;
        state.joint_positions[0] -= swing / 2.0;
        Frame {
            foot_forces: Some([150.0, 160.0]),
            ..Frame::of(&state, [0.5, 0.0, 0.0])
        }
    });
    Recording {
        title: "on the spot".to_owned(),
        source: "test".to_owned(),
        frame_seconds: 0.02,
        fell_at: None,
        frames: frames.collect(),
    }
}

/// Runs the browser on the page until `budget_ms` of its own time are over; gives what it printed.
fn browse(browser: &Path, folder: &Path, fragment: &str, budget_ms: u32, option: &str) -> String {
    let file = folder.join("page.html");
    std::fs::write(&file, page::html(&recording())).unwrap();
    let output = Command::new(browser)
        .args([
            "--headless=new",
            "--no-sandbox",
            "--use-angle=swiftshader",
            "--enable-unsafe-swiftshader",
            "--hide-scrollbars",
            "--window-size=1000,700",
        ])
        .arg(format!(
            "--user-data-dir={}",
            folder.join("profile").display()
        ))
        .arg(format!("--virtual-time-budget={budget_ms}"))
        .arg("--timeout=60000")
        .arg(option)
        .arg(format!("file://{}{fragment}", file.display()))
        .output()
        .unwrap();
    assert!(
        output.status.success(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    String::from_utf8_lossy(&output.stdout).into_owned()
}

fn pixels(path: &Path) -> (usize, Vec<u8>) {
    let file = std::fs::read(path).unwrap();
    let header = minipng::decode_png_header(&file).unwrap();
    let mut bytes = vec![0; header.required_bytes_rgba8bpc()];
    let mut image = minipng::decode_png(&file, &mut bytes).unwrap();
    image.convert_to_rgba8bpc().unwrap();
    let rgb = image
        .pixels()
        .chunks_exact(4)
        .flat_map(|p| [p[0], p[1], p[2]]);
    (image.width() as usize, rgb.collect())
}

#[test]
fn the_page_draws_a_robot_with_its_feet_below_its_head() {
    let Some(browser) = needs::browser() else {
        return;
    };
    let folder = tempfile::tempdir().unwrap();
    let shot = folder.path().join("shot.png");
    let option = format!("--screenshot={}", shot.display());
    browse(&browser, folder.path(), "#t=0.5", 1_000, &option);
    let (width, rgb) = pixels(&shot);
    // Loaded soles are orange, and nothing else in the scene is.
    let orange = |p: &[u8]| {
        let [red, green, blue] = [0, 1, 2].map(|i| i32::from(p[i]));
        red > 140 && red > green + 50 && green > blue + 20
    };
    let rows = |keep: &dyn Fn(&[u8]) -> bool, columns: std::ops::Range<usize>| -> Vec<usize> {
        rgb.chunks_exact(3)
            .enumerate()
            .filter(|(at, p)| columns.contains(&(at % width)) && at / width < 460 && keep(p))
            .map(|(at, _)| at / width)
            .collect()
    };
    // Letters at the left edge have coloured fringes.
    let feet = rows(&orange, width / 4..width * 3 / 4);
    assert!(feet.len() > 200, "{} orange pixels", feet.len());
    // The sky is 238 241 244; above the horizon in the middle only the robot is darker.
    let body = rows(&|p| p[0] < 200, width / 2 - 60..width / 2 + 60);
    let (top, lowest) = (body[0], feet.iter().max().unwrap());
    assert!(
        top + 150 < *lowest,
        "head at row {top}, feet down to {lowest}"
    );
    assert!(feet[0] > (top + lowest) / 2, "feet from row {}", feet[0]);
}

#[test]
fn time_runs_by_itself_and_stands_where_the_address_says() {
    let Some(browser) = needs::browser() else {
        return;
    };
    let folder = tempfile::tempdir().unwrap();
    let frame = |document: &str| -> u32 {
        let (_, rest) = document
            .split_once("data-frame=\"")
            .expect("the player ran");
        rest.split('"').next().unwrap().parse().unwrap()
    };
    let still = browse(&browser, folder.path(), "#t=0.5", 1_000, "--dump-dom");
    assert_eq!(frame(&still), 25); // 0.5 s of 20 ms
    assert!(still.contains("data-playing=\"false\""));
    // A busy machine draws few frames within a budget, and the first of them only starts the clock.
    let budgets = [1_500, 4_000, 10_000];
    let moving = budgets
        .iter()
        .map(|budget| browse(&browser, folder.path(), "", *budget, "--dump-dom"))
        .find(|document| frame(document) > 0)
        .expect("time runs within ten seconds");
    assert!(moving.contains("data-playing=\"true\""));
    assert!(
        moving.contains("id=\"trouble\" hidden"),
        "no WebGL in this browser"
    );
}

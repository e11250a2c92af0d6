//! Every format from file to clip.

use super::*;
use crate::clip::FRAME_SECONDS;
use crate::gait;
use crate::quality::Quality;

/// Writes a file and imports it.
fn imported(name: &str, bytes: &[u8], options: &Options) -> Result<Imported, String> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(name);
    std::fs::write(&path, bytes).unwrap();
    std::fs::write(folder.path().join("02.asf"), amc::tests::skeleton()).unwrap();
    import(&path, options).map_err(|e| e.to_string())
}

fn told(name: &str, bytes: &[u8]) -> Imported {
    imported(name, bytes, &Options::default()).unwrap_or_else(|e| panic!("{name}: {e}"))
}

#[test]
fn every_format_becomes_a_clip_by_its_content() {
    for (name, bytes, format, fps) in [
        (
            "a.npz",
            amass::tests::standing(60, 156),
            Format::Amass,
            100.0,
        ),
        (
            "b.bvh",
            bvh::tests::sliding(30).into_bytes(),
            Format::Bvh,
            30.0,
        ),
        (
            "02_01.amc",
            amc::tests::motion(60).into_bytes(),
            Format::Amc,
            120.0,
        ),
        (
            "c.npz",
            robot::tests::beyond_mimic_file(&joints::SDK_29),
            Format::BeyondMimic,
            50.0,
        ),
        ("d.npz", isaac::tests::lab_file(60), Format::IsaacLab, 60.0),
        ("e.npy", isaac::tests::gym_file(60), Format::IsaacGym, 60.0),
        ("f.pkl", robot::tests::gmr_file(29), Format::Gmr, 50.0),
        (
            "h.pkl",
            phc::tests::Clip::asap(30).file(),
            Format::Phc,
            30.0,
        ),
        (
            "i.pkl",
            mimickit::tests::file_of(&vec![mimickit::tests::standing(); 30]),
            Format::MimicKit,
            30.0,
        ),
        (
            "j.motion",
            proto::tests::walk(&joints::SDK_29),
            Format::ProtoMotions,
            50.0,
        ),
        (
            "k.npy",
            amp_rsl_rl::tests::npy(&amp_rsl_rl::tests::names(), 30),
            Format::AmpRslRl,
            50.0,
        ),
        (
            "l.json",
            frames::tests::deepmimic_clip(30).into_bytes(),
            Format::DeepMimic,
            50.0,
        ),
        (
            "m.txt",
            frames::tests::tienkung_clip(29, [0.0; 3]).into_bytes(),
            Format::TienKung,
            50.0,
        ),
        (
            "g.csv",
            crate::export::to_csv(&gait::walk(1.0).unwrap(), &[]).into_bytes(),
            Format::Csv,
            50.0,
        ),
    ] {
        // The name says nothing.
        let result = if name.ends_with(".amc") {
            told(name, &bytes)
        } else {
            told("motion.dat", &bytes)
        };
        assert_eq!(result.format, format, "{name}");
        assert!((result.fps - fps).abs() < 0.1, "{name}");
        let seconds = (result.frames - 1) as f64 / result.fps;
        assert!(
            (result.clip.seconds() - seconds).abs() < FRAME_SECONDS,
            "{name}"
        );
        assert!(
            result.clip.frames.iter().all(g1::RobotState::is_finite),
            "{name}"
        );
        assert!(!result.decisions.is_empty(), "{name}");
        let human = !matches!(
            format,
            Format::BeyondMimic
                | Format::Gmr
                | Format::Csv
                | Format::Phc
                | Format::ProtoMotions
                | Format::AmpRslRl
                | Format::TienKung
        );
        assert_eq!(result.retargeting.is_some(), human, "{name}");
        let quality = Quality::of(&result.clip);
        assert!(
            quality.penetration < 0.005,
            "{name}: {}",
            quality.penetration
        );
        assert!(
            quality.beyond_limits.is_empty(),
            "{name}: {:?}",
            quality.beyond_limits
        );
        assert!(
            quality.velocity_error < 1e-3,
            "{name}: {}",
            quality.velocity_error
        );
    }
}

#[test]
fn a_rate_against_the_files_own_is_refused_in_every_format_that_states_one() {
    for (name, bytes) in [
        ("a.npz", amass::tests::standing(60, 156)),
        ("b.bvh", bvh::tests::sliding(30).into_bytes()),
        ("c.npz", robot::tests::beyond_mimic_file(&joints::SDK_29)),
        ("d.npz", isaac::tests::lab_file(60)),
        ("e.npy", isaac::tests::gym_file(60)),
        ("f.pkl", robot::tests::gmr_file(29)),
        (
            "g.csv",
            crate::export::to_csv(&gait::walk(1.0).unwrap(), &[]).into_bytes(),
        ),
    ] {
        let own = told(name, &bytes).fps;
        let mut options = Options {
            fps: Some(2.0 * own),
            ..Options::default()
        };
        let message = imported(name, &bytes, &options).unwrap_err();
        for part in [name, "2.00 times as fast", "--force-fps"] {
            assert!(message.contains(part), "{part:?} is not in {message:?}");
        }
        options.force_fps = true;
        let forced = imported(name, &bytes, &options).unwrap();
        assert!((forced.fps - 2.0 * own).abs() < 1e-9, "{name}");
        let said = |d: &String| d.contains("by --force-fps");
        assert!(forced.decisions.iter().any(said), "{:?}", forced.decisions);
        options = Options {
            fps: Some(own),
            ..Options::default()
        };
        assert_eq!(imported(name, &bytes, &options).unwrap().fps, own);
    }
    // Acclaim's format has no place for a rate: 60 is news, not a contradiction.
    let options = Options {
        fps: Some(60.0),
        ..Options::default()
    };
    let motion = amc::tests::motion(60).into_bytes();
    assert_eq!(imported("02_01.amc", &motion, &options).unwrap().fps, 60.0);
}

#[test]
fn a_t_pose_before_a_capture_is_dropped_and_said() {
    // SMPL at rest stands in a T; from the second frame on its arms (joints 16 and 17) hang, turned about
    // the body's z by 80° (1.4 rad). 60 frames at 100 a second, sliding ahead.
    let (mut poses, mut trans) = (vec![0.0; 60 * 156], Vec::new());
    for i in 0..60 {
        let pose = &mut poses[i * 156..(i + 1) * 156];
        pose[0] = std::f64::consts::FRAC_PI_2;
        if i > 0 {
            (pose[3 * 16 + 2], pose[3 * 17 + 2]) = (-1.4, 1.4);
        }
        trans.extend([0.0, -0.01 * i as f64, 0.95]);
    }
    let bytes = file::npz::tests::Builder::new()
        .numbers("poses", &[60, 156], &poses)
        .numbers("trans", &[60, 3], &trans)
        .numbers("mocap_framerate", &[], &[100.0])
        .done();
    let result = told("t.npz", &bytes);
    // 59 frames last 0.58 s, which are 30 frames at 50 Hz.
    assert_eq!((result.frames, result.clip.frames.len()), (60, 30));
    let said = |words: &str| result.decisions.iter().any(|d| d.contains(words));
    assert!(said(
        "dropped the first frame, a calibration pose: the next frame is 80°"
    ));
    assert!(said("T-pose"), "{:?}", result.decisions);
}

#[test]
fn a_bow_of_the_larger_robot_is_a_bow_of_this_one() {
    // Standing for 1 s with the waist pitched by 0.2 rad (11°): x y z, qw qx qy qz, 29 joints.
    let pose: Vec<String> = joints::SDK_29
        .iter()
        .map(|name| match joints::ours().iter().position(|n| n == name) {
            Some(j) => g1::DEFAULT_POSE[j].to_string(),
            None if *name == "waist_pitch" => "0.2".into(),
            None => "0".into(),
        })
        .collect();
    let row = format!("0,0,0.8,1,0,0,0,{}\n", pose.join(","));
    let options = Options {
        fps: Some(30.0),
        ..Options::default()
    };
    let result = imported("bow.csv", row.repeat(31).as_bytes(), &options).unwrap();
    let (_, pitch, _) = result.clip.frames[25].orientation.euler_angles();
    assert!((pitch - 0.2).abs() < 1e-5, "{pitch}");
    // The hips' own −0.1 and the bow's −0.2.
    assert!((result.clip.frames[25].joint_positions[0] + 0.3).abs() < 1e-5);
    let said = |d: &String| d.starts_with("waist_pitch (11°): this robot has no such joint");
    assert!(result.decisions.iter().any(said), "{:?}", result.decisions);
}

#[test]
fn gmr_quaternions_are_read_with_the_scalar_last() {
    let walk = gait::walk(1.0).unwrap();
    let result = told("walk.pkl", &robot::tests::gmr_file(23));
    assert!(
        result.decisions.iter().any(|d| d.contains("xyzw")),
        "{:?}",
        result.decisions
    );
    for (a, b) in result.clip.frames.iter().zip(&walk.frames) {
        assert!(a.orientation.angle_to(&b.orientation) < 1e-3);
    }
}

#[test]
fn a_table_without_header_is_read_in_the_order_that_stands_upright() {
    let walk = gait::walk(1.0).unwrap();
    let text: String = walk
        .frames
        .iter()
        .map(|f| {
            let (p, q) = (f.position, f.orientation);
            let joints: Vec<String> = f.joint_positions.iter().map(f32::to_string).collect();
            format!(
                "{},{},{},{},{},{},{},{}\n",
                p.x,
                p.y,
                p.z,
                q.i,
                q.j,
                q.k,
                q.w,
                joints.join(",")
            )
        })
        .collect();
    let message = imported("walk.csv", text.as_bytes(), &Options::default()).unwrap_err();
    assert!(
        message.contains("walk.csv") && message.contains("--fps"),
        "{message}"
    );
    let with = |quaternion| Options {
        fps: Some(50.0),
        quaternion,
        ..Options::default()
    };
    let result = imported("walk.csv", text.as_bytes(), &with(None)).unwrap();
    assert!(
        result
            .decisions
            .iter()
            .any(|d| d.starts_with("quaternions xyzw")),
        "{:?}",
        result.decisions
    );
    assert!((result.clip.command[0] - 1.0).abs() < 0.03);
    let wrong = imported(
        "walk.csv",
        text.as_bytes(),
        &with(Some(QuaternionOrder::Wxyz)),
    )
    .unwrap();
    assert_ne!(wrong.clip, result.clip); // the user's word counts
}

#[test]
fn a_wrong_rate_or_format_is_refused() {
    let bytes = bvh::tests::sliding(30).into_bytes();
    let options = Options {
        fps: Some(0.0),
        ..Options::default()
    };
    assert!(
        imported("a.bvh", &bytes, &options)
            .unwrap_err()
            .contains("--fps")
    );
    for format in Format::ALL.into_iter().filter(|f| *f != Format::Bvh) {
        let options = Options {
            format: Some(format),
            ..Options::default()
        };
        let message = imported("a.bvh", &bytes, &options).unwrap_err();
        assert!(message.contains("a.bvh"), "{format}: {message}");
    }
    let message = imported(
        "a.bvh",
        bvh::tests::sliding(1).as_bytes(),
        &Options::default(),
    )
    .unwrap_err();
    assert!(message.contains("0.04 s"), "{message}");
}

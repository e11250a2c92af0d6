use super::*;
use crate::gait;
use g1::FEATURES;
use g1::observation::features;
use rand::SeedableRng;
use rand_pcg::Pcg64Mcg;

/// A clip whose frames are told apart by height: `base`, `base` + 1, …
fn numbered(base: f32, frames: usize, cyclic: bool, weight: f32) -> Clip {
    let frame = |i: usize| {
        let mut state = RobotState::standing();
        state.position.z = base + i as f32;
        state
    };
    Clip {
        name: format!("from {base}"),
        frames: (0..frames).map(frame).collect(),
        cyclic,
        command: [base, 0.0, 0.0],
        weight,
    }
}

#[test]
fn the_files_of_a_configuration_are_all_that_it_reads() {
    let folder = tempfile::tempdir().unwrap();
    for name in ["b.csv", "a.csv", "notes.txt", "02_01.amc", "02.asf"] {
        std::fs::write(folder.path().join(name), "").unwrap();
    }
    let files = |text: &str| {
        let config: MotionConfig = toml::from_str(text).unwrap();
        let files = Dataset::files(&config, folder.path()).unwrap();
        let names = files
            .iter()
            .map(|file| file.strip_prefix(folder.path()).unwrap());
        names
            .map(|name| name.display().to_string())
            .collect::<Vec<_>>()
    };
    assert_eq!(files("clips = [{ gait = 'walk', speed = 0.8 }]"), [""; 0]);
    // A skeleton is learned from as well, and a file that is named twice is one.
    assert_eq!(
        files("clips = [{ folder = '.' }, { file = '02_01.amc' }, { file = 'a.csv' }]"),
        ["a.csv", "b.csv", "02.asf", "02_01.amc"]
    );
}

#[test]
fn a_window_tells_the_command_that_it_obeys() {
    let mut rng = Pcg64Mcg::seed_from_u64(3);
    let mut window = [0.0; 2 * FEATURES];
    let walk = Dataset::of(vec![gait::walk(0.8).expect("a gait")]);
    let asked = walk.clips()[0].command;
    assert_eq!(walk.sample_window(&mut rng, 1, &mut window), asked);
    // A robot that sets off is not there yet: its speed as of now, between none and the last.
    let start = Dataset::of(vec![gait::start(0.8).expect("a gait")]);
    let speeds: Vec<f32> = (0..300)
        .map(|_| {
            let [forward, ..] = start.sample_window(&mut rng, 1, &mut window);
            assert!((forward - (window[1] + window[FEATURES + 1]) / 2.0).abs() < 1e-6);
            forward
        })
        .collect();
    assert!(speeds.iter().any(|speed| *speed < 0.2) && speeds.iter().any(|speed| *speed > 0.6));
}

#[test]
fn transitions_join_successive_frames_and_wrap_only_in_cycles() {
    let data = Dataset::of(vec![
        numbered(0.0, 3, true, 1.0),
        numbered(10.0, 3, false, 1.0),
    ]);
    assert_eq!(data.transitions(), 3 + 2);
    let mut rng = Pcg64Mcg::seed_from_u64(7);
    let (mut out, mut seen) = ([0.0; 2 * FEATURES], Vec::new());
    for _ in 0..200 {
        data.sample_window(&mut rng, 1, &mut out);
        seen.push((out[0] as i32, out[FEATURES] as i32));
    }
    seen.sort_unstable();
    seen.dedup();
    assert_eq!(seen, [(0, 1), (1, 2), (2, 0), (10, 11), (11, 12)]);

    // Four steps: back beyond the beginning, where only a cycle goes on.
    let (mut out, mut seen) = ([0.0; 4 * FEATURES], Vec::new());
    for _ in 0..200 {
        data.sample_window(&mut rng, 1, &mut out);
        seen.push([0, 1, 2, 3].map(|step| out[step * FEATURES] as i32));
    }
    seen.sort_unstable();
    seen.dedup();
    let expected = [
        [0, 1, 2, 0],
        [1, 2, 0, 1],
        [2, 0, 1, 2],
        [10, 10, 10, 11],
        [10, 10, 11, 12],
    ];
    assert_eq!(seen, expected);

    // Three states, each the second after the one before.
    let (mut out, mut seen) = ([0.0; 3 * FEATURES], Vec::new());
    for _ in 0..200 {
        data.sample_window(&mut rng, 2, &mut out);
        seen.push([0, 1, 2].map(|step| out[step * FEATURES] as i32));
    }
    seen.sort_unstable();
    seen.dedup();
    let expected = [[0, 2, 1], [1, 0, 2], [2, 1, 0], [10, 10, 11], [10, 10, 12]];
    assert_eq!(seen, expected);
}

#[test]
fn clips_are_drawn_by_weight_not_by_length() {
    let data = Dataset::of(vec![
        numbered(0.0, 300, true, 1.0),
        numbered(1000.0, 3, true, 3.0),
    ]);
    let mut rng = Pcg64Mcg::seed_from_u64(1);
    let drawn = (0..4000)
        .filter(|_| data.sample_frame(&mut rng).1[0] == 1000.0)
        .count();
    assert!((2900..3100).contains(&drawn), "{drawn}"); // 3/4 of 4000, σ = 27
    let share: f32 = data
        .frames()
        .filter(|f| f.1[0] == 1000.0)
        .map(|f| f.2)
        .sum();
    assert!((share - 3.0).abs() < 1e-5);
}

#[test]
fn the_default_walks_at_five_speeds_and_their_mirror_images() {
    let data = Dataset::load(&MotionConfig::default(), Path::new("/nowhere")).unwrap();
    assert_eq!(data.clips().len(), 10);
    let total: f32 = data.clips().iter().map(|c| c.weight).sum();
    assert!((total - 7.0).abs() < 1e-5); // 1 + 1 + 1 + 3 + 1, halved and doubled
    let speeds: Vec<f32> = data.clips().iter().step_by(2).map(Clip::speed).collect();
    assert_eq!(speeds, [0.4, 0.6, 0.8, 0.98, 1.2]);
    let text = data.describe();
    assert!(
        text.contains("walk 0.98 m/s mirrored: ") && text.contains("21.4 %"),
        "{text}"
    );
}

#[test]
fn a_cyclic_clip_wraps_without_a_jump() {
    let walk = gait::walk(0.8).unwrap();
    let n = walk.frames.len();
    let largest = |i: usize| {
        let (mut a, mut b) = ([0.0; FEATURES], [0.0; FEATURES]);
        features(&walk.frames[i], &mut a);
        features(&walk.frames[(i + 1) % n], &mut b);
        (7..30).map(|j| (a[j] - b[j]).abs()).fold(0.0, f32::max)
    };
    let usual = (0..n - 1).map(largest).fold(0.0, f32::max);
    assert!(largest(n - 1) <= usual, "{} after {usual}", largest(n - 1));
}

#[test]
fn a_folder_shares_its_weight_by_duration() {
    let folder = tempfile::tempdir().unwrap();
    let config = |text: &str| toml::from_str::<MotionConfig>(text).unwrap();
    let named = config("mirror = false\nclips = [{ folder = \"set\", weight = 2.0 }]");
    assert!(Dataset::load(&named, folder.path()).is_err()); // not there
    let set = folder.path().join("set");
    std::fs::create_dir(&set).unwrap();
    let message = Dataset::load(&named, folder.path())
        .unwrap_err()
        .to_string();
    assert!(
        message.contains("no .csv") && message.contains("motions import"),
        "{message}"
    );
    let mut walk = gait::walk(1.0).unwrap();
    std::fs::write(set.join("b.csv"), crate::export::to_csv(&walk, &[])).unwrap();
    let whole = walk.frames.len();
    walk.frames.truncate(whole / 2);
    std::fs::write(set.join("a.csv"), crate::export::to_csv(&walk, &[])).unwrap();
    std::fs::write(set.join("notes.json"), "{}").unwrap();
    let data = Dataset::load(&named, folder.path()).unwrap();
    let names: Vec<&str> = data.clips().iter().map(|c| c.name.as_str()).collect();
    assert_eq!(names, ["a", "b"]);
    let weights: Vec<f32> = data.clips().iter().map(|c| c.weight).collect();
    assert!((weights[0] + weights[1] - 2.0).abs() < 1e-6);
    let shares = (whole / 2 - 1) as f32 / (whole - 1) as f32;
    assert!((weights[0] / weights[1] - shares).abs() < 1e-4);
}

#[test]
fn the_same_seed_draws_the_same() {
    let data = Dataset::of(vec![gait::stand(), gait::walk(1.0).unwrap()]);
    let draw = || {
        let mut rng = Pcg64Mcg::seed_from_u64(3);
        let mut out = [0.0; 2 * FEATURES];
        (0..10)
            .map(|_| {
                data.sample_window(&mut rng, 1, &mut out);
                out
            })
            .collect::<Vec<_>>()
    };
    assert_eq!(draw(), draw());
}

#[test]
fn clips_of_files_are_examined_and_built_in_ones_are_sound() {
    let folder = tempfile::tempdir().unwrap();
    let mut moved = gait::walk(1.0).unwrap();
    for frame in &mut moved.frames[20..] {
        frame.position.y += 5.0;
    }
    let table = |clip| crate::export::to_csv(clip, &["made for a test".into()]);
    std::fs::write(folder.path().join("moved.csv"), table(&moved)).unwrap();
    std::fs::write(
        folder.path().join("sound.csv"),
        table(&gait::walk(1.0).unwrap()),
    )
    .unwrap();
    let config: MotionConfig =
        toml::from_str(r#"clips = [{ folder = "." }, { gait = "walk", speed = -0.5 }]"#).unwrap();
    let references = Dataset::read(&config, folder.path()).unwrap();
    let kinds: Vec<Vec<crate::quality::Kind>> = references
        .iter()
        .map(|reference| reference.defects().iter().map(|d| d.kind).collect())
        .collect();
    assert_eq!(
        kinds,
        [vec![crate::quality::Kind::Teleport], vec![], vec![]]
    );
    assert!((references[0].clip.weight - 0.5).abs() < 1e-6); // half of the folder's weight
}

#[test]
fn clips_are_seen_as_a_list_says_and_obey_what_they_obeyed() {
    let table = Table::plain(["key_bodies", "height"]);
    let start = || Dataset::of(vec![gait::start(0.8).expect("a gait")]);
    let (paper, other) = (start(), start().seen_as(&table));
    assert_eq!((paper.width(), other.width()), (FEATURES, 16));
    let mut rngs = [Pcg64Mcg::seed_from_u64(3), Pcg64Mcg::seed_from_u64(3)];
    let (mut a, mut b) = ([0.0; 2 * FEATURES], [0.0; 2 * 16]);
    for _ in 0..20 {
        let command = paper.sample_window(&mut rngs[0], 1, &mut a);
        assert_eq!(other.sample_window(&mut rngs[1], 1, &mut b), command);
        // The same frames: the height is first in one and last in the other.
        assert_eq!([a[0], a[FEATURES]], [b[15], b[31]]);
    }
}

#[test]
fn motion_near_a_command_is_drawn_in_its_place() {
    let walk = |speed| gait::walk(speed).expect("a gait");
    let mut data = Dataset::of(vec![walk(0.4), walk(0.7), gait::stand()]);
    assert!(!data.is_drawn_by_commands());
    data.by_commands = true;
    let mut rng = Pcg64Mcg::seed_from_u64(7);
    let mut out = [0.0; 2 * FEATURES];
    let mut count = |command: [f32; 3], speed: f32| {
        let drawn = (0..4000).map(|_| data.sample_window_near(command, &mut rng, 1, &mut out));
        drawn.filter(|told| (told[0] - speed).abs() < 1e-3).count()
    };
    // 0.7 is 0.3 = two times 0.15 away: e⁻² = 0.135 for 1 at 0.4, and 0.029 for standing, 2.67 times away: .135/1.164 of
    // 4,000 is 465, σ = 20.
    let slower = count([0.4, 0.0, 0.0], 0.7);
    assert!((385..545).contains(&slower), "{slower}");
    // Halfway they are alike, and standing has e^(−6.7 + 0.5) of it.
    let half = count([0.55, 0.0, 0.0], 0.4);
    assert!((1870..2130).contains(&half), "{half}");
    // However far all of it is, the nearest is shown.
    assert!(count([9.0, 0.0, 3.0], 0.7) == 4000);
}

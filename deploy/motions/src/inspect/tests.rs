//! Where figures are drawn, and what is never drawn over.

use super::*;
use clap::Parser;
use std::fs;
use std::os::unix::fs::symlink;
use std::path::Path;
use terminal::failure::Usage;

#[derive(Debug, Parser)]
struct Line {
    #[command(flatten)]
    inspect: Inspect,
}

fn inspect(arguments: &[&Path]) -> Result<()> {
    let line = std::iter::once(Path::new("inspect")).chain(arguments.iter().copied());
    Line::try_parse_from(line).unwrap().inspect.run()
}

/// A folder with clips of some names.
fn clips(names: &[&str]) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    for name in names {
        let path = folder.path().join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        let text = motion::export::to_csv(&motion::gait::walk(1.0).unwrap(), &[]);
        fs::write(path, text).unwrap();
    }
    folder
}

/// Says that drawing is refused as something to be typed otherwise.
fn refused(arguments: &[&Path], words: &str) {
    let error = inspect(arguments).unwrap_err();
    assert!(error.is::<Usage>(), "{error:#}");
    let message = error.to_string();
    assert!(message.contains(words), "{words:?} is not in {message:?}");
    assert!(!message.contains("--out"), "{message}");
}

#[test]
fn a_figure_replaces_a_figure_of_the_same_clip_and_nothing_else() {
    let folder = clips(&["walk.csv"]);
    let (clip, plots) = (folder.path().join("walk.csv"), folder.path().join("plots"));
    let drawn = plots.join("walk.svg");
    let line = [&*clip, Path::new("--plots"), &*plots];
    inspect(&line).unwrap();
    let first = fs::read_to_string(&drawn).unwrap();
    inspect(&line).unwrap();
    assert_eq!(fs::read_to_string(&drawn).unwrap(), first);
    for foreign in ["mine", "<svg></svg>", ""] {
        fs::write(&drawn, foreign).unwrap();
        refused(
            &line,
            "walk.svg is there and was not written by this command",
        );
        assert_eq!(fs::read_to_string(&drawn).unwrap(), foreign);
    }
    // A link to a figure that is ours is a link all the same.
    let elsewhere = folder.path().join("elsewhere.svg");
    fs::write(&elsewhere, &first).unwrap();
    fs::remove_file(&drawn).unwrap();
    symlink(&elsewhere, &drawn).unwrap();
    refused(&line, "walk.svg is a link");
    assert_eq!(fs::read_to_string(&elsewhere).unwrap(), first);
    assert_eq!(fs::read_dir(&plots).unwrap().count(), 1);
}

#[test]
fn a_source_is_never_drawn_over() {
    let folder = tempfile::tempdir().unwrap();
    let (source, link) = (folder.path().join("walk.svg"), folder.path().join("x"));
    fs::write(&source, "mine").unwrap();
    symlink(folder.path(), &link).unwrap();
    for plots in [folder.path(), &link] {
        let words = "walk.svg is one of the files that are read";
        refused(&[&source, Path::new("--plots"), plots], words);
        assert_eq!(fs::read_to_string(&source).unwrap(), "mine");
    }
    refused(&[&source, Path::new("--plots"), &source], "--plots");
}

#[test]
fn only_figures_need_names_of_their_own() {
    let folder = clips(&["a/walk.csv", "b/walk.csv"]);
    let (a, b) = (
        folder.path().join("a/walk.csv"),
        folder.path().join("b/walk.csv"),
    );
    inspect(&[&a, &b]).unwrap();
    let plots = folder.path().join("plots");
    let words = "walk.svg would hold two clips";
    refused(&[&a, &b, Path::new("--plots"), &plots], words);
    assert!(!plots.exists());
}

#[test]
fn what_is_hardly_below_zero_is_shown_as_zero() {
    assert_eq!(format!("{:.2}", hundredths(-0.004)), "0.00");
    assert_eq!(format!("{:.2}", hundredths(-0.006)), "-0.01");
}

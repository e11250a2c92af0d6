//! Files that are something else than their name says.

use super::*;

/// What a file of that name is refused with; a good skeleton lies beside it.
fn refused(name: &str, bytes: &[u8], format: Option<Format>) -> String {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(name);
    std::fs::write(folder.path().join("02.asf"), amc::tests::skeleton()).unwrap();
    std::fs::write(&path, bytes).unwrap();
    let options = Options {
        format,
        ..Options::default()
    };
    let error = import(&path, &options).unwrap_err().to_string();
    let place = folder.path().display().to_string();
    error.replace(&place, "")
}

const NAMES: [&str; 6] = ["a.npz", "a.bvh", "02_01.amc", "a.csv", "a.pkl", "a.npy"];

const POINTER: &[u8] =
    b"version https://git-lfs.github.com/spec/v1\noid sha256:4d7a214614ab2935c943f9e0ff69d22e\nsize 12345\n";

#[test]
fn what_a_file_is_instead_is_said_whatever_it_is_called() {
    let page = format!(
        "<!DOCTYPE html><html><body>{}</body></html>",
        "x".repeat(5_000)
    );
    let files = [
        (
            POINTER,
            "is a Git LFS pointer and not the file itself; fetch the file with git lfs pull",
        ),
        (
            b"Kaydara FBX Binary  \0\x1a\0\xe8\x1c\0\0",
            "is an FBX file; convert it to BVH",
        ),
        (
            b"; FBX 7.4.0 project file\nFBXHeaderExtension:  {\n",
            "is an FBX file (as text); convert it to BVH",
        ),
        (
            page.as_bytes(),
            "is a web page (HTML); the link led to a page",
        ),
        (b"", "is empty; download or export it again"),
    ];
    let formats = Format::ALL.into_iter().map(Some);
    for format in formats.chain([None]) {
        for name in NAMES {
            for (bytes, what) in files {
                let said = refused(name, bytes, format);
                assert!(
                    said.starts_with(&format!("/{name}: {what}")),
                    "{format:?}: {said}"
                );
            }
        }
    }
}

#[test]
fn so_it_is_of_the_skeleton_beside_a_motion() {
    let folder = tempfile::tempdir().unwrap();
    let (motion, skeleton) = (
        folder.path().join("02_01.amc"),
        folder.path().join("02.asf"),
    );
    std::fs::write(&motion, amc::tests::motion(60)).unwrap();
    std::fs::write(&skeleton, POINTER).unwrap();
    let said = import(&motion, &Options::default())
        .unwrap_err()
        .to_string();
    assert!(said.contains("02.asf: is a Git LFS pointer"), "{said}");
}

#[test]
fn a_name_that_promises_another_format_is_the_reason() {
    for (name, ending) in [
        ("a.npz", "npz"),
        ("a.NPY", "npy"),
        ("a.pkl", "pkl"),
        ("a.bvh", "bvh"),
        ("b.amc", "amc"),
    ] {
        let said = refused(name, b"Access denied\nretry later", None);
        let reason =
            format!("/{name}: is no .{ending} file: it begins with \"Access denied…\"; download");
        assert!(said.starts_with(&reason), "{said}");
    }
    let table = refused("a.csv", b"Access denied\nretry later", None);
    assert!(
        table.contains("unknown column \"Access denied\""),
        "{table}"
    );
    // A table under a wrong name is read all the same.
    let sound = crate::export::to_csv(&crate::gait::walk(1.0).unwrap(), &[]);
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.bvh");
    std::fs::write(&path, sound).unwrap();
    assert_eq!(
        import(&path, &Options::default()).unwrap().format,
        Format::Csv
    );
}

#[test]
fn no_more_than_a_line_of_a_wrong_file_is_shown() {
    let long = "A".repeat(1_800_000);
    let pickle = [b"\x80\x04c", long.as_bytes(), b"\nB\n)R."].concat();
    let texts = [
        long.clone(),
        format!("{long},{long}"),
        "A\x1b[2J ".repeat(300_000),
        "\"`A".repeat(300_000),
        format!("1\n{long} 1 2 3\n"),
        format!("{}\n", "A,".repeat(900_000)),
        format!("HIERARCHY\nROOT Hips\n{{\n{long} 0 0 0\n}}\n"),
        format!("HIERARCHY\nROOT Hips\n{{\nOFFSET {long} 0 0\n}}\n"),
        format!("HIERARCHY\nROOT Hips\n{{\nCHANNELS 1 {long}\n}}\n"),
        format!("1\nroot {long}\n"),
    ];
    let files = texts.iter().map(String::as_bytes).chain([&pickle[..]]);
    for bytes in files {
        for name in NAMES {
            let said = refused(name, bytes, None);
            assert!(
                said.chars().count() < 800,
                "{} characters: {said:.900}",
                said.len()
            );
            assert!(!said.contains(char::is_control), "{said:?}");
            assert!(!said.contains(&"A".repeat(101)), "{said}");
        }
    }
}

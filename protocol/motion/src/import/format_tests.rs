//! What a file is told to be, by its content.

use super::*;
use crate::import::file::npz::tests::Builder;

fn told(bytes: &[u8]) -> Result<Format, String> {
    let path = Path::new("motion");
    detect(&File { path, bytes })
        .map(|(format, _)| format)
        .map_err(|e| e.to_string())
}

#[test]
fn text_is_told_by_its_first_words() {
    assert_eq!(told(b"HIERARCHY\nROOT Hips"), Ok(Format::Bvh));
    assert_eq!(told(b"\xef\xbb\xbfhierarchy\r\n"), Ok(Format::Bvh));
    assert_eq!(told(b"#!OML:ASF x\n:FULLY-SPECIFIED\n"), Ok(Format::Amc));
    assert_eq!(told(b"x,y,z\n1,2,3"), Ok(Format::Csv));
    assert_eq!(told(b""), Ok(Format::Csv));
    assert_eq!(
        told(b"{\n\"Loop\": \"wrap\", \"Frames\": []}"),
        Ok(Format::DeepMimic)
    );
    assert_eq!(
        told(b"{\"FrameDuration\": 1, \"Frames\": []}"),
        Ok(Format::TienKung)
    );
    assert!(
        told(b"{\"name\": \"walk\"}")
            .unwrap_err()
            .contains("without Frames")
    );
    let message = told(b":version 1.10\n:bonedata").unwrap_err();
    assert!(message.contains(".amc"), "{message}");
}

#[test]
fn bytes_are_told_by_their_marks() {
    let message = told(b"\x93NUMPY\x01\x00").unwrap_err();
    assert!(message.contains("cut off"), "{message}");
    let message = told(b"\x80\x04\x95").unwrap_err();
    assert!(message.contains("cut off"), "{message}");
    let message = told(b"\x80\x04}\x8c\x01aK\x01s.").unwrap_err();
    assert!(message.contains("pickle with a,"), "{message}");
    let cases: [(&[u8], &str); 5] = [
        (b"\x80\x04}.", "an empty dictionary"),
        (b"\x80\x04].", "an empty list"),
        (b"\x80\x04](K\x01K\x02e.", "a list of 2 values"),
        (
            b"\x80\x04}K\x01K\x02s.",
            "a dictionary without names of 1 value",
        ),
        (b"\x80\x04K\x07.", "the number 7"),
    ];
    for (bytes, holds) in cases {
        let message = told(bytes).unwrap_err();
        assert!(
            message.contains(&format!("pickle with {holds}, which")),
            "{message}"
        );
    }
    let message = told(b"\x80\x02\x8a\nl\xfc\x9cF\xf9 j\xa8P\x19.\x80\x02M").unwrap_err();
    assert!(message.contains("torch.save"), "{message}");
    let message = told(b"PK\x03\x04 cut off").unwrap_err();
    assert!(message.contains("again"), "{message}");
}

#[test]
fn the_shape_of_a_body_is_no_motion() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    // AMASS's shape.npz and SMPL-X's …_stagei.npz.
    let shape = Builder::new()
        .numbers("betas", &[16], &[0.0; 16])
        .words("gender", &["male"]);
    let markers = Builder::new().numbers("betas", &[16], &[0.0; 16]).numbers(
        "markers_latent",
        &[1, 3],
        &[0.0; 3],
    );
    let motion =
        Builder::new()
            .numbers("betas", &[16], &[0.0; 16])
            .numbers("poses", &[1, 1], &[0.0]);
    for (name, archive, expected) in [
        ("shape.npz", shape, true),
        ("male_stagei.npz", markers, true),
        ("walk.npz", motion, false),
    ] {
        let bytes = archive.done();
        std::fs::write(path(name), &bytes).unwrap();
        assert_eq!(is_body_shape(&path(name)), expected, "{name}");
        let message = told(&bytes).unwrap_err();
        assert_eq!(
            message.contains("shape of a body and no motion"),
            expected,
            "{message}"
        );
    }
    std::fs::write(path("cut.npz"), b"PK\x03\x04").unwrap();
    for name in ["cut.npz", "none.npz", "."] {
        assert!(!is_body_shape(&path(name)), "{name}");
    }
}

#[test]
fn clips_among_text_files_are_told_by_their_beginning() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.txt");
    for (text, expected) in [
        ("{\n\"Loop\": \"wrap\",\n\"Frames\":\n[", true),
        ("\u{feff} {\"Frames\": []}", true),
        ("{\"name\": \"walk\", \"defects\": []}", false),
        ("The word \"Frames\"", false),
        ("", false),
    ] {
        std::fs::write(&path, text).unwrap();
        assert_eq!(is_text_of_frames(&path), expected, "{text}");
    }
    assert!(!is_text_of_frames(folder.path()));
}

#[test]
fn names_are_read_back() {
    for format in Format::ALL {
        assert_eq!(format.to_string().parse(), Ok(format));
    }
    assert!("fbx".parse::<Format>().unwrap_err().contains("bvh"));
}

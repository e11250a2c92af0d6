//! What a file is, by the bytes that its makers begin it with.
//!
//! Separate because it is a list: one entry, one kind of file that people hand over by mistake.

use std::fmt;

/// A file that is something else than what was asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Foreign {
    /// As in "is …".
    pub what: &'static str,
    /// What to do.
    pub remedy: &'static str,
}

impl fmt::Display for Foreign {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "it is {}; {}", self.what, self.remedy)
    }
}

const TO_BVH: &str = "convert it to BVH, for example with Blender";
const UNPACK: &str = "unpack it first";
const ARRAYS: &str = "save its arrays as .npz with numpy.savez";
const NO_DATA: &str = "give the file that holds the data";
const PAGE: &str =
    "the link led to a page, perhaps of a login or an error: download the file itself";

/// First bytes, and what begins with them.
const MARKS: [(&[u8], &str, &str); 38] = [
    (
        b"version https://git-lfs.github.com/spec/",
        "a Git LFS pointer and not the file itself",
        "fetch the file with git lfs pull",
    ),
    (
        b"/annex/objects/",
        "a git-annex pointer and not the file itself",
        "fetch the file with git annex get",
    ),
    (b"Kaydara FBX Binary", "an FBX file", TO_BVH),
    (b"; FBX", "an FBX file (as text)", TO_BVH),
    (b"glTF", "a glTF model (.glb, .vrm)", TO_BVH),
    (b"BLENDER", "a Blender file", "export its motion as BVH"),
    (b"PXR-USDC", "a USD file", TO_BVH),
    (b"#usda", "a USD file (as text)", TO_BVH),
    (b"//Maya ASCII", "a Maya file", TO_BVH),
    (
        b"Vocaloid Motion Data",
        "a MikuMikuDance motion (.vmd)",
        TO_BVH,
    ),
    (b"\x89HDF\r\n\x1a\n", "an HDF5 file", ARRAYS),
    (b"MATLAB 5.0 MAT-file", "a MATLAB file", ARRAYS),
    (b"PAR1", "a Parquet file", ARRAYS),
    (b"#ROSBAG", "a ROS bag", ARRAYS),
    (b"\x89MCAP0", "an MCAP recording", ARRAYS),
    (b"SQLite format 3\0", "an SQLite database", ARRAYS),
    (b"\x1f\x8b", "compressed (gzip)", UNPACK),
    (b"BZh", "compressed (bzip2)", UNPACK),
    (b"\xfd7zXZ\0", "compressed (xz)", UNPACK),
    (b"\x28\xb5\x2f\xfd", "compressed (zstd)", UNPACK),
    (b"\x04\x22\x4d\x18", "compressed (lz4)", UNPACK),
    (b"7z\xbc\xaf\x27\x1c", "a 7z archive", UNPACK),
    (b"Rar!\x1a\x07", "a RAR archive", UNPACK),
    (b"\x89PNG\r\n\x1a\n", "a picture (PNG)", NO_DATA),
    (b"\xff\xd8\xff", "a picture (JPEG)", NO_DATA),
    (b"GIF8", "a picture (GIF)", NO_DATA),
    (b"RIFF", "a sound, video or picture (RIFF)", NO_DATA),
    (b"OggS", "a sound or video (Ogg)", NO_DATA),
    (b"\x1a\x45\xdf\xa3", "a video (Matroska)", NO_DATA),
    (b"%PDF-", "a PDF", NO_DATA),
    (b"{\\rtf", "a text document (RTF)", NO_DATA),
    (
        b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1",
        "an old Office document",
        "save the table as CSV",
    ),
    (b"\x7fELF", "a program", NO_DATA),
    (b"MZ\x90\0", "a program", NO_DATA),
    (b"\xff\xfe", "text in UTF-16", "save it as UTF-8"),
    (b"\xfe\xff", "text in UTF-16", "save it as UTF-8"),
    (b"-----BEGIN ", "a key or certificate", NO_DATA),
    (b"diff --git ", "a patch", NO_DATA),
];

/// First words of a tag, in small letters, and what they open.
const TAGS: [(&str, &str, &str); 10] = [
    ("<!doctype html", "a web page (HTML)", PAGE),
    ("<html", "a web page (HTML)", PAGE),
    ("<head", "a web page (HTML)", PAGE),
    ("<body", "a web page (HTML)", PAGE),
    ("<script", "a web page (HTML)", PAGE),
    ("<error", "the error message of a server (XML)", PAGE),
    ("<mujoco", "a MuJoCo model, which holds no motion", NO_DATA),
    (
        "<robot",
        "a robot's description (URDF), which holds no motion",
        NO_DATA,
    ),
    ("<collada", "a Collada file", TO_BVH),
    ("<svg", "a picture (SVG)", NO_DATA),
];

/// So much is looked at where a mark may stand behind other text.
const LOOKED_AT: usize = 4096;

/// What a file is that nothing here reads; `None` for one that may be what its name says.
pub fn foreign(bytes: &[u8]) -> Option<Foreign> {
    let found = |what, remedy| Some(Foreign { what, remedy });
    if bytes.is_empty() {
        return found("empty", "download or export it again");
    }
    let bare = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    let bare = bare.trim_ascii_start();
    for (mark, what, remedy) in MARKS {
        if bytes.starts_with(mark) || (mark[0].is_ascii_graphic() && bare.starts_with(mark)) {
            return found(what, remedy);
        }
    }
    let head = &bytes[..bytes.len().min(LOOKED_AT)];
    if head.iter().all(|byte| *byte == 0) {
        return found(
            "full of zeros, as a download that was broken off leaves it",
            "download it again",
        );
    }
    if head.get(257..262) == Some(b"ustar") {
        return found("an archive (tar)", UNPACK);
    }
    if head.get(4..8) == Some(b"ftyp") {
        return found("a video (MP4)", NO_DATA);
    }
    // C3D: the block where its parameters begin, then always 0x50.
    if head.len() >= 512 && head[1] == 0x50 && (1..=16).contains(&head[0]) {
        return found(
            "a C3D file, which holds markers and no skeleton",
            "solve a skeleton and export it as BVH",
        );
    }
    markup(bare)
}

/// What an HTML or XML file is by the first tag that says it.
fn markup(bare: &[u8]) -> Option<Foreign> {
    if bare.first() != Some(&b'<') {
        return None;
    }
    let head = String::from_utf8_lossy(&bare[..bare.len().min(LOOKED_AT)]).to_lowercase();
    let first = TAGS
        .iter()
        .filter_map(|tag| Some((head.find(tag.0)?, tag)))
        .min_by_key(|(at, _)| *at);
    Some(match first {
        Some((_, &(_, what, remedy))) => Foreign { what, remedy },
        None => Foreign {
            what: "XML",
            remedy: NO_DATA,
        },
    })
}

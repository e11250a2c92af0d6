//! Compressed files: joblib packs pickles with zlib by default, and people pack anything with gzip.
//!
//! Separate because what is inside is read as if it had never been packed.

use super::{File, LARGEST};
use crate::error::MotionError;
use flate2::read::{MultiGzDecoder, ZlibDecoder};
use std::io::Read;

/// What a compressed file begins with, and its name.
const MARKS: [(&[u8], &str); 10] = [
    (b"\x1f\x8b", "gzip"),
    (b"\x78\x01", "zlib"),
    (b"\x78\x5e", "zlib"),
    (b"\x78\x9c", "zlib"),
    (b"\x78\xda", "zlib"),
    (b"BZh", "bzip2"),
    (b"\xfd7zXZ\0", "xz"),
    (b"\x5d\0\0", "lzma"),
    (b"\x04\x22\x4d\x18", "lz4"),
    (b"\x28\xb5\x2f\xfd", "zstandard"),
];

/// What is inside a compressed file and how it was packed; `None` if it is not compressed.
///
/// # Errors
/// A file that is cut off, larger inside than files may be, or packed in a way that is not read.
pub(in crate::import) fn unpacked(
    file: &File<'_>,
) -> Result<Option<(Vec<u8>, &'static str)>, MotionError> {
    let mark = MARKS.iter().find(|(mark, _)| file.bytes.starts_with(mark));
    let Some(&(_, name)) = mark else {
        return Ok(None);
    };
    let reader: Box<dyn Read + '_> = match name {
        "gzip" => Box::new(MultiGzDecoder::new(file.bytes)),
        "zlib" => Box::new(ZlibDecoder::new(file.bytes)),
        _ => {
            return Err(file.unusable(
                &format!("is compressed with {name}, which is not read"),
                "unpack it; a pickle of joblib with python -c \"import joblib, sys; \
                 joblib.dump(joblib.load(sys.argv[1]), sys.argv[2])\" FILE UNPACKED.pkl",
            ));
        }
    };
    let mut bytes = Vec::new();
    reader
        .take(LARGEST + 1)
        .read_to_end(&mut bytes)
        .map_err(|error| {
            file.unusable(
                &format!("cannot be unpacked ({name}: {error})"),
                "download or export it again: it may be cut off",
            )
        })?;
    if bytes.len() as u64 > LARGEST {
        return Err(file.unusable(
            &format!("is larger than 512 MiB inside its {name}"),
            "cut it into parts",
        ));
    }
    Ok(Some((bytes, name)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use flate2::Compression;
    use flate2::write::{GzEncoder, ZlibEncoder};
    use std::io::Write;
    use std::path::Path;

    fn inside(bytes: &[u8]) -> Result<Option<(Vec<u8>, &'static str)>, String> {
        let path = Path::new("walk.pkl");
        unpacked(&File { path, bytes }).map_err(|e| e.to_string())
    }

    fn zlib(bytes: &[u8]) -> Vec<u8> {
        let mut encoder = ZlibEncoder::new(Vec::new(), Compression::new(3));
        encoder.write_all(bytes).unwrap();
        encoder.finish().unwrap()
    }

    #[test]
    fn zlib_and_gzip_are_unpacked() {
        let packed = zlib(b"walk");
        assert_eq!(inside(&packed), Ok(Some((b"walk".to_vec(), "zlib"))));
        // joblib.dump({'fps': 30}, FILE, compress=3) of joblib 1.6.
        let joblib =
            b"x^k`\x99\xca\xc3\x00\x01\xb5Sz\x98\xd3\n\x8a\xa7x\xcb\x15\xeb\x01\x009S\x05\xad";
        let (pickle, _) = inside(joblib).unwrap().unwrap();
        assert!(pickle.starts_with(b"\x80\x04") && pickle.ends_with(b"\x8c\x03fps\x94K\x1es."));
        // Two members, as cat a.gz b.gz makes them.
        let mut members = Vec::new();
        for part in [&b"wa"[..], b"lk"] {
            let mut encoder = GzEncoder::new(Vec::new(), Compression::default());
            encoder.write_all(part).unwrap();
            members.extend(encoder.finish().unwrap());
        }
        assert_eq!(inside(&members), Ok(Some((b"walk".to_vec(), "gzip"))));
        assert_eq!(inside(b"x,y,z"), Ok(None));
        assert_eq!(inside(b""), Ok(None));
    }

    #[test]
    fn what_is_cut_off_or_packed_otherwise_is_named() {
        let whole = zlib(&[7; 500]);
        for cut in 2..whole.len() {
            let message = inside(&whole[..cut]).unwrap_err();
            assert!(
                message.contains("walk.pkl") && message.contains("zlib"),
                "{message}"
            );
        }
        for (bytes, name) in [
            (&b"BZh31AY&"[..], "bzip2"),
            (b"\xfd7zXZ\0\0\x04", "xz"),
            (b"\x5d\0\0\x40\0", "lzma"),
            (b"\x04\x22\x4d\x18", "lz4"),
        ] {
            let message = inside(bytes).unwrap_err();
            assert!(
                message.contains(name) && message.contains("joblib.dump"),
                "{message}"
            );
        }
    }
}

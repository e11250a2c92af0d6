//! Arrays by name, and archives cut short.

use super::*;
use npyz::WriterBuilder;
use std::io::Write;
use std::path::Path;
use zip::write::SimpleFileOptions;

/// Writes archives as NumPy does.
pub(in crate::import) struct Builder(zip::ZipWriter<Cursor<Vec<u8>>>);

impl Builder {
    pub(in crate::import) fn new() -> Self {
        Self(zip::ZipWriter::new(Cursor::new(Vec::new())))
    }

    pub(in crate::import) fn numbers(mut self, name: &str, shape: &[u64], values: &[f64]) -> Self {
        self.0
            .start_file(format!("{name}.npy"), SimpleFileOptions::default())
            .unwrap();
        let mut bytes = Vec::new();
        let mut writer = npyz::WriteOptions::new()
            .default_dtype()
            .shape(shape)
            .writer(&mut bytes)
            .begin_nd()
            .unwrap();
        writer.extend(values.iter().copied()).unwrap();
        writer.finish().unwrap();
        self.0.write_all(&bytes).unwrap();
        self
    }

    pub(in crate::import) fn words(mut self, name: &str, words: &[&str]) -> Self {
        self.0
            .start_file(format!("{name}.npy"), SimpleFileOptions::default())
            .unwrap();
        let longest = words.iter().map(|w| w.len()).max().unwrap_or(1);
        let mut bytes = Vec::new();
        let mut writer = npyz::WriteOptions::<str>::new()
            .dtype(npyz::DType::new_scalar(
                format!("<U{longest}").parse().unwrap(),
            ))
            .shape(&[words.len() as u64])
            .writer(&mut bytes)
            .begin_nd()
            .unwrap();
        for word in words {
            writer.push(*word).unwrap();
        }
        writer.finish().unwrap();
        self.0.write_all(&bytes).unwrap();
        self
    }

    pub(in crate::import) fn done(self) -> Vec<u8> {
        self.0.finish().unwrap().into_inner()
    }
}

#[test]
fn arrays_are_found_by_name() {
    let bytes = Builder::new()
        .numbers("a", &[2, 2], &[1.0, 2.0, 3.0, 4.0])
        .numbers("fps", &[], &[60.0])
        .words("names", &["hip", "knee"])
        .done();
    let file = File {
        path: Path::new("x.npz"),
        bytes: &bytes,
    };
    let mut archive = Archive::open(&file).unwrap();
    assert_eq!(archive.names(), ["a", "fps", "names"]);
    assert_eq!(archive.numbers("a").unwrap().frame(1), [3.0, 4.0]);
    assert_eq!(archive.scalar(&["rate", "fps"]).unwrap(), Some(60.0));
    assert_eq!(archive.words("names").unwrap().unwrap(), ["hip", "knee"]);
    assert_eq!(archive.try_numbers("b").unwrap(), None);
    let message = archive.numbers("b").unwrap_err().to_string();
    assert!(
        message.contains("x.npz") && message.contains("a, fps, names"),
        "{message}"
    );
    assert!(archive.numbers("names").is_err());
    assert!(archive.words("a").is_err());
}

#[test]
fn a_number_under_two_names_must_be_one() {
    let bytes = Builder::new()
        .numbers("fps", &[1], &[30.0])
        .numbers("rate", &[1], &[120.0])
        .done();
    let file = File {
        path: Path::new("two.npz"),
        bytes: &bytes,
    };
    let mut archive = Archive::open(&file).unwrap();
    let two = archive.scalar(&["rate", "fps"]).unwrap_err().to_string();
    for part in ["two.npz", "rate = 120", "fps = 30"] {
        assert!(two.contains(part), "{two}");
    }
}

#[test]
fn no_cut_panics() {
    let bytes = Builder::new().numbers("a", &[2], &[1.0, 2.0]).done();
    for cut in 0..bytes.len() {
        let file = File {
            path: Path::new("x.npz"),
            bytes: &bytes[..cut],
        };
        if let Ok(mut archive) = Archive::open(&file) {
            let _ = archive.numbers("a");
        }
    }
}

//! Archives written as `torch.save` writes them, entry by entry.

use super::*;
use crate::import::file::pickle::tests::Writer;
use std::io::Write;
use std::path::Path;
use zip::write::SimpleFileOptions;

/// An archive of a dictionary: keys and what writes their values, and the numbers of tensors.
pub(in crate::import) struct Archive {
    pickle: Writer,
    storages: Vec<Vec<u8>>,
}

impl Archive {
    pub(in crate::import) fn new() -> Self {
        Self {
            pickle: Writer::of_protocol(2).op(b"}q\0("),
            storages: Vec::new(),
        }
    }

    pub(in crate::import) fn value(mut self, key: &str, opcodes: &[u8]) -> Self {
        self.pickle = self.pickle.long_text(key).op(opcodes);
        self
    }

    /// A tensor of `float32` that is a part of wider rows, as a slice of columns is saved.
    pub(in crate::import) fn tensor(self, key: &str, shape: &[usize], values: &[f64]) -> Self {
        self.slice(key, shape, values, 0, values.len() / shape[0].max(1))
    }

    /// The same with the numbers of an array whose rows are `row` apart and begin at `offset`.
    pub(in crate::import) fn slice(
        mut self,
        key: &str,
        shape: &[usize],
        values: &[f64],
        offset: usize,
        row: usize,
    ) -> Self {
        let inner: usize = shape[1..].iter().product();
        let mut strides = vec![row];
        let mut stride = inner;
        for dimension in &shape[1..] {
            stride /= dimension;
            strides.push(stride);
        }
        let count = |writer: Writer, n: usize| writer.integer(i32::try_from(n).unwrap());
        let tuple = |writer: Writer, numbers: &[usize]| {
            numbers
                .iter()
                .fold(writer.op(b"("), |w, &n| count(w, n))
                .op(b"t")
        };
        let mut writer = self
            .pickle
            .long_text(key)
            .op(b"ctorch._utils\n_rebuild_tensor_v2\n((")
            .long_text("storage")
            .op(b"ctorch\nFloatStorage\n")
            .long_text(&self.storages.len().to_string())
            .long_text("cpu");
        writer = count(writer, values.len()).op(b"tQ");
        writer = tuple(count(writer, offset), shape);
        writer = tuple(writer, &strides);
        self.pickle = writer.op(b"\x89ccollections\nOrderedDict\n)RtR");
        let bytes = values.iter().flat_map(|&v| (v as f32).to_le_bytes());
        self.storages.push(bytes.collect());
        self
    }

    pub(in crate::import) fn done(self) -> Vec<u8> {
        let mut zip = zip::ZipWriter::new(Cursor::new(Vec::new()));
        let stored =
            SimpleFileOptions::default().compression_method(zip::CompressionMethod::Stored);
        let mut add = |name: String, bytes: &[u8]| {
            zip.start_file(format!("walk/{name}"), stored).unwrap();
            zip.write_all(bytes).unwrap();
        };
        add("data.pkl".into(), &self.pickle.op(b"u").done());
        add("byteorder".into(), b"little");
        for (i, bytes) in self.storages.iter().enumerate() {
            add(format!("data/{i}"), bytes);
        }
        add("version".into(), b"3\n");
        zip.finish().unwrap().into_inner()
    }
}

fn read_bytes(bytes: &[u8]) -> Result<Option<Pickle>, String> {
    let path = Path::new("walk.motion");
    read(&File { path, bytes }).map_err(|e| e.to_string())
}

#[test]
fn tensors_are_read_also_where_they_are_slices() {
    let wide: Vec<f64> = (0..12).map(f64::from).collect();
    let bytes = Archive::new()
        .value("fps", b"K\x1e")
        .slice("dof_pos", &[3, 2], &wide, 1, 4)
        .tensor("rigid_body_pos", &[2, 2, 3], &wide)
        .done();
    let pickle = read_bytes(&bytes).unwrap().unwrap();
    assert_eq!(pickle.array(&["fps"]).unwrap().values, [30.0]);
    let dof = pickle.array(&["dof_pos"]).unwrap();
    assert_eq!(
        (dof.shape.as_slice(), dof.frame(1)),
        (&[3, 2][..], &[5.0, 6.0][..])
    );
    let bodies = pickle.array(&["rigid_body_pos"]).unwrap();
    assert_eq!(
        (bodies.shape.as_slice(), bodies.frame(1)[3]),
        (&[2, 2, 3][..], 9.0)
    );
}

#[test]
fn what_is_no_archive_of_tensors_is_told_apart() {
    let npz = crate::import::file::npz::tests::Builder::new()
        .numbers("a", &[1], &[1.0])
        .done();
    assert!(read_bytes(&npz).unwrap().is_none());
    assert!(read_bytes(b"PK\x03\x04 cut off").unwrap().is_none());
}

#[test]
fn code_missing_numbers_and_slices_out_of_range_are_refused() {
    let attack = Archive::new().value("fps", b"cos\nsystem\n)R").done();
    assert!(read_bytes(&attack).unwrap_err().contains("os.system"));
    let beyond = Archive::new()
        .slice("dof_pos", &[3, 2], &[0.0; 6], 1, 2)
        .done();
    assert!(
        read_bytes(&beyond)
            .unwrap_err()
            .contains("beyond its numbers")
    );
    // A tensor that claims 2^40 numbers, all of them the same one.
    let huge = Archive::new()
        .value(
            "a",
            b"ctorch._utils\n_rebuild_tensor_v2\n((X\x07\0\0\0storagectorch\nFloatStorage\nX\x01\0\0\0\
              0X\x03\0\0\0cpuK\x01tQK\0\x8a\x06\0\0\0\0\0\x01\x85K\0\x85\x89ccollections\nOrderedDict\n)RtR",
        )
        .tensor("b", &[1], &[1.0])
        .done();
    assert!(read_bytes(&huge).unwrap_err().contains("size accounts for"));
    let lost = Archive::new()
        .value(
            "a",
            b"ctorch._utils\n_rebuild_tensor_v2\n((X\x07\0\0\0storagectorch\nFloatStorage\nX\x01\0\0\0\
              9X\x03\0\0\0cpuK\x01tQK\0K\x01\x85K\x01\x85\x89ccollections\nOrderedDict\n)RtR",
        )
        .done();
    assert!(read_bytes(&lost).unwrap_err().contains("data/9"));
}

#[test]
fn no_cut_panics() {
    let whole = Archive::new().tensor("a", &[2, 1], &[1.0, 2.0]).done();
    for cut in 0..whole.len() {
        let _ = read_bytes(&whole[..cut]);
    }
}

//! Pickles written opcode by opcode, good and bad.

use super::*;
use std::path::Path;

/// Writes pickles of protocol 4.
pub(in crate::import) struct Writer(Vec<u8>);

impl Writer {
    pub(in crate::import) fn new() -> Self {
        Self::of_protocol(4)
    }

    pub(in crate::import) fn of_protocol(protocol: u8) -> Self {
        Self(vec![0x80, protocol])
    }

    pub(in crate::import) fn op(mut self, bytes: &[u8]) -> Self {
        self.0.extend_from_slice(bytes);
        self
    }

    pub(in crate::import) fn text(self, text: &str) -> Self {
        let length = u8::try_from(text.len()).unwrap();
        self.op(&[0x8c, length]).op(text.as_bytes())
    }

    /// Text as protocol 2 writes it.
    pub(in crate::import) fn long_text(self, text: &str) -> Self {
        let length = u32::try_from(text.len()).unwrap();
        self.op(b"X").op(&length.to_le_bytes()).op(text.as_bytes())
    }

    pub(in crate::import) fn integer(self, number: i32) -> Self {
        self.op(b"J").op(&number.to_le_bytes())
    }

    /// An array of `f4`, as NumPy pickles it.
    pub(in crate::import) fn array(self, shape: &[usize], values: &[f64]) -> Self {
        let mut writer = self
            .text("numpy.core.multiarray")
            .text("_reconstruct")
            .op(&[0x93])
            .op(b"cnumpy\nndarray\n")
            .integer(0)
            .op(&[0x85])
            .op(b"C\x01b\x87R(")
            .integer(1)
            .op(b"(");
        for &dimension in shape {
            writer = writer.integer(i32::try_from(dimension).unwrap());
        }
        let bytes: Vec<u8> = values
            .iter()
            .flat_map(|&v| (v as f32).to_le_bytes())
            .collect();
        let length = u32::try_from(bytes.len()).unwrap();
        writer
            .op(b"t")
            .text("numpy")
            .text("dtype")
            .op(&[0x93])
            .text("f4")
            .op(&[0x89, 0x88, 0x87])
            .op(b"R(")
            .integer(3)
            .text("<")
            .op(b"NNNtb\x89B")
            .op(&length.to_le_bytes())
            .op(&bytes)
            .op(b"tb")
    }

    /// An array of `f4`, as joblib pickles it: its bytes follow the pickled header, aligned.
    pub(in crate::import) fn joblib_array(self, shape: &[usize], values: &[f64]) -> Self {
        let mut writer = self
            .text("joblib.numpy_pickle")
            .text("NumpyArrayWrapper")
            .op(b"\x93)\x81}(")
            .text("subclass")
            .op(b"cnumpy\nndarray\n")
            .text("shape")
            .op(b"(");
        for &dimension in shape {
            writer = writer.integer(i32::try_from(dimension).unwrap());
        }
        let bytes = values.iter().flat_map(|&v| (v as f32).to_le_bytes());
        writer
            .op(b"t")
            .text("order")
            .text("C")
            .text("dtype")
            .op(b"cnumpy\ndtype\n")
            .text("f4")
            .op(&[0x89, 0x88, 0x87])
            .op(b"R(")
            .integer(3)
            .text("<")
            .op(b"NNNJ\xff\xff\xff\xffJ\xff\xff\xff\xffK\0tb")
            .text("allow_mmap")
            .op(&[0x88])
            .text("numpy_array_alignment_bytes")
            .op(b"K\x10ub\x03\xff\xff\xff")
            .op(&bytes.collect::<Vec<u8>>())
    }

    pub(in crate::import) fn done(self) -> Vec<u8> {
        self.op(b".").0
    }
}

fn read(bytes: &[u8]) -> Result<Pickle, String> {
    let file = File {
        path: Path::new("motion.pkl"),
        bytes,
    };
    Pickle::read(&file, bytes).map_err(|e| e.to_string())
}

fn good() -> Vec<u8> {
    Writer::new()
        .op(b"}\x94(")
        .text("fps")
        .integer(30)
        .text("dof")
        .array(&[2, 2], &[0.5, 1.0, -1.5, 2.0])
        .text("names")
        .op(b"](")
        .text("hip")
        .text("knee")
        .op(b"eu")
        .done()
}

#[test]
fn dictionaries_of_arrays_are_read() {
    let pickle = read(&good()).unwrap();
    assert_eq!(pickle.keys(), ["fps", "dof", "names"]);
    assert_eq!(pickle.array(&["fps"]).unwrap().values, [30.0]);
    let dof = pickle.array(&["dof"]).unwrap();
    assert_eq!(
        (dof.shape.as_slice(), dof.frame(1)),
        (&[2, 2][..], &[-1.5, 2.0][..])
    );
    assert_eq!(pickle.words(&["names"]).unwrap(), ["hip", "knee"]);
    assert_eq!(pickle.at(&["names", "hip"]), None);
}

#[test]
fn numbers_of_every_size_are_read() {
    for (bytes, expected) in [
        (&b"K\xff"[..], 255.0),
        (b"M\x00\x01", 256.0),
        (b"J\xfe\xff\xff\xff", -2.0),
        (b"\x8a\x01\xff", -1.0),
        (b"\x8a\x02\x00\x01", 256.0),
        (b"\x8a\x00", 0.0),
        (b"G\x3f\xe0\x00\x00\x00\x00\x00\x00", 0.5),
    ] {
        let pickle = read(&Writer::new().op(bytes).done()).unwrap();
        assert_eq!(*pickle.root(), Value::Number(expected), "{bytes:?}");
    }
}

/// `joblib.dump({'a': {…}}, FILE)` of joblib 1.6 and NumPy 2.4 with every kind of value that such files
/// hold: arrays in both orders, text as an array and as a scalar, numbers, True.
const JOBLIB: &[u8] = b"\x80\x04\x95\xe2\x00\x00\x00\x00\x00\x00\x00}\x94\x8c\x01a\x94}\x94(\x8c\x03dof\x94\x8c\x13joblib.numpy_pickle\x94\x8c\x11NumpyArrayWrapper\x94\x93\x94)\x81\x94}\x94(\x8c\x08subclass\x94\x8c\x05numpy\x94\x8c\x07ndarray\x94\x93\x94\x8c\x05shape\x94K\x02K\x02\x86\x94\x8c\x05order\x94\x8c\x01C\x94\x8c\x05dtype\x94h\n\x8c\x05dtype\x94\x93\x94\x8c\x02f4\x94\x89\x88\x87\x94R\x94(K\x03\x8c\x01<\x94NNNJ\xff\xff\xff\xffJ\xff\xff\xff\xffK\x00t\x94b\x8c\nallow_mmap\x94\x88\x8c\x1bnumpy_array_alignment_bytes\x94K\x10ub\x02\xff\xff\x00\x00\x00\x00\x00\x00\x80?\x00\x00\x00@\x00\x00@@\x95@\x00\x00\x00\x00\x00\x00\x00\x8c\x01g\x94h\x06)\x81\x94}\x94(h\th\x0ch\r)h\x0fh\x10h\x11h\x13\x8c\x02U7\x94\x89\x88\x87\x94R\x94(K\x03h\x17NNNK\x1cK\x04K\x08t\x94bh\x19\x88h\x1aK\x10ub\x06\xff\xff\xff\xff\xff\xffn\x00\x00\x00e\x00\x00\x00u\x00\x00\x00t\x00\x00\x00r\x00\x00\x00a\x00\x00\x00l\x00\x00\x00\x95\xc9\x00\x00\x00\x00\x00\x00\x00\x8c\x01n\x94\x8c\x16numpy._core.multiarray\x94\x8c\x06scalar\x94\x93\x94h\x13\x8c\x02U4\x94\x89\x88\x87\x94R\x94(K\x03h\x17NNNK\x10K\x04K\x08t\x94bC\x10m\x00\x00\x00a\x00\x00\x00l\x00\x00\x00e\x00\x00\x00\x94\x86\x94R\x94\x8c\x03fps\x94K\x1e\x8c\x01h\x94h%h\x13\x8c\x02f8\x94\x89\x88\x87\x94R\x94(K\x03h\x17NNNJ\xff\xff\xff\xffJ\xff\xff\xff\xffK\x00t\x94bC\x08\x00\x00\x00\x00\x00\x00\x0c@\x94\x86\x94R\x94\x8c\x01f\x94h\x06)\x81\x94}\x94(h\th\x0ch\rK\x02K\x03\x86\x94h\x0f\x8c\x01F\x94h\x11h1h\x19\x88h\x1aK\x10ub\x01\xff\x00\x00\x00\x00\x00\x00\x00\x00\x00\x00\x00\x00\x00\x00\x08@\x00\x00\x00\x00\x00\x00\xf0?\x00\x00\x00\x00\x00\x00\x10@\x00\x00\x00\x00\x00\x00\x00@\x00\x00\x00\x00\x00\x00\x14@\x95\x08\x00\x00\x00\x00\x00\x00\x00\x8c\x01b\x94\x88us.";

#[test]
fn what_joblib_wrote_is_read() {
    let mut pickle = read(JOBLIB).unwrap();
    assert!(pickle.descend("a") && !pickle.descend("z"));
    let shaped = |key: &str| {
        let array = pickle.array(&[key]).unwrap();
        (array.shape, array.values)
    };
    assert_eq!(shaped("dof"), (vec![2, 2], vec![0.0, 1.0, 2.0, 3.0]));
    // Column by column in the file.
    assert_eq!(
        shaped("f"),
        (vec![2, 3], vec![0.0, 1.0, 2.0, 3.0, 4.0, 5.0])
    );
    assert_eq!(
        (shaped("fps").1, shaped("h").1, shaped("b").1),
        (vec![30.0], vec![3.5], vec![1.0])
    );
    assert_eq!(pickle.words(&["g"]).unwrap(), ["neutral"]);
    assert_eq!(pickle.words(&["n"]).unwrap(), ["male"]);
    for cut in 0..JOBLIB.len() {
        assert!(read(&JOBLIB[..cut]).is_err(), "{cut}");
        for byte in [0, b'.', b'b', 0x81, 0xff] {
            let mut changed = JOBLIB.to_vec();
            changed[cut] = byte;
            let _ = read(&changed);
        }
    }
}

#[test]
fn lists_of_numbers_and_of_arrays_are_arrays() {
    let pickle = read(
        &Writer::new()
            .op(b"}(")
            .text("rows")
            .op(b"](](K\x01K\x02e](K\x03K\x04ee")
            .text("ragged")
            .op(b"](](K\x01e](K\x03K\x04ee")
            .text("arrays")
            .op(b"](")
            .array(&[2], &[0.5, 1.5])
            .array(&[2], &[2.5, 3.5])
            .op(b"eu")
            .done(),
    )
    .unwrap();
    let rows = pickle.array(&["rows"]).unwrap();
    assert_eq!(
        (rows.shape, rows.values),
        (vec![2, 2], vec![1.0, 2.0, 3.0, 4.0])
    );
    assert_eq!(pickle.array(&["ragged"]), None);
    let arrays = pickle.array(&["arrays"]).unwrap();
    assert_eq!(
        (arrays.shape, arrays.values),
        (vec![2, 2], vec![0.5, 1.5, 2.5, 3.5])
    );
}

#[test]
fn a_few_bytes_cannot_ask_for_all_memory() {
    // A list of 1000 numbers, 1000 times in a list, that 1000 times in another: 10^9 numbers.
    let mut writer = Writer::new().op(b"}(").text("a");
    writer = writer.op(b"](").op(&b"K\x01".repeat(1000)).op(b"e\x94");
    writer = writer.op(b"0](").op(&b"h\x00".repeat(1000)).op(b"e\x94");
    writer = writer.op(b"0](").op(&b"h\x01".repeat(1000)).op(b"eu");
    let pickle = read(&writer.done()).unwrap();
    assert_eq!(pickle.array(&["a"]), None);
    // The same array taken as numpy.save's single object again and again.
    let mut writer = Writer::new().array(&[1000], &[0.0; 1000]).op(b"\x94](");
    for _ in 0..1000 {
        writer = writer
            .op(b"cnumpy.core.multiarray\n_reconstruct\n)R(K\x01)cnumpy\ndtype\n")
            .text("O8")
            .op(b"\x85R\x89]h\0atb");
    }
    let message = read(&writer.op(b"e").done()).unwrap_err();
    assert!(message.contains("size accounts for"), "{message}");
    let values = Writer::new().op(&b"N".repeat((1 << 16) + 2)).done();
    assert!(read(&values).unwrap_err().contains("values"));
}

#[test]
fn programs_are_refused_by_name() {
    // What an attacker would write: os.system("…").
    let attack = Writer::new()
        .op(b"cos\nsystem\n")
        .text("true")
        .op(&[0x85])
        .op(b"R");
    let message = read(&attack.done()).unwrap_err();
    assert!(
        message.contains("os.system") && message.contains("motion.pkl"),
        "{message}"
    );
    let object = Writer::new().op(b"csubprocess\nPopen\n)\x81");
    let message = read(&object.done()).unwrap_err();
    assert!(message.contains("object of subprocess.Popen"), "{message}");
    let nested = Writer::new()
        .op(b"}")
        .text("dof")
        .op(b"cbuiltins\neval\n")
        .text("1")
        .op(b"\x85Rs");
    assert!(read(&nested.done()).unwrap_err().contains("builtins.eval"));
    // Numbers outside the file are PyTorch's alone.
    let outside = Writer::new()
        .long_text("storage")
        .op(b"ctorch\nFloatStorage\n")
        .text("0")
        .op(b"\x87Q");
    assert!(read(&outside.done()).unwrap_err().contains("outside"));
}

#[test]
fn a_list_may_hold_itself() {
    let pickle = read(&Writer::new().op(b"]\x94h\x00a").done()).unwrap();
    assert_eq!(*pickle.root(), Value::List(vec![0]));
}

#[test]
fn no_bytes_whatever_panic() {
    let good = good();
    for cut in 0..good.len() {
        assert!(read(&good[..cut]).is_err(), "{cut}");
        for byte in [0, b'.', b'R', b'b', b't', b'e', b'u', b'h', 0x87, 0xff] {
            let mut changed = good.clone();
            changed[cut] = byte;
            let _ = read(&changed);
        }
    }
}

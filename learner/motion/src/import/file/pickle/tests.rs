//! Pickles written opcode by opcode, good and bad.

use super::*;
use std::path::Path;

/// Writes pickles of protocol 4.
pub(in crate::import) struct Writer(Vec<u8>);

impl Writer {
    pub(in crate::import) fn new() -> Self {
        Self(vec![0x80, 4])
    }

    pub(in crate::import) fn op(mut self, bytes: &[u8]) -> Self {
        self.0.extend_from_slice(bytes);
        self
    }

    pub(in crate::import) fn text(self, text: &str) -> Self {
        let length = u8::try_from(text.len()).unwrap();
        self.op(&[0x8c, length]).op(text.as_bytes())
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
    let object = Writer::new().op(b"ccopyreg\nx\n)\x81");
    assert!(read(&object.done()).unwrap_err().contains("object"));
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

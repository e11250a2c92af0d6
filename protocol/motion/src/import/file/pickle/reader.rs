//! The opcodes of a pickle (Python's `pickletools` names them), each of which makes or joins values.

use super::{Id, Pickle, Value};
use std::cell::Cell;
use std::collections::HashMap;

/// Most values of a pickle: an hour of a robot's frames as lists of numbers at 120 a second. A byte of a
/// file can be a value of many bytes in memory.
const MOST_VALUES: usize = if cfg!(test) { 1 << 16 } else { 1 << 24 };

/// Where the numbers of PyTorch's tensors come from: the bytes under a name.
pub(super) type Storages<'a> = Box<dyn FnMut(&str) -> Option<Vec<u8>> + 'a>;

/// A pickle that is being read.
pub(super) struct Reader<'a> {
    bytes: &'a [u8],
    at: usize,
    pub(super) values: Vec<Value>,
    pub(super) stack: Vec<Id>,
    memo: HashMap<u64, Id>,
    /// Numbers and bytes that may still be copied out of the file: a few bytes can ask for the same
    /// array again and again.
    allowance: Cell<usize>,
    pub(super) storages: Option<Storages<'a>>,
}

pub(super) type Outcome<T> = Result<T, String>;

impl<'a> Reader<'a> {
    /// A reader at the start of a pickle; `size` is that of the whole file, bytes.
    pub(super) fn new(bytes: &'a [u8], size: usize, storages: Option<Storages<'a>>) -> Self {
        Self {
            bytes,
            at: 0,
            values: Vec::new(),
            stack: Vec::new(),
            memo: HashMap::new(),
            allowance: Cell::new(super::allowance(size)),
            storages,
        }
    }

    /// Takes from what may be copied.
    pub(super) fn spend(&self, count: usize) -> Outcome<()> {
        let left = self.allowance.get().checked_sub(count);
        self.allowance
            .set(left.ok_or("it repeats itself to more than its size accounts for")?);
        Ok(())
    }

    pub(super) fn run(mut self) -> Outcome<Pickle> {
        loop {
            let opcode = self.take(1)?[0];
            if opcode == b'.' {
                let root = self.pop()?;
                return Ok(Pickle {
                    values: self.values,
                    root,
                    allowance: self.allowance,
                });
            }
            if self.values.len() > MOST_VALUES {
                return Err(format!("it holds more than {MOST_VALUES} values"));
            }
            self.execute(opcode)?;
        }
    }

    fn execute(&mut self, opcode: u8) -> Outcome<()> {
        match opcode {
            0x80 => drop(self.take(1)?), // PROTO
            0x95 => drop(self.take(8)?), // FRAME
            b'(' => self.push(Value::Mark),
            b'0' => drop(self.pop()?),
            b'N' => self.push(Value::None),
            0x88 => self.push(Value::Number(1.0)), // NEWTRUE
            0x89 => self.push(Value::Number(0.0)), // NEWFALSE
            b'K' | b'M' | b'J' | 0x8a | b'G' => self.number(opcode)?,
            b'X' | 0x8c | 0x8d => {
                let text = self.counted(opcode)?;
                let text = String::from_utf8(text).map_err(|_| "text that is not UTF-8")?;
                self.push(Value::Text(text));
            }
            b'B' | b'C' | 0x8e | 0x96 | b'T' | b'U' => {
                let bytes = self.counted(opcode)?;
                self.push(Value::Bytes(bytes));
            }
            b']' | 0x8f => self.push(Value::List(Vec::new())), // a set is a list to us
            b'}' => self.push(Value::Dict(Vec::new())),
            b')' => self.push(Value::Tuple(Vec::new())),
            0x85..=0x87 => {
                let from = self.stack.len().checked_sub(usize::from(opcode - 0x84));
                let items = self.stack.split_off(from.ok_or("a tuple of nothing")?);
                self.push(Value::Tuple(items));
            }
            b't' => {
                let items = self.pop_to_mark()?;
                self.push(Value::Tuple(items));
            }
            b'a' => {
                let item = self.pop()?;
                self.extend(&[item])?;
            }
            b'e' | 0x90 => {
                let items = self.pop_to_mark()?;
                self.extend(&items)?;
            }
            b's' => {
                let (value, key) = (self.pop()?, self.pop()?);
                self.insert(&[key, value])?;
            }
            b'u' => {
                let items = self.pop_to_mark()?;
                self.insert(&items)?;
            }
            b'q' | b'r' | 0x94 | b'h' | b'j' => self.remember(opcode)?,
            b'c' => {
                let (module, name) = (self.text_line()?, self.text_line()?);
                self.push(Value::Name(format!("{module}.{name}")));
            }
            0x93 => {
                let (name, module) = (self.pop_text()?, self.pop_text()?);
                self.push(Value::Name(format!("{module}.{name}")));
            }
            0x91 => {
                let items = self.pop_to_mark()?;
                self.push(Value::List(items)); // FROZENSET
            }
            b'R' => self.reduce()?,
            0x81 => self.object()?,
            b'b' => self.build()?,
            b'Q' => self.storage()?,
            other => return Err(format!("opcode {other:#04x} builds an object")),
        }
        Ok(())
    }

    fn number(&mut self, opcode: u8) -> Outcome<()> {
        let number = match opcode {
            b'K' => f64::from(self.take(1)?[0]),
            b'M' => self.little(2)? as f64,
            b'J' => f64::from(self.little(4)? as u32 as i32),
            b'G' => f64::from_bits(self.take(8)?.iter().fold(0, |n, &b| n << 8 | u64::from(b))),
            _ => {
                let length = usize::from(self.take(1)?[0]); // LONG1
                if length > 8 {
                    return Err("a number of more than 64 bits".into());
                }
                let raw = self.little(length)?;
                let unused = 64 - 8 * length as u32;
                // Two's complement: the highest bit that is there is the sign.
                (raw.checked_shl(unused).unwrap_or(0) as i64)
                    .checked_shr(unused)
                    .unwrap_or(0) as f64
            }
        };
        self.push(Value::Number(number));
        Ok(())
    }

    /// Bytes after their own count.
    fn counted(&mut self, opcode: u8) -> Outcome<Vec<u8>> {
        let width = match opcode {
            0x8c | b'C' | b'U' => 1,
            0x8d | 0x8e | 0x96 => 8,
            _ => 4,
        };
        let length = usize::try_from(self.little(width)?).map_err(|_| "a length beyond memory")?;
        self.taken(length)
    }

    fn remember(&mut self, opcode: u8) -> Outcome<()> {
        let key = match opcode {
            b'q' | b'h' => u64::from(self.take(1)?[0]),
            b'r' | b'j' => self.little(4)?,
            _ => self.memo.len() as u64, // MEMOIZE
        };
        if matches!(opcode, b'h' | b'j') {
            let id = *self.memo.get(&key).ok_or("a value that was never stored")?;
            self.stack.push(id);
        } else {
            let top = *self.stack.last().ok_or("nothing to store")?;
            self.memo.insert(key, top);
        }
        Ok(())
    }

    fn extend(&mut self, items: &[Id]) -> Outcome<()> {
        match self.top()? {
            Value::List(list) => list.extend_from_slice(items),
            _ => return Err("items for what is no list".into()),
        }
        Ok(())
    }

    fn insert(&mut self, items: &[Id]) -> Outcome<()> {
        match self.top()? {
            Value::Dict(entries) => {
                entries.extend(items.chunks_exact(2).map(|pair| (pair[0], pair[1])));
                Ok(())
            }
            _ => Err("entries for what is no dictionary".into()),
        }
    }

    fn top(&mut self) -> Outcome<&mut Value> {
        let id = *self.stack.last().ok_or("an empty stack")?;
        Ok(&mut self.values[id])
    }

    pub(super) fn push(&mut self, value: Value) {
        self.stack.push(self.values.len());
        self.values.push(value);
    }

    pub(super) fn pop(&mut self) -> Outcome<Id> {
        self.stack.pop().ok_or_else(|| "an empty stack".into())
    }

    fn pop_text(&mut self) -> Outcome<String> {
        let id = self.pop()?;
        match &self.values[id] {
            Value::Text(text) => Ok(text.clone()),
            _ => Err("a name that is no text".into()),
        }
    }

    fn pop_to_mark(&mut self) -> Outcome<Vec<Id>> {
        let mark = self
            .stack
            .iter()
            .rposition(|&id| self.values[id] == Value::Mark)
            .ok_or("no mark")?;
        let items = self.stack.split_off(mark + 1);
        self.stack.pop();
        Ok(items)
    }

    /// The next bytes of the file, copied.
    pub(super) fn taken(&mut self, count: usize) -> Outcome<Vec<u8>> {
        Ok(self.take(count)?.to_vec())
    }

    fn take(&mut self, count: usize) -> Outcome<&[u8]> {
        let end = self
            .at
            .checked_add(count)
            .filter(|&end| end <= self.bytes.len());
        let end = end.ok_or("it is cut off")?;
        let taken = &self.bytes[self.at..end];
        self.at = end;
        Ok(taken)
    }

    fn little(&mut self, count: usize) -> Outcome<u64> {
        let bytes = self.take(count)?;
        Ok(bytes.iter().rev().fold(0, |n, &b| n << 8 | u64::from(b)))
    }

    fn text_line(&mut self) -> Outcome<String> {
        let rest = &self.bytes[self.at..];
        let length = rest
            .iter()
            .position(|&b| b == b'\n')
            .ok_or("it is cut off")?;
        let line = String::from_utf8_lossy(&rest[..length]).into_owned();
        self.at += length + 1;
        Ok(line)
    }
}

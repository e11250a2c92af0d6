//! The few objects that a pickle of motion is built of.
//!
//! Separate because this list is what makes the reader safe: nothing here does more than copy bytes.

use super::reader::{Outcome, Reader};
use super::{Array, Value};

impl Reader<'_> {
    /// A call: the function's name and a tuple of arguments become a value.
    pub(super) fn reduce(&mut self) -> Outcome<()> {
        let (arguments, function) = (self.pop()?, self.pop()?);
        let Value::Name(name) = self.values[function].clone() else {
            return Err("a call of what is no name".into());
        };
        let Value::Tuple(arguments) = self.values[arguments].clone() else {
            return Err(format!("{name} is called without arguments"));
        };
        let argument = |i: usize| {
            let id = arguments
                .get(i)
                .ok_or_else(|| format!("{name} lacks argument {i}"))?;
            Ok::<&Value, String>(&self.values[*id])
        };
        let value = match name.as_str() {
            "numpy.core.multiarray._reconstruct" | "numpy._core.multiarray._reconstruct" => {
                // An empty array whose content follows (see `build`).
                Value::Array(Array {
                    shape: vec![0],
                    values: Vec::new(),
                })
            }
            "numpy.dtype" => match argument(0)? {
                Value::Text(kind) => {
                    let big = kind.starts_with('>');
                    Value::Type(kind.trim_start_matches(['<', '>', '|', '=']).into(), big)
                }
                _ => return Err("a type without a name".into()),
            },
            "numpy.core.multiarray.scalar" | "numpy._core.multiarray.scalar" => {
                let (Value::Type(kind, big), Value::Bytes(bytes)) = (argument(0)?, argument(1)?)
                else {
                    return Err("a number that is not given by its bytes".into());
                };
                let number = numbers(kind, *big, bytes)?.first().copied();
                Value::Number(number.ok_or("a number of no bytes")?)
            }
            "numpy.core.numeric._frombuffer" | "numpy._core.numeric._frombuffer" => {
                let (Value::Bytes(bytes), Value::Type(kind, big)) = (argument(0)?, argument(1)?)
                else {
                    return Err("an array that is not given by its bytes".into());
                };
                let (shape, order) = (self.shape(argument(2)?)?, argument(3)?);
                let fortran = *order == Value::Text("F".into());
                array(shape, numbers(kind, *big, bytes)?, fortran)?
            }
            "collections.OrderedDict" | "builtins.dict" => Value::Dict(Vec::new()),
            // How protocol 2 writes bytes: as text whose letters are the bytes.
            "_codecs.encode" => match argument(0)? {
                Value::Text(text) => Value::Bytes(
                    text.chars()
                        .map(|c| u8::try_from(u32::from(c)).map_err(|_| "text that is no bytes"))
                        .collect::<Result<_, _>>()?,
                ),
                _ => return Err("bytes that are no text".into()),
            },
            other => return Err(format!("it calls {other}, which is not plain data")),
        };
        self.push(value);
        Ok(())
    }

    /// The state of an object that a call made.
    pub(super) fn build(&mut self) -> Outcome<()> {
        let (state, object) = (self.pop()?, *self.stack.last().ok_or("an empty stack")?);
        let built = match (&self.values[object], &self.values[state]) {
            // (version, shape, type, Fortran order, bytes)
            (Value::Array(_), Value::Tuple(state)) if state.len() == 5 => {
                let part = |i: usize| &self.values[state[i]];
                // numpy.save wraps an object into an array of one.
                if let (Value::Type(kind, _), Value::List(items)) = (part(2), part(4)) {
                    let ("O8" | "O", [only]) = (kind.as_str(), items.as_slice()) else {
                        return Err("an array of many objects".into());
                    };
                    self.values[object] = self.values[*only].clone();
                    return Ok(());
                }
                let (Value::Type(kind, big), Value::Bytes(bytes)) = (part(2), part(4)) else {
                    return Err("an array without bytes".into());
                };
                let fortran = *part(3) == Value::Number(1.0);
                array(self.shape(part(1))?, numbers(kind, *big, bytes)?, fortran)?
            }
            // (version, byte order, …)
            (Value::Type(kind, _), Value::Tuple(state)) if state.len() > 1 => {
                let big = self.values[state[1]] == Value::Text(">".into());
                Value::Type(kind.clone(), big)
            }
            _ => return Err("the state of an object".into()),
        };
        self.values[object] = built;
        Ok(())
    }

    fn shape(&self, value: &Value) -> Outcome<Vec<usize>> {
        let Value::Tuple(items) = value else {
            return Err("a shape that is no tuple".into());
        };
        items
            .iter()
            .map(|&id| match self.values[id] {
                Value::Number(n) if n >= 0.0 => Ok(n as usize),
                _ => Err("a shape that is no count".into()),
            })
            .collect()
    }
}

fn array(shape: Vec<usize>, values: Vec<f64>, fortran: bool) -> Outcome<Value> {
    let array = Array::of(shape, values, fortran);
    array
        .map(Value::Array)
        .ok_or_else(|| "an array shorter than its shape".into())
}

/// Numbers from their bytes.
fn numbers(kind: &str, big: bool, bytes: &[u8]) -> Outcome<Vec<f64>> {
    macro_rules! read {
        ($type:ty) => {{
            let words = bytes.chunks_exact(size_of::<$type>());
            words
                .map(|word| {
                    let word = word.try_into().expect("chunks are as long as asked");
                    (if big {
                        <$type>::from_be_bytes(word)
                    } else {
                        <$type>::from_le_bytes(word)
                    }) as f64
                })
                .collect()
        }};
    }
    Ok(match kind {
        "f4" => read!(f32),
        "f8" => read!(f64),
        "i8" => read!(i64),
        "i4" => read!(i32),
        "i2" => read!(i16),
        "i1" => read!(i8),
        "u8" => read!(u64),
        "u4" => read!(u32),
        "u2" => read!(u16),
        "u1" | "b1" => read!(u8),
        other => return Err(format!("numbers of type {other}")),
    })
}

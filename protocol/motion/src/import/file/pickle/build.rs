//! The few objects that a pickle of motion is built of.
//!
//! Separate because this list is what makes the reader safe: nothing here does more than copy bytes.

use super::numbers::{self, width};
use super::reader::{Outcome, Reader};
use super::{Array, Value};
use wording::line;

/// joblib's place holder: the numbers of an array follow it in the file.
const WRAPPER: &str = "joblib.numpy_pickle.NumpyArrayWrapper";
/// What a training program leaves in its files beside the motion, which says nothing about it.
const LABELS: [&str; 1] = ["protomotions.simulator.base_simulator.simulator_state.StateConversion"];

impl Reader<'_> {
    /// A call: the function's name and a tuple of arguments become a value.
    pub(super) fn reduce(&mut self) -> Outcome<()> {
        let (name, arguments) = self.call()?;
        let argument = |i: usize| {
            let id = arguments
                .get(i)
                .ok_or_else(|| format!("{} lacks argument {i}", line(&name)))?;
            Ok::<&Value, String>(&self.values[*id])
        };
        let value = match name.as_str() {
            "numpy.core.multiarray._reconstruct" | "numpy._core.multiarray._reconstruct" => {
                // An empty array whose content follows (see `build`).
                Value::Array(Box::new(Array {
                    shape: vec![0],
                    values: Vec::new(),
                }))
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
                match numbers::content(kind, *big, bytes, Vec::new(), false)? {
                    Value::Array(array) => Value::Number(array.values[0]),
                    text => text,
                }
            }
            "numpy.core.numeric._frombuffer" | "numpy._core.numeric._frombuffer" => {
                let (Value::Bytes(bytes), Value::Type(kind, big)) = (argument(0)?, argument(1)?)
                else {
                    return Err("an array that is not given by its bytes".into());
                };
                let (shape, order) = (self.shape(argument(2)?)?, argument(3)?);
                let fortran = *order == Value::Text("F".into());
                self.spend(bytes.len())?;
                numbers::content(kind, *big, bytes, shape, fortran)?
            }
            "torch._utils._rebuild_tensor_v2" => {
                let Value::Array(storage) = argument(0)? else {
                    return Err("a tensor without numbers".into());
                };
                let Value::Number(offset) = *argument(1)? else {
                    return Err("a tensor that begins nowhere".into());
                };
                let (shape, strides) = (self.shape(argument(2)?)?, self.shape(argument(3)?)?);
                let count = shape.iter().try_fold(1usize, |n, &d| n.checked_mul(d));
                self.spend(count.ok_or("a tensor beyond memory")?)?;
                let tensor = numbers::strided(&storage.values, offset as usize, &shape, &strides);
                Value::Array(Box::new(tensor.ok_or("a tensor beyond its numbers")?))
            }
            "collections.OrderedDict" | "builtins.dict" => Value::Dict(Vec::new()),
            // How protocol 2 writes bytes: as text whose letters are the bytes.
            "_codecs.encode" => match argument(0)? {
                Value::Text(text) => {
                    self.spend(text.len())?;
                    let bytes = text
                        .chars()
                        .map(|c| u8::try_from(u32::from(c)).map_err(|_| "text that is no bytes"));
                    Value::Bytes(bytes.collect::<Result<_, _>>()?)
                }
                _ => return Err("bytes that are no text".into()),
            },
            label if LABELS.contains(&label) => Value::None,
            other => {
                let other = line(other);
                return Err(format!("it calls {other}, which is not plain data"));
            }
        };
        self.push(value);
        Ok(())
    }

    /// An object of a class: the one that is data is joblib's array, whose state follows.
    pub(super) fn object(&mut self) -> Outcome<()> {
        let (class, _) = self.call()?;
        if class != WRAPPER {
            return Err(format!(
                "it builds an object of {class}, which is not plain data"
            ));
        }
        self.push(Value::Wrapper);
        Ok(())
    }

    /// A name and the arguments for it.
    fn call(&mut self) -> Outcome<(String, Vec<usize>)> {
        let (arguments, function) = (self.pop()?, self.pop()?);
        let Value::Name(name) = self.values[function].clone() else {
            return Err("a call of what is no name".into());
        };
        let Value::Tuple(arguments) = &self.values[arguments] else {
            return Err(format!("{} is called without arguments", line(&name)));
        };
        self.spend(arguments.len())?;
        Ok((name, arguments.clone()))
    }

    /// The numbers of a tensor, which stand outside the pickle: ("storage", type, name, device, count).
    pub(super) fn storage(&mut self) -> Outcome<()> {
        let id = self.pop()?;
        let part = |i: usize| match &self.values[id] {
            Value::Tuple(parts) => parts.get(i).map(|&part| &self.values[part]),
            _ => None,
        };
        let (Some(Value::Name(class)), Some(Value::Text(name))) = (part(1), part(2)) else {
            return Err("numbers outside it without type and name".into());
        };
        let kind = match class.as_str() {
            "torch.FloatStorage" => "f4",
            "torch.DoubleStorage" => "f8",
            "torch.LongStorage" => "i8",
            "torch.IntStorage" => "i4",
            "torch.ShortStorage" => "i2",
            "torch.CharStorage" => "i1",
            "torch.ByteStorage" => "u1",
            "torch.BoolStorage" => "b1",
            other => return Err(format!("numbers of type {}", line(other))),
        };
        let name = name.clone();
        let load = self.storages.as_mut().ok_or("numbers outside it")?;
        let bytes =
            load(&name).ok_or_else(|| format!("its numbers data/{name} are missing or cut off"))?;
        self.spend(bytes.len())?;
        let values = numbers::values(kind, false, &bytes)?;
        self.push(Value::Array(Box::new(Array {
            shape: vec![values.len()],
            values,
        })));
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
                    self.spend(self.values[*only].size())?;
                    self.values[object] = self.values[*only].clone();
                    return Ok(());
                }
                let (Value::Type(kind, big), Value::Bytes(bytes)) = (part(2), part(4)) else {
                    return Err("an array without bytes".into());
                };
                let fortran = *part(3) == Value::Number(1.0);
                self.spend(bytes.len())?;
                numbers::content(kind, *big, bytes, self.shape(part(1))?, fortran)?
            }
            // (version, byte order, …)
            (Value::Type(kind, _), Value::Tuple(state)) if state.len() > 1 => {
                let big = self.values[state[1]] == Value::Text(">".into());
                Value::Type(kind.clone(), big)
            }
            (Value::Wrapper, Value::Dict(_)) => self.wrapped(state)?,
            _ => return Err("the state of an object".into()),
        };
        self.values[object] = built;
        Ok(())
    }

    /// The array whose numbers follow, after a count of bytes that only align them.
    fn wrapped(&mut self, state: usize) -> Outcome<Value> {
        let part = |key: &str| self.get(state, key).map(|id| &self.values[id]);
        let (Some(shape), Some(Value::Type(kind, big))) = (part("shape"), part("dtype")) else {
            return Err("an array without shape or type".into());
        };
        let (shape, kind, big) = (self.shape(shape)?, kind.clone(), *big);
        let fortran = part("order") == Some(&Value::Text("F".into()));
        if matches!(part("numpy_array_alignment_bytes"), Some(Value::Number(_))) {
            let padding = self.taken(1)?[0];
            self.taken(usize::from(padding))?;
        }
        let count = shape
            .iter()
            .try_fold(width(&kind)?, |n, &d| n.checked_mul(d));
        let bytes = self.taken(count.ok_or("an array beyond memory")?)?;
        numbers::content(&kind, big, &bytes, shape, fortran)
    }

    fn get(&self, dictionary: usize, key: &str) -> Option<usize> {
        super::get(&self.values, dictionary, key)
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

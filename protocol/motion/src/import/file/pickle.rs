//! Python pickles, as far as they are data: dictionaries, lists, numbers, text, NumPy arrays as NumPy
//! and joblib write them, and PyTorch's tensors.
//!
//! Separate, and our own, because no crate reads NumPy arrays out of pickles. A pickle is a program;
//! this reads it as data and runs nothing: what it may build is the list in [`Reader::reduce`], and
//! anything else is refused by name.

mod build;
mod numbers;
mod reader;

use super::File;
use super::array::Array;
use crate::error::MotionError;
use npyz::NpyFile;
use reader::{Reader, Storages};
use std::cell::Cell;

/// Where a value stands among all values of a pickle; values refer to each other by it.
pub(in crate::import) type Id = usize;

/// A value.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::import) enum Value {
    None,
    Number(f64),
    Text(String),
    Bytes(Vec<u8>),
    List(Vec<Id>),
    Tuple(Vec<Id>),
    Dict(Vec<(Id, Id)>),
    Array(Box<Array>),
    /// An array of text.
    Words(Vec<String>),
    /// The type of an array's numbers: kind and size as in `f4`, and whether big end first.
    Type(String, bool),
    /// A name that something else is built with.
    Name(String),
    /// An array of joblib's whose state has not come yet.
    Wrapper,
    Mark,
}

impl Value {
    /// What copying it counts, see [`Reader::spend`].
    fn size(&self) -> usize {
        match self {
            Self::Text(text) => text.len(),
            Self::Bytes(bytes) => bytes.len(),
            Self::List(items) | Self::Tuple(items) => items.len(),
            Self::Dict(entries) => entries.len(),
            Self::Array(array) => array.values.len(),
            Self::Words(words) => words.iter().map(String::len).sum(),
            _ => 1,
        }
    }
}

/// The values of a pickle and which of them is the whole.
#[derive(Debug)]
pub(in crate::import) struct Pickle {
    values: Vec<Value>,
    root: Id,
    /// Numbers that may still be copied together, see [`Reader::spend`].
    allowance: Cell<usize>,
}

/// Numbers and bytes that may be copied out of a file of a size: what it holds several times over.
fn allowance(size: usize) -> usize {
    size.saturating_mul(8).saturating_add(1 << 16).min(1 << 28)
}

impl Pickle {
    /// Reads the pickle at the start of `bytes`.
    pub(in crate::import) fn read(file: &File<'_>, bytes: &[u8]) -> Result<Self, MotionError> {
        Self::read_with(file, bytes, None)
    }

    /// Reads a pickle whose tensors have their numbers elsewhere.
    pub(super) fn read_with(
        file: &File<'_>,
        bytes: &[u8],
        storages: Option<Storages<'_>>,
    ) -> Result<Self, MotionError> {
        let size = file.bytes.len().max(bytes.len());
        Reader::new(bytes, size, storages).run().map_err(|problem| {
            file.unusable(
                &format!("is no pickle of plain data: {problem}"),
                "save dictionaries, numbers and NumPy arrays only, with pickle.dump, joblib.dump or numpy.save",
            )
        })
    }

    /// Reads the object that numpy.save pickled into an `.npy`.
    pub(in crate::import) fn of_npy(file: &File<'_>) -> Result<Self, MotionError> {
        let npy = NpyFile::new(file.bytes).map_err(|_| {
            file.unusable(
                "is no readable .npy file",
                "download or export it again: it may be cut off",
            )
        })?;
        if !npy.uses_pickled_array() {
            return Err(file.unusable(
                "is a plain array of numbers, which does not say what they are",
                "give a dictionary of arrays as Isaac Gym or amp-rsl-rl save it, or one of the other formats",
            ));
        }
        Self::read(file, npy.into_inner())
    }

    /// The whole.
    pub(in crate::import) fn root(&self) -> &Value {
        &self.values[self.root]
    }

    /// Makes the value under a key the whole; `false` if there is none.
    pub(in crate::import) fn descend(&mut self, key: &str) -> bool {
        let found = get(&self.values, self.root, key);
        self.root = found.unwrap_or(self.root);
        found.is_some()
    }

    /// The value under a path of keys, from the whole.
    pub(in crate::import) fn at(&self, path: &[&str]) -> Option<&Value> {
        let id = path
            .iter()
            .try_fold(self.root, |id, key| get(&self.values, id, key))?;
        Some(&self.values[id])
    }

    /// The array under a path of keys; numbers and lists of numbers or of arrays as long as each other do
    /// too. `None` if there is nothing of the kind, or more of it than the file's size accounts for.
    pub(in crate::import) fn array(&self, path: &[&str]) -> Option<Array> {
        let id = path
            .iter()
            .try_fold(self.root, |id, key| get(&self.values, id, key))?;
        let mut numbers = Vec::new();
        let shape = self.stack(id, &mut numbers, 0)?;
        Array::of(shape, numbers, false)
    }

    /// Appends the numbers of a value; returns its shape.
    fn stack(&self, id: Id, numbers: &mut Vec<f64>, depth: usize) -> Option<Vec<usize>> {
        const DEEPEST: usize = 4;
        let mut spend = |more: &[f64]| {
            let left = self.allowance.get().checked_sub(more.len())?;
            self.allowance.set(left);
            numbers.extend_from_slice(more);
            Some(())
        };
        match &self.values[id] {
            Value::Array(array) => spend(&array.values).map(|()| array.shape.clone()),
            Value::Number(number) => spend(&[*number]).map(|()| Vec::new()),
            Value::List(items) | Value::Tuple(items) if depth < DEEPEST => {
                let mut inner: Option<Vec<usize>> = None;
                for &item in items {
                    let shape = self.stack(item, numbers, depth + 1)?;
                    if inner.as_ref().is_some_and(|inner| *inner != shape) {
                        return None;
                    }
                    inner = Some(shape);
                }
                let mut shape = vec![items.len()];
                shape.extend(inner.unwrap_or_default());
                Some(shape)
            }
            _ => None,
        }
    }

    /// The words under a path of keys.
    pub(in crate::import) fn words(&self, path: &[&str]) -> Option<Vec<String>> {
        let items = match self.at(path)? {
            Value::Words(words) => return Some(words.clone()),
            Value::List(items) | Value::Tuple(items) => items,
            _ => return None,
        };
        items
            .iter()
            .map(|&id| match &self.values[id] {
                Value::Text(text) => Some(text.clone()),
                Value::Words(words) => Some(words.concat()),
                _ => None,
            })
            .collect()
    }

    /// The keys of the whole, if it is a dictionary.
    pub(in crate::import) fn keys(&self) -> Vec<&str> {
        let Value::Dict(entries) = self.root() else {
            return Vec::new();
        };
        entries
            .iter()
            .filter_map(|&(key, _)| match &self.values[key] {
                Value::Text(text) => Some(text.as_str()),
                _ => None,
            })
            .collect()
    }

    /// The array under the first of the names that has one, and that name; `remedy` says what was expected.
    pub(in crate::import) fn part<'n>(
        &self,
        file: &File<'_>,
        names: &[&'n str],
        remedy: &str,
    ) -> Result<(Array, &'n str), MotionError> {
        let found = names
            .iter()
            .find_map(|&name| Some((self.array(&[name])?, name)));
        found.ok_or_else(|| {
            let problem = format!("has no array {} (but {})", names.join(" or "), self.holds());
            file.unusable(&problem, remedy)
        })
    }

    /// What the whole is, for messages: its keys, or what it is that has none.
    pub(in crate::import) fn holds(&self) -> String {
        let keys = self.keys();
        if !keys.is_empty() {
            return wording::line(&keys.join(", "));
        }
        let of = |what: &str, count: usize| match count {
            0 => format!("an empty {what}"),
            _ => format!("a {what} of {}", wording::count(count, "value")),
        };
        match self.root() {
            Value::None => "None".into(),
            Value::Number(number) => format!("the number {number}"),
            Value::Text(_) => "a text".into(),
            Value::Bytes(_) => "bytes".into(),
            Value::List(items) => of("list", items.len()),
            Value::Tuple(items) => of("tuple", items.len()),
            Value::Dict(entries) if entries.is_empty() => of("dictionary", 0),
            Value::Dict(entries) => of("dictionary without names", entries.len()),
            Value::Array(array) => format!("an array of the shape {:?}", array.shape),
            Value::Words(words) => of("array of texts", words.len()),
            Value::Type(..) | Value::Name(_) | Value::Wrapper | Value::Mark => {
                "nothing that is data".into()
            }
        }
    }

    /// Whether the whole has a key.
    pub(in crate::import) fn has(&self, key: &str) -> bool {
        get(&self.values, self.root, key).is_some()
    }
}

/// The value under a key of a dictionary; a key that is set twice has its last value.
fn get(values: &[Value], dictionary: Id, key: &str) -> Option<Id> {
    let Value::Dict(entries) = &values[dictionary] else {
        return None;
    };
    let entry = entries
        .iter()
        .rev()
        .find(|(k, _)| matches!(&values[*k], Value::Text(text) if text == key));
    entry.map(|&(_, v)| v)
}

#[cfg(test)]
pub(in crate::import) mod tests;

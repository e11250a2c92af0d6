//! Python pickles, as far as they are data: dictionaries, lists, numbers, text and NumPy arrays.
//!
//! Separate, and our own, because no crate reads NumPy arrays out of pickles. A pickle is a program;
//! this reads it as data and runs nothing: what it may build is the list in [`Reader::reduce`], and
//! anything else is refused by name.

mod build;
mod reader;

use super::File;
use super::array::Array;
use crate::error::MotionError;
use reader::Reader;

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
    Array(Array),
    /// The type of an array's numbers: kind and size as in `f4`, and whether big end first.
    Type(String, bool),
    /// A name that something else is built with.
    Name(String),
    Mark,
}

/// The values of a pickle and which of them is the whole.
#[derive(Debug)]
pub(in crate::import) struct Pickle {
    values: Vec<Value>,
    root: Id,
}

impl Pickle {
    /// Reads the pickle at the start of `bytes`.
    pub(in crate::import) fn read(file: &File<'_>, bytes: &[u8]) -> Result<Self, MotionError> {
        Reader::new(bytes).run().map_err(|problem| {
            file.unusable(
                &format!("is no pickle of plain data: {problem}"),
                "save dictionaries, numbers and NumPy arrays only, with pickle.dump or numpy.save",
            )
        })
    }

    /// The whole.
    pub(in crate::import) fn root(&self) -> &Value {
        &self.values[self.root]
    }

    /// The value under a path of keys, from the whole.
    pub(in crate::import) fn at(&self, path: &[&str]) -> Option<&Value> {
        path.iter()
            .try_fold(self.root(), |value, key| self.get(value, key))
    }

    /// The array under a path of keys; lists of numbers do too.
    pub(in crate::import) fn array(&self, path: &[&str]) -> Option<Array> {
        match self.at(path)? {
            Value::Array(array) => Some(array.clone()),
            Value::Number(number) => Array::of(Vec::new(), vec![*number], false),
            Value::List(items) | Value::Tuple(items) => {
                let numbers: Option<Vec<f64>> = items
                    .iter()
                    .map(|&id| match &self.values[id] {
                        Value::Number(number) => Some(*number),
                        _ => None,
                    })
                    .collect();
                let numbers = numbers?;
                Array::of(vec![numbers.len()], numbers, false)
            }
            _ => None,
        }
    }

    /// The words under a path of keys.
    pub(in crate::import) fn words(&self, path: &[&str]) -> Option<Vec<String>> {
        let (Value::List(items) | Value::Tuple(items)) = self.at(path)? else {
            return None;
        };
        items
            .iter()
            .map(|&id| match &self.values[id] {
                Value::Text(text) => Some(text.clone()),
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

    fn get(&self, value: &Value, key: &str) -> Option<&Value> {
        let Value::Dict(entries) = value else {
            return None;
        };
        // A key that is set twice has its last value.
        let entry = entries
            .iter()
            .rev()
            .find(|(k, _)| matches!(&self.values[*k], Value::Text(text) if text == key));
        entry.map(|&(_, v)| &self.values[v])
    }
}

#[cfg(test)]
pub(in crate::import) mod tests;

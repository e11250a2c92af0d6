//! NumPy archives (`.npz`): arrays by name.
//!
//! Separate because four formats are archives that differ in the names of their arrays only.

use super::File;
use super::array::Array;
use crate::error::MotionError;
use npyz::{NpyFile, Order};
use std::io::{Cursor, Read};
use zip::ZipArchive;
use zip::result::ZipError;

/// Most numbers in an array: 4 hours of SMPL+H at 120 frames a second are a quarter of that. A forged
/// header asks for more memory than there is.
const MOST_NUMBERS: u64 = 1 << 30;

/// An open archive.
pub(in crate::import) struct Archive<'a> {
    file: File<'a>,
    zip: ZipArchive<Cursor<&'a [u8]>>,
}

impl<'a> Archive<'a> {
    pub(in crate::import) fn open(file: &File<'a>) -> Result<Self, MotionError> {
        let zip = ZipArchive::new(Cursor::new(file.bytes)).map_err(|error| broken(file, &error))?;
        Ok(Self { file: *file, zip })
    }

    /// Names of the arrays.
    pub(in crate::import) fn names(&self) -> Vec<String> {
        let mut names: Vec<String> = self
            .zip
            .file_names()
            .filter_map(|name| name.strip_suffix(".npy").map(String::from))
            .collect();
        names.sort();
        names
    }

    /// An array of numbers that must be there.
    pub(in crate::import) fn numbers(&mut self, name: &str) -> Result<Array, MotionError> {
        self.try_numbers(name)?.ok_or_else(|| {
            let problem = format!(
                "has no array {name} (but {})",
                wording::line(&self.names().join(", "))
            );
            self.file
                .unusable(&problem, "check --format, or export the motion again")
        })
    }

    /// An array of numbers, if it is there.
    pub(in crate::import) fn try_numbers(
        &mut self,
        name: &str,
    ) -> Result<Option<Array>, MotionError> {
        let file = self.file;
        let Some(npy) = self.array(name)? else {
            return Ok(None);
        };
        let shape: Vec<usize> = npy.shape().iter().map(|&d| d as usize).collect();
        let (count, fortran) = (npy.len(), npy.order() == Order::Fortran);
        if count > MOST_NUMBERS {
            return Err(file.unusable(
                &format!("array {name} claims {count} numbers"),
                "export it again",
            ));
        }
        let values = numbers(npy).ok_or_else(|| {
            file.unusable(
                &format!("array {name} is cut off or does not hold plain numbers"),
                "save it again with numpy.savez, as float32, float64 or an integer type",
            )
        })?;
        let array = Array::of(shape, values, fortran);
        array
            .ok_or_else(|| {
                file.unusable(
                    &format!("array {name} is shorter than its shape"),
                    "export it again",
                )
            })
            .map(Some)
    }

    /// A single number under one of several names; if it is there under two, they must be the same.
    pub(in crate::import) fn scalar(&mut self, names: &[&str]) -> Result<Option<f64>, MotionError> {
        let mut found: Option<(&str, f64)> = None;
        for name in names {
            let array = self.try_numbers(name)?;
            let Some(number) = array.and_then(|array| array.values.first().copied()) else {
                continue;
            };
            match found {
                Some((other, known)) if known != number => {
                    let problem = format!("has {other} = {known} and {name} = {number}");
                    return Err(self.file.unusable(&problem, "keep the right one of them"));
                }
                _ => found = found.or(Some((name, number))),
            }
        }
        Ok(found.map(|(_, number)| number))
    }

    /// An array of words, if it is there.
    pub(in crate::import) fn words(
        &mut self,
        name: &str,
    ) -> Result<Option<Vec<String>>, MotionError> {
        let file = self.file;
        let Some(npy) = self.array(name)? else {
            return Ok(None);
        };
        let words = npy
            .data::<String>()
            .ok()
            .and_then(|words| words.collect::<Result<Vec<_>, _>>().ok());
        words.map(Some).ok_or_else(|| {
            file.unusable(
                &format!("array {name} does not hold names"),
                "save it as an array of strings",
            )
        })
    }

    fn array(&mut self, name: &str) -> Result<Option<NpyFile<impl Read>>, MotionError> {
        let file = self.file;
        let entry = match self.zip.by_name(&format!("{name}.npy")) {
            Ok(entry) => entry,
            Err(ZipError::FileNotFound) => return Ok(None),
            Err(error) => return Err(broken(&file, &error)),
        };
        NpyFile::new(entry).map(Some).map_err(|error| {
            file.unusable(
                &format!("array {name} cannot be read ({error})"),
                "export it again",
            )
        })
    }
}

/// The numbers of an array, whatever their type.
fn numbers<R: Read>(npy: NpyFile<R>) -> Option<Vec<f64>> {
    macro_rules! try_types {
        ($npy:expr, $($type:ty),*) => {{
            let npy = $npy;
            $(let npy = match npy.try_data::<$type>() {
                Ok(values) => {
                    return values.map(|v| v.ok().map(|v| v as f64)).collect();
                }
                Err(npy) => npy,
            };)*
            drop(npy);
            None
        }};
    }
    try_types!(npy, f64, f32, i64, i32, i16, i8, u64, u32, u16, u8)
}

fn broken(file: &File<'_>, error: &ZipError) -> MotionError {
    file.unusable(
        &format!("is no readable .npz archive ({error})"),
        "download or export it again: it may be cut off",
    )
}

#[cfg(test)]
pub(in crate::import) mod tests;

//! Numbers and words from their bytes.
//!
//! Separate because NumPy, joblib and PyTorch write the same bytes around different headers.

use super::reader::Outcome;
use super::{Array, Value};

/// Bytes of a number of a type as in `f4`; letters have four each in `U`.
pub(super) fn width(kind: &str) -> Outcome<usize> {
    let (letter, digits) = kind.split_at_checked(1).unwrap_or((kind, ""));
    let count = digits.parse::<usize>().ok().filter(|&n| n < 1 << 16);
    match (letter, count) {
        ("f" | "i" | "u" | "b" | "S", Some(count)) => Ok(count),
        ("U", Some(count)) => Ok(4 * count),
        _ => Err(format!("numbers of type {}", wording::line(kind))),
    }
}

/// An array of numbers; words are a list of text, or one.
pub(super) fn content(
    kind: &str,
    big: bool,
    bytes: &[u8],
    shape: Vec<usize>,
    fortran: bool,
) -> Outcome<Value> {
    if kind.starts_with(['U', 'S']) {
        return Ok(Value::Words(words(kind, big, bytes)?));
    }
    Array::of(shape, values(kind, big, bytes)?, fortran)
        .map(|array| Value::Array(Box::new(array)))
        .ok_or_else(|| "an array shorter than its shape".into())
}

/// The words of an array of text of equal width, padded with zeros.
fn words(kind: &str, big: bool, bytes: &[u8]) -> Outcome<Vec<String>> {
    let width = width(kind)?.max(1);
    let word = |word: &[u8]| -> String {
        let letters = word.chunks(if kind.starts_with('U') { 4 } else { 1 });
        letters
            .map(|letter| {
                let code = letter
                    .iter()
                    .fold(0u32, |code, &byte| code << 8 | u32::from(byte));
                let code = if big || letter.len() == 1 {
                    code
                } else {
                    code.swap_bytes()
                };
                char::from_u32(code).unwrap_or('\u{fffd}')
            })
            .take_while(|&letter| letter != '\0')
            .collect()
    };
    Ok(bytes.chunks_exact(width).map(word).collect())
}

/// Numbers from their bytes.
pub(super) fn values(kind: &str, big: bool, bytes: &[u8]) -> Outcome<Vec<f64>> {
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
        other => return Err(format!("numbers of type {}", wording::line(other))),
    })
}

/// The numbers of a tensor: from `offset` on, so many apart along each dimension.
pub(super) fn strided(
    values: &[f64],
    offset: usize,
    shape: &[usize],
    strides: &[usize],
) -> Option<Array> {
    if shape.len() != strides.len() {
        return None;
    }
    let count = shape.iter().try_fold(1usize, |n, &d| n.checked_mul(d))?;
    let number = |index: usize| {
        let (mut rest, mut at) = (index, offset);
        for (&dimension, &stride) in shape.iter().zip(strides).rev() {
            at = at.checked_add((rest % dimension).checked_mul(stride)?)?;
            rest /= dimension;
        }
        values.get(at).copied()
    };
    let values = (0..count).map(number).collect::<Option<Vec<f64>>>()?;
    Array::of(shape.to_vec(), values, false)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_tensor_may_be_a_part_of_its_numbers_or_transposed() {
        let numbers: Vec<f64> = (0..12).map(f64::from).collect();
        // Columns 1 and 2 of three rows of four.
        let part = strided(&numbers, 1, &[3, 2], &[4, 1]).unwrap();
        assert_eq!(part.values, [1.0, 2.0, 5.0, 6.0, 9.0, 10.0]);
        let turned = strided(&numbers, 0, &[2, 3], &[1, 4]).unwrap();
        assert_eq!(turned.values, [0.0, 4.0, 8.0, 1.0, 5.0, 9.0]);
        assert_eq!(strided(&numbers, 9, &[3, 2], &[4, 1]), None);
        assert_eq!(strided(&numbers, 0, &[3], &[4, 1]), None);
        assert_eq!(strided(&numbers, 0, &[2, 2], &[usize::MAX, 1]), None);
        assert!(
            strided(&numbers, 0, &[0, 2], &[1, 1])
                .unwrap()
                .values
                .is_empty()
        );
    }

    #[test]
    fn words_have_letters_of_four_bytes_or_one() {
        assert_eq!(
            words("U2", false, b"m\0\0\0\0\0\0\0a\0\0\0b\0\0\0").unwrap(),
            ["m", "ab"]
        );
        assert_eq!(words("U1", true, b"\0\0\0m").unwrap(), ["m"]);
        assert_eq!(words("S3", false, b"ab\0xyz").unwrap(), ["ab", "xyz"]);
        assert!(width("O").is_err() && width("U9999999").is_err());
    }
}

//! The frame of a record: its length, a checksum of the length, the data, a checksum of the data.
//!
//! Format: TensorFlow's `tensorflow/core/lib/io/record_writer.h`. All numbers are little-endian.

/// The bytes of one record.
pub(super) fn wrap(data: &[u8]) -> Vec<u8> {
    let length = (data.len() as u64).to_le_bytes();
    let mut out = Vec::with_capacity(data.len() + 16);
    out.extend_from_slice(&length);
    out.extend_from_slice(&masked_checksum(&length).to_le_bytes());
    out.extend_from_slice(data);
    out.extend_from_slice(&masked_checksum(data).to_le_bytes());
    out
}

/// CRC-32C, turned right by 15 bits and moved by a constant.
///
/// The format does so because checksums of data that holds checksums of itself are weak.
fn masked_checksum(bytes: &[u8]) -> u32 {
    crc32c::crc32c(bytes)
        .rotate_right(15)
        .wrapping_add(0xa282_ead8)
}

/// The data of all records, or the index of the first byte that is not as it was written.
#[cfg(test)]
pub(super) fn unwrap_all(bytes: &[u8]) -> Result<Vec<&[u8]>, usize> {
    let checked = |at: usize, length: usize| -> Option<&[u8]> {
        let data = bytes.get(at..at + length)?;
        let sum = bytes.get(at + length..at + length + 4)?;
        (sum == masked_checksum(data).to_le_bytes()).then_some(data)
    };
    let (mut at, mut records) = (0, Vec::new());
    while at < bytes.len() {
        let length = checked(at, 8).ok_or(at)?;
        let length = u64::from_le_bytes(length.try_into().expect("eight bytes")) as usize;
        records.push(checked(at + 12, length).ok_or(at + 12)?);
        at += 16 + length;
    }
    Ok(records)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_checksum_by_hand() {
        // CRC-32C of "123456789" is 0xe3069283, the check value of its definition. Its low 15 bits are 0x1283, which
        // go to the top: 0x1283 << 17 = 0x25060000; the others go down: 0xe3069283 >> 15 = 0x0001c60d. Together
        // 0x2507c60d, and 0x2507c60d + 0xa282ead8 = 0xc78ab0e5.
        assert_eq!(crc32c::crc32c(b"123456789"), 0xe306_9283);
        assert_eq!(masked_checksum(b"123456789"), 0xc78a_b0e5);
    }

    #[test]
    fn a_record_is_length_checksum_data_checksum() {
        let record = wrap(b"123456789");
        assert_eq!(record.len(), 8 + 4 + 9 + 4);
        assert_eq!(record[..8], [9, 0, 0, 0, 0, 0, 0, 0]);
        assert_eq!(&record[12..21], b"123456789");
        assert_eq!(record[21..], [0xe5, 0xb0, 0x8a, 0xc7]);
    }

    #[test]
    fn damage_is_seen() {
        let mut bytes = [wrap(b"one"), wrap(b"two")].concat();
        assert_eq!(unwrap_all(&bytes).unwrap(), [b"one", b"two"]);
        bytes[19 + 12] ^= 1; // the first byte of "two"
        assert_eq!(unwrap_all(&bytes), Err(19 + 12));
    }
}

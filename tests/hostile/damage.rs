//! Damage to bytes: what disks, editors and people do to files.

use proptest::collection::vec;
use proptest::prelude::*;
use proptest::strategy::Strategy;

/// One blow; places are shares of the length.
#[derive(Clone, Debug)]
pub(crate) enum Blow {
    Flip(f64, u8),
    Insert(f64, Vec<u8>),
    Remove(f64, usize),
    Repeat(f64, usize),
    Cut(f64),
    /// Eight bytes of ones or zeros, where lengths and numbers may be.
    Fill(f64, bool),
}

/// One to six blows.
pub(crate) fn blows() -> impl Strategy<Value = Vec<Blow>> {
    let place = || 0.0..1.0_f64;
    let blow = prop_oneof![
        4 => (place(), any::<u8>()).prop_map(|(at, bits)| Blow::Flip(at, bits)),
        2 => (place(), vec(any::<u8>(), 1..9)).prop_map(|(at, bytes)| Blow::Insert(at, bytes)),
        2 => (place(), 1..40_usize).prop_map(|(at, count)| Blow::Remove(at, count)),
        1 => (place(), 1..200_usize).prop_map(|(at, count)| Blow::Repeat(at, count)),
        1 => place().prop_map(Blow::Cut),
        1 => (place(), any::<bool>()).prop_map(|(at, ones)| Blow::Fill(at, ones)),
    ];
    vec(blow, 1..7)
}

/// The bytes after all blows.
pub(crate) fn damaged(bytes: &[u8], blows: &[Blow]) -> Vec<u8> {
    let mut bytes = bytes.to_vec();
    for blow in blows {
        let length = bytes.len();
        let place = |share: f64| ((length as f64 * share) as usize).min(length);
        match blow {
            Blow::Flip(at, bits) => {
                if let Some(byte) = bytes.get_mut(place(*at)) {
                    *byte ^= bits;
                }
            }
            Blow::Insert(at, new) => {
                let at = place(*at);
                bytes.splice(at..at, new.iter().copied());
            }
            Blow::Remove(at, count) => {
                let at = place(*at);
                bytes.drain(at..(at + count).min(length));
            }
            Blow::Repeat(at, count) => {
                let at = place(*at);
                let part = bytes[at..(at + count).min(length)].to_vec();
                bytes.splice(at..at, part);
            }
            Blow::Cut(at) => bytes.truncate(place(*at)),
            Blow::Fill(at, ones) => {
                let at = place(*at);
                bytes[at..(at + 8).min(length)].fill(if *ones { 0xff } else { 0 });
            }
        }
    }
    bytes
}

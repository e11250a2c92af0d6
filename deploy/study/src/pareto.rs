//! Whether any method is better than another in everything at once: velocity error, energy and strides, each without
//! exploration noise.

use crate::gait::{ENERGY, ERROR, Measure, STRIDES_OFF};
use crate::results::Results;
use crate::statistics::Spread;

/// What is weighed against each other; of each less is better.
pub const AIMS: [Measure; 3] = [ERROR, ENERGY, STRIDES_OFF];

/// A method's means of [`AIMS`].
#[derive(Clone, Debug, PartialEq)]
pub struct Place {
    /// The entry.
    pub entry: String,
    /// In the order of [`AIMS`].
    pub means: [f64; 3],
}

impl Place {
    /// Whether this one is better in every aim.
    pub fn beats(&self, other: &Self) -> bool {
        let pairs = self.means.iter().zip(&other.means);
        pairs.into_iter().all(|(ours, theirs)| ours < theirs)
    }
}

/// Where the methods stand that have all of it.
pub fn places(results: &Results) -> Vec<Place> {
    let mean = |entry: &str, aim: &Measure| {
        Spread::of(&aim.values(results, entry)).map(|spread| spread.mean)
    };
    let place = |entry: &str| {
        let [error, energy, strides] = AIMS.map(|aim| mean(entry, &aim));
        Some(Place {
            entry: entry.to_owned(),
            means: [error?, energy?, strides?],
        })
    };
    let entries = results.entries.iter();
    entries.filter_map(|entry| place(&entry.name)).collect()
}

/// Those that no other beats.
pub fn front(places: &[Place]) -> Vec<&Place> {
    let beaten = |place: &Place| places.iter().any(|other| other.beats(place));
    places.iter().filter(|place| !beaten(place)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn who_is_better_in_two_of_three_beats_nobody() {
        let place = |entry: &str, means| Place {
            entry: entry.into(),
            means,
        };
        let places = [
            place("a", [1.0, 1.0, 1.0]),
            place("b", [0.5, 0.5, 1.5]),
            place("c", [2.0, 2.0, 2.0]),
            place("d", [1.0, 1.0, 1.0]),
        ];
        assert!(places[0].beats(&places[2]) && !places[1].beats(&places[0]));
        let front: Vec<&str> = front(&places)
            .iter()
            .map(|place| place.entry.as_str())
            .collect();
        assert_eq!(front, ["a", "b", "d"]);
    }
}

//! How far the ground under standing feet rises or sinks over a clip.
//!
//! Separate because humans and robots are asked alike, before feet are put on the ground: afterwards there is none.

use serde::{Deserialize, Serialize};

/// Frames of the pieces that are compared, half a second: a walker and a runner stand within each.
const PIECE: usize = 25;
/// Frames of a piece in which a foot must stand: at the top of a jump feet are slow for up to four.
const ENOUGH: usize = 6;
/// Which of a piece's heights is the ground's, from below: one frame that pokes through it is none.
const OF_LOWEST: usize = 1;

/// Two places of a clip between which the ground under standing feet differs most.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Floor {
    /// Difference of their heights, m.
    pub by: f64,
    /// Frame where the ground is lowest, counted from 1.
    pub lowest: usize,
    /// Frame where it is highest.
    pub highest: usize,
}

impl Floor {
    /// Of the heights of the lowest foot that stands (m), frame by frame at 50 Hz; `None` where none stands, and of clips
    /// shorter than half a second.
    pub fn of(standing: &[Option<f64>]) -> Option<Self> {
        let mut places: Vec<(usize, f64)> = Vec::new();
        for (start, piece) in standing.windows(PIECE).enumerate() {
            let mut heights: Vec<(usize, f64)> = piece
                .iter()
                .enumerate()
                .filter_map(|(i, height)| height.map(|height| (start + i, height)))
                .collect();
            if heights.len() >= ENOUGH {
                heights.sort_by(|a, b| a.1.total_cmp(&b.1));
                places.push(heights[OF_LOWEST]);
            }
        }
        let lowest = places.iter().min_by(|a, b| a.1.total_cmp(&b.1))?;
        let highest = places.iter().max_by(|a, b| a.1.total_cmp(&b.1))?;
        Some(Self {
            by: highest.1 - lowest.1,
            lowest: lowest.0 + 1,
            highest: highest.0 + 1,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ramp_is_as_high_as_its_pieces_are_apart() {
        // 1 mm a frame over 200: the second of the first piece is at 1 mm, that of the last at 176 mm.
        let ramp: Vec<Option<f64>> = (0..200).map(|i| Some(0.001 * f64::from(i))).collect();
        let floor = Floor::of(&ramp).unwrap();
        assert!((floor.by - 0.175).abs() < 1e-9, "{floor:?}");
        assert_eq!((floor.lowest, floor.highest), (2, 177));
    }

    #[test]
    fn jumps_pokes_and_flights_are_no_drift() {
        let mut standing = vec![Some(0.0); 100];
        standing[20..45].fill(None); // in the air, slow at the top for three frames
        standing[31..34].fill(Some(0.4));
        standing[70] = Some(-0.1);
        assert_eq!(Floor::of(&standing).unwrap().by, 0.0);
        assert_eq!(Floor::of(&[None; 100]), None);
        assert_eq!(Floor::of(&[Some(0.0); 24]), None);
    }
}

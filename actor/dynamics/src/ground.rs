//! What the robots stand on: a plane, or a field of heights.
//!
//! Separate because contacts only ask two things of it: how high it is below a point, and which way
//! it faces there.

use crate::lane::{Lane, Real};
use crate::spatial::Vec3;

/// The ground.
#[derive(Clone, Debug, PartialEq)]
pub enum Ground {
    /// z = 0 everywhere.
    Plane,
    /// Heights on a grid.
    Heights(Heights),
}

/// Heights on a square grid around the origin, bilinear in between, level beyond its edge.
#[derive(Clone, Debug, PartialEq)]
pub struct Heights {
    /// Distance of neighbouring points, m.
    spacing: f32,
    /// Points along each side.
    side: usize,
    /// Heights, m: x runs slowest.
    heights: Vec<f32>,
}

impl Heights {
    /// A grid of `side` × `side` heights (m), x slowest, centred on the origin; none if the number of
    /// heights is not that, the side below 2, the spacing not positive, or a height not finite.
    pub fn new(spacing: f32, side: usize, heights: Vec<f32>) -> Option<Self> {
        let sound = side >= 2
            && heights.len() == side * side
            && spacing > 0.0
            && spacing.is_finite()
            && heights.iter().all(|height| height.is_finite());
        sound.then_some(Self {
            spacing,
            side,
            heights,
        })
    }

    /// Height at a place, m.
    pub fn height(&self, x: f64, y: f64) -> f64 {
        self.look(x, y).0
    }

    /// Height and slopes along x and y at a place.
    fn look(&self, x: f64, y: f64) -> (f64, f64, f64) {
        let spacing = f64::from(self.spacing);
        let last = (self.side - 1) as f64;
        // A NaN becomes 0: the lane is thrown away later, but its place must not be read.
        let cell = |along: f64| {
            let place = (along / spacing + last / 2.0).clamp(0.0, last);
            let place = if place.is_nan() { 0.0 } else { place };
            let first = (place as usize).min(self.side - 2);
            (first, place - first as f64)
        };
        let ((i, u), (j, v)) = (cell(x), cell(y));
        let at = |i: usize, j: usize| f64::from(self.heights[i * self.side + j]);
        let (a, b, c, d) = (at(i, j), at(i + 1, j), at(i, j + 1), at(i + 1, j + 1));
        let height = a * (1.0 - u) * (1.0 - v) + b * u * (1.0 - v) + c * (1.0 - u) * v + d * u * v;
        let slope_x = ((b - a) * (1.0 - v) + (d - c) * v) / spacing;
        let slope_y = ((c - a) * (1.0 - u) + (d - b) * u) / spacing;
        (height, slope_x, slope_y)
    }
}

/// The ground below a point of each lane.
pub(crate) struct Below<L> {
    /// Distance of the point from the ground, m; negative inside it.
    pub(crate) distance: L,
    /// Normal and two tangents.
    pub(crate) frame: [Vec3<L>; 3],
}

impl Heights {
    /// Below points at world places.
    #[inline(always)]
    pub(crate) fn below<L: Lane>(&self, at: Vec3<L>) -> Below<L> {
        const WIDEST: usize = 16;
        let zero = L::Scalar::default();
        let (mut x, mut y) = ([zero; WIDEST], [zero; WIDEST]);
        at.x.store(&mut x);
        at.y.store(&mut y);
        let mut looks = [[zero; WIDEST]; 3];
        for lane in 0..L::WIDTH {
            let (height, slope_x, slope_y) = self.look(x[lane].to_f64(), y[lane].to_f64());
            looks[0][lane] = L::Scalar::of(height);
            looks[1][lane] = L::Scalar::of(slope_x);
            looks[2][lane] = L::Scalar::of(slope_y);
        }
        let token = at.x.token();
        let height = L::load(token, &looks[0]);
        let slope_x = L::load(token, &looks[1]);
        let slope_y = L::load(token, &looks[2]);
        let one = at.x.lit(1.0);
        let level = slope_x.mul_add(slope_x, slope_y.mul_add(slope_y, one));
        let upright = one / level.sqrt();
        let normal = Vec3::new(-slope_x, -slope_y, one).scale(upright);
        // Along x as it climbs, and square to both.
        let along = one / slope_x.mul_add(slope_x, one).sqrt();
        let first = Vec3::new(along, at.x.lit(0.0), slope_x * along);
        Below {
            distance: (at.z - height) * upright,
            frame: [normal, first, normal.cross(first)],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn heights_are_bilinear_and_level_beyond_the_edge() {
        // A ramp of 0.1 along x over 4 × 4 m.
        let side = 5;
        let ramp = (0..side * side).map(|i| 0.1 * (i / side) as f32).collect();
        let heights = Heights::new(1.0, side, ramp).unwrap();
        let below = heights.below(Vec3::new(0.5_f64, -0.3, 1.0));
        // Height 0.1·(0.5 + 2) = 0.25; distance 0.75·cos(atan 0.1).
        assert!((below.distance - 0.75 / 1.01_f64.sqrt()).abs() < 1e-7);
        let [n, t, s] = below.frame;
        assert!((n.x / n.z + 0.1).abs() < 1e-7 && n.y == 0.0);
        assert!(n.dot(t).abs() < 1e-12 && n.dot(s).abs() < 1e-12 && t.dot(s).abs() < 1e-12);
        let beyond = heights.below(Vec3::new(50.0_f64, 0.0, 0.0));
        assert!(beyond.distance < -0.39);
        assert!(Heights::new(1.0, 2, vec![0.0; 3]).is_none());
        assert!(Heights::new(1.0, 2, vec![f32::NAN; 4]).is_none());
    }
}

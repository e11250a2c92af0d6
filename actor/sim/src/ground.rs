//! Uneven ground, `[task.ground]`: hills that are nowhere steeper than said, and bumps on them. Not there unless listed;
//! the floor is the plane z = 0 then.
//!
//! Separate because both engines stand on the same heights, and because nothing else of the task knows of them: a robot
//! begins somewhere on the ground, and its height is told above the ground under its pelvis, as on a plane.

use dynamics::Heights;
use g1::{LEFT_FOOT, RIGHT_FOOT, RobotState, kinematics};
use rand::{Rng, RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;
use rapier3d::geometry::{Array2, HeightFieldFlags, SharedShape};
use rapier3d::math::Vector;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use vocabulary::Checked;
use vocabulary::invalid::require;

/// Points along each side of the grid.
const SIDE: usize = 193;
/// Distance of neighbouring points, m: a sole is 17 cm long.
const SPACING: f32 = 0.25;
/// From the middle to an edge, m. Beyond, the ground is level.
const EXTENT: f32 = SPACING * (SIDE - 1) as f32 / 2.0;
/// Points from one hilltop to the next, along x and along y.
const PERIOD: usize = 24;
/// The same, m.
const WAVELENGTH: f32 = SPACING * PERIOD as f32;
const _: () = assert!(
    ((SIDE - 1) / 2).is_multiple_of(PERIOD),
    "hills end at the edge"
);
/// Robots begin this far from the middle at most, along x and along y, m.
const START: f32 = 10.0;
/// Steepest hills that may be asked for, degrees.
const STEEPEST: f32 = 5.0;
/// Highest bumps that may be asked for, m.
const HIGHEST: f32 = 0.02;

/// What the ground is like.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct GroundConfig {
    /// Steepest slope of the hills, degrees; robots meet every slope up to it, in every direction. 0 to 5, default 0.
    pub slope: f32,
    /// Greatest height of the bumps, m: every 25 cm another one, drawn evenly from 0 up. 0 to 0.02, default 0.
    pub bumps: f32,
}

impl GroundConfig {
    /// Checks both; names the first bad one.
    pub fn validate(&self) -> Checked {
        require(
            (0.0..=STEEPEST).contains(&self.slope),
            "slope",
            self.slope,
            format!("give degrees from 0 to {STEEPEST}"),
        )?;
        require(
            (0.0..=HIGHEST).contains(&self.bumps),
            "bumps",
            self.bumps,
            format!("give metres from 0 to {HIGHEST}"),
        )
    }

    /// The ground of a seed: the bumps are its own, the hills those of every seed.
    pub(crate) fn lay(&self, seed: u64) -> Ground {
        let mut random = Pcg64Mcg::seed_from_u64(seed ^ 0x6772_6f75_6e64);
        let along = |point: usize| SPACING * point as f32 - EXTENT;
        let mut heights = Vec::with_capacity(SIDE * SIDE);
        for (i, j) in (0..SIDE).flat_map(|i| (0..SIDE).map(move |j| (i, j))) {
            let edge = [i, j].iter().any(|&point| point == 0 || point == SIDE - 1);
            heights.push(if edge {
                0.0
            } else {
                self.hill(along(i), along(j)) + self.bumps * random.random::<f32>()
            });
        }
        Ground(Heights::new(SPACING, SIDE, heights).expect("a square of finite heights"))
    }

    /// Height of the hills: h = H sin²(πx/λ) sin²(πy/λ) with H π/λ = tan(slope), so that no direction is steeper. It is 0
    /// along every λ, and so at the edges.
    fn hill(&self, x: f32, y: f32) -> f32 {
        let wave = std::f32::consts::PI / WAVELENGTH;
        let height = self.slope.to_radians().tan() / wave;
        height * ((wave * x).sin() * (wave * y).sin()).powi(2)
    }
}

/// The ground of a fleet.
#[derive(Clone, Debug)]
pub(crate) struct Ground(Heights);

impl Ground {
    /// For the batched solver.
    pub(crate) fn heights(&self) -> &Heights {
        &self.0
    }

    /// For rapier, whose fields lie on the xz-plane: to be turned by a quarter about x, from y up to z up.
    pub(crate) fn shape(&self) -> SharedShape {
        // Columns follow x; rows follow rapier's z, which is −y.
        let along = |point: usize| f64::from(SPACING * point as f32 - EXTENT);
        let of_column = |j| (0..SIDE).map(move |i| self.0.height(along(j), -along(i)) as f32);
        let heights = (0..SIDE).flat_map(of_column).collect();
        SharedShape::heightfield_with_flags(
            Array2::new(SIDE, SIDE, heights),
            Vector::new(2.0 * EXTENT, 1.0, 2.0 * EXTENT),
            HeightFieldFlags::FIX_INTERNAL_EDGES,
        )
    }

    /// Moves a robot over the origin to another place, its soles at least `lift` above the ground and its pelvis no nearer
    /// to it than before.
    pub(crate) fn place(&self, state: &RobotState, lift: f32, rng: &mut impl Rng) -> RobotState {
        let mut placed = *state;
        placed.position.x = rng.random_range(-START..START);
        placed.position.y = rng.random_range(-START..START);
        let bodies = kinematics::forward_state(&placed);
        let soles = [LEFT_FOOT, RIGHT_FOOT].map(|foot| kinematics::sole_points(&bodies, foot));
        let needed = soles
            .iter()
            .flatten()
            .map(|corner| self.height(corner.x, corner.y) + lift - corner.z);
        let under = self.height(placed.position.x, placed.position.y);
        placed.position.z += needed.fold(under, f32::max);
        placed
    }

    /// A state as it is told: its height above the ground under the pelvis.
    pub(crate) fn level(&self, mut state: RobotState) -> RobotState {
        state.position.z -= self.height(state.position.x, state.position.y);
        state
    }

    fn height(&self, x: f32, y: f32) -> f32 {
        self.0.height(f64::from(x), f64::from(y)) as f32
    }
}

#[cfg(test)]
mod tests;

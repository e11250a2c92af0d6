//! Along the normal: what velocity a contact wants, and how soft it is.
//!
//! Separate because the ground and the robot's own parts push alike.

use crate::lane::Lane;

/// Time constant of the normal's return, s.
const TIME_CONSTANT: f64 = 0.02;
/// Impedance at the surface and from `WIDTH` on.
const IMPEDANCE: [f64; 2] = [0.9, 0.95];
/// Depth over which the impedance rises, m.
const WIDTH: f64 = 0.001;

/// The velocity (m/s) that the normal wants of a contact at a distance (m, negative inside) that it approaches with
/// velocity `now`, and the softness (1/kg) of one that yields by `weight` (1/kg).
#[inline(always)]
pub(super) fn normal<L: Lane>(dt: L, distance: L, now: L, weight: L) -> (L, L) {
    let (zero, one) = (dt.lit(0.0), dt.lit(1.0));
    let depth = (-distance * distance.lit(1.0 / WIDTH)).max(zero).min(one);
    let impedance = depth.mul_add(
        distance.lit(IMPEDANCE[1] - IMPEDANCE[0]),
        distance.lit(IMPEDANCE[0]),
    );
    // Stiffness and damping of MuJoCo's reference, with a damping ratio of 1.
    let b = dt * distance.lit(2.0 / (IMPEDANCE[1] * TIME_CONSTANT));
    let k = dt * distance.lit(1.0 / (IMPEDANCE[1] * TIME_CONSTANT).powi(2));
    let share = one / k.mul_add(dt, b + one);
    // Above the surface the way down is free; only the velocity beyond that is braked.
    let rate = (k + distance.lit(1.0 / (IMPEDANCE[1] * TIME_CONSTANT)) * distance.lit(2.0))
        .select(zero.less(distance), k);
    let wanted = rate.neg_mul_add(distance, now) * share;
    (wanted, weight * share * (one - impedance) / impedance)
}

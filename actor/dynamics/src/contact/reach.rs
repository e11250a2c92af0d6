//! How forces on a body are felt along its chain.
//!
//! Separate because the points of a body share it: six unit wrenches are carried half-way through the
//! factored matrix once, and every point's three forces are sums of them.

use crate::factor::Factor;
use crate::kinematics::Walk;
use crate::lane::Lane;
use crate::spatial::Vec3;
use crate::tree::{BASE, CHAIN, LIMB_FIRST, TRUNK};
use g1::joints;

/// ζ of three unit forces through the root point and three unit moments, along a limb's chain.
pub(crate) struct Reach<L> {
    forces: [[L; CHAIN]; 3],
    moments: [[L; CHAIN]; 3],
}

impl<L: Lane> Reach<L> {
    pub(crate) fn new(zero: L) -> Self {
        Self {
            forces: [[zero; CHAIN]; 3],
            moments: [[zero; CHAIN]; 3],
        }
    }

    /// Of a body that the first `moved` degrees of a limb's chain move.
    #[inline(always)]
    pub(crate) fn fill<const PREFIX: usize, const COUNT: usize>(
        &mut self,
        limb: usize,
        moved: usize,
        walk: &Walk<L>,
        factor: Factor<'_, L>,
        zero: L,
    ) {
        let one = zero.lit(1.0);
        for i in BASE..CHAIN {
            let joint = if PREFIX == TRUNK && i == BASE {
                joints::WAIST
            } else {
                LIMB_FIRST[limb] + i - PREFIX
            };
            let (mut f, mut m) = (Vec3::new(zero, zero, zero), Vec3::new(zero, zero, zero));
            if i < moved {
                f = walk.motions[joint].shift;
                m = walk.motions[joint].turn;
            }
            self.forces[0][i] = f.x;
            self.forces[1][i] = f.y;
            self.forces[2][i] = f.z;
            self.moments[0][i] = m.x;
            self.moments[1][i] = m.y;
            self.moments[2][i] = m.z;
        }
        for axis in 0..3 {
            for i in 0..BASE {
                self.forces[axis][i] = if i == axis { one } else { zero };
                self.moments[axis][i] = if i == 3 + axis { one } else { zero };
            }
            factor.half_chain::<PREFIX, COUNT>(limb, &mut self.forces[axis]);
            factor.half_chain::<PREFIX, COUNT>(limb, &mut self.moments[axis]);
        }
    }

    /// ζ of unit forces at a point along normal and tangents (z, x, y unless the ground is turned), and
    /// their products: 00, 01, 02, 11, 12, 22.
    #[inline(always)]
    pub(crate) fn at(
        &self,
        at: Vec3<L>,
        frame: Option<[Vec3<L>; 3]>,
        y: &mut [[L; CHAIN]; 3],
    ) -> [L; 6] {
        let (f, m) = (&self.forces, &self.moments);
        let mut products = [at.x.lit(0.0); 6];
        for i in 0..CHAIN {
            // The moment of e_x at r is r × e_x = (0, r_z, −r_y), and so on.
            let x_force = at.z.mul_add(m[1][i], at.y.neg_mul_add(m[2][i], f[0][i]));
            let y_force = at.x.mul_add(m[2][i], at.z.neg_mul_add(m[0][i], f[1][i]));
            let z_force = at.y.mul_add(m[0][i], at.x.neg_mul_add(m[1][i], f[2][i]));
            let [a, b, c] = match frame {
                None => [z_force, x_force, y_force],
                Some([n, s, t]) => {
                    let force = Vec3::new(x_force, y_force, z_force);
                    [n.dot(force), s.dot(force), t.dot(force)]
                }
            };
            (y[0][i], y[1][i], y[2][i]) = (a, b, c);
            let [aa, ab, ac, bb, bc, cc] = products;
            products = [
                a.mul_add(a, aa),
                a.mul_add(b, ab),
                a.mul_add(c, ac),
                b.mul_add(b, bb),
                b.mul_add(c, bc),
                c.mul_add(c, cc),
            ];
        }
        products
    }
}

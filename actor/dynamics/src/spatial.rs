//! Vectors, rotations and rigid-body inertias of many robots at once.
//!
//! Separate because the recursions read as mechanics only when their algebra is elsewhere. All
//! spatial quantities are in world axes about the root point (the origin of the pelvis), in a frame
//! that moves with that point's velocity: near the origin `f32` is fine enough for all of them.

use crate::lane::{Lane, afresh};

/// A vector of three.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Vec3<L> {
    pub(crate) x: L,
    pub(crate) y: L,
    pub(crate) z: L,
}

impl<L: Lane> Vec3<L> {
    #[inline(always)]
    pub(crate) fn new(x: L, y: L, z: L) -> Self {
        Self { x, y, z }
    }
    #[inline(always)]
    pub(crate) fn splat(token: L::Token, v: [L::Scalar; 3]) -> Self {
        Self::new(
            L::splat(token, v[0]),
            L::splat(token, v[1]),
            L::splat(token, v[2]),
        )
    }
    #[inline(always)]
    pub(crate) fn add(self, b: Self) -> Self {
        Self::new(self.x + b.x, self.y + b.y, self.z + b.z)
    }
    #[inline(always)]
    pub(crate) fn sub(self, b: Self) -> Self {
        Self::new(self.x - b.x, self.y - b.y, self.z - b.z)
    }
    #[inline(always)]
    pub(crate) fn scale(self, s: L) -> Self {
        Self::new(self.x * s, self.y * s, self.z * s)
    }
    /// self·s + b.
    #[inline(always)]
    pub(crate) fn scale_add(self, s: L, b: Self) -> Self {
        Self::new(
            self.x.mul_add(s, b.x),
            self.y.mul_add(s, b.y),
            self.z.mul_add(s, b.z),
        )
    }
    #[inline(always)]
    pub(crate) fn dot(self, b: Self) -> L {
        self.x.mul_add(b.x, self.y.mul_add(b.y, self.z * b.z))
    }
    #[inline(always)]
    pub(crate) fn cross(self, b: Self) -> Self {
        Self::new(
            self.z.neg_mul_add(b.y, self.y * b.z),
            self.x.neg_mul_add(b.z, self.z * b.x),
            self.y.neg_mul_add(b.x, self.x * b.y),
        )
    }
    /// self × b + c.
    #[inline(always)]
    pub(crate) fn cross_add(self, b: Self, c: Self) -> Self {
        Self::new(
            self.z.neg_mul_add(b.y, self.y.mul_add(b.z, c.x)),
            self.x.neg_mul_add(b.z, self.z.mul_add(b.x, c.y)),
            self.y.neg_mul_add(b.x, self.x.mul_add(b.y, c.z)),
        )
    }
}

/// A rotation by its columns: where the axes of a body point in the world.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Rotation<L> {
    pub(crate) x: Vec3<L>,
    pub(crate) y: Vec3<L>,
    pub(crate) z: Vec3<L>,
}

impl<L: Lane> Rotation<L> {
    /// Of a unit quaternion.
    #[inline(always)]
    pub(crate) fn of_quaternion(w: L, i: L, j: L, k: L) -> Self {
        let two = w.lit(2.0);
        let one = w.lit(1.0);
        let (i2, j2, k2) = (i * two, j * two, k * two);
        let (ii, jj, kk) = (i * i2, j * j2, k * k2);
        let (ij, ik, jk) = (i * j2, i * k2, j * k2);
        let (wi, wj, wk) = (w * i2, w * j2, w * k2);
        Self {
            x: Vec3::new(one - jj - kk, ij + wk, ik - wj),
            y: Vec3::new(ij - wk, one - ii - kk, jk + wi),
            z: Vec3::new(ik + wj, jk - wi, one - ii - jj),
        }
    }
    /// R·v.
    #[inline(always)]
    pub(crate) fn turn(&self, v: Vec3<L>) -> Vec3<L> {
        self.x
            .scale_add(v.x, self.y.scale_add(v.y, self.z.scale(v.z)))
    }
    /// R·v + b.
    #[inline(always)]
    pub(crate) fn turn_add(&self, v: Vec3<L>, b: Vec3<L>) -> Vec3<L> {
        self.x
            .scale_add(v.x, self.y.scale_add(v.y, self.z.scale_add(v.z, b)))
    }
}

/// A symmetric matrix of three.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Symmetric<L> {
    pub(crate) xx: L,
    pub(crate) yy: L,
    pub(crate) zz: L,
    pub(crate) xy: L,
    pub(crate) xz: L,
    pub(crate) yz: L,
}

impl<L: Lane> Symmetric<L> {
    #[inline(always)]
    pub(crate) fn turn(&self, v: Vec3<L>) -> Vec3<L> {
        self.turn_add(v, None)
    }

    #[inline(always)]
    fn turn_add(&self, v: Vec3<L>, b: Option<Vec3<L>>) -> Vec3<L> {
        let (x, y, z) = match b {
            None => (self.xz * v.z, self.yz * v.z, self.zz * v.z),
            Some(b) => (
                self.xz.mul_add(v.z, b.x),
                self.yz.mul_add(v.z, b.y),
                self.zz.mul_add(v.z, b.z),
            ),
        };
        Vec3::new(
            self.xx.mul_add(v.x, self.xy.mul_add(v.y, x)),
            self.xy.mul_add(v.x, self.yy.mul_add(v.y, y)),
            self.xz.mul_add(v.x, self.yz.mul_add(v.y, z)),
        )
    }

    /// R·self·Rᵀ.
    #[inline(always)]
    pub(crate) fn turned(&self, r: &Rotation<L>) -> Self {
        // A column of R·self after the other, and what it adds to the upper half of the product with Rᵀ.
        // The rotation is read again for each: nine numbers of it, six sums and a column are too many for
        // sixteen registers.
        let c =
            r.x.scale_add(self.xz, r.y.scale_add(self.yz, r.z.scale(self.zz)));
        let product = Self {
            xx: c.x * r.z.x,
            yy: c.y * r.z.y,
            zz: c.z * r.z.z,
            xy: c.x * r.z.y,
            xz: c.x * r.z.z,
            yz: c.y * r.z.z,
        };
        let r = afresh(r);
        let b =
            r.x.scale_add(self.xy, r.y.scale_add(self.yy, r.z.scale(self.yz)));
        let product = product.outer_add(b, r.y);
        let r = afresh(r);
        let a =
            r.x.scale_add(self.xx, r.y.scale_add(self.xy, r.z.scale(self.xz)));
        product.outer_add(a, r.x)
    }

    /// The upper half of a·bᵀ + self.
    #[inline(always)]
    fn outer_add(&self, a: Vec3<L>, b: Vec3<L>) -> Self {
        Self {
            xx: a.x.mul_add(b.x, self.xx),
            yy: a.y.mul_add(b.y, self.yy),
            zz: a.z.mul_add(b.z, self.zz),
            xy: a.x.mul_add(b.y, self.xy),
            xz: a.x.mul_add(b.z, self.xz),
            yz: a.y.mul_add(b.z, self.yz),
        }
    }
}

/// Rotation beside translation: a velocity or an acceleration (ω, v), or a moment and a force (n, f).
#[derive(Clone, Copy, Debug)]
pub(crate) struct Spatial<L> {
    /// Angular part, or moment about the root point.
    pub(crate) turn: Vec3<L>,
    /// Linear part at the root point, or force.
    pub(crate) shift: Vec3<L>,
}

impl<L: Lane> Spatial<L> {
    #[inline(always)]
    pub(crate) fn add(self, b: Self) -> Self {
        Self {
            turn: self.turn.add(b.turn),
            shift: self.shift.add(b.shift),
        }
    }
    #[inline(always)]
    pub(crate) fn scale(self, s: L) -> Self {
        Self {
            turn: self.turn.scale(s),
            shift: self.shift.scale(s),
        }
    }
    /// Power of a force over a motion.
    #[inline(always)]
    pub(crate) fn dot(self, b: Self) -> L {
        let (a, c) = (self.turn, self.shift);
        let half = a.x.mul_add(b.turn.x, a.y.mul_add(b.turn.y, a.z * b.turn.z));
        c.x.mul_add(
            b.shift.x,
            c.y.mul_add(b.shift.y, c.z.mul_add(b.shift.z, half)),
        )
    }
    /// self × m for motions, added to b.
    #[inline(always)]
    pub(crate) fn cross_motion_add(self, m: Self, b: Self) -> Self {
        Self {
            turn: self.turn.cross_add(m.turn, b.turn),
            shift: self
                .turn
                .cross_add(m.shift, self.shift.cross_add(m.turn, b.shift)),
        }
    }
    /// self ×* f for a motion and a force, added to b.
    #[inline(always)]
    pub(crate) fn cross_force_add(self, f: Self, b: Self) -> Self {
        Self {
            turn: self
                .turn
                .cross_add(f.turn, self.shift.cross_add(f.shift, b.turn)),
            shift: self.turn.cross_add(f.shift, b.shift),
        }
    }
}

/// Inertia of a body, or of several, about the root point.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Inertia<L> {
    pub(crate) mass: L,
    /// Mass times the place of its centre, kg·m.
    pub(crate) moment: Vec3<L>,
    /// Rotational inertia about the root point, kg·m².
    pub(crate) rotational: Symmetric<L>,
}

impl<L: Lane> Inertia<L> {
    /// Of a body with its centre of mass at `centre` and inertia `own` about it.
    #[inline(always)]
    pub(crate) fn of_body(mass: L, centre: Vec3<L>, own: &Symmetric<L>) -> Self {
        let moment = centre.scale(mass);
        let (hx, hy, hz) = (moment.x, moment.y, moment.z);
        let (xx, yy, zz) = (hx * centre.x, hy * centre.y, hz * centre.z);
        Self {
            mass,
            moment,
            rotational: Symmetric {
                xx: own.xx + (yy + zz),
                yy: own.yy + (xx + zz),
                zz: own.zz + (xx + yy),
                xy: hx.neg_mul_add(centre.y, own.xy),
                xz: hx.neg_mul_add(centre.z, own.xz),
                yz: hy.neg_mul_add(centre.z, own.yz),
            },
        }
    }
    #[inline(always)]
    pub(crate) fn add(&self, b: &Self) -> Self {
        let (p, q) = (&self.rotational, &b.rotational);
        Self {
            mass: self.mass + b.mass,
            moment: self.moment.add(b.moment),
            rotational: Symmetric {
                xx: p.xx + q.xx,
                yy: p.yy + q.yy,
                zz: p.zz + q.zz,
                xy: p.xy + q.xy,
                xz: p.xz + q.xz,
                yz: p.yz + q.yz,
            },
        }
    }
    /// Momentum of a velocity, or force of an acceleration.
    #[inline(always)]
    pub(crate) fn times(&self, m: Spatial<L>) -> Spatial<L> {
        let turn = self.rotational.turn(m.turn);
        Spatial {
            turn: self.moment.cross_add(m.shift, turn),
            // m·v − h×ω = m·v + ω×h
            shift: m.turn.cross_add(self.moment, m.shift.scale(self.mass)),
        }
    }
}

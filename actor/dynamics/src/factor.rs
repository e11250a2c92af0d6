//! H = LᵀDL along the tree, and solves with its halves.
//!
//! Separate because the order of elimination is the tree's: from the ends inward a row fills nothing
//! that was empty (Featherstone 2008, section 6.5). Rows hold the chain of their joint only.
//!
//! ζ = D^-½·L⁻ᵀ·f carries a force f half-way: L⁻¹·D^-½·ζ is the change of velocity that it makes, and
//! the product of two ζ is what one force does along another.

use crate::lane::Lane;
use crate::tree::{BASE, CHAIN, DEGREES, LIMB_FIRST, LIMB_JOINTS, LIMBS, TRUNK};

/// A factored matrix: L without its unit diagonal, D as its inverse's root.
#[derive(Clone, Copy)]
pub(crate) struct Factor<'a, L> {
    pub(crate) trunk: &'a [[L; TRUNK]; TRUNK],
    pub(crate) limbs: &'a [[[L; CHAIN]; LIMB_JOINTS]; LIMBS],
    /// D^-½ of every degree.
    pub(crate) root: &'a [L; DEGREES],
}

/// Prefix and joints of a limb.
pub(crate) const fn limb_shape(limb: usize) -> (usize, usize) {
    if limb < 2 { (BASE, 6) } else { (TRUNK, 5) }
}

/// Index of the first joint of a limb among the degrees.
pub(crate) const fn limb_degree(limb: usize) -> usize {
    BASE + LIMB_FIRST[limb]
}

/// Repeats a block with a constant, so that every loop inside has a known length and what it works on
/// stays in registers.
macro_rules! each {
    ($name:ident in [$($value:literal)*] $body:block) => {
        $({ const $name: usize = $value; $body })*
    };
}
pub(crate) use each;

/// Factors in place: limbs, then the trunk that they load.
///
/// Row by row with all that was eliminated before, instead of spreading every row at once: a row's
/// sums stay in registers and are stored once. A row before its division is the row times its pivot.
#[inline(always)]
pub(crate) fn factor<L: Lane>(
    trunk: &mut [[L; TRUNK]; TRUNK],
    limbs: &mut [[[L; CHAIN]; LIMB_JOINTS]; LIMBS],
    root: &mut [L; DEGREES],
) {
    let zero = trunk[0][0].lit(0.0);
    let mut load = [[zero; TRUNK]; TRUNK];
    for limb in 0..2 {
        let root = &mut root[limb_degree(limb)..];
        eliminate_limb::<L, BASE, 6>(&mut limbs[limb], root, &mut load);
    }
    for limb in 2..LIMBS {
        let root = &mut root[limb_degree(limb)..];
        eliminate_limb::<L, TRUNK, 5>(&mut limbs[limb], root, &mut load);
    }
    for k in 0..TRUNK {
        for j in 0..=k {
            trunk[k][j] = trunk[k][j] - load[k][j];
        }
    }
    // The waist is the trunk's last row and the degree after both legs.
    let pivots = &mut [zero; TRUNK];
    each!(I in [6 5 4 3 2 1 0] {
        let mut row = trunk[I];
        each!(K in [1 2 3 4 5 6] {
            if K > I {
                let a = trunk[K][I] * pivots[K];
                each!(J in [0 1 2 3 4 5 6] {
                    if J <= I {
                        row[J] = a.neg_mul_add(trunk[K][J], row[J]);
                    }
                });
            }
        });
        let pivot = row[I];
        let inverse = zero.lit(1.0) / pivot;
        pivots[I] = pivot;
        each!(J in [0 1 2 3 4 5 6] {
            if J < I {
                trunk[I][J] = row[J] * inverse;
            }
        });
        root[trunk_degree(I)] = inverse.sqrt();
    });
}

/// Degree of a row of the trunk.
pub(crate) const fn trunk_degree(row: usize) -> usize {
    if row < BASE {
        row
    } else {
        BASE + g1::joints::WAIST
    }
}

/// Eliminates a limb's joints; adds what they take from the trunk to `load`.
#[inline(always)]
fn eliminate_limb<L: Lane, const PREFIX: usize, const COUNT: usize>(
    rows: &mut [[L; CHAIN]; LIMB_JOINTS],
    root: &mut [L],
    load: &mut [[L; TRUNK]; TRUNK],
) {
    let one = rows[0][0].lit(1.0);
    let mut pivots = [one; LIMB_JOINTS];
    each!(I in [5 4 3 2 1 0] {
        if I < COUNT {
            let mut row = rows[I];
            each!(K in [1 2 3 4 5] {
                if K > I && K < COUNT {
                    let a = rows[K][PREFIX + I] * pivots[K];
                    each!(J in [0 1 2 3 4 5 6 7 8 9 10 11] {
                        if J <= PREFIX + I {
                            row[J] = a.neg_mul_add(rows[K][J], row[J]);
                        }
                    });
                }
            });
            let pivot = row[PREFIX + I];
            let inverse = one / pivot;
            pivots[I] = pivot;
            each!(J in [0 1 2 3 4 5 6 7 8 9 10 11] {
                if J < PREFIX + I {
                    rows[I][J] = row[J] * inverse;
                }
            });
            root[I] = inverse.sqrt();
        }
    });
    each!(I in [0 1 2 3 4 5 6] {
        if I < PREFIX {
            let mut row = load[I];
            each!(K in [0 1 2 3 4 5] {
                if K < COUNT {
                    let a = rows[K][I] * pivots[K];
                    each!(J in [0 1 2 3 4 5 6] {
                        if J <= I {
                            row[J] = a.mul_add(rows[K][J], row[J]);
                        }
                    });
                }
            });
            each!(J in [0 1 2 3 4 5 6] {
                if J <= I {
                    load[I][J] = row[J];
                }
            });
        }
    });
}

impl<L: Lane> Factor<'_, L> {
    /// f → ζ = D^-½·L⁻ᵀ·f for a force on all degrees, in place.
    #[inline(always)]
    pub(crate) fn half(&self, x: &mut [L; DEGREES]) {
        for limb in 0..2 {
            self.half_limb::<BASE, 6>(limb, x);
        }
        for limb in 2..LIMBS {
            self.half_limb::<TRUNK, 5>(limb, x);
        }
        each!(K in [6 5 4 3 2 1 0] {
            let value = x[trunk_degree(K)];
            for i in 0..K {
                x[i] = self.trunk[K][i].neg_mul_add(value, x[i]);
            }
            x[trunk_degree(K)] = value * self.root[trunk_degree(K)];
        });
    }

    #[inline(always)]
    fn half_limb<const PREFIX: usize, const COUNT: usize>(
        &self,
        limb: usize,
        x: &mut [L; DEGREES],
    ) {
        let first = limb_degree(limb);
        let rows = &self.limbs[limb];
        let mut trunk = [x[0]; TRUNK];
        for (i, value) in trunk.iter_mut().enumerate() {
            *value = x[trunk_degree(i)];
        }
        let mut own = [x[0]; COUNT];
        for (i, value) in own.iter_mut().enumerate() {
            *value = x[first + i];
        }
        each!(K in [5 4 3 2 1 0] {
            if K < COUNT {
                let value = own[K];
                for i in 0..K {
                    own[i] = rows[K][PREFIX + i].neg_mul_add(value, own[i]);
                }
                for i in 0..PREFIX {
                    trunk[i] = rows[K][i].neg_mul_add(value, trunk[i]);
                }
                x[first + K] = value * self.root[first + K];
            }
        });
        for i in 0..PREFIX {
            x[trunk_degree(i)] = trunk[i];
        }
    }

    /// f → ζ for a force on the chain of one limb, in place.
    #[inline(always)]
    pub(crate) fn half_chain<const PREFIX: usize, const COUNT: usize>(
        &self,
        limb: usize,
        y: &mut [L; CHAIN],
    ) {
        let first = limb_degree(limb);
        let rows = &self.limbs[limb];
        let mut x = [y[0]; CHAIN];
        for i in 0..PREFIX + COUNT {
            x[i] = y[i];
        }
        each!(K in [5 4 3 2 1 0] {
            if K < COUNT {
                let value = x[PREFIX + K];
                for i in 0..PREFIX + K {
                    x[i] = rows[K][i].neg_mul_add(value, x[i]);
                }
                x[PREFIX + K] = value * self.root[first + K];
            }
        });
        each!(K in [6 5 4 3 2 1 0] {
            if K < PREFIX {
                let value = x[K];
                for i in 0..K {
                    x[i] = self.trunk[K][i].neg_mul_add(value, x[i]);
                }
                x[K] = value * self.root[trunk_degree(K)];
            }
        });
        for i in 0..PREFIX + COUNT {
            y[i] = x[i];
        }
    }

    /// ζ → L⁻¹·D^-½·ζ: the change of velocity, in place.
    #[inline(always)]
    pub(crate) fn velocity(&self, x: &mut [L; DEGREES]) {
        for k in 0..TRUNK {
            let degree = trunk_degree(k);
            let mut value = x[degree] * self.root[degree];
            for i in 0..k {
                value = self.trunk[k][i].neg_mul_add(x[i], value);
            }
            x[degree] = value;
        }
        for limb in 0..2 {
            self.velocity_limb::<BASE, 6>(limb, x);
        }
        for limb in 2..LIMBS {
            self.velocity_limb::<TRUNK, 5>(limb, x);
        }
    }

    #[inline(always)]
    fn velocity_limb<const PREFIX: usize, const COUNT: usize>(
        &self,
        limb: usize,
        x: &mut [L; DEGREES],
    ) {
        let first = limb_degree(limb);
        let rows = &self.limbs[limb];
        let mut chain = [x[0]; CHAIN];
        each!(I in [0 1 2 3 4 5 6] {
            if I < PREFIX {
                chain[I] = x[trunk_degree(I)];
            }
        });
        each!(K in [0 1 2 3 4 5] {
            if K < COUNT {
                // Two sums, for one would wait for itself.
                let mut value = x[first + K] * self.root[first + K];
                let mut other = rows[K][0] * chain[0];
                each!(I in [1 2 3 4 5 6 7 8 9 10] {
                    if I < PREFIX + K {
                        if I.is_multiple_of(2) {
                            other = rows[K][I].mul_add(chain[I], other);
                        } else {
                            value = rows[K][I].neg_mul_add(chain[I], value);
                        }
                    }
                });
                chain[PREFIX + K] = value - other;
                x[first + K] = chain[PREFIX + K];
            }
        });
    }
}

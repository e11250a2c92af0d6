//! A body of the tree: where it is, how it moves, what it weighs.
//!
//! Separate because this is what happens to every body alike; the walk over the tree is in
//! [`crate::kinematics`].

use crate::capsules::Capsules;
use crate::lane::{Lane, afresh};
use crate::spatial::{Inertia, Rotation, Spatial, Symmetric, Vec3};
use crate::tree::{Hinge, POINTS, Tree};
use g1::collision::CAPSULES;

/// Where a body is.
#[derive(Clone, Copy)]
pub(crate) struct Frame<L> {
    pub(crate) orientation: Rotation<L>,
    /// From the root point, world axes, m.
    pub(crate) position: Vec3<L>,
}

impl<L: Lane> Frame<L> {
    /// Across a joint at angle `q`, of a known axis and with its own frame turned or not, to the next body; and the
    /// joint's motion at unit speed.
    #[inline(always)]
    pub(crate) fn across(
        &self,
        token: L::Token,
        hinge: &Hinge<L::Scalar>,
        (axis, placed): (usize, bool),
        q: L,
    ) -> (Self, Spatial<L>) {
        let origin = Vec3::splat(token, hinge.origin);
        let position = self.orientation.turn_add(origin, self.position);
        let mut r = self.orientation;
        if placed {
            let [x, y, z] = hinge.placed;
            r = Rotation {
                x: self.orientation.turn(Vec3::splat(token, x)),
                y: self.orientation.turn(Vec3::splat(token, y)),
                z: self.orientation.turn(Vec3::splat(token, z)),
            };
        }
        let (sin, cos) = q.sin_cos();
        let ahead = |a: Vec3<L>, b: Vec3<L>| b.scale_add(sin, a.scale(cos));
        let behind = |a: Vec3<L>, b: Vec3<L>| b.scale_add(-sin, a.scale(cos));
        let (axis, orientation) = match axis {
            0 => (
                r.x,
                Rotation {
                    x: r.x,
                    y: ahead(r.y, r.z),
                    z: behind(r.z, r.y),
                },
            ),
            1 => (
                r.y,
                Rotation {
                    x: behind(r.x, r.z),
                    y: r.y,
                    z: ahead(r.z, r.x),
                },
            ),
            _ => (
                r.z,
                Rotation {
                    x: ahead(r.x, r.y),
                    y: behind(r.y, r.x),
                    z: r.z,
                },
            ),
        };
        let motion = Spatial {
            turn: axis,
            shift: position.cross(axis),
        };
        let frame = Self {
            orientation,
            position,
        };
        (frame, motion)
    }

    /// Where the contact points of a body are.
    #[inline(always)]
    pub(crate) fn place(
        &self,
        token: L::Token,
        tree: &Tree<L::Scalar>,
        body: usize,
        points: &mut [Vec3<L>; POINTS],
    ) {
        let (first, end) = tree.of_body[body];
        for &point in &tree.order[first..end] {
            let at = Vec3::splat(token, tree.points[point]);
            points[point] = self.orientation.turn_add(at, self.position);
        }
    }

    /// Where the ends of a body's capsule are, if it has one.
    #[inline(always)]
    pub(crate) fn span(
        &self,
        token: L::Token,
        capsules: &Capsules<L::Scalar>,
        body: usize,
        ends: &mut [[Vec3<L>; 2]; CAPSULES],
    ) {
        if let Some(capsule) = capsules.of_body[body] {
            for end in 0..2 {
                let at = Vec3::splat(token, capsules.ends[capsule][end]);
                ends[capsule][end] = self.orientation.turn_add(at, self.position);
            }
        }
    }
}

/// A body on the way down; on the way up with all that hangs on it.
#[derive(Clone, Copy)]
pub(crate) struct Body<L> {
    pub(crate) frame: Frame<L>,
    /// With zero generalised accelerations, gravity as an upward acceleration.
    pub(crate) acceleration: Spatial<L>,
    pub(crate) inertia: Inertia<L>,
    /// What its motion takes.
    pub(crate) force: Spatial<L>,
}

impl<L: Lane> Body<L> {
    #[inline(always)]
    pub(crate) fn new(zero: L) -> Self {
        let none = Vec3::new(zero, zero, zero);
        let still = Spatial {
            turn: none,
            shift: none,
        };
        Self {
            frame: Frame {
                orientation: Rotation {
                    x: none,
                    y: none,
                    z: none,
                },
                position: none,
            },
            acceleration: still,
            inertia: Inertia {
                mass: zero,
                moment: none,
                rotational: Symmetric {
                    xx: zero,
                    yy: zero,
                    zz: zero,
                    xy: zero,
                    xz: zero,
                    yz: zero,
                },
            },
            force: still,
        }
    }

    /// Inertia and force from place and motion, and the numbers of [`crate::tree::inertial`].
    #[inline(always)]
    pub(crate) fn weigh(&mut self, velocity: &Spatial<L>, number: impl Fn(usize) -> L) {
        let own = Symmetric {
            xx: number(4),
            yy: number(5),
            zz: number(6),
            xy: number(7),
            xz: number(8),
            yz: number(9),
        };
        let turned = own.turned(&self.frame.orientation);
        let Frame {
            orientation,
            position,
        } = afresh(&self.frame);
        let centre = orientation.turn_add(Vec3::new(number(1), number(2), number(3)), *position);
        self.inertia = Inertia::of_body(number(0), centre, &turned);
        let acceleration = self.acceleration;
        let pushed = afresh(&self.inertia).times(acceleration);
        let momentum = afresh(&self.inertia).times(*velocity);
        self.force = afresh(velocity).cross_force_add(momentum, pushed);
    }

    /// Takes on what hangs on it.
    #[inline(always)]
    pub(crate) fn carry(&mut self, inertia: &Inertia<L>, force: Spatial<L>) {
        self.inertia = self.inertia.add(inertia);
        self.force = self.force.add(force);
    }
}

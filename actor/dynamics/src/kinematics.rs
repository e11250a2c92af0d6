//! Down the tree and up again: frames, bias forces, composite inertias, the mass matrix.
//!
//! Separate because this is the mechanics of the robot without what acts on it. Newton–Euler with
//! zero accelerations gives the bias, composite rigid bodies give the mass matrix, both after
//! Featherstone, *Rigid Body Dynamics Algorithms* (2008), chapters 5 and 6, with all quantities in
//! world axes about the root point, so that composites and forces are plain sums.

use crate::block::{Block, row};
use crate::factor::each;
use crate::lane::Lane;
use crate::spatial::{Inertia, Rotation, Spatial, Symmetric, Vec3};
use crate::tree::{
    BASE, CHAIN, DEGREES, LIMB_FIRST, LIMB_JOINTS, LIMBS, POINTS, SHAPES, TRUNK, Tree,
};
use g1::{BODIES, JOINTS, joints, links};

/// Gravity, m/s².
const GRAVITY: f64 = 9.81;

/// A body on the way down.
#[derive(Clone, Copy)]
struct Frame<L> {
    orientation: Rotation<L>,
    /// From the root point, world axes, m.
    position: Vec3<L>,
    velocity: Spatial<L>,
    /// With zero generalised accelerations, gravity as an upward acceleration.
    acceleration: Spatial<L>,
}

/// What the walk leaves behind.
pub(crate) struct Walk<L> {
    /// Motion of every joint at unit speed.
    pub(crate) motions: [Spatial<L>; JOINTS],
    /// Bias forces: gravity, Coriolis, centrifugal.
    pub(crate) bias: [L; DEGREES],
    /// Mass matrix of base and waist, lower half.
    pub(crate) trunk: [[L; TRUNK]; TRUNK],
    /// Rows of the mass matrix of every limb's joints along their chain.
    pub(crate) limbs: [[[L; CHAIN]; LIMB_JOINTS]; LIMBS],
    /// Contact points from the root point, world axes, m.
    pub(crate) points: [Vec3<L>; POINTS],
    /// Velocities of the bodies in the frame that moves with the root point.
    pub(crate) velocities: [Spatial<L>; BODIES],
    /// Bodies of the limb at work, and the forces that their motion takes.
    bodies: [(Inertia<L>, Spatial<L>); LIMB_JOINTS],
}

impl<L: Lane> Walk<L> {
    #[inline(always)]
    pub(crate) fn new(token: L::Token) -> Self {
        let zero = L::splat(token, L::Scalar::default());
        let none = Vec3::new(zero, zero, zero);
        let still = Spatial {
            turn: none,
            shift: none,
        };
        let weightless = Inertia {
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
        };
        Self {
            motions: [still; JOINTS],
            bias: [zero; DEGREES],
            trunk: [[zero; TRUNK]; TRUNK],
            limbs: [[[zero; CHAIN]; LIMB_JOINTS]; LIMBS],
            points: [none; POINTS],
            velocities: [still; BODIES],
            bodies: [(weightless, still); LIMB_JOINTS],
        }
    }

    /// Fills everything for the robots of a block from `lane` on.
    #[inline(always)]
    pub(crate) fn run(
        &mut self,
        token: L::Token,
        tree: &Tree<L::Scalar>,
        block: &Block<L::Scalar>,
        lane: usize,
    ) {
        let state = block.rows();
        let get = |row: usize| -> L { state[row].get(token, lane) };
        let zero = L::splat(token, L::Scalar::default());
        let none = Vec3::new(zero, zero, zero);
        let q = row::QUATERNION;
        let pelvis = Frame {
            orientation: Rotation::of_quaternion(get(q), get(q + 1), get(q + 2), get(q + 3)),
            position: none,
            velocity: Spatial {
                turn: Vec3::new(
                    get(row::ANGULAR),
                    get(row::ANGULAR + 1),
                    get(row::ANGULAR + 2),
                ),
                shift: none,
            },
            acceleration: Spatial {
                turn: none,
                shift: Vec3::new(zero, zero, zero.lit(GRAVITY)),
            },
        };
        let (mut whole, mut force) = self.body(token, tree, block, lane, links::PELVIS, &pelvis);
        for limb in 0..2 {
            let (inertia, load) = self.limb::<BASE, 6>(token, tree, block, lane, limb, &pelvis);
            whole = whole.add(&inertia);
            force = force.add(load);
        }
        let torso = self.hinge(
            token,
            tree,
            block,
            lane,
            joints::WAIST,
            SHAPES[joints::WAIST],
            &pelvis,
        );
        let (mut upper, mut load) = self.body(token, tree, block, lane, links::TORSO, &torso);
        for limb in 2..LIMBS {
            let (inertia, of_arm) = self.limb::<TRUNK, 5>(token, tree, block, lane, limb, &torso);
            upper = upper.add(&inertia);
            load = load.add(of_arm);
        }
        let waist = self.motions[joints::WAIST];
        let moved = upper.times(waist);
        self.bias[BASE + joints::WAIST] = waist.dot(load);
        let armature = L::splat(token, tree.hinges[joints::WAIST].armature);
        self.trunk[BASE] = [
            moved.shift.x,
            moved.shift.y,
            moved.shift.z,
            moved.turn.x,
            moved.turn.y,
            moved.turn.z,
            waist.dot(moved) + armature,
        ];
        whole = whole.add(&upper);
        force = force.add(load);
        self.base(&whole, &force, zero);
    }

    /// The base's own part: total mass, first moment, inertia and load.
    #[inline(always)]
    fn base(&mut self, whole: &Inertia<L>, force: &Spatial<L>, zero: L) {
        let (m, h, j) = (whole.mass, whole.moment, &whole.rotational);
        let trunk = &mut self.trunk;
        trunk[0][0] = m;
        [trunk[1][0], trunk[1][1]] = [zero, m];
        [trunk[2][0], trunk[2][1], trunk[2][2]] = [zero, zero, m];
        let rows = [
            [zero, -h.z, h.y, j.xx, zero, zero],
            [h.z, zero, -h.x, j.xy, j.yy, zero],
            [-h.y, h.x, zero, j.xz, j.yz, j.zz],
        ];
        each!(I in [0 1 2] {
            each!(J in [0 1 2 3 4 5] {
                if J <= 3 + I {
                    trunk[3 + I][J] = rows[I][J];
                }
            });
        });
        let (f, n) = (force.shift, force.turn);
        let bias = [f.x, f.y, f.z, n.x, n.y, n.z];
        each!(I in [0 1 2 3 4 5] {
            self.bias[I] = bias[I];
        });
    }

    /// A limb down and up; returns what it weighs and how it loads its root.
    #[inline(always)]
    fn limb<const PREFIX: usize, const COUNT: usize>(
        &mut self,
        token: L::Token,
        tree: &Tree<L::Scalar>,
        block: &Block<L::Scalar>,
        lane: usize,
        limb: usize,
        root: &Frame<L>,
    ) -> (Inertia<L>, Spatial<L>) {
        let first = LIMB_FIRST[limb];
        let mut frame = *root;
        each!(K in [0 1 2 3 4 5] {
            if K < COUNT {
                let shape = SHAPES[if PREFIX == BASE { K } else { LIMB_FIRST[2] + K }];
                frame = self.hinge(token, tree, block, lane, first + K, shape, &frame);
                self.bodies[K] = self.body(token, tree, block, lane, first + K + 1, &frame);
            }
        });
        let (mut whole, mut load) = self.bodies[COUNT - 1];
        each!(K in [5 4 3 2 1 0] {
            if K < COUNT {
            let k = K;
            let motion = self.motions[first + k];
            let moved = whole.times(motion);
            self.bias[BASE + first + k] = motion.dot(load);
            let rows = &mut self.limbs[limb][k];
            rows[0] = moved.shift.x;
            rows[1] = moved.shift.y;
            rows[2] = moved.shift.z;
            rows[3] = moved.turn.x;
            rows[4] = moved.turn.y;
            rows[5] = moved.turn.z;
            if PREFIX == TRUNK {
                rows[BASE] = self.motions[joints::WAIST].dot(moved);
            }
            each!(M in [0 1 2 3 4 5] {
                if M <= K {
                    rows[PREFIX + M] = self.motions[first + M].dot(moved);
                }
            });
            rows[PREFIX + k] = rows[PREFIX + k] + L::splat(token, tree.hinges[first + k].armature);
            if k > 0 {
                whole = whole.add(&self.bodies[k - 1].0);
                load = load.add(self.bodies[k - 1].1);
            }
            }
        });
        (whole, load)
    }

    /// From a body across a joint to the next.
    #[expect(
        clippy::too_many_arguments,
        reason = "a part of `run`, split off only for its shape"
    )]
    #[inline(always)]
    fn hinge(
        &mut self,
        token: L::Token,
        tree: &Tree<L::Scalar>,
        block: &Block<L::Scalar>,
        lane: usize,
        joint: usize,
        (axis, placed): (usize, bool),
        parent: &Frame<L>,
    ) -> Frame<L> {
        let hinge = &tree.hinges[joint];
        let origin = Vec3::splat(token, hinge.origin);
        let position = parent.orientation.turn_add(origin, parent.position);
        let mut r = parent.orientation;
        if placed {
            let [x, y, z] = hinge.placed;
            r = Rotation {
                x: parent.orientation.turn(Vec3::splat(token, x)),
                y: parent.orientation.turn(Vec3::splat(token, y)),
                z: parent.orientation.turn(Vec3::splat(token, z)),
            };
        }
        let state = block.rows();
        let q: L = state[row::JOINT + joint].get(token, lane);
        let speed: L = state[row::SPEED + joint].get(token, lane);
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
        self.motions[joint] = motion;
        let turning = motion.scale(speed);
        Frame {
            orientation,
            position,
            velocity: parent.velocity.add(turning),
            acceleration: parent
                .velocity
                .cross_motion_add(turning, parent.acceleration),
        }
    }

    /// A body's inertia and the force that its motion takes; its contact points on the way.
    #[inline(always)]
    fn body(
        &mut self,
        token: L::Token,
        tree: &Tree<L::Scalar>,
        block: &Block<L::Scalar>,
        lane: usize,
        body: usize,
        frame: &Frame<L>,
    ) -> (Inertia<L>, Spatial<L>) {
        let numbers = block.body(body);
        let get = |i: usize| -> L { numbers[i].get(token, lane) };
        let centre = frame
            .orientation
            .turn_add(Vec3::new(get(1), get(2), get(3)), frame.position);
        let own = Symmetric {
            xx: get(4),
            yy: get(5),
            zz: get(6),
            xy: get(7),
            xz: get(8),
            yz: get(9),
        };
        let inertia = Inertia::of_body(get(0), centre, &own, &frame.orientation);
        let momentum = inertia.times(frame.velocity);
        let force = frame
            .velocity
            .cross_force_add(momentum, inertia.times(frame.acceleration));
        self.velocities[body] = frame.velocity;
        let (first, end) = tree.of_body[body];
        for &point in &tree.order[first..end] {
            let at = Vec3::splat(token, tree.points[point]);
            self.points[point] = frame.orientation.turn_add(at, frame.position);
        }
        (inertia, force)
    }
}

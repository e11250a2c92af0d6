//! Down the tree and up again: frames, bias forces, composite inertias, the mass matrix.
//!
//! Separate because this is the mechanics of the robot without what acts on it. Newton–Euler with
//! zero accelerations gives the bias, composite rigid bodies give the mass matrix, both after
//! Featherstone, *Rigid Body Dynamics Algorithms* (2008), chapters 5 and 6, with all quantities in
//! world axes about the root point, so that composites and forces are plain sums.

use crate::block::row;
use crate::body::{Body, Frame};
use crate::factor::each;
use crate::group::Group;
use crate::lane::{Lane, afresh};
use crate::spatial::{Rotation, Spatial, Vec3};
use crate::tree::{
    BASE, CHAIN, DEGREES, LIMB_FIRST, LIMB_JOINTS, LIMBS, POINTS, SHAPES, TRUNK, Tree,
};
use g1::collision::CAPSULES;
use g1::{BODIES, JOINTS, joints, links};

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
    /// Ends of the capsules from the root point, world axes, m, if parts meet.
    pub(crate) capsules: [[Vec3<L>; 2]; CAPSULES],
    /// The pelvis' left, world axes.
    pub(crate) left: Vec3<L>,
    /// Velocities of the bodies in the frame that moves with the root point.
    pub(crate) velocities: [Spatial<L>; BODIES],
    pelvis: Body<L>,
    torso: Body<L>,
    /// Bodies of the limb at work.
    bodies: [Body<L>; LIMB_JOINTS],
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
        Self {
            motions: [still; JOINTS],
            bias: [zero; DEGREES],
            trunk: [[zero; TRUNK]; TRUNK],
            limbs: [[[zero; CHAIN]; LIMB_JOINTS]; LIMBS],
            points: [none; POINTS],
            capsules: [[none; 2]; CAPSULES],
            left: none,
            velocities: [still; BODIES],
            pelvis: Body::new(zero),
            torso: Body::new(zero),
            bodies: [Body::new(zero); LIMB_JOINTS],
        }
    }

    /// Fills everything for the robots of a group.
    #[inline(always)]
    pub(crate) fn run(&mut self, token: L::Token, tree: &Tree<L::Scalar>, group: &Group<L>) {
        let get = |row: usize| group.state[row];
        let zero = L::splat(token, L::Scalar::default());
        let none = Vec3::new(zero, zero, zero);
        let q = row::QUATERNION;
        self.pelvis.frame = Frame {
            orientation: Rotation::of_quaternion(get(q), get(q + 1), get(q + 2), get(q + 3)),
            position: none,
        };
        self.left = self.pelvis.frame.orientation.y;
        self.pelvis.acceleration = Spatial {
            turn: none,
            shift: Vec3::new(group.own.lift[0], group.own.lift[1], group.own.lift[2]),
        };
        let w = row::ANGULAR;
        self.velocities[links::PELVIS] = Spatial {
            turn: Vec3::new(get(w), get(w + 1), get(w + 2)),
            shift: none,
        };
        let nominal = tree.inertials[links::PELVIS];
        self.pelvis.weigh(&self.velocities[links::PELVIS], |i| {
            L::splat(token, nominal[i])
        });
        let (frame, points) = (afresh(&self.pelvis.frame), &mut self.points);
        frame.place(token, tree, links::PELVIS, points);
        for limb in 0..2 {
            self.limb::<BASE, 6>(token, tree, group, limb);
            self.pelvis
                .carry(&self.bodies[0].inertia, self.bodies[0].force);
        }
        let joint = joints::WAIST;
        let parent = afresh(&self.pelvis.frame);
        let (frame, motion) = parent.across(
            token,
            &tree.hinges[joint],
            SHAPES[joint],
            get(row::JOINT + joint),
        );
        (self.torso.frame, self.motions[joint]) = (frame, motion);
        let speed = group.state[row::SPEED + joint];
        let turning = motion.scale(speed);
        let before = &self.velocities[links::PELVIS];
        self.torso.acceleration = before.cross_motion_add(turning, self.pelvis.acceleration);
        self.velocities[links::TORSO] = before.add(turning);
        self.torso
            .weigh(&self.velocities[links::TORSO], |i| group.torso[i]);
        let (frame, points) = (afresh(&self.torso.frame), &mut self.points);
        frame.place(token, tree, links::TORSO, points);
        if tree.collides {
            frame.span(token, &tree.capsules, links::TORSO, &mut self.capsules);
        }
        for limb in 2..LIMBS {
            self.limb::<TRUNK, 5>(token, tree, group, limb);
            self.torso
                .carry(&self.bodies[0].inertia, self.bodies[0].force);
        }
        let (waist, torso) = (self.motions[joint], afresh(&self.torso));
        let moved = torso.inertia.times(waist);
        self.bias[BASE + joint] = waist.dot(torso.force);
        let armature = L::splat(token, tree.hinges[joint].armature);
        self.trunk[BASE] = [
            moved.shift.x,
            moved.shift.y,
            moved.shift.z,
            moved.turn.x,
            moved.turn.y,
            moved.turn.z,
            waist.dot(moved) + armature,
        ];
        self.pelvis.carry(&self.torso.inertia, self.torso.force);
        self.base(zero);
    }

    /// The torso's centre of mass, from the root point, world axes, m.
    #[inline(always)]
    pub(crate) fn torso_centre(&self, group: &Group<L>) -> Vec3<L> {
        let [_, x, y, z, ..] = group.torso;
        let frame = &self.torso.frame;
        frame
            .orientation
            .turn_add(Vec3::new(x, y, z), frame.position)
    }

    /// The base's own part: total mass, first moment, inertia and load.
    #[inline(always)]
    fn base(&mut self, zero: L) {
        let (whole, force) = (&self.pelvis.inertia, &self.pelvis.force);
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

    /// A limb down and up; leaves what it weighs and how it loads its root in its first body.
    #[inline(always)]
    fn limb<const PREFIX: usize, const COUNT: usize>(
        &mut self,
        token: L::Token,
        tree: &Tree<L::Scalar>,
        group: &Group<L>,
        limb: usize,
    ) {
        let first = LIMB_FIRST[limb];
        let (trunk, root) = match PREFIX {
            BASE => (links::PELVIS, &self.pelvis),
            _ => (links::TORSO, &self.torso),
        };
        each!(K in [0 1 2 3 4 5] {
            if K < COUNT {
                let shape = SHAPES[if PREFIX == BASE { K } else { LIMB_FIRST[2] + K }];
                let parent = match K {
                    0 => *afresh(&root.frame),
                    _ => self.bodies[K - 1].frame,
                };
                let (frame, motion) = parent.across(token, &tree.hinges[first + K], shape, group.state[row::JOINT + first + K]);
                self.bodies[K].frame = frame;
                self.motions[first + K] = motion;
            }
        });
        // A loop that stays one: unrolled, all bodies' numbers were alive at once.
        for k in 0..COUNT {
            let (joint, body) = (first + k, first + k + 1);
            let turning = self.motions[joint].scale(group.state[row::SPEED + joint]);
            let (earlier, this) = self.bodies.split_at_mut(k);
            let (parent, acceleration) = match earlier.last() {
                None => (trunk, &root.acceleration),
                Some(parent) => (body - 1, &parent.acceleration),
            };
            let before = &self.velocities[parent];
            this[0].acceleration = before.cross_motion_add(turning, *acceleration);
            self.velocities[body] = before.add(turning);
            let numbers = &tree.inertials[body];
            this[0].weigh(&self.velocities[body], |i| L::splat(token, numbers[i]));
            this[0].frame.place(token, tree, body, &mut self.points);
        }
        if tree.collides {
            for (k, body) in self.bodies[..COUNT].iter().enumerate() {
                let frame = afresh(&body.frame);
                frame.span(token, &tree.capsules, first + k + 1, &mut self.capsules);
            }
        }
        each!(K in [5 4 3 2 1 0] {
            if K < COUNT {
                let (motion, body) = (self.motions[first + K], afresh(&self.bodies[K]));
                self.bias[BASE + first + K] = motion.dot(body.force);
                let moved = body.inertia.times(motion);
                let rows = &mut self.limbs[limb][K];
                rows[0] = moved.shift.x;
                rows[1] = moved.shift.y;
                rows[2] = moved.shift.z;
                rows[3] = moved.turn.x;
                rows[4] = moved.turn.y;
                rows[5] = moved.turn.z;
                let motions = afresh(&self.motions);
                if PREFIX == TRUNK {
                    rows[BASE] = motions[joints::WAIST].dot(moved);
                }
                each!(M in [0 1 2 3 4 5] {
                    if M <= K {
                        rows[PREFIX + M] = motions[first + M].dot(moved);
                    }
                });
                let armature = L::splat(token, tree.hinges[first + K].armature);
                rows[PREFIX + K] = rows[PREFIX + K] + armature;
                if K > 0 {
                    let (before, this) = self.bodies.split_at_mut(K);
                    let child = afresh(&this[0]);
                    before[K - 1].carry(&child.inertia, child.force);
                }
            }
        });
    }
}

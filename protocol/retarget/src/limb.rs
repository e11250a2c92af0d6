//! A limb as a chain of hinges, and the normal equations of what it shall do.
//!
//! Separate because legs and arms are solved alike, frame by frame and over whole clips: a residual r of
//! weight w adds w JᵀJ to the matrix, −w Jᵀr to the right side and w |r|² to the cost.

use g1::joints::{LEFT_ARM, LEFT_LEG, RIGHT_ARM, RIGHT_LEG};
use g1::{DEFAULT_POSE, JOINT_TABLE};
use nalgebra::{Isometry3, Point3, Quaternion, SMatrix, SVector, UnitQuaternion, Vector3};

/// First joints of legs and arms, by side.
pub(crate) const LEGS: [usize; 2] = [LEFT_LEG, RIGHT_LEG];
pub(crate) const ARMS: [usize; 2] = [LEFT_ARM, RIGHT_ARM];
/// Bodies of a limb between whose origins its bones run: thigh and shin, or upper arm and forearm.
pub(crate) const BONES: [(usize, usize); 2] = [(1, 3), (3, 4)];
/// The hip roll body, the knee and the ankle pitch body of a leg.
pub(crate) const HIP: usize = 1;
pub(crate) const KNEE: usize = 3;
pub(crate) const ANKLE: usize = 4;

/// Distance that is kept from a joint's limit, rad: `f32` rounds.
pub(crate) const MARGIN: f64 = 1e-4;
/// Least flexion of a knee, rad. Its stop is 5° beyond straight, where humans do not go and where
/// a leg has two ways to be of a length.
const STRAIGHT: f64 = 0.0;

/// `N` hinges in a row.
pub(crate) struct Chain<const N: usize> {
    /// Index of the first joint.
    pub(crate) first: usize,
    /// Frame of each joint in the body before it.
    links: [Isometry3<f64>; N],
    /// Lowest and highest positions that are used, rad.
    pub(crate) lower: SVector<f64, N>,
    pub(crate) upper: SVector<f64, N>,
    /// The default pose, rad.
    pub(crate) home: SVector<f64, N>,
}

/// Where the bodies of a limb are, in the world.
pub(crate) struct Pose<const N: usize> {
    bodies: [Isometry3<f64>; N],
    axes: [Vector3<f64>; N],
}

/// Normal equations of a limb in one frame.
#[derive(Clone, Copy)]
pub(crate) struct Normal<const N: usize> {
    pub(crate) matrix: SMatrix<f64, N, N>,
    pub(crate) right: SVector<f64, N>,
    pub(crate) cost: f64,
}

impl<const N: usize> Chain<N> {
    /// The limb whose first joint this is.
    pub(crate) fn new(first: usize) -> Self {
        let joint = |k: usize| &JOINT_TABLE[first + k];
        let mut lower = SVector::from_fn(|k, _| joint(k).lower + MARGIN);
        if LEGS.contains(&first) {
            lower[KNEE] = STRAIGHT;
        }
        Self {
            first,
            links: std::array::from_fn(|k| {
                let [roll, pitch, yaw] = joint(k).rpy;
                let turn = UnitQuaternion::from_euler_angles(roll, pitch, yaw);
                Isometry3::from_parts(Vector3::from(joint(k).origin).into(), turn)
            }),
            lower,
            upper: SVector::from_fn(|k, _| joint(k).upper - MARGIN),
            home: SVector::from_fn(|k, _| f64::from(DEFAULT_POSE[first + k])),
        }
    }

    /// Where the bodies are when the chain hangs on `parent`.
    pub(crate) fn pose(&self, parent: &Isometry3<f64>, q: &SVector<f64, N>) -> Pose<N> {
        let mut bodies = [*parent; N];
        let mut axes = [Vector3::zeros(); N];
        let mut before = *parent;
        for k in 0..N {
            let axis = Vector3::from(JOINT_TABLE[self.first + k].axis);
            let (sin, cos) = (0.5 * q[k]).sin_cos();
            let turn = Quaternion::from_parts(cos, axis * sin);
            before *= self.links[k];
            // The hinge's axis is fixed to the moved body too, since it turns about it.
            axes[k] = before.rotation * axis;
            before.rotation *= UnitQuaternion::new_unchecked(turn);
            bodies[k] = before;
        }
        Pose { bodies, axes }
    }

    /// The nearest position within bounds.
    pub(crate) fn clamped(&self, q: &SVector<f64, N>) -> SVector<f64, N> {
        SVector::from_fn(|k, _| q[k].clamp(self.lower[k], self.upper[k]))
    }

    /// Whether a joint is at a bound and pushed beyond it.
    pub(crate) fn held(&self, k: usize, q: f64, push: f64) -> bool {
        (q <= self.lower[k] && push < 0.0) || (q >= self.upper[k] && push > 0.0)
    }
}

impl<const N: usize> Pose<N> {
    /// Origin of a body, m.
    pub(crate) fn origin(&self, body: usize) -> Vector3<f64> {
        self.bodies[body].translation.vector
    }

    /// Frame of the last body.
    pub(crate) fn end(&self) -> Isometry3<f64> {
        self.bodies[N - 1]
    }

    /// How the origin of a body moves with the joints.
    fn jacobian(&self, body: usize) -> SMatrix<f64, 3, N> {
        let mut jacobian = SMatrix::<f64, 3, N>::zeros();
        for k in 0..=body {
            let arm = self.origin(body) - self.origin(k);
            jacobian.set_column(k, &self.axes[k].cross(&arm));
        }
        jacobian
    }
}

impl<const N: usize> Normal<N> {
    pub(crate) fn new() -> Self {
        Self {
            matrix: SMatrix::zeros(),
            right: SVector::zeros(),
            cost: 0.0,
        }
    }

    /// A residual (what is wanted less what is) whose parts weigh differently.
    fn add(&mut self, jacobian: &SMatrix<f64, 3, N>, error: &Vector3<f64>, weight: &Vector3<f64>) {
        for row in 0..3 {
            let (j, w) = (jacobian.row(row), weight[row]);
            for a in 0..N {
                self.right[a] += w * j[a] * error[row];
                for b in 0..=a {
                    self.matrix[(a, b)] += w * j[a] * j[b];
                }
            }
            self.cost += w * error[row] * error[row];
        }
    }

    /// Joints shall be near a position, rad.
    pub(crate) fn stay(&mut self, q: &SVector<f64, N>, near: &SVector<f64, N>, weight: f64) {
        for k in 0..N {
            let error = near[k] - q[k];
            self.matrix[(k, k)] += weight;
            self.right[k] += weight * error;
            self.cost += weight * error * error;
        }
    }

    /// A bone of the limb shall point in a direction.
    pub(crate) fn point(
        &mut self,
        pose: &Pose<N>,
        (from, to): (usize, usize),
        direction: &Vector3<f64>,
        weight: f64,
    ) {
        let bone = pose.origin(to) - pose.origin(from);
        let length = bone.norm();
        let now = bone / length;
        let moves = (pose.jacobian(to) - pose.jacobian(from)) / length;
        // Only what turns the bone: its length is not to be changed.
        let across = moves - now * (now.transpose() * moves);
        self.add(&across, &(direction - now), &Vector3::repeat(weight));
    }

    /// The end of the limb shall turn to an orientation.
    pub(crate) fn turn(&mut self, pose: &Pose<N>, to: &UnitQuaternion<f64>, weight: f64) {
        self.turn_about(
            pose,
            to,
            &UnitQuaternion::identity(),
            &Vector3::repeat(weight),
        );
    }

    /// The same with weights by axis of a frame.
    pub(crate) fn turn_about(
        &mut self,
        pose: &Pose<N>,
        to: &UnitQuaternion<f64>,
        frame: &UnitQuaternion<f64>,
        weight: &Vector3<f64>,
    ) {
        let into = frame.inverse().to_rotation_matrix();
        let jacobian = SMatrix::<f64, 3, N>::from_columns(&pose.axes);
        let error = (to * pose.end().rotation.inverse()).scaled_axis();
        self.add(&(into * jacobian), &(into * error), weight);
    }
}

impl Normal<6> {
    /// A point of a leg's foot, in the foot's frame, shall be at a place; weights by axis of the world.
    pub(crate) fn reach(
        &mut self,
        pose: &Pose<6>,
        point: &Vector3<f64>,
        to: &Vector3<f64>,
        weight: &Vector3<f64>,
    ) {
        let now = pose.end() * Point3::from(*point);
        let mut jacobian = SMatrix::<f64, 3, 6>::zeros();
        for k in 0..6 {
            jacobian.set_column(k, &pose.axes[k].cross(&(now.coords - pose.origin(k))));
        }
        self.add(&jacobian, &(to - now.coords), weight);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use g1::kinematics::forward;

    #[test]
    fn a_chain_is_where_the_whole_robot_has_it() {
        let base = Isometry3::from_parts(
            [1.0, 2.0, 0.75].into(),
            UnitQuaternion::from_euler_angles(0.05, 0.1, 0.7),
        );
        let q: [f64; g1::JOINTS] = std::array::from_fn(|i| 0.3 * (i as f64).sin());
        let bodies = forward(&base, &q);
        let torso = bodies[g1::joints::WAIST + 1];
        for first in LEGS {
            let pose = Chain::<6>::new(first).pose(&base, &SVector::from_fn(|k, _| q[first + k]));
            for k in 0..6 {
                assert!(
                    (pose.bodies[k].to_matrix() - bodies[first + 1 + k].to_matrix()).amax() < 1e-12
                );
            }
        }
        for first in ARMS {
            let pose = Chain::<5>::new(first).pose(&torso, &SVector::from_fn(|k, _| q[first + k]));
            for k in 0..5 {
                assert!(
                    (pose.bodies[k].to_matrix() - bodies[first + 1 + k].to_matrix()).amax() < 1e-12
                );
            }
        }
    }

    /// −2 J^T r is the cost's slope: against central differences.
    #[test]
    fn the_right_side_is_the_slope_of_the_cost() {
        let chain = Chain::<6>::new(LEGS[1]);
        let base = Isometry3::translation(0.0, 0.0, 0.7);
        let cost = |q: &SVector<f64, 6>| {
            let (pose, mut normal) = (chain.pose(&base, q), Normal::new());
            normal.point(&pose, BONES[0], &Vector3::new(0.6, 0.0, -0.8), 2.0);
            normal.point(&pose, BONES[1], &Vector3::new(0.0, 0.6, -0.8), 1.0);
            normal.reach(
                &pose,
                &Vector3::new(0.12, 0.0, -0.03),
                &Vector3::new(0.1, -0.1, 0.05),
                &Vector3::new(3.0, 4.0, 5.0),
            );
            normal.stay(q, &chain.home, 0.3);
            normal
        };
        let q = SVector::<f64, 6>::from([-0.4, -0.1, 0.2, 0.7, -0.3, 0.1]);
        for k in 0..6 {
            let step = |h: f64| cost(&(q + SVector::<f64, 6>::ith(k, h))).cost;
            let slope = (step(1e-6) - step(-1e-6)) / 2e-6;
            let right = cost(&q).right[k];
            assert!((slope + 2.0 * right).abs() < 1e-6, "{k}: {slope} {right}");
        }
    }
}

//! A stick figure whose walk is known, for tests.

use crate::capture::{Capture, Landmark, Landmarks, Side};
use nalgebra::{Point3, Vector3};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// Thigh and shin together of the plain walk, m.
pub(crate) const LEG: f64 = 0.84;
/// Its speed along x, m/s.
pub(crate) const SPEED: f64 = 1.1;
/// Its share of the stride that a foot stands.
pub(crate) const STANCE: f64 = 0.6;
const ANKLE_HEIGHT: f64 = 0.08;
const HEEL: f64 = 0.05;
const BALL: f64 = 0.13;

/// A walk along x that may turn or climb.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Walk {
    /// Frames per second, and how long, s.
    pub(crate) fps: f64,
    pub(crate) seconds: f64,
    /// m/s.
    pub(crate) speed: f64,
    /// Of a stride, s.
    pub(crate) period: f64,
    /// Share of the stride that a foot stands.
    pub(crate) stance: f64,
    /// Thigh and shin together, m, and the thigh's share of it.
    pub(crate) leg: f64,
    pub(crate) thigh: f64,
    /// Greatest distance from hip to ankle over a flat foot, as a share of the leg. At 1 the leg is
    /// straight where a step is longest; above 1 the capture's bones stretch.
    pub(crate) reach: f64,
    /// How much the hips rise over the standing leg, m.
    pub(crate) bob: f64,
    /// Pitch of the foot at heel strike (toe up) and at push-off (toe down), rad.
    pub(crate) strike: f64,
    pub(crate) push: f64,
    /// How high the ankle is lifted in swing, m.
    pub(crate) lift: f64,
    /// Turn to the left, 1/m of way, and rise, m/m of way.
    pub(crate) curvature: f64,
    pub(crate) slope: f64,
    /// Where in the stride it begins, 0 to 1, and by how much markers are wrong, m.
    pub(crate) phase: f64,
    pub(crate) noise: f64,
}

impl Walk {
    /// Bent knees, flat feet in stance.
    pub(crate) const PLAIN: Self = Self {
        fps: 120.0,
        seconds: 2.2,
        speed: SPEED,
        period: 1.1,
        stance: STANCE,
        leg: LEG,
        thigh: 0.5,
        reach: 0.96,
        bob: 0.0,
        strike: 0.0,
        push: 0.0,
        lift: 0.1,
        curvature: 0.0,
        slope: 0.0,
        phase: 0.0,
        noise: 0.0,
    };

    pub(crate) fn capture(&self) -> Capture {
        let count = (self.fps * self.seconds).round() as usize + 1;
        Capture {
            fps: self.fps,
            frames: (0..count).map(|i| self.frame(i)).collect(),
        }
    }

    fn frame(&self, i: usize) -> Landmarks {
        let time = i as f64 / self.fps;
        let half = 0.5 * self.speed * self.period * self.stance;
        let far = self.reach * self.leg;
        let height = ANKLE_HEIGHT
            + (far * far - half * half)
                .max(0.09 * self.leg * self.leg)
                .sqrt();
        let mut points = [Point3::origin(); crate::LANDMARKS];
        for side in Side::BOTH {
            let left = if side == Side::Left { 1.0 } else { -1.0 };
            let cycle = time / self.period + self.phase + 0.25 * (1.0 - left);
            // Highest in the middle of each stance.
            let bob = self.bob * (2.0 * TAU * (cycle - 0.5 * self.stance)).cos();
            let hip = Point3::new(self.speed * time, 0.1 * left, height + bob);
            // The foot's clock counts strides; the body's is ahead of it by this.
            let ahead = self.speed * (time - cycle * self.period);
            let (ankle, pitch) = self.foot(cycle);
            let ankle = ankle + Vector3::new(ahead, 0.1 * left, 0.0);
            let swing = 0.3 * (TAU * cycle).cos();
            let shoulder = Point3::new(hip.x, 0.2 * left, height + 0.5);
            let elbow = shoulder + 0.28 * Vector3::new((-swing).sin(), 0.1 * left, -swing.cos());
            let wrist = elbow + 0.25 * Vector3::new((0.4 - swing).sin(), 0.0, -(0.4 - swing).cos());
            let toe = ankle + pitched(pitch, BALL, -0.07);
            for (landmark, point) in Landmark::ALL.into_iter().zip([
                hip,
                self.knee(hip, ankle),
                ankle,
                toe,
                shoulder,
                elbow,
                wrist,
            ]) {
                let k = Landmarks::index(side, landmark);
                points[k] = self.warped(point) + self.wrong(i, k);
            }
        }
        Landmarks(points)
    }

    /// Ankle in the plane of the walk, where the hip passes 0 at cycle 0, and the pitch of the foot.
    fn foot(&self, cycle: f64) -> (Point3<f64>, f64) {
        let (stride, phase) = (self.speed * self.period, cycle.rem_euclid(1.0));
        // Half of stance is ahead of the hip, half behind.
        let planted = (cycle.floor() + 0.5 * self.stance) * stride;
        if phase < self.stance {
            return (
                self.standing(phase) + Vector3::x() * planted,
                self.pitch(phase),
            );
        }
        let u = (phase - self.stance) / (1.0 - self.stance);
        // From where the foot leaves to where it lands, with the speeds that it has there.
        let slope = |phase: f64| (self.standing(phase + 1e-4) - self.standing(phase - 1e-4)) / 2e-4;
        let [from, to] = [
            self.standing(self.stance).coords,
            self.standing(1.0).coords + Vector3::x() * stride,
        ];
        let [out, into] = [slope(self.stance), slope(1.0)].map(|s| s * (1.0 - self.stance));
        let (u2, u3) = (u * u, u * u * u);
        let ankle = from * (2.0 * u3 - 3.0 * u2 + 1.0)
            + out * (u3 - 2.0 * u2 + u)
            + to * (3.0 * u2 - 2.0 * u3)
            + into * (u3 - u2);
        let lift = Vector3::z() * (self.lift * (PI * u).sin().powi(2));
        let pitch = self.pitch(phase) + 0.4 * (PI * u).sin().powi(2);
        (Point3::from(ankle + lift + Vector3::x() * planted), pitch)
    }

    /// Ankle of a foot that rolls over heel and ball, against its place when flat.
    fn standing(&self, phase: f64) -> Point3<f64> {
        let pitch = self.pitch(phase);
        let edge = if pitch < 0.0 { -HEEL } else { BALL };
        let ankle = pitched(pitch, -edge, ANKLE_HEIGHT);
        Point3::new(edge, 0.0, 0.0) + ankle
    }

    /// Pitch of the foot without what swing adds, toe down positive, rad.
    fn pitch(&self, phase: f64) -> f64 {
        let bump = |at: f64, width: f64| {
            let x = (phase - at).abs().min(1.0 - (phase - at).abs().min(1.0)) / width;
            (FRAC_PI_2 * x.min(1.0)).cos().powi(2)
        };
        self.push * bump(self.stance, 0.2) - self.strike * bump(1.0, 0.12)
    }

    /// The knee of the leg, bent forward; the bones of a leg too far to reach stretch.
    fn knee(&self, hip: Point3<f64>, ankle: Point3<f64>) -> Point3<f64> {
        let line = ankle - hip;
        let (d, thigh, shin) = (
            line.norm(),
            self.leg * self.thigh,
            self.leg * (1.0 - self.thigh),
        );
        let along = 0.5 * (d * d + thigh * thigh - shin * shin) / d;
        let bend = (thigh * thigh - along * along).max(0.0).sqrt();
        let forward = Vector3::y().cross(&line).normalize();
        hip + line / d * along - forward * bend
    }

    /// Bends the straight, level way; what stands still in it still does.
    fn warped(&self, p: Point3<f64>) -> Point3<f64> {
        let z = p.z + self.slope * p.x;
        if self.curvature.abs() < 1e-9 {
            return Point3::new(p.x, p.y, z);
        }
        let (sin, cos) = (self.curvature * p.x).sin_cos();
        let r = 1.0 / self.curvature;
        Point3::new((r - p.y) * sin, r - (r - p.y) * cos, z)
    }

    /// How wrong a marker is in a frame: the same every time.
    fn wrong(&self, frame: usize, marker: usize) -> Vector3<f64> {
        Vector3::from_fn(|axis, _| {
            let seed = (frame * 131 + marker * 17 + axis * 7 + 1) as f64;
            self.noise * (2.0 * ((seed * 12.9898).sin() * 43_758.545_3).rem_euclid(1.0) - 1.0)
        })
    }
}

/// A vector along a foot and up from it, pitched (toe down positive).
fn pitched(pitch: f64, along: f64, up: f64) -> Vector3<f64> {
    let (sin, cos) = pitch.sin_cos();
    Vector3::new(along * cos + up * sin, 0.0, up * cos - along * sin)
}

/// The plain walk.
pub(crate) fn walking(fps: f64, seconds: f64) -> Capture {
    Walk {
        fps,
        seconds,
        ..Walk::PLAIN
    }
    .capture()
}

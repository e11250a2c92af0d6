//! What a human did: fourteen joint centres over time.
//!
//! Separate because every format of human motion ends here; bones, rotations and the names of
//! skeletons are gone. Only directions between centres and the length of the legs matter after this.

use crate::RATE;
use crate::signal;
use nalgebra::Point3;

/// A side of the body.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// Left.
    Left,
    /// Right.
    Right,
}

impl Side {
    /// Both sides, left first.
    pub const BOTH: [Self; 2] = [Self::Left, Self::Right];

    /// 0 for left, 1 for right.
    pub fn index(self) -> usize {
        usize::from(self == Self::Right)
    }
}

/// A joint centre of one side.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Landmark {
    /// Between pelvis and thigh.
    Hip,
    /// Between thigh and shin.
    Knee,
    /// Between shin and foot.
    Ankle,
    /// The ball of the foot, or any point ahead of the ankle that turns with the foot.
    Toe,
    /// Between trunk and upper arm.
    Shoulder,
    /// Between upper arm and forearm.
    Elbow,
    /// Between forearm and hand.
    Wrist,
}

impl Landmark {
    /// The seven of a side, in the order in which [`Landmarks`] holds them.
    pub const ALL: [Self; 7] = [
        Self::Hip,
        Self::Knee,
        Self::Ankle,
        Self::Toe,
        Self::Shoulder,
        Self::Elbow,
        Self::Wrist,
    ];

    /// The name that errors use.
    pub fn name(self) -> &'static str {
        match self {
            Self::Hip => "hip",
            Self::Knee => "knee",
            Self::Ankle => "ankle",
            Self::Toe => "toe",
            Self::Shoulder => "shoulder",
            Self::Elbow => "elbow",
            Self::Wrist => "wrist",
        }
    }
}

/// Joint centres of one frame.
pub const LANDMARKS: usize = 14;

/// The joint centres of one frame in the world, m, z up: seven of the left side, then seven of the
/// right, each in the order of [`Landmark::ALL`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Landmarks(pub [Point3<f64>; LANDMARKS]);

impl Landmarks {
    /// One joint centre.
    pub fn of(&self, side: Side, landmark: Landmark) -> Point3<f64> {
        self.0[Self::index(side, landmark)]
    }

    /// Where a joint centre stands in the array.
    pub fn index(side: Side, landmark: Landmark) -> usize {
        side.index() * Landmark::ALL.len() + landmark as usize
    }

    /// Half way between a joint centre and its fellow of the other side.
    pub fn middle(&self, landmark: Landmark) -> Point3<f64> {
        nalgebra::center(
            &self.of(Side::Left, landmark),
            &self.of(Side::Right, landmark),
        )
    }
}

/// A recorded human motion.
#[derive(Clone, Debug, PartialEq)]
pub struct Capture {
    /// Frames per second.
    pub fps: f64,
    /// The frames.
    pub frames: Vec<Landmarks>,
}

impl Capture {
    /// Length of thigh and shin together, m: the median over frames, mean of both sides.
    pub fn leg_length(&self) -> f64 {
        let mut lengths: Vec<f64> = self.frames.iter().map(leg_length).collect();
        signal::median(&mut lengths)
    }

    /// Mean speed of the middle of the hips over the ground from first to last frame, m/s, along
    /// the straight way.
    pub fn travel_speed(&self) -> f64 {
        let (Some(first), Some(last)) = (self.frames.first(), self.frames.last()) else {
            return 0.0;
        };
        let way = (last.middle(Landmark::Hip) - first.middle(Landmark::Hip)).xy();
        way.norm() * self.fps / (self.frames.len() as f64 - 1.0).max(1.0)
    }

    /// The same motion at [`RATE`]: a cubic spline through the centres, after a low pass of 10 ms
    /// where the capture is fast enough to have more than the robot can follow.
    pub fn at_rate(&self) -> Self {
        const SMOOTHING_SECONDS: f64 = 0.010;
        let count = signal::resampled_length(self.frames.len(), self.fps);
        let mut frames = vec![Landmarks([Point3::origin(); LANDMARKS]); count];
        for landmark in 0..LANDMARKS {
            for axis in 0..3 {
                let series: Vec<f64> = self.frames.iter().map(|f| f.0[landmark][axis]).collect();
                let smooth = signal::gaussian(&series, SMOOTHING_SECONDS * self.fps);
                let resampled = signal::resample(&smooth, self.fps, count);
                for (frame, value) in frames.iter_mut().zip(resampled) {
                    frame.0[landmark][axis] = value;
                }
            }
        }
        Self { fps: RATE, frames }
    }
}

fn leg_length(frame: &Landmarks) -> f64 {
    let length = |side| {
        let [hip, knee, ankle] =
            [Landmark::Hip, Landmark::Knee, Landmark::Ankle].map(|l| frame.of(side, l));
        (knee - hip).norm() + (ankle - knee).norm()
    };
    Side::BOTH.map(length).iter().sum::<f64>() / 2.0
}

#[cfg(test)]
mod tests {
    use crate::puppet;

    #[test]
    fn a_leg_is_as_long_as_its_bones() {
        let capture = puppet::walking(120.0, 1.0);
        assert!((capture.leg_length() - puppet::LEG).abs() < 1e-9);
        assert!((capture.travel_speed() - puppet::SPEED).abs() < 1e-9);
    }

    #[test]
    fn any_rate_becomes_50_hertz_with_the_same_motion() {
        let exact = puppet::walking(50.0, 1.0);
        for fps in [60.0, 100.0, 120.0, 240.0] {
            let resampled = puppet::walking(fps, 1.0).at_rate();
            assert_eq!(resampled.frames.len(), 51, "{fps}");
            // The low pass at the ends has nothing to see beyond them.
            for (a, b) in resampled.frames.iter().zip(&exact.frames).skip(5).take(41) {
                for (p, q) in a.0.iter().zip(&b.0) {
                    assert!((p - q).norm() < 4e-3, "{fps}: {p} is not {q}");
                }
            }
        }
    }
}

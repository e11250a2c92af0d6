//! Normative human walking at any speed, as figures.
//!
//! Separate because it is a table of a source: Schwartz, Rozumalski and Trost, "The effect of
//! walking speed on the gait of typically developing children", Journal of Biomechanics 41 (2008)
//! 1639–1650, electronic addendum: mean joint rotations of five speed groups. Each curve was fitted
//! with eight harmonics, and each coefficient with a quadratic in the dimensionless speed, which
//! leaves at most 1.7° at the hip, 2.9° at the knee and 1.5° at the ankle.
//!
//! Signs: flexion, dorsiflexion, anterior tilt, up and forward are positive, in degrees; phase 0 is
//! the contact of the foot on the curve's side.

use super::harmonics::{Harmonics, ORDER};

/// Acceleration of gravity, m/s².
pub(super) const GRAVITY: f64 = 9.81;
/// The G1's leg from hip joint to floor, m.
pub(super) const LEG: f64 = 0.69;

/// Dimensionless speed v* = v/√(g·L).
pub(super) fn dimensionless(speed: f64) -> f64 {
    speed / (GRAVITY * LEG).sqrt()
}

/// Duration of a walking stride (two steps) on the G1, s.
///
/// cadence* = −0.316 v*² + 1.071 v* + 0.165, in steps per √(L/g).
pub(super) fn walking_period(speed: f64) -> f64 {
    let v = dimensionless(speed);
    stride_period(-0.3162061 * v * v + 1.0705180 * v + 0.1651460)
}

/// Duration of a running stride on the G1, s.
///
/// The line through the fastest walk (v* = 0.694, cadence* = 0.756), where a walk turns into a run,
/// and a human run at 2.73 m/s with 0.693 s per stride (BMClab, github.com/BMClab/BMC, CC BY 4.0;
/// leg taken as 0.9 m: v* = 0.918, cadence* = 0.874).
pub(super) fn running_period(speed: f64) -> f64 {
    let v = dimensionless(speed);
    stride_period(0.756 + (v - 0.694) * (0.874 - 0.756) / (0.918 - 0.694))
}

fn stride_period(cadence: f64) -> f64 {
    2.0 / cadence * (LEG / GRAVITY).sqrt()
}

/// Share of the stride that a foot is on the ground when walking.
///
/// 68, 62, 59, 58 and 56 % at five dimensionless speeds; linear between, held outside.
pub(super) fn stance_share(speed: f64) -> f64 {
    const SPEED: [f64; 5] = [0.172, 0.290, 0.429, 0.560, 0.694];
    const SHARE: [f64; 5] = [0.68, 0.62, 0.59, 0.58, 0.56];
    let v = dimensionless(speed).clamp(SPEED[0], SPEED[4]);
    let i = (1..4).find(|&i| v <= SPEED[i]).unwrap_or(4);
    let u = (v - SPEED[i - 1]) / (SPEED[i] - SPEED[i - 1]);
    SHARE[i - 1] + u * (SHARE[i] - SHARE[i - 1])
}

/// A joint curve over walking speed: each coefficient is square·v*² + linear·v* + constant,
/// in the order mean, cos 1–8, sin 1–8, in degrees.
pub(super) struct SpeedCurve {
    square: [f64; 1 + 2 * ORDER],
    linear: [f64; 1 + 2 * ORDER],
    constant: [f64; 1 + 2 * ORDER],
}

impl SpeedCurve {
    /// The curve at a speed of the G1 (m/s), in radians.
    pub(super) fn at_speed(&self, speed: f64) -> Harmonics {
        let v = dimensionless(speed);
        let coefficient = |i: usize| {
            (self.square[i] * v * v + self.linear[i] * v + self.constant[i]).to_radians()
        };
        Harmonics {
            mean: coefficient(0),
            cos: std::array::from_fn(|k| coefficient(1 + k)),
            sin: std::array::from_fn(|k| coefficient(1 + ORDER + k)),
        }
    }
}

/// Hip flexion.
pub(super) const HIP_FLEXION: SpeedCurve = SpeedCurve {
    square: [
        16.3754, -16.5612, 15.6314, -5.3204, -0.3072, 1.6517, -0.2561, 0.5287, -0.3272, 2.7011,
        -10.1096, -11.0104, 1.0539, -2.7728, -0.9493, -0.1067, -0.49,
    ],
    linear: [
        -2.7912, 36.8143, -21.2176, 4.821, -0.2541, -1.4616, 0.0805, -0.4521, 0.2775, -8.7277,
        12.4368, 10.9954, -0.8189, 2.4884, 0.6762, 0.0931, 0.4102,
    ],
    constant: [
        16.8816, 8.2579, 2.9636, -1.1235, 0.1091, 0.0517, 0.0076, 0.0442, -0.0588, -0.1527, -5.022,
        -1.0014, 0.0216, -0.31, -0.0402, -0.0376, -0.0709,
    ],
};

/// Knee flexion.
pub(super) const KNEE_FLEXION: SpeedCurve = SpeedCurve {
    square: [
        -44.863, 35.4355, 30.6014, -11.5465, 3.9018, 4.0446, -1.0148, 0.578, -0.136, 2.6268,
        -43.7833, -11.6837, -0.092, -4.8925, -1.8091, -0.1038, -0.5053,
    ],
    linear: [
        53.464, -26.3403, -34.5406, 10.689, -6.3788, -3.6647, 0.7847, -0.6806, 0.2146, -12.3739,
        55.6141, 9.6829, -0.3237, 4.4984, 0.9063, -0.1264, 0.3569,
    ],
    constant: [
        8.2911, 2.6582, -4.4904, -2.862, 1.2287, 0.2663, -0.0694, 0.1444, -0.0197, -13.9348,
        -8.4432, 2.4587, 0.6471, -0.306, 0.1308, 0.0765, -0.0332,
    ],
};

/// Ankle dorsiflexion.
pub(super) const ANKLE_DORSIFLEXION: SpeedCurve = SpeedCurve {
    square: [
        7.2857, 5.3456, -21.6895, 26.192, -23.9651, 5.9415, 0.8617, -5.7628, 3.2631, -44.6392,
        25.2569, -12.4527, -6.475, 16.1791, -8.5203, 4.7672, 0.4198,
    ],
    linear: [
        -14.4104, 12.4108, 8.5491, -22.8521, 23.3223, -7.994, 0.7181, 4.3636, -2.8347, 49.1528,
        -29.7048, 17.7803, 0.5698, -13.6018, 7.4905, -4.9529, 0.1882,
    ],
    constant: [
        5.5577, -8.5864, 1.0618, 0.3208, -3.3496, 1.8715, -0.2437, -0.2955, 0.5726, -6.0938,
        0.8775, -4.4052, 1.2231, 1.4352, -1.1612, 0.7888, -0.2258,
    ],
};

/// Anterior pelvic tilt.
pub(super) const PELVIC_TILT: SpeedCurve = SpeedCurve {
    square: [
        39.2557, -0.9007, -7.2208, -0.0481, -0.2812, -0.0211, 0.6299, 0.0424, -0.1176, -0.0587,
        1.7658, 0.0436, 1.2092, 0.0219, -0.235, 0.0713, -0.1064,
    ],
    linear: [
        -24.8388, 0.6615, 5.9501, -0.0109, 0.8423, -0.0112, -0.6069, -0.0372, 0.0357, 0.0903,
        -5.2268, -0.0649, -0.8835, -0.0069, 0.2471, -0.0612, 0.1034,
    ],
    constant: [
        15.0429, -0.1089, -0.8293, 0.0139, -0.1543, 0.0072, 0.0969, 0.0051, -0.0092, -0.0161,
        1.1747, 0.0099, 0.1145, 0.0017, -0.0097, 0.0132, -0.008,
    ],
};

/// Pelvic obliquity, the side of the curve up.
pub(super) const PELVIC_OBLIQUITY: SpeedCurve = SpeedCurve {
    square: [
        -1.3127, 5.4069, -0.2443, 5.7725, -0.2274, 0.5421, -0.1049, -0.2312, -0.0566, 4.1123,
        -0.5121, -6.1766, -0.2781, 0.569, 0.0069, -0.1254, 0.0285,
    ],
    linear: [
        1.1306, -2.7472, 0.1129, -6.0866, 0.2592, -0.1054, 0.0973, 0.3985, 0.0641, 3.6424, 0.3483,
        4.682, 0.234, -0.756, 0.0018, 0.1445, -0.0119,
    ],
    constant: [
        -0.1696, 2.1303, -0.002, 0.3422, -0.0664, -0.0651, -0.0217, -0.1133, -0.0156, -0.1437,
        -0.0443, -0.6625, -0.0456, 0.118, -0.0048, -0.0538, -0.0028,
    ],
};

/// Pelvic rotation, the side of the curve forward.
pub(super) const PELVIC_ROTATION: SpeedCurve = SpeedCurve {
    square: [
        -2.0929, 9.3767, -0.4522, 3.0392, -0.145, -1.6787, 0.0203, -0.2266, 0.0969, 6.1926, 0.0031,
        3.741, 0.1008, 1.6179, 0.0937, -0.1685, -0.0182,
    ],
    linear: [
        1.1563, 1.6794, 0.3881, -1.4576, 0.1021, 1.3648, -0.0687, 0.14, -0.1124, -10.0875, -0.0823,
        -4.7615, -0.0481, -1.5726, -0.0696, 0.1236, 0.0071,
    ],
    constant: [
        -0.0918, 1.3759, -0.0561, 0.4576, -0.0104, -0.0238, 0.0308, 0.0184, 0.0299, 5.3249, 0.0238,
        0.959, 0.0039, 0.2994, 0.0142, 0.0398, 0.0057,
    ],
};

/// Trunk rotation, the side of the curve forward.
pub(super) const TRUNK_ROTATION: SpeedCurve = SpeedCurve {
    square: [
        0.5682, -5.1733, 0.5128, -1.1466, 0.2146, 0.8777, -0.0445, 0.1648, -0.1438, 0.8974, 0.1445,
        0.029, -0.1443, -1.3285, 0.085, 0.1381, 0.1021,
    ],
    linear: [
        -0.6335, -7.9395, -0.4955, -0.9338, -0.1772, -0.4856, 0.0567, 0.0493, 0.1465, 3.603,
        -0.1672, 0.9687, 0.075, 0.9586, -0.1165, -0.0784, -0.0959,
    ],
    constant: [
        0.127, 0.4075, 0.0951, 0.0621, 0.0308, -0.0709, -0.0187, -0.1038, -0.036, -1.1843, 0.0383,
        -0.2356, -0.005, -0.0547, 0.0288, -0.031, 0.0147,
    ],
};

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn free_walking_is_that_of_the_table() {
        // Group "Free": v* = 0.429, which on the G1 is 0.429·√(9.81·0.69) = 1.117 m/s.
        let speed = 1.117;
        assert!((dimensionless(speed) - 0.4294).abs() < 1e-4);
        // cadence* = −0.3162·0.1844 + 1.0705·0.4294 + 0.1651 = 0.5665; 2/0.5665·√(0.69/9.81) = 0.936.
        assert!((walking_period(speed) - 0.936).abs() < 1e-3);
        assert!((stance_share(speed) - 0.59).abs() < 1e-3);
        // Published means of the group: hip 36° at contact, knee 5.5° at contact and about 59° in swing.
        assert!((HIP_FLEXION.at_speed(speed).at(0.0).to_degrees() - 36.0).abs() < 1.0);
        assert!((KNEE_FLEXION.at_speed(speed).at(0.0).to_degrees() - 5.5).abs() < 1.0);
        let swing = KNEE_FLEXION.at_speed(speed).at(0.72).to_degrees();
        assert!((swing - 59.5).abs() < 1.5, "{swing}");
    }

    #[test]
    fn running_begins_where_walking_ends() {
        let speed = 0.694 * (GRAVITY * LEG).sqrt();
        assert!((running_period(speed) / walking_period(speed) - 1.0).abs() < 0.01);
    }
}

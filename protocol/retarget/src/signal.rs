//! Series of numbers over time: smoothing, resampling, filling gaps.
//!
//! Separate because captures, robot clips and corrections of feet all pass here.

use crate::RATE;

/// The series smoothed by a Gaussian of `sigma` samples.
///
/// The ends are continued by point reflection, which keeps a straight line straight.
pub fn gaussian(series: &[f64], sigma: f64) -> Vec<f64> {
    let n = series.len();
    // Below a third of a sample the kernel is 1 and nothing else to a percent.
    if n < 2 || sigma < 0.33 {
        return series.to_vec();
    }
    let reach = (3.0 * sigma).ceil() as usize;
    let kernel: Vec<f64> = (0..=reach)
        .map(|k| (-0.5 * (k as f64 / sigma).powi(2)).exp())
        .collect();
    let total = kernel[0] + 2.0 * kernel[1..].iter().sum::<f64>();
    let at = |i: isize| {
        let last = n as isize - 1;
        if i < 0 {
            2.0 * series[0] - series[(-i).min(last) as usize]
        } else if i > last {
            2.0 * series[n - 1] - series[(2 * last - i).max(0) as usize]
        } else {
            series[i as usize]
        }
    };
    (0..n as isize)
        .map(|i| {
            let sides = |k: usize| kernel[k] * (at(i - k as isize) + at(i + k as isize));
            (kernel[0] * series[i as usize] + (1..=reach).map(sides).sum::<f64>()) / total
        })
        .collect()
}

/// How many frames at [`RATE`] fit into `frames` frames at `fps`.
pub fn resampled_length(frames: usize, fps: f64) -> usize {
    match frames.checked_sub(1) {
        // A hair of tolerance: 3 frames at 50 fps last 0.04 s, which must give 3 frames.
        Some(last) => (last as f64 / fps * RATE + 1e-6).floor() as usize + 1,
        None => 0,
    }
}

/// `count` values at [`RATE`] of the natural cubic spline through a series at `fps`.
///
/// A spline and not straight lines: between the lines of a 30 Hz file velocities would be steps.
pub fn resample(series: &[f64], fps: f64, count: usize) -> Vec<f64> {
    let curvature = natural_spline(series);
    let last = series.len().saturating_sub(1);
    (0..count)
        .map(|k| {
            let at = k as f64 / RATE * fps;
            let i = (at.floor() as usize).min(last.saturating_sub(1));
            let j = (i + 1).min(last);
            let u = (at - i as f64).clamp(0.0, 1.0);
            let v = 1.0 - u;
            v * series[i]
                + u * series[j]
                + (v * (v * v - 1.0) * curvature[i] + u * (u * u - 1.0) * curvature[j]) / 6.0
        })
        .collect()
}

/// Second derivatives of the natural cubic spline through samples one unit apart.
fn natural_spline(series: &[f64]) -> Vec<f64> {
    let n = series.len();
    let mut curvature = vec![0.0; n];
    if n < 3 {
        return curvature;
    }
    // Tridiagonal system m₋ + 4 m + m₊ = 6 (y₋ − 2 y + y₊), solved by elimination.
    let mut factor = vec![0.0; n];
    for i in 1..n - 1 {
        let right = 6.0 * (series[i - 1] - 2.0 * series[i] + series[i + 1]);
        let pivot = 4.0 - factor[i - 1];
        factor[i] = 1.0 / pivot;
        curvature[i] = (right - curvature[i - 1]) / pivot;
    }
    for i in (1..n - 1).rev() {
        curvature[i] -= factor[i] * curvature[i + 1];
    }
    curvature
}

/// Angles without jumps of whole turns.
pub fn unwrap(angles: &mut [f64]) {
    use std::f64::consts::TAU;
    for i in 1..angles.len() {
        let jump = angles[i] - angles[i - 1];
        angles[i] -= TAU * (jump / TAU).round();
    }
}

/// The gaps of a series filled by straight lines, its ends held; all `otherwise` if it is empty.
pub fn filled(series: &[Option<f64>], otherwise: f64) -> Vec<f64> {
    let known: Vec<(usize, f64)> = series
        .iter()
        .enumerate()
        .filter_map(|(i, value)| value.map(|value| (i, value)))
        .collect();
    (0..series.len())
        .map(|i| {
            let after = known.partition_point(|&(k, _)| k < i);
            match (after.checked_sub(1).map(|b| known[b]), known.get(after)) {
                (Some((a, x)), Some(&(b, y))) => x + (y - x) * (i - a) as f64 / (b - a) as f64,
                (Some((_, x)), None) => x,
                (None, Some(&(_, y))) => y,
                (None, None) => otherwise,
            }
        })
        .collect()
}

/// A smooth curve that is nowhere below a series of needs (≥ 0): the greatest need within `reach`
/// frames, averaged over as many. Each averaged maximum sees the frame's own need.
pub fn envelope(needs: &[f64], reach: usize) -> Vec<f64> {
    let window = |i: usize| i.saturating_sub(reach)..(i + reach + 1).min(needs.len());
    let greatest: Vec<f64> = (0..needs.len())
        .map(|i| needs[window(i)].iter().copied().fold(0.0, f64::max))
        .collect();
    (0..needs.len())
        .map(|i| {
            let around = window(i);
            let count = around.len() as f64;
            greatest[around].iter().sum::<f64>() / count
        })
        .collect()
}

/// The middle value (of the upper two, the upper); 0 of nothing. Sorts its argument.
pub fn median(values: &mut [f64]) -> f64 {
    quantile(values, 0.5)
}

/// The value below which a share of the others lies; 0 of nothing. Sorts its argument.
pub fn quantile(values: &mut [f64], share: f64) -> f64 {
    if values.is_empty() {
        return 0.0;
    }
    values.sort_by(f64::total_cmp);
    let at = (share * values.len() as f64) as usize;
    values[at.min(values.len() - 1)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_spline_passes_through_its_samples_and_follows_a_line_and_a_sine() {
        let line: Vec<f64> = (0..4).map(|i| 2.0 * f64::from(i)).collect();
        // 4 samples at 25 fps are 0.12 s: 7 frames at 50 Hz, each 1.0 further on.
        let fine = resample(&line, 25.0, resampled_length(4, 25.0));
        assert_eq!(fine, [0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0]);
        let sine = |t: f64| (std::f64::consts::TAU * t).sin();
        let coarse: Vec<f64> = (0..=30).map(|i| sine(f64::from(i) / 30.0)).collect();
        for (k, value) in resample(&coarse, 30.0, 51).iter().enumerate() {
            assert!((value - sine(k as f64 / 50.0)).abs() < 5e-4, "{k}");
        }
    }

    #[test]
    fn smoothing_keeps_a_line_and_averages_noise() {
        let line: Vec<f64> = (0..20).map(f64::from).collect();
        for (a, b) in gaussian(&line, 2.0).iter().zip(&line) {
            assert!((a - b).abs() < 1e-9);
        }
        let noise: Vec<f64> = (0..20).map(|i| f64::from(i % 2)).collect();
        // Far from the ends alternating 0 and 1 become one half.
        assert!((gaussian(&noise, 2.0)[10] - 0.5).abs() < 1e-3);
        assert_eq!(gaussian(&[1.0], 3.0), [1.0]);
    }

    #[test]
    fn gaps_are_filled_and_ends_held() {
        let series = [None, Some(1.0), None, Some(3.0), None];
        assert_eq!(filled(&series, 9.0), [1.0, 1.0, 2.0, 3.0, 3.0]);
        assert_eq!(filled(&[None, None], 9.0), [9.0, 9.0]);
    }

    #[test]
    fn an_envelope_covers_every_need() {
        let mut needs = [0.0; 20];
        needs[10] = 1.0;
        let cover = envelope(&needs, 2);
        assert_eq!(cover[10], 1.0);
        assert!(cover[8] > 0.0 && cover[5] == 0.0);
    }

    #[test]
    fn turns_are_counted() {
        let mut angles = [3.0, -3.0, 3.0];
        unwrap(&mut angles);
        assert!((angles[1] - (std::f64::consts::TAU - 3.0)).abs() < 1e-12);
        assert_eq!(angles[2], 3.0);
        assert_eq!(quantile(&mut [3.0, 1.0, 2.0, 4.0], 0.25), 2.0);
    }
}

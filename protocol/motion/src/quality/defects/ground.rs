//! Soles and the ground: flight, drift, sinking, sliding.
//!
//! Separate because all of it is heights and ways of soles; the ground is flat, at 0.

use super::super::defect::{Defect, Frames, Kind, Severity};
use super::super::{Feet, Quality};
use crate::clip::FRAME_SECONDS;

/// A sole this high is off the ground, m: captures of standing feet hover by up to 2 cm.
const OFF: f64 = 0.03;
/// Longest flight of a jump, s: t = √(8h/g) for a rise of the centre of mass by h = 1 m, more than a good jumper's.
const JUMP: f64 = 0.9;
/// Longest piece of motion that is looked at for its lowest sole, s: longer than any flight.
const PIECE: f64 = 1.0;
/// Rises and falls of the lowest sole from piece to piece, m: floors of studios are level to a centimetre.
pub(super) const SOLES: Unevenness = Unevenness {
    odd: 0.02,
    unfit: 0.05,
};
/// The same of a human's standing toes before they are put on the ground. A toe is a point of a fitted skeleton above a
/// sole that is not in the file: in sound captures of level floors (CMU 02_01 and 02_03) it varies by 4 and 3 cm.
pub(super) const TOES: Unevenness = Unevenness {
    odd: 0.05,
    unfit: 0.1,
};

/// Heights above which ground is uneven, m.
#[derive(Clone, Copy)]
pub(super) struct Unevenness {
    odd: f64,
    unfit: f64,
}
/// Lowest tenth of the lower sole, m, above which a short clip does not touch the ground.
const FLOATS: f64 = 0.05;
/// Sinking, m, that physics pushes out, and that it turns into a kick.
const SINKS: f64 = 0.005;
const BURIED: f64 = 0.03;
/// Sliding of standing feet, m/s: seen by the eye, and as fast as a slow walk itself.
const SLIPS: f64 = 0.10;
const SLIDES: f64 = 0.5;

pub(super) fn of(feet: &[Feet], quality: &Quality) -> Vec<Defect> {
    let lower: Vec<f64> = feet
        .iter()
        .map(|f| f64::from(f.low[0].min(f.low[1])))
        .collect();
    let flight = flight(&lower);
    let float = if flight.is_none() {
        float(&lower, quality)
    } else {
        None
    };
    let rest = [
        flight,
        drift(&lower),
        float,
        penetration(&lower),
        slip(quality),
    ];
    rest.into_iter().flatten().collect()
}

/// The longest time that both feet are off the ground, if that is longer than any jump.
fn flight(lower: &[f64]) -> Option<Defect> {
    let frames: Vec<usize> = (0..lower.len()).filter(|&i| lower[i] > OFF).collect();
    let longest = frames
        .chunk_by(|a, b| b - a == 1)
        .max_by_key(|run| run.len())?;
    let seconds = longest.len() as f64 * FRAME_SECONDS;
    if seconds <= JUMP {
        return None;
    }
    let bad: Vec<(usize, f64)> = longest.iter().map(|&i| (i, lower[i])).collect();
    let frames = Frames::of(&bad)?;
    let says = format!(
        "both feet are off the ground for {seconds:.2} s, up to {:.0} cm: longer than any jump",
        100.0 * lower[frames.worst - 1]
    );
    let value = (seconds, "s");
    Some(Defect::new(
        Kind::Flight,
        Severity::Unfit,
        frames,
        value,
        &says,
    ))
}

/// A floor that rises or sinks: the lowest sole of a second differs from that of another.
fn drift(lower: &[f64]) -> Option<Defect> {
    let piece = (PIECE / FRAME_SECONDS).round() as usize;
    let floors: Vec<(usize, f64)> = lower
        .windows(piece)
        .enumerate()
        .map(|(i, piece)| {
            let (at, low) = (0..piece.len())
                .map(|k| (k, piece[k]))
                .min_by(|a, b| a.1.total_cmp(&b.1))
                .expect("a piece has frames");
            (i + at, low)
        })
        .collect();
    let high = floors.iter().max_by(|a, b| a.1.total_cmp(&b.1))?;
    let low = floors.iter().min_by(|a, b| a.1.total_cmp(&b.1))?;
    uneven(SOLES, high.1 - low.1, (low.0, high.0), "the floor")
}

/// Ground that is `by` m higher in frame `high` than in frame `low`, counted from 0.
pub(super) fn uneven(
    limits: Unevenness,
    by: f64,
    (low, high): (usize, usize),
    what: &str,
) -> Option<Defect> {
    if by <= limits.odd {
        return None;
    }
    let (first, last) = (high.min(low), high.max(low));
    let frames = Frames {
        first: first + 1,
        last: last + 1,
        worst: high + 1,
        count: last - first + 1,
    };
    let severity = if by > limits.unfit {
        Severity::Unfit
    } else {
        Severity::Odd
    };
    let way = if high > low { "rises" } else { "sinks" };
    let says = format!("{what} {way} by {:.0} cm", 100.0 * by);
    Some(Defect::new(Kind::Drift, severity, frames, (by, "m"), &says))
}

fn float(lower: &[f64], quality: &Quality) -> Option<Defect> {
    let by = quality.float;
    (by > FLOATS).then(|| {
        let says = format!("floats {:.0} cm above the ground", 100.0 * by);
        Defect::throughout(Kind::Float, Severity::Unfit, lower.len(), (by, "m"), says)
    })
}

fn penetration(lower: &[f64]) -> Option<Defect> {
    let bad: Vec<(usize, f64)> = (0..lower.len())
        .filter(|&i| -lower[i] > SINKS)
        .map(|i| (i, -lower[i]))
        .collect();
    let frames = Frames::of(&bad)?;
    let by = -lower[frames.worst - 1];
    let severity = if by > BURIED {
        Severity::Unfit
    } else {
        Severity::Odd
    };
    let says = format!("soles are up to {:.1} cm below the ground", 100.0 * by);
    let value = (by, "m");
    Some(Defect::new(
        Kind::Penetration,
        severity,
        frames,
        value,
        &says,
    ))
}

fn slip(quality: &Quality) -> Option<Defect> {
    let by = quality.slip;
    (by > SLIPS).then(|| {
        let severity = if by > SLIDES {
            Severity::Unfit
        } else {
            Severity::Odd
        };
        let says = format!("standing feet slip at {by:.2} m/s (median)");
        Defect::throughout(Kind::Slip, severity, quality.frames, (by, "m/s"), says)
    })
}

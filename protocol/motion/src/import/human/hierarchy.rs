//! Which joint of a skeleton is which of ours, by how they hang together, where names do not tell.
//!
//! Separate because it looks at nothing but parents and places: a human's skeleton has four long limbs, two
//! below the trunk and two above, and the two longest bones in a row of each are what we look for.

use super::names::Names;
use nalgebra::Vector3;
use retarget::Landmark;

/// A branch shorter than this share of the longest way from the root is no limb: a head, fingers, a hand.
const LIMB: f64 = 0.25;
/// Frames that are looked at.
const LOOKS: usize = 100;
/// Limbs of a pair differ by less than this share.
const PAIR: f64 = 0.2;

/// Joints of a limb: those of thigh and shin or of upper arm and forearm, and the one after.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Limb {
    joints: [usize; 3],
    tip: Option<usize>,
}

/// The joints of both sides in the order of [`Landmark::ALL`]; the toe may be missing.
pub(super) type Found = [[Option<usize>; 7]; 2];

/// Finds the limbs of a skeleton; `None` if it does not look like a human's.
pub(super) fn find(
    parents: &[Option<usize>],
    frames: &[Vec<Vector3<f64>>],
    names: &Names,
) -> Option<Found> {
    let first = frames
        .first()
        .filter(|first| first.len() == parents.len())?;
    let tree = Tree::of(parents, first)?;
    let looks: Vec<&Vec<Vector3<f64>>> = frames.iter().step_by(frames.len() / LOOKS + 1).collect();
    let frames = looks.as_slice();
    let tips = tree.tips();
    // The four limbs and perhaps a head that is as long: two pairs that part at different joints.
    let mut best: Option<(f64, [[usize; 2]; 2])> = None;
    for (a, b) in pairs(&tips) {
        for (c, d) in pairs(&tips) {
            let parted = ![c, d].contains(&a) && ![c, d].contains(&b);
            let (Some(low), Some(high)) = (tree.mismatch(a, b), tree.mismatch(c, d)) else {
                continue;
            };
            let (at, other) = (tree.parting(a, b), tree.parting(c, d));
            if !parted || at == other || tree.rise(at, other, frames) <= 0.0 {
                continue;
            }
            if best.is_none_or(|(least, _)| low + high < least) {
                best = Some((low + high, [[a, b], [c, d]]));
            }
        }
    }
    let (_, [legs, arms]) = best?;
    let limb = |pair: [usize; 2], tip: usize| tree.limb(tree.parting(pair[0], pair[1]), tip);
    let legs = [limb(legs, legs[0])?, limb(legs, legs[1])?];
    let arms = [limb(arms, arms[0])?, limb(arms, arms[1])?];
    let up = tree.up(legs[0].joints[0], arms[0].joints[0], frames);
    let forward = forward(&legs, frames, up);
    let mut found: Found = [[None; 7]; 2];
    for (pair, at) in [(legs, Landmark::Hip), (arms, Landmark::Shoulder)] {
        let first =
            side(&pair, names).unwrap_or_else(|| side_by_place(&pair, frames, up, &forward));
        for (limb, side) in pair.iter().zip([first, 1 - first]) {
            for (k, joint) in limb.joints.into_iter().enumerate() {
                found[side][at as usize + k] = Some(joint);
            }
            if at == Landmark::Hip {
                found[side][Landmark::Toe as usize] = limb.tip;
            }
        }
    }
    Some(found)
}

fn pairs(tips: &[usize]) -> impl Iterator<Item = (usize, usize)> + '_ {
    (0..tips.len()).flat_map(move |i| (i + 1..tips.len()).map(move |j| (tips[i], tips[j])))
}

/// Which side the first of a pair is on, as its names say: 0 for left.
fn side(pair: &[Limb; 2], names: &Names) -> Option<usize> {
    let told = |limb: &Limb| limb.joints.iter().find_map(|&joint| names.side(joint));
    match (told(&pair[0]), told(&pair[1])) {
        (Some(first), Some(second)) if first != second => Some(first.index()),
        _ => None,
    }
}

fn side_by_place(
    pair: &[Limb; 2],
    frames: &[&Vec<Vector3<f64>>],
    up: Vector3<f64>,
    forward: &[Vector3<f64>],
) -> usize {
    let [a, b] = [pair[0].joints[0], pair[1].joints[0]];
    let to_left = |(frame, ahead): (&&Vec<Vector3<f64>>, &Vector3<f64>)| {
        (frame[a] - frame[b]).dot(&up.cross(ahead))
    };
    usize::from(frames.iter().zip(forward).map(to_left).sum::<f64>() < 0.0)
}

/// The way that feet point and knees bend, in every frame.
fn forward(legs: &[Limb; 2], frames: &[&Vec<Vector3<f64>>], up: Vector3<f64>) -> Vec<Vector3<f64>> {
    let level = |v: Vector3<f64>| v - up * v.dot(&up);
    let ahead = |frame: &&Vec<Vector3<f64>>| {
        let of_leg = |limb: &Limb| {
            let [hip, knee, ankle] = limb.joints.map(|joint| frame[joint]);
            let foot = limb.tip.map_or(Vector3::zeros(), |tip| frame[tip] - ankle);
            level(foot) + level(knee - (hip + ankle) / 2.0)
        };
        of_leg(&legs[0]) + of_leg(&legs[1])
    };
    frames.iter().map(ahead).collect()
}

struct Tree<'a> {
    parents: &'a [Option<usize>],
    children: Vec<Vec<usize>>,
    /// Length of the bone from a joint's parent to it.
    bone: Vec<f64>,
    /// Longest way from a joint on, and the child that it goes by.
    reach: Vec<(f64, Option<usize>)>,
}

impl<'a> Tree<'a> {
    fn of(parents: &'a [Option<usize>], places: &[Vector3<f64>]) -> Option<Self> {
        let mut children = vec![Vec::new(); parents.len()];
        for (joint, parent) in parents.iter().enumerate() {
            let Some(parent) = *parent else { continue };
            // A parent stands before its children.
            children
                .get_mut(parent)
                .filter(|_| parent < joint)?
                .push(joint);
        }
        let bone: Vec<f64> = (0..parents.len())
            .map(|joint| parents[joint].map_or(0.0, |p| (places[joint] - places[p]).norm()))
            .collect();
        let mut reach: Vec<(f64, Option<usize>)> = vec![(0.0, None); parents.len()];
        for joint in (1..parents.len()).rev() {
            let Some(parent) = parents[joint] else {
                continue;
            };
            let way = bone[joint] + reach[joint].0;
            if way > reach[parent].0 {
                reach[parent] = (way, Some(joint));
            }
        }
        Some(Self {
            parents,
            children,
            bone,
            reach,
        })
    }

    /// Where the long branches end: joints with a long way to them and none from them.
    fn tips(&self) -> Vec<usize> {
        let least = LIMB * self.reach.first().map_or(0.0, |(reach, _)| *reach);
        let mut tips = Vec::new();
        let mut open = vec![0];
        while let Some(joint) = open.pop() {
            let long = |&&child: &&usize| self.bone[child] + self.reach[child].0 >= least;
            let branches: Vec<usize> = self.children[joint].iter().filter(long).copied().collect();
            if branches.is_empty() {
                tips.push(joint);
            }
            open.extend(branches);
        }
        const MOST: usize = 12; // no human; and pairs of pairs grow fast
        if tips.len() > MOST { Vec::new() } else { tips }
    }

    fn path(&self, joint: usize) -> Vec<usize> {
        let mut path: Vec<usize> =
            std::iter::successors(Some(joint), |&joint| self.parents[joint]).collect();
        path.reverse();
        path
    }

    /// The last joint that the ways to two joints share.
    fn parting(&self, a: usize, b: usize) -> usize {
        let (a, b) = (self.path(a), self.path(b));
        let shared = a.iter().zip(&b).take_while(|(a, b)| a == b).count();
        a[shared.saturating_sub(1)]
    }

    /// By which share two limbs differ in length; `None` if they are no pair.
    fn mismatch(&self, a: usize, b: usize) -> Option<f64> {
        let from = self.parting(a, b);
        let length = |tip: usize| -> f64 {
            let path = self.path(tip);
            let limb = path.iter().skip_while(|&&joint| joint != from).skip(1);
            limb.map(|&joint| self.bone[joint]).sum::<f64>() + self.reach[tip].0
        };
        let (a, b) = (length(a), length(b));
        let share = (a - b).abs() / a.max(b).max(f64::MIN_POSITIVE);
        (share < PAIR).then_some(share)
    }

    /// How far one joint is above another along the axis that they are farthest apart on, of y and z.
    fn rise(&self, low: usize, high: usize, frames: &[&Vec<Vector3<f64>>]) -> f64 {
        let way: Vector3<f64> = frames.iter().map(|frame| frame[high] - frame[low]).sum();
        if way.y.abs() > way.z.abs() {
            way.y
        } else {
            way.z
        }
    }

    fn up(&self, low: usize, high: usize, frames: &[&Vec<Vector3<f64>>]) -> Vector3<f64> {
        let way: Vector3<f64> = frames.iter().map(|frame| frame[high] - frame[low]).sum();
        if way.y.abs() > way.z.abs() {
            Vector3::y()
        } else {
            Vector3::z()
        }
    }

    /// The two longest bones in a row on the way from a joint to a tip and on to its end.
    fn limb(&self, from: usize, tip: usize) -> Option<Limb> {
        let mut way: Vec<usize> = self
            .path(tip)
            .into_iter()
            .skip_while(|&joint| joint != from)
            .skip(1)
            .collect();
        way.extend(std::iter::successors(self.reach[tip].1, |&joint| {
            self.reach[joint].1
        }));
        // Joints in one place are one.
        let whole: f64 = way.iter().map(|&joint| self.bone[joint]).sum();
        let mut chain: Vec<usize> = Vec::new();
        for joint in way {
            if chain.is_empty() || self.bone[joint] > 0.01 * whole {
                chain.push(joint);
            }
        }
        let length = |i: usize| self.bone[chain[i + 1]] + self.bone[chain[i + 2]];
        let start =
            (0..chain.len().saturating_sub(2)).max_by(|&a, &b| length(a).total_cmp(&length(b)))?;
        Some(Limb {
            joints: [chain[start], chain[start + 1], chain[start + 2]],
            tip: chain.get(start + 3).copied(),
        })
    }
}

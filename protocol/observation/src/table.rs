//! A list of terms made ready: where each stands, how a row is written and how it is reflected.
//!
//! Names are looked up here, once; what runs at every step of every robot is a few calls of functions with a range each.

use crate::scene::Scene;
use crate::term::{Term, Writer};
use crate::terms::{self, TOGETHER};
use std::ops::Range;

/// A term of a list.
#[derive(Clone, Copy, Debug)]
pub struct Entry {
    /// The term.
    pub term: &'static Term,
    /// What a quantity in its unit is multiplied by.
    pub scale: f32,
    /// Uniform noise, ± this, in its unit.
    pub noise: f32,
    /// It is cut to ± this, in its unit.
    pub clip: Option<f32>,
    /// Frames before the present one that are seen too.
    pub past: usize,
}

impl Entry {
    /// A term as it is, at present.
    pub fn plain(term: &'static Term) -> Self {
        Self {
            term,
            scale: 1.0,
            noise: 0.0,
            clip: None,
            past: 0,
        }
    }

    /// Numbers of a row.
    pub fn width(&self) -> usize {
        self.term.width() * (1 + self.past)
    }

    /// Whether its newest numbers are the quantity in its unit, noise aside.
    fn is_in_units(&self) -> bool {
        self.scale == 1.0 && self.clip.is_none()
    }
}

/// A left–right reflection of rows: `out[i] = sign[i] · in[index[i]]`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Reflection {
    /// Where each number comes from.
    pub index: Vec<usize>,
    /// +1 or −1.
    pub sign: Vec<f32>,
}

/// A list made ready. A *row* is what is seen, past frames included; a *frame* is the present alone.
#[derive(Clone, Debug)]
pub struct Table {
    entries: Vec<Entry>,
    /// Where each entry's numbers are in a frame.
    frames: Vec<Range<usize>>,
    /// Where each entry's numbers are in a row; the newest come first.
    rows: Vec<Range<usize>>,
    /// What writes a frame: a function, and which numbers.
    writers: Vec<(Writer, Range<usize>)>,
    /// What is cut and scaled of a frame: which numbers, ± what, by what.
    adjustments: Vec<(Range<usize>, f32, f32)>,
    width: usize,
    frame_width: usize,
}

impl Table {
    /// Of entries in order.
    pub fn of(entries: Vec<Entry>) -> Self {
        let places = |width: fn(&Entry) -> usize| {
            let mut end = 0;
            let place = |entry: &Entry| {
                let start = end;
                end += width(entry);
                start..end
            };
            entries.iter().map(place).collect::<Vec<_>>()
        };
        let frames = places(|entry| entry.term.width());
        let rows = places(Entry::width);
        let adjusted = entries
            .iter()
            .zip(&frames)
            .filter(|(e, _)| !e.is_in_units());
        Self {
            writers: writers(&entries, &frames),
            adjustments: adjusted
                .map(|(e, place)| (place.clone(), e.clip.unwrap_or(f32::INFINITY), e.scale))
                .collect(),
            width: rows.last().map_or(0, |place| place.end),
            frame_width: frames.last().map_or(0, |place| place.end),
            frames,
            rows,
            entries,
        }
    }

    /// Of terms as they are.
    ///
    /// # Panics
    /// If there is no term of a name.
    pub fn plain<'a>(names: impl IntoIterator<Item = &'a str>) -> Self {
        let entry = |name| Entry::plain(terms::named(name).expect("a name of the table of terms"));
        Self::of(names.into_iter().map(entry).collect())
    }

    /// The entries in order.
    pub fn entries(&self) -> &[Entry] {
        &self.entries
    }

    /// Numbers of a row.
    pub fn width(&self) -> usize {
        self.width
    }

    /// Numbers of a frame.
    pub fn frame_width(&self) -> usize {
        self.frame_width
    }

    /// Whether a row is a frame: no term has past frames.
    pub fn is_of_the_present(&self) -> bool {
        self.width == self.frame_width
    }

    /// Every entry with where its numbers are in a frame.
    pub fn in_frame(&self) -> impl Iterator<Item = (&Entry, Range<usize>)> {
        self.entries.iter().zip(self.frames.iter().cloned())
    }

    /// Every entry with where its numbers are in a row, the newest first.
    pub fn in_row(&self) -> impl Iterator<Item = (&Entry, Range<usize>)> {
        self.entries.iter().zip(self.rows.iter().cloned())
    }

    /// Where a row holds a term's newest numbers in its unit, if it does.
    pub fn in_units(&self, name: &str) -> Option<Range<usize>> {
        let (entry, place) = self.in_row().find(|(entry, _)| entry.term.name == name)?;
        let newest = place.start..place.start + entry.term.width();
        entry.is_in_units().then_some(newest)
    }

    /// Writes what the terms measure of a scene into a frame, in their units.
    ///
    /// # Panics
    /// If `frame` has not [`Self::frame_width`] numbers.
    #[inline]
    pub fn measure(&self, scene: &Scene<'_>, frame: &mut [f32]) {
        for (write, place) in &self.writers {
            write(scene, &mut frame[place.clone()]);
        }
    }

    /// Cuts and scales a frame that was measured.
    #[inline]
    pub fn adjust(&self, frame: &mut [f32]) {
        for (place, clip, scale) in &self.adjustments {
            for number in &mut frame[place.clone()] {
                *number = number.clamp(-clip, *clip) * scale;
            }
        }
    }

    /// Moves a row's frames one step into the past and puts a frame before them; as the first of an episode it stands
    /// for all.
    ///
    /// # Panics
    /// If `row` has not [`Self::width`] numbers or `frame` not [`Self::frame_width`].
    pub fn remember(&self, frame: &[f32], first: bool, row: &mut [f32]) {
        for (now, place) in self.frames.iter().zip(&self.rows) {
            let (now, frames) = (&frame[now.clone()], &mut row[place.clone()]);
            if first {
                for place in frames.chunks_exact_mut(now.len()) {
                    place.copy_from_slice(now);
                }
            } else {
                let kept = frames.len() - now.len();
                frames.copy_within(..kept, now.len());
                frames[..now.len()].copy_from_slice(now);
            }
        }
    }

    /// Puts other numbers, in its unit, in the place of a term's newest; as the first of an episode in that of all its
    /// frames. Does nothing where the term is not listed.
    pub fn replace(&self, name: &str, numbers: &[f32], first: bool, row: &mut [f32]) {
        let Some((entry, place)) = self.in_row().find(|(entry, _)| entry.term.name == name) else {
            return;
        };
        let count = if first { 1 + entry.past } else { 1 };
        let clip = entry.clip.unwrap_or(f32::INFINITY);
        for frame in row[place].chunks_exact_mut(numbers.len()).take(count) {
            for (out, number) in frame.iter_mut().zip(numbers) {
                *out = number.clamp(-clip, clip) * entry.scale;
            }
        }
    }

    /// A row of a scene that is the first of its episode, without noise.
    pub fn row(&self, scene: &Scene<'_>) -> Vec<f32> {
        let mut frame = vec![0.0; self.frame_width()];
        self.measure(scene, &mut frame);
        self.adjust(&mut frame);
        let mut row = vec![0.0; self.width()];
        self.remember(&frame, true, &mut row);
        row
    }

    /// The left–right reflection of rows.
    pub fn reflection(&self) -> Reflection {
        let mut reflection = Reflection::default();
        for (entry, place) in self.in_row() {
            let width = entry.term.width();
            for start in place.step_by(width) {
                for (from, sign) in (0..width).map(entry.term.mirror) {
                    reflection.index.push(start + from);
                    reflection.sign.push(sign);
                }
            }
        }
        reflection
    }

    /// The list in a line: names, and what is otherwise than usual.
    pub fn words(&self) -> String {
        let word = |entry: &Entry| {
            let mut word = entry.term.name.to_owned();
            let mut tell = |name: &str, value: Option<f32>| {
                if let Some(value) = value {
                    word.push_str(&format!(" {name} {value}"));
                }
            };
            tell("scale", (entry.scale != 1.0).then_some(entry.scale));
            tell("noise", (entry.noise != 0.0).then_some(entry.noise));
            tell("clip", entry.clip);
            tell("past", (entry.past > 0).then_some(entry.past as f32));
            word
        };
        let words: Vec<String> = self.entries.iter().map(word).collect();
        words.join(", ")
    }

    /// The same list without noise of its own.
    #[must_use]
    pub fn exact(&self) -> Self {
        let exact = |entry: &Entry| Entry {
            noise: 0.0,
            ..*entry
        };
        Self::of(self.entries.iter().map(exact).collect())
    }
}

/// What writes a frame: terms that one function writes together, wherever they follow each other, and else their own.
fn writers(entries: &[Entry], frames: &[Range<usize>]) -> Vec<(Writer, Range<usize>)> {
    let mut writers = Vec::new();
    let mut next = 0;
    while next < entries.len() {
        let follow = |names: &[&str]| {
            let there = entries[next..].iter().map(|entry| entry.term.name);
            entries.len() - next >= names.len() && there.zip(names).all(|(a, b)| a == *b)
        };
        let (write, count) = TOGETHER
            .iter()
            .find(|(names, _)| follow(names))
            .map_or((entries[next].term.write, 1), |(names, write)| {
                (*write, names.len())
            });
        writers.push((write, frames[next].start..frames[next + count - 1].end));
        next += count;
    }
    writers
}

#[cfg(test)]
mod tests;

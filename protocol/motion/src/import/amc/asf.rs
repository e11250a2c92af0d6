//! Acclaim skeletons (`.asf`).
//!
//! Separate because it is another file with errors of its own.

use crate::error::MotionError;
use crate::import::file::File;
use nalgebra::{Rotation3, Vector3};

/// A number of a bone's line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Channel {
    Move(usize),
    Turn(usize),
    /// Stretching, which rigid humans do not.
    Length,
}

/// A bone; the root is one without length.
#[derive(Clone, Debug)]
pub(super) struct Bone {
    pub(super) name: String,
    pub(super) parent: Option<usize>,
    /// From its start to its end in the skeleton's pose at rest, in the file's unit.
    pub(super) vector: Vector3<f64>,
    /// Its own axes at rest.
    axis: Rotation3<f64>,
    pub(super) channels: Vec<Channel>,
    /// rad per unit of an angle.
    radians: f64,
}

impl Bone {
    /// How a frame's numbers move and turn it, relative to its parent.
    pub(super) fn pose(&self, values: &[f64]) -> (Vector3<f64>, Rotation3<f64>) {
        let (mut moved, mut turned) = (Vector3::zeros(), Rotation3::identity());
        for (channel, value) in self.channels.iter().zip(values) {
            match *channel {
                Channel::Move(axis) => moved[axis] = *value,
                // The first number turns first.
                Channel::Turn(axis) => {
                    turned = Rotation3::from_scaled_axis(Vector3::ith(axis, value * self.radians))
                        * turned;
                }
                Channel::Length => {}
            }
        }
        (moved, self.axis * turned * self.axis.inverse())
    }
}

/// Bones, parents before children.
#[derive(Clone, Debug)]
pub(super) struct Skeleton {
    pub(super) bones: Vec<Bone>,
    /// m per unit of length.
    pub(super) unit: f64,
}

/// Reads a skeleton.
pub(super) fn read(file: &File<'_>) -> Result<Skeleton, MotionError> {
    let text = file.text();
    let mut reader = Reader {
        file,
        section: String::new(),
        unit: 1.0,
        radians: 1f64.to_radians(),
        bones: vec![Bone {
            name: "root".into(),
            parent: None,
            vector: Vector3::zeros(),
            axis: Rotation3::identity(),
            channels: Vec::new(),
            radians: 1f64.to_radians(),
        }],
        links: Vec::new(),
        direction: Vector3::zeros(),
        length: 0.0,
    };
    for (i, line) in text.lines().enumerate() {
        let line = line.split('#').next().unwrap_or("").trim();
        if let Some(section) = line.strip_prefix(':') {
            section
                .split_whitespace()
                .next()
                .unwrap_or("")
                .clone_into(&mut reader.section);
            continue;
        }
        let words: Vec<&str> = line.split_whitespace().collect();
        if let Some((&key, words)) = words.split_first() {
            reader.line(i + 1, key, words)?;
        }
    }
    reader.skeleton()
}

struct Reader<'a> {
    file: &'a File<'a>,
    section: String,
    unit: f64,
    radians: f64,
    bones: Vec<Bone>,
    links: Vec<(String, String)>,
    direction: Vector3<f64>,
    length: f64,
}

impl Reader<'_> {
    fn line(&mut self, number: usize, key: &str, words: &[&str]) -> Result<(), MotionError> {
        match (self.section.as_str(), key) {
            // CMU's lengths are inches over this number.
            ("units", "length") => {
                let length = self.numbers(number, key, words, 1)?[0];
                if length <= 0.0 {
                    return Err(self.file.line(
                        number,
                        format!("a unit of length {length}"),
                        "write one above 0",
                    ));
                }
                self.unit = 0.0254 / length;
            }
            ("units", "angle") if words.first() == Some(&"rad") => self.radians = 1.0,
            ("root", "order") => self.bones[0].channels = self.channels(number, words)?,
            ("root", "axis") => {}
            ("root", "orientation") => {
                let angles = self.numbers(number, key, words, 3)?;
                self.bones[0].axis = euler(&angles, "XYZ", self.radians);
            }
            ("bonedata", "begin") => {
                (self.direction, self.length) = (Vector3::zeros(), 0.0);
                let mut bone = self.bones[0].clone();
                (bone.axis, bone.channels) = (Rotation3::identity(), Vec::new());
                bone.name.clear();
                self.bones.push(bone);
            }
            ("bonedata", "name") => {
                self.bone().name = words.first().copied().unwrap_or("").to_owned();
            }
            ("bonedata", "direction") => {
                self.direction = Vector3::from_column_slice(&self.numbers(number, key, words, 3)?);
            }
            ("bonedata", "length") => self.length = self.numbers(number, key, words, 1)?[0],
            ("bonedata", "axis") => {
                let angles = self.numbers(number, key, words, 3)?;
                let order = words.get(3).copied().unwrap_or("XYZ").to_owned();
                let radians = self.radians;
                self.bone().axis = euler(&angles, &order, radians);
            }
            ("bonedata", "dof") => self.bone().channels = self.channels(number, words)?,
            ("bonedata", "end") => {
                let vector = self.direction.try_normalize(1e-9).unwrap_or_default() * self.length;
                self.bone().vector = vector;
            }
            ("hierarchy", parent) if parent != "begin" && parent != "end" => {
                let links = words
                    .iter()
                    .map(|child| (parent.to_owned(), (*child).to_owned()));
                self.links.extend(links);
            }
            _ => {}
        }
        Ok(())
    }

    fn bone(&mut self) -> &mut Bone {
        self.bones.last_mut().expect("there is a root")
    }

    fn numbers(
        &self,
        line: usize,
        key: &str,
        words: &[&str],
        count: usize,
    ) -> Result<Vec<f64>, MotionError> {
        let numbers: Option<Vec<f64>> = words
            .iter()
            .take(count)
            .map(|word| word.parse().ok().filter(|x: &f64| x.is_finite()))
            .collect();
        numbers
            .filter(|numbers| numbers.len() == count)
            .ok_or_else(|| {
                let problem = format!("{key} needs {count} finite numbers");
                self.file
                    .line(line, problem, "download or export the skeleton again")
            })
    }

    fn channels(&self, line: usize, words: &[&str]) -> Result<Vec<Channel>, MotionError> {
        words
            .iter()
            .map(|word| match word.to_ascii_lowercase().as_str() {
                "tx" => Ok(Channel::Move(0)),
                "ty" => Ok(Channel::Move(1)),
                "tz" => Ok(Channel::Move(2)),
                "rx" => Ok(Channel::Turn(0)),
                "ry" => Ok(Channel::Turn(1)),
                "rz" => Ok(Channel::Turn(2)),
                "l" => Ok(Channel::Length),
                _ => {
                    let problem = format!("degree of freedom {word:?}");
                    Err(self
                        .file
                        .line(line, problem, "expected tx ty tz rx ry rz l"))
                }
            })
            .collect()
    }

    /// Bones with their parents, sorted so that parents come first.
    fn skeleton(self) -> Result<Skeleton, MotionError> {
        if self.bones[0].channels.is_empty() || self.bones.len() == 1 {
            return Err(self.file.unusable(
                "has no :root with an order, or no :bonedata",
                "is it an .asf file?",
            ));
        }
        let mut bones: Vec<Bone> = vec![self.bones[0].clone()];
        let mut next = 0;
        while next < bones.len() {
            let parent = bones[next].name.clone();
            for (_, child) in self.links.iter().filter(|(from, _)| *from == parent) {
                let bone = self.bones.iter().find(|bone| bone.name == *child);
                // A bone that is already there would hang on itself.
                let known = bones.iter().any(|bone| bone.name == *child);
                let (Some(bone), false) = (bone, known) else {
                    let problem =
                        format!("the hierarchy names {child:?}, which is no bone or hangs twice");
                    return Err(self
                        .file
                        .unusable(&problem, "download or export the skeleton again"));
                };
                bones.push(Bone {
                    parent: Some(next),
                    ..bone.clone()
                });
            }
            next += 1;
        }
        Ok(Skeleton {
            bones,
            unit: self.unit,
        })
    }
}

/// Angles about axes of the parent, the first of the order first.
fn euler(angles: &[f64], order: &str, radians: f64) -> Rotation3<f64> {
    order
        .bytes()
        .zip(angles)
        .fold(Rotation3::identity(), |before, (axis, angle)| {
            let axis = match axis {
                b'X' | b'x' => 0,
                b'Y' | b'y' => 1,
                _ => 2,
            };
            Rotation3::from_scaled_axis(Vector3::ith(axis, angle * radians)) * before
        })
}

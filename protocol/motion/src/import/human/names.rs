//! Which joint of a skeleton is which of ours, by name.
//!
//! Separate because every maker has names of its own: a side somewhere in the name, a word for the joint,
//! and often something in front that all joints share.

use retarget::{Landmark, Side};

/// Names of a joint, without side, in the order in which they are looked for: some mean another joint
/// in another skeleton ("LeftLeg" is a shin unless there is a "LeftShin").
const NAMES: [(Landmark, &[&str]); 7] = [
    (
        Landmark::Hip,
        &[
            "upleg",
            "thigh",
            "upperleg",
            "thighbend",
            "hip",
            "femur",
            "leg",
        ],
    ),
    (
        Landmark::Knee,
        &["shin", "lowerleg", "lowleg", "knee", "calf", "tibia", "leg"],
    ),
    (Landmark::Ankle, &["ankle", "foot"]),
    (
        Landmark::Toe,
        &[
            "toebase",
            "toe",
            "toes",
            "ball",
            "foottoe",
            "toebaseend",
            "footend",
            "ankleend",
        ],
    ),
    (
        Landmark::Shoulder,
        &[
            "arm",
            "upperarm",
            "uparm",
            "uarm",
            "humerus",
            "shldr",
            "shldrbend",
            "shoulder",
        ],
    ),
    (
        Landmark::Elbow,
        &[
            "forearm",
            "lowerarm",
            "lowarm",
            "farm",
            "forearmbend",
            "elbow",
            "radius",
        ],
    ),
    (Landmark::Wrist, &["wrist", "hand"]),
];

/// Sides and words of every joint of a skeleton.
pub(super) struct Names(Vec<Vec<(Side, String)>>);

impl Names {
    pub(super) fn of(names: &[String]) -> Self {
        let prefix = common_prefix(names);
        let readings = |name: &String| readings(name.get(prefix..).unwrap_or(name));
        Self(names.iter().map(readings).collect())
    }

    /// The joint that a landmark of a side is, if it is named and not taken.
    pub(super) fn find(&self, side: Side, landmark: Landmark, taken: &[usize]) -> Option<usize> {
        let (_, stems) = NAMES[landmark as usize];
        stems
            .iter()
            .filter(|stem| {
                // A leg is a shin where nothing else is.
                !(**stem == "leg" && landmark == Landmark::Hip && !self.has_shin(side))
            })
            .find_map(|stem| {
                (0..self.0.len()).find(|i| !taken.contains(i) && self.is(*i, side, stem))
            })
    }

    /// The side that a joint's name has, if it has one.
    pub(super) fn side(&self, joint: usize) -> Option<Side> {
        self.0[joint].first().map(|(side, _)| *side)
    }

    fn has_shin(&self, side: Side) -> bool {
        let (_, stems) = NAMES[Landmark::Knee as usize];
        let mut shins = stems.iter().filter(|stem| **stem != "leg");
        shins.any(|stem| (0..self.0.len()).any(|i| self.is(i, side, stem)))
    }

    fn is(&self, joint: usize, side: Side, stem: &str) -> bool {
        self.0[joint].iter().any(|(s, word)| {
            *s == side
                && (word == stem || word.trim_end_matches(|c: char| c.is_ascii_digit()) == stem)
        })
    }
}

/// Bytes that all joints' names begin with, up to a break in the words: "mixamorig:", "Bip01 ",
/// "Skeleton 001_".
fn common_prefix(names: &[String]) -> usize {
    let Some((first, rest)) = names.split_first() else {
        return 0;
    };
    // The root is often the one that has another name.
    let first = rest.first().unwrap_or(first);
    let shared = rest.iter().fold(first.len(), |shared, name| {
        let pairs = first.bytes().zip(name.bytes());
        pairs.take_while(|(a, b)| a == b).count().min(shared)
    });
    let shared = &first.as_bytes()[..shared];
    let at_break = shared
        .iter()
        .rposition(|byte| !byte.is_ascii_alphabetic())
        .map_or(0, |at| at + 1);
    // A word that all names begin with ends where a capital follows: "mixamorigHips".
    let capital = |at: usize| first.as_bytes().get(at).is_some_and(u8::is_ascii_uppercase);
    let whole =
        (rest.len() > 2 && shared.len() > 2 && capital(shared.len())).then_some(shared.len());
    let prefix = whole.unwrap_or(0).max(at_break);
    (0..=prefix)
        .rev()
        .find(|&at| first.is_char_boundary(at))
        .unwrap_or(0)
}

/// Sides and words that a name may mean: LeftFoot, left_foot, L_Foot, Foot_L, lfoot, LFoot, Bip01 L Foot.
fn readings(name: &str) -> Vec<(Side, String)> {
    let name = name.rsplit(':').next().unwrap_or(name);
    let words = words(name);
    let mut readings = Vec::new();
    for (at, word) in words.iter().enumerate() {
        let side = match word.as_str() {
            "left" | "l" => Side::Left,
            "right" | "r" => Side::Right,
            _ => continue,
        };
        let after = words[at + 1..].concat();
        if after.chars().any(|c| c.is_ascii_alphabetic()) {
            readings.push((side, after));
            continue;
        }
        // "DEF-upper_arm.L": what is in front may be more than the joint.
        const FRONT: [&str; 8] = ["def", "org", "mch", "jnt", "joint", "bone", "bip", "j"];
        let front = words[..at]
            .iter()
            .take_while(|word| FRONT.contains(&word.as_str()))
            .count();
        readings.push((side, words[front..at].concat()));
    }
    let plain = words.concat();
    for (side, word, letter) in [(Side::Left, "left", "l"), (Side::Right, "right", "r")] {
        let stems = [
            plain.strip_prefix(word),
            plain.strip_suffix(word),
            plain.strip_prefix(letter),
        ];
        readings.extend(
            stems
                .into_iter()
                .flatten()
                .map(|stem| (side, stem.to_owned())),
        );
    }
    // A name that only happens to begin with l or r has no side of its own: known words decide.
    let known = |stem: &str| {
        let stem = stem.trim_end_matches(|c: char| c.is_ascii_digit());
        NAMES.iter().any(|(_, stems)| stems.contains(&stem))
    };
    readings.retain(|(_, stem)| known(stem));
    readings
}

/// The words of a name in small letters: parted by signs and by capitals, a leading L or R of capitals by
/// itself ("LUArm").
fn words(name: &str) -> Vec<String> {
    let mut words: Vec<String> = Vec::new();
    for token in name.split(|c: char| !c.is_ascii_alphanumeric()) {
        let letters: Vec<char> = token.chars().collect();
        let mut begun = false;
        for (i, &letter) in letters.iter().enumerate() {
            let before = i.checked_sub(1).map(|j| letters[j]);
            let after = letters.get(i + 1);
            let begins = match before {
                None => true,
                Some(before) => {
                    letter.is_ascii_uppercase()
                        && (!before.is_ascii_uppercase()
                            || after.is_some_and(char::is_ascii_lowercase)
                            || (i == 1 && matches!(before, 'L' | 'R')))
                }
            };
            if begins || !begun {
                words.push(String::new());
                begun = true;
            }
            if let Some(word) = words.last_mut() {
                word.push(letter.to_ascii_lowercase());
            }
        }
    }
    words
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(list: &[&str]) -> Vec<String> {
        list.iter().map(|name| (*name).to_owned()).collect()
    }

    #[test]
    fn words_part_at_signs_and_capitals() {
        for (name, expected) in [
            ("LeftUpLeg", &["left", "up", "leg"][..]),
            ("LUArm", &["l", "u", "arm"]),
            ("LThigh", &["l", "thigh"]),
            ("lShldrBend", &["l", "shldr", "bend"]),
            ("Bip01 L Toe0", &["bip01", "l", "toe0"]),
            ("J_Bip_R_ToeBase", &["j", "bip", "r", "toe", "base"]),
            ("upper_arm.L", &["upper", "arm", "l"]),
            ("Bip01LThigh", &["bip01", "l", "thigh"]),
        ] {
            assert_eq!(words(name), expected, "{name}");
        }
    }

    #[test]
    fn what_all_names_begin_with_is_no_part_of_them() {
        for (list, prefix) in [
            (&["Ryan_Hip", "Ryan_LThigh", "Ryan_RThigh"][..], 5),
            (&["Hips", "Spine", "LeftUpLeg"], 0),
            (&["root", "Skel 1_LeftUpLeg", "Skel 1_LeftLeg"], 7),
            (
                &[
                    "mixamorigHips",
                    "mixamorigSpine",
                    "mixamorigLeftLeg",
                    "mixamorigRightLeg",
                ],
                9,
            ),
            (&["LeftLeg", "LeftFoot"], 0),
            (&["x"], 0),
            (&[], 0),
        ] {
            assert_eq!(common_prefix(&names(list)), prefix, "{list:?}");
        }
    }

    #[test]
    fn names_that_only_begin_like_a_side_have_none() {
        let names = Names::of(&names(&["root", "lowerback", "rib", "lfoot", "rightArm"]));
        assert_eq!([0, 1, 2].map(|i| names.side(i)), [None; 3]);
        assert_eq!(names.side(3), Some(Side::Left));
        assert_eq!(names.find(Side::Right, Landmark::Shoulder, &[]), Some(4));
        assert_eq!(names.find(Side::Right, Landmark::Shoulder, &[4]), None);
    }
}

//! Closest names: what somebody probably meant to type.
//!
//! Separate because keys, sections, presets, terms and runs are all misspelt the same way.

/// Longer names are not misspelt, and comparing them takes time.
const LONGEST: usize = 100;

/// The remedy for an unknown `name`: the closest of `known`, else all of them.
pub fn remedy(name: &str, known: &[&str]) -> String {
    let close = nearest(name, known);
    if close.is_empty() {
        format!("known: {}", names(known))
    } else {
        let quoted: Vec<String> = close.iter().map(|name| format!("`{name}`")).collect();
        format!("did you mean {}?", quoted.join(" or "))
    }
}

/// Names in a row, each in marks, so that a message that is cut is cut between them.
pub fn names(names: &[&str]) -> String {
    let quoted: Vec<String> = names.iter().map(|name| format!("`{name}`")).collect();
    quoted.join(", ")
}

/// At most three of `known` that differ from `name` in about a third of their letters, closest first.
fn nearest<'a>(name: &str, known: &[&'a str]) -> Vec<&'a str> {
    if name.len() > LONGEST {
        return Vec::new();
    }
    let mut scored: Vec<(usize, &str)> = known
        .iter()
        .map(|candidate| {
            // Part of a long name, as in `smoothing` for `rise_smoothing`, is as good as one wrong letter.
            let contains =
                name.len() >= 4 && (candidate.contains(name) || name.contains(candidate));
            let distance = if contains {
                1
            } else {
                distance(name, candidate)
            };
            (distance, *candidate)
        })
        .filter(|(distance, candidate)| *distance <= name.len().max(candidate.len()).div_ceil(3))
        .collect();
    scored.sort();
    scored
        .into_iter()
        .take(3)
        .map(|(_, candidate)| candidate)
        .collect()
}

/// Levenshtein distance in characters: insertions, deletions and replacements.
fn distance(from: &str, to: &str) -> usize {
    let to: Vec<char> = to.chars().collect();
    let mut row: Vec<usize> = (0..=to.len()).collect();
    for (i, a) in from.chars().enumerate() {
        let mut diagonal = row[0];
        row[0] = i + 1;
        for (j, b) in to.iter().enumerate() {
            let replaced = diagonal + usize::from(a != *b);
            diagonal = row[j + 1];
            row[j + 1] = replaced.min(row[j] + 1).min(diagonal + 1);
        }
    }
    row[to.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn kitten_becomes_sitting_in_three_edits() {
        assert_eq!(distance("kitten", "sitting"), 3); // k→s, e→i, +g
        assert_eq!(distance("", "abc"), 3);
        assert_eq!(distance("same", "same"), 0);
    }

    #[test]
    fn a_missing_letter_names_the_key_and_nonsense_names_all() {
        let known = ["steps", "environments", "actors"];
        assert_eq!(
            remedy("enviroments", &known),
            "did you mean `environments`?"
        );
        assert_eq!(
            remedy("zzzzzzzz", &known),
            "known: `steps`, `environments`, `actors`"
        );
    }
}

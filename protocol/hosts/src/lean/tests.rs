//! Every bit comes back, less is sent, and hostile bytes are refused.

use super::*;
use proptest::prelude::*;
use protocol::Lists;

fn lists() -> Lists {
    Lists::default()
}

/// Where the paper's list has the previous action.
fn previous() -> Option<Range<usize>> {
    observation::Tables::default()
        .actor
        .in_units("previous_action")
}

fn lean(environments: usize, steps: usize) -> Lean {
    let layout = RolloutLayout {
        environments,
        steps,
        lists: lists(),
    };
    Lean::new(layout, previous())
}

/// A rollout as actors make it: the next features are those of the next step, but where an episode ended.
fn rollout(lean: &Lean, ended: &[usize]) -> Vec<f32> {
    let layout = *lean.layout();
    let mut numbers: Vec<f32> = (0..layout.len()).map(|i| (i as f32).sin()).collect();
    let view = layout.view_mut(&mut numbers);
    let (width, seen) = (lists().widths.features, lists().widths.observation);
    let rows = layout.environments * layout.steps;
    for row in 0..rows {
        if ended.contains(&row) {
            continue;
        }
        let after = row + layout.environments;
        if after < rows {
            let next = view.features[after * width..][..width].to_vec();
            view.next_features[row * width..][..width].copy_from_slice(&next);
        }
        let acted = &view.actions[row * 23..][..23];
        let place = previous().unwrap();
        if after < rows {
            view.observations[after * seen..][..seen][place].copy_from_slice(acted);
        } else {
            let row = after - rows;
            view.last_observations[row * seen..][..seen][place].copy_from_slice(acted);
        }
    }
    numbers
}

fn bits(numbers: &[f32]) -> Vec<u32> {
    numbers.iter().map(|number| number.to_bits()).collect()
}

#[test]
fn every_bit_comes_back_and_a_quarter_is_not_sent() {
    let lean = lean(128, 32);
    let numbers = rollout(&lean, &[3, 7, 500, 4000]);
    let bytes = lean.strip(&numbers);
    let mut back = vec![f32::NAN; numbers.len()];
    lean.restore(&bytes, &mut back).unwrap();
    assert_eq!(bits(&numbers), bits(&back));
    // 53 of 242 numbers of a step and 23 more are left out, but of the last step's features: about .70 is sent.
    let share = bytes.len() as f64 / (4 * numbers.len()) as f64;
    assert!((0.68..0.72).contains(&share), "{share}");
}

#[test]
fn numbers_that_follow_no_rule_come_back_too() {
    for (environments, steps) in [(1, 1), (3, 2), (5, 7)] {
        let lean = lean(environments, steps);
        let mut numbers: Vec<f32> = (0..lean.layout().len()).map(|i| (i as f32).cos()).collect();
        // A NaN is not equal to itself, −0 is equal to 0: bits count.
        numbers[0] = f32::NAN;
        numbers[1] = -0.0;
        let mut back = vec![1.0; numbers.len()];
        lean.restore(&lean.strip(&numbers), &mut back).unwrap();
        assert_eq!(bits(&numbers), bits(&back));
    }
    let layout = *lean(2, 3).layout();
    let without = Lean::new(layout, None);
    let numbers = rollout(&lean(2, 3), &[]);
    let mut back = vec![1.0; numbers.len()];
    without
        .restore(&without.strip(&numbers), &mut back)
        .unwrap();
    assert_eq!(bits(&numbers), bits(&back));
}

#[test]
fn wrong_lengths_and_rows_that_nothing_tells_are_refused() {
    let lean = lean(4, 3);
    let numbers = rollout(&lean, &[]);
    let bytes = lean.strip(&numbers);
    let mut back = vec![0.0; numbers.len()];
    for wrong in [&bytes[..0], &bytes[..3], &bytes[..bytes.len() - 1]] {
        let refused = lean.restore(wrong, &mut back);
        assert!(
            matches!(refused, Err(LeanError::Length { .. })),
            "{refused:?}"
        );
    }
    let longer = [&bytes[..], &[0; 4]].concat();
    assert!(lean.restore(&longer, &mut back).is_err());
    // 12 rows; of the last four nothing follows.
    let mut marked = bytes.clone();
    marked[1] |= 1;
    assert_eq!(lean.restore(&marked, &mut back), Err(LeanError::Row(8)));
    let mut behind = bytes;
    behind[3] |= 1 << 4;
    assert_eq!(lean.restore(&behind, &mut back), Err(LeanError::Row(12)));
}

proptest! {
    #[test]
    fn no_bytes_make_it_panic(bytes in proptest::collection::vec(any::<u8>(), 0..9000)) {
        let lean = lean(2, 2);
        let mut back = vec![0.0; lean.layout().len()];
        let _ = lean.restore(&bytes, &mut back);
    }

    #[test]
    fn flipped_marks_change_lengths_or_are_refused(at in 0usize..4, bit in 0u8..8) {
        let lean = lean(4, 3);
        let numbers = rollout(&lean, &[]);
        let mut bytes = lean.strip(&numbers);
        bytes[at] ^= 1 << bit;
        let mut back = vec![0.0; numbers.len()];
        prop_assert!(lean.restore(&bytes, &mut back).is_err());
    }
}

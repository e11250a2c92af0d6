//! Hostile input: whatever comes from files and messages is refused with one clear error, without a
//! panic and without memory that the input does not need.
//!
//! The short form runs with all other tests; `AMPCO_FUZZ_CASES=200000` makes each of the kinds of input
//! that long, and `AMPCO_FUZZ_SEED=7` draws others. What fails is shrunk to the smallest that fails.

#![allow(missing_docs)]

mod configuration;
mod damage;
mod messages;
mod motions;
mod saved;

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Once;

use proptest::strategy::Strategy;
use proptest::test_runner::{Config, RngAlgorithm, TestCaseError, TestRng, TestRunner};

/// Address space of this process: what asks for more was asked to by its input.
const MOST_BYTES: u64 = 8 << 30;

/// Tries a property on many inputs, `short` of them unless the environment asks for another number. A
/// panic is a failure like any other, so that its input is shrunk and shown.
fn always<S: Strategy>(short: u32, inputs: &S, property: impl Fn(S::Value)) {
    static LIMITED: Once = Once::new();
    LIMITED.call_once(limit_memory);
    let number = |name: &str| std::env::var(name).ok()?.parse::<u32>().ok();
    let config = Config {
        cases: number("AMPCO_FUZZ_CASES").unwrap_or(short),
        failure_persistence: None,
        ..Config::default()
    };
    let seed = number("AMPCO_FUZZ_SEED").unwrap_or(1);
    let mut key = [0; 32];
    key[..4].copy_from_slice(&seed.to_le_bytes());
    let generator = TestRng::from_seed(RngAlgorithm::ChaCha, &key);
    let mut runner = TestRunner::new_with_rng(config, generator);
    let tried = runner.run(inputs, |input| {
        catch_unwind(AssertUnwindSafe(|| property(input))).map_err(|panic| {
            let words = panic
                .downcast_ref::<String>()
                .cloned()
                .or_else(|| panic.downcast_ref::<&str>().map(|&words| words.to_owned()));
            TestCaseError::fail(words.unwrap_or_else(|| "a panic".to_owned()))
        })
    });
    if let Err(failure) = tried {
        panic!("{failure}");
    }
}

fn limit_memory() {
    use rustix::process::{Resource, Rlimit, setrlimit};
    let limit = Rlimit {
        current: Some(MOST_BYTES),
        maximum: Some(MOST_BYTES),
    };
    setrlimit(Resource::As, limit).expect("a lower limit");
}

/// Longest error: half of it is what a parser may quote, the rest paths and remedies.
const LONGEST: usize = 2 * wording::SAID;

/// One clear error: said in one line that names something, is not a screen long and moves no cursor.
fn assert_clear(error: &(dyn std::error::Error + 'static)) {
    let words = error.to_string();
    assert!(words.len() > 8, "{words:?} says nothing");
    let length = words.chars().count();
    assert!(
        length < LONGEST,
        "{length} characters of error: {words:.2000}"
    );
    assert!(!words.contains(char::is_control), "{words:?}");
}

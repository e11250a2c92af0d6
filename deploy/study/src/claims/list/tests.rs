//! Verdicts over made-up results.

use super::*;
use crate::results::sample;

// Final values of seven seeds of two methods, all of one below all of the other: p = 2/128, twice that by Holm of two.
const LOW: [f64; 7] = [1.0, 1.1, 1.2, 1.05, 1.15, 1.12, 1.08];
const HIGH: [f64; 7] = [2.0, 2.1, 2.3, 2.2, 2.4, 2.5, 2.6];

fn verdict(results: &Results, part: &str) -> Claim {
    let claims = all(results);
    let found = claims.into_iter().find(|claim| claim.text.contains(part));
    found.expect("a claim with these words")
}

#[test]
fn three_seeds_decide_nothing_and_the_report_says_so() {
    let results = sample::results(&[
        ("ampco", &[1.0, 1.1, 1.2]),
        ("amp-0.5", &[2.0, 2.1, 2.3]),
        ("adamimic", &[3.0, 3.1, 3.3]),
    ]);
    let claim = verdict(&results, "70 % less energy");
    assert_eq!(claim.verdict, Verdict::Undecided);
    assert!(
        claim.evidence.contains("too few seeds"),
        "{}",
        claim.evidence
    );
    assert!(claim.evidence.contains("smallest reachable p = 0.25"));
    let claim = verdict(&results, "AMP [w = 0.7]");
    assert!(
        claim.evidence.contains("no finished run of AMP [w = 0.7]"),
        "{}",
        claim.evidence
    );
}

#[test]
fn runs_that_are_too_short_to_be_measured_are_not_called_unfinished() {
    let mut results = sample::results(&[("ampco", &[1.0, 1.1]), ("amp-0.7", &[2.0, 2.1])]);
    let of = |results: &Results| verdict(results, "AMP [w = 0.7]").evidence;
    for run in results.runs.iter_mut().filter(|run| run.entry == "amp-0.7") {
        run.measured = None;
    }
    let short = "no run of AMP [w = 0.7] is long enough to be measured";
    assert!(of(&results).contains(short), "{}", of(&results));
    results.runs.retain(|run| run.entry == "ampco");
    assert!(of(&results).contains("no finished run of AMP [w = 0.7]"));
}

#[test]
fn seven_seeds_on_one_side_support_or_contradict() {
    let (low, high) = (&LOW[..], &HIGH[..]);
    let results = sample::results(&[("ampco", low), ("amp-0.5", high), ("adamimic", high)]);
    let claim = verdict(&results, "70 % less energy");
    assert_eq!(claim.verdict, Verdict::Supported, "{}", claim.evidence);
    for part in [
        "p = 0.01562, n = 7",
        "Holm's p = 0.03125",
        "r = −1.00",
        "median difference",
        "(95 %: ",
    ] {
        assert!(claim.evidence.contains(part), "{}", claim.evidence);
    }
    // The samples' style is a tenth of their error: lower here, which the paper says it is not.
    assert_eq!(
        verdict(&results, "collapses").verdict,
        Verdict::Contradicted
    );
    assert_eq!(
        verdict(&results, "as well as the best").verdict,
        Verdict::Supported
    );
    assert_eq!(
        verdict(&results, "enters Phase II").verdict,
        Verdict::Supported
    );

    let results = sample::results(&[("ampco", high), ("amp-0.5", low), ("adamimic", low)]);
    assert_eq!(
        verdict(&results, "70 % less energy").verdict,
        Verdict::Contradicted
    );
    assert_eq!(
        verdict(&results, "as well as the best").verdict,
        Verdict::Contradicted
    );
}

#[test]
fn runs_that_did_not_reach_phase_two_are_too_short() {
    let (low, high) = (&LOW[..], &HIGH[..]);
    let mut results = sample::results(&[("ampco", low), ("adamimic", high)]);
    results.runs[0].told.switched_at = None;
    let claim = verdict(&results, "as well as the best");
    assert_eq!(claim.verdict, Verdict::Undecided);
    assert!(
        claim
            .evidence
            .contains("1 of 7 runs of AMPCO had not reached Phase II")
    );
    assert_eq!(
        verdict(&results, "enters Phase II").verdict,
        Verdict::Undecided
    );
}

#[test]
fn of_six_seeds_one_contradiction_among_two_does_not_count() {
    let (low, high) = (&LOW[..6], &HIGH[..6]);
    let results = sample::results(&[("ampco", high), ("amp-0.5", low), ("adamimic", low)]);
    let claim = verdict(&results, "70 % less energy");
    assert_eq!(claim.verdict, Verdict::Undecided, "{}", claim.evidence);
    assert!(
        claim.evidence.contains("Holm's p = 0.0625"),
        "{}",
        claim.evidence
    );
    assert!(
        claim.evidence.contains("not by the corrected p"),
        "{}",
        claim.evidence
    );
    // Against one alone nothing is corrected.
    let claim = verdict(&results, "as well as the best");
    assert_eq!(claim.verdict, Verdict::Contradicted);
    assert!(!claim.evidence.contains("Holm"), "{}", claim.evidence);
}

//! One comparison as evidence: what it shows, and whether it may count.

use wording::count;

use super::Verdict;
use crate::compare::{Comparison, LEVEL};
use crate::metric::Metric;
use crate::paper;
use crate::results::{Column, Results, State};

/// A run has settled if it converged within this share of its length.
const SETTLED: f64 = 0.8;

/// A piece of evidence.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Finding {
    pub(super) verdict: Verdict,
    pub(super) words: String,
}

/// Whether `a` is better than `b` in its final value.
pub(super) fn better(results: &Results, a: &str, b: &str, metric: Metric) -> Finding {
    weigh(results, a, b, metric, |comparison| {
        let found = comparison.p() < LEVEL;
        match (found, metric.better(comparison.first, comparison.second)) {
            (true, true) => (Verdict::Supported, ""),
            (true, false) => (Verdict::Contradicted, "it is the other way about"),
            (false, _) => (Verdict::Undecided, "no difference found"),
        }
    })
}

/// Whether `a` is no worse than `b` in its final value.
pub(super) fn alike(results: &Results, a: &str, b: &str, metric: Metric) -> Finding {
    weigh(results, a, b, metric, |comparison| {
        let worse = metric.better(comparison.second, comparison.first);
        if comparison.p() >= LEVEL {
            (Verdict::Supported, "")
        } else if worse {
            (Verdict::Contradicted, "it is worse")
        } else {
            (Verdict::Supported, "it is better")
        }
    })
}

/// Whether the final values of `a` lie closer together than those of `b`.
pub(super) fn steadier(results: &Results, a: &str, b: &str, metric: Metric) -> Finding {
    let deviation = |entry| {
        let spread = results.spread(entry, metric, Column::Last);
        spread.map_or(f64::NAN, |spread| spread.deviation)
    };
    let less = 100.0 * (1.0 - deviation(a) / deviation(b));
    let Some(comparison) = Comparison::of_steadiness(results, a, b, metric) else {
        return missing(results, &[a, b]);
    };
    let words = format!(
        "standard deviation against {}: {} and {} ({} %; {})",
        paper::label(b),
        metric.written(deviation(a)),
        metric.written(deviation(b)),
        signed(-less),
        comparison.words()
    );
    let verdict = match too_little(results, &comparison, &[a, b], metric) {
        Some(reason) => return undecided(words, &reason),
        None if comparison.p() >= LEVEL => Verdict::Undecided,
        None if comparison.first < comparison.second => Verdict::Supported,
        None => Verdict::Contradicted,
    };
    Finding { verdict, words }
}

/// Several findings as one: all must support, one is enough to contradict.
pub(super) fn together(findings: Vec<Finding>) -> Finding {
    let all = |verdict| findings.iter().all(|finding| finding.verdict == verdict);
    let any = |verdict| findings.iter().any(|finding| finding.verdict == verdict);
    let verdict = if findings.is_empty() {
        Verdict::Undecided
    } else if any(Verdict::Contradicted) {
        Verdict::Contradicted
    } else if all(Verdict::Supported) {
        Verdict::Supported
    } else {
        Verdict::Undecided
    };
    let words: Vec<String> = findings.into_iter().map(|finding| finding.words).collect();
    Finding {
        verdict,
        words: words.join(". "),
    }
}

/// A finding that says only why there is none.
pub(super) fn undecided(words: String, reason: &str) -> Finding {
    let words = match words.as_str() {
        "" => reason.to_owned(),
        words => format!("{words}: {reason}"),
    };
    Finding {
        verdict: Verdict::Undecided,
        words,
    }
}

fn weigh(
    results: &Results,
    a: &str,
    b: &str,
    metric: Metric,
    judge: impl Fn(&Comparison) -> (Verdict, &'static str),
) -> Finding {
    let Some(comparison) = Comparison::of(results, a, b, metric, Column::Last) else {
        return missing(results, &[a, b]);
    };
    let words = format!(
        "{} of {} {}, of {} {} ({} %; {})",
        metric.words(),
        paper::label(a),
        metric.written(comparison.first),
        paper::label(b),
        metric.written(comparison.second),
        signed(100.0 * (comparison.first / comparison.second - 1.0)),
        comparison.words()
    );
    if let Some(reason) = too_little(results, &comparison, &[a, b], metric) {
        return undecided(words, &reason);
    }
    let (verdict, remark) = judge(&comparison);
    let words = match remark {
        "" => words,
        remark => format!("{words}: {remark}"),
    };
    Finding { verdict, words }
}

/// Why a comparison cannot count, if it cannot.
fn too_little(
    results: &Results,
    comparison: &Comparison,
    entries: &[&str],
    metric: Metric,
) -> Option<String> {
    if !comparison.can_decide() {
        return Some("too few seeds".to_owned());
    }
    too_short(results, entries, Some(metric))
}

/// Why the runs of these entries are too short for a claim, if they are.
pub(super) fn too_short(
    results: &Results,
    entries: &[&str],
    metric: Option<Metric>,
) -> Option<String> {
    for entry in entries {
        let runs = results.measured(entry).count();
        let has_second = entry.starts_with(paper::AMPCO);
        let before = results
            .measured(entry)
            .filter(|run| run.switched_at().is_none());
        let before = if has_second { before.count() } else { 0 };
        if before > 0 {
            let label = paper::label(entry);
            return Some(format!(
                "too short, {before} of {} of {label} had not reached Phase II",
                count(runs, "run")
            ));
        }
        let moving = |metric| {
            let settled = |run: &&crate::results::Run| {
                run.value(metric, Column::Convergence)
                    .is_some_and(|at| at <= SETTLED * run.target as f64)
            };
            runs - results.measured(entry).filter(settled).count()
        };
        if let Some(moving) = metric.map(moving).filter(|moving| 2 * moving > runs) {
            let label = paper::label(entry);
            return Some(format!(
                "too short, it was still moving in {moving} of {} of {label}",
                count(runs, "run")
            ));
        }
    }
    None
}

/// Which of the entries has no run that counts: none has finished, or those that have are shorter than the window over
/// which they would be measured.
pub(super) fn missing(results: &Results, entries: &[&str]) -> Finding {
    let without: Vec<&str> = entries
        .iter()
        .copied()
        .filter(|entry| results.measured(entry).next().is_none())
        .collect();
    let finished = |entry: &&str| {
        let mut runs = results.runs.iter().filter(|run| run.entry == **entry);
        runs.any(|run| run.state == State::Finished)
    };
    let labels: Vec<&str> = without.iter().map(|entry| paper::label(entry)).collect();
    let reason = match without.as_slice() {
        [] => "no seed that both have finished".to_owned(),
        some if some.iter().all(finished) => {
            format!(
                "no run of {} is long enough to be measured",
                labels.join(" or ")
            )
        }
        _ => format!("no finished run of {}", labels.join(" and ")),
    };
    undecided(String::new(), &reason)
}

/// A rounded percentage with its sign.
pub(super) fn signed(percent: f64) -> String {
    if percent.is_finite() {
        format!("{percent:+.0}").replace('-', "−")
    } else {
        "–".to_owned()
    }
}

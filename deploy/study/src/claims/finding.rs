//! Comparisons as evidence: what they show, and whether they may count.
//!
//! A claim is one comparison or several. That all of several hold is found where each is found by itself, which needs no
//! correction: the chance to find all by chance is no greater than that of one. That one of several is the other way
//! about could be found by chance in any of them, so there the p of Holm counts. Both are told.

use wording::count;

use super::Verdict;
use crate::compare::{Comparison, LEVEL, written};
use crate::holm;
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

/// What is asked of a method against another, by their final values.
#[derive(Clone, Copy, Debug)]
pub(super) struct Question<'a> {
    relation: Relation,
    a: &'a str,
    b: &'a str,
    metric: Metric,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Relation {
    Better,
    Alike,
    Steadier,
}

/// Whether `a` is better than `b`.
pub(super) fn better<'a>(a: &'a str, b: &'a str, metric: Metric) -> Question<'a> {
    Question {
        relation: Relation::Better,
        a,
        b,
        metric,
    }
}

/// Whether `a` is no worse than `b`.
pub(super) fn alike<'a>(a: &'a str, b: &'a str, metric: Metric) -> Question<'a> {
    Question {
        relation: Relation::Alike,
        a,
        b,
        metric,
    }
}

/// Whether the values of `a` lie closer together than those of `b`.
pub(super) fn steadier<'a>(a: &'a str, b: &'a str, metric: Metric) -> Question<'a> {
    Question {
        relation: Relation::Steadier,
        a,
        b,
        metric,
    }
}

/// The answers to several questions as one finding: all must support, one is enough to contradict.
pub(super) fn ask(results: &Results, questions: &[Question<'_>]) -> Finding {
    let compared: Vec<Option<Comparison>> = questions
        .iter()
        .map(|question| question.compare(results))
        .collect();
    let p: Vec<f64> = compared.iter().flatten().map(Comparison::p).collect();
    let several = p.len() > 1;
    let mut corrected = holm::corrected(&p).into_iter();
    let findings = questions
        .iter()
        .zip(&compared)
        .map(|(question, comparison)| match comparison {
            None => missing(results, &[question.a, question.b]),
            Some(comparison) => {
                let corrected = corrected.next().unwrap_or(1.0);
                question.answer(results, comparison, several.then_some(corrected))
            }
        });
    together(findings.collect())
}

impl Question<'_> {
    fn compare(&self, results: &Results) -> Option<Comparison> {
        let (a, b, metric) = (self.a, self.b, self.metric);
        match self.relation {
            Relation::Steadier => Comparison::of_steadiness(results, a, b, metric),
            Relation::Better | Relation::Alike => {
                Comparison::of(results, a, b, metric, Column::Last)
            }
        }
    }

    /// `corrected` is Holm's p where the question is one of several.
    fn answer(
        &self,
        results: &Results,
        comparison: &Comparison,
        corrected: Option<f64>,
    ) -> Finding {
        let words = self.words(results, comparison, corrected);
        if let Some(reason) = too_little(results, comparison, &[self.a, self.b], self.metric) {
            return undecided(words, &reason);
        }
        let found = comparison.p() < LEVEL;
        let against = corrected.unwrap_or(comparison.p()) < LEVEL;
        let first = match self.relation {
            Relation::Steadier => comparison.first < comparison.second,
            _ => self.metric.better(comparison.first, comparison.second),
        };
        let (verdict, remark) = match (self.relation, found, first) {
            (Relation::Alike, false, _) => (Verdict::Supported, ""),
            (Relation::Alike, true, true) => (Verdict::Supported, "it is better"),
            (Relation::Alike, true, false) if against => (Verdict::Contradicted, "it is worse"),
            (_, true, true) => (Verdict::Supported, ""),
            (_, true, false) if against => (Verdict::Contradicted, "it is the other way about"),
            (_, true, false) => (
                Verdict::Undecided,
                "it is the other way about, but not by the corrected p",
            ),
            (_, false, _) => (Verdict::Undecided, "no difference found"),
        };
        let words = match remark {
            "" => words,
            remark => format!("{words}: {remark}"),
        };
        Finding { verdict, words }
    }

    fn words(&self, results: &Results, comparison: &Comparison, corrected: Option<f64>) -> String {
        let metric = self.metric;
        let holm = corrected.map_or_else(String::new, |p| format!("; Holm's p = {}", written(p)));
        if self.relation == Relation::Steadier {
            let deviation = |entry| {
                let spread = results.spread(entry, metric, Column::Last);
                spread.map_or(f64::NAN, |spread| spread.deviation)
            };
            let (a, b) = (deviation(self.a), deviation(self.b));
            return format!(
                "standard deviation against {}: {} and {} ({} %; {}{holm})",
                paper::label(self.b),
                metric.written(a),
                metric.written(b),
                signed(100.0 * (a / b - 1.0)),
                comparison.words()
            );
        }
        format!(
            "{} of {} {}, of {} {} ({} %; {}{holm}; {})",
            metric.words(),
            paper::label(self.a),
            metric.written(comparison.first),
            paper::label(self.b),
            metric.written(comparison.second),
            signed(100.0 * (comparison.first / comparison.second - 1.0)),
            comparison.words(),
            comparison.size(|value| metric.written(value))
        )
    }
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

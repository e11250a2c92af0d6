//! The paper's claims in its order.

use wording::count;

use super::finding::{
    Finding, Question, alike, ask, better, missing, steadier, too_short, undecided,
};
use super::{Claim, Verdict};
use crate::matrix::Entry;
use crate::metric::Metric;
use crate::overhead::Overhead;
use crate::paper::{self, AMPCO, COMPARISON};
use crate::results::{Column, Results};

const AIG: &str = "ampco-without-aig";
const ROGER: &str = "ampco-without-roger";
/// Share of the longest possible that episodes of robots that walk last.
const WALKS: f64 = 0.8;

pub(super) fn all(results: &Results) -> Vec<Claim> {
    let others = || COMPARISON.iter().filter(|method| **method != AMPCO);
    fn against<'a>(
        results: &Results,
        methods: &[&'a str],
        of: impl Fn(&'a str) -> Question<'a>,
    ) -> Finding {
        let questions: Vec<Question<'_>> = methods.iter().map(|method| of(method)).collect();
        ask(results, &questions)
    }
    let others: Vec<&str> = others().copied().collect();
    let claim = |section, text, finding: Finding| Claim {
        section,
        text,
        verdict: finding.verdict,
        evidence: finding.words,
    };
    let mut claims = vec![
        claim(
            "Abstract",
            "AMPCO's energy varies 67 to 90 % less over seeds than that of every baseline.",
            against(results, &others, |other| {
                steadier(AMPCO, other, Metric::Energy)
            }),
        ),
        claim(
            "Abstract, IV-A",
            "AMPCO takes about 70 % less energy than the task-focused baselines, AMP [w = 0.5] and AdaMimic.",
            against(results, &["amp-0.5", "adamimic"], |other| {
                better(AMPCO, other, Metric::Energy)
            }),
        ),
        claim(
            "IV-A",
            "AMPCO tracks the velocity as well as the best, AdaMimic (0.288 against 0.280 m/s, p = 0.77).",
            ask(results, &[alike(AMPCO, "adamimic", Metric::Rmse)]),
        ),
        claim(
            "IV-A",
            "AMPCO tracks better than the energy-efficient baselines, AMP [w = 0.7] and AMP [w = 0.8].",
            against(results, &["amp-0.7", "amp-0.8"], |other| {
                better(AMPCO, other, Metric::Rmse)
            }),
        ),
        claim(
            "IV-A",
            "AMPCO's final discriminator reward is the highest of all (p < 0.05 against each baseline).",
            against(results, &others, |other| {
                better(AMPCO, other, Metric::Style)
            }),
        ),
        claim(
            "IV-A",
            "AdaMimic's discriminator reward collapses (0.008, a fortieth of AMPCO's).",
            collapse(results),
        ),
        claim(
            "IV-A",
            "AMPCO's coefficient of variation is the lowest: below 7.2 % in energy, 6 % in tracking.",
            variation(results, &others),
        ),
        claim(
            "IV-B",
            "Without AIG the tracking is the same (p = 0.28) but the energy 154 % higher.",
            ask(
                results,
                &[
                    alike(AMPCO, AIG, Metric::Rmse),
                    better(AMPCO, AIG, Metric::Energy),
                ],
            ),
        ),
        claim(
            "IV-B",
            "Without ROGER energy is lowest and the discriminator reward highest, but tracking 25 % worse.",
            ask(
                results,
                &[
                    better(ROGER, AMPCO, Metric::Energy),
                    better(ROGER, AMPCO, Metric::Style),
                    better(AMPCO, ROGER, Metric::Rmse),
                ],
            ),
        ),
        claim(
            "IV-B",
            "The discriminator reward converges soonest with AMPCO (2.1k against 3.1k and 4.4k iterations).",
            convergence(results),
        ),
        claim(
            "IV-A",
            "AMPCO finds the end of imitation by itself and enters Phase II (around iteration 2,500 of 20,000).",
            switch(results),
        ),
        claim(
            "II-B",
            "Scheduling adds less than 0.012 % to a training cycle.",
            overhead(results),
        ),
    ];
    let of_table_two = |entry: &Entry| entry.values.iter().any(is_of_table_two);
    if results.entries.iter().any(of_table_two) {
        claims.push(claim(
            "III-C",
            "All settings of α and p take statistically equivalent energy (p > 0.05).",
            sensitivity(results),
        ));
    }
    claims
}

fn collapse(results: &Results) -> Finding {
    let mean = |entry| {
        let spread = results.spread(entry, Metric::Style, Column::Last);
        spread.map(|spread| spread.mean)
    };
    let (Some(theirs), Some(ours)) = (mean("adamimic"), mean(AMPCO)) else {
        return missing(results, &["adamimic", AMPCO]);
    };
    let found = ask(results, &[better(AMPCO, "adamimic", Metric::Style)]);
    let collapsed = theirs < 0.1 * ours;
    match (found.verdict, collapsed) {
        // A style reward that is merely lower has not collapsed.
        (Verdict::Supported, false) => Finding {
            verdict: Verdict::Contradicted,
            words: format!("{}; lower, but no collapse", found.words),
        },
        _ => found,
    }
}

fn variation(results: &Results, others: &[&str]) -> Finding {
    let of = |entry, metric| {
        let spread = results.spread(entry, metric, Column::Last);
        spread.map_or(f64::NAN, |spread| 100.0 * spread.variation())
    };
    if results.measured(AMPCO).count() < 2 {
        return undecided(String::new(), "fewer than two finished runs of AMPCO");
    }
    let words = [Metric::Energy, Metric::Rmse].map(|metric| {
        let rest: Vec<String> = others
            .iter()
            .filter(|other| results.measured(other).count() > 1)
            .map(|other| format!("{} {:.1}", paper::label(other), of(other, metric)))
            .collect();
        let words = metric.words();
        format!(
            "{words}: AMPCO {:.1} %, {}",
            of(AMPCO, metric),
            rest.join(", ")
        )
    });
    let steadiness = |metric| {
        let each: Vec<Question<'_>> = others
            .iter()
            .map(|other| steadier(AMPCO, other, metric))
            .collect();
        ask(results, &each).verdict
    };
    let verdicts = [steadiness(Metric::Energy), steadiness(Metric::Rmse)];
    let small = of(AMPCO, Metric::Energy) < 7.2 && of(AMPCO, Metric::Rmse) < 6.0;
    let verdict = if verdicts.contains(&Verdict::Contradicted) {
        Verdict::Contradicted
    } else if verdicts == [Verdict::Supported; 2] {
        if small {
            Verdict::Supported
        } else {
            Verdict::Contradicted
        }
    } else {
        Verdict::Undecided
    };
    let reason = if verdict == Verdict::Undecided {
        "; too few seeds, too short runs, or no difference found (see the claim on energy's variance)"
    } else {
        ""
    };
    Finding {
        verdict,
        words: format!("{}{reason}", words.join("; ")),
    }
}

fn convergence(results: &Results) -> Finding {
    let at = |entry| results.spread(entry, Metric::Style, Column::Convergence);
    let (Some(ours), Some(aig), Some(roger)) = (at(AMPCO), at(AIG), at(ROGER)) else {
        let all = [AMPCO, AIG, ROGER];
        let lacking = all
            .iter()
            .any(|entry| results.measured(entry).next().is_none());
        return match lacking {
            true => missing(results, &all),
            false => undecided(String::new(), "some method did not converge in any run"),
        };
    };
    let words = format!(
        "converged at iteration {:.0} (AMPCO), {:.0} (w/o AIG), {:.0} (w/o ROGER)",
        ours.mean, aig.mean, roger.mean
    );
    if let Some(reason) = too_short(results, &[AMPCO, AIG, ROGER], None) {
        return undecided(words, &reason);
    }
    let compare = |other| {
        crate::compare::Comparison::of(results, AMPCO, other, Metric::Style, Column::Convergence)
    };
    let (Some(first), Some(second)) = (compare(AIG), compare(ROGER)) else {
        return undecided(words, "no seed that all have finished");
    };
    let words = format!("{words}; {} and {}", first.words(), second.words());
    let found = |comparison: &crate::compare::Comparison| comparison.p() < crate::compare::LEVEL;
    let sooner = |comparison: &crate::compare::Comparison| comparison.first < comparison.second;
    let verdict = match [&first, &second] {
        both if both.iter().all(|c| found(c) && sooner(c)) => Verdict::Supported,
        both if both.iter().any(|c| found(c) && !sooner(c)) => Verdict::Contradicted,
        _ => Verdict::Undecided,
    };
    Finding { verdict, words }
}

fn switch(results: &Results) -> Finding {
    let runs: Vec<_> = results.measured(AMPCO).collect();
    let at: Vec<f64> = runs
        .iter()
        .filter_map(|run| run.switched_at().map(|at| at as f64))
        .collect();
    let Some(first) = runs.first() else {
        return missing(results, &[AMPCO]);
    };
    let mut words = format!(
        "{} of {} entered Phase II",
        at.len(),
        count(runs.len(), "run")
    );
    if !at.is_empty() {
        let mean = at.iter().sum::<f64>() / at.len() as f64;
        words.push_str(&format!(
            ", at iteration {mean:.0} of {} on the mean",
            first.target
        ));
    }
    let walked = runs
        .iter()
        .filter_map(|run| run.told.episode_share_at_switch);
    let walked: Vec<f64> = walked.collect();
    if !walked.is_empty() {
        let long = walked.iter().filter(|share| **share >= WALKS).count();
        words.push_str(&format!(
            "; in {long} of these {} episodes then lasted {:.0} % of the longest possible or more",
            walked.len(),
            100.0 * WALKS
        ));
    }
    if at.len() == runs.len() {
        return Finding {
            verdict: Verdict::Supported,
            words,
        };
    }
    let short = first.target < paper::ITERATIONS;
    let reason = if short { "too short to tell" } else { "" };
    let found = undecided(words, reason);
    Finding {
        verdict: if short {
            Verdict::Undecided
        } else {
            Verdict::Contradicted
        },
        ..found
    }
}

fn overhead(results: &Results) -> Finding {
    let measured: Vec<Overhead> = results
        .runs
        .iter()
        .filter_map(|run| run.told.overhead)
        .collect();
    if measured.is_empty() {
        return undecided(String::new(), "no run has recorded it");
    }
    let greatest = |share: fn(&Overhead) -> f64| measured.iter().map(share).fold(0.0, f64::max);
    let (decision, weighting) = (
        greatest(|overhead| overhead.decision_share),
        greatest(|overhead| overhead.weighting_share),
    );
    let within =
        greatest(|overhead| overhead.decision_share + overhead.weighting_share) < paper::SHARE;
    Finding {
        verdict: if within {
            Verdict::Supported
        } else {
            Verdict::Contradicted
        },
        words: format!(
            "over {} at most {:.5} % of a cycle (medians) for the scheduler's decision and {:.5} % for weighting in the learner",
            count(measured.len(), "run"),
            100.0 * decision,
            100.0 * weighting
        ),
    }
}

fn sensitivity(results: &Results) -> Finding {
    let swept: Vec<&str> = results
        .entries
        .iter()
        .filter(|entry| !entry.values.is_empty() && entry.values.iter().all(is_of_table_two))
        .map(|entry| entry.name.as_str())
        .collect();
    let Some(usual) = swept
        .iter()
        .find(|name| is_usual(results, name))
        .or(swept.first())
    else {
        return undecided(String::new(), "nothing was varied");
    };
    let rest = swept.iter().filter(|name| *name != usual);
    let questions: Vec<Question<'_>> = rest
        .map(|name| alike(usual, name, Metric::Energy))
        .collect();
    ask(results, &questions)
}

/// Whether a swept value is of α or p.
fn is_of_table_two((key, _): &(String, toml::Value)) -> bool {
    ["scheduler.alpha", "scheduler.percentile"].contains(&key.as_str())
}

/// Whether a setting is the paper's: every swept value 0.95.
fn is_usual(results: &Results, name: &str) -> bool {
    let entry = results.entries.iter().find(|entry| entry.name == name);
    entry.is_some_and(|entry| {
        let usual = |value: &toml::Value| value.as_float() == Some(0.95);
        entry.values.iter().all(|(_, value)| usual(value))
    })
}

#[cfg(test)]
mod tests;

//! The findings in plain words: what holds, what does not, what may be behind it, what to choose. Every sentence is made of
//! numbers of the runs, and stands only where they give it.

use super::gait;
use super::html::escape;
use crate::claims::{Claim, Verdict};
use crate::compare::{Comparison, LEVEL};
use crate::gait::{ENERGY, ERROR, Measure, STRIDES_OFF, STYLE};
use crate::metric::Metric;
use crate::paper::{self, AMPCO};
use crate::results::{Column, Results, Run};
use crate::statistics::{Spread, median, rank_correlation};

/// rˢ that a perfect imitation earns (Eq. 7): the discriminator cannot tell it from the reference.
const PERFECT: f64 = 0.75;

pub(super) fn reading(results: &Results, claims: &[Claim]) -> String {
    let paragraphs = [
        holds(
            claims,
            Verdict::Supported,
            "What the paper says and these runs bear out",
        ),
        holds(claims, Verdict::Contradicted, "What they speak against"),
        why(results),
        choice(results),
    ];
    let paragraphs = paragraphs
        .into_iter()
        .filter(|paragraph| !paragraph.is_empty());
    let html: String = paragraphs
        .map(|text| format!("<p>{}</p>\n", escape(&text)))
        .collect();
    match html.as_str() {
        "" => html,
        _ => format!("<h2>In plain words</h2>\n{html}"),
    }
}

fn holds(claims: &[Claim], verdict: Verdict, title: &str) -> String {
    let texts: Vec<&str> = claims
        .iter()
        .filter(|claim| claim.verdict == verdict)
        .map(|claim| claim.text)
        .collect();
    match texts.as_slice() {
        [] => String::new(),
        texts => format!("{title}: {}", texts.join(" ")),
    }
}

/// What may be behind the outcome.
fn why(results: &Results) -> String {
    let sentences = [bounds(results), rewards(results), noise(results)];
    let said: Vec<String> = sentences.into_iter().flatten().collect();
    match said.as_slice() {
        [] => String::new(),
        said => format!("Why that may be. {}", said.join(" ")),
    }
}

/// Bounds that the reward cannot reach bind nothing.
fn bounds(results: &Results) -> Option<String> {
    let bounds: Vec<(f64, f64)> = results
        .measured(AMPCO)
        .filter_map(|run| run.told.lower_bound.zip(run.told.upper_bound))
        .collect();
    let (lower, upper): (Vec<f64>, Vec<f64>) = bounds.iter().copied().unzip();
    let beyond = bounds
        .iter()
        .filter(|(lower, upper)| *lower <= 0.0 || *upper >= PERFECT)
        .count();
    (!bounds.is_empty()).then(|| {
        format!(
            "The bounds of AMPCO's Phase II are {} to {} (medians); in {beyond} of {} one of them is beyond what a \
             style reward can be (0 at the least, and {PERFECT} where motion cannot be told from the reference), and there \
             Eq. 12 never gives one of the two rewards all of the weight.",
            signed(median(&lower)),
            signed(median(&upper)),
            wording::count(bounds.len(), "run")
        )
    })
}

/// Whether the rewards of the runs' own discriminators agree with those of one that is the same for all.
fn rewards(results: &Results) -> Option<String> {
    results.file.evaluate.as_ref()?.judge.as_ref()?;
    let pair = |run: &Run| Some((run.value(Metric::Style, Column::Last)?, STYLE.of_run(run)?));
    let pairs: Vec<(f64, f64)> = results.runs.iter().filter_map(pair).collect();
    let agreement = rank_correlation(&pairs)?;
    let reading = if agreement < 0.5 {
        "what one run's discriminator gives says little of another's motion"
    } else {
        "the two mostly agree on who moves better"
    };
    Some(format!(
        "Each run is paid by its own discriminator; over {} its final reward and that of one frozen judge have a rank \
         correlation of {}: {reading}.",
        wording::count(pairs.len(), "run"),
        signed(agreement)
    ))
}

/// How much of the energy of training is exploration's.
fn noise(results: &Results) -> Option<String> {
    let ratio = |run: &Run| Some(run.value(Metric::Energy, Column::Last)? / ENERGY.of_run(run)?);
    let ratios: Vec<f64> = results
        .runs
        .iter()
        .filter_map(ratio)
        .filter(|r| r.is_finite())
        .collect();
    (!ratios.is_empty()).then(|| {
        format!(
            "The energy of training holds what exploration costs: it is {:.2} times that of the same policies without noise \
             (median of {}).",
            median(&ratios),
            wording::count(ratios.len(), "run")
        )
    })
}

/// Who is best in what.
fn choice(results: &Results) -> String {
    let aims: [(&str, Measure, bool); 4] = [
        ("tracks best", ERROR, false),
        ("takes the least energy", ENERGY, false),
        ("strides most like the reference", STRIDES_OFF, false),
        ("has most style", STYLE, true),
    ];
    let said: Vec<String> = aims
        .iter()
        .filter_map(|(what, measure, most)| best(results, what, measure, *most))
        .collect();
    if said.is_empty() {
        return String::new();
    }
    format!(
        "What to choose, by the mean of each without noise. {} {}",
        said.join(" "),
        gait::sentence(results)
    )
}

fn best(results: &Results, what: &str, measure: &Measure, most: bool) -> Option<String> {
    let mean = |entry: &str| Spread::of(&measure.values(results, entry)).map(|spread| spread.mean);
    let mut means: Vec<(f64, &str)> = results
        .entries
        .iter()
        .filter_map(|entry| Some((mean(&entry.name)?, entry.name.as_str())))
        .collect();
    means.sort_by(|a, b| a.0.total_cmp(&b.0));
    if most {
        means.reverse();
    }
    let (value, first) = *means.first()?;
    if means.len() < 2 {
        return None;
    }
    let second = if first == AMPCO {
        means[1]
    } else {
        *means.iter().find(|(_, entry)| *entry == AMPCO)?
    };
    let told = Comparison::of_pairs(&measure.paired(results, first, second.1))
        .is_some_and(|comparison| comparison.p() < LEVEL);
    let other = format!("{} {}", paper::label(second.1), measure.written(second.0));
    let remark = if told {
        "found by the exact test"
    } else {
        "not to be told apart"
    };
    Some(format!(
        "{} {what} ({}; {other}, {remark}).",
        paper::label(first),
        measure.written(value)
    ))
}

/// Two digits, and a minus sign that is one.
fn signed(value: f64) -> String {
    format!("{value:.2}").replace('-', "−")
}

//! The report of a study: one page that needs nothing beside it, and the same numbers as CSV and SVG.
//!
//! Every number is a mean over runs that the page names and links to, or stands in the row of one run.

mod csv;
mod curves;
mod figures;
mod gait;
mod html;
mod overhead;
mod page;
mod reading;
mod runs;
mod tables;

use crate::results::Results;

pub use curves::{Point, curve};

/// A file of the report: its name and its text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct File {
    /// Without folder.
    pub name: &'static str,
    /// All of it.
    pub text: String,
}

/// All files; `report.html` is the one to open.
pub fn files(results: &Results) -> Vec<File> {
    let file = |name, text| File { name, text };
    let drawn = figures::all(results);
    let mut files = vec![
        file("report.html", page::page(results, &drawn)),
        file("runs.csv", csv::runs(results)),
        file("methods.csv", csv::methods(results)),
        file("tests.csv", csv::tests(results)),
        file("claims.csv", csv::claims(results)),
        file("curves.csv", csv::curves(results)),
    ];
    files.extend(
        drawn
            .into_iter()
            .map(|figure| file(figure.name, figure.svg)),
    );
    files
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::results::{State, sample};
    use crate::{Judged, Told};

    fn text(files: &[File], name: &str) -> String {
        let file = files.iter().find(|file| file.name == name);
        file.expect("a file of this name").text.clone()
    }

    /// Columns that a row of HTML has.
    fn columns(row: &str) -> usize {
        let cells = row.split("<t").skip(1);
        cells
            .filter(|cell| {
                cell.starts_with('d') || cell.starts_with("h ") || cell.starts_with("h>")
            })
            .map(|cell| match cell.split_once("colspan=") {
                Some((_, span)) => span[..1].parse().unwrap(),
                None => 1,
            })
            .sum()
    }

    #[test]
    fn every_number_has_a_heading_of_its_own() {
        let mut results = sample::results(&[
            ("ampco", &[1.0, 1.2]),
            ("amp-0.5", &[2.0, 2.4]),
            ("ampco-without-aig", &[3.0, 3.2]),
            ("mine", &[3.0, 3.2]),
        ]);
        results.runs[0].judged.push(Judged {
            command: [0.0, 0.0, 1.0],
            survival: 1.0,
            rmse: 0.25,
            rmse_yaw_rate: 0.875,
            energy_j: 1_000.0,
            gait: "still: 0.13 of 1.00 rad/s".to_owned(),
            ..Judged::default()
        });
        let files = files(&results);
        let page = text(&files, "report.html");
        let mut found = 0;
        for table in page.split("<table>").skip(1) {
            let table = table.split("</table>").next().unwrap();
            let (head, body) = table.split_once("</thead>").unwrap();
            // In a head of two rows the second divides cells of the first.
            let Some(first) = head.split("<tr>").nth(1) else {
                continue;
            };
            let expected = columns(first);
            for row in body.split("<tr>").skip(1) {
                assert_eq!(columns(row), expected, "{head}\n{row}");
                found += 1;
            }
        }
        assert!(found > 20, "{found} rows");
        assert!(page.contains("0.875") && page.contains("of the yaw rate, rad/s"));
        for file in files.iter().filter(|file| file.name.ends_with(".csv")) {
            let cells = |line: &str| {
                // Commas within quotes divide nothing.
                let outside = line.split('"').step_by(2);
                outside.map(|part| part.matches(',').count()).sum::<usize>()
            };
            let mut lines = file.text.lines();
            let heading = lines.next().unwrap();
            for line in lines {
                assert_eq!(cells(line), cells(heading), "{}: {line}", file.name);
            }
        }
    }

    #[test]
    fn a_report_holds_tables_figures_claims_and_what_failed() {
        let mut results = sample::results(&[
            ("ampco", &[1.0, 1.2]),
            ("amp-0.5", &[2.0, 2.4]),
            ("ampco-without-aig", &[3.0, 3.2]),
        ]);
        results.runs[3].measured = None;
        results.runs[3].state = State::Failed("no <memory>".to_owned());
        let files = files(&results);
        let page = text(&files, "report.html");
        for part in [
            "a &lt;study&gt;",
            "Table III",
            "Table IV",
            "1.100 ± 0.141", // 1.0 and 1.2
            "0.288 ± 0.017", // the paper's
            "href=\"../records/ampco-seed1.json\"",
            "no &lt;memory&gt;",
            "smallest reachable p = 0.5",
            "undecided",
            "<svg",
        ] {
            assert!(page.contains(part), "{part}");
        }
        // Self-contained: no address outside but the names that SVG must declare.
        let outside = page.replace("http://www.w3.org/2000/svg", "");
        assert!(!outside.contains("http") && !outside.contains("<script"));
        assert!(text(&files, "figure3.svg").contains("Phase II"));
        let rows = text(&files, "runs.csv");
        assert_eq!(rows.lines().count(), 1 + 6);
        assert!(rows.contains("ampco-seed1,ampco,1,finished,200,"));
    }

    #[test]
    fn plain_words_are_made_of_what_was_found() {
        let values =
            |from: f64| -> Vec<f64> { (0..6).map(|i| from + 0.1 * f64::from(i)).collect() };
        let (ours, theirs) = (values(1.0), values(3.0));
        let mut results = sample::results(&[("ampco", &ours), ("amp-0.5", &theirs)]);
        results.file.evaluate = Some(crate::Evaluation {
            commands: vec![[0.5, 0.0, 0.0]],
            episodes: 1,
            seconds: 1.0,
            judge: Some("walk".into()),
        });
        for run in &mut results.runs {
            let value = run.measured.unwrap().figures(crate::Metric::Rmse).last;
            run.judged = vec![Judged {
                rmse: value / 10.0,
                energy_j: 500.0 * value, // half of what training took
                stride_rate_hz: Some(1.0 + value),
                reference: Some(crate::judged::Reference {
                    stride_rate_hz: 1.0,
                }),
                style_reward: Some(1.0 - value / 10.0), // the other way about than their own
                ..Judged::default()
            }];
            (run.told.lower_bound, run.told.upper_bound) = (Some(-0.5), Some(1.25));
        }
        let page = text(&files(&results), "report.html");
        for part in [
            "In plain words",
            "−0.50 to 1.25",
            "in 6 of 6 runs one of them is beyond",
            "rank correlation of −1.00",
            "2.00 times that of the same policies without noise",
            "AMPCO tracks best (0.125; AMP [w = 0.5] 0.325, found by the exact test)",
            "no method is better than AMPCO in all three at once",
            "Holm&#39;s p = 0.03125",
        ] {
            assert!(
                page.replace("Holm's", "Holm&#39;s").contains(part),
                "{part}: {page:.9000}"
            );
        }
        // The other way about, the other sentence.
        for run in &mut results.runs {
            run.entry = if run.entry == "ampco" {
                "amp-0.5"
            } else {
                "ampco"
            }
            .to_owned();
        }
        let page = text(&files(&results), "report.html");
        assert!(
            page.contains(
                "better than AMPCO in all three at once: AMP [w = 0.5] (0.125, 625, 1.25)"
            )
        );
    }

    #[test]
    fn a_study_without_a_finished_run_is_reported_all_the_same() {
        let mut results = sample::results(&[("ampco", &[1.0])]);
        results.runs[0].measured = None;
        results.runs[0].state = State::Missing;
        results.runs[0].told = Told::default();
        let page = text(&files(&results), "report.html");
        assert!(page.contains("not begun") && page.contains("no finished run of AMPCO"));
    }
}

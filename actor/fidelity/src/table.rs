//! The table: a row per number, a column per engine.
//!
//! Separate because people read it and nothing else does.

use crate::measure::Row;
use std::fmt::Write;

/// A Markdown table of the rows of several engines.
pub fn markdown(engines: &[(&str, Vec<Row>)]) -> String {
    let mut out = String::from("| case |");
    for (name, _) in engines {
        let _ = write!(out, " {name} |");
    }
    out.push_str("\n| --- |");
    out.push_str(&" --- |".repeat(engines.len()));
    let rows = engines.first().map_or(0, |(_, rows)| rows.len());
    for i in 0..rows {
        let row = &engines[0].1[i];
        let _ = write!(out, "\n| {}, {} |", row.name, row.unit);
        for (_, rows) in engines {
            match rows[i].value {
                Some(value) => {
                    let _ = write!(out, " {} |", number(value));
                }
                None => out.push_str(" – |"),
            }
        }
    }
    out
}

/// Three figures, more only before the point.
fn number(value: f64) -> String {
    if value == 0.0 {
        return "0".into();
    }
    let places = (2 - value.abs().log10().floor() as i32).clamp(0, 6) as usize;
    format!("{value:.places$}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_column_per_engine() {
        let row = |value| Row {
            name: "drop: height".into(),
            unit: "mm",
            value,
            judged: true,
        };
        let table = markdown(&[("a", vec![row(Some(1.234_5))]), ("b", vec![row(None)])]);
        assert_eq!(
            table,
            "| case | a | b |\n| --- | --- | --- |\n| drop: height, mm | 1.23 | – |"
        );
        assert_eq!(number(314.97), "315");
        assert_eq!(number(0.002_345), "0.00234");
    }
}

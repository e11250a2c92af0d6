//! What one who watches sees: a line or two rewritten in place on a terminal, else a plain line
//! every few seconds, and messages that stay.
//!
//! Everything goes to standard error; standard output is for results.

use std::io::{IsTerminal, Stderr, Write};
use std::time::{Duration, Instant};

/// Between two plain lines.
const EVERY: Duration = Duration::from_secs(5);

/// What stands between two figures of a line.
pub(crate) const BETWEEN: &str = " · ";

/// Says something where no line is rewritten in place.
pub(crate) fn say(message: &str) {
    // Whoever watched may have closed the terminal.
    let _ = writeln!(std::io::stderr(), "{message}");
}

#[derive(Debug)]
pub(crate) struct Console {
    out: Stderr,
    terminal: bool,
    /// The line in place, to be written again under a message.
    shown: String,
    /// How many rows of the terminal it takes.
    rows: usize,
    last_plain: Option<Instant>,
}

impl Console {
    pub(crate) fn new() -> Self {
        let out = std::io::stderr();
        let terminal = out.is_terminal();
        Self {
            out,
            terminal,
            shown: String::new(),
            rows: 0,
            last_plain: None,
        }
    }

    /// Shows the present state: in place on a terminal, else once in a while and only if it changed.
    pub(crate) fn show(&mut self, line: &str, now: Instant) {
        if self.terminal {
            line.clone_into(&mut self.shown);
            self.rewrite("");
        } else if line != self.shown && self.last_plain.is_none_or(|last| now - last >= EVERY) {
            line.clone_into(&mut self.shown);
            self.last_plain = Some(now);
            self.write(&format!("{line}\n"));
        }
    }

    /// Says something that stays.
    pub(crate) fn say(&mut self, message: &str) {
        if self.terminal {
            self.rewrite(&format!("{message}\n"));
        } else {
            self.write(&format!("{message}\n"));
        }
    }

    /// Leaves the last state standing and begins a line of its own for what follows.
    pub(crate) fn finish(&mut self) {
        if self.rows > 0 {
            self.write("\n");
        }
        self.rows = 0;
        self.shown.clear();
    }

    /// Writes `above` where the state stood, and the state anew below it.
    fn rewrite(&mut self, above: &str) {
        let rows = wrapped(&self.shown, self.width());
        let up = match self.rows.saturating_sub(1) {
            0 => String::new(),
            up => format!("\x1b[{up}A"),
        };
        self.write(&format!("\r{up}\x1b[J{above}{}", rows.join("\n")));
        self.rows = rows.len();
    }

    fn width(&self) -> usize {
        let size = rustix::termios::tcgetwinsize(&self.out);
        let columns = size.map_or(0, |size| usize::from(size.ws_col));
        if columns == 0 { 80 } else { columns }
    }

    fn write(&mut self, text: &str) {
        // Training goes on when whoever watched has closed the terminal.
        let _ = self.out.write_all(text.as_bytes());
        let _ = self.out.flush();
    }
}

/// A line broken between its figures into rows that fit: the terminal must break none itself, or the
/// rows could not be counted and rewritten.
fn wrapped(line: &str, columns: usize) -> Vec<String> {
    let fits = columns.saturating_sub(1);
    let mut rows: Vec<String> = Vec::new();
    for figure in line.split(BETWEEN).filter(|figure| !figure.is_empty()) {
        let figure: String = figure.chars().take(fits).collect();
        match rows.last_mut() {
            Some(row) if length(row) + length(BETWEEN) + length(&figure) <= fits => {
                row.push_str(BETWEEN);
                row.push_str(&figure);
            }
            _ => rows.push(figure),
        }
    }
    rows
}

fn length(text: &str) -> usize {
    text.chars().count()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_is_broken_between_figures_by_letters_and_not_by_bytes() {
        // "one · two" has nine letters, eleven bytes; the last column stays free.
        assert_eq!(wrapped("one · two · three", 10), ["one · two", "three"]);
        assert_eq!(wrapped("one · two · three", 9), ["one", "two", "three"]);
        assert_eq!(wrapped("one · two · three", 80), ["one · two · three"]);
        assert_eq!(wrapped("", 80), [""; 0]);
    }

    #[test]
    fn a_figure_wider_than_the_terminal_is_cut() {
        assert_eq!(wrapped("abcdefgh · x", 5), ["abcd", "x"]);
    }
}

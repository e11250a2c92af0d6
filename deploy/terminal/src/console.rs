//! What one who watches sees: a line or two rewritten in place on a terminal, else a plain line
//! every few seconds, and messages that stay.
//!
//! Everything goes to standard error; standard output is for [`Results`].

use std::io::{self, IsTerminal, Stderr, StdoutLock, Write};
use std::time::{Duration, Instant};

use anyhow::{Context, Result};
use wording::harmless;

/// Between two plain lines.
const EVERY: Duration = Duration::from_secs(5);

/// What stands between two figures of a line.
pub const BETWEEN: &str = " · ";

/// Says something where no line is rewritten in place.
pub fn say(message: &str) {
    // Whoever watched may have closed the terminal.
    let _ = writeln!(io::stderr(), "{}", harmless(message));
}

/// Standard output. Who reads it may have seen enough, as `head` has after ten lines: the rest is dropped, and what a
/// command writes elsewhere is written all the same. Any other refusal, as of a full disk, is an error.
#[derive(Debug)]
pub struct Results<W = StdoutLock<'static>>(W);

/// Where a command writes what it was asked for.
pub fn results() -> Results {
    Results(io::stdout().lock())
}

/// Prints the whole of a result, which ends in a line break.
pub fn print(result: &str) -> Result<()> {
    let mut out = results();
    out.write_all(result.as_bytes())
        .and_then(|()| out.flush())
        .context("writing to standard output")
}

/// Hands on what is still held back; called once, at the end.
pub fn finish_results() -> Result<()> {
    results().flush().context("writing to standard output")
}

impl<W: Write> Write for Results<W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        unless_gone(self.0.write(bytes), bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        unless_gone(self.0.flush(), ())
    }
}

/// What came of writing, or `enough` where nobody reads any more.
fn unless_gone<T>(written: io::Result<T>, enough: T) -> io::Result<T> {
    match written {
        Err(error) if error.kind() == io::ErrorKind::BrokenPipe => Ok(enough),
        written => written,
    }
}

/// A line on standard error that is rewritten in place, and messages above it.
#[derive(Debug)]
pub struct Console {
    out: Stderr,
    terminal: bool,
    /// The line in place, to be written again under a message.
    shown: String,
    /// How many rows of the terminal it takes.
    rows: usize,
    last_plain: Option<Instant>,
}

impl Console {
    /// Nothing shown yet.
    pub fn on_stderr() -> Self {
        let out = io::stderr();
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
    pub fn show(&mut self, line: &str, now: Instant) {
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
    pub fn say(&mut self, message: &str) {
        let message = harmless(message);
        if self.terminal {
            self.rewrite(&format!("{message}\n"));
        } else {
            self.write(&format!("{message}\n"));
        }
    }

    /// Leaves the last state standing and begins a line of its own for what follows.
    pub fn finish(&mut self) {
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

    /// Refuses everything for the same reason.
    struct Refusing(io::ErrorKind);

    impl Write for Refusing {
        fn write(&mut self, _: &[u8]) -> io::Result<usize> {
            Err(self.0.into())
        }

        fn flush(&mut self) -> io::Result<()> {
            Err(self.0.into())
        }
    }

    #[test]
    fn a_reader_that_has_seen_enough_is_no_failure_and_a_full_disk_is() {
        let mut gone = Results(Refusing(io::ErrorKind::BrokenPipe));
        gone.write_all(b"a line\n").unwrap();
        gone.flush().unwrap();
        let mut full = Results(Refusing(io::ErrorKind::StorageFull));
        assert!(full.write_all(b"a line\n").is_err());
        assert!(full.flush().is_err());
    }

    #[test]
    fn a_figure_wider_than_the_terminal_is_cut() {
        assert_eq!(wrapped("abcdefgh · x", 5), ["abcd", "x"]);
    }
}

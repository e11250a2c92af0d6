//! The words of a text with their lines, and what is wrong where another word should be.

use crate::error::MotionError;
use crate::import::file::File;
use wording::count;

/// What to do about a text that ends too early.
const CUT_OFF: &str = "download or export it again: it is cut off";

/// The words of a file with their lines.
pub(super) struct Words<'a> {
    file: &'a File<'a>,
    words: std::iter::Peekable<Box<dyn Iterator<Item = (usize, &'a str)> + 'a>>,
    line: usize,
}

impl<'a> Words<'a> {
    pub(super) fn new(file: &'a File<'a>, text: &'a str) -> Self {
        let text = text.strip_prefix('\u{feff}').unwrap_or(text);
        let words: Box<dyn Iterator<Item = (usize, &'a str)> + 'a> = Box::new(
            text.lines()
                .enumerate()
                .flat_map(|(i, line)| line.split_whitespace().map(move |word| (i + 1, word))),
        );
        Self {
            file,
            words: words.peekable(),
            line: 0,
        }
    }

    pub(super) fn more(&mut self) -> bool {
        self.words.peek().is_some()
    }

    /// The line of the next word.
    pub(super) fn line(&mut self) -> usize {
        self.words.peek().map_or(self.line, |(line, _)| *line)
    }

    pub(super) fn word(&mut self, what: &str) -> Result<(usize, &'a str), MotionError> {
        let Some((line, word)) = self.words.next() else {
            let problem = format!("ends where {what} should be");
            return Err(self.file.line(self.line, problem, CUT_OFF));
        };
        self.line = line;
        Ok((line, word))
    }

    /// A joint's name, which may have spaces: the words up to the brace or the end of the line.
    pub(super) fn name(&mut self) -> Result<String, MotionError> {
        let (line, first) = self.word("the joint's name")?;
        let mut name = first.to_owned();
        while let Some((_, word)) = self.words.next_if(|(at, word)| *at == line && *word != "{") {
            name.push(' ');
            name.push_str(word);
        }
        Ok(name)
    }

    pub(super) fn expect(&mut self, expected: &str) -> Result<(), MotionError> {
        let (_, word) = self.word(expected)?;
        if word.eq_ignore_ascii_case(expected) {
            return Ok(());
        }
        Err(self.error(
            format!("{word:?} where {expected} should be"),
            "export it again as BVH",
        ))
    }

    pub(super) fn number(&mut self, what: &str) -> Result<f64, MotionError> {
        let (_, word) = self.word(what)?;
        match word.parse::<f64>() {
            Ok(number) if number.is_finite() => Ok(number),
            _ => Err(self.error(
                format!("{word:?} for {what}"),
                "write a finite decimal number",
            )),
        }
    }

    /// A number of a frame, which must be on the frame's line.
    pub(super) fn frame_number(
        &mut self,
        frame: usize,
        channels: usize,
        channel: usize,
        line: usize,
    ) -> Result<f64, MotionError> {
        let field = format!("channel {}", channel + 1);
        let next = self.words.next_if(|(at, _)| *at == line);
        let Some((_, word)) = next else {
            let problem = format!(
                "line {line} has {}, the hierarchy has {}",
                count(channel, "number"),
                count(channels, "channel")
            );
            let remedy = if self.more() {
                "give every frame a line of all channels"
            } else {
                CUT_OFF
            };
            return Err(self.file.frame(frame, &field, problem, remedy));
        };
        match word.parse::<f64>() {
            Ok(number) if number.is_finite() => Ok(number),
            _ => {
                let problem = format!("{word:?} is not a finite number");
                let remedy = if self.more() {
                    "repair or cut the frame"
                } else {
                    CUT_OFF
                };
                Err(self.file.frame(frame, &field, problem, remedy))
            }
        }
    }

    /// What is wrong with the last word; where the text ends with it, it is half a word.
    pub(super) fn error(&mut self, problem: String, remedy: &str) -> MotionError {
        if self.more() {
            return self.file.line(self.line, problem, remedy);
        }
        let problem = format!("{problem}, where the text ends");
        self.file.line(self.line, problem, CUT_OFF)
    }
}

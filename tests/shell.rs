//! Shell commands that stand in a text for people: in its blocks of shell code and between its backticks.
//!
//! Separate because two test binaries need it: one parses the commands, the other runs them.

/// A command and where it stands.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Command {
    /// Line of the text, counted from 1.
    pub(crate) line: usize,
    /// Program and arguments, quotes resolved.
    pub(crate) words: Vec<String>,
    /// Whether it stands in a block, to be typed as it is, and not within a sentence.
    pub(crate) typed: bool,
}

/// All commands of a Markdown text, in their order.
pub(crate) fn commands(markdown: &str) -> Vec<Command> {
    let mut found = Vec::new();
    let mut block: Option<(bool, String, usize)> = None;
    // Prose is kept with its lines, for spans between backticks may be broken over two.
    let mut prose = String::new();
    for (index, line) in markdown.lines().enumerate() {
        let fence = line.trim_start().strip_prefix("```");
        let blank = match (&mut block, fence) {
            (None, Some(language)) => {
                block = Some((
                    matches!(language.trim(), "sh" | "bash"),
                    String::new(),
                    index + 2,
                ));
                true
            }
            (Some((shell, text, first)), Some(_)) => {
                if *shell {
                    found.extend(of_script(text, *first, true));
                }
                block = None;
                true
            }
            (Some((_, text, _)), None) => {
                text.push_str(line);
                text.push('\n');
                true
            }
            (None, None) => false,
        };
        prose.push_str(if blank { "" } else { line });
        prose.push('\n');
    }
    let mut first = 1;
    for (i, piece) in prose.split('`').enumerate() {
        if i % 2 == 1 {
            found.extend(of_script(&piece.replace('\n', " "), first, false));
        }
        first += piece.matches('\n').count();
    }
    found.sort_by_key(|command| command.line);
    found
}

/// The commands of a script: a line each, more where `;`, `&&` or `|` join them.
fn of_script(script: &str, first: usize, typed: bool) -> Vec<Command> {
    let mut found = Vec::new();
    let mut number = first;
    for line in script.replace("\\\n", "\u{b}").lines() {
        let words = shlex::split(&line.replace('\u{b}', " ")).unwrap_or_default();
        for mut part in words.split(|word| matches!(word.as_str(), "&&" | "|" | ";")) {
            while let Some((assignment, rest)) =
                part.split_first().filter(|(word, _)| is_assignment(word))
            {
                let _ = assignment;
                part = rest;
            }
            let mut words: Vec<String> = part
                .iter()
                .take_while(|word| *word != ">")
                .cloned()
                .collect();
            // "a; b": the sign stays with the word before it.
            let joined = words.iter().position(|word| word.ends_with(';'));
            let mut rest = Vec::new();
            if let Some(at) = joined {
                rest = words.split_off(at + 1);
                words[at].pop();
            }
            for words in [words, rest] {
                if !words.is_empty() {
                    found.push(Command {
                        line: number,
                        words,
                        typed,
                    });
                }
            }
        }
        number += 1 + line.matches('\u{b}').count();
    }
    found
}

/// `NAME=value` before a command.
fn is_assignment(word: &str) -> bool {
    word.split_once('=').is_some_and(|(name, _)| {
        !name.is_empty() && name.chars().all(|c| c.is_ascii_uppercase() || c == '_')
    })
}

/// The arguments of a command of the program `ampco`, whichever way it is called; `local.sh` is `ampco train`.
pub(crate) fn arguments(words: &[String]) -> Option<Vec<String>> {
    let (program, rest) = words.split_first()?;
    match program.as_str() {
        "ampco" | "target/release/ampco" => Some(rest.to_vec()),
        "deploy/local.sh" => Some([&["train".to_owned()], rest].concat()),
        _ => None,
    }
}

#[test]
fn commands_are_found_in_blocks_and_in_sentences() {
    let text = "Do `ampco x --a\n b` and `y`.\n\n```sh\nA=1 ampco y 'b c' \\\n  d   # why\nf; g > h\n```\n```\nno\n```\n`z`\n";
    let found: Vec<(usize, String, bool)> = commands(text)
        .into_iter()
        .map(|command| (command.line, command.words.join("|"), command.typed))
        .collect();
    let expected = [
        (1, "ampco|x|--a|b", false),
        (2, "y", false),
        (5, "ampco|y|b c|d", true),
        (7, "f", true),
        (7, "g", true),
        (12, "z", false),
    ];
    assert_eq!(
        found,
        expected.map(|(line, words, typed)| (line, words.to_owned(), typed))
    );
}

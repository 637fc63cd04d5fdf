//! What came from elsewhere, told in one line.
//!
//! A key in a JSON file, an id in a drawing, a path: whatever is in them may
//! stand in a message, and a message is one line of characters that show. So
//! all that is told of a file goes through [`SanitizedLine`], and what a terminal
//! prints once more: told twice is told as once.
//!
//! Guaranteed: no line breaks, no control characters, no characters that turn
//! the direction of writing; they are escaped as Rust does it (`\n`,
//! `\u{1b}`). What is longer than [`MOST`] characters loses its middle, for
//! files are named at the beginning and the way out stands at the end. Not
//! guaranteed: that the text can be had back; a backslash stays one.

use std::fmt;

/// Most characters of a message: twice those of the longest of our own, an
/// unknown key of a project with all keys that there are.
const MOST: usize = 1_000;

/// How many of [`MOST`] stay of the end: room for any way out.
const TAIL: usize = 400;

/// Shows what it holds in one line.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SanitizedLine<T>(pub T);

impl<T: fmt::Display> fmt::Display for SanitizedLine<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let shown: String = self.0.to_string().chars().flat_map(visible).collect();
        let count = shown.chars().count();
        if count <= MOST {
            return f.write_str(&shown);
        }
        let head = shown.chars().take(MOST - TAIL - 1);
        let tail = shown.chars().skip(count - TAIL);
        f.write_str(&head.chain(['…']).chain(tail).collect::<String>())
    }
}

/// Whether a character acts on what shows it, instead of being shown.
pub(crate) fn is_hidden(c: char) -> bool {
    // Line and paragraph separators, and all that override the direction
    // (Unicode, UAX #9): with them a name can be made to look like another.
    let turns = matches!(c, '\u{61c}' | '\u{200e}' | '\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2066}'..='\u{2069}');
    c.is_control() || turns
}

fn visible(c: char) -> impl Iterator<Item = char> {
    let hidden = is_hidden(c);
    let escaped = hidden.then(|| c.escape_default());
    escaped.into_iter().flatten().chain((!hidden).then_some(c))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn told(text: &str) -> String {
        SanitizedLine(text).to_string()
    }

    #[test]
    fn what_acts_is_escaped_once() {
        for (text, line) in [
            ("plain: ä “x” \\n", "plain: ä “x” \\n"),
            ("a\nb\r\tc", "a\\nb\\r\\tc"),
            ("\u{1b}[31mred\u{7}\0", "\\u{1b}[31mred\\u{7}\\u{0}"),
            ("\u{9b}2J\u{7f}", "\\u{9b}2J\\u{7f}"),
            ("a\u{202e}gpj.exe\u{2028}", "a\\u{202e}gpj.exe\\u{2028}"),
        ] {
            assert_eq!(told(text), line);
            assert_eq!(told(&told(text)), line);
        }
    }

    #[test]
    fn what_is_long_keeps_its_ends() {
        let line = told(&format!("a.svg: {}; save it again", "é".repeat(1_000_000)));
        assert_eq!(line.chars().count(), MOST);
        assert!(line.starts_with("a.svg: é") && line.ends_with("é; save it again"));
        assert_eq!(told(&line), line);
    }
}

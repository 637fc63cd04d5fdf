//! Escaping of text from files, so that it can be shown in a message of one line.
//!
//! A JSON key, an id in a drawing or a path may contain line breaks and terminal commands. Every
//! message that quotes a file goes through [`SanitizedLine`]. Terminal output goes through it a
//! second time, which changes nothing.
//!
//! The result has no line breaks, no control characters and no characters that override the
//! writing direction; they are escaped as in Rust (`\n`, `\u{1b}`). Text longer than
//! [`MAX_CHARS`] loses its middle, because messages name the file at the start and the remedy at
//! the end. Escaping is not reversible: backslashes are not escaped.

use std::fmt;

/// Maximum number of characters of a message (resource limit: twice the longest message of the
/// program, which lists all keys of a project file).
const MAX_CHARS: usize = 1_000;

/// Number of characters that a shortened message keeps from its end, enough for any remedy
/// (heuristic).
const TAIL_CHARS: usize = 400;

/// Wrapper whose `Display` writes the text of the value as one line: escaped, and shortened if it
/// is too long.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SanitizedLine<T>(pub T);

impl<T: fmt::Display> fmt::Display for SanitizedLine<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let escaped: String = self.0.to_string().chars().flat_map(escape_hidden).collect();
        let count = escaped.chars().count();
        if count <= MAX_CHARS {
            return f.write_str(&escaped);
        }
        let head = escaped.chars().take(MAX_CHARS - TAIL_CHARS - 1);
        let tail = escaped.chars().skip(count - TAIL_CHARS);
        f.write_str(&head.chain(['…']).chain(tail).collect::<String>())
    }
}

/// Returns whether a character controls the display instead of being visible.
pub(crate) fn is_hidden(c: char) -> bool {
    // Line and paragraph separators, and directional formatting characters (Unicode UAX #9),
    // which can make one name look like another.
    let is_directional = matches!(c, '\u{61c}' | '\u{200e}' | '\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2066}'..='\u{2069}');
    c.is_control() || is_directional
}

/// Returns the character itself, or its escape sequence if it is hidden.
fn escape_hidden(c: char) -> impl Iterator<Item = char> {
    let hidden = is_hidden(c);
    let escaped = hidden.then(|| c.escape_default());
    escaped.into_iter().flatten().chain((!hidden).then_some(c))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sanitized(text: &str) -> String {
        SanitizedLine(text).to_string()
    }

    #[test]
    fn hidden_characters_are_escaped_once() {
        for (text, line) in [
            ("plain: ä “x” \\n", "plain: ä “x” \\n"),
            ("a\nb\r\tc", "a\\nb\\r\\tc"),
            ("\u{1b}[31mred\u{7}\0", "\\u{1b}[31mred\\u{7}\\u{0}"),
            ("\u{9b}2J\u{7f}", "\\u{9b}2J\\u{7f}"),
            ("a\u{202e}gpj.exe\u{2028}", "a\\u{202e}gpj.exe\\u{2028}"),
        ] {
            assert_eq!(sanitized(text), line);
            assert_eq!(sanitized(&sanitized(text)), line);
        }
    }

    #[test]
    fn long_text_keeps_its_start_and_end() {
        let line = sanitized(&format!("a.svg: {}; save it again", "é".repeat(1_000_000)));
        assert_eq!(line.chars().count(), MAX_CHARS);
        assert!(line.starts_with("a.svg: é") && line.ends_with("é; save it again"));
        assert_eq!(sanitized(&line), line);
    }
}

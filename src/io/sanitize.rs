//! Escaping of text from files, so that it can be shown in a message of one line.
//!
//! A JSON key, an id in a drawing or a path may contain line breaks and terminal commands. Every
//! message that quotes a file goes through [`SanitizedLine`]. Terminal output goes through it a
//! second time, which changes nothing.
//!
//! The result has no line breaks, no control characters and no characters that override the
//! writing direction; they are escaped as in Rust (`\n`, `\u{1b}`). From names and titles, direction
//! controls are removed instead ([`SanitizedName`]). Text longer than
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

/// Wrapper whose `Display` writes a name or a title as one line, without characters that control
/// the writing direction. Names in scripts from right to left contain such characters legitimately, so
/// escape sequences would make them hard to read.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SanitizedName<'a>(pub &'a str);

impl fmt::Display for SanitizedName<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        SanitizedLine(without_direction_controls(self.0)).fmt(f)
    }
}

/// Returns the text without characters that control the writing direction. The order of the other
/// characters, and so the direction of words, is that of their scripts.
pub(crate) fn without_direction_controls(text: &str) -> String {
    text.chars().filter(|&c| !is_direction_control(c)).collect()
}

/// Returns whether a character controls the writing direction (Unicode UAX #9, section 2). Such
/// characters can make one name look like another.
pub(crate) fn is_direction_control(c: char) -> bool {
    matches!(c, '\u{61c}' | '\u{200e}' | '\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}')
}

/// Returns whether a character controls the display instead of being visible.
pub(crate) fn is_hidden(c: char) -> bool {
    let is_separator = matches!(c, '\u{2028}' | '\u{2029}');
    c.is_control() || is_separator || is_direction_control(c)
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
    fn names_lose_what_controls_their_direction_and_keep_their_words() {
        let name = |text: &str| SanitizedName(text).to_string();
        for (text, expected) in [
            ("\u{202e}gpj.exe\u{202c}", "gpj.exe"),
            (
                "a\u{202a}\u{202b}\u{202d}b\u{2066}\u{2067}\u{2068}\u{2069}c",
                "abc",
            ),
            ("\u{200f}שלום 3\u{200e} (עולם)", "שלום 3 (עולם)"),
            ("\u{61c}نجمة", "نجمة"),
            // The joiners of Persian and of emoji are no direction controls.
            (
                "می\u{200c}خواهم 👩\u{200d}🎨",
                "می\u{200c}خواهم 👩\u{200d}🎨",
            ),
            ("a\nb\u{1b}", "a\\nb\\u{1b}"),
        ] {
            assert_eq!(name(text), expected);
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

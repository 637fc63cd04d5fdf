//! Inline codes of TEXT (`%%d`) and MTEXT (`\P`, `\H2.5;`): replaces codes of characters and
//! removes formatting.

/// Replaces the `%%` codes of a single line of text: symbols and numbered characters. Codes of
/// under- and overlines are removed.
pub(super) fn plain_text(text: &str) -> String {
    let text = without_carets(text);
    let mut result = String::with_capacity(text.len());
    let mut rest = text.as_str();
    while let Some(at) = rest.find("%%") {
        result.push_str(&rest[..at]);
        rest = &rest[at + 2..];
        let Some(code) = rest.chars().next() else {
            break;
        };
        let number = rest.get(..3).and_then(|digits| digits.parse::<u8>().ok());
        let (character, length) = match (code.to_ascii_lowercase(), number) {
            (_, Some(number)) => (Some(char::from(number)), 3),
            ('d', _) => (Some('°'), 1),
            ('p', _) => (Some('±'), 1),
            ('c', _) => (Some('Ø'), 1),
            ('%', _) => (Some('%'), 1),
            ('u' | 'o' | 'k', _) => (None, 1),
            _ => (Some('%'), 0),
        };
        result.extend(character);
        rest = &rest[length..];
    }
    result.push_str(rest);
    result.chars().filter(|c| !c.is_control()).collect()
}

/// Replaces carets with the character after them by the character that they stand for.
fn without_carets(text: &str) -> String {
    let mut result = String::with_capacity(text.len());
    let mut characters = text.chars();
    while let Some(character) = characters.next() {
        match character {
            '^' => result.push(characters.next().map_or('^', after_caret)),
            other => result.push(other),
        }
    }
    result
}

/// Returns the character that a caret with a character after it stands for: "^I" is a tab, "^ " a
/// caret and "^a" an exclamation mark.
fn after_caret(character: char) -> char {
    // Codes are shifted by 64, modulo 126.
    match u8::try_from(character) {
        Ok(code) if code.is_ascii() => char::from((code + 126 - 64) % 126),
        _ => character,
    }
}

/// Returns the text of an MTEXT without inline codes, with one line for each paragraph, and whether
/// it had codes that change its appearance.
pub(super) fn plain_mtext(text: &str) -> (String, bool) {
    let mut result = String::with_capacity(text.len());
    let mut has_codes = false;
    let mut characters = text.chars().peekable();
    while let Some(character) = characters.next() {
        match character {
            '{' | '}' => {}
            '^' => match characters.next().map(after_caret) {
                Some('\n' | '\r') => result.push('\n'),
                Some('\t') => result.push(' '),
                // The lines are searched for carets again.
                Some('^') | None => result.push_str("^ "),
                Some(other) => result.push(other),
            },
            '\\' => match characters.next() {
                Some('P' | 'N' | 'X') => result.push('\n'),
                Some('~') => result.push('\u{a0}'),
                Some(literal @ ('\\' | '{' | '}')) => result.push(literal),
                Some('L' | 'l' | 'O' | 'o' | 'K' | 'k') => has_codes = true,
                Some('S') => {
                    has_codes = true;
                    let stacked = characters.by_ref().take_while(|&c| c != ';');
                    let slash = |c: char| if matches!(c, '^' | '#') { '/' } else { c };
                    result.extend(stacked.map(slash));
                }
                Some('A' | 'C' | 'c' | 'F' | 'f' | 'H' | 'Q' | 'T' | 'W' | 'p') => {
                    has_codes = true;
                    characters.by_ref().take_while(|&c| c != ';').for_each(drop);
                }
                Some(other) => result.push(other),
                None => {}
            },
            '\t' => result.push(' '),
            other => result.push(other),
        }
    }
    let lines: Vec<String> = result.split('\n').map(plain_text).collect();
    (lines.join("\n"), has_codes)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn codes_of_characters_are_replaced() {
        assert_eq!(plain_text("%%c20 %%p5%%% 45%%D %%u%%065"), "Ø20 ±5% 45° A");
        assert_eq!(plain_text("100%"), "100%");
        assert_eq!(plain_text("a%%"), "a");
    }

    #[test]
    fn formatting_is_removed() {
        let (text, has_codes) = plain_mtext("{\\fArial|b0;A\\H2x;B}\\Pa\\~b \\S1^2; \\\\ \\{c\\}");
        assert_eq!(text, "AB\na\u{a0}b 1/2 \\ {c}");
        assert!(has_codes);
        assert_eq!(plain_mtext("a^Jb"), ("a\nb".to_owned(), false));
        assert_eq!(plain_mtext("^a^0^ ^ ").0, "!n^^");
        assert_eq!(plain_text("a^b^ ^Ic^"), "a\"^c^");
    }
}

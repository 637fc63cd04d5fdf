//! Text of style sheets: comments, strings, brackets and components of values.

/// Replaces the comments of a sheet by spaces.
pub(in crate::design::svg) fn without_comments(text: &str) -> String {
    let mut plain = String::with_capacity(text.len());
    let mut rest = text;
    while let Some(at) = rest.find(['/', '"', '\'', '(']) {
        if let Some(comment) = rest[at..].strip_prefix("/*") {
            plain.push_str(&rest[..at]);
            plain.push(' ');
            rest = comment.split_once("*/").map_or("", |(_, after)| after);
            continue;
        }
        let end = match rest.as_bytes()[at] {
            b'/' => at + 1,
            b'(' if is_plain_url(rest, at) => {
                rest[at..].find(')').map_or(rest.len(), |end| at + end)
            }
            b'(' => at + 1,
            _ => string_end(rest.as_bytes(), at),
        };
        plain.push_str(&rest[..end]);
        rest = &rest[end..];
    }
    plain + rest
}

/// Returns the position of the first of the ASCII characters `targets` that lies outside of
/// strings, brackets and `url(…)`.
pub(in crate::design::svg) fn find_outside_brackets(text: &str, targets: &str) -> Option<usize> {
    let bytes = text.as_bytes();
    let (mut at, mut depth) = (0, 0_usize);
    while let Some(&byte) = bytes.get(at) {
        if depth == 0 && targets.as_bytes().contains(&byte) {
            return Some(at);
        }
        match byte {
            b'\\' => at += 1,
            b'"' | b'\'' => {
                at = string_end(bytes, at);
                continue;
            }
            b'(' if is_plain_url(text, at) => {
                at += bytes[at..]
                    .iter()
                    .position(|&b| b == b')')
                    .unwrap_or(bytes.len() - at);
            }
            b'(' | b'[' | b'{' => depth += 1,
            b')' | b']' | b'}' => depth = depth.saturating_sub(1),
            _ => {}
        }
        at += 1;
    }
    None
}

/// Returns whether the bracket at `at` opens a `url(…)` without quotes, whose content is no CSS.
fn is_plain_url(text: &str, at: usize) -> bool {
    let name = &text.as_bytes()[at.saturating_sub(3)..at];
    let content = text[at + 1..].trim_start();
    name.eq_ignore_ascii_case(b"url") && !content.starts_with(['"', '\''])
}

/// Returns the position after the string that begins at `at`.
fn string_end(bytes: &[u8], at: usize) -> usize {
    let quote = bytes[at];
    let mut end = at + 1;
    while let Some(&byte) = bytes.get(end) {
        match byte {
            b'\\' => end += 1,
            byte if byte == quote => return end + 1,
            _ => {}
        }
        end += 1;
    }
    bytes.len()
}

/// Splits a text at an ASCII character outside of strings and brackets. The parts are trimmed.
pub(in crate::design::svg) fn split_outside_brackets(
    text: &str,
    separator: char,
) -> impl Iterator<Item = &str> {
    let mut rest = Some(text);
    std::iter::from_fn(move || {
        let text = rest?;
        let mut buffer = [0; 4];
        let end = find_outside_brackets(text, separator.encode_utf8(&mut buffer));
        rest = end.map(|end| &text[end + 1..]);
        Some(text[..end.unwrap_or(text.len())].trim())
    })
}

/// Splits a value into its components, separated by white space outside of strings and brackets.
pub(in crate::design::svg) fn components(text: &str) -> Vec<&str> {
    let mut parts = Vec::new();
    let mut rest = text.trim_start();
    while !rest.is_empty() {
        let end = find_outside_brackets(rest, " \t\r\n\u{c}").unwrap_or(rest.len());
        parts.push(&rest[..end]);
        rest = rest[end..].trim_start();
    }
    parts
}

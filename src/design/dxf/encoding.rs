//! Character encodings of DXF files, and the escape sequences of characters.
//!
//! Files of release 2007 (AC1021) and later are UTF-8; earlier files use the code page that the
//! header names. Only Windows-1252 is decoded exactly; text that is valid UTF-8 is always read as
//! UTF-8, because many programs write it into old files.

use crate::design::text_encoding::from_windows_1252;

/// Decodes a text value, including `\U+XXXX` escapes.
pub(super) fn decode(bytes: &[u8]) -> String {
    let text = match std::str::from_utf8(bytes) {
        Ok(text) => text.to_owned(),
        Err(_) => bytes.iter().map(|&byte| from_windows_1252(byte)).collect(),
    };
    match text.contains(UNICODE_ESCAPE) {
        true => resolve_escapes(&text),
        false => text,
    }
}

/// Start of the escape sequence of a character; four hexadecimal digits follow.
const UNICODE_ESCAPE: &str = "\\U+";

/// Replaces the escape sequences by their characters; leaves invalid sequences unchanged.
fn resolve_escapes(text: &str) -> String {
    let mut result = String::with_capacity(text.len());
    let mut rest = text;
    while let Some(at) = rest.find(UNICODE_ESCAPE) {
        let (before, escape) = rest.split_at(at);
        result.push_str(before);
        let digits = escape.get(3..7).unwrap_or_default();
        let number = u32::from_str_radix(digits, 16).ok();
        match number.and_then(char::from_u32) {
            Some(character) => {
                result.push(character);
                rest = &escape[7..];
            }
            None => {
                result.push_str(UNICODE_ESCAPE);
                rest = &escape[3..];
            }
        }
    }
    result.push_str(rest);
    result
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn text_is_utf_8_or_windows_1252_with_escapes() {
        assert_eq!(decode("Wände".as_bytes()), "Wände");
        assert_eq!(decode(b"W\xe4nde \x80"), "Wände €");
        assert_eq!(decode(b"\\U+00C4 \\U+zzzz \\U+"), "Ä \\U+zzzz \\U+");
    }
}

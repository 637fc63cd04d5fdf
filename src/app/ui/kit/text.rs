//! Text of labels: capitalises the first letter, and shortens text that contains names from files.

/// Maximum number of characters of a sentence with a name in it (heuristic: leaves at least 170
/// characters for names, since the longest sentence of a dialog has 129 without them).
pub const MAX_CHARS: usize = 300;

/// Returns the text without its middle if it is too long for a dialog. A third of the result comes
/// from the end (heuristic: longer than any text that follows a name).
pub fn shortened(text: &str) -> String {
    let count = text.chars().count();
    if count <= MAX_CHARS {
        return text.to_owned();
    }
    let tail_count = MAX_CHARS / 3;
    let head = text.chars().take(MAX_CHARS - tail_count - 1);
    let tail = text.chars().skip(count - tail_count);
    head.chain(['…']).chain(tail).collect()
}

/// Returns the text with its first letter in upper case.
pub fn capitalised(text: &str) -> String {
    let mut chars = text.chars();
    chars
        .next()
        .map(|first| first.to_uppercase().chain(chars).collect())
        .unwrap_or_default()
}

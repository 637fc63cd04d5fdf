//! Where JSON is wrong, and how: what its two readers tell of it.

/// The line and the column, from 1, and the parser's words without them.
pub(super) fn fault(error: &serde_json::Error) -> (usize, usize, String) {
    let (line, column) = (error.line(), error.column());
    let words = error.to_string();
    let place = format!(" at line {line} column {column}");
    let message = words.strip_suffix(&place).unwrap_or(&words).to_owned();
    (line, column, message)
}

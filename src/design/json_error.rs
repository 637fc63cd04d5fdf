//! Error that the polygon and truss importers share: text with invalid JSON syntax or an unexpected
//! structure.

/// Error for text that is not JSON or does not have the expected structure.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("line {line}, column {column}: {message}; correct the file")]
pub struct JsonError {
    /// Line of the error, counted from 1.
    pub line: usize,
    /// Column of the error, counted from 1.
    pub column: usize,
    /// Description from the JSON parser, without the position.
    pub message: String,
}

impl From<serde_json::Error> for JsonError {
    fn from(error: serde_json::Error) -> Self {
        let (line, column) = (error.line(), error.column());
        let words = error.to_string();
        // The parser appends the position, but the error message of `JsonError` already begins with
        // it.
        let position = format!(" at line {line} column {column}");
        Self {
            line,
            column,
            message: words.strip_suffix(&position).unwrap_or(&words).to_owned(),
        }
    }
}

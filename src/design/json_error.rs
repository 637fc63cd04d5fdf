//! Where JSON is wrong, and how: what its two readers tell of it.

/// Text that is not JSON, or not of the form that is read.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("line {line}, column {column}: {message}; correct the file")]
pub struct JsonError {
    /// The line, from 1.
    pub line: usize,
    /// The column, from 1.
    pub column: usize,
    /// What was found, in the parser's words.
    pub message: String,
}

impl From<serde_json::Error> for JsonError {
    fn from(error: serde_json::Error) -> Self {
        let (line, column) = (error.line(), error.column());
        let words = error.to_string();
        let place = format!(" at line {line} column {column}");
        Self {
            line,
            column,
            message: words.strip_suffix(&place).unwrap_or(&words).to_owned(),
        }
    }
}

//! Reads the table of pairs for `check --pairs`: CSV in UTF-8 with a header.
//!
//! A defect of the whole table is an error. A defect of a row becomes the error of this row, so
//! that the other pairs can be measured.

use std::collections::HashSet;
use std::path::{Path, PathBuf};

use super::columns;
use crate::design::DesignSource;
use crate::io::read;
use crate::io::read::ReadError;
use crate::io::sanitize::SanitizedLine;

/// Table of pairs, with at least one row.
#[derive(Debug)]
pub(super) struct PairTable {
    /// Headings of the columns.
    pub header: Vec<String>,
    /// Rows of the file; rows with only empty cells are left out.
    pub rows: Vec<PairTableRow>,
}

/// Row of the table.
#[derive(Debug)]
pub(super) struct PairTableRow {
    /// Line of the file on which the row starts, from 1.
    pub line: u64,
    /// Cells, as many as the header has; they are copied to the report.
    pub cells: Vec<Vec<u8>>,
    /// Source and target, or the error of the row.
    pub pair: Result<[PathBuf; 2], PairRowError>,
}

/// Error of reading a table.
#[derive(Debug, thiserror::Error)]
pub(super) enum PairTableError {
    #[error(transparent)]
    Read(#[from] ReadError),
    #[error("the table is UTF-16; save it as CSV in UTF-8")]
    Utf16,
    #[error("the table is empty; its first line names the columns: source,target")]
    Empty,
    #[error(transparent)]
    Csv(csv::Error),
    #[error("the table lists no pairs; add a line for each under the header")]
    NoPairs,
    #[error("the first line is not text in UTF-8; save the table as CSV in UTF-8")]
    HeaderNotText,
    #[error("two columns are called `{0}`; rename one of them")]
    DuplicateHeading(String),
    #[error("the column `{0}` has the name of a column of the report; rename it")]
    ReservedHeading(String),
    #[error("there is no column `{0}`; the first line names {1}; separate columns by commas")]
    MissingColumn(&'static str, String),
}

/// Error of a row.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub(super) enum PairRowError {
    #[error(
        "the row has {found} cells but the header has {expected}; quote cells that contain commas"
    )]
    CellCount { found: usize, expected: usize },
    #[error("the {0} is not text in UTF-8; save the table in UTF-8")]
    NotText(&'static str),
    #[error("the {0} is empty; write the path of a design")]
    Empty(&'static str),
    #[error("the {0} `{1}` has several lines; close its quote")]
    SeveralLines(&'static str, String),
}

/// Reads a table from a file. The paths of designs are relative to its folder.
pub(super) fn read(path: &Path) -> Result<PairTable, PairTableError> {
    let bytes = read::read(path)?;
    let folder = path.parent().unwrap_or(Path::new(""));
    parse(&bytes, folder)
}

/// Parses a table from the content of a file. The paths of designs are relative to `folder`.
fn parse(bytes: &[u8], folder: &Path) -> Result<PairTable, PairTableError> {
    const UTF8_MARK: &[u8] = b"\xef\xbb\xbf";
    if bytes.starts_with(b"\xff\xfe") || bytes.starts_with(b"\xfe\xff") {
        return Err(PairTableError::Utf16);
    }
    let bytes = bytes.strip_prefix(UTF8_MARK).unwrap_or(bytes);
    // The reader accepts rows of any length and treats the header as a row, because the errors
    // below are clearer than its own.
    let mut reader = csv::ReaderBuilder::new()
        .flexible(true)
        .has_headers(false)
        .from_reader(bytes);
    let mut records = reader.byte_records();
    let first = records.next().ok_or(PairTableError::Empty)?;
    let header = parse_header(&first.map_err(PairTableError::Csv)?)?;
    let pair_columns = [
        find_column(&header, "source")?,
        find_column(&header, "target")?,
    ];
    let mut rows = Vec::new();
    for record in records {
        let record = record.map_err(PairTableError::Csv)?;
        if !record.iter().all(|cell| cell.trim_ascii().is_empty()) {
            rows.push(parse_row(&record, header.len(), pair_columns, folder));
        }
    }
    if rows.is_empty() {
        return Err(PairTableError::NoPairs);
    }
    Ok(PairTable { header, rows })
}

/// Returns the headings of the table. A heading that is not text, occurs twice or is used by the
/// report itself is an error.
fn parse_header(record: &csv::ByteRecord) -> Result<Vec<String>, PairTableError> {
    let name = |cell: &[u8]| {
        let text = std::str::from_utf8(cell).ok().filter(|t| !t.contains('\0'));
        text.map(|name| name.trim().to_owned())
            .ok_or(PairTableError::HeaderNotText)
    };
    let names: Vec<String> = record.iter().map(name).collect::<Result<_, _>>()?;
    let mut seen = HashSet::new();
    for name in names.iter().filter(|name| !name.is_empty()) {
        if !seen.insert(name) {
            return Err(PairTableError::DuplicateHeading(shorten(name)));
        }
        if columns::is_own(name) {
            return Err(PairTableError::ReservedHeading(shorten(name)));
        }
    }
    Ok(names)
}

/// Returns the index of the column with a heading.
fn find_column(header: &[String], heading: &'static str) -> Result<usize, PairTableError> {
    let mut headings = header.iter();
    headings
        .position(|name| name == heading)
        .ok_or_else(|| PairTableError::MissingColumn(heading, list_headings(header)))
}

/// Lists headings for an error message.
fn list_headings(names: &[String]) -> String {
    /// Maximum number of headings in the list (resource limit: keeps error messages short).
    const MAX_SHOWN: usize = 8;
    let shown = names
        .iter()
        .take(MAX_SHOWN)
        .map(|name| format!("`{}`", shorten(name)));
    let more = if names.len() > MAX_SHOWN { ", ..." } else { "" };
    shown.collect::<Vec<_>>().join(", ") + more
}

/// Returns a text from the file for an error message: in one line, and cut off if it is long.
fn shorten(text: &str) -> String {
    /// Maximum number of characters before the ellipsis (resource limit: keeps error messages
    /// short).
    const MAX_CHARS: usize = 60;
    let line = SanitizedLine(text).to_string();
    if line.chars().count() <= MAX_CHARS {
        return line;
    }
    line.chars().take(MAX_CHARS).chain(['\u{2026}']).collect()
}

/// Returns a row with `width` cells. `pair_columns` holds the indices of the columns `source` and
/// `target`.
fn parse_row(
    record: &csv::ByteRecord,
    width: usize,
    pair_columns: [usize; 2],
    folder: &Path,
) -> PairTableRow {
    let mut cells: Vec<Vec<u8>> = record.iter().take(width).map(<[u8]>::to_vec).collect();
    // All rows get `width` cells, so that the measures, which follow in the report, stay below
    // their headings.
    cells.resize(width, Vec::new());
    let [source, target] = pair_columns;
    let parse_pair = || {
        // The paths are checked before the number of cells: if a quotation mark is not closed, the
        // rest of the file is one cell, and the error of this cell is more helpful.
        let source = parse_path(&cells[source], "source", folder)?;
        let target = parse_path(&cells[target], "target", folder)?;
        if record.len() != width {
            return Err(PairRowError::CellCount {
                found: record.len(),
                expected: width,
            });
        }
        Ok([source, target])
    };
    let pair = parse_pair();
    PairTableRow {
        line: record.position().map_or(0, csv::Position::line),
        cells,
        pair,
    }
}

/// Returns the path of a design from its cell. `column` is the heading, for error messages.
fn parse_path(cell: &[u8], column: &'static str, folder: &Path) -> Result<PathBuf, PairRowError> {
    let text = std::str::from_utf8(cell).map_err(|_| PairRowError::NotText(column))?;
    let text = text.trim();
    if text.is_empty() {
        return Err(PairRowError::Empty(column));
    }
    if text.contains(['\n', '\r', '\0']) {
        return Err(PairRowError::SeveralLines(column, shorten(text)));
    }
    Ok(DesignSource::in_folder(folder, text.as_ref()).to_path())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table(text: &str) -> Result<PairTable, PairTableError> {
        parse(text.as_bytes(), Path::new("folder"))
    }

    fn pairs(text: &str) -> Vec<Result<[String; 2], PairRowError>> {
        let rows = table(text).expect("a table").rows.into_iter();
        let name = |path: PathBuf| path.to_string_lossy().replace('\\', "/");
        rows.map(|row| row.pair.map(|pair| pair.map(name)))
            .collect()
    }

    #[test]
    fn paths_are_relative_to_the_table() {
        let pairs = pairs("kind,target,source\nx,b c.svg, a.svg\n");
        let expected = ["folder/a.svg", "folder/b c.svg"].map(str::to_owned);
        assert_eq!(pairs, [Ok(expected)]);
    }

    #[test]
    fn svg_elements_and_glyphs_are_designs() {
        let pairs = pairs("source,target\nglyph:D,a.svg#leaf\nglyph:S@x.ttf,./glyph:D\n");
        let expected = [
            ["glyph:D", "folder/a.svg#leaf"],
            ["glyph:S@folder/x.ttf", "folder/./glyph:D"],
        ];
        for (pair, expected) in pairs.into_iter().zip(expected) {
            assert_eq!(pair, Ok(expected.map(str::to_owned)));
        }
    }

    #[test]
    fn quotes_byte_order_marks_and_blank_lines_are_read() {
        let text =
            "\u{feff}\"source\",target,note\r\n\"a, 1.svg\",b.svg,\"say \"\"x\"\"\"\r\n\r\n,,\r\n";
        let table = table(text).expect("a table");
        assert_eq!(table.header, ["source", "target", "note"]);
        assert_eq!(table.rows.len(), 1);
        assert_eq!(table.rows[0].cells[0], b"a, 1.svg");
        assert_eq!(table.rows[0].cells[2], b"say \"x\"");
    }

    #[test]
    fn defects_of_the_whole_table_are_refused_with_a_reason() {
        for (text, reason) in [
            ("", "empty"),
            ("\n\n", "empty"),
            ("source,target\n", "no pairs"),
            ("source,kind\na,b\n", "no column `target`"),
            ("source;target\na;b\n", "`source;target`"),
            (
                "source,target,source\na,b,c\n",
                "two columns are called `source`",
            ),
            ("source,target,status\na,b,c\n", "`status` has the name"),
            ("source,target\0\na,b\n", "not text"),
        ] {
            let message = table(text).expect_err(reason).to_string();
            assert!(message.contains(reason), "{text:?}: {message}");
        }
        let utf16 = parse(b"\xff\xfes\0o\0", Path::new("")).expect_err("UTF-16");
        assert!(utf16.to_string().contains("UTF-8"));
    }

    #[test]
    fn a_defect_of_a_row_is_the_error_of_this_row() {
        let pairs = pairs("source,target,k\na,b,\na,,1\na,b\na,b,1,2\n\"a\nb\nc,d,e");
        let reasons = [
            "",
            "target is empty",
            "2 cells",
            "4 cells",
            "target is empty",
        ];
        assert_eq!(pairs.len(), reasons.len(), "{pairs:?}");
        assert!(pairs[0].is_ok());
        for (pair, reason) in pairs.iter().zip(reasons).skip(1) {
            let message = pair.as_ref().expect_err(reason).to_string();
            assert!(
                message.contains(reason) || message.contains("close its quote"),
                "{message}"
            );
        }
    }
}

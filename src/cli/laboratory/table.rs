//! A table of pairs as it is given: CSV with a header.
//!
//! What concerns the table as a whole is an error here; what concerns one row
//! becomes that row's error, so that the others are worked on.

use std::collections::HashSet;
use std::path::{Path, PathBuf};

use super::columns;
use crate::design::DesignSource;
use crate::io::read;
use crate::io::read::ReadError;
use crate::io::sanitize::SanitizedLine;

/// A table that can be worked on.
#[derive(Debug)]
pub(super) struct PairTable {
    /// The names of its columns.
    pub header: Vec<String>,
    pub rows: Vec<PairTableRow>,
}

/// A row with as many cells as the header.
#[derive(Debug)]
pub(super) struct PairTableRow {
    /// The line of the file at which it begins, from 1.
    pub line: u64,
    /// What it says, to be carried along.
    pub cells: Vec<Vec<u8>>,
    /// The two files, or why there are none.
    pub pair: Result<[PathBuf; 2], PairRowError>,
}

/// Why there is no table.
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
    Twice(String),
    #[error("the column `{0}` has the name of one of the report's own; rename it")]
    Own(String),
    #[error("there is no column `{0}`; the first line names {1}; separate columns by commas")]
    Missing(&'static str, String),
}

/// Why a row names no pair.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub(super) enum PairRowError {
    #[error("the row has {found} cells and the header {wanted}; quote cells that hold commas")]
    Cells { found: usize, wanted: usize },
    #[error("the {0} is not text in UTF-8; save the table in UTF-8")]
    NotText(&'static str),
    #[error("the {0} is empty; write the path of a design")]
    Empty(&'static str),
    #[error("the {0} `{1}` runs over several lines; close its quote")]
    Lines(&'static str, String),
}

/// Reads a table; its paths are relative to its folder.
pub(super) fn read(path: &Path) -> Result<PairTable, PairTableError> {
    let bytes = read::read(path)?;
    let folder = path.parent().unwrap_or(Path::new(""));
    parsed(&bytes, folder)
}

fn parsed(bytes: &[u8], folder: &Path) -> Result<PairTable, PairTableError> {
    const UTF8_MARK: &[u8] = b"\xef\xbb\xbf";
    if bytes.starts_with(b"\xff\xfe") || bytes.starts_with(b"\xfe\xff") {
        return Err(PairTableError::Utf16);
    }
    let bytes = bytes.strip_prefix(UTF8_MARK).unwrap_or(bytes);
    // A row of another length is that row's error, and the header has errors of
    // its own.
    let mut reader = csv::ReaderBuilder::new()
        .flexible(true)
        .has_headers(false)
        .from_reader(bytes);
    let mut records = reader.byte_records();
    let first = records.next().ok_or(PairTableError::Empty)?;
    let header = header(&first.map_err(PairTableError::Csv)?)?;
    let pair = [column(&header, "source")?, column(&header, "target")?];
    let mut rows = Vec::new();
    for record in records {
        let record = record.map_err(PairTableError::Csv)?;
        if !record.iter().all(|cell| cell.trim_ascii().is_empty()) {
            rows.push(row(&record, header.len(), pair, folder));
        }
    }
    if rows.is_empty() {
        return Err(PairTableError::NoPairs);
    }
    Ok(PairTable { header, rows })
}

fn header(record: &csv::ByteRecord) -> Result<Vec<String>, PairTableError> {
    let name = |cell: &[u8]| {
        let text = std::str::from_utf8(cell).ok().filter(|t| !t.contains('\0'));
        text.map(|name| name.trim().to_owned())
            .ok_or(PairTableError::HeaderNotText)
    };
    let names: Vec<String> = record.iter().map(name).collect::<Result<_, _>>()?;
    let mut seen = HashSet::new();
    for name in names.iter().filter(|name| !name.is_empty()) {
        if !seen.insert(name) {
            return Err(PairTableError::Twice(cut(name)));
        }
        if columns::is_own(name) {
            return Err(PairTableError::Own(cut(name)));
        }
    }
    Ok(names)
}

fn column(header: &[String], wanted: &'static str) -> Result<usize, PairTableError> {
    let mut names = header.iter();
    names
        .position(|name| name == wanted)
        .ok_or_else(|| PairTableError::Missing(wanted, quoted(header)))
}

fn quoted(names: &[String]) -> String {
    const MOST: usize = 8;
    let shown = names
        .iter()
        .take(MOST)
        .map(|name| format!("`{}`", cut(name)));
    let more = if names.len() > MOST { ", ..." } else { "" };
    shown.collect::<Vec<_>>().join(", ") + more
}

/// The beginning of a text that may be very long.
fn cut(text: &str) -> String {
    const MOST: usize = 60;
    let line = SanitizedLine(text).to_string();
    if line.chars().count() <= MOST {
        return line;
    }
    line.chars().take(MOST).chain(['\u{2026}']).collect()
}

fn row(record: &csv::ByteRecord, width: usize, pair: [usize; 2], folder: &Path) -> PairTableRow {
    let mut cells: Vec<Vec<u8>> = record.iter().take(width).map(<[u8]>::to_vec).collect();
    // So that the report's own columns stand under their headings.
    cells.resize(width, Vec::new());
    let [source, target] = pair;
    let paths = || {
        // Before the count of cells: a quote that is not closed swallows the rest,
        // and is what to look for.
        let source = path(&cells[source], "source", folder)?;
        let target = path(&cells[target], "target", folder)?;
        if record.len() != width {
            return Err(PairRowError::Cells {
                found: record.len(),
                wanted: width,
            });
        }
        Ok([source, target])
    };
    let pair = paths();
    PairTableRow {
        line: record.position().map_or(0, csv::Position::line),
        cells,
        pair,
    }
}

fn path(cell: &[u8], column: &'static str, folder: &Path) -> Result<PathBuf, PairRowError> {
    let text = std::str::from_utf8(cell).map_err(|_| PairRowError::NotText(column))?;
    let text = text.trim();
    if text.is_empty() {
        return Err(PairRowError::Empty(column));
    }
    if text.contains(['\n', '\r', '\0']) {
        return Err(PairRowError::Lines(column, cut(text)));
    }
    Ok(DesignSource::in_folder(folder, text.as_ref()).to_path())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table(text: &str) -> Result<PairTable, PairTableError> {
        parsed(text.as_bytes(), Path::new("folder"))
    }

    fn pairs(text: &str) -> Vec<Result<[String; 2], PairRowError>> {
        let rows = table(text).expect("a table").rows.into_iter();
        let name = |path: PathBuf| path.to_string_lossy().replace('\\', "/");
        rows.map(|row| row.pair.map(|pair| pair.map(name)))
            .collect()
    }

    #[test]
    fn paths_are_relative_to_the_table() {
        let found = pairs("kind,target,source\nx,b c.svg, a.svg\n");
        let expected = ["folder/a.svg", "folder/b c.svg"].map(str::to_owned);
        assert_eq!(found, [Ok(expected)]);
    }

    #[test]
    fn elements_and_letters_are_designs_too() {
        let found = pairs("source,target\nglyph:D,a.svg#leaf\nglyph:S@x.ttf,./glyph:D\n");
        let expected = [
            ["glyph:D", "folder/a.svg#leaf"],
            ["glyph:S@folder/x.ttf", "folder/./glyph:D"],
        ];
        for (found, expected) in found.into_iter().zip(expected) {
            assert_eq!(found, Ok(expected.map(str::to_owned)));
        }
    }

    #[test]
    fn quotes_marks_and_blank_lines_are_read() {
        let text =
            "\u{feff}\"source\",target,note\r\n\"a, 1.svg\",b.svg,\"say \"\"x\"\"\"\r\n\r\n,,\r\n";
        let table = table(text).expect("a table");
        assert_eq!(table.header, ["source", "target", "note"]);
        assert_eq!(table.rows.len(), 1);
        assert_eq!(table.rows[0].cells[0], b"a, 1.svg");
        assert_eq!(table.rows[0].cells[2], b"say \"x\"");
    }

    #[test]
    fn what_is_wrong_with_the_whole_table_is_said() {
        for (text, said) in [
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
            let problem = table(text).expect_err(said).to_string();
            assert!(problem.contains(said), "{text:?}: {problem}");
        }
        let utf16 = parsed(b"\xff\xfes\0o\0", Path::new("")).expect_err("UTF-16");
        assert!(utf16.to_string().contains("UTF-8"));
    }

    #[test]
    fn what_is_wrong_with_a_row_stays_with_it() {
        let found = pairs("source,target,k\na,b,\na,,1\na,b\na,b,1,2\n\"a\nb\nc,d,e");
        let said = [
            "",
            "target is empty",
            "2 cells",
            "4 cells",
            "target is empty",
        ];
        assert_eq!(found.len(), said.len(), "{found:?}");
        assert!(found[0].is_ok());
        for (row, said) in found.iter().zip(said).skip(1) {
            let problem = row.as_ref().expect_err(said).to_string();
            assert!(
                problem.contains(said) || problem.contains("close its quote"),
                "{problem}"
            );
        }
    }
}

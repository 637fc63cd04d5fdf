//! Rows of the report on a table of pairs as CSV, and the file in which finished rows are saved.
//!
//! As soon as a pair is measured, its row is written to `report.partial.csv` next to `report.csv`,
//! so finished work is not lost if the program is interrupted. The file contains complete rows
//! only, in the order in which they were finished. An existing file of this name is not replaced;
//! the next one gets a number.

use std::fs::{self, File};
use std::io::{self, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use crate::io::escape::csv_line;

use super::columns;
use super::report::PairReport;
use super::table::{PairTable, PairTableRow};

/// Returns the header of the report as a line of CSV: the headings of the input table, `direction`,
/// `status`, and the headings of the measures.
pub(super) fn header(table: &PairTable) -> Vec<u8> {
    let result = [columns::DIRECTION, columns::STATUS].map(str::to_owned);
    let measures = columns::ALL.iter().map(columns::ReportColumn::heading);
    let headings = table.header.iter().cloned().chain(result).chain(measures);
    csv_line(headings)
}

/// Returns the row of a pair as a line of CSV: the cells of the input table, the direction, the
/// status, and the measures. `report` is an error message if the pair failed.
pub(super) fn row(
    row: &PairTableRow,
    backward: bool,
    report: Result<&PairReport, &str>,
) -> Vec<u8> {
    let direction = if backward { "backward" } else { "forward" };
    let status = report.err().unwrap_or("ok");
    let measures = columns::ALL.iter().map(|column| match report {
        Ok(report) => column.cell(report),
        Err(_) => String::new(),
    });
    let result = [direction, status].map(str::to_owned).into_iter();
    let report_cells = result.chain(measures).map(String::into_bytes);
    csv_line(row.cells.iter().cloned().chain(report_cells))
}

/// File with the finished rows of a report, until all pairs are measured.
pub(super) struct PartialTable {
    /// Path of the file.
    pub path: PathBuf,
    saved: Mutex<SavedRows>,
}

/// The open file and the number of rows in it, without the header.
struct SavedRows {
    file: File,
    count: usize,
}

impl PartialTable {
    /// Creates a new file next to the path of the report, and writes the header.
    ///
    /// # Errors
    /// The file cannot be created or written. The report could not be written either.
    pub fn begin(report: &Path, header: &[u8]) -> io::Result<Self> {
        for number in 1u32.. {
            let path = partial_path(report, number);
            match File::create_new(&path) {
                Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {}
                Err(error) => return Err(error),
                Ok(mut file) => {
                    let written = file.write_all(header);
                    let saved = Mutex::new(SavedRows { file, count: 0 });
                    let partial = Self { path, saved };
                    // If the header could not be written, the file is of no use and is removed.
                    return match written {
                        Ok(()) => Ok(partial),
                        Err(error) => partial.remove().and(Err(error)),
                    };
                }
            }
        }
        Err(io::ErrorKind::AlreadyExists.into())
    }

    /// Appends a row. If it cannot be written, for example because the disk is full, the row is
    /// only in the final report.
    pub fn keep(&self, row: &[u8]) {
        // Rows are complete whenever the lock is free, even after a panic.
        let mut saved = self.saved.lock().unwrap_or_else(PoisonError::into_inner);
        let SavedRows { file, count } = &mut *saved;
        let Ok(end) = file.stream_position() else {
            return;
        };
        match file.write_all(row) {
            Ok(()) => *count += 1,
            Err(_) => {
                // Removes the part of the row that was written.
                let restored = file
                    .set_len(end)
                    .and_then(|()| file.seek(SeekFrom::Start(end)));
                restored.map(drop).unwrap_or_default();
            }
        }
    }

    /// Returns the number of saved rows.
    pub fn rows(&self) -> usize {
        let saved = self.saved.lock().unwrap_or_else(PoisonError::into_inner);
        saved.count
    }

    /// Deletes the file, because the report has been written or no row was saved.
    ///
    /// # Errors
    /// The file cannot be deleted.
    pub fn remove(self) -> io::Result<()> {
        fs::remove_file(self.path)
    }
}

/// Returns the path of a partial table: `report.partial.csv` for `report.csv` and number 1,
/// `report.partial-2.csv` for number 2.
fn partial_path(report: &Path, number: u32) -> PathBuf {
    let mut name = report.file_stem().unwrap_or_default().to_owned();
    name.push(".partial");
    if number > 1 {
        name.push(format!("-{number}"));
    }
    if let Some(extension) = report.extension() {
        name.push(".");
        name.push(extension);
    }
    report.with_file_name(name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_existing_partial_table_is_not_replaced() {
        let folder = tempfile::tempdir().expect("a folder");
        let report = folder.path().join("a.b.csv");
        for name in ["a.b.partial.csv", "a.b.partial-2.csv"] {
            let partial = PartialTable::begin(&report, b"x\n").expect("created");
            assert_eq!(partial.path, folder.path().join(name));
            partial.keep(b"1\n");
            assert_eq!(partial.rows(), 1);
            assert_eq!(fs::read(&partial.path).expect("read"), b"x\n1\n");
        }
        assert_eq!(partial_path("r".as_ref(), 1), Path::new("r.partial"));
    }
}

//! The report on a table of pairs as CSV, and where its rows are kept until it
//! is whole.
//!
//! A row is written as soon as it is known, in `report.partial.csv` beside
//! `report.csv`, so that the work that was done is there however the program
//! ends. Rows stand in the order in which they became known, whole ones only. An
//! earlier file of that name stays, and the next one has a number.

use std::fs::{self, File};
use std::io::{self, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use super::columns;
use super::report::PairReport;
use super::table::{PairTable, PairTableRow};

/// The names of all columns: those of the table, then the report's.
pub(super) fn header(table: &PairTable) -> Vec<u8> {
    let own = [columns::DIRECTION, columns::STATUS].map(str::to_owned);
    let measures = columns::ALL.iter().map(columns::ReportColumn::heading);
    let names = table.header.iter().cloned().chain(own).chain(measures);
    line(names.map(String::into_bytes))
}

/// What became of a row of the table.
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
    let own = [direction, status].map(str::to_owned).into_iter();
    let own = own.chain(measures).map(String::into_bytes);
    line(row.cells.iter().cloned().chain(own))
}

fn line(cells: impl Iterator<Item = Vec<u8>>) -> Vec<u8> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    // Into memory, which refuses nothing.
    writer.write_record(cells).unwrap_or_default();
    writer.into_inner().unwrap_or_default()
}

/// Rows of a report that is not whole yet.
pub(super) struct PartialTable {
    /// Where they are.
    pub path: PathBuf,
    kept: Mutex<SavedRows>,
}

struct SavedRows {
    file: File,
    rows: usize,
}

impl PartialTable {
    /// Begins a new file beside the place of the report.
    ///
    /// # Errors
    /// It cannot be written, and neither can the report.
    pub fn begin(report: &Path, header: &[u8]) -> io::Result<Self> {
        for number in 1u32.. {
            let path = partial_of(report, number);
            match File::create_new(&path) {
                Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {}
                Err(error) => return Err(error),
                Ok(mut file) => {
                    let begun = file.write_all(header);
                    let kept = Mutex::new(SavedRows { file, rows: 0 });
                    let partial = Self { path, kept };
                    // Without rows it is of no use to anybody.
                    return match begun {
                        Ok(()) => Ok(partial),
                        Err(error) => partial.remove().and(Err(error)),
                    };
                }
            }
        }
        Err(io::ErrorKind::AlreadyExists.into())
    }

    /// Keeps a row, if there is room for it: else it is in the report alone.
    pub fn keep(&self, row: &[u8]) {
        // Rows are whole whenever the lock is free, even after a panic.
        let mut kept = self.kept.lock().unwrap_or_else(PoisonError::into_inner);
        let SavedRows { file, rows } = &mut *kept;
        let Ok(end) = file.stream_position() else {
            return;
        };
        match file.write_all(row) {
            Ok(()) => *rows += 1,
            Err(_) => {
                let back = file
                    .set_len(end)
                    .and_then(|()| file.seek(SeekFrom::Start(end)));
                back.map(drop).unwrap_or_default();
            }
        }
    }

    /// How many rows are there.
    pub fn rows(&self) -> usize {
        let kept = self.kept.lock().unwrap_or_else(PoisonError::into_inner);
        kept.rows
    }

    /// Takes it away, once the report is there or where nothing was kept.
    ///
    /// # Errors
    /// It stays.
    pub fn remove(self) -> io::Result<()> {
        fs::remove_file(self.path)
    }
}

/// `report.partial.csv` for `report.csv`, then `report.partial-2.csv`.
fn partial_of(report: &Path, number: u32) -> PathBuf {
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
    fn an_earlier_file_stays_and_the_next_one_has_a_number() {
        let folder = tempfile::tempdir().expect("a folder");
        let report = folder.path().join("a.b.csv");
        for name in ["a.b.partial.csv", "a.b.partial-2.csv"] {
            let partial = PartialTable::begin(&report, b"x\n").expect("begun");
            assert_eq!(partial.path, folder.path().join(name));
            partial.keep(b"1\n");
            assert_eq!(partial.rows(), 1);
            assert_eq!(fs::read(&partial.path).expect("read"), b"x\n1\n");
        }
        assert_eq!(partial_of("r".as_ref(), 1), Path::new("r.partial"));
    }
}

//! Rows of the report on a table of pairs as CSV, and the file in which finished rows are saved.
//!
//! As soon as a pair is measured, its row is written to `report.partial.csv` next to `report.csv`,
//! so finished work is not lost if the program is interrupted. The file contains complete rows
//! only, in the order in which they were finished. An existing file of this name is not replaced;
//! the next one gets a number. After writing the report, a run deletes its own partial table and
//! those of interrupted runs. Partial tables of running runs stay.

use std::fs::{self, File};
use std::io::{self, BufRead, BufReader, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use crate::io::atomic_file::{remove_unowned, try_lock};
use crate::io::escape::csv_line;

use super::columns;
use super::report::PairReport;
use super::table::{PairTable, PairTableRow};

/// Returns the header of the report as a line of CSV: the headings of the input table, `direction`,
/// `status`, and the headings of the measures.
pub(super) fn header(table: &PairTable) -> Vec<u8> {
    csv_line(table.header.iter().cloned().chain(result_headings()))
}

/// Returns the headings that follow those of the input table.
fn result_headings() -> impl Iterator<Item = String> {
    let result = [columns::DIRECTION, columns::STATUS].map(str::to_owned);
    let measures = columns::ALL.iter().map(columns::ReportColumn::heading);
    result.into_iter().chain(measures)
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
                // The lock shows other runs that the file is in use.
                Ok(file) if !try_lock(&file)? => {}
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

    /// Deletes this run's file after `report` was written, and the partial tables of interrupted
    /// runs. Returns the paths of the latter.
    ///
    /// # Errors
    /// This run's file cannot be deleted.
    pub fn finish(self, report: &Path) -> io::Result<Vec<PathBuf>> {
        let mut left = interrupted_tables(report);
        left.retain(|path| *path != self.path);
        self.remove()?;
        left.retain(|path| remove_unowned(path));
        Ok(left)
    }

    /// Deletes the file, because no row was saved.
    ///
    /// # Errors
    /// The file cannot be deleted.
    pub fn remove(self) -> io::Result<()> {
        fs::remove_file(self.path)
    }
}

/// Returns the paths of the partial tables of a report. Files with the name of a partial table but
/// with other contents are left out.
fn interrupted_tables(report: &Path) -> Vec<PathBuf> {
    let paths = (1u32..).map(|number| partial_path(report, number));
    let existing = paths.take_while(|path| path.symlink_metadata().is_ok());
    existing.filter(|path| is_partial_table(path)).collect()
}

/// Returns whether a file has the headings of a report, or is empty because the program was killed
/// before it wrote them.
fn is_partial_table(path: &Path) -> bool {
    let is_file = |data: fs::Metadata| data.is_file();
    if !path.symlink_metadata().is_ok_and(is_file) {
        return false;
    }
    let Ok(file) = File::open(path) else {
        return false;
    };
    let headings = csv_line(result_headings());
    let mut lines = BufReader::new(file).split(b'\n').map_while(Result::ok);
    // A heading of the input table may contain line breaks, so the first line may not be the last
    // of the headings.
    match lines.next() {
        None => true,
        Some(first) => std::iter::once(first)
            .chain(lines)
            .any(|line| line.ends_with(headings.trim_ascii_end())),
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

    #[test]
    fn a_finished_run_removes_the_tables_of_interrupted_ones_only() {
        let folder = tempfile::tempdir().expect("a folder");
        let report = folder.path().join("r.csv");
        let table = PairTable {
            header: vec!["note\nof the pair".to_owned()],
            rows: Vec::new(),
        };
        let begin = || PartialTable::begin(&report, &header(&table)).expect("created");
        fs::write(partial_path(&report, 1), "notes\nof mine\n").expect("written");
        let (interrupted, running, finished) = (begin(), begin(), begin());
        fs::write(partial_path(&report, 5), "").expect("written");
        let [left, kept] = [&interrupted, &running].map(|partial| partial.path.clone());
        // Releases the lock, as the system does when a process ends.
        drop(interrupted);
        let removed = finished.finish(&report).expect("removed");
        assert_eq!(removed, [left, partial_path(&report, 5)]);
        assert!(kept.exists() && partial_path(&report, 1).exists());
        assert_eq!(fs::read_dir(&folder).expect("listed").count(), 2);
    }
}

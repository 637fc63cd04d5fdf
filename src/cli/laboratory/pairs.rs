//! `check --pairs`: measures the pairs of a table on all cores, and writes a report and a contact
//! sheet.
//!
//! Guarantees: the report has a row for each pair and direction, in the order of the table, even if
//! a pair fails. Report and sheet are written atomically once all pairs are measured. Finished rows
//! are saved before that, and remain if the program is interrupted. Unless `--one-by-one` is given,
//! times are measured while other pairs use the other cores.

use std::io;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};

use clap::Args;
use rayon::prelude::*;

use super::report::{MeasuringArgs, PairReport};
use super::rows;
use super::rows::PartialTable;
use super::summary::PairSummary;
use super::table;
use super::table::{PairRowError, PairTable, PairTableRow};
use crate::cli::error::CliError;
use crate::cli::input_files::InputFiles;
use crate::cli::inputs::{InputArgs, OpenedPair};
use crate::design::DesignSource;
use crate::export::{
    ExportError, ExportTarget, PairStrip, StillKind, even_times, pair_sheet, write_atomically,
    write_still,
};
use crate::io::atomic_file::write_error_message;
use crate::io::file_id::FileId;
use crate::io::sanitize::SanitizedLine;
use crate::transition::TransitionStyle;
use crate::work::panic_boundary::catch_panic;
use crate::work::progress::Progress;

/// Number of frames in a strip of the contact sheet (heuristic).
const STRIP_FRAMES: usize = 7;

/// Options of `check --pairs`: the input table and the output files.
// `required = false` is needed because without --pairs none of these options is required.
#[derive(Debug, Args)]
pub(in crate::cli) struct PairBatchArgs {
    /// Measure the pairs of a table instead: a CSV file with the columns source and target; paths
    /// are relative to its folder, and other columns are copied to the report
    #[arg(long, value_name = "FILE.csv", required = false, requires = "out")]
    pairs: PathBuf,

    /// With --pairs: report file, with one row per pair. Finished rows are saved in
    /// FILE.partial.csv until all pairs are measured. After an interrupted run, that file stays
    /// until a run with the same FILE finishes
    #[arg(long, value_name = "FILE.csv", required = false, requires = "pairs")]
    out: PathBuf,

    /// With --pairs: also write a contact sheet with a strip for each pair (.png or .svg)
    #[arg(long, value_name = "FILE.png", requires = "pairs")]
    sheet: Option<PathBuf>,

    /// With --pairs: measure each pair in both directions
    #[arg(long, requires = "pairs")]
    both: bool,

    /// With --pairs: measure one pair at a time instead of several in parallel, so that times are
    /// as in the window
    #[arg(long, requires = "pairs")]
    one_by_one: bool,
}

/// Result of measuring a table.
pub(in crate::cli) struct PairBatchOutcome {
    /// Summary of all pairs.
    pub summary: PairSummary,
    /// Descriptions of the written files: the path, and whether pairs are missing on the sheet.
    pub written: Vec<String>,
    /// Line of the first pair that failed, from 1, and its error message.
    pub first_failure: Option<(u64, String)>,
    /// If the work was cancelled: a message with the number of finished pairs.
    pub ended: Option<String>,
}

/// A pair of the table in one direction.
struct PairJob<'a> {
    row: &'a PairTableRow,
    /// Whether the film goes from target to source.
    backward: bool,
}

/// Result of measuring a pair in one direction.
struct PairResult<'a> {
    job: &'a PairJob<'a>,
    /// Report without samples, or the error message in one line.
    report: Result<PairReport, String>,
    /// Strip of the contact sheet; `None` without `--sheet`.
    strip: Option<PairStrip>,
}

impl PairBatchArgs {
    /// Measures every pair and writes the report and the contact sheet.
    ///
    /// # Errors
    /// The table cannot be read, or an output file cannot be written. A pair that fails is not an
    /// error, and neither is a cancellation.
    pub fn run(
        &self,
        measuring: &MeasuringArgs,
        progress: &dyn Progress,
    ) -> Result<PairBatchOutcome, CliError> {
        let sheet = match &self.sheet {
            Some(path) => Some((sheet_kind(path)?, path)),
            None => None,
        };
        self.check_output_paths()?;
        let outputs = || std::iter::once(&self.out).chain(&self.sheet);
        let inputs = InputFiles::default().with_file(&self.pairs);
        // The table is checked before it is parsed, because an earlier run may already have
        // overwritten it.
        inputs.check_outputs(outputs())?;
        let table = table::read(&self.pairs)
            .map_err(|error| CliError::Failed(format!("`{}`: {error}", self.pairs.display())))?;
        let designs = table.rows.iter().filter_map(|row| row.pair.as_ref().ok());
        let designs = designs.flatten().map(PathBuf::as_path);
        let inputs = inputs.with_designs(Path::new(""), designs);
        inputs.check_outputs(outputs())?;
        let jobs = self.jobs(&table);
        let partial = PartialTable::begin(&self.out, &rows::header(&table));
        let partial = partial.map_err(|source| {
            let path = self.out.clone();
            CliError::failed(ExportError::Write { path, source })
        })?;
        let results = self.measure_all(&jobs, &partial, measuring, progress);
        let unfinished = jobs.len() - results.len();
        let (written, ended) = if unfinished > 0 {
            (Vec::new(), Some(cancelled_message(partial, jobs.len())?))
        } else {
            progress.report("writing", 1.0);
            (self.write(&table, &results, partial, sheet)?, None)
        };
        let failure = |r: &PairResult<'_>| Some((r.job.row.line, r.report.as_ref().err()?.clone()));
        Ok(PairBatchOutcome {
            summary: PairSummary::of(results.iter().map(|r| r.report.as_ref().ok()), unfinished),
            written,
            first_failure: results.iter().find_map(failure),
            ended,
        })
    }

    /// Writes the report and the contact sheet, and deletes the partial table. Returns descriptions
    /// of the written files.
    fn write(
        &self,
        table: &PairTable,
        results: &[PairResult<'_>],
        partial: PartialTable,
        sheet: Option<(StillKind, &PathBuf)>,
    ) -> Result<Vec<String>, CliError> {
        let lines = std::iter::once(rows::header(table)).chain(results.iter().map(PairResult::row));
        let bytes = lines.collect::<Vec<_>>().concat();
        write_atomically(&self.out, &bytes).map_err(|error| {
            let path = partial.path.display();
            CliError::Failed(format!("{error}; the rows are saved in `{path}`"))
        })?;
        let removed = partial.finish(&self.out).map_err(CliError::failed)?;
        let remark = removed.iter().map(|path| {
            let path = path.display();
            format!(" (and removed `{path}`, left by an interrupted run)")
        });
        let mut written = vec![self.out.display().to_string() + &remark.collect::<String>()];
        if let Some((kind, path)) = sheet {
            let remark = write_sheet(results, kind, path)?;
            written.push(path.display().to_string() + &remark);
        }
        Ok(written)
    }

    /// Checks before the work that the output files can be written and are not the same file.
    fn check_output_paths(&self) -> Result<(), CliError> {
        for path in std::iter::once(&self.out).chain(&self.sheet) {
            let shown = path.display();
            let folder = path.parent().filter(|f| !f.as_os_str().is_empty());
            if path.exists() && !path.is_file() {
                return Err(CliError::Failed(format!(
                    "cannot write `{shown}`: it is not a file; choose another name for the output"
                )));
            }
            if let Some(folder) = folder.filter(|folder| !folder.is_dir()) {
                let kind = match folder.exists() {
                    true => io::ErrorKind::NotADirectory,
                    false => io::ErrorKind::NotFound,
                };
                return Err(CliError::Failed(format!(
                    "cannot write `{shown}`: {}",
                    write_error_message(&kind.into())
                )));
            }
        }
        if (self.sheet.as_ref()).is_some_and(|sheet| is_same_output(sheet, &self.out)) {
            let message = "--out and --sheet are the same file; choose two names";
            return Err(CliError::Usage(message.to_owned()));
        }
        Ok(())
    }

    /// Returns the pairs to measure: each row in one or both directions.
    fn jobs<'a>(&self, table: &'a PairTable) -> Vec<PairJob<'a>> {
        let directions: &[bool] = if self.both { &[false, true] } else { &[false] };
        let jobs_of_row = |row| {
            let job = move |&backward| PairJob { row, backward };
            directions.iter().map(job)
        };
        table.rows.iter().flat_map(jobs_of_row).collect()
    }

    /// Measures the pairs and returns the results in the order of `jobs`, without the jobs that
    /// were not finished when the work was cancelled.
    fn measure_all<'a>(
        &self,
        jobs: &'a [PairJob<'a>],
        partial: &PartialTable,
        measuring: &MeasuringArgs,
        progress: &dyn Progress,
    ) -> Vec<PairResult<'a>> {
        const STAGE: &str = "checking pairs";
        let finished = AtomicUsize::new(0);
        progress.report(STAGE, 0.0);
        let measure = |job| {
            if progress.is_cancelled() {
                return None;
            }
            let result = self.measure_one(job, measuring, progress);
            // The error is probably the cancellation, not a failure of the pair.
            if progress.is_cancelled() && result.report.is_err() {
                return None;
            }
            partial.keep(&result.row());
            let count = finished.fetch_add(1, Ordering::Relaxed) + 1;
            progress.report(STAGE, count as f64 / jobs.len() as f64);
            Some(result)
        };
        if self.one_by_one {
            return jobs.iter().filter_map(measure).collect();
        }
        // Each core takes one pair at a time, because some pairs take much longer than others.
        jobs.par_iter()
            .with_max_len(1)
            .filter_map(measure)
            .collect()
    }

    /// Measures a pair. An error or a panic becomes the result of the pair.
    fn measure_one<'a>(
        &self,
        job: &'a PairJob<'a>,
        measuring: &MeasuringArgs,
        progress: &dyn Progress,
    ) -> PairResult<'a> {
        let measure = || {
            let (opened, report) = measuring.of_pair(&job.inputs()?, &QuietProgress(progress))?;
            let strip = self.sheet.is_some().then(|| strip(&opened, &report, job));
            Ok((report.without_samples(), strip))
        };
        // A panic in one pair must not stop the work on the others.
        let outcome = catch_panic(measure).unwrap_or_else(|message| Err(panic_error(&message)));
        let (report, strip) = match outcome {
            Ok((report, strip)) => (Ok(report), strip),
            Err(error) => {
                // A cell of the table holds one line.
                let reason = SanitizedLine(error).to_string();
                let failed_strip = || PairStrip::failed(&job.name(), &format!("failed: {reason}"));
                let strip = self.sheet.is_some().then(failed_strip);
                (Err(reason), strip)
            }
        };
        PairResult { job, report, strip }
    }
}

/// Returns whether two outputs are the same file, which may not exist yet.
fn is_same_output(a: &Path, b: &Path) -> bool {
    let parts = |path: &Path| {
        let folder = path.parent().unwrap_or(path);
        let name = path.file_name().map(ToOwned::to_owned);
        (FileId::of(&Path::new(".").join(folder)), name)
    };
    match (FileId::of(a), FileId::of(b)) {
        (None, None) => parts(a) == parts(b),
        (a, b) => a == b,
    }
}

/// Returns a message that says how many of `total` rows are finished and where they are saved.
/// Deletes the partial table if it has no rows.
fn cancelled_message(partial: PartialTable, total: usize) -> Result<String, CliError> {
    let count = partial.rows();
    if count == 0 {
        partial.remove().map_err(CliError::failed)?;
        return Ok(format!(
            "cancelled before any of the {total} pairs was measured"
        ));
    }
    let path = partial.path.display();
    Ok(format!(
        "cancelled; {count} of {total} rows are saved in `{path}`"
    ))
}

/// Returns the error for a panic while a pair was measured.
fn panic_error(message: &str) -> CliError {
    CliError::Failed(format!(
        "internal error ({message}); please report it with both designs"
    ))
}

impl PairResult<'_> {
    /// Returns the row of the report, as a line of CSV.
    fn row(&self) -> Vec<u8> {
        let report = self.report.as_ref().map_err(String::as_str);
        rows::row(self.job.row, self.job.backward, report)
    }
}

impl PairJob<'_> {
    /// Returns the paths of the designs at t = 0 and t = 1 in this direction.
    fn pair(&self) -> Result<[&Path; 2], &PairRowError> {
        let [source, target] = self.row.pair.as_ref()?;
        Ok(match self.backward {
            true => [target, source],
            false => [source, target],
        })
    }

    fn inputs(&self) -> Result<InputArgs, CliError> {
        let [source, target] = self.pair().map_err(CliError::failed)?;
        Ok(InputArgs::pair(source, target))
    }

    /// Returns the names of the two designs; for a row without a valid pair, its line number in the
    /// table.
    fn name(&self) -> String {
        match self.pair() {
            Ok(pair) => pair
                .map(|path| DesignSource::from_path(path).name())
                .join(" to "),
            Err(_) => format!("line {}", self.row.line),
        }
    }
}

/// A [`Progress`] for one pair: forwards cancellation, but not the stages, because many pairs are
/// measured at the same time.
struct QuietProgress<'a>(&'a dyn Progress);

impl Progress for QuietProgress<'_> {
    fn report(&self, _: &'static str, _: f64) {}

    fn is_cancelled(&self) -> bool {
        self.0.is_cancelled()
    }
}

/// Returns the file type of the contact sheet.
fn sheet_kind(path: &Path) -> Result<StillKind, CliError> {
    match ExportTarget::of_path(path) {
        Ok(ExportTarget::Still(kind, _)) => Ok(kind),
        _ => Err(CliError::Usage(format!(
            "cannot write a contact sheet as `{}`; choose a name that ends in .png or .svg",
            path.display()
        ))),
    }
}

/// Returns the strip of a pair for the contact sheet.
fn strip(opened: &OpenedPair, report: &PairReport, job: &PairJob<'_>) -> PairStrip {
    let style: &TransitionStyle = &opened.loaded.project.style;
    let times = even_times(0.0, 1.0, STRIP_FRAMES);
    PairStrip::of(&job.name(), &opened.transition, style, &times)
        .with_remark(&report.verdict.words, !report.verdict.findings.is_empty())
}

/// Writes the contact sheet. Returns a remark if there was no room for all strips, else an empty
/// text.
fn write_sheet(
    results: &[PairResult<'_>],
    kind: StillKind,
    path: &Path,
) -> Result<String, CliError> {
    let strips: Vec<PairStrip> = results.iter().filter_map(|r| r.strip.clone()).collect();
    let ground = Some(TransitionStyle::default().ground);
    let (drawing, shown) = pair_sheet(&strips, ground).map_err(CliError::failed)?;
    write_still(&drawing, kind, path).map_err(CliError::failed)?;
    Ok(if shown < strips.len() {
        format!(" (the first {shown} of {} pairs)", strips.len())
    } else {
        String::new()
    })
}

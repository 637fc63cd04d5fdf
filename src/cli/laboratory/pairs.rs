//! The pairs of a table, over all cores.
//!
//! Guarantees: a row for each pair and direction, in the order of the table,
//! whatever happens to it; report and sheet are written whole or not at all,
//! at the end; rows that are done are kept however the work ends. Times are
//! taken while other pairs run on the other cores, unless they go one by one.

use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind};
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
use crate::cli::inputs::{InputArgs, OpenedPair};
use crate::design::DesignSource;
use crate::export::{
    ExportError, ExportTarget, PairStrip, StillKind, even_times, pair_sheet, write_atomically,
    write_still,
};
use crate::io::sanitize::SanitizedLine;
use crate::transition::TransitionStyle;
use crate::work::progress::Progress;

/// Frames of a strip of the sheet.
const STRIP_FRAMES: usize = 7;

/// A table to be worked through, and what comes of it.
// The fields are needed of a table only, so that the parser must not ask for
// them.
#[derive(Debug, Args)]
pub(in crate::cli) struct PairBatchArgs {
    /// A table of pairs instead: a CSV file with the columns source and target,
    /// paths relative to its folder; other columns are carried along
    #[arg(long, value_name = "FILE.csv", required = false, requires = "out")]
    pairs: PathBuf,

    /// With --pairs: where the report goes, a row for each pair; until it is
    /// whole, rows that are done are kept beside it, in FILE.partial.csv
    #[arg(long, value_name = "FILE.csv", required = false, requires = "pairs")]
    out: PathBuf,

    /// With --pairs: a contact sheet too, a strip for each pair (.png or .svg)
    #[arg(long, value_name = "FILE.png", requires = "pairs")]
    sheet: Option<PathBuf>,

    /// With --pairs: each pair in both directions
    #[arg(long, requires = "pairs")]
    both: bool,

    /// With --pairs: one pair after the other, so that each has the machine for
    /// itself and its times are those of the window
    #[arg(long, requires = "pairs")]
    one_by_one: bool,
}

/// What became of a table.
pub(in crate::cli) struct PairBatchOutcome {
    /// All pairs in short.
    pub summary: PairSummary,
    /// The files that were written, in words.
    pub written: Vec<String>,
    /// The line of the first pair that failed, and why it did.
    pub first_failure: Option<(u64, String)>,
    /// How far it came, where it was ended before.
    pub ended: Option<String>,
}

/// A row in one direction.
struct PairJob<'a> {
    row: &'a PairTableRow,
    backward: bool,
}

/// What came of it.
struct PairResult<'a> {
    job: &'a PairJob<'a>,
    report: Result<PairReport, String>,
    strip: Option<PairStrip>,
}

impl PairBatchArgs {
    /// Measures every pair and writes what was found.
    pub fn run(
        &self,
        measuring: &MeasuringArgs,
        progress: &dyn Progress,
    ) -> Result<PairBatchOutcome, CliError> {
        let sheet = match &self.sheet {
            Some(path) => Some((sheet_kind(path)?, path)),
            None => None,
        };
        self.check_places()?;
        let table = table::read(&self.pairs)
            .map_err(|error| CliError::Failed(format!("`{}`: {error}", self.pairs.display())))?;
        let jobs = self.jobs(&table);
        let partial = PartialTable::begin(&self.out, &rows::header(&table));
        let partial = partial.map_err(|source| {
            let path = self.out.clone();
            CliError::failed(ExportError::Write { path, source })
        })?;
        let done = self.work(&jobs, &partial, measuring, progress);
        let unfinished = jobs.len() - done.len();
        let (written, ended) = if unfinished > 0 {
            (Vec::new(), Some(ended(partial, jobs.len())?))
        } else {
            progress.report("writing", 1.0);
            (self.write(&table, &done, partial, sheet)?, None)
        };
        let failure = |d: &PairResult<'_>| Some((d.job.row.line, d.report.as_ref().err()?.clone()));
        Ok(PairBatchOutcome {
            summary: PairSummary::of(done.iter().map(|d| d.report.as_ref().ok()), unfinished),
            written,
            first_failure: done.iter().find_map(failure),
            ended,
        })
    }

    /// Writes report and sheet; what was written, in words.
    fn write(
        &self,
        table: &PairTable,
        done: &[PairResult<'_>],
        partial: PartialTable,
        sheet: Option<(StillKind, &PathBuf)>,
    ) -> Result<Vec<String>, CliError> {
        let all = std::iter::once(rows::header(table)).chain(done.iter().map(PairResult::row));
        let bytes = all.collect::<Vec<_>>().concat();
        write_atomically(&self.out, &bytes).map_err(|error| {
            let kept = partial.path.display();
            CliError::Failed(format!("{error}; until then the rows are in `{kept}`"))
        })?;
        partial.remove().map_err(CliError::failed)?;
        let mut written = vec![self.out.display().to_string()];
        if let Some((kind, path)) = sheet {
            let left_out = write_sheet(done, kind, path)?;
            written.push(path.display().to_string() + &left_out);
        }
        Ok(written)
    }

    /// Before the work and not after it: whether what comes out can be
    /// written, and over nothing that goes in.
    fn check_places(&self) -> Result<(), CliError> {
        let same = |a: &Path, b: &Path| match (a.canonicalize(), b.canonicalize()) {
            // A file that is not there yet is compared as it is written.
            (Ok(a), Ok(b)) => a == b,
            _ => a == b,
        };
        for path in std::iter::once(&self.out).chain(&self.sheet) {
            let shown = path.display();
            if same(path, &self.pairs) {
                return Err(CliError::Usage(format!(
                    "`{shown}` is the table itself: choose another name for the output"
                )));
            }
            let folder = path.parent().filter(|f| !f.as_os_str().is_empty());
            if path.exists() && !path.is_file() {
                return Err(CliError::Failed(format!(
                    "cannot write `{shown}`: it is no file; choose another name for the output"
                )));
            }
            if folder.is_some_and(|folder| !folder.is_dir()) {
                return Err(CliError::Failed(format!(
                    "cannot write `{shown}`: name a file in a folder that exists"
                )));
            }
        }
        if (self.sheet.as_ref()).is_some_and(|sheet| same(sheet, &self.out)) {
            let one = "--out and --sheet are one file: choose two names";
            return Err(CliError::Usage(one.to_owned()));
        }
        Ok(())
    }

    fn jobs<'a>(&self, table: &'a PairTable) -> Vec<PairJob<'a>> {
        let directions: &[bool] = if self.both { &[false, true] } else { &[false] };
        let of_row = |row| {
            let job = move |&backward| PairJob { row, backward };
            directions.iter().map(job)
        };
        table.rows.iter().flat_map(of_row).collect()
    }

    /// What came of the jobs, in their order; without those that were not done
    /// before nobody wanted them any more.
    fn work<'a>(
        &self,
        jobs: &'a [PairJob<'a>],
        partial: &PartialTable,
        measuring: &MeasuringArgs,
        progress: &dyn Progress,
    ) -> Vec<PairResult<'a>> {
        const STAGE: &str = "checking pairs";
        let finished = AtomicUsize::new(0);
        progress.report(STAGE, 0.0);
        let one = |job| {
            if progress.is_cancelled() {
                return None;
            }
            let done = self.one(job, measuring, progress);
            // One that was cut short says so, which is not what became of it.
            if progress.is_cancelled() && done.report.is_err() {
                return None;
            }
            partial.keep(&done.row());
            let count = finished.fetch_add(1, Ordering::Relaxed) + 1;
            progress.report(STAGE, count as f64 / jobs.len() as f64);
            Some(done)
        };
        if self.one_by_one {
            return jobs.iter().filter_map(one).collect();
        }
        // One at a time: pairs take unlike long, and a core with none is idle.
        jobs.par_iter().with_max_len(1).filter_map(one).collect()
    }

    fn one<'a>(
        &self,
        job: &'a PairJob<'a>,
        measuring: &MeasuringArgs,
        progress: &dyn Progress,
    ) -> PairResult<'a> {
        let measured = || {
            let (opened, report) = measuring.of_pair(&job.inputs()?, &QuietProgress(progress))?;
            let strip = self.sheet.is_some().then(|| strip(&opened, &report, job));
            Ok((report.without_samples(), strip))
        };
        // One pair must not end the work on all others, whatever it is.
        let caught = catch_unwind(AssertUnwindSafe(measured));
        let (report, strip) = match caught.unwrap_or_else(|panic| Err(of_panic(&*panic))) {
            Ok((report, strip)) => (Ok(report), strip),
            Err(error) => {
                // For a cell of the table.
                let reason = SanitizedLine(error).to_string();
                let failed = || PairStrip::failed(&job.name(), &format!("failed: {reason}"));
                let strip = self.sheet.is_some().then(failed);
                (Err(reason), strip)
            }
        };
        PairResult { job, report, strip }
    }
}

/// Says how far the work came, and where that is.
fn ended(partial: PartialTable, of: usize) -> Result<String, CliError> {
    let count = partial.rows();
    if count == 0 {
        partial.remove().map_err(CliError::failed)?;
        return Ok(format!("cancelled before one of {of} pairs was done"));
    }
    let kept = partial.path.display();
    Ok(format!(
        "cancelled; {count} of {of} rows are kept in `{kept}`"
    ))
}

fn of_panic(panic: &(dyn Any + Send)) -> CliError {
    let text = panic.downcast_ref::<&str>().copied();
    let words = text.or_else(|| panic.downcast_ref::<String>().map(String::as_str));
    CliError::Failed(format!(
        "internal error ({}); please report it with both designs",
        words.unwrap_or("no words")
    ))
}

impl PairResult<'_> {
    fn row(&self) -> Vec<u8> {
        let report = self.report.as_ref().map_err(String::as_str);
        rows::row(self.job.row, self.job.backward, report)
    }
}

impl PairJob<'_> {
    /// Source and target, the way round that they are taken.
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

    /// The pair by the names of its designs.
    fn name(&self) -> String {
        match self.pair() {
            Ok(pair) => pair
                .map(|path| DesignSource::from_path(path).name())
                .join(" to "),
            Err(_) => format!("line {}", self.row.line),
        }
    }
}

/// Passes a cancel on, and keeps the many stages of many pairs to itself.
struct QuietProgress<'a>(&'a dyn Progress);

impl Progress for QuietProgress<'_> {
    fn report(&self, _: &'static str, _: f64) {}

    fn is_cancelled(&self) -> bool {
        self.0.is_cancelled()
    }
}

fn sheet_kind(path: &Path) -> Result<StillKind, CliError> {
    match ExportTarget::of_path(path) {
        Ok(ExportTarget::Still(kind, _)) => Ok(kind),
        _ => Err(CliError::Usage(format!(
            "`{}` is no picture: end --sheet in .png or .svg",
            path.display()
        ))),
    }
}

fn strip(opened: &OpenedPair, report: &PairReport, job: &PairJob<'_>) -> PairStrip {
    let style: &TransitionStyle = &opened.loaded.project.style;
    let times = even_times(0.0, 1.0, STRIP_FRAMES);
    PairStrip::of(&job.name(), &opened.transition, style, &times)
        .with_remark(&report.verdict.words, !report.verdict.findings.is_empty())
}

/// Writes the sheet; words about strips that had no room.
fn write_sheet(done: &[PairResult<'_>], kind: StillKind, path: &Path) -> Result<String, CliError> {
    let strips: Vec<PairStrip> = done.iter().filter_map(|d| d.strip.clone()).collect();
    let ground = Some(TransitionStyle::default().ground);
    let (drawing, shown) = pair_sheet(&strips, ground).map_err(CliError::failed)?;
    write_still(&drawing, kind, path).map_err(CliError::failed)?;
    Ok(if shown < strips.len() {
        format!(" (the first {shown} of {} pairs)", strips.len())
    } else {
        String::new()
    })
}

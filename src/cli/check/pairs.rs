//! `morphospace check --pairs`: a table of pairs over all cores.
//!
//! Guarantees: a row for each pair and direction, in the order of the table,
//! whatever happens to it; report and sheet are written whole or not at all,
//! at the end; a cancel writes nothing. Times are taken while other pairs run
//! on the other cores.

use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::sync::atomic::{AtomicUsize, Ordering};

use rayon::prelude::*;

use super::super::error::CliError;
use super::super::inputs::Opened;
use super::super::output;
use super::super::terminal::Terminal;
use super::CheckArgs;
use super::clock::StageClock;
use super::columns::{self, Value};
use super::report::Report;
use super::summary::Summary;
use super::table::{self, Row, Table};
use crate::design::Source;
use crate::export::{
    StillKind, Strip, Target, even_times, pair_sheet, write_atomically, write_still,
};
use crate::progress::Progress;
use crate::transition::Style;

/// Frames of a strip of the sheet.
const STRIP_FRAMES: usize = 7;

/// A row in one direction.
struct Job<'a> {
    row: &'a Row,
    backward: bool,
}

/// What came of it.
struct Done {
    result: Result<Vec<Option<Value>>, String>,
    strip: Option<Strip>,
}

pub(super) fn run(args: &CheckArgs, pairs: &Path, out: &Path) -> Result<(), CliError> {
    let sheet = args.sheet.as_deref().map(sheet_kind).transpose()?;
    check_places(pairs, out, args.sheet.as_deref())?;
    let terminal = Terminal::new();
    let table = table::read(pairs)?;
    let jobs = jobs(&table, args.both);
    let done = work(args, &jobs, &terminal);
    if terminal.is_cancelled() {
        return Err(CliError::Failed(
            "cancelled; nothing was written".to_owned(),
        ));
    }
    terminal.report("writing", 1.0);
    write_report(&table, &jobs, &done, out)?;
    let mut written = vec![out.display().to_string()];
    if let (Some(kind), Some(path)) = (sheet, &args.sheet) {
        let left_out = write_sheet(&done, kind, path)?;
        written.push(path.display().to_string() + &left_out);
    }
    drop(terminal);
    tell(args, &jobs, &done, &written)
}

fn sheet_kind(path: &Path) -> Result<StillKind, CliError> {
    match Target::of_path(path) {
        Ok(Target::Still(kind, _)) => Ok(kind),
        _ => Err(CliError::Usage(format!(
            "`{}` is no picture: end --sheet in .png or .svg",
            path.display()
        ))),
    }
}

/// Before the work and not after it: whether what comes out can be written,
/// and over nothing that goes in.
fn check_places(pairs: &Path, out: &Path, sheet: Option<&Path>) -> Result<(), CliError> {
    let same = |a: &Path, b: &Path| match (a.canonicalize(), b.canonicalize()) {
        (Ok(a), Ok(b)) => a == b,
        _ => a == b,
    };
    let outputs = [Some(out), sheet].into_iter().flatten();
    for path in outputs.clone() {
        let shown = path.display();
        if same(path, pairs) {
            return Err(CliError::Usage(format!(
                "`{shown}` is the table itself: choose another name for the output"
            )));
        }
        let folder = path.parent().filter(|f| !f.as_os_str().is_empty());
        if path.is_dir() || folder.is_some_and(|folder| !folder.is_dir()) {
            return Err(CliError::Failed(format!(
                "cannot write `{shown}`: name a file in a folder that exists"
            )));
        }
    }
    if sheet.is_some_and(|sheet| same(sheet, out)) {
        return Err(CliError::Usage(
            "--out and --sheet are one file: choose two names".to_owned(),
        ));
    }
    Ok(())
}

fn jobs(table: &Table, both: bool) -> Vec<Job<'_>> {
    let directions: &[bool] = if both { &[false, true] } else { &[false] };
    let of_row = |row| {
        let job = move |&backward| Job { row, backward };
        directions.iter().map(job)
    };
    table.rows.iter().flat_map(of_row).collect()
}

/// Passes a cancel on, and keeps the many stages of many pairs to itself.
struct Quiet<'a>(&'a dyn Progress);

impl Progress for Quiet<'_> {
    fn report(&self, _: &'static str, _: f64) {}

    fn is_cancelled(&self) -> bool {
        self.0.is_cancelled()
    }
}

fn work(args: &CheckArgs, jobs: &[Job<'_>], terminal: &Terminal) -> Vec<Done> {
    let finished = AtomicUsize::new(0);
    terminal.report("checking pairs", 0.0);
    let one = |job: &Job<'_>| {
        let done = one(args, job, terminal);
        let count = finished.fetch_add(1, Ordering::Relaxed) + 1;
        terminal.report("checking pairs", count as f64 / jobs.len() as f64);
        done
    };
    if args.one_by_one {
        return jobs.iter().map(one).collect();
    }
    jobs.par_iter().with_max_len(1).map(one).collect()
}

fn one(args: &CheckArgs, job: &Job<'_>, progress: &dyn Progress) -> Done {
    // One pair must not end the work on all others, whatever it is.
    let caught = catch_unwind(AssertUnwindSafe(|| measured(args, job, progress)));
    let result = caught.unwrap_or_else(|panic| Err(words_of(&*panic)));
    let name = || name(job);
    match result {
        Ok((values, strip)) => Done {
            result: Ok(values),
            strip,
        },
        Err(reason) => Done {
            strip: args
                .sheet
                .is_some()
                .then(|| Strip::failed(&name(), &format!("failed: {reason}"))),
            result: Err(reason),
        },
    }
}

fn words_of(panic: &(dyn Any + Send)) -> String {
    let text = panic.downcast_ref::<&str>().copied();
    let words = text.or_else(|| panic.downcast_ref::<String>().map(String::as_str));
    format!(
        "internal error ({}); please report it with both designs",
        words.unwrap_or("no words")
    )
}

type Measured = (Vec<Option<Value>>, Option<Strip>);

fn measured(args: &CheckArgs, job: &Job<'_>, progress: &dyn Progress) -> Result<Measured, String> {
    let [source, target] = job.row.pair.as_ref().map_err(String::clone)?;
    let pair = if job.backward {
        [target, source]
    } else {
        [source, target]
    };
    let quiet = Quiet(progress);
    let clock = StageClock::new(&quiet);
    let opened = Opened::pair(pair.map(|p| p.as_path()), &args.method, &clock).map_err(told)?;
    let stages = clock.stages();
    let report = Report::of(&opened, stages, args.samples as usize, &quiet).map_err(told)?;
    let strip = args.sheet.is_some().then(|| strip(&opened, &report, job));
    Ok((columns::values(&report), strip))
}

fn told(error: CliError) -> String {
    let message = match error {
        CliError::Usage(message) | CliError::Failed(message) => message,
        CliError::Stdout(error) => error.to_string(),
    };
    let lines: Vec<_> = message.lines().map(str::trim).collect();
    lines.join("; ")
}

fn strip(opened: &Opened, report: &Report, job: &Job<'_>) -> Strip {
    let style: &Style = &opened.loaded.project.style;
    let times = even_times(0.0, 1.0, STRIP_FRAMES);
    Strip::of(&name(job), &opened.transition, style, &times)
        .saying(&report.verdict.words, !report.verdict.findings.is_empty())
}

/// The pair by the names of its designs.
fn name(job: &Job<'_>) -> String {
    let name = |path: &Path| Source::of(path).name();
    match &job.row.pair {
        Ok([source, target]) if job.backward => format!("{} to {}", name(target), name(source)),
        Ok([source, target]) => format!("{} to {}", name(source), name(target)),
        Err(_) => format!("line {}", job.row.line),
    }
}

fn write_report(
    table: &Table,
    jobs: &[Job<'_>],
    done: &[Done],
    out: &Path,
) -> Result<(), CliError> {
    let bytes = report_bytes(table, jobs, done).map_err(CliError::failed)?;
    write_atomically(out, &bytes).map_err(CliError::failed)
}

fn report_bytes(table: &Table, jobs: &[Job<'_>], done: &[Done]) -> Result<Vec<u8>, csv::Error> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    for name in &table.header {
        writer.write_field(name)?;
    }
    for name in [columns::DIRECTION, columns::STATUS] {
        writer.write_field(name)?;
    }
    writer.write_record(columns::names())?;
    let nothing = vec![None; columns::names().count()];
    for (job, done) in jobs.iter().zip(done) {
        for cell in &job.row.cells {
            writer.write_field(cell)?;
        }
        let (status, values) = match &done.result {
            Ok(values) => ("ok", values),
            Err(reason) => (reason.as_str(), &nothing),
        };
        let direction = if job.backward { "backward" } else { "forward" };
        for cell in [direction, status] {
            writer.write_field(cell)?;
        }
        let text = |value: &Option<Value>| value.as_ref().map(Value::text).unwrap_or_default();
        writer.write_record(values.iter().map(text))?;
    }
    writer
        .into_inner()
        .map_err(|error| error.into_error().into())
}

/// Writes the sheet; words about strips that had no room.
fn write_sheet(done: &[Done], kind: StillKind, path: &Path) -> Result<String, CliError> {
    let strips: Vec<Strip> = done.iter().filter_map(|d| d.strip.clone()).collect();
    let ground = Some(Style::default().ground);
    let (drawing, shown) = pair_sheet(&strips, ground).map_err(CliError::failed)?;
    write_still(&drawing, kind, path).map_err(CliError::failed)?;
    Ok(if shown < strips.len() {
        format!(" (the first {shown} of {} pairs)", strips.len())
    } else {
        String::new()
    })
}

fn tell(
    args: &CheckArgs,
    jobs: &[Job<'_>],
    done: &[Done],
    written: &[String],
) -> Result<(), CliError> {
    let rows: Vec<_> = done.iter().map(|d| d.result.as_deref().ok()).collect();
    let summary = Summary::of(&rows);
    output::data(&if args.json {
        let value = serde_json::to_value(&summary).map_err(CliError::failed)?;
        format!("{value:#}\n")
    } else {
        summary.text()
    })?;
    output::words(&format!("wrote {}", written.join(" and ")));
    let Some(first) = done.iter().position(|d| d.result.is_err()) else {
        return Ok(());
    };
    let reason = done[first].result.as_ref().err();
    Err(CliError::Failed(format!(
        "{} of {} pairs failed, the first in line {} ({}); see the column status",
        summary.failures,
        summary.pairs,
        jobs[first].row.line,
        reason.map_or("", String::as_str)
    )))
}

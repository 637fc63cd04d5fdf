//! `morphospace check`: measures a transition, each segment of a sequence, each pair in a table, or
//! blends of many designs.
//!
//! `--json` prints one object, or a list of objects for a sequence. The `laboratory` module
//! documents the units of the values in these objects.

use clap::Args;

use crate::measure;
use crate::work::progress::{OverallProgress, ProgressSpan};

use super::error::CliError;
use super::inputs::InputArgs;
use super::laboratory::{MeasuringArgs, PairBatchArgs, SpaceMeasurement, text};
use super::output;
use super::structure::StructureArgs;
use super::terminal::Terminal;

#[derive(Debug, Args)]
#[command(mut_arg("inputs", |inputs| inputs
    .required(false)
    .required_unless_present("pairs")))]
pub(super) struct CheckArgs {
    #[command(flatten)]
    inputs: Option<InputArgs>,

    #[command(flatten)]
    batch: Option<PairBatchArgs>,

    /// Measure blends of all designs instead of each segment: their common mesh, the blends of each
    /// pair of designs, the blend with equal weights, and 200 blends spread over all weights
    #[arg(long, conflicts_with = "pairs")]
    map: bool,

    #[command(flatten)]
    structure: StructureArgs,

    /// Print JSON instead of a table
    #[arg(long)]
    json: bool,

    #[command(flatten)]
    measuring: MeasuringArgs,
}

pub(super) fn run(args: &CheckArgs) -> Result<(), CliError> {
    match (&args.inputs, &args.batch) {
        (Some(inputs), None) if args.structure.structure => {
            args.structure
                .check(inputs, args.measuring.method(), args.json)
        }
        (Some(inputs), None) if args.map => check_space(args, inputs),
        (Some(inputs), None) => check_segments(args, inputs),
        (None, Some(batch)) => check_pairs(args, batch),
        _ => Err(CliError::Usage(
            "give a project, two or more designs, or a table of pairs with --pairs".to_owned(),
        )),
    }
}

/// Measures and prints a transition, or each segment of a sequence.
fn check_segments(args: &CheckArgs, inputs: &InputArgs) -> Result<(), CliError> {
    let terminal = Terminal::new();
    let measured = args.measuring.of(inputs, &terminal)?;
    // Dropping the terminal clears the progress line before the report is printed.
    drop(terminal);
    let reports: Vec<_> = measured.iter().map(|(_, report)| report).collect();
    output::write_data(&match reports.as_slice() {
        [report] if args.json => output::json(report)?,
        segments if args.json => output::json(&segments)?,
        segments => segments
            .iter()
            .map(|report| text(report))
            .collect::<Vec<_>>()
            .join("\n"),
    })
}

/// Number of blends that `--map` measures, spread over all weights (heuristic).
const BLENDS: usize = 200;

/// Measures blends of all designs and prints the report.
fn check_space(args: &CheckArgs, inputs: &InputArgs) -> Result<(), CliError> {
    let terminal = Terminal::new();
    let overall = OverallProgress::new(&terminal);
    let building = ProgressSpan::new(&overall, 0.0, 0.7);
    let (_, space, build) = inputs
        .read(args.measuring.method(), &building)?
        .open_space(&building)?;
    let measuring = ProgressSpan::new(&overall, 0.7, 1.0);
    let report = measure::space_report(&space, BLENDS, &measuring).map_err(CliError::failed)?;
    let measured = SpaceMeasurement::new(&space, report, build);
    drop(terminal);
    output::write_data(&match args.json {
        true => output::json(&measured)?,
        false => measured.text(),
    })
}

/// Measures the pairs of a table and prints the summary.
fn check_pairs(args: &CheckArgs, batch: &PairBatchArgs) -> Result<(), CliError> {
    let outcome = batch.run(&args.measuring, &Terminal::new())?;
    let summary = &outcome.summary;
    output::write_data(&if args.json {
        output::json(summary)?
    } else {
        summary.text()
    })?;
    if let Some(ended) = outcome.ended {
        return Err(CliError::Failed(ended));
    }
    output::message(&format!("wrote {}", outcome.written.join(" and ")));
    let Some((line, reason)) = outcome.first_failure else {
        return Ok(());
    };
    Err(CliError::Failed(format!(
        "{} of {} pairs failed, the first in line {line} ({reason}); see the column status",
        summary.failures, summary.pairs
    )))
}

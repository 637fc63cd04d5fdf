//! `morphospace check`: a transition, each leg of a sequence, or a table of pairs, in
//! numbers and in words.
//!
//! With `--json` one object on stdout, of a sequence a list of them; the laboratory says in which units.

use clap::Args;

use crate::measure;
use crate::work::progress::{ProgressSpan, WholeProgress};

use super::error::CliError;
use super::inputs::InputArgs;
use super::laboratory::{MeasuringArgs, PairBatchArgs, SpaceMeasurement, text};
use super::output;
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

    /// The space of all designs instead of each leg: its common mesh, its edges, its
    /// middle, and 200 blends all over it
    #[arg(long, conflicts_with = "pairs")]
    map: bool,

    /// One JSON object instead of a table
    #[arg(long)]
    json: bool,

    #[command(flatten)]
    measuring: MeasuringArgs,
}

pub(super) fn run(args: &CheckArgs) -> Result<(), CliError> {
    match (&args.inputs, &args.batch) {
        (Some(inputs), None) if args.map => map(args, inputs),
        (Some(inputs), None) => one(args, inputs),
        (None, Some(batch)) => table(args, batch),
        _ => Err(CliError::Usage(
            "give a project, two designs or more, or a table of pairs with --pairs".to_owned(),
        )),
    }
}

fn one(args: &CheckArgs, inputs: &InputArgs) -> Result<(), CliError> {
    let terminal = Terminal::new();
    let measured = args.measuring.of(inputs, &terminal)?;
    // Its line goes before the report comes.
    drop(terminal);
    let reports: Vec<_> = measured.iter().map(|(_, report)| report).collect();
    output::data(&match reports.as_slice() {
        [report] if args.json => output::json(report)?,
        legs if args.json => output::json(&legs)?,
        legs => legs
            .iter()
            .map(|report| text(report))
            .collect::<Vec<_>>()
            .join("\n"),
    })
}

/// Blends all over a space that are looked at.
const BLENDS: usize = 200;

fn map(args: &CheckArgs, inputs: &InputArgs) -> Result<(), CliError> {
    let terminal = Terminal::new();
    let whole = WholeProgress::new(&terminal);
    let building = ProgressSpan::new(&whole, 0.0, 0.7);
    let (_, space, build) = inputs.open_space(args.measuring.method(), &building)?;
    let measuring = ProgressSpan::new(&whole, 0.7, 1.0);
    let report = measure::space(&space, BLENDS, &measuring).map_err(CliError::failed)?;
    let measured = SpaceMeasurement::new(&space, report, build);
    drop(terminal);
    output::data(&match args.json {
        true => output::json(&measured)?,
        false => measured.text(),
    })
}

fn table(args: &CheckArgs, batch: &PairBatchArgs) -> Result<(), CliError> {
    let outcome = batch.run(&args.measuring, &Terminal::new())?;
    let summary = &outcome.summary;
    output::data(&if args.json {
        output::json(summary)?
    } else {
        summary.text()
    })?;
    if let Some(ended) = outcome.ended {
        return Err(CliError::Failed(ended));
    }
    output::words(&format!("wrote {}", outcome.written.join(" and ")));
    let Some((line, reason)) = outcome.first_failure else {
        return Ok(());
    };
    Err(CliError::Failed(format!(
        "{} of {} pairs failed, the first in line {line} ({reason}); see the column status",
        summary.failures, summary.pairs
    )))
}

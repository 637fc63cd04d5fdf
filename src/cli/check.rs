//! `morphospace check`: a transition, or a table of pairs, in numbers and in
//! words.
//!
//! With `--json` one object on stdout; the laboratory says in which units.

use std::path::{Path, PathBuf};

use clap::Args;

use super::error::CliError;
use super::inputs::Inputs;
use super::laboratory::{Batch, Outcome, Report, StageClock, text};
use super::options::MethodArgs;
use super::output;
use super::terminal::Terminal;

#[derive(Debug, Args)]
#[command(mut_arg("inputs", |inputs| inputs
    .required(false)
    .required_unless_present("pairs")
    .conflicts_with("pairs")))]
pub(super) struct CheckArgs {
    #[command(flatten)]
    inputs: Option<Inputs>,

    /// A table of pairs instead: a CSV file with the columns source and target,
    /// paths relative to its folder; other columns are carried along
    #[arg(long, value_name = "FILE.csv", requires = "out")]
    pairs: Option<PathBuf>,

    /// With --pairs: where the report goes, a row for each pair
    #[arg(long, value_name = "FILE.csv", requires = "pairs")]
    out: Option<PathBuf>,

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

    /// At how many values of t, evenly from 0 to 1, the film is measured
    #[arg(long, value_name = "N", default_value_t = 65, value_parser = clap::value_parser!(u64).range(2..=10_000))]
    samples: u64,

    /// One JSON object instead of a table
    #[arg(long)]
    json: bool,

    #[command(flatten)]
    method: MethodArgs,
}

impl CheckArgs {
    fn wants_a_table(&self) -> bool {
        self.out.is_some() || self.sheet.is_some() || self.both || self.one_by_one
    }
}

pub(super) fn run(args: &CheckArgs) -> Result<(), CliError> {
    match (&args.pairs, &args.out, &args.inputs) {
        (Some(pairs), Some(out), _) => table(args, pairs, out),
        // The parser lets these pass where --pairs is at odds with the inputs.
        (None, ..) if args.wants_a_table() => Err(CliError::Usage(
            "--out, --sheet, --both and --one-by-one go with a table: give it with --pairs"
                .to_owned(),
        )),
        (_, _, Some(inputs)) => one(args, inputs),
        _ => Err(CliError::Usage(
            "give a project, two designs, or a table of pairs with --pairs".to_owned(),
        )),
    }
}

fn one(args: &CheckArgs, inputs: &Inputs) -> Result<(), CliError> {
    let terminal = Terminal::new();
    let clock = StageClock::new(&terminal);
    let opened = inputs.open(&args.method, &clock)?;
    let stages = clock.stages();
    let report = Report::of(&opened, stages, args.samples as usize, &terminal)?;
    drop(terminal);
    output::data(&if args.json {
        output::json(&report)?
    } else {
        text(&report)
    })
}

fn table(args: &CheckArgs, pairs: &Path, out: &Path) -> Result<(), CliError> {
    let batch = Batch {
        pairs,
        out,
        sheet: args.sheet.as_deref(),
        both: args.both,
        one_by_one: args.one_by_one,
        samples: args.samples as usize,
        method: &args.method,
    };
    let Outcome {
        summary,
        written,
        first_failure,
    } = batch.run(&Terminal::new())?;
    output::data(&if args.json {
        output::json(&summary)?
    } else {
        summary.text()
    })?;
    output::words(&format!("wrote {}", written.join(" and ")));
    let Some((line, reason)) = first_failure else {
        return Ok(());
    };
    Err(CliError::Failed(format!(
        "{} of {} pairs failed, the first in line {line} ({reason}); see the column status",
        summary.failures, summary.pairs
    )))
}

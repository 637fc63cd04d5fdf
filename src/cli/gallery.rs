//! `morphospace gallery`: the bundled projects.

use clap::Args;

use crate::project::gallery;

use super::error::CliError;
use super::output;

#[derive(Debug, Args)]
pub(super) struct GalleryArgs {
    /// One JSON array of objects with `name`, `title` and `description`
    #[arg(long)]
    json: bool,
}

pub(super) fn run(args: &GalleryArgs) -> Result<(), CliError> {
    let entries = gallery::list().map_err(CliError::failed)?;
    output::data(&if args.json {
        json(&entries)?
    } else {
        table(&entries)
    })
}

fn json(entries: &[gallery::Entry]) -> Result<String, CliError> {
    let text = serde_json::to_string_pretty(entries).map_err(CliError::failed)?;
    Ok(text + "\n")
}

fn table(entries: &[gallery::Entry]) -> String {
    let width = entries.iter().map(|e| e.name.len()).max().unwrap_or(0);
    let line = |e: &gallery::Entry| format!("gallery:{:width$}  {}\n", e.name, e.title);
    entries.iter().map(line).collect()
}

//! `morphospace gallery`: lists the bundled projects.

use clap::Args;

use crate::project::gallery;

use super::error::CliError;
use super::output;

#[derive(Debug, Args)]
pub(super) struct GalleryArgs {
    /// Print a JSON array of objects with `name`, `title` and `description`
    #[arg(long)]
    json: bool,
}

pub(super) fn run(args: &GalleryArgs) -> Result<(), CliError> {
    let entries = gallery::list().map_err(CliError::failed)?;
    output::write_data(&if args.json {
        output::json(&entries)?
    } else {
        table(&entries)
    })
}

fn table(entries: &[gallery::GalleryEntry]) -> String {
    let width = entries.iter().map(|e| e.name.len()).max().unwrap_or(0);
    let line = |e: &gallery::GalleryEntry| format!("gallery:{:width$}  {}\n", e.name, e.title);
    entries.iter().map(line).collect()
}

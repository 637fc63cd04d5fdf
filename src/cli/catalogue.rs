//! `morphospace catalogue`: writes each saved blend of a map as SVG and DXF, all of them on an
//! overview sheet, and a table of their measures.

use std::path::PathBuf;

use clap::Args;

use crate::export::{Catalogue, CatalogueOrder};
use crate::project::SavedBlend;
use crate::work::progress::{OverallProgress, ProgressSpan};

use super::error::CliError;
use super::inputs::InputArgs;
use super::options::MethodArgs;
use super::output;
use super::terminal::Terminal;
use super::value_parsers::{BackgroundColour, background, one_of};

#[derive(Debug, Args)]
pub(super) struct CatalogueArgs {
    #[command(flatten)]
    inputs: InputArgs,

    /// Folder to write to, created if missing: each saved blend as SVG and DXF, all of them on a
    /// sheet catalogue.png, and their measures as catalogue.csv
    #[arg(long, short, value_name = "FOLDER")]
    out: PathBuf,

    /// Order of the saved blends
    #[arg(long, default_value_t, value_parser = one_of::<CatalogueOrder>())]
    sort: CatalogueOrder,

    /// Include only saved blends with at least this many stars
    #[arg(long, value_name = "N", default_value_t = 0, value_parser = clap::value_parser!(u8).range(0..=i64::from(SavedBlend::MOST_STARS)))]
    stars: u8,

    /// Background colour: #rrggbb, or transparent [default: that of the project]
    #[arg(long, value_name = "COLOUR", value_parser = background)]
    ground: Option<BackgroundColour>,

    #[command(flatten)]
    method: MethodArgs,
}

pub(super) fn run(args: &CatalogueArgs) -> Result<(), CliError> {
    let terminal = Terminal::new();
    let overall = OverallProgress::new(&terminal);
    let building = ProgressSpan::new(&overall, 0.0, 0.7);
    let input = args.inputs.read(&args.method, &building)?;
    let files = input.files.clone();
    let (loaded, space, _) = input.open_space(&building)?;
    let saved_blends = &loaded.project.map.kept;
    if saved_blends.is_empty() {
        return Err(CliError::Failed(
            "the project has no saved blends: save some on the map in the window (D, then K), and \
             save the project"
                .to_owned(),
        ));
    }
    let map = loaded.map_of(&space).map_err(CliError::failed)?;
    let catalogue = Catalogue::new(&space, &map, saved_blends, args.stars, args.sort);
    if catalogue.is_empty() {
        let min_stars = args.stars;
        return Err(CliError::Failed(format!(
            "no saved blend has {min_stars} stars or more"
        )));
    }
    files.check_outputs(catalogue.paths(&args.out))?;
    let style = &loaded.project.style;
    let requested = args.ground.map(|BackgroundColour(colour)| colour);
    let background = requested.unwrap_or(Some(style.ground));
    let writing = ProgressSpan::new(&overall, 0.7, 1.0);
    let written = catalogue
        .write(&space, style, background, &args.out, &writing)
        .map_err(CliError::failed)?;
    drop(terminal);
    output::message(&format!(
        "wrote {} files of {} saved blends into {}",
        written.len(),
        catalogue.len(),
        args.out.display()
    ));
    Ok(())
}

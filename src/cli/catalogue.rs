//! `morphospace catalogue`: the places of a map that are kept, as files.

use std::path::PathBuf;

use clap::Args;

use crate::export::{Catalogue, CatalogueOrder};
use crate::project::SavedPlace;
use crate::work::progress::{ProgressSpan, WholeProgress};

use super::error::CliError;
use super::inputs::InputArgs;
use super::options::MethodArgs;
use super::output;
use super::terminal::Terminal;
use super::value_parsers::{BackgroundColour, ground, one_of};

#[derive(Debug, Args)]
pub(super) struct CatalogueArgs {
    #[command(flatten)]
    inputs: InputArgs,

    /// The folder that it is written into, made where it is missing: each kept place as SVG and
    /// DXF, all as catalogue.png, their measures as catalogue.csv
    #[arg(long, short, value_name = "FOLDER")]
    out: PathBuf,

    /// In which order they are listed
    #[arg(long, default_value_t, value_parser = one_of::<CatalogueOrder>())]
    sort: CatalogueOrder,

    /// Those of at least so many stars
    #[arg(long, value_name = "N", default_value_t = 0, value_parser = clap::value_parser!(u8).range(0..=i64::from(SavedPlace::MOST_STARS)))]
    stars: u8,

    /// The colour behind: #rrggbb, or transparent [default: the project's]
    #[arg(long, value_name = "COLOUR", value_parser = ground)]
    ground: Option<BackgroundColour>,

    #[command(flatten)]
    method: MethodArgs,
}

pub(super) fn run(args: &CatalogueArgs) -> Result<(), CliError> {
    let terminal = Terminal::new();
    let whole = WholeProgress::new(&terminal);
    let building = ProgressSpan::new(&whole, 0.0, 0.7);
    let (loaded, space, _) = args.inputs.open_space(&args.method, &building)?;
    let kept = &loaded.project.map.kept;
    if kept.is_empty() {
        return Err(CliError::Failed(
            "the project keeps no places of its map: keep some in the window (D, then K), and save"
                .to_owned(),
        ));
    }
    let map = loaded.map_of(&space).map_err(CliError::failed)?;
    let catalogue = Catalogue::new((&space, &map), kept, args.stars, args.sort);
    if catalogue.is_empty() {
        let wanted = args.stars;
        return Err(CliError::Failed(format!(
            "no kept place has {wanted} stars or more"
        )));
    }
    let style = &loaded.project.style;
    let given = args.ground.map(|BackgroundColour(ground)| ground);
    let ground = given.unwrap_or(Some(style.ground));
    let writing = ProgressSpan::new(&whole, 0.7, 1.0);
    let written = catalogue
        .write(&space, (style, ground), &args.out, &writing)
        .map_err(CliError::failed)?;
    drop(terminal);
    output::words(&format!(
        "wrote {} files of {} kept places into {}",
        written.len(),
        catalogue.len(),
        args.out.display()
    ));
    Ok(())
}

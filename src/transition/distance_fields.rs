//! The distance fields of two designs, measured.

use super::drawing_pair::DrawingPair;
use super::error::BuildError;
use super::note::TransitionNote;
use super::options::{FieldOptions, PaintRule};
use super::paint_layer_options::PaintLayerOptions;
use super::piece_coating::coats;
use super::spec::{TransitionSpec, outline};
use super::transients::layers::PieceLayers;
use crate::content::{FieldPair, PaintLayerStack, PaintedFields};
use crate::correspondence::{MatchSettings, paired_parts};
use crate::field::{DistanceField, FieldError, Grid};
use crate::geometry::{Regions, Side};
use crate::warp::Placement;
use crate::work::budget::WorkloadKind;
use crate::work::progress::{Progress, ProgressSpan, checkpoint, still_wanted};

/// The fields of all that the designs cover.
pub(super) fn whole_fields(
    spec: &TransitionSpec,
    grid: Grid,
    bar_width: f64,
    progress: &dyn Progress,
) -> Result<FieldPair, BuildError> {
    let measured = |side: Side, design, progress: &ProgressSpan| {
        let outline = outline(design, bar_width, progress)?;
        let field = distance_field(&outline, grid, &spec.options.field, progress);
        field.map_err(|error| of_side(side, error))
    };
    let first = ProgressSpan::new(progress, 0.0, 0.5);
    let source = measured(Side::Source, &spec.source, &first)?;
    checkpoint(progress, "measuring distances", 0.5)?;
    let second = ProgressSpan::new(progress, 0.5, 1.0);
    let target = measured(Side::Target, &spec.target, &second)?;
    still_wanted(progress)?;
    Ok(FieldPair::new(source, target, spec.options.field.blend)?)
}

/// What is painted in several colours, and what could not be as it was asked for.
type PaintedFieldsResult = (Option<PaintedFields>, Option<TransitionNote>);

/// The fields of each paint, where the drawings have some and are shown in it. Parts are
/// paired as rigid parts are; gradients go with the vertices of the frame.
pub(super) fn painted_fields(
    spec: &TransitionSpec,
    grid: &Grid,
    bar_width: f64,
    frame: &Placement,
    progress: &dyn Progress,
) -> Result<PaintedFieldsResult, BuildError> {
    let designs = [&spec.source, &spec.target];
    let is_painted = designs.iter().any(|design| !design.coats.is_empty());
    if spec.options.paint == PaintRule::One || !is_painted {
        return Ok((None, None));
    }
    checkpoint(progress, "measuring distances", 0.0)?;
    let drawings = match spec.drawings(bar_width, progress) {
        Ok(drawings) => drawings,
        Err(BuildError::TooMuch(_)) => return Ok((None, Some(TransitionNote::OneColour))),
        Err(error) => return Err(error),
    };
    let outlines = drawings.outlines.each_ref();
    // Fields need no match: what was said of one that cannot be is no reason to fail.
    let pairs = paired_parts(outlines, &drawings.looks, &spec.options.matching)
        .or_else(|_| paired_parts(outlines, &drawings.looks, &MatchSettings::default()))?;
    let levels = PieceLayers::of_parts(pairs.iter().copied(), &drawings.looks);
    let count = levels.coats.len();
    if WorkloadKind::Cells
        .allow(count * grid.cells(), progress)
        .is_err()
    {
        return Ok((None, Some(TransitionNote::OneColour)));
    }
    let fields = (0..count).map(|level| {
        checkpoint(progress, "measuring distances", level as f64 / count as f64)?;
        let of_level = pairs.iter().enumerate();
        let of_level = of_level.filter(|(piece, _)| levels.of_piece(*piece) == level);
        let of_level: Vec<_> = of_level.map(|(_, parts)| *parts).collect();
        let [source, target] = Side::BOTH.map(|side| {
            let parts = parts_of(&drawings, &of_level, side);
            parts.map(|parts| coat(side, &parts, *grid, &spec.options.field, progress))
        });
        Ok([source.transpose()?.flatten(), target.transpose()?.flatten()])
    });
    let fields = fields.collect::<Result<Vec<_>, BuildError>>()?;
    let along: Vec<u32> = (0..frame.in_frame.len() as u32).collect();
    let places: [&[_]; 2] = [&frame.in_source, &frame.in_target];
    let coating = PaintLayerStack {
        coats: coats(&drawings, &levels, |_| along.clone(), places),
        of_walks: Vec::new(),
        of_holes: Vec::new(),
        lone_walks: Vec::new(),
        fades: false,
        reordered_at: PaintLayerOptions::default().reorder_at,
    };
    let painted = PaintedFields::new(coating, fields, grid, spec.options.field.blend)?;
    Ok((Some(painted), None))
}

/// The parts of one design among pieces that go from one part to one part.
fn parts_of(drawings: &DrawingPair, pieces: &[[Option<usize>; 2]], side: Side) -> Option<Regions> {
    let mut parts: Vec<usize> = pieces.iter().filter_map(|piece| piece[side]).collect();
    parts.sort_unstable();
    parts.dedup();
    drawings.outlines[side].only(&parts)
}

/// The field of a coat; none where all of it is too thin for the cells.
fn coat(
    side: Side,
    parts: &Regions,
    grid: Grid,
    options: &FieldOptions,
    progress: &dyn Progress,
) -> Result<Option<DistanceField>, BuildError> {
    match distance_field(parts, grid, options, progress) {
        Ok(field) => Ok(Some(field)),
        Err(FieldError::Mask(_)) => Ok(None),
        Err(error) => Err(of_side(side, error)),
    }
}

pub(crate) fn distance_field(
    regions: &Regions,
    grid: Grid,
    options: &FieldOptions,
    progress: &dyn Progress,
) -> Result<DistanceField, FieldError> {
    if options.is_exact() {
        DistanceField::from_regions(regions, grid, progress)
    } else {
        DistanceField::from_raster(regions, grid, options.metric, progress)
    }
}

fn of_side(side: Side, error: FieldError) -> BuildError {
    match error {
        FieldError::Cancelled(cancelled) => BuildError::Cancelled(cancelled),
        error => BuildError::Field { side, error },
    }
}

//! Computes the distance fields of two designs: one field of each whole design, and fields of the
//! parts on each paint layer, so that drawings can be shown in their own colours.

use super::drawing_pair::{DrawingPair, need_layers};
use super::error::BuildError;
use super::note::TransitionNote;
use super::options::{FieldOptions, PaintRule};
use super::paint_layer_options::PaintLayerOptions;
use super::piece_coating::placed_paint_layers;
use super::spec::{TransitionSpec, outline};
use super::transients::layers::PieceLayers;
use crate::content::{FieldPair, PaintLayerStack, PaintedFields};
use crate::correspondence::{MatchSettings, paired_parts};
use crate::field::{DistanceField, FieldError, Grid};
use crate::geometry::{Regions, Side};
use crate::warp::Placement;
use crate::work::budget::WorkloadKind;
use crate::work::progress::{Progress, ProgressSpan, check_cancelled, checkpoint};

/// Computes the distance fields of the whole designs.
///
/// # Errors
/// If an outline or a field cannot be computed, or the work is cancelled.
pub(super) fn whole_fields(
    spec: &TransitionSpec,
    grid: Grid,
    bar_width: f64,
    progress: &dyn Progress,
) -> Result<FieldPair, BuildError> {
    let measured = |side: Side, design, progress: &ProgressSpan| {
        let outline = outline(design, bar_width, progress)?;
        let field = distance_field(&outline, grid, &spec.options.field, progress);
        field.map_err(|error| error_of_design(side, error))
    };
    let first = ProgressSpan::new(progress, 0.0, 0.5);
    let source = measured(Side::Source, &spec.source, &first)?;
    checkpoint(progress, "measuring distances", 0.5)?;
    let second = ProgressSpan::new(progress, 0.5, 1.0);
    let target = measured(Side::Target, &spec.target, &second)?;
    check_cancelled(progress)?;
    Ok(FieldPair::new(source, target, spec.options.field.blend)?)
}

/// Distance fields of each paint layer, if the designs are shown in their own colours; and a note,
/// if they are shown in one colour instead because they have too many layers or parts.
type PaintedFieldsResult = (Option<PaintedFields>, Option<TransitionNote>);

/// Computes the distance fields of each paint layer, if the drawings are shown in their own
/// colours. Parts are paired as in the method of rigid parts. `frame` is the placement of the warp
/// that moves the fields; gradients move with its vertices.
///
/// # Errors
/// If outlines or fields cannot be computed, or the work is cancelled. Drawings with too many
/// layers or parts are not an error, but a note.
pub(super) fn painted_fields(
    spec: &TransitionSpec,
    grid: &Grid,
    bar_width: f64,
    frame: &Placement,
    progress: &dyn Progress,
) -> Result<PaintedFieldsResult, BuildError> {
    let designs = [&spec.source, &spec.target];
    if spec.options.paint == PaintRule::One || !need_layers(designs.map(|design| &**design)) {
        return Ok((None, None));
    }
    let too_many = match designs.iter().any(|design| design.is_painted()) {
        true => TransitionNote::PaintIgnored,
        false => TransitionNote::NamesIgnored,
    };
    checkpoint(progress, "measuring distances", 0.0)?;
    let drawings = match spec.drawings(bar_width, progress) {
        Ok(drawings) if drawings.are_names_ignored => return Ok((None, Some(too_many))),
        Ok(drawings) => drawings,
        Err(BuildError::TooMuch(_)) => return Ok((None, Some(too_many))),
        Err(error) => return Err(error),
    };
    let outlines = drawings.outlines.each_ref();
    // Fields need no match, so an impossible requested pairing is replaced by the default pairing.
    let pairs = paired_parts(outlines, &drawings.appearances, &spec.options.matching)
        .or_else(|_| paired_parts(outlines, &drawings.appearances, &MatchSettings::default()))?;
    let layers = PieceLayers::of_parts(pairs.iter().copied(), &drawings.appearances);
    let count = layers.layers.len();
    if WorkloadKind::Cells
        .check(count * grid.cells(), progress)
        .is_err()
    {
        return Ok((None, Some(too_many)));
    }
    let fields = (0..count).map(|level| {
        checkpoint(progress, "measuring distances", level as f64 / count as f64)?;
        let pieces = pairs.iter().enumerate();
        let in_layer = pieces.filter(|(piece, _)| layers.of_piece(*piece) == level);
        let parts_of_layer: Vec<_> = in_layer.map(|(_, parts)| *parts).collect();
        let [source, target] = Side::BOTH.map(|side| {
            let parts = parts_of(&drawings, &parts_of_layer, side);
            parts.map(|parts| layer_field(side, &parts, *grid, &spec.options.field, progress))
        });
        Ok([source.transpose()?.flatten(), target.transpose()?.flatten()])
    });
    let fields = fields.collect::<Result<Vec<_>, BuildError>>()?;
    let all_vertices: Vec<u32> = (0..frame.in_frame.len() as u32).collect();
    let places: [&[_]; 2] = [&frame.in_source, &frame.in_target];
    let coating = PaintLayerStack {
        layers: placed_paint_layers(&drawings, &layers, |_| all_vertices.clone(), places),
        of_loops: Vec::new(),
        of_holes: Vec::new(),
        unmatched_loops: Vec::new(),
        fades_unmatched: false,
        reorder_t: PaintLayerOptions::default().reorder_at,
    };
    let painted = PaintedFields::new(coating, fields, grid, spec.options.field.blend)?;
    Ok((Some(painted), None))
}

/// Returns the outlines of the parts of one design that occur in `pieces`; `None` if there are
/// none. Each piece is a pair of part indices, one in the source and one in the target.
fn parts_of(drawings: &DrawingPair, pieces: &[[Option<usize>; 2]], side: Side) -> Option<Regions> {
    let mut parts: Vec<usize> = pieces.iter().filter_map(|piece| piece[side]).collect();
    parts.sort_unstable();
    parts.dedup();
    drawings.outlines[side].subset(&parts)
}

/// Computes the distance field of a paint layer; `None` if the whole layer is thinner than the grid
/// cells.
///
/// # Errors
/// If the field cannot be computed for another reason, or the work is cancelled.
fn layer_field(
    side: Side,
    parts: &Regions,
    grid: Grid,
    options: &FieldOptions,
    progress: &dyn Progress,
) -> Result<Option<DistanceField>, BuildError> {
    match distance_field(parts, grid, options, progress) {
        Ok(field) => Ok(Some(field)),
        Err(FieldError::Mask(_)) => Ok(None),
        Err(error) => Err(error_of_design(side, error)),
    }
}

/// Computes a distance field as the options request: from the exact outlines, or from the pixels of
/// a binary image.
///
/// # Errors
/// [`FieldError`] if the grid is unsuitable or the work is cancelled.
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

/// Converts an error of a distance field to a build error that names the design. A cancellation
/// stays a cancellation.
fn error_of_design(side: Side, error: FieldError) -> BuildError {
    match error {
        FieldError::Cancelled(cancelled) => BuildError::Cancelled(cancelled),
        error => BuildError::Field { side, error },
    }
}

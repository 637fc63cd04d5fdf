//! Builds a transition from two designs. All errors occur here; playing a built transition cannot
//! fail.

use super::any_warp::BuiltWarp;
use super::boundary_paths;
use super::common_frame::extent;
use super::error::BuildError;
use super::note::TransitionNote;
use super::plane;
use super::solids;
use super::spec::{TransitionSpec, bar_width};
use super::transition::{RecordingSlot, Transition, TransitionData};
use crate::compatible;
use crate::content::{Content, ContentKind, FieldContent, PicturePair};
use crate::design::{Design, DesignForm};
use crate::field::Grid;
use crate::geometry::Bounds;
use crate::warp::{Arap, Placement, Warp, WarpKind};
use crate::work::budget::WorkloadKind;
use crate::work::progress::{
    Cancelled, OverallProgress, Progress, ProgressSpan, Silent, check_cancelled, checkpoint,
};
use std::sync::Arc;

/// The warp, the visible content, and a box around all frames.
type BuiltParts = (BuiltWarp, Content, Bounds);

impl Transition {
    /// Builds a transition of two designs with default options and the method that suits them best,
    /// however long it takes.
    ///
    /// # Errors
    /// [`BuildError`] with the reason why the designs cannot be combined.
    pub fn between(source: Design, target: Design) -> Result<Self, BuildError> {
        let spec = TransitionSpec {
            patient: true,
            ..TransitionSpec::new(Arc::new(source), Arc::new(target))
        };
        Self::build(&spec, &Silent)
    }

    /// Builds a transition as specified. The designs are already imported and placed in the common
    /// frame.
    ///
    /// # Errors
    /// [`BuildError::Between`] names the designs and says why they cannot be combined, or that the
    /// work would take very long and the specification does not allow it. [`BuildError::Cancelled`]
    /// if the work was cancelled.
    pub fn build(spec: &TransitionSpec, progress: &dyn Progress) -> Result<Self, BuildError> {
        build_named(spec, progress).map(Self::from)
    }
}

/// Builds the data of a transition; errors name the designs.
fn build_named(
    spec: &TransitionSpec,
    progress: &dyn Progress,
) -> Result<TransitionData, BuildError> {
    build_data(spec, progress).map_err(|error| match progress.is_cancelled() {
        // A cancellation has nothing to do with the designs, so it is not prefixed with their
        // names.
        true => error,
        false => error.with_names(&spec.source, &spec.target),
    })
}

/// Builds the data of a transition; errors do not name the designs.
fn build_data(
    spec: &TransitionSpec,
    progress: &dyn Progress,
) -> Result<TransitionData, BuildError> {
    // This check comes first because it is cheap. The application uses it to disable buttons.
    TransitionSpec::available(spec.method, &spec.source, &spec.target)?;
    let renumbered = renumbered_nodes(spec);
    let spec = renumbered.as_ref().unwrap_or(spec);
    let progress = &OverallProgress::new(progress).patient(spec.patient);
    if spec.method.warp() == WarpKind::Arap {
        // Each subdivision quadruples the number of faces; ten subdivisions give too many even for
        // one face.
        let children = 4_usize.saturating_pow(spec.options.arap.subdivisions);
        WorkloadKind::Faces.check(children, progress)?;
    }
    let bar_width = bar_width(spec)?;
    let (mut built, content, bounds) = match spec.method.content() {
        ContentKind::Solid => solids(spec, bar_width, progress)?,
        ContentKind::Field => fields(spec, bar_width, progress)?,
        ContentKind::Colours => colours(spec, progress)?,
    };
    built.notes.splice(..0, spec.notes.iter().cloned());
    let of_match = built.matched.iter().flat_map(TransitionNote::of_match);
    built.notes.extend(of_match);
    let ridge = built.warp.arap().and_then(Arap::ridge);
    built
        .notes
        .extend(ridge.map(|ridge| TransitionNote::DiagonalAdded { share: ridge.share }));
    let parts = built.warp.arap().map_or(0, Arap::unflattened_count);
    built
        .notes
        .extend((parts > 0).then_some(TransitionNote::Unflattened { parts }));
    let data = TransitionData {
        method: spec.method,
        designs: [spec.source.clone(), spec.target.clone()],
        built_warp: built,
        content,
        bounds,
        bar_width,
        recording: RecordingSlot::default(),
    };
    Ok(data
        .with_paint_layers(&spec.options.coats)
        .with_part_times(&spec.options.parts))
}

/// Returns the specification with the nodes of the target truss in the order of the source, if both
/// are the same truss with different numbers of its nodes.
fn renumbered_nodes(spec: &TransitionSpec) -> Option<TransitionSpec> {
    let (DesignForm::Truss(source), DesignForm::Truss(target)) =
        (&spec.source.form, &spec.target.form)
    else {
        return None;
    };
    if compatible::check_same_bars(source, target).is_ok() {
        return None;
    }
    let order = compatible::corresponding_nodes(source, target)?;
    let target = Design {
        form: target.with_nodes_in_order(&order)?.into(),
        ..Design::clone(&spec.target)
    };
    let mut spec = spec.clone();
    spec.target = Arc::new(target);
    spec.notes.push(TransitionNote::NodesRenumbered);
    Some(spec)
}

/// Builds the warp of solid designs, their content, and the box around all frames.
fn solids(
    spec: &TransitionSpec,
    bar_width: f64,
    progress: &dyn Progress,
) -> Result<BuiltParts, BuildError> {
    let (built, solid) = match spec.method.warp() {
        WarpKind::Paths => boundary_paths::build_boundary_paths(spec, bar_width, progress)?,
        _ => solids::rigid_parts(spec, bar_width, progress)?,
    };
    let bar_margin = if solid.bars.is_empty() {
        0.0
    } else {
        bar_width
    };
    let warp = built.warp.as_warp();
    let placer = warp.placer();
    let placement = placer.placement();
    let ends = Bounds::of(
        placement
            .in_source
            .iter()
            .chain(&placement.in_target)
            .copied(),
    )
    .unwrap_or_else(|| unreachable!("a warp of solids has vertices"));
    let visible_box = |placement: &Placement, _| Bounds::of(placement.in_frame.iter().copied());
    let bounds = swept(ends, warp, visible_box, progress)?;
    Ok((built, Content::Solid(solid), bounds.padded(bar_margin)))
}

/// Builds distance fields, the warp of the plane that moves them, and the box around all frames.
fn fields(
    spec: &TransitionSpec,
    bar_width: f64,
    progress: &dyn Progress,
) -> Result<BuiltParts, BuildError> {
    checkpoint(progress, "measuring distances", 0.0)?;
    let frame = field_frame(spec, bar_width);
    let grid = Grid::covering(&frame, spec.options.field.cells, spec.options.field.margin)?;
    WorkloadKind::Cells.check(grid.cells(), progress)?;
    let span = |from, to| ProgressSpan::new(progress, from, to);
    let whole = super::distance_fields::whole_fields(spec, grid, bar_width, &span(0.0, 0.4))?;
    // The warp also covers the margin of the grid, because moving fields are evaluated there too.
    let mut built = plane::build_plane_warp(spec, &grid.bounds(), bar_width, &span(0.7, 1.0))?;
    let placer = built.warp.as_warp().placer();
    let (painted, note) = super::distance_fields::painted_fields(
        spec,
        &grid,
        bar_width,
        placer.placement(),
        &span(0.4, 0.7),
    )?;
    built.notes.extend(note);
    let is_carried = spec.method.warp() != WarpKind::None;
    let fields = FieldContent::new(whole, painted, is_carried);
    if spec.options.field.needs_binary_boundary() {
        // Notes are in the order of the work, and the fields were computed before the warp.
        built.notes.insert(0, TransitionNote::BinaryBoundary);
    }
    let bounds = if is_carried {
        let visible_box = |placement: &Placement, t| {
            Bounds::of(fields.contour(placement, t).into_iter().flatten())
        };
        swept(frame, built.warp.as_warp(), visible_box, progress)?
    } else {
        frame
    };
    Ok((built, Content::Field(fields), bounds))
}

/// Builds a pair of pictures, the warp of the plane that moves them, and the box around all frames.
fn colours(spec: &TransitionSpec, progress: &dyn Progress) -> Result<BuiltParts, BuildError> {
    checkpoint(progress, "reading colours", 0.0)?;
    let picture = |design: &Design| {
        let missing = || BuildError::Unavailable(format!("{} has no colours", design.name));
        design.picture.clone().ok_or_else(missing)
    };
    let [source, target] = [picture(&spec.source)?, picture(&spec.target)?];
    let bounds = source.bounds().union(&target.bounds());
    let pair = PicturePair::new(&source, &target, spec.options.colours)?;
    // The mesh extends beyond the visible area, so that its border is never seen.
    let frame = bounds.padded(0.02 * bounds.diameter());
    let built = plane::build_plane_warp(spec, &frame, 0.0, progress)?;
    Ok((built, Content::Colours(pair), bounds))
}

/// Returns the box around all frames, found by sampling. `ends` is the box around both designs; a
/// part that swings may leave this box during the motion.
fn swept(
    ends: Bounds,
    warp: &dyn Warp,
    visible_box: impl Fn(&Placement, f64) -> Option<Bounds>,
    progress: &dyn Progress,
) -> Result<Bounds, Cancelled> {
    /// Number of equal intervals of t between the sampled frames (heuristic).
    const SAMPLES: u32 = 8;
    let mut placer = warp.placer();
    let mut bounds = ends;
    for i in 1..SAMPLES {
        check_cancelled(progress)?;
        let t = f64::from(i) / f64::from(SAMPLES);
        placer.place(t);
        if let Some(frame_box) = visible_box(placer.placement(), t) {
            bounds = bounds.union(&frame_box);
        }
    }
    Ok(bounds)
}

/// Returns the rectangle that the distance fields cover, without their margin: the box around all
/// designs, including whole pictures and pages and the thickness of bars.
pub(crate) fn field_frame(spec: &TransitionSpec, bar_width: f64) -> Bounds {
    let of = |design: &Design| match design.form {
        DesignForm::Truss(_) => design.extent.padded(0.5 * bar_width),
        _ => design.extent.union(&extent(design)),
    };
    let boxes = spec.all_designs().map(|design| of(design));
    boxes
        .reduce(|a, b| a.union(&b))
        .unwrap_or_else(|| unreachable!("there are two designs"))
}

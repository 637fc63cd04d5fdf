//! From two designs to a transition: everything that can fail.

use super::any_warp::BuiltWarp;
use super::boundary_paths;
use super::common_frame::extent;
use super::error::BuildError;
use super::note::TransitionNote;
use super::plane;
use super::solids;
use super::spec::{TransitionSpec, bar_width};
use super::transition::{RecordingSlot, Transition, TransitionData};
use crate::content::{Content, ContentKind, FieldContent, PicturePair};
use crate::design::{Design, DesignForm};
use crate::field::Grid;
use crate::geometry::Bounds;
use crate::warp::{Arap, Placement, Warp, WarpKind};
use crate::work::budget::WorkloadKind;
use crate::work::progress::{
    Cancelled, Progress, ProgressSpan, Silent, WholeProgress, checkpoint, still_wanted,
};
use std::sync::Arc;

/// What moves, what is seen, and the box around it.
type BuiltParts = (BuiltWarp, Content, Bounds);

impl Transition {
    /// Two designs by the method that suits them best, with default options,
    /// however long it takes.
    ///
    /// # Errors
    /// [`BuildError`] says what does not go together.
    pub fn between(source: Design, target: Design) -> Result<Self, BuildError> {
        let spec = TransitionSpec {
            patient: true,
            ..TransitionSpec::new(Arc::new(source), Arc::new(target))
        };
        Self::build(&spec, &Silent)
    }

    /// Builds the cell of the table that the specification names: imports
    /// nothing, decides everything.
    ///
    /// # Errors
    /// [`BuildError::Between`] names the designs and says what does not go
    /// together, or that it would take very long and nobody is patient; of
    /// work that was cancelled another says so.
    pub fn build(spec: &TransitionSpec, progress: &dyn Progress) -> Result<Self, BuildError> {
        built(spec, progress).map(Self::from)
    }
}

/// What [`Transition::build`] builds, or why it cannot, by the designs' names.
fn built(spec: &TransitionSpec, progress: &dyn Progress) -> Result<TransitionData, BuildError> {
    made(spec, progress).map_err(|error| match progress.is_cancelled() {
        // A cancel is nobody's fault: it names no design.
        true => error,
        false => error.between(&spec.source, &spec.target),
    })
}

fn made(spec: &TransitionSpec, progress: &dyn Progress) -> Result<TransitionData, BuildError> {
    // Before any work: a window asks the same to grey a button out.
    TransitionSpec::available(spec.cell, &spec.source, &spec.target)?;
    let progress = &WholeProgress::new(progress).patient(spec.patient);
    if spec.cell.warp() == WarpKind::Arap {
        // Four times as many at each round: at ten a single face is too much.
        let children = 4_usize.saturating_pow(spec.options.arap.subdivisions);
        WorkloadKind::Faces.allow(children, progress)?;
    }
    let bar_width = bar_width(spec)?;
    let (mut moved, content, bounds) = match spec.cell.content() {
        ContentKind::Solid => solids(spec, bar_width, progress)?,
        ContentKind::Field => fields(spec, bar_width, progress)?,
        ContentKind::Colours => colours(spec, progress)?,
    };
    let of_match = moved.matched.iter().flat_map(TransitionNote::of_match);
    moved.notes.extend(of_match);
    let ridge = moved.warp.arap().and_then(Arap::ridge);
    moved
        .notes
        .extend(ridge.map(|ridge| TransitionNote::Stiffened { share: ridge.share }));
    let parts = moved.warp.arap().map_or(0, Arap::unflattened);
    moved
        .notes
        .extend((parts > 0).then_some(TransitionNote::Unflattened { parts }));
    let made = TransitionData {
        cell: spec.cell,
        designs: [spec.source.clone(), spec.target.clone()],
        moved,
        content,
        bounds,
        bar_width,
        film: RecordingSlot::default(),
    };
    Ok(made.coated(&spec.options.coats).timed(&spec.options.parts))
}

fn solids(
    spec: &TransitionSpec,
    bar_width: f64,
    progress: &dyn Progress,
) -> Result<BuiltParts, BuildError> {
    let (moved, solid) = match spec.cell.warp() {
        WarpKind::Paths => boundary_paths::paths(spec, bar_width, progress)?,
        _ => solids::rigid_parts(spec, bar_width, progress)?,
    };
    let room = if solid.bars.is_empty() {
        0.0
    } else {
        bar_width
    };
    let warp = moved.warp.as_warp();
    let at_rest = warp.placer();
    let ends = at_rest.placement();
    let ends = Bounds::of(ends.in_source.iter().chain(&ends.in_target).copied())
        .unwrap_or_else(|| unreachable!("a warp of solids has vertices"));
    let seen = |placement: &Placement, _| Bounds::of(placement.in_frame.iter().copied());
    let bounds = swept(ends, warp, seen, progress)?;
    Ok((moved, Content::Solid(solid), bounds.padded(room)))
}

fn fields(
    spec: &TransitionSpec,
    bar_width: f64,
    progress: &dyn Progress,
) -> Result<BuiltParts, BuildError> {
    checkpoint(progress, "measuring distances", 0.0)?;
    let frame = field_frame(spec, bar_width);
    let grid = Grid::covering(&frame, spec.options.field.cells, spec.options.field.margin)?;
    WorkloadKind::Cells.allow(grid.cells(), progress)?;
    let span = |from, to| ProgressSpan::new(progress, from, to);
    let whole = super::distance_fields::whole_fields(spec, grid, bar_width, &span(0.0, 0.4))?;
    // Over the grid with its margin: a carried field is looked up there too.
    let mut moved = plane::warp(spec, &grid.bounds(), bar_width, &span(0.7, 1.0))?;
    let placer = moved.warp.as_warp().placer();
    let (painted, note) = super::distance_fields::painted_fields(
        spec,
        &grid,
        bar_width,
        placer.placement(),
        &span(0.4, 0.7),
    )?;
    moved.notes.extend(note);
    let is_carried = spec.cell.warp() != WarpKind::None;
    let fields = FieldContent::new(whole, painted, is_carried);
    if spec.options.field.is_switched() {
        // First, as the fields were made before the warp.
        moved.notes.insert(0, TransitionNote::BinaryBoundary);
    }
    let bounds = if is_carried {
        let seen = |placement: &Placement, t| {
            Bounds::of(fields.contour(placement, t).into_iter().flatten())
        };
        swept(frame, moved.warp.as_warp(), seen, progress)?
    } else {
        frame
    };
    Ok((moved, Content::Field(fields), bounds))
}

fn colours(spec: &TransitionSpec, progress: &dyn Progress) -> Result<BuiltParts, BuildError> {
    checkpoint(progress, "reading colours", 0.0)?;
    let picture = |design: &Design| {
        let missing = || BuildError::Unavailable(format!("{} has no colours", design.name));
        design.picture.clone().ok_or_else(missing)
    };
    let [source, target] = [picture(&spec.source)?, picture(&spec.target)?];
    let bounds = source.bounds().union(&target.bounds());
    let pair = PicturePair::new(&source, &target, spec.options.colours)?;
    // The mesh reaches beyond what is shown, so that its edge is never seen.
    let frame = bounds.padded(0.02 * bounds.diameter());
    let moved = plane::warp(spec, &frame, 0.0, progress)?;
    Ok((moved, Content::Colours(pair), bounds))
}

/// The box around `ends` and what is seen in a few frames: a part that swings
/// may leave the ends' box.
fn swept(
    ends: Bounds,
    warp: &dyn Warp,
    seen: impl Fn(&Placement, f64) -> Option<Bounds>,
    progress: &dyn Progress,
) -> Result<Bounds, Cancelled> {
    const SAMPLES: u32 = 8;
    let mut placer = warp.placer();
    let mut bounds = ends;
    for i in 1..SAMPLES {
        still_wanted(progress)?;
        let t = f64::from(i) / f64::from(SAMPLES);
        placer.place(t);
        if let Some(now) = seen(placer.placement(), t) {
            bounds = bounds.union(&now);
        }
    }
    Ok(bounds)
}

/// The rectangle of the fields without their margin: pictures and pages whole,
/// meshes and trusses with the thickness of their bars.
pub(crate) fn field_frame(spec: &TransitionSpec, bar_width: f64) -> Bounds {
    let of = |design: &Design| match design.form {
        DesignForm::Truss(_) => design.extent.padded(0.5 * bar_width),
        _ => design.extent.union(&extent(design)),
    };
    let boxes = spec.all().map(|design| of(design));
    boxes
        .reduce(|a, b| a.union(&b))
        .unwrap_or_else(|| unreachable!("there are two designs"))
}

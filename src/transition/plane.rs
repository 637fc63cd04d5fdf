//! Builds warps of the whole plane, which move distance fields or pictures.
//!
//! A warp follows *features*, that is, pins and lines. It is either evaluated on a grid, or moves a
//! mesh as rigidly as possible. Here, the *frame* is the rectangle of the plane that is warped.

use super::any_warp::{AnyWarp, BuiltWarp};
use super::arap_build::build_arap;
use super::error::BuildError;
use super::note::TransitionNote;
use super::plane_features::PlaneFeatures;
use super::spec::TransitionSpec;
use crate::compatible::{CompatibleMesh, FrameOutlinesError, FramePinsError};
use crate::content::ContentKind;
use crate::correspondence::{LinePair, PointPair, RegionMatch};
use crate::geometry::Bounds;
use crate::warp::{
    CommonRigidMotion, FeatureTravel, GridWarp, IdentityWarp, Lattice, LineWarp, PlaneGrid,
    PlaneWarp, RigidElasticPlaneWarp, RigidElasticWarp, ScatteredWarp, Warp, WarpKind,
};
use crate::work::progress::{Progress, ProgressSpan, checkpoint, run_cancellable};
use std::sync::Arc;

/// Maximum number of cells along the longer side of the grid of a warp. Each cell consists of two
/// triangles, in which the warp is linear, and covers a few pixels of a window (heuristic).
const MAX_GRID_CELLS: u32 = 160;

/// Maximum work of evaluating a warp at one t: the number of grid points times the number of pins,
/// where a line counts as four pins. If a grid would need more work, it is made coarser (resource
/// limit: some milliseconds on one or two cores, for 60 evaluations per second).
const MAX_FRAME_WORK: f64 = 3e6;

/// Work of the lattice warp at one grid point, expressed as a number of pins of another warp. The
/// work of the lattice warp does not depend on the actual number of pins and lines (heuristic).
const LATTICE_WORK: usize = 16;

/// Distance by which a mesh of the plane extends beyond the rectangle that is warped, as a fraction
/// of the longer side of this rectangle. The border of the mesh bends; a wider margin would only
/// add faces that are never visible (heuristic).
const FRAME_MARGIN: f64 = 0.25;

/// Builds the specified warp of the plane, over the rectangle `frame`.
///
/// # Errors
/// If features cannot be determined, the warp cannot be built, or the work is cancelled.
pub(super) fn build_plane_warp(
    spec: &TransitionSpec,
    frame: &Bounds,
    bar_width: f64,
    progress: &dyn Progress,
) -> Result<BuiltWarp, BuildError> {
    let kind = spec.method.warp();
    if kind == WarpKind::None {
        return Ok(AnyWarp::Identity(IdentityWarp::new(*frame)).into());
    }
    let features = PlaneFeatures::of(spec, bar_width, &ProgressSpan::new(progress, 0.0, 0.4))?;
    let progress = &ProgressSpan::new(progress, 0.4, 1.0);
    if kind == WarpKind::Arap {
        return rigid(spec, frame, features, progress);
    }
    checkpoint(progress, "warping", 0.0)?;
    // Solving for all features is one long library call. It runs in the background, so that a
    // cancellation need not wait for its end.
    let (spec, frame, features) = (spec.clone(), *frame, Arc::new(features));
    let features_for_warp = Arc::clone(&features);
    let warp = run_cancellable(progress, move || {
        build_grid_warp(&spec, &frame, &features_for_warp)
    })?;
    Ok(BuiltWarp {
        automatic_pins: features.automatic(),
        notes: features.notes.clone(),
        ..AnyWarp::Plane(warp?).into()
    })
}

/// Builds a warp that is evaluated on a grid and follows the given pins and lines.
fn build_grid_warp(
    spec: &TransitionSpec,
    frame: &Bounds,
    features: &PlaneFeatures,
) -> Result<Arc<dyn Warp>, BuildError> {
    let options = &spec.options;
    let work = features.points.len() + 4 * features.lines.len();
    match spec.method.warp() {
        WarpKind::Lines => on_grid(spec, frame, features, work, |frame, points, lines| {
            Ok(LineWarp::new(frame, lines, points, &options.lines)?)
        }),
        WarpKind::Scattered => on_grid(spec, frame, features, work, |frame, points, lines| {
            Ok(ScatteredWarp::new(frame, points, lines, options.scattered)?)
        }),
        WarpKind::Lattice => {
            let work = LATTICE_WORK;
            on_grid(spec, frame, features, work, |frame, points, lines| {
                Ok(Lattice::new(frame, points, lines, options.lattice)?)
            })
        }
        // These warps are not evaluated on a grid. A new grid warp must be added to this match.
        WarpKind::None | WarpKind::Paths | WarpKind::Arap => Err(BuildError::Unavailable(format!(
            "{} cannot be built; choose another method",
            spec.method.name()
        ))),
    }
}

/// Builds a warp that is evaluated on a grid and follows the given pins and lines. If the option
/// `travel` makes the features rotate together, the warp is relative to their common rigid motion.
/// `work` is the work of evaluating the warp at one grid point, as a number of pins; see
/// [`MAX_FRAME_WORK`].
fn on_grid<W: PlaneWarp>(
    spec: &TransitionSpec,
    frame: &Bounds,
    PlaneFeatures { points, lines, .. }: &PlaneFeatures,
    work: usize,
    new: impl FnOnce(&Bounds, &[PointPair], &[LinePair]) -> Result<W, BuildError>,
) -> Result<Arc<dyn Warp>, BuildError> {
    let travels_as_whole = match spec.options.travel {
        FeatureTravel::Auto => spec.method.content() == ContentKind::Field,
        FeatureTravel::Whole => true,
        FeatureTravel::Straight => false,
    };
    let rigid = CommonRigidMotion::fit(points, lines).filter(|_| travels_as_whole);
    Ok(match rigid {
        Some(rigid) => {
            let warp = RigidElasticPlaneWarp::new(rigid, frame, points, lines, new)?;
            // Distance fields may leave the rectangle `frame` while they rotate. Pictures are
            // cropped to this rectangle.
            let visible_area = match spec.method.content() {
                ContentKind::Field => rigid.swept_bounds(frame),
                ContentKind::Colours | ContentKind::Solid => *frame,
            };
            Arc::new(GridWarp::new(warp, grid(&visible_area, work)))
        }
        None => Arc::new(GridWarp::new(new(frame, points, lines)?, grid(frame, work))),
    })
}

/// Returns a grid that is as fine as possible within [`MAX_GRID_CELLS`] and [`MAX_FRAME_WORK`], but
/// has at least 24 cells along its longer side.
fn grid(frame: &Bounds, work: usize) -> PlaneGrid {
    let frame_size = frame.size();
    let aspect = frame_size.min_element() / frame_size.max_element();
    // The grid has about aspect · cells² points, and the evaluation at each point takes `work`.
    let max_points = MAX_FRAME_WORK / (work.max(1) as f64);
    let cells = (max_points / aspect.max(0.01))
        .sqrt()
        .min(f64::from(MAX_GRID_CELLS));
    PlaneGrid::covering(frame, (cells as u32).max(24))
}

/// Builds a warp that moves the plane as one mesh, as rigidly as matched outlines or pins allow.
/// Automatic pins are thinned out until the plane does not fold.
///
/// # Errors
/// If the plane folds with pins set by the user or cannot be triangulated, or the work is
/// cancelled.
fn rigid(
    spec: &TransitionSpec,
    frame: &Bounds,
    mut features: PlaneFeatures,
    progress: &dyn Progress,
) -> Result<BuiltWarp, BuildError> {
    let mut notes = std::mem::take(&mut features.notes);
    let mut pins = features.as_points();
    let found_count = pins.len();
    let mut warp = None;
    if let Some(matched) = &features.matched {
        match about_outlines(spec, frame, &features, matched, progress)? {
            Ok(outline_warp) => warp = Some(outline_warp),
            Err(error) => notes.push(TransitionNote::PinsInsteadOfOutlines(error)),
        }
    }
    let warp = match warp {
        Some(warp) => warp,
        None => about_pins(spec, frame, features.are_automatic, &mut pins, progress)?,
    };
    if pins.len() < found_count {
        notes.push(TransitionNote::FewerPins {
            left: pins.len(),
            of: found_count,
        });
    }
    // Pins set by the user are displayed already.
    pins.retain(|_| features.are_automatic);
    Ok(BuiltWarp {
        automatic_pins: pins,
        notes,
        ..warp.into()
    })
}

/// Builds a warp that moves the plane as rigidly as the pins allow. As long as automatic pins fold
/// the plane, or two of them coincide in only one design, every other pin is removed.
///
/// # Errors
/// If the plane folds with pins set by the user or cannot be triangulated, or the work is
/// cancelled.
fn about_pins(
    spec: &TransitionSpec,
    frame: &Bounds,
    are_automatic: bool,
    pins: &mut Vec<PointPair>,
    progress: &dyn Progress,
) -> Result<AnyWarp, BuildError> {
    let frame = frame.padded(FRAME_MARGIN * frame.size().max_element());
    let mesh = loop {
        match CompatibleMesh::around_pins(&frame, pins, progress) {
            Ok(mesh) => break mesh,
            Err(FramePinsError::Folds { .. } | FramePinsError::Coincide { .. })
                if are_automatic && !pins.is_empty() =>
            {
                *pins = pins.iter().copied().step_by(2).collect();
                // Removing every other pin always leaves the first pin, so it is removed here if it
                // is the only one.
                if pins.len() == 1 {
                    pins.clear();
                }
            }
            Err(error) => return Err(error.into()),
        }
    };
    let arap = build_arap(&mesh, &spec.options.arap, &[], progress)?;
    Ok(AnyWarp::Rigid(arap))
}

/// Builds a warp that moves the plane as rigidly as the matched outlines allow, relative to the
/// common rigid motion of the features. If no mesh of the plane has the outlines of both designs as
/// edges, returns the reason as the inner error.
fn about_outlines(
    spec: &TransitionSpec,
    frame: &Bounds,
    features: &PlaneFeatures,
    matched: &RegionMatch,
    progress: &dyn Progress,
) -> Result<Result<AnyWarp, FrameOutlinesError>, BuildError> {
    let options = &spec.options;
    let rigid = match options.travel {
        FeatureTravel::Auto | FeatureTravel::Whole => {
            CommonRigidMotion::fit(&features.points, &features.lines)
        }
        FeatureTravel::Straight => None,
    };
    let (matched, frame) = match &rigid {
        Some(rigid) => (&rigid.match_to_rest(matched), rigid.frame_to_rest(frame)),
        None => (matched, *frame),
    };
    // Outlines must lie within the meshed rectangle to become edges of the mesh.
    let frame = padded_frame(matched, &frame);
    let attempt =
        CompatibleMesh::around_outlines(&frame, matched, &options.triangulation, progress);
    let mesh = match attempt {
        Ok(mesh) => mesh,
        Err(error) => {
            // A cancellation is also returned as an error of the mesh, but must not become a note.
            checkpoint(progress, "triangulating", 0.0)?;
            return Ok(Err(error));
        }
    };
    let arap = build_arap(&mesh, &options.arap, &[], progress)?;
    Ok(Ok(match rigid {
        Some(rigid) => AnyWarp::RigidElastic(RigidElasticWarp::new(rigid, arap)),
        None => AnyWarp::Rigid(arap),
    }))
}

/// Returns the box around `frame` and all matched outlines, with the margin [`FRAME_MARGIN`].
fn padded_frame(matched: &RegionMatch, frame: &Bounds) -> Bounds {
    let rings = matched.pieces.iter().flat_map(|piece| &piece.rings);
    let points = rings.flat_map(|ring| ring.source.iter().chain(&ring.target));
    let all = Bounds::of(points.copied()).map_or(*frame, |outlines| outlines.union(frame));
    all.padded(FRAME_MARGIN * all.size().max_element())
}

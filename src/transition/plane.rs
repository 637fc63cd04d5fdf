//! Warps of the whole plane for fields and colours: from pins and lines to a
//! warp on a grid, or to rigid parts of the frame.

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
use crate::work::progress::{Progress, ProgressSpan, beside, checkpoint};
use std::sync::Arc;

/// Squares of the grid along the longer side of the frame, on which a warp is
/// taken as linear.
/// Some pixels a square in a window: what is linear within is not seen.
const GRID: u32 = 160;

/// Work of one frame, in places times features, beyond which the grid is made
/// coarser.
/// Some milliseconds on a core or two, so that a film plays at 60 frames.
const MOST_WORK: f64 = 3e6;

/// Work of a place by lattices, in features: it does not grow with them.
const LATTICE_WORK: usize = 16;

/// How far a mesh of rigid parts reaches beyond the frame, in longer sides:
/// its border bends on the way.
/// More costs faces that nobody sees.
const BEYOND: f64 = 0.25;

/// The warp of a specification over a frame.
pub(super) fn warp(
    spec: &TransitionSpec,
    frame: &Bounds,
    bar_width: f64,
    progress: &dyn Progress,
) -> Result<BuiltWarp, BuildError> {
    let kind = spec.cell.warp();
    if kind == WarpKind::None {
        return Ok(AnyWarp::Still(IdentityWarp::new(*frame)).into());
    }
    let features = PlaneFeatures::of(spec, bar_width, &ProgressSpan::new(progress, 0.0, 0.4))?;
    let progress = &ProgressSpan::new(progress, 0.4, 1.0);
    if kind == WarpKind::Arap {
        return rigid(spec, frame, features, progress);
    }
    checkpoint(progress, "warping", 0.0)?;
    // Equations of all features at once: beside, so that a cancel is answered.
    let (spec, frame, features) = (spec.clone(), *frame, Arc::new(features));
    let theirs = Arc::clone(&features);
    let warp = beside(progress, move || of_features(&spec, &frame, &theirs))?;
    Ok(BuiltWarp {
        automatic: features.automatic(),
        notes: features.notes.clone(),
        ..AnyWarp::Plane(warp?).into()
    })
}

/// The warp that takes its features along.
fn of_features(
    spec: &TransitionSpec,
    frame: &Bounds,
    features: &PlaneFeatures,
) -> Result<Arc<dyn Warp>, BuildError> {
    let options = &spec.options;
    let work = features.points.len() + 4 * features.lines.len();
    match spec.cell.warp() {
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
        // The table has no such cell; one that is added must be built.
        WarpKind::None | WarpKind::Paths | WarpKind::Arap => Err(BuildError::Unavailable(format!(
            "{} cannot be built; choose another method",
            spec.cell.name()
        ))),
    }
}

/// A warp of the features on a grid; behind their common motion where they
/// travel as a whole.
fn on_grid<W: PlaneWarp>(
    spec: &TransitionSpec,
    frame: &Bounds,
    PlaneFeatures { points, lines, .. }: &PlaneFeatures,
    work: usize,
    new: impl FnOnce(&Bounds, &[PointPair], &[LinePair]) -> Result<W, BuildError>,
) -> Result<Arc<dyn Warp>, BuildError> {
    let is_whole = match spec.options.travel {
        FeatureTravel::Auto => spec.cell.content() == ContentKind::Field,
        FeatureTravel::Whole => true,
        FeatureTravel::Straight => false,
    };
    let rigid = CommonRigidMotion::of(points, lines).filter(|_| is_whole);
    Ok(match rigid {
        Some(rigid) => {
            let warp = RigidElasticPlaneWarp::new(rigid, frame, points, lines, new)?;
            // What turns leaves the frame on its way; pictures are cut to it.
            let seen = match spec.cell.content() {
                ContentKind::Field => rigid.swept(frame),
                ContentKind::Colours | ContentKind::Solid => *frame,
            };
            Arc::new(GridWarp::new(warp, grid(&seen, work)))
        }
        None => Arc::new(GridWarp::new(new(frame, points, lines)?, grid(frame, work))),
    })
}

/// A grid that can be looked up in the time of a frame.
fn grid(frame: &Bounds, work: usize) -> PlaneGrid {
    let size = frame.size();
    let aspect = size.min_element() / size.max_element();
    // aspect · cells² places, each at the cost of all features.
    let places = MOST_WORK / (work.max(1) as f64);
    let cells = (places / aspect.max(0.01)).sqrt().min(f64::from(GRID));
    PlaneGrid::covering(frame, (cells as u32).max(24))
}

/// The frame as rigid as its pins allow. What nobody pinned may be pinned by
/// fewer points until no fold is left.
fn rigid(
    spec: &TransitionSpec,
    frame: &Bounds,
    mut features: PlaneFeatures,
    progress: &dyn Progress,
) -> Result<BuiltWarp, BuildError> {
    let mut notes = std::mem::take(&mut features.notes);
    let mut pins = features.as_points();
    let found = pins.len();
    let mut warp = None;
    if let Some(matched) = &features.matched {
        match about_outlines(spec, frame, &features, matched, progress)? {
            Ok(made) => warp = Some(made),
            Err(error) => notes.push(TransitionNote::NotByOutlines(error)),
        }
    }
    let warp = match warp {
        Some(warp) => warp,
        None => about_pins(spec, frame, features.are_automatic, &mut pins, progress)?,
    };
    if pins.len() < found {
        notes.push(TransitionNote::FewerPins {
            left: pins.len(),
            of: found,
        });
    }
    // Pins that somebody set are shown as theirs already.
    pins.retain(|_| features.are_automatic);
    Ok(BuiltWarp {
        automatic: pins,
        notes,
        ..warp.into()
    })
}

/// The frame as rigid as its pins allow, of which every other one is left out
/// while it folds and they may be.
fn about_pins(
    spec: &TransitionSpec,
    frame: &Bounds,
    are_automatic: bool,
    pins: &mut Vec<PointPair>,
    progress: &dyn Progress,
) -> Result<AnyWarp, BuildError> {
    let frame = frame.padded(BEYOND * frame.size().max_element());
    let mesh = loop {
        match CompatibleMesh::around_pins(&frame, pins, progress) {
            Ok(mesh) => break mesh,
            Err(FramePinsError::Folds { .. } | FramePinsError::Coincide { .. })
                if are_automatic && !pins.is_empty() =>
            {
                *pins = pins.iter().copied().step_by(2).collect();
                // Every other pin of one is that one again.
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

/// The frame as rigid as matched outlines allow, behind the motion that they
/// have in common; why not, where they do not divide the frame alike.
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
            CommonRigidMotion::of(&features.points, &features.lines)
        }
        FeatureTravel::Straight => None,
    };
    let (matched, frame) = match &rigid {
        Some(rigid) => (&rigid.match_at_rest(matched), rigid.frame_at_rest(frame)),
        None => (matched, *frame),
    };
    // An outline that leaves the frame at rest could not be an edge of its mesh.
    let frame = around(matched, &frame);
    let made = CompatibleMesh::around_outlines(&frame, matched, &options.triangulation, progress);
    let mesh = match made {
        Ok(mesh) => mesh,
        Err(error) => {
            // A cancel comes back as an error of the mesh; it must not become a note.
            checkpoint(progress, "triangulating", 0.0)?;
            return Ok(Err(error));
        }
    };
    let arap = build_arap(&mesh, &options.arap, &[], progress)?;
    Ok(Ok(match rigid {
        Some(rigid) => AnyWarp::Turned(RigidElasticWarp::new(rigid, arap)),
        None => AnyWarp::Rigid(arap),
    }))
}

/// The frame with all outlines in it, and room around.
fn around(matched: &RegionMatch, frame: &Bounds) -> Bounds {
    let rings = matched.pieces.iter().flat_map(|piece| &piece.rings);
    let points = rings.flat_map(|ring| ring.source.iter().chain(&ring.target));
    let all = Bounds::of(points.copied()).map_or(*frame, |all| all.union(frame));
    all.padded(BEYOND * all.size().max_element())
}

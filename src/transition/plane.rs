//! Warps of the whole plane for fields and colours: from pins and lines to a
//! warp on a grid.

use super::{BuildError, TransitionSpec};
use crate::compatible::{CompatibleMesh, FrameError};
use crate::content::ContentKind;
use crate::correspondence::{HoleRule, LinePair, Matching, PointPair, match_regions};
use crate::geometry::Bounds;
use crate::progress::Progress;
use crate::warp::{
    Arap, Lattice, LatticeOptions, LineOptions, Lines, OnGrid, PlaneGrid, PlaneWarp, Scattered,
    ScatteredOptions, Still, Warp, WarpKind,
};
use std::sync::Arc;

/// The options of all warps of the plane.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PlaneOptions {
    /// By pairs of lines.
    pub lines: LineOptions,
    /// By scattered points.
    pub scattered: ScatteredOptions,
    /// By B-spline lattices.
    pub lattice: LatticeOptions,
}

/// Squares of the grid along the longer side of the frame, on which a warp is
/// taken as linear.
const GRID: u32 = 160;

/// Work of one frame, in places times features, beyond which the grid is made
/// coarser.
const MOST_WORK: f64 = 3e6;

/// How far a mesh of rigid parts reaches beyond the frame, in longer sides:
/// its border bends on the way.
const BEYOND: f64 = 0.25;

/// Pins that are set along each outline where nobody set any.
const AUTOMATIC: usize = 24;

/// The warp of a specification over a frame.
pub(super) fn warp(
    spec: &TransitionSpec,
    frame: &Bounds,
    bar_width: f64,
    progress: &dyn Progress,
) -> Result<Arc<dyn Warp>, BuildError> {
    let kind = spec.cell.warp();
    if kind == WarpKind::None {
        return Ok(Arc::new(Still::new(*frame)));
    }
    let features = Features::of(spec, bar_width, progress)?;
    if kind == WarpKind::Arap {
        return rigid(spec, frame, &features, progress);
    }
    let (points, lines) = (&features.points, &features.lines);
    let options = &spec.plane;
    let count = points.len() + 4 * lines.len();
    Ok(match kind {
        WarpKind::Lines => on_grid(
            Lines::new(frame, lines, points, &options.lines)?,
            frame,
            count,
        ),
        WarpKind::Scattered => {
            let warp = Scattered::new(frame, points, lines, options.scattered)?;
            on_grid(warp, frame, count)
        }
        WarpKind::Lattice => on_grid(
            Lattice::new(frame, points, lines, options.lattice)?,
            frame,
            16,
        ),
        WarpKind::None | WarpKind::Arap | WarpKind::Paths => Arc::new(Still::new(*frame)),
    })
}

/// The frame as rigid as its pins allow. What nobody pinned may be pinned by
/// fewer points until no fold is left.
fn rigid(
    spec: &TransitionSpec,
    frame: &Bounds,
    features: &Features,
    progress: &dyn Progress,
) -> Result<Arc<dyn Warp>, BuildError> {
    let frame = frame.padded(BEYOND * frame.size().max_element());
    let mut pins = features.as_points();
    loop {
        match CompatibleMesh::of_frame(&frame, &pins, progress) {
            Ok(mesh) => return Ok(Arc::new(Arap::build(&mesh, &spec.arap, progress)?)),
            Err(FrameError::Folds { .. }) if features.are_automatic && !pins.is_empty() => {
                pins = pins.into_iter().step_by(2).collect();
                if pins.len() == 1 {
                    pins.clear();
                }
            }
            Err(error) => return Err(error.into()),
        }
    }
}

fn on_grid(warp: impl PlaneWarp, frame: &Bounds, features: usize) -> Arc<dyn Warp> {
    let size = frame.size();
    let aspect = size.min_element() / size.max_element();
    let places = MOST_WORK / (features.max(1) as f64);
    let cells = (places / aspect.max(0.01)).sqrt().min(f64::from(GRID));
    let grid = PlaneGrid::covering(frame, (cells as u32).max(24));
    Arc::new(OnGrid::new(warp, grid))
}

/// What a warp of the plane goes by.
#[derive(Default)]
struct Features {
    points: Vec<PointPair>,
    lines: Vec<LinePair>,
    /// Nobody set them.
    are_automatic: bool,
}

impl Features {
    /// Lines as their ends and their middle.
    fn as_points(&self) -> Vec<PointPair> {
        let on = |line: &LinePair, along: f64| PointPair {
            source: line.source[0].lerp(line.source[1], along),
            target: line.target[0].lerp(line.target[1], along),
        };
        let of_line = |line: &LinePair| [0.0, 0.5, 1.0].map(|along| on(line, along));
        let ends = self.lines.iter().flat_map(of_line);
        self.points.iter().copied().chain(ends).collect()
    }

    /// Those that were set; where there are none and outlines are what is
    /// seen, some along matched outlines.
    fn of(
        spec: &TransitionSpec,
        bar_width: f64,
        progress: &dyn Progress,
    ) -> Result<Self, BuildError> {
        let given = Self {
            points: spec.matching.pins.clone(),
            lines: spec.matching.lines.clone(),
            are_automatic: false,
        };
        let is_empty = given.points.is_empty() && given.lines.is_empty();
        if !is_empty || spec.cell.content() != ContentKind::Field {
            return Ok(given);
        }
        let matching = Matching {
            holes: HoleRule::Close,
            ..spec.matching.clone()
        };
        let [source, target] = [&spec.source, &spec.target].map(|d| d.outline(bar_width));
        let matched = match_regions(&source?, &target?, &matching, progress)?;
        let rings = matched.automatic_pins(AUTOMATIC);
        Ok(if spec.cell.warp() == WarpKind::Lines {
            Self {
                points: Vec::new(),
                lines: rings.iter().flat_map(|ring| sides(ring)).collect(),
                are_automatic: true,
            }
        } else {
            Self {
                points: rings.concat(),
                lines: Vec::new(),
                are_automatic: true,
            }
        })
    }
}

/// The lines from each pin of a ring to the next.
fn sides(ring: &[PointPair]) -> impl Iterator<Item = LinePair> {
    let next = ring.iter().cycle().skip(1);
    ring.iter().zip(next).map(|(a, b)| LinePair {
        source: [a.source, b.source],
        target: [a.target, b.target],
    })
}

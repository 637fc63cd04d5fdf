//! Warps of the whole plane for fields and colours: from pins and lines to a
//! warp on a grid.

use super::{BuildError, TransitionSpec};
use crate::compatible::{CompatibleMesh, PinnedError};
use crate::content::ContentKind;
use crate::correspondence::{
    HoleRule, LinePair, Matching, PartRule, PointPair, RegionMatch, match_regions,
};
use crate::geometry::{Bounds, Regions, Ring, Side};
use crate::progress::{Progress, checkpoint};
use crate::warp::{
    Arap, Lattice, Lines, OnGrid, PlaneGrid, PlaneWarp, RigidPart, Scattered, Split, Still, Travel,
    Turned, Warp, WarpKind,
};
use std::sync::Arc;

/// Squares of the grid along the longer side of the frame, on which a warp is
/// taken as linear.
const GRID: u32 = 160;

/// Work of one frame, in places times features, beyond which the grid is made
/// coarser.
const MOST_WORK: f64 = 3e6;

/// How far a mesh of rigid parts reaches beyond the frame, in longer sides:
/// its border bends on the way.
const BEYOND: f64 = 0.25;

/// Pins so near an outline are on it, as a share of the design's diameter.
const ON_OUTLINE: f64 = 0.005;

/// Pins that are set along each outline where nobody set any.
const AUTOMATIC: usize = 24;

/// The same of lines, each of which pulls the whole plane along: where many are
/// near each other it folds.
const AUTOMATIC_LINES: usize = 10;

/// A warp of the plane and, where nobody set any, the pairs of points that it
/// goes by.
pub(super) type Chosen = (Arc<dyn Warp>, Vec<PointPair>);

/// The warp of a specification over a frame.
pub(super) fn warp(
    spec: &TransitionSpec,
    frame: &Bounds,
    bar_width: f64,
    progress: &dyn Progress,
) -> Result<Chosen, BuildError> {
    let kind = spec.cell.warp();
    if kind == WarpKind::None {
        return Ok((Arc::new(Still::new(*frame)), Vec::new()));
    }
    let features = Features::of(spec, bar_width, progress)?;
    if kind == WarpKind::Arap {
        return rigid(spec, frame, &features, progress);
    }
    let (points, lines) = (&features.points, &features.lines);
    let options = &spec.options;
    let automatic = if features.are_automatic {
        features
            .points
            .iter()
            .copied()
            .chain(lines.iter().map(start))
            .collect()
    } else {
        Vec::new()
    };
    let count = points.len() + 4 * lines.len();
    let warp = match kind {
        WarpKind::Lines => split_on_grid(spec, frame, &features, count, |frame, points, lines| {
            Ok(Lines::new(frame, lines, points, &options.lines)?)
        }),
        WarpKind::Scattered => {
            split_on_grid(spec, frame, &features, count, |frame, points, lines| {
                Ok(Scattered::new(frame, points, lines, options.scattered)?)
            })
        }
        WarpKind::Lattice => split_on_grid(spec, frame, &features, 16, |frame, points, lines| {
            Ok(Lattice::new(frame, points, lines, options.lattice)?)
        }),
        WarpKind::None | WarpKind::Arap | WarpKind::Paths => {
            Ok(Arc::new(Still::new(*frame)) as Arc<dyn Warp>)
        }
    };
    Ok((warp?, automatic))
}

fn start(line: &LinePair) -> PointPair {
    PointPair {
        source: line.source[0],
        target: line.target[0],
    }
}

/// A warp of the features on a grid; behind their common motion where they
/// travel as a whole.
fn split_on_grid<W: PlaneWarp>(
    spec: &TransitionSpec,
    frame: &Bounds,
    Features { points, lines, .. }: &Features,
    work: usize,
    new: impl FnOnce(&Bounds, &[PointPair], &[LinePair]) -> Result<W, BuildError>,
) -> Result<Arc<dyn Warp>, BuildError> {
    let is_whole = match spec.options.travel {
        Travel::Auto => spec.cell.content() == ContentKind::Field,
        Travel::Whole => true,
        Travel::Straight => false,
    };
    let rigid = RigidPart::of(points, lines).filter(|_| is_whole);
    Ok(match rigid {
        Some(rigid) => {
            let warp = Split::new(rigid, frame, points, lines, new)?;
            // What turns leaves the frame on its way; pictures are cut to it.
            let seen = match spec.cell.content() {
                ContentKind::Field => rigid.swept(frame),
                ContentKind::Colours | ContentKind::Solid => *frame,
            };
            on_grid(warp, &seen, work)
        }
        None => on_grid(new(frame, points, lines)?, frame, work),
    })
}

/// The frame as rigid as its pins allow. What nobody pinned may be pinned by
/// fewer points until no fold is left.
fn rigid(
    spec: &TransitionSpec,
    frame: &Bounds,
    features: &Features,
    progress: &dyn Progress,
) -> Result<Chosen, BuildError> {
    if let Some(matched) = &features.matched
        && let Some(warp) = about_outlines(spec, frame, features, matched, progress)?
    {
        let pins = features.as_points();
        return Ok((
            warp,
            if features.are_automatic {
                pins
            } else {
                Vec::new()
            },
        ));
    }
    let frame = frame.padded(BEYOND * frame.size().max_element());
    let mut pins = features.as_points();
    loop {
        match CompatibleMesh::around_pins(&frame, &pins, progress) {
            Ok(mesh) => {
                let warp = Arc::new(Arap::build(&mesh, &spec.options.arap, progress)?);
                pins.retain(|_| features.are_automatic);
                return Ok((warp, pins));
            }
            Err(PinnedError::Folds { .. } | PinnedError::Coincide { .. })
                if features.are_automatic && !pins.is_empty() =>
            {
                pins = pins.into_iter().step_by(2).collect();
                if pins.len() == 1 {
                    pins.clear();
                }
            }
            Err(error) => return Err(error.into()),
        }
    }
}

/// The frame as rigid as matched outlines allow, behind the motion that they
/// have in common; none where they do not divide the frame alike.
fn about_outlines(
    spec: &TransitionSpec,
    frame: &Bounds,
    features: &Features,
    matched: &RegionMatch,
    progress: &dyn Progress,
) -> Result<Option<Arc<dyn Warp>>, BuildError> {
    let rigid = match spec.options.travel {
        Travel::Auto | Travel::Whole => RigidPart::of(&features.points, &features.lines),
        Travel::Straight => None,
    };
    let (matched, frame) = match &rigid {
        Some(rigid) => (&rigid.match_at_rest(matched), rigid.frame_at_rest(frame)),
        None => (matched, *frame),
    };
    let frame = around(matched, &frame);
    let made =
        CompatibleMesh::around_outlines(&frame, matched, &spec.options.triangulation, progress);
    let Ok(mesh) = made else {
        checkpoint(progress, "triangulating", 0.0)?;
        return Ok(None);
    };
    let arap = Arap::build(&mesh, &spec.options.arap, progress)?;
    Ok(Some(match rigid {
        Some(rigid) => Arc::new(Turned::new(rigid, arap)),
        None => Arc::new(arap),
    }))
}

/// The frame with all outlines in it, and room around.
fn around(matched: &RegionMatch, frame: &Bounds) -> Bounds {
    let rings = matched.pieces.iter().flat_map(|piece| &piece.rings);
    let points = rings.flat_map(|ring| ring.source.iter().chain(&ring.target));
    let all = Bounds::of(points.copied()).map_or(*frame, |all| all.union(frame));
    all.padded(BEYOND * all.size().max_element())
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
    /// The outlines that they are on, where all are on outlines.
    matched: Option<RegionMatch>,
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

    /// Whether each feature is a point, and on the outline of either design.
    fn are_on(&self, outlines: &[Regions; 2]) -> bool {
        let is_on = |pair: &PointPair| {
            Side::BOTH.iter().all(|&side| {
                let regions = &outlines[side];
                let far = |ring: &Ring| ring.distance_squared(pair[side]).sqrt();
                let near = regions.rings().map(far).fold(f64::INFINITY, f64::min);
                near <= ON_OUTLINE * regions.bounds().diameter()
            })
        };
        self.lines.is_empty() && self.points.iter().all(is_on)
    }

    /// Those that were set; where there are none and outlines are what is
    /// seen, some along matched outlines.
    fn of(
        spec: &TransitionSpec,
        bar_width: f64,
        progress: &dyn Progress,
    ) -> Result<Self, BuildError> {
        let mut given = Self {
            points: spec.options.matching.pins.clone(),
            lines: spec.options.matching.lines.clone(),
            are_automatic: false,
            matched: None,
        };
        let is_empty = given.points.is_empty() && given.lines.is_empty();
        if spec.cell.content() != ContentKind::Field {
            return Ok(given);
        }
        // No map of the plane cuts a ring open or a part in two.
        let matching = Matching {
            holes: HoleRule::Close,
            parts: PartRule::Alone,
            ..spec.options.matching.clone()
        };
        let [source, target] = [&spec.source, &spec.target].map(|d| d.outline(bar_width));
        let outlines = [source?, target?];
        let [source, target] = &outlines;
        if !is_empty {
            // Pins that somebody moved along the outlines still match them.
            let is_rigid = spec.cell.warp() == WarpKind::Arap;
            if is_rigid && given.are_on(&outlines) {
                given.matched = match_regions(source, target, &matching, progress).ok();
                checkpoint(progress, "matching", 0.5)?;
            }
            return Ok(given);
        }
        let matched = match_regions(source, target, &matching, progress)?;
        let count = match spec.cell.warp() {
            WarpKind::Lines => AUTOMATIC_LINES,
            _ => AUTOMATIC,
        };
        let rings = matched.automatic_pins(count);
        Ok(if spec.cell.warp() == WarpKind::Lines {
            Self {
                points: Vec::new(),
                lines: rings.iter().flat_map(|ring| sides(ring)).collect(),
                are_automatic: true,
                matched: Some(matched),
            }
        } else {
            Self {
                points: rings.concat(),
                lines: Vec::new(),
                are_automatic: true,
                matched: Some(matched),
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

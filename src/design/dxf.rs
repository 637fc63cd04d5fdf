//! DXF drawings, text and binary, of any release, as regions.
//!
//! LINE, LWPOLYLINE and POLYLINE with bulges, ARC, CIRCLE, ELLIPSE, SPLINE
//! and INSERT of blocks are read. Curves are joined end to end into rings:
//! ends count as one where they are nearer than [`JOIN_TOLERANCE`] of the
//! drawing's longer side. The even-odd rule says what is inside. Where layers or
//! objects have colours, what each layer has in each colour is a coat of paint.
//! Units are
//! not looked at, nor is what lies on hidden layers or in the paper space.
//! One unit of the drawing is one unit.
//!
//! Read by hand, as the pairs of a DXF file are simple: the `dxf` crate keeps
//! every object with all its attributes, hundreds of bytes for each byte of a
//! hostile file, and does not say on which line an error is.
//!
//! Guaranteed: no bytes make it panic or run without end; memory is bounded by
//! some hundred bytes for each object of at most [`MAX_OBJECTS`]. Curves that
//! do not close are left out, which is told; where more than two meet and
//! their number is odd, which of them belong to a ring is arbitrary. Splines
//! that are given only by the points they pass through, hatches, text and
//! solids are left out, which is told.
//!
//! [`MAX_OBJECTS`]: error::MAX_OBJECTS

mod colours;
mod curve;
mod drawing;
mod entity;
mod error;
mod join;
mod pairs;

pub use error::{DxfError, DxfPlace};
pub(super) use pairs::BINARY;

use super::flatten::{MAX_POINTS, MIN_TOLERANCE, TooManyPoints};
use super::form::ImportedOutlines;
use super::note::{ImportNote, OtherKinds};
use super::paint_layer::{PaintGroup, PaintLayer, stack_by_containment};
use crate::colour::Rgb;
use crate::geometry::{Bounds, DVec2, FillRule, Regions};
use curve::DxfCurve;
use drawing::DxfPath;
use std::collections::{BTreeMap, BTreeSet};

/// How far ends that belong together may be apart, as a fraction of the
/// drawing's longer side: what rounding to four digits leaves.
pub(super) const JOIN_TOLERANCE: f64 = 1e-4;

/// Points of one polyline nearer than this fraction of the longer side differ
/// by rounding: a bulge of 1e-7 makes an arc whose ends are good to 3e-10.
const ROUNDING: f64 = 1e-9;

/// Reads a DXF file. The tolerance is a fraction of the drawing's longer side.
pub(super) fn read(bytes: &[u8], tolerance: f64) -> Result<ImportedOutlines, DxfError> {
    let drawing = drawing::read(bytes)?;
    let curves = || drawing.paths.iter().flat_map(|path| &path.curves);
    let hull = Bounds::of(curves().flat_map(DxfCurve::hull));
    let side = hull.map_or(0.0, |hull| hull.size().max_element());
    // Not a curve, or points alone.
    if side <= 0.0 {
        return Err(DxfError::Nothing(OtherKinds(drawing.skipped)));
    }
    let tolerance = tolerance.max(MIN_TOLERANCE) * side;
    let all: Vec<&DxfPath> = drawing.paths.iter().collect();
    let (mut rings, open) = flattened(&all, tolerance, ROUNDING * side)?;
    let count = open.len();
    let joined = join::join_curves(open, JOIN_TOLERANCE * side);
    rings.extend(joined.rings);
    if let (true, Some(&at)) = (rings.is_empty(), joined.loose.first()) {
        return Err(DxfError::Open { count, at });
    }
    let (regions, mut repairs) = Regions::from_rings_reporting(&rings, FillRule::EvenOdd)?;
    // Rings that are there twice were counted by the cleaning, curves before it.
    repairs.duplicates += joined.duplicates;
    let mut notes = ImportNote::of_repairs(&repairs, FillRule::EvenOdd);
    notes.extend(joined.loose.first().map(|&at| ImportNote::Open {
        count: joined.loose.len(),
        at,
    }));
    notes.extend(ImportNote::of_skipped(drawing.skipped));
    Ok(ImportedOutlines {
        coats: coats(&drawing.paths, tolerance, side)?,
        extent: regions.bounds(),
        regions,
        notes,
    })
}

/// What each layer has in each colour, where any colour is given. Of what closes only
/// together the longest share decides.
fn coats(paths: &[DxfPath], tolerance: f64, side: f64) -> Result<Vec<PaintLayer>, DxfError> {
    if paths.iter().all(|path| path.drawn.1.is_none()) {
        return Ok(Vec::new());
    }
    let mut of_ink: BTreeMap<_, Vec<&DxfPath>> = BTreeMap::new();
    for path in paths {
        let (layer, rgb) = &path.drawn;
        let key = (layer, rgb.map(|Rgb(rgb)| rgb));
        of_ink.entry(key).or_default().push(path);
    }
    let mut rings_of = Vec::with_capacity(of_ink.len());
    // What does not close in one ink, and the number of its ink.
    let (mut left, mut inks_left) = (Vec::new(), Vec::new());
    for (ink, paths) in of_ink.values().enumerate() {
        let (mut rings, open) = flattened(paths, tolerance, ROUNDING * side)?;
        let joined = join::join_curves(open.clone(), JOIN_TOLERANCE * side);
        let closed: BTreeSet<usize> = joined.of_rings.into_iter().flatten().collect();
        rings.extend(joined.rings);
        rings_of.push(rings);
        let open = open.into_iter().enumerate();
        let open = open.filter_map(|(k, curve)| (!closed.contains(&k)).then_some(curve));
        left.extend(open);
        inks_left.resize(left.len(), ink);
    }
    let joined = join::join_curves(left.clone(), JOIN_TOLERANCE * side);
    for (ring, curves) in joined.rings.into_iter().zip(&joined.of_rings) {
        let mut shares = vec![0.0; rings_of.len()];
        for &curve in curves {
            let steps = left[curve].windows(2).map(|step| step[0].distance(step[1]));
            shares[inks_left[curve]] += steps.sum::<f64>();
        }
        let most = (0..shares.len())
            .rev()
            .max_by(|&a, &b| shares[a].total_cmp(&shares[b]));
        rings_of[most.unwrap_or(0)].push(ring);
    }
    let mut sheets = Vec::with_capacity(rings_of.len());
    for ((layer, rgb), rings) in of_ink.keys().zip(rings_of) {
        // Nothing of it closes, which is told of the whole.
        let regions = Regions::from_rings(&rings, FillRule::EvenOdd);
        sheets.extend(regions.ok().map(|regions| PaintGroup {
            regions,
            paint: rgb.map(|rgb| Rgb(rgb).into()),
            name: String::from_utf8_lossy(layer).into_owned(),
        }));
    }
    Ok(stack_by_containment(&sheets))
}

type Polylines = Vec<Vec<DVec2>>;

/// The paths as polygons: those that close, and those that do not.
fn flattened(
    paths: &[&DxfPath],
    tolerance: f64,
    rounding: f64,
) -> Result<(Polylines, Polylines), DxfError> {
    let (mut closed, mut open) = (Vec::new(), Vec::new());
    let mut count = 0;
    for DxfPath {
        curves, is_closed, ..
    } in paths
    {
        let mut points = Vec::new();
        for curve in curves {
            let start = points.len();
            curve.flatten(tolerance, &mut points);
            // The end of an arc is computed and need not be where the next begins.
            if start > 0 && points[start].distance(points[start - 1]) <= rounding {
                points.remove(start);
            }
            if count + points.len() > MAX_POINTS {
                return Err(TooManyPoints.into());
            }
        }
        let is_back = |p: &DVec2| points[0].distance(*p) <= rounding;
        if *is_closed && points.len() > 1 && points.last().is_some_and(is_back) {
            points.pop();
        }
        count += points.len();
        points.dedup();
        match (*is_closed, points.len()) {
            (_, 0 | 1) => {}
            (true, _) => closed.push(points),
            (false, _) => open.push(points),
        }
    }
    Ok((closed, open))
}

#[cfg(test)]
mod tests;

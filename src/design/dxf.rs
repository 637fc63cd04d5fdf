//! Importer of DXF drawings, text and binary, of any release.
//!
//! Supports LINE, LWPOLYLINE and POLYLINE with bulges, ARC, CIRCLE, ELLIPSE, SPLINE and INSERT.
//! Curves are joined end to end into rings; end points closer than [`JOIN_TOLERANCE`] count as one.
//! The even-odd rule decides what is inside. If layers or entities have colours, each combination
//! of DXF layer and colour becomes one or more paint layers. One drawing unit is one design unit;
//! the unit that the file declares is ignored. Entities on hidden layers and in paper space are
//! left out.
//!
//! Does not use the `dxf` crate, which stores every entity with all attributes (hundreds of
//! bytes per byte of a hostile file) and does not report the line of an error.
//!
//! Guarantees that no input causes a panic or an infinite loop, and that memory use stays within a
//! few hundred bytes per entity; there are at most [`MAX_OBJECTS`] entities and polyline vertices.
//! Open curves, splines with fit points only, hatches, text and solids are ignored and reported as
//! notes. Where three or a larger odd number of curves meet at a point, it is arbitrary which of
//! them form a ring.
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

/// Maximum distance between end points that are joined, as a fraction of the drawing's longer side
/// (tolerance: covers coordinates that were rounded to four significant digits).
pub(super) const JOIN_TOLERANCE: f64 = 1e-4;

/// Distance up to which two points of one path count as equal, as a fraction of the drawing's
/// longer side (tolerance: the end points of an arc with bulge 1e-7 are accurate to 3e-10).
const ROUNDING: f64 = 1e-9;

/// Imports a DXF file. `tolerance` is the maximum deviation of flattened curves, as a fraction of
/// the drawing's longer side.
///
/// # Errors
/// Returns a [`DxfError`] if the file is damaged, exceeds a limit, or has no closed outline.
pub(super) fn read(bytes: &[u8], tolerance: f64) -> Result<ImportedOutlines, DxfError> {
    let drawing = drawing::read(bytes)?;
    let curves = || drawing.paths.iter().flat_map(|path| &path.curves);
    let hull = Bounds::of(curves().flat_map(DxfCurve::hull));
    let side = hull.map_or(0.0, |hull| hull.size().max_element());
    // The drawing has no curves, or all of them lie in one point.
    if side <= 0.0 {
        return Err(DxfError::Nothing(OtherKinds(drawing.skipped)));
    }
    let tolerance = tolerance.max(MIN_TOLERANCE) * side;
    let all: Vec<&DxfPath> = drawing.paths.iter().collect();
    let (mut rings, open) = flatten_paths(&all, tolerance, ROUNDING * side)?;
    let count = open.len();
    let joined = join::join_curves(open, JOIN_TOLERANCE * side);
    rings.extend(joined.rings);
    if let (true, Some(&at)) = (rings.is_empty(), joined.loose_ends.first()) {
        return Err(DxfError::Open { count, at });
    }
    let (regions, mut repairs) = Regions::from_rings_reporting(&rings, FillRule::EvenOdd)?;
    // Duplicate rings are already counted. Add the duplicate curves.
    repairs.duplicates += joined.duplicates;
    let mut notes = ImportNote::from_repairs(&repairs, FillRule::EvenOdd);
    notes.extend(joined.loose_ends.first().map(|&at| ImportNote::OpenCurves {
        count: joined.loose_ends.len(),
        at,
    }));
    notes.extend(ImportNote::from_skipped(drawing.skipped));
    Ok(ImportedOutlines {
        paint_layers: layers_by_style(&drawing.paths, tolerance, side)?,
        extent: regions.bounds(),
        regions,
        notes,
    })
}

/// Returns the paint layers of all styles, at least one for each style that encloses an area; none
/// if the drawing has no colours. A style is a combination of DXF layer and colour. `tolerance` and
/// `side`, the longer side of the drawing, are in drawing units.
///
/// A ring of curves with different styles gets the style whose curves have the largest total
/// length.
fn layers_by_style(
    paths: &[DxfPath],
    tolerance: f64,
    side: f64,
) -> Result<Vec<PaintLayer>, DxfError> {
    if paths.iter().all(|path| path.layer_and_colour.1.is_none()) {
        return Ok(Vec::new());
    }
    let mut paths_by_style: BTreeMap<_, Vec<&DxfPath>> = BTreeMap::new();
    for path in paths {
        let (layer, rgb) = &path.layer_and_colour;
        let key = (layer, rgb.map(|Rgb(rgb)| rgb));
        paths_by_style.entry(key).or_default().push(path);
    }
    let mut rings_by_style = Vec::with_capacity(paths_by_style.len());
    // Curves that form no ring with other curves of their style, and for each of these curves the
    // index of its style.
    let (mut remaining, mut remaining_styles) = (Vec::new(), Vec::new());
    for (style, paths) in paths_by_style.values().enumerate() {
        let (mut rings, open) = flatten_paths(paths, tolerance, ROUNDING * side)?;
        let joined = join::join_curves(open.clone(), JOIN_TOLERANCE * side);
        let closed: BTreeSet<usize> = joined.ring_curves.into_iter().flatten().collect();
        rings.extend(joined.rings);
        rings_by_style.push(rings);
        let open = open.into_iter().enumerate();
        let open = open.filter_map(|(k, curve)| (!closed.contains(&k)).then_some(curve));
        remaining.extend(open);
        remaining_styles.resize(remaining.len(), style);
    }
    let joined = join::join_curves(remaining.clone(), JOIN_TOLERANCE * side);
    for (ring, curves) in joined.rings.into_iter().zip(&joined.ring_curves) {
        let mut lengths = vec![0.0; rings_by_style.len()];
        for &curve in curves {
            let steps = remaining[curve]
                .windows(2)
                .map(|step| step[0].distance(step[1]));
            lengths[remaining_styles[curve]] += steps.sum::<f64>();
        }
        // `max_by` returns the last of several maxima, so the order is reversed to let the first
        // style win a tie.
        let longest = (0..lengths.len())
            .rev()
            .max_by(|&a, &b| lengths[a].total_cmp(&lengths[b]));
        rings_by_style[longest.unwrap_or(0)].push(ring);
    }
    let mut sheets = Vec::with_capacity(rings_by_style.len());
    for ((layer, rgb), rings) in paths_by_style.keys().zip(rings_by_style) {
        // A style without a ring has no regions and is skipped; the notes already report its open
        // curves.
        let regions = Regions::from_rings(&rings, FillRule::EvenOdd);
        sheets.extend(regions.ok().map(|regions| PaintGroup {
            regions,
            paint: rgb.map(|rgb| Rgb(rgb).into()),
            name: String::from_utf8_lossy(layer).into_owned(),
        }));
    }
    Ok(stack_by_containment(&sheets))
}

/// Lists of points, closed or open depending on the context.
type Polylines = Vec<Vec<DVec2>>;

/// Flattens paths; returns closed polygons and open polylines. `tolerance` (the maximum deviation)
/// and `rounding` (the distance up to which points count as equal) are in drawing units.
fn flatten_paths(
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
            // The computed end of an arc may differ from the start of the next curve by rounding
            // errors.
            if start > 0 && points[start].distance(points[start - 1]) <= rounding {
                points.remove(start);
            }
            if count + points.len() > MAX_POINTS {
                return Err(TooManyPoints.into());
            }
        }
        let is_at_start = |p: &DVec2| points[0].distance(*p) <= rounding;
        if *is_closed && points.len() > 1 && points.last().is_some_and(is_at_start) {
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

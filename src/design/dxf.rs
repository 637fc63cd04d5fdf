//! Importer of DXF drawings, text and binary, of any release.
//!
//! Supports LINE, LWPOLYLINE and POLYLINE with bulges, ARC, CIRCLE, ELLIPSE, SPLINE and
//! INSERT. Curves are joined end to end into rings; end points closer than
//! [`JOIN_TOLERANCE`] count as one. The even-odd rule decides what is inside. If layers or
//! entities have colours, each combination of layer and colour becomes a paint layer. One
//! drawing unit is one design unit; the declared units, hidden layers and paper space are
//! ignored.
//!
//! Does not use the `dxf` crate, which stores every entity with all attributes (hundreds of
//! bytes per byte of a hostile file) and does not report the line of an error.
//!
//! Guarantees that no bytes cause a panic or an endless run, and that memory stays within a
//! few hundred bytes per entity, of which there are at most [`MAX_OBJECTS`]. Open curves,
//! splines with fit points only, hatches, text and solids are ignored and reported as
//! notes. If an odd number of curves, three or more, meets at a point, it is arbitrary which
//! of them form a ring.
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

/// Maximum distance of end points that are joined, as a fraction of the drawing's longer side
/// (tolerance: coordinates rounded to four digits).
pub(super) const JOIN_TOLERANCE: f64 = 1e-4;

/// Maximum distance of equal points within one path, as a fraction of the longer side
/// (tolerance: the end points of an arc with bulge 1e-7 are accurate to 3e-10).
const ROUNDING: f64 = 1e-9;

/// Imports a DXF file. `tolerance` is a fraction of the drawing's longer side.
///
/// # Errors
/// [`DxfError`] names the position in the file or the open end that prevents the import.
pub(super) fn read(bytes: &[u8], tolerance: f64) -> Result<ImportedOutlines, DxfError> {
    let drawing = drawing::read(bytes)?;
    let curves = || drawing.paths.iter().flat_map(|path| &path.curves);
    let hull = Bounds::of(curves().flat_map(DxfCurve::hull));
    let side = hull.map_or(0.0, |hull| hull.size().max_element());
    // No curves, or only points.
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
    // `from_rings_reporting` counts duplicate rings, joining counts duplicate curves.
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

/// Returns one or more paint layers for each combination of DXF layer and colour; none if no
/// colour is given.
///
/// A ring whose curves have different styles gets the style with the largest total length.
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
    // Curves that do not close within their own style, and the index of that style.
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
        // `max_by` returns the last maximum; reversed, the first style wins a tie.
        let longest = (0..lengths.len())
            .rev()
            .max_by(|&a, &b| lengths[a].total_cmp(&lengths[b]));
        rings_by_style[longest.unwrap_or(0)].push(ring);
    }
    let mut sheets = Vec::with_capacity(rings_by_style.len());
    for ((layer, rgb), rings) in paths_by_style.keys().zip(rings_by_style) {
        // Skips styles without a ring; the notes already report their open curves.
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

/// Flattens paths; returns closed polygons and open polylines. Both lengths are in drawing
/// units.
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
            // The computed end of an arc may differ from the next start by rounding.
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

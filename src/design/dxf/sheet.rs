//! Flattened curves of a drawing, sorted into closed outlines, which are filled, and lines, which
//! are drawn with a width.
//!
//! Curves of one style are joined first, then what remains of all styles together. A ring of curves
//! with different styles gets the style whose curves have the largest total length.

use super::curve::DxfCurve;
use super::error::DxfError;
use super::expansion::{AreaShape, DxfArea, DxfDrawing, DxfPath};
use super::join::join_curves;
use crate::design::flatten::{Flattener, MAX_POINTS, TooManyPoints};
use crate::design::svg::WindingRings;
use crate::geometry::{
    Bounds, DVec2, EdgeBvh, FillRule, Regions, distance_squared_to_segment, perimeter, signed_area,
};
use std::collections::BTreeMap;

/// Lengths by which a drawing is flattened and joined, in drawing units.
#[derive(Clone, Copy, Debug)]
pub(super) struct SheetScale {
    /// Maximum deviation of flattened curves.
    pub tolerance: f64,
    /// Distance up to which two points of one path count as equal.
    pub rounding: f64,
    /// Maximum distance between end points that are joined.
    pub gap: f64,
    /// Minimum width of a line.
    pub hair: f64,
}

/// Flattened path.
pub(super) struct FlatPath {
    pub points: Vec<DVec2>,
    /// Whether the last point is followed by the first.
    pub is_closed: bool,
    /// Index of the style.
    pub style: usize,
    /// Position in the order of drawing.
    pub order: usize,
}

/// Closed outline.
pub(super) struct OutlineRing {
    pub points: Vec<DVec2>,
    /// Index of the style.
    pub style: usize,
    /// Indices of the paths that form the ring.
    pub paths: Vec<usize>,
}

impl OutlineRing {
    /// Returns whether the ring is more than a line there and back; `rounding` is the distance up
    /// to which points count as equal.
    fn encloses_area(&self, rounding: f64) -> bool {
        signed_area(&self.points).abs() > rounding * perimeter(&self.points)
    }
}

/// Flattened area.
pub(super) struct OutlinedArea {
    /// Outlines, filled by the non-zero rule.
    pub rings: WindingRings,
    pub is_text: bool,
    /// Index of the style.
    pub style: usize,
    /// Position in the order of drawing.
    pub order: usize,
}

/// Flattened drawing.
pub(super) struct Sheet {
    pub paths: Vec<FlatPath>,
    pub rings: Vec<OutlineRing>,
    /// Indices of the paths that belong to no ring.
    pub lines: Vec<usize>,
    pub areas: Vec<OutlinedArea>,
    /// Number of duplicate curves that were ignored.
    pub duplicates: usize,
    /// Number of areas that enclose nothing and were ignored.
    pub empty_areas: usize,
}

impl Sheet {
    /// Flattens a drawing and joins its curves.
    pub fn of(drawing: &DxfDrawing, scale: SheetScale) -> Result<Self, DxfError> {
        let areas = flatten_areas(&drawing.areas, scale)?;
        let mut sheet = Self {
            paths: flatten_paths(&drawing.paths, scale)?,
            rings: Vec::new(),
            lines: Vec::new(),
            empty_areas: drawing.areas.len() - areas.len(),
            areas,
            duplicates: 0,
        };
        let mut open_by_style: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
        for (index, path) in sheet.paths.iter().enumerate() {
            match path.is_closed {
                true => sheet.rings.push(OutlineRing {
                    points: path.points.clone(),
                    style: path.style,
                    paths: vec![index],
                }),
                false => open_by_style.entry(path.style).or_default().push(index),
            }
        }
        let mut remaining = Vec::new();
        for paths in open_by_style.into_values() {
            remaining.extend(sheet.join(&paths, scale.gap));
        }
        sheet.lines = sheet.join(&remaining, scale.gap);
        let (rings, flat): (Vec<_>, Vec<_>) = std::mem::take(&mut sheet.rings)
            .into_iter()
            .partition(|ring| ring.encloses_area(scale.rounding));
        sheet.rings = rings;
        snap_duplicates(&mut sheet.rings, 2.0 * scale.tolerance);
        sheet
            .lines
            .extend(flat.into_iter().flat_map(|ring| ring.paths));
        Ok(sheet)
    }

    /// Joins open paths to rings; returns the paths that belong to no ring.
    fn join(&mut self, paths: &[usize], gap: f64) -> Vec<usize> {
        let curves = paths.iter().map(|&path| self.paths[path].points.clone());
        let joined = join_curves(curves.collect(), gap);
        self.duplicates += joined.duplicates;
        for (points, curves) in joined.rings.into_iter().zip(joined.ring_curves) {
            let paths: Vec<usize> = curves.into_iter().map(|curve| paths[curve]).collect();
            self.rings.push(OutlineRing {
                points,
                style: self.longest_style(&paths),
                paths,
            });
        }
        joined.loose.into_iter().map(|curve| paths[curve]).collect()
    }

    /// Returns the style of the paths whose total length is largest; of equals the first.
    fn longest_style(&self, paths: &[usize]) -> usize {
        let mut lengths: BTreeMap<usize, f64> = BTreeMap::new();
        for &path in paths {
            let FlatPath { points, style, .. } = &self.paths[path];
            let steps = points.windows(2).map(|step| step[0].distance(step[1]));
            *lengths.entry(*style).or_default() += steps.sum::<f64>();
        }
        // `max_by` returns the last of several maxima, so the order is reversed to let the first
        // style win a tie.
        let longest = lengths.into_iter().rev().max_by(|a, b| a.1.total_cmp(&b.1));
        longest.map_or(0, |(style, _)| style)
    }
}

/// Number of rings with nearly the same bounding box with which a ring is compared (resource
/// limit).
const MAX_COMPARED: usize = 8;

/// Gives rings that are everywhere at most `within` apart the same points, so that they count as
/// duplicates: an outline may be drawn once as arcs and once as a polyline, which are flattened
/// differently.
fn snap_duplicates(rings: &mut [OutlineRing], within: f64) {
    let boxes: Vec<Bounds> = rings
        .iter()
        .filter_map(|ring| Bounds::of(ring.points.iter().copied()))
        .collect();
    if boxes.len() < rings.len() {
        return; // not reached: a ring has points
    }
    let key = |ring: usize| {
        let Bounds { min, max } = boxes[ring];
        [min.x, min.y, max.x, max.y].map(|x| (x / (4.0 * within)).round() as i64)
    };
    let mut order: Vec<usize> = (0..rings.len()).collect();
    order.sort_by_key(|&ring| (key(ring), ring));
    for (k, &ring) in order.iter().enumerate() {
        let earlier = order[k.saturating_sub(MAX_COMPARED)..k].iter().rev();
        let twin = earlier
            .take_while(|&&other| key(other) == key(ring))
            .find(|&&other| {
                let areas = [ring, other].map(|ring| signed_area(&rings[ring].points).abs());
                let slack = within * perimeter(&rings[ring].points);
                (areas[0] - areas[1]).abs() <= slack && follows(&rings[ring], &rings[other], within)
            });
        if let Some(&twin) = twin {
            rings[ring].points = rings[twin].points.clone();
        }
    }
}

/// Returns whether all points of a ring lie at most `within` from another ring.
fn follows(ring: &OutlineRing, other: &OutlineRing, within: f64) -> bool {
    let edges = EdgeBvh::of(&other.points);
    ring.points.iter().all(|&p| {
        let place = Bounds { min: p, max: p }.padded(within);
        let limit = within * within;
        edges.any_edge_near(&place, &|[a, b]| {
            distance_squared_to_segment(p, a, b) <= limit
        })
    })
}

/// Flattens paths; leaves out those that are a single point.
fn flatten_paths(paths: &[DxfPath], scale: SheetScale) -> Result<Vec<FlatPath>, TooManyPoints> {
    let mut flat = Vec::with_capacity(paths.len());
    let mut count = 0;
    for path in paths {
        let mut points = Vec::new();
        for curve in &path.curves {
            let start = points.len();
            curve.flatten(scale.tolerance, &mut points);
            // The computed end of an arc may differ from the start of the next curve by rounding
            // errors.
            if start > 0 && points[start].distance(points[start - 1]) <= scale.rounding {
                points.remove(start);
            }
            if count + points.len() > MAX_POINTS {
                return Err(TooManyPoints);
            }
        }
        points.dedup();
        let is_near = |p: &DVec2| points[0].distance(*p) <= scale.rounding;
        if path.is_closed && points.len() > 1 && points.last().is_some_and(is_near) {
            points.pop();
        }
        count += points.len();
        if points.len() > 1 {
            flat.push(FlatPath {
                // Two points enclose nothing; they are a line.
                is_closed: path.is_closed && points.len() > 2,
                points,
                style: path.style,
                order: path.order,
            });
        }
    }
    Ok(flat)
}

/// Flattens areas; leaves out those that enclose nothing.
fn flatten_areas(areas: &[DxfArea], scale: SheetScale) -> Result<Vec<OutlinedArea>, TooManyPoints> {
    let mut flattener = Flattener::new(scale.tolerance);
    let mut flat = Vec::with_capacity(areas.len());
    let mut count = 0;
    for area in areas {
        let (rings, rule) = match &area.shape {
            AreaShape::Band(band) => {
                let rings = band.area(scale.tolerance, &mut flattener)?;
                (rings, FillRule::NonZero)
            }
            AreaShape::Loops(area) => {
                let rings = area
                    .loops
                    .iter()
                    .flat_map(|curves| loop_rings(curves, scale));
                (rings.collect(), area.rule)
            }
        };
        count += rings.iter().map(Vec::len).sum::<usize>();
        if count > MAX_POINTS {
            return Err(TooManyPoints);
        }
        if let Ok(regions) = Regions::from_rings(&rings, rule) {
            flat.push(OutlinedArea {
                rings: regions.rings().map(|ring| ring.points().to_vec()).collect(),
                is_text: area.is_text,
                style: area.style,
                order: area.order,
            });
        }
    }
    Ok(flat)
}

/// Returns the polygons of a boundary loop. Curves are reversed where that makes them meet; a
/// closed curve, or a curve that begins elsewhere after the loop has closed, begins a new polygon.
fn loop_rings(curves: &[DxfCurve], scale: SheetScale) -> WindingRings {
    let mut rings: WindingRings = Vec::new();
    let mut ring: Vec<DVec2> = Vec::new();
    let mut is_first = false;
    for curve in curves {
        let mut points = Vec::new();
        curve.flatten(scale.tolerance, &mut points);
        let (Some(&start), Some(&end)) = (points.first(), points.last()) else {
            continue;
        };
        let distances = |p: DVec2| [p.distance(start), p.distance(end)];
        let nearest = |p: DVec2| distances(p)[0].min(distances(p)[1]);
        let is_whole = matches!(curve, DxfCurve::Arc(arc) if arc.is_full_ellipse());
        if let (Some(&first), Some(&last)) = (ring.first(), ring.last()) {
            let is_closed = !is_first && first.distance(last) <= scale.gap;
            if is_whole || is_closed && nearest(last) > scale.gap {
                rings.push(std::mem::take(&mut ring));
            } else if is_first && nearest(first) < nearest(last) {
                ring.reverse();
            }
        }
        if is_whole {
            rings.push(points);
            continue;
        }
        if let Some(&last) = ring.last()
            && distances(last)[1] < distances(last)[0]
        {
            points.reverse();
        }
        is_first = ring.is_empty();
        ring.extend(points);
    }
    rings.push(ring);
    rings
}

//! Finds closed outlines that must not be filled, because the fill would hide what is drawn inside
//! them: lines, text and filled areas, as in the outline of a building around its rooms.
//!
//! Each region of the outlines is examined on its own. A line hides in a region if some part of it
//! lies in the region, farther from the boundary than its own half width. An area hides in a region
//! if it covers the region in part, or covers one of the region's holes. An area that covers the
//! region as a whole, such as the hatch of an outline, is hidden if its paint is another one.

use super::sheet::{OutlineRing, OutlinedArea};
use super::style::ResolvedStyle;
use crate::design::svg::{WindingRings, boolean};
use crate::geometry::{Bounds, DVec2, EdgeBvh, Region, Regions, distance_squared_to_segment};
use i_overlay::core::fill_rule::FillRule as OverlayFill;
use i_overlay::core::overlay_rule::OverlayRule;
use i_overlay::float::clip::FloatClip;
use i_overlay::string::clip::ClipRule;
use std::collections::BTreeMap;

/// Line that an outline may hide.
pub(super) struct InnerLine<'a> {
    pub points: &'a [DVec2],
    pub width: f64,
}

/// Things that an outline may hide.
pub(super) struct InnerContent<'a> {
    pub lines: Vec<InnerLine<'a>>,
    pub areas: &'a [OutlinedArea],
    /// Styles of the drawing.
    pub styles: &'a [ResolvedStyle],
    /// Maximum deviation of flattened curves.
    pub tolerance: f64,
    /// Maximum distance of a cleaned outline from the original one.
    pub rounding: f64,
}

/// Maximum number of edges that are visited to find the regions of lines (resource limit: about a
/// second).
const MAX_EDGE_VISITS: usize = 300_000_000;

impl InnerContent<'_> {
    /// Returns for each of `rings` whether it bounds one of the `regions` that would hide
    /// something.
    pub fn hidden_by(&self, regions: &Regions, rings: &[OutlineRing]) -> Vec<bool> {
        let pieces: Vec<(&Region, Bounds)> = regions
            .iter()
            .map(|piece| (piece, piece.outer.bounds()))
            .collect();
        let mut hides = vec![false; pieces.len()];
        self.find_lines(regions, &pieces, &mut hides);
        let covering = self.find_areas(&pieces, &mut hides);
        let mut is_hiding = vec![false; rings.len()];
        for (((piece, bounds), hides), covering) in pieces.iter().zip(&hides).zip(&covering) {
            if !hides && covering.is_empty() {
                continue;
            }
            let paint = |style: usize| self.styles[style].paint;
            let boundary: Vec<EdgeBvh> = piece
                .rings()
                .map(|ring| EdgeBvh::of(ring.points()))
                .collect();
            for (ring, is_hiding) in rings.iter().zip(&mut is_hiding) {
                let differs = |&style: &usize| paint(style) != paint(ring.style);
                let may_hide = *hides || covering.iter().any(differs);
                *is_hiding |= may_hide && self.bounds_piece(ring, &boundary, bounds);
            }
        }
        is_hiding
    }

    /// Returns whether an edge of a ring lies on the boundary of a region.
    fn bounds_piece(&self, ring: &OutlineRing, boundary: &[EdgeBvh], bounds: &Bounds) -> bool {
        let reach = bounds.padded(self.rounding);
        let ends = ring.points.iter().zip(ring.points.iter().cycle().skip(1));
        ends.map(|(&a, &b)| a.midpoint(b)).any(|middle| {
            let place = Bounds {
                min: middle,
                max: middle,
            };
            let place = place.padded(self.rounding);
            let limit = self.rounding * self.rounding;
            let is_near = |[a, b]: [DVec2; 2]| distance_squared_to_segment(middle, a, b) <= limit;
            reach.contains(middle)
                && boundary
                    .iter()
                    .any(|edges| edges.any_edge_near(&place, &is_near))
        })
    }

    /// Marks the pieces in which a line runs.
    fn find_lines(&self, regions: &Regions, pieces: &[(&Region, Bounds)], hides: &mut [bool]) {
        let origin = regions.bounds().centre(); // the grid of the library is finest around zero
        let local = |points: &[DVec2]| -> Vec<[f64; 2]> {
            points.iter().map(|&p| (p - origin).to_array()).collect()
        };
        let outlines: Vec<Vec<[f64; 2]>> =
            regions.rings().map(|ring| local(ring.points())).collect();
        let rule = ClipRule {
            invert: false,
            boundary_included: false,
        };
        let mut by_width: BTreeMap<u64, Vec<Vec<[f64; 2]>>> = BTreeMap::new();
        for line in &self.lines {
            let lines = by_width.entry(line.width.to_bits()).or_default();
            lines.push(local(line.points));
        }
        let mut visits = 0;
        for (width, lines) in by_width {
            let half_width = 0.5 * f64::from_bits(width);
            for part in lines.clip_by_as::<i64>(&outlines, OverlayFill::NonZero, rule) {
                let part: Vec<DVec2> = part.into_iter().map(|p| DVec2::from(p) + origin).collect();
                let middle = middle_of(&part);
                for ((piece, bounds), hides) in pieces.iter().zip(hides.iter_mut()) {
                    visits += 1;
                    if *hides || !bounds.contains(middle) || visits > MAX_EDGE_VISITS {
                        continue;
                    }
                    visits += piece.rings().map(|ring| ring.points().len()).sum::<usize>();
                    let depth = piece.rings().map(|ring| ring.distance_squared(middle));
                    let depth = depth.fold(f64::INFINITY, f64::min).sqrt();
                    *hides = piece.contains(middle) && depth > half_width;
                }
            }
        }
    }

    /// Marks the pieces that areas cover in part, and those of which areas cover a hole. Returns
    /// for each of the other pieces the styles of the areas that cover it.
    fn find_areas(&self, pieces: &[(&Region, Bounds)], hides: &mut [bool]) -> Vec<Vec<usize>> {
        let areas: Vec<(&OutlinedArea, Bounds)> = (self.areas.iter())
            .filter_map(|area| Some((area, Bounds::of(area.rings.iter().flatten().copied())?)))
            .collect();
        let mut covering = vec![Vec::new(); pieces.len()];
        let found = pieces.iter().zip(hides).zip(&mut covering);
        for (((piece, bounds), hides), covering) in found {
            if *hides {
                continue;
            }
            let near = areas.iter().filter(|(_, area)| area.meets(bounds));
            let near: Vec<&OutlinedArea> = near.map(|(area, _)| *area).collect();
            if near.is_empty() {
                continue;
            }
            let all: WindingRings = near.iter().flat_map(|area| area.rings.clone()).collect();
            let covered = |rings: &WindingRings, by: &WindingRings| {
                area_of(&boolean(rings, by, OverlayRule::Intersect))
            };
            let whole: WindingRings = piece.rings().map(|ring| ring.points().to_vec()).collect();
            // Curves of the area and of the outline may be flattened differently.
            let slack = |perimeter: f64| 2.0 * self.tolerance * perimeter;
            let margin = slack(piece.rings().map(|ring| ring.perimeter()).sum());
            let inside = covered(&whole, &all);
            let covers_hole = || {
                piece.holes.iter().any(|hole| {
                    let hole = hole.clone().reversed();
                    let area = covered(&vec![hole.points().to_vec()], &all);
                    area > hole.signed_area() - slack(hole.perimeter())
                })
            };
            *hides = inside > margin && inside < piece.area() - margin || covers_hole();
            if !*hides && inside > margin {
                let covers = |area: &&&OutlinedArea| {
                    near.len() == 1 || covered(&whole, &area.rings) > margin
                };
                covering.extend(near.iter().filter(covers).map(|area| area.style));
            }
        }
        covering
    }
}

/// Returns the point halfway along a polyline.
fn middle_of(points: &[DVec2]) -> DVec2 {
    let steps = || points.windows(2).map(|step| step[0].distance(step[1]));
    let mut rest = 0.5 * steps().sum::<f64>();
    for (step, length) in points.windows(2).zip(steps()) {
        if rest <= length && length > 0.0 {
            return step[0].lerp(step[1], rest / length);
        }
        rest -= length;
    }
    points.last().copied().unwrap_or_default()
}

/// Returns the area of disjoint polygons with holes that run the other way.
pub(super) fn area_of(rings: &WindingRings) -> f64 {
    rings
        .iter()
        .map(|ring| crate::geometry::signed_area(ring))
        .sum::<f64>()
        .abs()
}

//! Which part and which ring of it a point of a design belongs to.

use super::super::{MatchSettings, PointPair};
use super::region_match::RegionMatchError;
use crate::geometry::{DVec2, Regions};

/// A ring of a design: the part, and 0 for its outer ring or 1 + k for hole k.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct RingIndex {
    pub(super) part: usize,
    pub(super) ring: usize,
}

/// A pin with the rings it lies on, source first.
#[derive(Clone, Copy, Debug)]
pub(super) struct LocatedPin {
    /// Its number among all pins.
    pub(super) index: usize,
    pub(super) on: [RingIndex; 2],
    pub(super) points: [DVec2; 2],
}

/// Everything that was said is finite.
pub(super) fn check(wanted: &MatchSettings) -> Result<(), RegionMatchError> {
    let pairs = wanted.pins.iter().chain(&wanted.links);
    let cuts = wanted.cuts.iter().map(|cut| [cut.outer, cut.hole]);
    let lone = wanted.lone.iter().map(|part| [part.at; 2]);
    let points = pairs.map(|pair| pair.to_array()).chain(cuts).chain(lone);
    for (k, pair) in points.enumerate() {
        if !pair.iter().all(|p| p.is_finite()) {
            return Err(RegionMatchError::NotFinite(k));
        }
    }
    Ok(())
}

/// Each pin with the rings nearest to its ends.
pub(super) fn pins(wanted: &MatchSettings, designs: [&Regions; 2]) -> Vec<LocatedPin> {
    let located = |(index, pair): (usize, &PointPair)| {
        let points = pair.to_array();
        let on = [0, 1].map(|s| nearest_ring(designs[s], points[s]));
        LocatedPin { index, on, points }
    };
    wanted.pins.iter().enumerate().map(located).collect()
}

/// The ring that runs nearest to a point.
pub(super) fn nearest_ring(design: &Regions, p: DVec2) -> RingIndex {
    let mut best = (f64::INFINITY, RingIndex { part: 0, ring: 0 });
    for (part, region) in design.iter().enumerate() {
        for (ring, outline) in region.rings().enumerate() {
            let distance = outline.distance_squared(p);
            if distance < best.0 {
                best = (distance, RingIndex { part, ring });
            }
        }
    }
    best.1
}

/// The part that a point lies in, the uppermost of several; else the nearest.
pub(super) fn part_at(design: &Regions, p: DVec2) -> usize {
    // A link is clicked into a part, and in its hole it lies in none.
    let containing = design
        .iter()
        .enumerate()
        .filter(|(_, region)| region.contains(p));
    let inside = containing.last().map(|(part, _)| part);
    inside.unwrap_or_else(|| nearest_ring(design, p).part)
}

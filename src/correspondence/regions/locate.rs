//! Finds the part, and the ring of that part, to which a point of a design belongs.

use super::super::{MatchSettings, PointPair};
use super::region_match::RegionMatchError;
use crate::geometry::{DVec2, Regions};

/// Indices that identify a ring of a design.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct RingIndex {
    /// Index of the part.
    pub(super) part: usize,
    /// 0 for the part's outer ring, 1 + k for its hole k.
    pub(super) ring: usize,
}

/// A pin with its two points and the rings on which they lie, source first.
#[derive(Clone, Copy, Debug)]
pub(super) struct LocatedPin {
    /// Index of the pin in the settings.
    pub(super) index: usize,
    pub(super) on: [RingIndex; 2],
    pub(super) points: [DVec2; 2],
}

/// Checks that all coordinates of pins, links, cuts and unmatched parts are finite.
///
/// # Errors
/// [`RegionMatchError::NotFinite`] with an index that counts pins, links, cuts and unmatched parts,
/// in this order.
pub(super) fn check_places(settings: &MatchSettings) -> Result<(), RegionMatchError> {
    let pairs = settings.pins.iter().chain(&settings.links);
    let cuts = settings.cuts.iter().map(|cut| [cut.outer, cut.hole]);
    let unmatched = settings.lone.iter().map(|part| [part.at; 2]);
    let points = pairs
        .map(|pair| pair.to_array())
        .chain(cuts)
        .chain(unmatched);
    for (k, pair) in points.enumerate() {
        if !pair.iter().all(|p| p.is_finite()) {
            return Err(RegionMatchError::NotFinite(k));
        }
    }
    Ok(())
}

/// Returns each pin with the rings that are nearest to its two points.
pub(super) fn locate_pins(settings: &MatchSettings, designs: [&Regions; 2]) -> Vec<LocatedPin> {
    let located = |(index, pair): (usize, &PointPair)| {
        let points = pair.to_array();
        let on = [0, 1].map(|s| nearest_ring(designs[s], points[s]));
        LocatedPin { index, on, points }
    };
    settings.pins.iter().enumerate().map(located).collect()
}

/// Returns the ring nearest to a point; ties go to the first.
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

/// Returns the part that contains a point. If several do, returns the topmost, which is the last;
/// if none does, the nearest.
pub(super) fn part_at(design: &Regions, p: DVec2) -> usize {
    // Containment comes first: a click inside a part may be nearer to another part's boundary.
    let containing = design
        .iter()
        .enumerate()
        .filter(|(_, region)| region.contains(p));
    let inside = containing.last().map(|(part, _)| part);
    inside.unwrap_or_else(|| nearest_ring(design, p).part)
}

//! Recognises slivers: thin contours that the cleaning of outlines leaves where edges nearly
//! coincide.

use super::{Bounds, DVec2, Ring, signed_area};

/// Maximum mean thickness of a sliver, as a fraction of the longer side of all outlines' bounding
/// box: a tenth of a pixel in an image 1,000 pixels wide (heuristic).
const MAX_THICKNESS: f64 = 1e-4;

/// Maximum area of a sliver, as a fraction of the area of each drawn outline near it. Contours that
/// remain where drawn hairlines cross are larger, so they are not removed (heuristic).
const MAX_AREA_SHARE: f64 = 0.01;

/// Recognises slivers among cleaned contours by comparing them with the outlines as drawn.
pub(super) struct SliverTest {
    /// Bounds and area of each drawn outline whose area exceeds the limit given to [`Self::of`].
    outlines: Vec<(Bounds, f64)>,
    /// Maximum mean thickness of a sliver, in the units of the outlines.
    max_thickness: f64,
}

impl SliverTest {
    /// Collects the drawn outlines with more than the given area. `extent` is the longer side of
    /// all outlines' bounding box.
    pub(super) fn of(rings: &[Vec<DVec2>], extent: f64, area: f64) -> Self {
        let outlines = rings.iter().filter_map(|ring| {
            let ring_area = signed_area(ring).abs();
            let bounds = Bounds::of(ring.iter().copied())?;
            (ring_area > area).then_some((bounds, ring_area))
        });
        Self {
            outlines: outlines.collect(),
            max_thickness: MAX_THICKNESS * extent,
        }
    }

    /// Returns whether a cleaned contour is too thin to be seen, and is a leftover of cleaning
    /// rather than a drawn shape.
    pub(super) fn is_sliver(&self, contour: &Ring) -> bool {
        let area = contour.signed_area().abs();
        // Twice the area over the perimeter is the mean thickness of a long shape.
        if 2.0 * area >= self.max_thickness * contour.perimeter() {
            return false;
        }
        let bounds = contour.bounds().padded(self.max_thickness);
        // A leftover is tiny in comparison with every drawn outline near it.
        let mut near = self.outlines.iter().filter(|(own, _)| own.meets(&bounds));
        near.all(|(_, drawn)| area < MAX_AREA_SHARE * drawn)
    }
}

#[cfg(test)]
mod tests {
    use crate::geometry::{DVec2, FillRule, Regions};

    fn ring(points: &[[f64; 2]]) -> Vec<DVec2> {
        points.iter().copied().map(DVec2::from).collect()
    }

    fn rect(x: [f64; 2], y: [f64; 2]) -> Vec<DVec2> {
        ring(&[[x[0], y[0]], [x[1], y[0]], [x[1], y[1]], [x[0], y[1]]])
    }

    #[test]
    fn a_sliver_left_by_rounding_is_removed() {
        // The last point is too low by 0.001, so the last edge crosses the first one.
        let slip = ring(&[
            [0.0, 0.0],
            [24.0, 0.0],
            [24.0, 10.0],
            [0.0, 10.0],
            [0.5, -0.001],
        ]);
        let (regions, repairs) =
            Regions::from_rings_reporting(&[slip], FillRule::NonZero).expect("a rectangle");
        assert_eq!((regions.len(), repairs.slivers), (1, 1), "{repairs:?}");
    }

    #[test]
    fn a_seam_between_parts_that_should_touch_is_closed() {
        let seam = [
            rect([0.0, 10.0], [0.0, 10.0]),
            rect([9.9, 20.0], [0.0, 4.9997]),
            rect([9.9, 20.0], [5.0, 10.0]),
            rect([19.9, 30.0], [0.0, 10.0]),
        ];
        let regions = Regions::from_rings(&seam, FillRule::NonZero).expect("regions");
        assert_eq!(regions.rings().count(), 1);
    }

    #[test]
    fn drawn_hairlines_and_dots_stay() {
        let (hair, dot) = ([5.0, 5.0002], [2.0, 2.0001]);
        let drawn = [
            rect([0.0, 10.0], hair),
            rect(hair, [0.0, 10.0]),
            rect(dot, dot),
            rect([20.0, 30.0], [0.0, 10.0]),
        ];
        let regions = Regions::from_rings(&drawn, FillRule::NonZero).expect("regions");
        assert_eq!(regions.len(), 3);
    }
}

//! What cleaning leaves over where edges all but lie on each other.

use super::{Bounds, DVec2, Ring, signed_area};

/// A mean thickness, as a share of the size of all outlines: a tenth of a pixel in a
/// picture of a thousand. Of 120 icons 15 had thinner ones, each of which would be a
/// part of its own that is born or dies.
const THIN: f64 = 1e-4;

/// A sliver is so small beside all that was drawn there; a drawing of hairlines that
/// cross is not.
const SMALL: f64 = 0.01;

/// What was drawn, to tell a sliver by.
pub(super) struct SliverTest {
    outlines: Vec<(Bounds, f64)>,
    thin: f64,
}

impl SliverTest {
    /// Outlines with more than this area.
    pub(super) fn of(rings: &[Vec<DVec2>], extent: f64, area: f64) -> Self {
        let outlines = rings.iter().filter_map(|ring| {
            let own = signed_area(ring).abs();
            let bounds = Bounds::of(ring.iter().copied())?;
            (own > area).then_some((bounds, own))
        });
        Self {
            outlines: outlines.collect(),
            thin: THIN * extent,
        }
    }

    /// Whether a contour is too thin to be seen, and is left over rather than drawn.
    pub(super) fn leaves(&self, contour: &Ring) -> bool {
        let area = contour.signed_area().abs();
        if 2.0 * area >= self.thin * contour.perimeter() {
            return false;
        }
        let bounds = contour.bounds().padded(self.thin);
        let mut there = self.outlines.iter().filter(|(own, _)| own.meets(&bounds));
        there.all(|(_, drawn)| area < SMALL * drawn)
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
    fn what_rounding_leaves_beside_a_side_is_left_out() {
        // The last side ends a thousandth too low, and crosses the first.
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
    fn hairlines_and_dots_that_were_drawn_stay() {
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

//! Insets a region: moves its boundary inwards by a given depth.

use super::{DVec2, signed_area};
use i_overlay::mesh::float::outline::offset::OutlineOffset;
use i_overlay::mesh::float::style::{LineJoin, OutlineStyle};

/// Minimum angle, in radians, of a corner whose tip stays pointed. The tip of a sharper corner is
/// cut off; such corners occur only where a region is about to vanish (heuristic).
const MIN_TIP_ANGLE: f64 = 0.2;

/// Number of bisections in the search for the inradius (derived: they narrow the range of the
/// search to 2⁻¹⁰ of its length, about a thousandth).
const BISECTIONS: u32 = 10;

/// Returns the rings that bound all points of a region farther than `depth` from its boundary;
/// holes run in the opposite direction to outer rings. Corners stay sharp, except those with an
/// angle below [`MIN_TIP_ANGLE`].
pub(crate) fn inset(rings: &[Vec<DVec2>], depth: f64) -> Vec<Vec<DVec2>> {
    let contours: Vec<Vec<[f64; 2]>> = rings
        .iter()
        .map(|ring| ring.iter().map(|p| p.to_array()).collect())
        .collect();
    let style = OutlineStyle::new(-depth).line_join(LineJoin::Miter(MIN_TIP_ANGLE));
    let shapes = contours.outline_as::<i64>(&style);
    let remaining = shapes.into_iter().flatten();
    remaining
        .map(|ring| ring.into_iter().map(DVec2::from).collect())
        .collect()
}

/// Returns the smallest depth at which [`inset`] leaves nothing: the radius of the largest disc in
/// the region. The result may be too large by up to a thousandth of r, the radius of a disc with
/// the same area as the region.
pub(crate) fn inradius(rings: &[Vec<DVec2>]) -> f64 {
    let area: f64 = rings.iter().map(|ring| signed_area(ring)).sum();
    // No disc in the region has more area than the region.
    let (mut inside, mut beyond) = (0.0, (area.max(0.0) / std::f64::consts::PI).sqrt());
    for _ in 0..BISECTIONS {
        let depth = 0.5 * (inside + beyond);
        *(if inset(rings, depth).is_empty() {
            &mut beyond
        } else {
            &mut inside
        }) = depth;
    }
    beyond
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square(r: f64) -> Vec<DVec2> {
        [(-r, -r), (r, -r), (r, r), (-r, r)]
            .map(DVec2::from)
            .to_vec()
    }

    fn area(rings: &[Vec<DVec2>]) -> f64 {
        rings.iter().map(|ring| signed_area(ring)).sum()
    }

    #[test]
    fn a_frame_grows_thin_from_both_sides() {
        let hole: Vec<DVec2> = square(1.0).into_iter().rev().collect();
        let frame = [square(3.0), hole];
        let thin = inset(&frame, 0.5);
        assert_eq!(thin.len(), 2);
        assert!((area(&thin) - (25.0 - 9.0)).abs() < 1e-6, "{thin:?}");
        assert!((inradius(&frame) - 1.0).abs() < 2e-3);
        assert!(inset(&frame, 1.01).is_empty());
    }

    #[test]
    fn corners_stay_sharp_and_empty_regions_stay_empty() {
        let remaining = inset(&[square(2.0)], 0.25);
        assert!((area(&remaining) - 3.5 * 3.5).abs() < 1e-6);
        assert!(inset(&[], 1.0).is_empty());
        assert_eq!(inradius(&[]), 0.0);
        assert!(inset(&[vec![DVec2::ONE; 3]], 1.0).is_empty());
    }
}

//! Measures by how much a face exceeds the distortion bound, and computes the change of its local
//! map that restores the bound.
//!
//! The bound of a sheet is the largest distortion of its faces from source to target. At other
//! times a face can exceed the bound, because a face that is flattened conformally is distorted
//! slightly more than its metric, and because the local maps around a hole do not quite fit
//! together. If the distortion of a face relative to either design exceeds the bound, its local map
//! is replaced by the nearest map within the bound. The vertex positions are then computed again
//! from all local maps. This is repeated several times: alternating projections (Kovalsky,
//! Aigerman, Basri, Lipman, "Large-scale bounded distortion mappings", 2015, here with the factored
//! matrix of the energy). Faces within the bound are unchanged. The bound is soft: it is exceeded
//! smoothly, by at most [`SOFT`], so that the motion has no kinks.

use super::layout::BoundedFace;
use crate::geometry::DMat2;

/// Maximum relative excess over the distortion bound (heuristic: invisible, and smooth enough to be
/// recorded).
const SOFT: f64 = 0.01;

/// Relative excess that is ignored (tolerance: rounding).
const NONE: f64 = 1e-12;

/// A linear map, split into a similarity (rotation and scaling) and an anti-similarity (with
/// reflection).
#[derive(Clone, Copy)]
struct Halves {
    turning: DMat2,
    flipping: DMat2,
    /// Norms of `turning` and `flipping`: half the sum and half the difference of the singular
    /// values.
    sizes: [f64; 2],
}

impl Halves {
    fn of(m: DMat2) -> Self {
        let (a, b, c, d) = (m.x_axis.x, m.y_axis.x, m.x_axis.y, m.y_axis.y);
        let (p, q) = (0.5 * (a + d), 0.5 * (c - b));
        let turning = DMat2::from_cols_array(&[p, q, -q, p]);
        Self {
            turning,
            flipping: m - turning,
            sizes: [p.hypot(q), 0.5 * (a - d).hypot(c + b)],
        }
    }

    /// Returns the ratio of the singular values; infinite if the linear map turns faces over.
    fn sheared(self) -> f64 {
        let [turning, flipping] = self.sizes;
        match turning - flipping {
            small if small > 0.0 => (turning + flipping) / small,
            _ => f64::INFINITY,
        }
    }
}

/// Returns the distortion of a linear map: the ratio of its singular values.
pub(super) fn sheared(map: DMat2) -> f64 {
    Halves::of(map).sheared()
}

/// Returns the change that brings a linear map whose distortion exceeds `most` back to this bound;
/// `None` if the distortion does not exceed `most`.
fn back(map: DMat2, most: f64) -> Option<DMat2> {
    let halves = Halves::of(map);
    let beyond = halves.sheared() / most - 1.0;
    let [turning, flipping] = halves.sizes;
    if beyond.is_nan() || beyond <= NONE || turning <= 0.0 {
        return None;
    }
    let soft = (beyond.powi(-2) + SOFT.powi(-2)).sqrt().recip();
    let ratio = most * (1.0 + soft);
    // The singular values with this ratio that are nearest to those of the map.
    let (large, small) = (turning + flipping, turning - flipping);
    let small = (ratio * large + small) / (ratio * ratio + 1.0);
    let large = ratio * small;
    let by = [
        (large + small) / (2.0 * turning) - 1.0,
        (large - small) / (2.0 * flipping) - 1.0,
    ];
    Some(halves.turning * by[0] + halves.flipping * by[1])
}

/// Returns the change that brings the local map of a face back to the distortion bound `most`;
/// `None` if the face satisfies the bound. The distortion is measured relative to the source and
/// relative to the target. If both exceed the bound, the result is the mean of the two changes.
pub(super) fn taken_back(face: &BoundedFace, map: DMat2, most: f64) -> Option<DMat2> {
    let from_source = back(map, most);
    let from_target = back(map * face.back, most).map(|by| by * face.map.matrix());
    match (from_source, from_target) {
        (Some(a), Some(b)) => Some((a + b) * 0.5),
        (a, b) => a.or(b),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::DVec2;

    #[test]
    fn a_map_is_put_back_to_the_bound() {
        let turned = DMat2::from_angle(0.7);
        let of = |large: f64, small: f64| turned * DMat2::from_diagonal(DVec2::new(large, small));
        assert!(back(of(3.0, 1.0), 3.0).is_none());
        assert!((sheared(of(3.0, 1.0)) - 3.0).abs() < 1e-12);
        for worse in [of(9.0, 1.0), of(3.0, 1e-9), of(3.0, -0.5)] {
            let by = back(worse, 3.0).expect("beyond");
            let found = sheared(worse + by);
            assert!(
                (3.0..=3.0 * (1.0 + SOFT) + 1e-9).contains(&found),
                "{found}"
            );
        }
        // A tiny excess is left almost unchanged.
        let by = back(of(3.0 + 1e-6, 1.0), 3.0).expect("beyond");
        assert!(by.x_axis.length() < 1e-13, "{by}");
    }
}

//! What of a face is sheared more than at the worse end, and how it is taken back.
//!
//! A face of discrete conformal maps is sheared a little more than its metric, and
//! around a hole maps do not quite close. So where a face of the film is sheared
//! more than the worst of its sheet at the end, seen from either design, its map is put
//! back to the nearest one that is not, and all are integrated anew, some rounds:
//! alternating projections (Kovalsky, Aigerman, Basri, Lipman, "Large-scale bounded
//! distortion mappings", 2015, with the matrix that there is). Faces within the
//! bound are not touched, and the bound is gone beyond smoothly, by no more than
//! [`SOFT`], so that the film has no kinks.

use super::layout::BoundedFace;
use crate::geometry::DMat2;

/// How far the bound may be gone beyond, as a share of it. A hundredth is not seen,
/// and soft enough to be recorded.
const SOFT: f64 = 0.01;

/// What is rounding.
const NONE: f64 = 1e-12;

/// A map as its part that turns and scales, and the part that is left.
#[derive(Clone, Copy)]
struct Halves {
    turning: DMat2,
    flipping: DMat2,
    /// Their sizes: half the sum and half the difference of the singular values.
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

    /// The ratio of the singular values; infinite of what is turned over.
    fn sheared(self) -> f64 {
        let [turning, flipping] = self.sizes;
        match turning - flipping {
            small if small > 0.0 => (turning + flipping) / small,
            _ => f64::INFINITY,
        }
    }
}

/// How much a map is sheared.
pub(super) fn sheared(map: DMat2) -> f64 {
    Halves::of(map).sheared()
}

/// What has to be added to a map that is sheared more than `most`.
fn back(map: DMat2, most: f64) -> Option<DMat2> {
    let halves = Halves::of(map);
    let beyond = halves.sheared() / most - 1.0;
    let [turning, flipping] = halves.sizes;
    if beyond.is_nan() || beyond <= NONE || turning <= 0.0 {
        return None;
    }
    let soft = (beyond.powi(-2) + SOFT.powi(-2)).sqrt().recip();
    let ratio = most * (1.0 + soft);
    // The nearest singular values with this ratio.
    let (large, small) = (turning + flipping, turning - flipping);
    let small = (ratio * large + small) / (ratio * ratio + 1.0);
    let large = ratio * small;
    let by = [
        (large + small) / (2.0 * turning) - 1.0,
        (large - small) / (2.0 * flipping) - 1.0,
    ];
    Some(halves.turning * by[0] + halves.flipping * by[1])
}

/// What has to be added to the map of a face, seen from both designs.
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
        // Hardly beyond: all of it is left.
        let by = back(of(3.0 + 1e-6, 1.0), 3.0).expect("beyond");
        assert!(by.x_axis.length() < 1e-13, "{by}");
    }
}

//! Paths of the centroids of a design's parts.
//!
//! The design's centroid moves on a straight line C(t), and the design rotates by tΘ about it. The
//! centroid of part k follows c_k(t) = C(t) + R(tΘ) ((1−t) d_k + t R(−Θ) e_k), where R(α) is the
//! rotation by α, and d_k and e_k are the offsets of the part's centroid from the design's centroid
//! in source and target. If each part moved on its own straight line instead, two parts of a design
//! rotated by π would collide halfway.

use crate::geometry::{DMat2, DVec2};

/// Path of a part's centroid relative to the design's centroid.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct PartPath {
    /// Offset of the part's centroid from the design's centroid in the source.
    begin: DVec2,
    /// Offset of the part's centroid from the design's centroid in the target, rotated back by the
    /// design's rotation.
    turned_end: DVec2,
}

impl PartPath {
    /// Returns the paths of parts with the given centroids `[source, target]` and masses, in a
    /// design that rotates by `whole_angle` radians.
    pub(super) fn all(centres: &[[DVec2; 2]], mass: &[f64], whole_angle: f64) -> Vec<Self> {
        if let [_] = centres {
            // A single part has exactly zero offset; computing it would leave rounding.
            return vec![Self::default()];
        }
        let whole = centroid(centres.iter().copied(), mass);
        let path = |ends: &[DVec2; 2]| Self::of(*ends, whole, whole_angle);
        centres.iter().map(path).collect()
    }

    /// Returns the path of a part whose centroid is at `begin` in the source and at `end` in the
    /// target. The whole design has its centroid at `from` in the source and at `to` in the target.
    pub(super) fn of([begin, end]: [DVec2; 2], [from, to]: [DVec2; 2], whole_angle: f64) -> Self {
        Self {
            begin: begin - from,
            turned_end: DMat2::from_angle(-whole_angle) * (end - to),
        }
    }

    /// Returns the offset of the part's centroid from the design's centroid at t.
    pub(super) fn offset(&self, t: f64, whole_angle: f64) -> DVec2 {
        self.offset_at_fraction(t, t, whole_angle)
    }

    /// Returns the offset of the part's centroid from the design's centroid at t.
    ///
    /// `share`, from 0 to 1, is the completed fraction of the part's motion relative to the design;
    /// the rotation with the design always follows t.
    pub(super) fn offset_at_fraction(&self, t: f64, share: f64, whole_angle: f64) -> DVec2 {
        let unrotated = self.begin * (1.0 - share) + self.turned_end * share;
        DMat2::from_angle(t * whole_angle) * unrotated
    }

    /// Returns the deviation of the offset at t from the straight line between its values at t = 0
    /// and t = 1; exactly 0 at these two times.
    pub(super) fn deviation(&self, t: f64, whole_angle: f64) -> DVec2 {
        let straight = self.begin * (1.0 - t) + self.offset(1.0, whole_angle) * t;
        self.offset(t, whole_angle) - straight
    }
}

/// Returns two centres of mass: that of the source points and that of the target points of
/// `points`.
pub(super) fn centroid(
    points: impl Iterator<Item = [DVec2; 2]> + Clone,
    mass: &[f64],
) -> [DVec2; 2] {
    let total: f64 = mass.iter().sum();
    [0, 1].map(|side| {
        let weighted = points.clone().zip(mass);
        weighted.map(|(p, &m)| p[side] * (m / total)).sum()
    })
}

/// Returns the best-fit rotation of weighted point pairs about their centroids.
///
/// The fit is least squares (Procrustes); the angle is in radians, in [−π, π].
pub(super) fn rotation(
    points: impl Iterator<Item = ([DVec2; 2], f64)>,
    [from, to]: [DVec2; 2],
) -> f64 {
    let (mut sin, mut cos) = (0.0, 0.0);
    for ([p, q], m) in points {
        sin += m * (p - from).perp_dot(q - to);
        cos += m * (p - from).dot(q - to);
    }
    sin.atan2(cos)
}

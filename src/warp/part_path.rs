//! Where the parts of a design are as wholes.
//!
//! The design's centroid runs on a straight line C(t), and each part k moves
//! with the whole, c_k(t) = C(t) + R(tΘ) ((1−t) d_k + t R(−Θ) e_k), with d_k
//! and e_k its offsets in source and target. (On straight lines of their own,
//! two parts of a design turned by π would meet.)

use crate::geometry::{DMat2, DVec2};

/// The path of a part's centroid about that of the whole.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct PartPath {
    /// d, the offset from the whole's centroid in the source.
    begin: DVec2,
    /// R(−Θ) e, the offset in the target turned back.
    turned_end: DVec2,
}

impl PartPath {
    /// Paths of parts with the given centroids, `[source, target]`, and
    /// masses in a whole that turns by `whole_angle`.
    pub(super) fn all(centres: &[[DVec2; 2]], mass: &[f64], whole_angle: f64) -> Vec<Self> {
        if let [_] = centres {
            return vec![Self::default()]; // the only part is the whole
        }
        let whole = centroid(centres.iter().copied(), mass);
        let path = |ends: &[DVec2; 2]| Self::of(*ends, whole, whole_angle);
        centres.iter().map(path).collect()
    }

    /// The path between two places in a whole with the given centroid.
    pub(super) fn of([begin, end]: [DVec2; 2], [from, to]: [DVec2; 2], whole_angle: f64) -> Self {
        Self {
            begin: begin - from,
            turned_end: DMat2::from_angle(-whole_angle) * (end - to),
        }
    }

    /// The offset from the whole's centroid.
    pub(super) fn at(&self, t: f64, whole_angle: f64) -> DVec2 {
        self.at_share(t, t, whole_angle)
    }

    /// The same where so much of its own way is done, from 0 to 1.
    pub(super) fn at_share(&self, t: f64, share: f64, whole_angle: f64) -> DVec2 {
        let own = self.begin * (1.0 - share) + self.turned_end * share;
        DMat2::from_angle(t * whole_angle) * own
    }

    /// How far from its straight line the part is; exactly 0 at both ends.
    pub(super) fn deviation(&self, t: f64, whole_angle: f64) -> DVec2 {
        let straight = self.begin * (1.0 - t) + self.at(1.0, whole_angle) * t;
        self.at(t, whole_angle) - straight
    }
}

/// The centroids in source and target of pairs of places with masses.
pub(super) fn centroid(
    places: impl Iterator<Item = [DVec2; 2]> + Clone,
    mass: &[f64],
) -> [DVec2; 2] {
    let total: f64 = mass.iter().sum();
    [0, 1].map(|side| {
        let weighted = places.clone().zip(mass);
        weighted.map(|(p, &m)| p[side] * (m / total)).sum()
    })
}

/// The angle of the rotation about the centroids that best takes places with
/// masses from source to target, least squares, in (−π, π].
pub(super) fn rotation(
    places: impl Iterator<Item = ([DVec2; 2], f64)>,
    [from, to]: [DVec2; 2],
) -> f64 {
    let (mut sin, mut cos) = (0.0, 0.0);
    for ([p, q], m) in places {
        sin += m * (p - from).perp_dot(q - to);
        cos += m * (p - from).dot(q - to);
    }
    sin.atan2(cos)
}

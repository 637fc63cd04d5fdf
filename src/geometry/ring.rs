//! Closed polygons: the type [`Ring`], and functions on lists of points.

use super::{Bounds, DVec2, distance_squared_to_segment};

/// Closed polygon of at least three finite points. The last point is joined to the first and does
/// not repeat it.
///
/// A ring may cross itself; the rings of [`super::Regions`] do not.
#[derive(Clone, Debug, PartialEq)]
pub struct Ring(Vec<DVec2>);

/// Reason why points form no [`Ring`].
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum RingError {
    /// Fewer than three points are left after consecutive repetitions are removed.
    #[error("a closed outline needs at least 3 different points, this one has {0}; add points")]
    TooFewPoints(usize),
    /// A coordinate of the point with this index is NaN or infinite.
    #[error("point {0} of the outline is not a finite number; correct its coordinates")]
    NotFinite(usize),
}

impl Ring {
    /// Creates a ring from points in order. Consecutive repetitions of a point are left out, and so
    /// are repetitions of the first point at the end.
    ///
    /// # Errors
    /// [`RingError`] for fewer than three different points, or for a coordinate that is not finite.
    ///
    /// ```
    /// use morphospace::geometry::{DVec2, Ring};
    /// let ring = Ring::new(vec![DVec2::ZERO, DVec2::X, DVec2::Y])?;
    /// assert_eq!(ring.signed_area(), 0.5);
    /// # Ok::<(), morphospace::geometry::RingError>(())
    /// ```
    pub fn new(mut points: Vec<DVec2>) -> Result<Self, RingError> {
        // Check this first, so that the index is that of the points as given.
        if let Some(bad) = points.iter().position(|p| !p.is_finite()) {
            return Err(RingError::NotFinite(bad));
        }
        points.dedup();
        while points.len() > 1 && points.first() == points.last() {
            points.pop();
        }
        if points.len() < 3 {
            return Err(RingError::TooFewPoints(points.len()));
        }
        Ok(Self(points))
    }

    /// Returns the points in order.
    #[must_use]
    pub fn points(&self) -> &[DVec2] {
        &self.0
    }

    /// Returns the edges in order; the one from the last point to the first comes last.
    pub fn edges(&self) -> impl Iterator<Item = (DVec2, DVec2)> + '_ {
        ring_edges(&self.0)
    }

    /// Returns the enclosed area, negative if the points run clockwise.
    #[must_use]
    pub fn signed_area(&self) -> f64 {
        signed_area(&self.0)
    }

    /// Returns the length of the closed boundary.
    #[must_use]
    pub fn perimeter(&self) -> f64 {
        perimeter(&self.0)
    }

    /// Returns the squared distance of `p` from the boundary.
    #[must_use]
    pub fn distance_squared(&self, p: DVec2) -> f64 {
        let to_edge = |(a, b)| distance_squared_to_segment(p, a, b);
        self.edges().map(to_edge).fold(f64::INFINITY, f64::min)
    }

    /// Returns the same polygon in the opposite direction.
    #[must_use]
    pub fn reversed(mut self) -> Self {
        self.0.reverse();
        self
    }

    /// Returns the smallest box around the ring.
    #[must_use]
    pub fn bounds(&self) -> Bounds {
        // A ring has at least three points.
        self.0.iter().fold(Bounds::at(self.0[0]), |b, &p| Bounds {
            min: b.min.min(p),
            max: b.max.max(p),
        })
    }

    /// Returns the winding number of the ring around `p`, counter-clockwise positive. On the
    /// boundary, the answer may be that of either side.
    #[must_use]
    pub fn winding(&self, p: DVec2) -> i32 {
        winding(&self.0, p)
    }

    /// Returns the ring with `map` applied to every point; `map` must keep coordinates finite.
    pub(crate) fn mapped(&self, map: impl Fn(DVec2) -> DVec2) -> Self {
        Self(self.0.iter().map(|&p| map(p)).collect())
    }
}

/// Returns the edges of a closed polygon in order; the one from the last corner to the first comes
/// last. Corners may be points or indices.
pub fn ring_edges<T: Copy>(points: &[T]) -> impl Iterator<Item = (T, T)> + '_ {
    let next = points.iter().skip(1).chain(points.first());
    points.iter().copied().zip(next.copied())
}

/// Returns the area that a closed polygon encloses, negative if its points run clockwise; 0 for no
/// points.
///
/// ```
/// use morphospace::geometry::{DVec2, signed_area};
/// assert_eq!(signed_area(&[DVec2::ZERO, DVec2::X, DVec2::Y]), 0.5);
/// ```
#[must_use]
pub fn signed_area(points: &[DVec2]) -> f64 {
    // Use coordinates relative to a vertex, which avoids cancellation far from the origin.
    let origin = points.first().copied().unwrap_or_default();
    let twice: f64 = ring_edges(points)
        .map(|(a, b)| (a - origin).perp_dot(b - origin))
        .sum();
    0.5 * twice
}

/// Returns the length of a closed polygon's boundary.
#[must_use]
pub fn perimeter(points: &[DVec2]) -> f64 {
    ring_edges(points).map(|(a, b)| a.distance(b)).sum()
}

/// Returns the winding number of a closed polygon around `p`, counter-clockwise positive. On the
/// boundary, the answer may be that of either side.
#[must_use]
pub fn winding(points: &[DVec2], p: DVec2) -> i32 {
    ring_edges(points).map(|edge| ray_crossing(edge, p)).sum()
}

/// Returns the contribution of an edge to the winding number around `p`: 1 if the edge crosses the
/// horizontal ray to the right of `p` upwards, -1 if downwards, otherwise 0.
pub(crate) fn ray_crossing((a, b): (DVec2, DVec2), p: DVec2) -> i32 {
    let side = (b - a).perp_dot(p - a);
    // An end at the height of `p` counts as below it. A ray through a corner therefore crosses
    // neither of the corner's edges, one of them, or both in opposite directions.
    match (a.y <= p.y, b.y <= p.y) {
        (true, false) if side > 0.0 => 1,
        (false, true) if side < 0.0 => -1,
        _ => 0,
    }
}

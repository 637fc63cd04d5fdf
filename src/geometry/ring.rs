//! Closed polygons.

use super::{Bounds, DVec2, distance_squared_to_segment};

/// A closed polygon of at least three finite points; the last point is joined
/// to the first and does not repeat it.
///
/// A ring may cross itself: [`super::Regions`] is what has been cleaned.
#[derive(Clone, Debug, PartialEq)]
pub struct Ring(Vec<DVec2>);

/// Why points do not make a [`Ring`].
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum RingError {
    /// Too few points.
    #[error("a closed outline needs at least 3 different points, this one has {0}; add points")]
    TooFewPoints(usize),
    /// A coordinate is NaN or infinite.
    #[error("point {0} of the outline is not a finite number; correct its coordinates")]
    NotFinite(usize),
}

impl Ring {
    /// Takes the points in order. Immediate repetitions, also of the first
    /// point at the end, are left out.
    ///
    /// # Errors
    /// [`RingError`] for fewer than three different points or a coordinate
    /// that is not finite.
    ///
    /// ```
    /// use morphospace::geometry::{DVec2, Ring};
    /// let ring = Ring::new(vec![DVec2::ZERO, DVec2::X, DVec2::Y])?;
    /// assert_eq!(ring.signed_area(), 0.5);
    /// # Ok::<(), morphospace::geometry::RingError>(())
    /// ```
    pub fn new(mut points: Vec<DVec2>) -> Result<Self, RingError> {
        // First: the index is that of the points as they were given.
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

    /// The points in order.
    #[must_use]
    pub fn points(&self) -> &[DVec2] {
        &self.0
    }

    /// The edges in order, the closing one last.
    pub fn edges(&self) -> impl Iterator<Item = (DVec2, DVec2)> + '_ {
        ring_edges(&self.0)
    }

    /// The enclosed area, negative when the points run clockwise.
    #[must_use]
    pub fn signed_area(&self) -> f64 {
        signed_area(&self.0)
    }

    /// Length of the closed boundary.
    #[must_use]
    pub fn perimeter(&self) -> f64 {
        perimeter(&self.0)
    }

    /// The squared distance of `p` from the boundary.
    #[must_use]
    pub fn distance_squared(&self, p: DVec2) -> f64 {
        let to_edge = |(a, b)| distance_squared_to_segment(p, a, b);
        self.edges().map(to_edge).fold(f64::INFINITY, f64::min)
    }

    /// The same polygon run the other way.
    #[must_use]
    pub fn reversed(mut self) -> Self {
        self.0.reverse();
        self
    }

    /// The smallest box around it.
    #[must_use]
    pub fn bounds(&self) -> Bounds {
        // A ring has three points at least.
        self.0.iter().fold(Bounds::at(self.0[0]), |b, &p| Bounds {
            min: b.min.min(p),
            max: b.max.max(p),
        })
    }

    /// How often the ring winds around `p`, counter-clockwise positive.
    #[must_use]
    pub fn winding(&self, p: DVec2) -> i32 {
        winding(&self.0, p)
    }

    /// Every point sent through `map`, which must keep coordinates finite.
    pub(crate) fn mapped(&self, map: impl Fn(DVec2) -> DVec2) -> Self {
        Self(self.0.iter().map(|&p| map(p)).collect())
    }
}

/// The edges of a closed polygon in order, the closing one last; its corners
/// may be points or numbers of points.
pub fn ring_edges<T: Copy>(points: &[T]) -> impl Iterator<Item = (T, T)> + '_ {
    let next = points.iter().skip(1).chain(points.first());
    points.iter().copied().zip(next.copied())
}

/// The area that a closed polygon encloses, negative when its points run
/// clockwise; 0 for no points.
///
/// ```
/// use morphospace::geometry::{DVec2, signed_area};
/// assert_eq!(signed_area(&[DVec2::ZERO, DVec2::X, DVec2::Y]), 0.5);
/// ```
#[must_use]
pub fn signed_area(points: &[DVec2]) -> f64 {
    // Relative to a vertex: no cancellation far from zero.
    let origin = points.first().copied().unwrap_or_default();
    let twice: f64 = ring_edges(points)
        .map(|(a, b)| (a - origin).perp_dot(b - origin))
        .sum();
    0.5 * twice
}

/// The length of a closed polygon's boundary.
#[must_use]
pub fn perimeter(points: &[DVec2]) -> f64 {
    ring_edges(points).map(|(a, b)| a.distance(b)).sum()
}

/// How often a closed polygon winds around `p`, counter-clockwise positive;
/// on the boundary either answer may come.
#[must_use]
pub fn winding(points: &[DVec2], p: DVec2) -> i32 {
    let crossing = |(a, b): (DVec2, DVec2)| {
        let side = (b - a).perp_dot(p - a);
        // An end as high as `p` counts as below it: a ray through a corner
        // then meets one of its edges, or both in opposite directions.
        match (a.y <= p.y, b.y <= p.y) {
            (true, false) if side > 0.0 => 1,
            (false, true) if side < 0.0 => -1,
            _ => 0,
        }
    };
    ring_edges(points).map(crossing).sum()
}

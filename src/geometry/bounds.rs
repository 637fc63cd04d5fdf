//! Axis-aligned bounding boxes.

use super::DVec2;

/// Closed axis-aligned box; `min` is at most `max` in both coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// Lower left corner.
    pub min: DVec2,
    /// Upper right corner.
    pub max: DVec2,
}

impl Bounds {
    /// Returns the smallest box around the points; `None` for no points.
    ///
    /// ```
    /// use morphospace::geometry::{Bounds, DVec2};
    /// let b = Bounds::of([DVec2::ZERO, DVec2::new(2.0, 1.0)]).expect("two points");
    /// assert_eq!(b.size(), DVec2::new(2.0, 1.0));
    /// ```
    pub fn of(points: impl IntoIterator<Item = DVec2>) -> Option<Self> {
        let mut points = points.into_iter();
        let first = points.next()?;
        Some(points.fold(Self::at(first), |b, p| Self {
            min: b.min.min(p),
            max: b.max.max(p),
        }))
    }

    /// Returns the length of the diagonal of the smallest box around the points; 0 for no points.
    #[must_use]
    pub fn diameter_of(points: &[DVec2]) -> f64 {
        Self::of(points.iter().copied()).map_or(0.0, |bounds| bounds.diameter())
    }

    /// Returns the box that contains only the point `p`.
    #[must_use]
    pub const fn at(p: DVec2) -> Self {
        Self { min: p, max: p }
    }

    /// Returns the width and the height of the box.
    #[must_use]
    pub fn size(&self) -> DVec2 {
        self.max - self.min
    }

    /// Returns the centre of the box.
    #[must_use]
    pub fn centre(&self) -> DVec2 {
        self.min.midpoint(self.max)
    }

    /// Returns the length of the box's diagonal.
    #[must_use]
    pub fn diameter(&self) -> f64 {
        self.size().length()
    }

    /// Returns the smallest box around both boxes.
    #[must_use]
    pub fn union(&self, other: &Self) -> Self {
        Self {
            min: self.min.min(other.min),
            max: self.max.max(other.max),
        }
    }

    /// Returns the box grown by `by` on every side. A negative `by` shrinks it, at most to its
    /// centre.
    #[must_use]
    pub fn padded(&self, by: f64) -> Self {
        // A width or height of less than twice the shrinkage becomes 0, never negative.
        let centre = self.centre();
        Self {
            min: (self.min - by).min(centre),
            max: (self.max + by).max(centre),
        }
    }

    /// Returns whether `p` lies in the closed box.
    #[must_use]
    pub fn contains(&self, p: DVec2) -> bool {
        p.cmpge(self.min).all() && p.cmple(self.max).all()
    }

    /// Returns whether the closed boxes have a point in common.
    #[must_use]
    pub fn meets(&self, other: &Self) -> bool {
        self.min.cmple(other.max).all() && other.min.cmple(self.max).all()
    }

    /// Returns the corners, counter-clockwise from the lower left.
    #[must_use]
    pub fn corners(&self) -> [DVec2; 4] {
        [
            self.min,
            DVec2::new(self.max.x, self.min.y),
            self.max,
            DVec2::new(self.min.x, self.max.y),
        ]
    }
}

//! Similarities: how one design is laid over another.

use super::{Bounds, DAffine2, DMat2, DVec2, DesignSizeError, RANGE_MESSAGE, is_in_range};
use serde::{Deserialize, Serialize};

/// A mirror, then a scale, then a rotation about the origin, then an offset.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields, rename_all = "kebab-case")]
pub struct Similarity {
    /// Moved by this much at the end, in the design's units.
    pub offset: DVec2,
    /// Enlarged by this factor; finite and positive.
    pub scale: f64,
    /// Turned counter-clockwise, in radians.
    pub rotation: f64,
    /// Left and right exchanged first.
    pub mirror: bool,
}

/// A similarity that would not keep shapes finite.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SimilarityError {
    /// The scale is zero, negative or not finite.
    #[error("the scale {0} is not a positive number; give one above zero")]
    Scale(f64),
    /// The offset or the rotation is not finite.
    #[error("the offset and the rotation of a placement must be finite numbers")]
    NotFinite,
    /// What it lays down is out of range.
    #[error("laid down, a corner of the design {RANGE_MESSAGE}")]
    OutOfRange,
    /// What it lays down is too small.
    #[error(transparent)]
    Size(#[from] DesignSizeError),
}

impl Default for Similarity {
    fn default() -> Self {
        Self::IDENTITY
    }
}

impl Similarity {
    /// Leaves everything where it is.
    pub const IDENTITY: Self = Self {
        offset: DVec2::ZERO,
        scale: 1.0,
        rotation: 0.0,
        mirror: false,
    };

    /// Checks that the map is finite and can be inverted.
    ///
    /// # Errors
    /// [`SimilarityError`] names the number that is wrong.
    pub fn checked(self) -> Result<Self, SimilarityError> {
        if !(self.scale.is_finite() && self.scale > 0.0) {
            return Err(SimilarityError::Scale(self.scale));
        }
        if !(self.offset.is_finite() && self.rotation.is_finite()) {
            return Err(SimilarityError::NotFinite);
        }
        Ok(self)
    }

    /// Checks that what is laid down can be reckoned with.
    ///
    /// # Errors
    /// [`SimilarityError`] says what is wrong with the size or the place.
    pub fn check_on(&self, bounds: &Bounds) -> Result<(), SimilarityError> {
        let corners = bounds.corners().map(|p| self.apply(p));
        if !corners.into_iter().all(is_in_range) {
            return Err(SimilarityError::OutOfRange);
        }
        let laid = Bounds::of(corners).unwrap_or(*bounds);
        Ok(DesignSizeError::check(&laid).map(drop)?)
    }

    /// The linear part; its determinant is negative when mirrored.
    #[must_use]
    pub fn linear(&self) -> DMat2 {
        DMat2::from_angle(self.rotation)
            * DMat2::from_diagonal(DVec2::new(self.flip() * self.scale, self.scale))
    }

    /// The same as an affine map.
    #[must_use]
    pub fn affine(&self) -> DAffine2 {
        DAffine2::from_mat2_translation(self.linear(), self.offset)
    }

    /// The sign that x gets, and that a turn gets which is moved past the mirror.
    fn flip(&self) -> f64 {
        if self.mirror { -1.0 } else { 1.0 }
    }

    /// Where `p` goes.
    ///
    /// ```
    /// use morphospace::geometry::{DVec2, Similarity};
    /// let s = Similarity { scale: 2.0, offset: DVec2::X, ..Similarity::IDENTITY };
    /// assert_eq!(s.apply(DVec2::new(1.0, 1.0)), DVec2::new(3.0, 2.0));
    /// ```
    #[must_use]
    pub fn apply(&self, p: DVec2) -> DVec2 {
        if *self == Self::IDENTITY {
            return p; // exact, so that designs as drawn keep their last bit
        }
        self.linear() * p + self.offset
    }

    /// This similarity after another, as one.
    #[must_use]
    pub fn after(&self, first: &Self) -> Self {
        Self {
            offset: self.apply(first.offset),
            scale: self.scale * first.scale,
            rotation: self.rotation + self.flip() * first.rotation,
            mirror: self.mirror != first.mirror,
        }
    }

    /// The way back.
    #[must_use]
    pub fn inverse(&self) -> Self {
        let linear = Self {
            offset: DVec2::ZERO,
            scale: 1.0 / self.scale,
            rotation: -self.flip() * self.rotation,
            mirror: self.mirror,
        };
        Self {
            // The offset was last, so it is undone first.
            offset: -linear.apply(self.offset),
            ..linear
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_after_another_and_back() {
        let similarity = |mirror, rotation| Similarity {
            offset: DVec2::new(3.0, -1.0),
            scale: 2.5,
            rotation,
            mirror,
        };
        let p = DVec2::new(0.7, 1.9);
        for (m, n) in [(false, false), (false, true), (true, false), (true, true)] {
            let (a, b) = (similarity(m, 0.4), similarity(n, -1.1));
            assert!((b.after(&a).apply(p) - b.apply(a.apply(p))).length() < 1e-12);
            assert!((a.inverse().apply(a.apply(p)) - p).length() < 1e-12);
        }
    }
}

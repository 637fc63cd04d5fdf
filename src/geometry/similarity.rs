//! Similarity transforms, for example to place one design over another.

use super::{Bounds, DAffine2, DMat2, DVec2, DesignSizeError, RANGE_MESSAGE, is_in_range};
use serde::{Deserialize, Serialize};

/// Similarity transform: a mirror, then a scale, then a rotation about the origin, then an offset.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields, rename_all = "kebab-case")]
pub struct Similarity {
    /// Translation, applied last, in the design's units.
    pub offset: DVec2,
    /// Scale factor, finite and positive.
    pub scale: f64,
    /// Rotation in radians, counter-clockwise.
    pub rotation: f64,
    /// Whether left and right are exchanged (x becomes −x), before everything else.
    pub mirror: bool,
}

/// Reason why a similarity cannot be used.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SimilarityError {
    /// The scale is zero, negative or not finite.
    #[error("the scale {0} is not a positive number; give one above zero")]
    Scale(f64),
    /// The offset or the rotation is not finite.
    #[error("the offset and the rotation of a placement must be finite numbers")]
    NotFinite,
    /// A point of the transformed design is out of range.
    #[error("after placement, a corner of the design {RANGE_MESSAGE}")]
    OutOfRange,
    /// The transformed design is too small, or too far from the origin for its size.
    #[error(transparent)]
    Size(#[from] DesignSizeError),
}

impl Default for Similarity {
    fn default() -> Self {
        Self::IDENTITY
    }
}

impl Similarity {
    /// The transform that changes nothing.
    pub const IDENTITY: Self = Self {
        offset: DVec2::ZERO,
        scale: 1.0,
        rotation: 0.0,
        mirror: false,
    };

    /// Checks that the transform is finite and invertible.
    ///
    /// # Errors
    /// [`SimilarityError`] names the invalid number.
    pub fn checked(self) -> Result<Self, SimilarityError> {
        if !(self.scale.is_finite() && self.scale > 0.0) {
            return Err(SimilarityError::Scale(self.scale));
        }
        if !(self.offset.is_finite() && self.rotation.is_finite()) {
            return Err(SimilarityError::NotFinite);
        }
        Ok(self)
    }

    /// Checks that a design with the given bounds stays in range when it is transformed.
    ///
    /// # Errors
    /// [`SimilarityError`] if the transformed design is out of range, too small, or too far from
    /// the origin for its size.
    pub fn check_on(&self, bounds: &Bounds) -> Result<(), SimilarityError> {
        let corners = bounds.corners().map(|p| self.apply(p));
        if !corners.into_iter().all(is_in_range) {
            return Err(SimilarityError::OutOfRange);
        }
        let placed = Bounds::of(corners).unwrap_or(*bounds);
        Ok(DesignSizeError::check(&placed).map(drop)?)
    }

    /// Returns the linear part of the transform. Its determinant is negative if the transform
    /// mirrors.
    #[must_use]
    pub fn linear(&self) -> DMat2 {
        DMat2::from_angle(self.rotation)
            * DMat2::from_diagonal(DVec2::new(self.flip() * self.scale, self.scale))
    }

    /// Returns the transform as an affine map.
    #[must_use]
    pub fn affine(&self) -> DAffine2 {
        DAffine2::from_mat2_translation(self.linear(), self.offset)
    }

    /// Returns −1 if the transform mirrors, and 1 otherwise. The mirror multiplies x by this
    /// factor. When a rotation and the mirror swap their order, the rotation's angle is multiplied
    /// by it.
    fn flip(&self) -> f64 {
        if self.mirror { -1.0 } else { 1.0 }
    }

    /// Applies the transform to a point.
    ///
    /// ```
    /// use morphospace::geometry::{DVec2, Similarity};
    /// let s = Similarity { scale: 2.0, offset: DVec2::X, ..Similarity::IDENTITY };
    /// assert_eq!(s.apply(DVec2::new(1.0, 1.0)), DVec2::new(3.0, 2.0));
    /// ```
    #[must_use]
    pub fn apply(&self, p: DVec2) -> DVec2 {
        if *self == Self::IDENTITY {
            return p; // exact, so that unplaced designs keep every bit
        }
        self.linear() * p + self.offset
    }

    /// Returns the composition: first `first`, then this transform.
    #[must_use]
    pub fn after(&self, first: &Self) -> Self {
        Self {
            offset: self.apply(first.offset),
            scale: self.scale * first.scale,
            // The mirror comes after the first rotation; swapping their order changes the angle's
            // sign.
            rotation: self.rotation + self.flip() * first.rotation,
            mirror: self.mirror != first.mirror,
        }
    }

    /// Returns the inverse transform.
    #[must_use]
    pub fn inverse(&self) -> Self {
        let linear = Self {
            offset: DVec2::ZERO,
            scale: 1.0 / self.scale,
            rotation: -self.flip() * self.rotation,
            mirror: self.mirror,
        };
        Self {
            // The offset was applied last, so it is undone first.
            offset: -linear.apply(self.offset),
            ..linear
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn composition_and_inverse_agree_with_application() {
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

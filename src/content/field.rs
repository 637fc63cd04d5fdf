//! Blends of two signed distance fields: the content *field* (section 3.1 of the paper).
//!
//! A blend of the fields f₀ and f₁ is F = (1 − t) L(f₀) + t L(f₁), with a scale function L. The
//! shape is filled where F ≥ L(τ), with the threshold τ. Both CPU and GPU interpolate the fields
//! bilinearly between samples *before* they apply L.
//!
//! The paper uses L(x) = sgn(x) log(|x| + ε). For ε < 1 its sign is wrong near the boundary, and
//! for every ε except 1 it jumps there. This implementation uses L(x) = sgn(x) log(1 + |x| / ε).
//! For ε = 1 this is the paper's function, and it is continuous, odd and monotone for every ε > 0.
//!
//! Guaranteed: at t = 0 and t = 1 the contour is that of the source's and of the target's field; a
//! [`FieldPair`] always has two fields on the same grid and valid parameters. Not guaranteed:
//! topology. For t between 0 and 1, parts may split or merge.

mod carried;
mod many_designs;

pub use many_designs::FieldSet;

use std::sync::Arc;

use crate::field::{DistanceField, Grid, contour};
use crate::geometry::DVec2;
use crate::settings::named;
use serde::{Deserialize, Serialize};

/// Scale function L through which distances are blended.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum BlendSpace {
    /// L(x) = sgn(x) log(1 + |x| / ε): distances near a boundary weigh most.
    #[default]
    Log,
    /// L(x) = x: all distances weigh the same.
    Real,
}

named! { BlendSpace {
    Log: "log", "Logarithmic", "Distances near the outlines weigh most: thin parts survive";
    Real: "real", "Linear", "All distances weigh the same: thin parts disappear";
} }

/// Parameters of a field blend. All lengths are in cells of the fields' grid.
///
/// ```
/// use morphospace::content::{BlendSpace, FieldBlend};
///
/// let paper = FieldBlend::default();
/// assert_eq!(paper.curve(-3.0), -(4.0_f64.ln()));
/// let real = FieldBlend { space: BlendSpace::Real, ..paper };
/// assert_eq!(real.value(-2.0, 6.0, 0.25), 0.0);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields, rename_all = "kebab-case")]
pub struct FieldBlend {
    /// Scale function: logarithmic or linear.
    pub space: BlendSpace,
    /// The length ε > 0 of the logarithmic scale, in cells. The scale is nearly linear for
    /// distances below ε. The linear scale ignores it.
    pub epsilon: f64,
    /// The threshold τ: the blended distance at which the contour lies, in cells. Positive values
    /// make the shape thinner, negative values thicker.
    pub threshold: f64,
}

/// Errors of [`FieldBlend::check`], [`FieldPair`] and [`FieldSet`].
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum FieldBlendError {
    /// The parameter ε has this value, which is not a positive finite number.
    #[error("epsilon is {0}; enter a number above 0 (the paper uses 1)")]
    Epsilon(f64),
    /// The threshold has this value, which is not finite.
    #[error("the threshold is {0}; enter a finite number of cells (0 is the boundary)")]
    Threshold(f64),
    /// Two fields do not have the same grid.
    #[error(
        "the source field uses the grid {source_grid:?} and the target field {target_grid:?}; compute both on the same grid"
    )]
    Grids {
        /// Grid of the source field.
        source_grid: Grid,
        /// Grid of the target field.
        target_grid: Grid,
    },
}

impl Default for FieldBlend {
    /// Returns the paper's parameters: logarithmic scale, ε = 1, τ = 0.
    fn default() -> Self {
        Self {
            space: BlendSpace::Log,
            epsilon: 1.0,
            threshold: 0.0,
        }
    }
}

impl FieldBlend {
    /// Checks that ε is positive and finite, and that τ is finite.
    ///
    /// # Errors
    /// [`FieldBlendError`] contains the invalid number.
    pub fn check(&self) -> Result<(), FieldBlendError> {
        if !(self.epsilon > 0.0 && self.epsilon.is_finite()) {
            return Err(FieldBlendError::Epsilon(self.epsilon));
        }
        if !self.threshold.is_finite() {
            return Err(FieldBlendError::Threshold(self.threshold));
        }
        Ok(())
    }

    /// Returns L(x), the scale function at a distance `x` in cells. L is odd, continuous and
    /// monotone.
    #[must_use]
    pub fn curve(&self, x: f64) -> f64 {
        if self.space == BlendSpace::Real {
            return x;
        }
        let ratio = x.abs() / self.epsilon;
        let log = if ratio.is_finite() {
            ratio.ln_1p()
        } else {
            // Since |x| / ε has overflowed, the 1 in log(1 + |x| / ε) is negligible.
            x.abs().ln() - self.epsilon.ln()
        };
        log.copysign(x)
    }

    /// Returns the distance, in cells, at which the scale function [`Self::curve`] has the value
    /// `level`. This is the inverse of the scale function.
    pub(crate) fn inverse_curve(&self, level: f64) -> f64 {
        match self.space {
            BlendSpace::Real => level,
            BlendSpace::Log => (level.abs().exp_m1() * self.epsilon).copysign(level),
        }
    }

    /// Returns the blend F of two distances in cells. Values of `t` outside [0, 1] extrapolate.
    #[must_use]
    pub fn value(&self, source: f64, target: f64, t: f64) -> f64 {
        (1.0 - t) * self.curve(source) + t * self.curve(target)
    }

    /// Returns L(τ), the scale function at the threshold. The shape is filled where the blend
    /// [`Self::value`] is at least L(τ).
    #[must_use]
    pub fn level(&self) -> f64 {
        self.curve(self.threshold)
    }
}

/// Two distance fields on the same grid, and the parameters of their blend.
///
/// Cloning is cheap because the fields are shared.
///
/// ```
/// use morphospace::content::{FieldBlend, FieldPair};
/// use morphospace::field::{DistanceField, Grid, Mask, Metric};
/// use morphospace::geometry::DVec2;
/// use morphospace::work::progress::Silent;
///
/// let grid = Grid::new(3, 1, DVec2::ZERO, 1.0)?;
/// let field = |bits: [bool; 3]| -> Result<_, Box<dyn std::error::Error>> {
///     let mask = Mask::new(3, 1, bits.to_vec())?;
///     Ok(DistanceField::from_mask(&mask, grid, Metric::Euclidean, &Silent)?)
/// };
/// let left = field([true, false, false])?;
/// let right = field([false, false, true])?;
/// let pair = FieldPair::new(left, right, FieldBlend::default())?;
/// assert!(pair.is_inside(DVec2::new(0.5, 0.5), 0.0));
/// assert!(!pair.is_inside(DVec2::new(0.5, 0.5), 1.0));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct FieldPair {
    source: Arc<DistanceField>,
    target: Arc<DistanceField>,
    blend: FieldBlend,
}

impl FieldPair {
    /// Combines two fields on the same grid.
    ///
    /// # Errors
    /// [`FieldBlendError`] if the grids differ or the parameters are invalid.
    pub fn new(
        source: impl Into<Arc<DistanceField>>,
        target: impl Into<Arc<DistanceField>>,
        blend: FieldBlend,
    ) -> Result<Self, FieldBlendError> {
        let (source, target) = (source.into(), target.into());
        blend.check()?;
        // Distances are in cells, so fields on different grids have different units.
        if source.grid() != target.grid() {
            return Err(FieldBlendError::Grids {
                source_grid: *source.grid(),
                target_grid: *target.grid(),
            });
        }
        Ok(Self {
            source,
            target,
            blend,
        })
    }

    /// Returns the same fields with other parameters. Distances are not computed again.
    ///
    /// # Errors
    /// [`FieldBlendError`] if the parameters are invalid.
    pub fn with_blend(&self, blend: FieldBlend) -> Result<Self, FieldBlendError> {
        blend.check()?;
        Ok(Self {
            blend,
            ..self.clone()
        })
    }

    /// Field at t = 0.
    #[must_use]
    pub fn source(&self) -> &DistanceField {
        &self.source
    }

    /// Field at t = 1.
    #[must_use]
    pub fn target(&self) -> &DistanceField {
        &self.target
    }

    /// Parameters of the blend.
    #[must_use]
    pub fn blend(&self) -> &FieldBlend {
        &self.blend
    }

    /// Grid of both fields.
    #[must_use]
    pub fn grid(&self) -> &Grid {
        self.source.grid()
    }

    /// Returns the blend F at a point of the plane. Outside the grid, the values at its border
    /// continue.
    #[must_use]
    pub fn value(&self, p: DVec2, t: f64) -> f64 {
        self.blend
            .value(self.source.value(p), self.target.value(p), t)
    }

    /// Returns whether a point of the plane is filled at `t`: it lies in the rectangle of the grid,
    /// and F is at least L(τ).
    #[must_use]
    pub fn is_inside(&self, p: DVec2, t: f64) -> bool {
        // The field values continue beyond the grid, but the shape ends there.
        self.grid().bounds().contains(p) && self.value(p, t) >= self.blend.level()
    }

    /// Returns the contour of the filled shape at `t` as closed polygons in the plane, clipped to
    /// the rectangle of the grid. Outer polygons run counter-clockwise, holes clockwise.
    #[must_use]
    pub fn contour(&self, t: f64) -> Vec<Vec<DVec2>> {
        let (grid, blend) = (self.grid(), &self.blend);
        let (source, target) = (self.source.samples(), self.target.samples());
        let value = |x, y| blend.value(source.bilinear(x, y), target.bilinear(x, y), t);
        // L is monotone. For t in [0, 1] a sample therefore needs no evaluation if both fields are
        // on the same side of the threshold there.
        let is_between = (0.0..=1.0).contains(&t);
        let [a, b] = [self.source.values(), self.target.values()];
        let known_side = |column: usize, row: usize| {
            let index = row * grid.width as usize + column;
            let [a, b] = [a[index], b[index]].map(|value| f64::from(value) >= blend.threshold);
            (is_between && a == b).then_some(a)
        };
        let (width, height) = (grid.width, grid.height);
        let mut rings = contour::trace_with_known(width, height, known_side, value, blend.level());
        for p in rings.iter_mut().flatten() {
            *p = grid.plane_from_lattice(*p);
        }
        rings
    }
}

#[cfg(test)]
mod tests;

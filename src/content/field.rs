//! A pair of distance fields and how they mix: the paper's §3.1.
//!
//! A blend is F = (1 − t) L(f₀) + t L(f₁), drawn where F ≥ L(τ). The fields
//! are read bilinearly *before* L is applied, by the CPU as by the GPU.
//!
//! The paper's L(x) = sgn(x) log(|x| + ε) changes sign near the boundary for
//! ε < 1 and jumps there for every ε but 1, which is where the paper ended. L
//! here is sgn(x) log(1 + |x| / ε): the same at ε = 1, and continuous, odd and
//! monotone at every ε > 0.
//!
//! Guarantees: at t = 0 and t = 1 the contour is that of the one design's
//! field; a pair has two fields on one grid and a legal blend. Does not
//! guarantee: between the ends, a blend may tear or merge parts.

mod carried;
mod many_designs;

pub use many_designs::FieldSet;

use std::sync::Arc;

use crate::field::{DistanceField, Grid, contour};
use crate::geometry::DVec2;
use crate::settings::choice::named;
use serde::{Deserialize, Serialize};

/// What is done to distances before they are mixed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum BlendSpace {
    /// L(x) = sgn(x) log(1 + |x| / ε): what is near a boundary decides.
    #[default]
    Log,
    /// L(x) = x.
    Real,
}

named! { BlendSpace {
    Log: "log", "Logarithmic", "Near the outlines counts most: thin parts survive";
    Real: "real", "Real", "Far counts as much as near: thin parts go under";
} }

/// How two distances make one. All lengths are in cells of the fields' grid.
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
    /// Logarithmic or real.
    pub space: BlendSpace,
    /// ε > 0 of the logarithmic space: below it L is nearly straight. Real
    /// space has no use for it.
    pub epsilon: f64,
    /// τ: how deep inside, by the blended distance, is drawn. Negative values
    /// thicken.
    pub threshold: f64,
}

/// Why a blend or a pair is none.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum FieldPairError {
    /// ε is not a positive finite number.
    #[error("epsilon is {0}: it must be above 0; the paper's value is 1")]
    Epsilon(f64),
    /// The threshold is not finite.
    #[error("the threshold is {0}: it must be a finite number of cells; 0 is the boundary")]
    Threshold(f64),
    /// The fields are not on the same grid.
    #[error(
        "the source's field is on the grid {source_grid:?} and the target's on {target_grid:?}: measure both on one"
    )]
    Grids {
        /// The source's.
        source_grid: Grid,
        /// The target's.
        target_grid: Grid,
    },
}

impl Default for FieldBlend {
    /// The paper's: logarithmic, ε = 1, the boundary itself.
    fn default() -> Self {
        Self {
            space: BlendSpace::Log,
            epsilon: 1.0,
            threshold: 0.0,
        }
    }
}

impl FieldBlend {
    /// That ε is positive and finite, and τ finite.
    ///
    /// # Errors
    /// Names the number that is not.
    pub fn check(&self) -> Result<(), FieldPairError> {
        if !(self.epsilon > 0.0 && self.epsilon.is_finite()) {
            return Err(FieldPairError::Epsilon(self.epsilon));
        }
        if !self.threshold.is_finite() {
            return Err(FieldPairError::Threshold(self.threshold));
        }
        Ok(())
    }

    /// L(x) for a distance `x` in cells: odd, continuous and monotone.
    #[must_use]
    pub fn curve(&self, x: f64) -> f64 {
        if self.space == BlendSpace::Real {
            return x;
        }
        let ratio = x.abs() / self.epsilon;
        let log = if ratio.is_finite() {
            ratio.ln_1p()
        } else {
            // |x| / ε has overflowed, and 1 is nothing beside it.
            x.abs().ln() - self.epsilon.ln()
        };
        log.copysign(x)
    }

    /// The distance whose L is `level`: the inverse of [`Self::curve`].
    pub(crate) fn distance(&self, level: f64) -> f64 {
        match self.space {
            BlendSpace::Real => level,
            BlendSpace::Log => (level.abs().exp_m1() * self.epsilon).copysign(level),
        }
    }

    /// F for the distances `source` and `target`, at `t` in [0, 1] or beyond.
    #[must_use]
    pub fn value(&self, source: f64, target: f64, t: f64) -> f64 {
        (1.0 - t) * self.curve(source) + t * self.curve(target)
    }

    /// L(τ): drawn is where the value is at least this.
    #[must_use]
    pub fn level(&self) -> f64 {
        self.curve(self.threshold)
    }
}

/// Two fields on one grid, and their blend.
///
/// Cloning is cheap: the fields are shared.
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
    /// A pair of fields on one grid.
    ///
    /// # Errors
    /// Where the grids differ, or the blend is none.
    pub fn new(
        source: impl Into<Arc<DistanceField>>,
        target: impl Into<Arc<DistanceField>>,
        blend: FieldBlend,
    ) -> Result<Self, FieldPairError> {
        let (source, target) = (source.into(), target.into());
        blend.check()?;
        // Distances are in cells: those of another grid would mean something
        // else.
        if source.grid() != target.grid() {
            return Err(FieldPairError::Grids {
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

    /// The same fields mixed another way; measures nothing again.
    ///
    /// # Errors
    /// Where the blend is none.
    pub fn with_blend(&self, blend: FieldBlend) -> Result<Self, FieldPairError> {
        blend.check()?;
        Ok(Self {
            blend,
            ..self.clone()
        })
    }

    /// The field at t = 0.
    #[must_use]
    pub fn source(&self) -> &DistanceField {
        &self.source
    }

    /// The field at t = 1.
    #[must_use]
    pub fn target(&self) -> &DistanceField {
        &self.target
    }

    /// How they mix.
    #[must_use]
    pub fn blend(&self) -> &FieldBlend {
        &self.blend
    }

    /// The grid of both fields.
    #[must_use]
    pub fn grid(&self) -> &Grid {
        self.source.grid()
    }

    /// F at a point of the plane. Beyond the grid, the values at its border
    /// are carried on.
    #[must_use]
    pub fn value(&self, p: DVec2, t: f64) -> f64 {
        self.blend
            .value(self.source.value(p), self.target.value(p), t)
    }

    /// Whether a point of the plane is drawn: it is in the grid's rectangle,
    /// and the value there is at least the level.
    #[must_use]
    pub fn is_inside(&self, p: DVec2, t: f64) -> bool {
        // Values are carried on beyond the grid, the contour is cut off there.
        self.grid().bounds().contains(p) && self.value(p, t) >= self.blend.level()
    }

    /// What is drawn at `t`, as closed polygons in the plane: outer ones
    /// counter-clockwise, holes clockwise, cut off at the grid's rectangle.
    #[must_use]
    pub fn contour(&self, t: f64) -> Vec<Vec<DVec2>> {
        let (grid, blend) = (self.grid(), &self.blend);
        let (source, target) = (self.source.samples(), self.target.samples());
        let value = |x, y| blend.value(source.bilinear(x, y), target.bilinear(x, y), t);
        // L is monotone: what both fields have on one side of the threshold is there.
        let is_between = (0.0..=1.0).contains(&t);
        let [a, b] = [self.source.values(), self.target.values()];
        let known = |column: usize, row: usize| {
            let at = row * grid.width as usize + column;
            let [a, b] = [a[at], b[at]].map(|value| f64::from(value) >= blend.threshold);
            (is_between && a == b).then_some(a)
        };
        let (width, height) = (grid.width, grid.height);
        let mut rings = contour::trace_knowing(width, height, known, value, blend.level());
        for p in rings.iter_mut().flatten() {
            *p = grid.plane_from_lattice(*p);
        }
        rings
    }
}

#[cfg(test)]
mod tests;

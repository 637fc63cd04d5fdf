//! Options of the lattice warp and their validation.

use crate::warp::features::FeatureError;
use serde::{Deserialize, Serialize};

/// Maximum number of levels added beyond the requested ones while features are missed (resource
/// limit: each level doubles the resolution).
pub const MAX_EXTRA_LEVELS: u32 = 3;

/// Maximum number of cells of the finest lattice along the longer side of the frame (resource
/// limit).
pub const MAX_LATTICE_CELLS: u32 = 1024;

/// Options of the lattice warp.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields, rename_all = "kebab-case")]
pub struct LatticeOptions {
    /// Number of levels, 1 to 9. The lattice of each level has half the spacing of the previous
    /// one. While an error exceeds the tolerance, up to [`MAX_EXTRA_LEVELS`] levels are added.
    pub levels: u32,
    /// Number of cells of the first lattice along the longer side of the frame, 1 to 32. With
    /// fewer cells a feature affects more of the plane.
    pub coarsest: u32,
    /// Permitted error of features as a fraction of the frame's diameter, in (0, 1].
    pub tolerance: f64,
    /// Whether folds of the plane are prevented. Each lattice layer displaces the plane smoothly,
    /// by displacements that are chosen at the points of one lattice. If true, these displacements
    /// are bounded, and the layers (several per level) are applied one after another. If false,
    /// they are unbounded, and the layers (one per level) are added up.
    pub fold_free: bool,
}

impl Default for LatticeOptions {
    fn default() -> Self {
        Self {
            levels: 5,
            coarsest: 4,
            tolerance: 1e-4,
            fold_free: true,
        }
    }
}

/// Reason why the lattice warp cannot be created.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum LatticeError {
    /// The features are invalid.
    #[error(transparent)]
    Features(#[from] FeatureError),
    /// The number of levels is outside 1 to 9.
    #[error("the lattice has {0} levels, but must have 1 to 9; the default is 5")]
    Levels(u32),
    /// The number of cells of the first lattice is outside 1 to 32.
    #[error("the coarsest lattice has {0} cells, but must have 1 to 32; the default is 4")]
    Coarsest(u32),
    /// The finest requested lattice would have more than [`MAX_LATTICE_CELLS`] cells along a side.
    #[error(
        "the finest lattice would have {0} cells along a side, but at most {MAX_LATTICE_CELLS} are possible; use fewer levels or a coarser first lattice"
    )]
    Finest(u32),
    /// The tolerance is outside (0, 1].
    #[error("the tolerance is {0}, but must be above 0 and at most 1 frame diameter")]
    Tolerance(f64),
}

impl LatticeOptions {
    /// Checks that all options are in range.
    ///
    /// # Errors
    /// [`LatticeError`] for the first option out of range.
    pub fn check(&self) -> Result<(), LatticeError> {
        if !(1..=9).contains(&self.levels) {
            return Err(LatticeError::Levels(self.levels));
        }
        if !(1..=32).contains(&self.coarsest) {
            return Err(LatticeError::Coarsest(self.coarsest));
        }
        let finest = self.coarsest << (self.levels - 1);
        if finest > MAX_LATTICE_CELLS {
            return Err(LatticeError::Finest(finest));
        }
        if !(self.tolerance > 0.0 && self.tolerance <= 1.0) {
            return Err(LatticeError::Tolerance(self.tolerance));
        }
        Ok(())
    }

    /// Returns the maximum number of levels, including added ones.
    pub(super) fn max_levels(&self) -> u32 {
        let finer = MAX_LATTICE_CELLS / (self.coarsest << (self.levels - 1));
        self.levels + MAX_EXTRA_LEVELS.min(finer.ilog2())
    }
}

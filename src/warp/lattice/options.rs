//! How fine lattices are, and what may be wrong with that.

use crate::warp::features::FeatureError;
use serde::{Deserialize, Serialize};

/// Levels that may follow those asked for where a feature is not met.
pub const MAX_EXTRA_LEVELS: u32 = 3;

/// Cells of the finest lattice along the longer side of the frame.
pub const MAX_LATTICE_CELLS: u32 = 1024;

/// Options of the warp by lattices.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields, rename_all = "kebab-case")]
pub struct LatticeOptions {
    /// How many lattices, each twice as fine as the one before; 1 to 9. Up to
    /// [`MAX_EXTRA_LEVELS`] follow while a feature is not met.
    pub levels: u32,
    /// Cells of the first lattice along the longer side of the frame; 1 to
    /// 32. Fewer move more of the plane with a feature.
    pub coarsest: u32,
    /// How far features may be missed, as a fraction of the frame's diameter;
    /// above 0 and at most 1.
    pub tolerance: f64,
    /// Compose bounded layers, so that the plane never folds; else layers are
    /// summed.
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

/// Why a warp by lattices is none.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum LatticeError {
    /// The features cannot be moved by.
    #[error(transparent)]
    Features(#[from] FeatureError),
    /// Too few or too many levels.
    #[error("{0} levels: there must be 1 to 9; 5 are usual")]
    Levels(u32),
    /// The first lattice is none, or too fine.
    #[error("the coarsest lattice has {0} cells: it must have 1 to 32; 4 are usual")]
    Coarsest(u32),
    /// The last lattice is too fine.
    #[error(
        "the finest lattice would have {0} cells along a side: at most {MAX_LATTICE_CELLS}; use fewer levels or a coarser first lattice"
    )]
    Finest(u32),
    /// The tolerance is out of range.
    #[error("the tolerance is {0}: it must be above 0 and at most 1 of the frame's diameters")]
    Tolerance(f64),
}

impl LatticeOptions {
    /// That all numbers are in range.
    ///
    /// # Errors
    /// Names the number that is not.
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

    /// How many levels there may be in the end.
    pub(super) fn most_levels(&self) -> u32 {
        let finer = MAX_LATTICE_CELLS / (self.coarsest << (self.levels - 1));
        self.levels + MAX_EXTRA_LEVELS.min(finer.ilog2())
    }
}

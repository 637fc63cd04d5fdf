//! Warps by lattices: multilevel cubic B-splines.
//!
//! Lee, Wolberg, Shin, "Scattered data interpolation with multilevel
//! B-splines" (1997). At t the features lie on the straight lines
//! (1−t) p + t q. From there, two maps lead to the source and to the target:
//! layers of displacements, from a coarse lattice to finer ones, each of which
//! leads the features nearer to where they belong.
//!
//! *Fold-free*, layers are **composed** and each control point's displacement
//! is at most 0.48 of its lattice's spacing, which makes every layer, and so
//! the whole, injective (Choi, Lee 2000). Otherwise layers are summed, as
//! published, and the plane may fold: summed layers can fold though each is
//! within its bound.
//!
//! Guaranteed: a frame cannot fail. At t = 0 the source, and at t = 1 the
//! target, is looked up at the very same place, to the last bit. Swapping the
//! designs plays the film backwards. Fold-free, the plane never folds,
//! whatever the features do. Not guaranteed: that every feature is met;
//! [`Lattice::residuals`] says by how much not. Features that meet on their
//! way cannot be.
//!
//! Lattices reach one longer side of the frame beyond it, and displacements
//! fade to zero there. Features farther than half of a longer side outside
//! count less and less, and not at all from a whole one.
//!
//! - `layer`: one lattice
//! - `tower`: layer upon layer

mod layer;
mod tower;

#[cfg(test)]
mod tests;

use super::scattered::{FeatureError, Features};
use super::{Missed, PlaneWarp};
use crate::correspondence::{LinePair, PointPair};
use crate::geometry::{Bounds, DVec2};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use tower::{Ground, Tower};

/// Levels that may follow those asked for where a feature is not met.
pub const MORE_LEVELS: u32 = 3;

/// Cells of the finest lattice along the longer side of the frame.
pub const FINEST: u32 = 1024;

/// Layers of the first level, of the others that are asked for, and of those
/// that follow: ten of spacings ¼ lead a feature across the frame.
const COMPOSED: [u32; 3] = [16, 4, 8];

/// Features missed by so many tolerances are told of: a thousandth of the
/// frame unless another tolerance was chosen.
const SEEN: f64 = 10.0;

/// How many places a core takes at a time.
const CHUNK: usize = 256;

/// Options of the warp by lattices.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields, rename_all = "kebab-case")]
pub struct LatticeOptions {
    /// How many lattices, each twice as fine as the one before; 1 to 9. Up to
    /// [`MORE_LEVELS`] follow while a feature is not met.
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
        "the finest lattice would have {0} cells along a side: at most {FINEST}; use fewer levels or a coarser first lattice"
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
        if finest > FINEST {
            return Err(LatticeError::Finest(finest));
        }
        if !(self.tolerance > 0.0 && self.tolerance <= 1.0) {
            return Err(LatticeError::Tolerance(self.tolerance));
        }
        Ok(())
    }
}

/// How far the looks from a feature at t are from its places in the designs,
/// in units of the plane.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Residual {
    /// In the source.
    pub source: f64,
    /// In the target.
    pub target: f64,
}

/// The row *B-spline lattices*.
///
/// ```
/// use morphospace::correspondence::PointPair;
/// use morphospace::geometry::{Bounds, DVec2};
/// use morphospace::warp::{Lattice, LatticeOptions, PlaneWarp};
///
/// let frame = Bounds { min: DVec2::ZERO, max: DVec2::ONE };
/// let pair = PointPair { source: DVec2::splat(0.25), target: DVec2::splat(0.75) };
/// let warp = Lattice::new(&frame, &[pair], &[], LatticeOptions::default())?;
/// let (mut source, mut target) = ([DVec2::ZERO], [DVec2::ZERO]);
/// let halfway = [DVec2::splat(0.5)];
/// warp.look_up(0.5, &mut warp.maps(), &halfway, &mut source, &mut target);
/// assert!(source[0].distance(pair.source) < 2e-4);
/// assert!(target[0].distance(pair.target) < 2e-4);
/// # Ok::<(), morphospace::warp::LatticeError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Lattice {
    features: Features,
    ground: Ground,
    options: LatticeOptions,
}

impl Lattice {
    /// A warp by pairs of points, and by lines as
    /// [`super::LINE_SAMPLES`] points each, in the coordinates of the frame.
    ///
    /// # Errors
    /// [`LatticeError`] on coordinates that are not finite, on options out of
    /// range and on more than [`super::MAX_FEATURES`].
    pub fn new(
        frame: &Bounds,
        points: &[PointPair],
        lines: &[LinePair],
        options: LatticeOptions,
    ) -> Result<Self, LatticeError> {
        options.check()?;
        let features = Features::new(frame, points, lines)?;
        let ground = Ground::new(frame, features.unit, options);
        Ok(Self {
            features,
            ground,
            options,
        })
    }

    /// What it was built with.
    #[must_use]
    pub fn options(&self) -> &LatticeOptions {
        &self.options
    }

    /// The tolerance as a length.
    #[must_use]
    pub fn tolerance(&self) -> f64 {
        self.ground.tolerance
    }

    /// How far features are missed at t: first points, then the samples of
    /// each line from end to end. Builds the maps anew.
    #[must_use]
    pub fn residuals(&self, t: f64) -> Vec<Residual> {
        let mut maps = self.maps();
        self.build(t, &mut maps);
        let [source, target] = &maps.towers;
        let both = source.residuals().zip(target.residuals());
        both.map(|(source, target)| Residual { source, target })
            .collect()
    }

    fn build(&self, t: f64, maps: &mut LatticeMaps) {
        let [source, target] = &mut maps.towers;
        let build = |tower: &mut Tower, side: usize| {
            let features = self.features.at(t).map(|(at, looks)| (at, looks[side]));
            tower.build(&self.ground, features);
        };
        rayon::join(|| build(source, 0), || build(target, 1));
    }
}

/// The memory of one player of a [`Lattice`].
#[derive(Debug, Default)]
pub struct LatticeMaps {
    /// To the source and to the target.
    towers: [Tower; 2],
}

impl PlaneWarp for Lattice {
    type Maps = LatticeMaps;

    fn maps(&self) -> LatticeMaps {
        LatticeMaps::default()
    }

    fn look_up(
        &self,
        t: f64,
        maps: &mut LatticeMaps,
        frame: &[DVec2],
        in_source: &mut [DVec2],
        in_target: &mut [DVec2],
    ) {
        self.build(t, maps);
        let [to_source, to_target] = &maps.towers;
        let sources = in_source.par_chunks_mut(CHUNK);
        let looked_up = sources.zip(in_target.par_chunks_mut(CHUNK));
        let chunks = frame.par_chunks(CHUNK).zip(looked_up);
        chunks.for_each(|(places, (source, target))| {
            to_source.lead(places, source);
            to_target.lead(places, target);
        });
    }

    fn missed(&self, t: f64) -> Option<Missed> {
        let seen = SEEN * self.tolerance();
        let residuals = self.residuals(t).into_iter().zip(self.features.at(t));
        let off = residuals.map(|(r, (at, _))| (r.source.max(r.target), at));
        let missed: Vec<_> = off.filter(|(by, _)| *by > seen).collect();
        let worst = missed.iter().max_by(|a, b| a.0.total_cmp(&b.0))?;
        Some(Missed {
            count: missed.len(),
            by: worst.0,
            place: worst.1,
            unfolded: self.options.fold_free,
        })
    }
}

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
//! - `options`: how fine, and what may be wrong with it
//! - `blocks`: control points where there are any
//! - `layer`: one lattice
//! - `tower`: layer upon layer

mod control_grid;
mod layer;
mod layer_stack;
mod options;

#[cfg(test)]
mod tests;

pub use options::{LatticeError, LatticeOptions, MAX_EXTRA_LEVELS, MAX_LATTICE_CELLS};

use super::MissedFeatures;
use super::features::WarpFeatures;
use super::plane::{PlaneWarp, in_chunks};
use crate::correspondence::{LinePair, PointPair};
use crate::geometry::{Bounds, DVec2};
use layer_stack::{LatticeDomain, LayerStack};

/// Features missed by so many tolerances are told of: a thousandth of the
/// frame unless another tolerance was chosen.
const SEEN: f64 = 10.0;

/// How many places a core takes at a time.
/// A place costs up to some hundred layers: fewer places than other warps take.
const CHUNK: usize = 256;

/// The row *B-spline lattices*.
///
/// ```
/// use morphospace::correspondence::PointPair;
/// use morphospace::geometry::{Bounds, DVec2};
/// use morphospace::warp::{Lattice, LatticeOptions, PlaneWarp};
///
/// let frame = Bounds { min: DVec2::ZERO, max: DVec2::ONE };
/// let pair = PointPair { source: DVec2::splat(0.25), target: DVec2::splat(0.75) };
/// let mut warp = Lattice::new(&frame, &[pair], &[], LatticeOptions::default())?;
/// let (mut source, mut target) = ([DVec2::ZERO], [DVec2::ZERO]);
/// let halfway = [DVec2::splat(0.5)];
/// warp.look_up(0.5, &halfway, &mut source, &mut target);
/// assert!(source[0].distance(pair.source) < 2e-4);
/// assert!(target[0].distance(pair.target) < 2e-4);
/// # Ok::<(), morphospace::warp::LatticeError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Lattice {
    features: WarpFeatures,
    ground: LatticeDomain,
    /// To the source and to the target, as they last were.
    towers: [LayerStack; 2],
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
        let features = WarpFeatures::new(frame, points, lines)?;
        Ok(Self {
            ground: LatticeDomain::new(frame, features.unit, options),
            features,
            towers: Default::default(),
        })
    }

    /// The tolerance as a length.
    #[must_use]
    pub fn tolerance(&self) -> f64 {
        self.ground.tolerance
    }

    /// How far the looks from each feature at t are from its places in the
    /// source and in the target: first points, then the samples of each line
    /// from end to end. Builds the maps anew.
    #[must_use]
    pub fn residuals(&self, t: f64) -> Vec<[f64; 2]> {
        let mut now = self.clone();
        now.build(t);
        let [source, target] = &now.towers;
        let both = source.residuals().zip(target.residuals());
        both.map(<[f64; 2]>::from).collect()
    }

    fn build(&mut self, t: f64) {
        let [source, target] = &mut self.towers;
        let (features, ground) = (&self.features, &self.ground);
        let build = |tower: &mut LayerStack, side: usize| {
            tower.build(ground, features.at(t).map(|(at, looks)| (at, looks[side])));
        };
        rayon::join(|| build(source, 0), || build(target, 1));
    }
}

impl PlaneWarp for Lattice {
    fn look_up(
        &mut self,
        t: f64,
        frame: &[DVec2],
        in_source: &mut [DVec2],
        in_target: &mut [DVec2],
    ) {
        self.build(t);
        let [to_source, to_target] = &self.towers;
        in_chunks(
            CHUNK,
            frame,
            [in_source, in_target],
            |places, [source, target]| {
                to_source.lead(places, source);
                to_target.lead(places, target);
            },
        );
    }

    fn missed(&self, t: f64) -> Option<MissedFeatures> {
        let seen = SEEN * self.tolerance();
        let residuals = self.residuals(t).into_iter().zip(self.features.at(t));
        let off = residuals.map(|([a, b], (at, _))| (a.max(b), at));
        let missed: Vec<_> = off.filter(|(by, _)| *by > seen).collect();
        let worst = missed.iter().max_by(|a, b| a.0.total_cmp(&b.0))?;
        Some(MissedFeatures {
            count: missed.len(),
            by: worst.0,
            place: worst.1,
            unfolded: self.ground.options.fold_free,
        })
    }
}

//! Lattice warp: multilevel cubic B-splines, optionally without folds.
//!
//! Lee, Wolberg, Shin, "Scattered data interpolation with multilevel B-splines" (1997). At time t,
//! a feature with position p in the source and q in the target lies at (1−t) p + t q. Two mappings
//! lead from there to the source and to the target. Each mapping is a sequence of displacement
//! layers on increasingly fine lattices; each layer moves the features closer to their positions in
//! the design.
//!
//! In fold-free mode the layers are **composed** and each control point moves by at most 0.48 of
//! the lattice spacing per axis. This makes every layer, and hence the composition, injective
//! (Choi, Lee 2000). Otherwise the layers are summed as published, and the mapping may fold even if
//! each layer respects the bound.
//!
//! Guaranteed: evaluation cannot fail. At t = 0 the mapping to the source is exactly the identity;
//! at t = 1 the mapping to the target is. Exchanging the designs reverses the motion. In fold-free
//! mode the mapping never folds, for any features. Not guaranteed: that every feature is mapped
//! exactly to its position; [`Lattice::residuals`] returns the errors. If two features coincide at
//! some t but not in a design, the mapping to that design must miss at least one of them.
//!
//! The influence of a feature outside the frame fades from a distance of half the frame's longer
//! side onwards and vanishes at a distance of the full side. The lattices cover all points that are
//! displaced.
//!
//! - `options`: resolution, tolerance and their validation
//! - `control_grid`: sparse storage of control points
//! - `layer`: one B-spline lattice
//! - `layer_stack`: the sequence of layers

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

/// Multiple of the permitted error above which a feature is reported as missed: with the default
/// options, a thousandth of the frame's diameter, which is barely visible (heuristic).
const REPORTED_ERROR: f64 = 10.0;

/// Number of points per parallel work item (resource limit: small enough to balance the load, since
/// a point may pass through dozens of layers, and large enough to hide the scheduling overhead).
const CHUNK: usize = 256;

/// Plane warp controlled by point pairs, with multilevel B-spline lattices.
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
    domain: LatticeDomain,
    /// Mappings from the frame to the source and to the target, built for the most recent t.
    stacks: [LayerStack; 2],
}

impl Lattice {
    /// Creates a warp from point pairs and line pairs in frame coordinates.
    ///
    /// Each line is sampled at [`super::LINE_SAMPLES`] points.
    ///
    /// # Errors
    /// [`LatticeError`] if a coordinate is not finite, an option is out of range, or there are
    /// more than [`super::MAX_FEATURES`] features.
    pub fn new(
        frame: &Bounds,
        points: &[PointPair],
        lines: &[LinePair],
        options: LatticeOptions,
    ) -> Result<Self, LatticeError> {
        options.check()?;
        let features = WarpFeatures::new(frame, points, lines)?;
        Ok(Self {
            domain: LatticeDomain::new(frame, features.unit, options),
            features,
            stacks: Default::default(),
        })
    }

    /// Returns the permitted error of a feature, in plane units.
    #[must_use]
    pub fn tolerance(&self) -> f64 {
        self.domain.tolerance
    }

    /// For each feature, returns by how far the mappings at t miss its position in the source and
    /// its position in the target, in plane units.
    ///
    /// Point pairs come first, then the sample points of each line. Each call builds the mappings
    /// into source and target anew, which costs as much as evaluating the warp.
    #[must_use]
    pub fn residuals(&self, t: f64) -> Vec<[f64; 2]> {
        let mut at_t = self.clone();
        at_t.build(t);
        let [source, target] = &at_t.stacks;
        let both = source.residuals().zip(target.residuals());
        both.map(<[f64; 2]>::from).collect()
    }

    /// Builds the mappings from the frame to the source and to the target, for time t.
    fn build(&mut self, t: f64) {
        let [source, target] = &mut self.stacks;
        let (features, ground) = (&self.features, &self.domain);
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
        let [to_source, to_target] = &self.stacks;
        in_chunks(
            CHUNK,
            frame,
            [in_source, in_target],
            |places, [source, target]| {
                to_source.apply(places, source);
                to_target.apply(places, target);
            },
        );
    }

    fn missed_features(&self, t: f64) -> Option<MissedFeatures> {
        let limit = REPORTED_ERROR * self.tolerance();
        let residuals = self.residuals(t).into_iter().zip(self.features.at(t));
        let errors = residuals.map(|([a, b], (at, _))| (a.max(b), at));
        let missed: Vec<_> = errors.filter(|(error, _)| *error > limit).collect();
        let worst = missed.iter().max_by(|a, b| a.0.total_cmp(&b.0))?;
        Some(MissedFeatures {
            count: missed.len(),
            distance: worst.0,
            place: worst.1,
            fold_free: self.domain.options.fold_free,
        })
    }
}

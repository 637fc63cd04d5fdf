//! A map of the plane through given values at given places: dense, for any
//! number of places to look it up at.

use super::options::{ScatteredError, ScatteredOptions};
use super::system::Solver;
use crate::geometry::DVec2;
use rayon::prelude::*;

/// How many places a core takes at a time.
pub(super) const CHUNK: usize = 1024;

/// An affine part plus Σ cᵢ φ(|x − xᵢ|), in each of two coordinates.
///
/// Building is about 2n³/3 operations for n centres; a look-up n evaluations
/// of φ, as wide as the machine's vectors and over all cores.
///
/// Guaranteed: values are met where there is no smoothing, the centres are
/// apart and the functions are not too wide for the last digits; affine maps
/// are reproduced. With thin plates it is `RBFInterpolator(centres, values,
/// kernel="thin_plate_spline", smoothing=λ · unit²)` of SciPy.
///
/// ```
/// use morphospace::geometry::DVec2;
/// use morphospace::warp::{RadialMap, ScatteredOptions};
///
/// let centres = [DVec2::ZERO, DVec2::X, DVec2::Y, DVec2::ONE];
/// let values = [DVec2::ZERO, DVec2::X, DVec2::Y, DVec2::splat(2.0)];
/// let map = RadialMap::new(&centres, &values, &ScatteredOptions::default(), 1.0)?;
/// assert!(map.map(DVec2::ONE).distance(DVec2::splat(2.0)) < 1e-12);
/// # Ok::<(), morphospace::warp::ScatteredError>(())
/// ```
#[derive(Debug)]
pub struct RadialMap(Solver<1>);

/// What a map gave up so that there is one. Nothing, if it is the default.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RadialCompromise {
    /// How many centres were one with an earlier one.
    pub merged: usize,
    /// What was added to the diagonal of the system, where it was singular to
    /// the last digits. Infinite where nothing helped: the map is then the
    /// similarity that fits best.
    pub ridge: f64,
}

impl RadialMap {
    /// Solves for the map. Width and smoothing are relative to `unit`, a
    /// length; in a film it is the frame's diameter.
    ///
    /// Centres nearer than a millionth of the unit are one, with the mean of
    /// their values.
    ///
    /// # Errors
    /// [`ScatteredError`] if an option is out of range, if there are not as
    /// many values as centres, or if a number is not finite.
    pub fn new(
        centres: &[DVec2],
        values: &[DVec2],
        options: &ScatteredOptions,
        unit: f64,
    ) -> Result<Self, ScatteredError> {
        options.check()?;
        if centres.len() != values.len() {
            return Err(ScatteredError::Lengths {
                centres: centres.len(),
                values: values.len(),
            });
        }
        if !(unit.is_finite() && unit > 0.0) {
            return Err(ScatteredError::Unit(unit));
        }
        let finite = |(c, v): (&DVec2, &DVec2)| c.is_finite() && v.is_finite();
        if let Some(index) = centres.iter().zip(values).position(|pair| !finite(pair)) {
            return Err(ScatteredError::Centre(index + 1));
        }
        let values: Vec<[DVec2; 1]> = values.iter().map(|&v| [v]).collect();
        let mut solver = Solver::new(*options, unit, f64::INFINITY);
        solver.solve(centres, &values);
        Ok(Self(solver))
    }

    /// What was given up when it was built.
    #[must_use]
    pub fn compromise(&self) -> RadialCompromise {
        RadialCompromise {
            merged: self.0.merged(),
            ridge: self.0.ridge().unwrap_or(f64::INFINITY),
        }
    }

    /// The value at one place.
    #[must_use]
    pub fn map(&self, place: DVec2) -> DVec2 {
        let mut out = [DVec2::ZERO];
        let solver = &self.0;
        solver
            .sum
            .evaluate(solver.arch(), &[place], false, [&mut out]);
        out[0]
    }

    /// The values at many places, over all cores.
    ///
    /// # Panics
    /// If there is not one of `out` for each place.
    pub fn map_into(&self, places: &[DVec2], out: &mut [DVec2]) {
        assert_eq!(places.len(), out.len(), "one value for each place");
        let (sum, arch) = (&self.0.sum, self.0.arch());
        places
            .par_chunks(CHUNK)
            .zip(out.par_chunks_mut(CHUNK))
            .for_each(|(places, out)| sum.evaluate(arch, places, false, [out]));
    }
}

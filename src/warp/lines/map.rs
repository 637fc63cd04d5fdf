//! The map of the plane by one set of lines: for whole pictures and for many
//! points, without a time.

use super::bundle::Bundle;
use super::kernel::BLOCK;
use super::line::Feature;
use super::options::{Constants, LinesError, check_points};
use super::raster::{Painter, Raster};
use crate::geometry::DVec2;
use rayon::prelude::*;

/// A line from end to end.
pub type Segment = [DVec2; 2];

/// How many places a thread takes at a time.
const CHUNK: usize = 32 * BLOCK;

/// Beier and Neely's map by pairs of lines, from the frame into a design.
///
/// Places are computed for many at a time: one alone costs as much as sixteen.
///
/// ```
/// use morphospace::geometry::DVec2;
/// use morphospace::warp::LineMap;
///
/// let in_frame = [DVec2::ZERO, DVec2::X];
/// let in_design = [DVec2::ZERO, DVec2::Y]; // a quarter turn
/// let map = LineMap::new(&[[in_frame, in_design]], 0.1, 2.0, 0.5)?;
/// assert!(map.map(DVec2::new(3.0, 1.0)).distance(DVec2::new(-1.0, 3.0)) < 1e-12);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct LineMap(pub(super) Bundle<1>);

impl LineMap {
    /// A map by pairs of lines, each in the frame and in the design. `a` > 0
    /// is in units of the plane, `b` in (0, 8], `p` ≥ 0. A pair without length
    /// in both moves what is near it as a line of length `a` would. Without
    /// pairs nothing moves.
    ///
    /// # Errors
    /// [`LinesError`] if a coordinate is not finite or a constant out of
    /// range.
    pub fn new(pairs: &[[Segment; 2]], a: f64, b: f64, p: f64) -> Result<Self, LinesError> {
        let constants = Constants::new(a, b, p)?;
        check_points(pairs.iter().copied(), |line| LinesError::Line { line })?;
        let mut bundle = Bundle::new(constants, pairs.len());
        bundle.fill(pairs.iter().map(|&[in_frame, in_design]| Feature {
            in_frame,
            in_designs: [in_design],
            nominal: None,
        }));
        Ok(Self(bundle))
    }

    /// Where a place of the frame is in the design.
    #[must_use]
    pub fn map(&self, place: DVec2) -> DVec2 {
        let mut out = [place];
        self.0.map_into(&[place], [&mut out]);
        out[0]
    }

    /// Where each place of the frame is in the design, on all threads of the
    /// caller's rayon pool. Both slices have one length; what is beyond the
    /// shorter is left as it is.
    pub fn map_into(&self, places: &[DVec2], out: &mut [DVec2]) {
        places
            .par_chunks(CHUNK)
            .zip(out.par_chunks_mut(CHUNK))
            .for_each(|(places, out)| self.0.map_into(places, [out]));
    }

    /// Where each pixel is in the design, x and y apart, as many as there is
    /// room for in both; on all threads of the caller's rayon pool. To 1e-12
    /// of the longest displacements the same as for single places, and faster.
    pub fn map_raster(&self, raster: &Raster, out_x: &mut [f64], out_y: &mut [f64]) {
        let room = out_x.len().min(out_y.len());
        Painter::new(&self.0, raster).paint(&mut out_x[..room], &mut out_y[..room]);
    }
}

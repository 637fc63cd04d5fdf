//! Inverse warps of the whole plane, evaluated on a grid.
//!
//! A plane warp consists of two mappings from the frame, one into each design. Each mapping returns
//! the design point shown at a frame point, so that the frame is covered without gaps. The mappings
//! are evaluated at the corners of a grid and interpolated linearly in its triangles.

use super::{MissedFeatures, Placement, Placer, Warp};
use crate::geometry::{Bounds, DVec2};
use rayon::prelude::*;
use std::fmt::Debug;
use std::sync::Arc;

/// A plane warp controlled by features (points or lines).
///
/// At t the features lie between their source and target positions. The warp reuses its
/// memory from call to call, so each evaluator works on its own clone.
pub trait PlaneWarp: Clone + Debug + Send + Sync + 'static {
    /// Computes, for time t, the source point and the target point that are shown at each point of
    /// `frame`.
    ///
    /// All slices have the same length. The results are finite for all features, even for
    /// features that meet.
    fn look_up(
        &mut self,
        t: f64,
        frame: &[DVec2],
        in_source: &mut [DVec2],
        in_target: &mut [DVec2],
    );

    /// Returns a summary of the features that the mappings miss at t by more than their tolerance,
    /// or `None` if there are none.
    fn missed_features(&self, _t: f64) -> Option<MissedFeatures> {
        None
    }
}

/// Evaluates `look` on chunks of `size` frame points, in parallel.
pub(super) fn in_chunks(
    size: usize,
    frame: &[DVec2],
    [in_source, in_target]: [&mut [DVec2]; 2],
    look: impl Fn(&[DVec2], [&mut [DVec2]; 2]) + Sync,
) {
    let looks = in_source
        .par_chunks_mut(size)
        .zip(in_target.par_chunks_mut(size));
    let chunks = frame.par_chunks(size).zip(looks);
    chunks.for_each(|(places, (source, target))| look(places, [source, target]));
}

/// Regular grid of nearly square cells over a rectangle, two triangles per cell.
#[derive(Clone, Debug)]
pub struct PlaneGrid {
    faces: Arc<[[u32; 3]]>,
    places: Vec<DVec2>,
}

impl PlaneGrid {
    /// Covers `frame` with about `cells` cells along its longer side, at least one.
    #[must_use]
    pub fn covering(frame: &Bounds, cells: u32) -> Self {
        let size = frame.size();
        let cell = size.max_element() / f64::from(cells.max(1));
        let along = |length: f64| ((length / cell).round() as u32).clamp(1, cells.max(1));
        let (columns, rows) = (along(size.x), along(size.y));
        let place = |i: u32, j: u32| {
            let share = |k: u32, of: u32| f64::from(k) / f64::from(of);
            frame.min + size * DVec2::new(share(i, columns), share(j, rows))
        };
        let places = (0..=rows).flat_map(|j| (0..=columns).map(move |i| place(i, j)));
        let cell = |i: u32, j: u32| {
            let a = j * (columns + 1) + i;
            let (b, d) = (a + 1, a + columns + 1);
            let c = d + 1;
            // Alternating diagonals avoid a directional bias.
            if (i + j).is_multiple_of(2) {
                [[a, b, c], [a, c, d]]
            } else {
                [[a, b, d], [b, c, d]]
            }
        };
        let cells = (0..rows).flat_map(|j| (0..columns).flat_map(move |i| cell(i, j)));
        Self {
            faces: cells.collect(),
            places: places.collect(),
        }
    }

    /// Returns the triangles as indices into [`Self::places`].
    pub(super) fn faces(&self) -> Arc<[[u32; 3]]> {
        Arc::clone(&self.faces)
    }

    /// Returns the cell corners, row by row from the bottom.
    #[must_use]
    pub fn places(&self) -> &[DVec2] {
        &self.places
    }
}

/// A [`Warp`] that samples a plane warp at the corners of a grid.
#[derive(Debug)]
pub struct GridWarp<W> {
    warp: W,
    grid: PlaneGrid,
}

impl<W: PlaneWarp> GridWarp<W> {
    /// Samples `warp` at the corners of `grid`.
    pub const fn new(warp: W, grid: PlaneGrid) -> Self {
        Self { warp, grid }
    }
}

impl<W: PlaneWarp> Warp for GridWarp<W> {
    fn missed_features(&self, t: f64) -> Option<MissedFeatures> {
        self.warp.missed_features(t)
    }

    fn placer(&self) -> Placer {
        let places = &self.grid.places;
        let placement = Placement::of_source(Arc::clone(&self.grid.faces), places, places);
        let mut warp = self.warp.clone();
        let mut placer = Placer::new(placement, move |t, placement| {
            let Placement {
                in_frame,
                in_source,
                in_target,
                ..
            } = placement;
            warp.look_up(t, in_frame, in_source, in_target);
        });
        placer.place(0.0);
        placer
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::twice_signed_area;

    #[test]
    fn a_grid_covers_its_frame_once() {
        let frame = Bounds {
            min: DVec2::new(-1.0, 2.0),
            max: DVec2::new(5.0, 4.0),
        };
        let grid = PlaneGrid::covering(&frame, 9);
        assert_eq!(grid.places().len(), 10 * 4);
        let area = |face: &[u32; 3]| {
            let [a, b, c] = face.map(|v| grid.places()[v as usize]);
            twice_signed_area(a, b, c)
        };
        let areas: Vec<f64> = grid.faces.iter().map(area).collect();
        assert!(areas.iter().all(|&area| area > 0.0));
        assert!((0.5 * areas.iter().sum::<f64>() - 12.0).abs() < 1e-12);
    }
}

//! Distance fields that a warp has carried: pulled back into the frame.
//!
//! For each sample of the fields' own grid a placement says which point of the
//! source and which of the target is there; the fields are read at those and
//! blended as ever. Pulled-back values are no distances any more; L is applied
//! to them as they are.

use super::super::placement_scan::scan;
use super::FieldPair;
use crate::field::{SampledField, contour};
use crate::geometry::{Bounds, DVec2};
use crate::warp::Placement;

/// What no face of the placement covers is outside, this many cells deep: as
/// deep as a sample beside the boundary.
const OUTSIDE: f64 = -1.0;

/// How far beyond the fields' grid parts are followed, in its longer sides. Of
/// a square grid that makes up to four times as many samples.
const BEYOND: f64 = 0.5;

impl FieldPair {
    /// What is drawn at `t` where a warp has carried the fields, as closed
    /// polygons in the plane: outer ones counter-clockwise, holes clockwise.
    /// Between samples of the grid the blend is taken as bilinear, and what no
    /// face covers as outside. What moves out of the grid is followed for half
    /// its longer side.
    ///
    /// # Panics
    /// Where a face of the placement has a vertex without a place.
    #[must_use]
    pub fn contour_carried(&self, placement: &Placement, t: f64) -> Vec<Vec<DVec2>> {
        let (grid, blend) = (self.grid(), &self.blend);
        let level = blend.level();
        // Samples are relative to the level, so that single precision is
        // finest where the contour runs.
        let outside = (blend.curve(OUTSIDE + blend.threshold.min(0.0)) - level) as f32;
        // The grid grows by the same number on all sides: a shift is all that
        // tells the two apart.
        let more = self.cells_beyond(placement);
        let [width, height] = [grid.width, grid.height].map(|n| n + 2 * more);
        let shift = DVec2::splat(f64::from(more));
        let mut samples = vec![outside; width as usize * height as usize];
        let (source, target) = (self.source.samples(), self.target.samples());
        scan(
            placement,
            |p| grid.lattice_from_plane(p) + shift,
            width as usize,
            &mut samples,
            |facet| {
                let (to_source, to_target) = (facet.source, facet.target);
                move |x, y, samples: &mut [f32]| {
                    for (x, sample) in (x..).zip(samples) {
                        let places = [to_source.at(x, y), to_target.at(x, y)];
                        let [a, b] = places.map(|p| grid.lattice_from_plane(p));
                        let (f0, f1) = (source.bilinear(a.x, a.y), target.bilinear(b.x, b.y));
                        *sample = (blend.value(f0, f1, t) - level) as f32;
                    }
                }
            },
        );
        // Never so: a grid has a cell at least, and there are as many samples.
        let Ok(samples) = SampledField::new(width, height, &samples) else {
            return Vec::new();
        };
        let mut rings = contour::trace_samples(&samples, 0.0);
        for p in rings.iter_mut().flatten() {
            *p = grid.plane_from_lattice(*p - shift);
        }
        rings
    }

    /// By how many cells a placement reaches beyond the grid, on any side.
    fn cells_beyond(&self, placement: &Placement) -> u32 {
        let grid = self.grid();
        let bounds = grid.bounds();
        // What neither field knows is outside, wherever it goes.
        let looks = placement.in_source.iter().zip(&placement.in_target);
        let known = placement.in_frame.iter().zip(looks);
        let known = known.filter(|(_, (a, b))| bounds.contains(**a) || bounds.contains(**b));
        let Some(reach) = Bounds::of(known.map(|(p, _)| *p)) else {
            return 0;
        };
        let beyond = (bounds.min - reach.min).max(reach.max - bounds.max);
        let cells = (beyond.max_element() / grid.cell).ceil();
        let most = BEYOND * f64::from(grid.width.max(grid.height));
        // NaN and less than nothing count as nothing.
        if cells > 0.0 {
            cells.min(most) as u32
        } else {
            0
        }
    }
}

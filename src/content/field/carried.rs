//! Contours of distance fields carried by a warp.
//!
//! At each sample of the frame's grid, the placement gives the corresponding point of the source
//! and of the target. The fields are read at those two points and blended as usual. The values read
//! this way are no longer exact distances in the frame; L is applied to them unchanged.

use super::super::placement_scan::scan;
use super::FieldPair;
use crate::field::{SampledField, contour};
use crate::geometry::{Bounds, DVec2};
use crate::warp::Placement;

/// Distance, in cells, of samples that no face of the placement covers: outside (heuristic: as
/// deep as a sample next to a boundary).
const UNCOVERED_DISTANCE: f64 = -1.0;

/// Maximum extension of the sampled area beyond the fields' grid on each side, as a fraction of its
/// longer side (resource limit: a square grid then has four times as many samples).
const MAX_EXTENSION: f64 = 0.5;

impl FieldPair {
    /// Returns the contour at `t` of the fields carried by `placement`, as closed polygons in the
    /// plane: outer ones counter-clockwise, holes clockwise.
    ///
    /// Between samples the blend is interpolated bilinearly. Area that no face covers is outside.
    /// Shapes that leave the grid are followed for up to half its longer side.
    ///
    /// # Panics
    /// Panics if a face of the placement has a vertex without a position.
    #[must_use]
    pub fn contour_carried(&self, placement: &Placement, t: f64) -> Vec<Vec<DVec2>> {
        let (grid, blend) = (self.grid(), &self.blend);
        let level = blend.level();
        // Samples are stored relative to the level, so that single precision is finest near the
        // contour.
        let outside = (blend.curve(UNCOVERED_DISTANCE + blend.threshold.min(0.0)) - level) as f32;
        // The extended grid has the same margin on all sides, so the two lattices differ by a shift
        // only.
        let margin_cells = self.cells_beyond(placement);
        let [width, height] = [grid.width, grid.height].map(|n| n + 2 * margin_cells);
        let shift = DVec2::splat(f64::from(margin_cells));
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
        // Unreachable: the lattice has at least one cell, and as many samples as cells.
        let Ok(samples) = SampledField::new(width, height, &samples) else {
            return Vec::new();
        };
        let mut rings = contour::trace_samples(&samples, 0.0);
        for p in rings.iter_mut().flatten() {
            *p = grid.plane_from_lattice(*p - shift);
        }
        rings
    }

    /// Number of cells by which shapes in `placement` reach beyond the grid, the maximum over all
    /// sides.
    fn cells_beyond(&self, placement: &Placement) -> u32 {
        let grid = self.grid();
        let bounds = grid.bounds();
        // Vertices outside the grid in both designs are outside both fields, wherever they move.
        let design_points = placement.in_source.iter().zip(&placement.in_target);
        let in_fields = placement
            .in_frame
            .iter()
            .zip(design_points)
            .filter(|(_, (a, b))| bounds.contains(**a) || bounds.contains(**b));
        let Some(reach) = Bounds::of(in_fields.map(|(p, _)| *p)) else {
            return 0;
        };
        let beyond = (bounds.min - reach.min).max(reach.max - bounds.max);
        let cells = (beyond.max_element() / grid.cell).ceil();
        let max_cells = MAX_EXTENSION * f64::from(grid.width.max(grid.height));
        // NaN and negative values become 0.
        if cells > 0.0 {
            cells.min(max_cells) as u32
        } else {
            0
        }
    }
}

//! Contours of the blend of two distance fields that a warp carries along.
//!
//! For each sample of a grid in the frame, the placement gives the corresponding point of the
//! source and of the target. The two fields are read at these points and blended as usual. In the
//! frame these values are no longer exact distances; the scale function L is applied to them all
//! the same.

use super::super::placement_scan::scan;
use super::FieldPair;
use crate::field::{SampledField, contour};
use crate::geometry::{Bounds, DVec2};
use crate::warp::Placement;

/// Distance, in cells, at samples that no face of the placement covers (derived: outside, as deep
/// as a sample next to a boundary).
const UNCOVERED_DISTANCE: f64 = -1.0;

/// Maximum margin by which the sampled rectangle extends beyond the fields' grid on each side, as a
/// fraction of the grid's longer side (resource limit: a square grid then has four times as many
/// samples).
const MAX_EXTENSION: f64 = 0.5;

impl FieldPair {
    /// Returns the contour at `t` of the blend of both fields, carried along by `placement`, as
    /// closed polygons in the plane. Outer polygons run counter-clockwise, holes clockwise.
    ///
    /// Between samples the blend is interpolated bilinearly. Regions that no face covers are
    /// outside. A shape that leaves the grid is drawn up to a distance of half the grid's longer
    /// side.
    ///
    /// # Panics
    /// Panics if a face of the placement has a vertex without a position.
    #[must_use]
    pub fn contour_carried(&self, placement: &Placement, t: f64) -> Vec<Vec<DVec2>> {
        let (grid, blend) = (self.grid(), &self.blend);
        let level = blend.level();
        // Samples are stored relative to `level`, the blend's value on the contour, because single
        // precision is finest near 0.
        let outside = (blend.curve(UNCOVERED_DISTANCE + blend.threshold.min(0.0)) - level) as f32;
        // The extended grid has the same margin on all sides, so its sample coordinates differ from
        // those of the fields' grid by a shift only.
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
        // This error cannot occur: the grid has at least one cell, and as many samples as cells.
        let Ok(samples) = SampledField::new(width, height, &samples) else {
            return Vec::new();
        };
        let mut rings = contour::trace_samples(&samples, 0.0);
        for p in rings.iter_mut().flatten() {
            *p = grid.plane_from_lattice(*p - shift);
        }
        rings
    }

    /// Returns by how many cells the shapes in `placement` extend beyond the grid, at the side
    /// where they extend farthest. The result is limited to [`MAX_EXTENSION`] times the grid's
    /// longer side.
    fn cells_beyond(&self, placement: &Placement) -> u32 {
        let grid = self.grid();
        let bounds = grid.bounds();
        // A vertex that lies outside the grid in both designs belongs to neither field's shape,
        // wherever it moves.
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

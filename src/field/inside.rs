//! Which samples of a grid are inside a set of polygons, by scanline winding.
//!
//! Guarantees: the same half-open rule as `Ring::winding`, so that edges that
//! meet in a row are counted once. A sample within rounding of an edge may go
//! either way.

use rayon::prelude::*;

use super::Grid;
use crate::geometry::{DVec2, Regions};

/// An edge on the lattice of samples.
pub(super) type ScanlineEdge = (DVec2, DVec2);

/// All edges of `regions` on the lattice of `grid`.
pub(super) fn edges(regions: &Regions, grid: &Grid) -> Vec<ScanlineEdge> {
    let place = |p| grid.lattice_from_plane(p);
    regions
        .rings()
        .flat_map(|ring| ring.edges())
        .map(|(a, b)| (place(a), place(b)))
        .collect()
}

/// Samples with non-zero winding, row-major.
pub(super) fn inside(edges: &[ScanlineEdge], grid: &Grid) -> Vec<bool> {
    let mut steps = vec![0_i32; grid.cells()];
    for &(a, b) in edges {
        // Windings: +1 to the right of an edge that rises, −1 of one that
        // falls.
        if a.y <= b.y {
            cross(a, b, 1, grid, &mut steps);
        } else {
            cross(b, a, -1, grid, &mut steps);
        }
    }
    let width = grid.width as usize;
    let mut bits = vec![false; steps.len()];
    bits.par_chunks_mut(width)
        .zip(steps.par_chunks(width))
        .for_each(|(bits, steps)| {
            // Steps add up along the row: each edge is written once a row, not
            // once a sample.
            let mut winding = 0;
            for (bit, step) in bits.iter_mut().zip(steps) {
                winding += step;
                *bit = winding != 0;
            }
        });
    bits
}

/// Adds `step` to the first sample to the right of an upward edge, in each row
/// that it crosses.
fn cross(low: DVec2, high: DVec2, step: i32, grid: &Grid, steps: &mut [i32]) {
    // `as` saturates, which is what edges outside the grid need.
    let row = |y: f64| (y.ceil() as usize).min(grid.height as usize);
    // A level edge has no slope, and no row to need it in.
    let slope = (high.x - low.x) / (high.y - low.y);
    for y in row(low.y)..row(high.y) {
        let x = low.x + (y as f64 - low.y) * slope;
        let column = x.ceil() as usize;
        if column < grid.width as usize {
            steps[y * grid.width as usize + column] += step;
        }
    }
}

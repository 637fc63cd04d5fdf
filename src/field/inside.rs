//! Determines which grid samples are inside a set of polygons, by scanline winding numbers.
//!
//! Guaranteed: whether a row of samples crosses an edge is decided by the half-open rule of
//! `Ring::winding`, so a boundary that crosses a row exactly at a corner is counted once. Not
//! guaranteed: a sample whose distance from an edge is within rounding errors may be classified
//! either way.

use rayon::prelude::*;

use super::Grid;
use crate::geometry::{DVec2, Regions};

/// Start and end of an edge in lattice coordinates.
pub(super) type ScanlineEdge = (DVec2, DVec2);

/// Returns all edges of `regions` in the lattice coordinates of `grid`.
pub(super) fn lattice_edges(regions: &Regions, grid: &Grid) -> Vec<ScanlineEdge> {
    let place = |p| grid.lattice_from_plane(p);
    regions
        .rings()
        .flat_map(|ring| ring.edges())
        .map(|(a, b)| (place(a), place(b)))
        .collect()
}

/// Returns for each sample whether its winding number is not zero, in row-major order.
pub(super) fn inside_samples(edges: &[ScanlineEdge], grid: &Grid) -> Vec<bool> {
    let mut steps = vec![0_i32; grid.cells()];
    for &(a, b) in edges {
        // Counts +1 for the samples to the right of a rising edge and −1 for those to the right of
        // a falling one. The sum is minus the winding number; its sign does not matter here.
        if a.y <= b.y {
            add_crossings(a, b, 1, grid, &mut steps);
        } else {
            add_crossings(b, a, -1, grid, &mut steps);
        }
    }
    let width = grid.width as usize;
    let mut bits = vec![false; steps.len()];
    bits.par_chunks_mut(width)
        .zip(steps.par_chunks(width))
        .for_each(|(bits, steps)| {
            // Prefix sums along the row: each edge was added once per row instead of once per
            // sample.
            let mut winding = 0;
            for (bit, step) in bits.iter_mut().zip(steps) {
                winding += step;
                *bit = winding != 0;
            }
        });
    bits
}

/// In each row that the upward edge from `low` to `high` crosses, adds `step` to the entry of the
/// first sample on or to the right of the edge.
fn add_crossings(low: DVec2, high: DVec2, step: i32, grid: &Grid, steps: &mut [i32]) {
    // `as` turns negative numbers into 0, so an edge that begins below the grid starts at row 0.
    let row = |y: f64| (y.ceil() as usize).min(grid.height as usize);
    // A horizontal edge has an infinite slope, but crosses no row.
    let slope = (high.x - low.x) / (high.y - low.y);
    for y in row(low.y)..row(high.y) {
        let x = low.x + (y as f64 - low.y) * slope;
        let column = x.ceil() as usize;
        if column < grid.width as usize {
            steps[y * grid.width as usize + column] += step;
        }
    }
}

//! A smooth function on the pixels of a square tile, from its values at few
//! places.
//!
//! Interpolation by polynomials at Chebyshev points of the first kind, row by
//! row and column by column, with Lagrange's polynomials in barycentric form
//! (Berrut, Trefethen, "Barycentric Lagrange interpolation", 2004, §5).
//!
//! Guaranteed: polynomials of a degree below [`NODES`] in each direction come
//! out to rounding; others with the error that Chebyshev points have, which
//! for a function whose singularities, seen from the middle, are at least r
//! half sides away along an axis is of the order (r + √(r² − 1))^−NODES.

use pulp::{Arch, Simd, WithSimd};
use std::f64::consts::PI;

/// Pixels along the side of a tile.
pub(super) const TILE: usize = 32;

/// Places along the side of a tile.
pub(super) const NODES: usize = 12;

/// Values at the nodes, row by row.
pub(super) type AtNodes = [[f64; NODES]; NODES];

/// Values at the pixels, row by row.
pub(super) type OnTile = [[f64; TILE]; TILE];

/// Lagrange's polynomials of the nodes at the pixels.
#[derive(Clone, Debug)]
pub(super) struct Interpolation {
    /// Where the nodes are: 0 is the first pixel's centre, 1 the second's.
    pub(super) nodes: [f64; NODES],
    /// Of pixel p and node k, at [p][k].
    at_pixels: [[f64; NODES]; TILE],
    /// The same at [k][p].
    of_nodes: [[f64; TILE]; NODES],
}

impl Interpolation {
    pub(super) fn new() -> Self {
        let angles: [f64; NODES] = std::array::from_fn(|k| (k as f64 + 0.5) * PI / NODES as f64);
        let half = 0.5 * (TILE - 1) as f64;
        let nodes = angles.map(|angle| half * (1.0 - angle.cos()));
        let at_pixels: [_; TILE] = std::array::from_fn(|p| lagrange(&nodes, &angles, p as f64));
        Self {
            nodes,
            of_nodes: std::array::from_fn(|k| at_pixels.map(|of_nodes| of_nodes[k])),
            at_pixels,
        }
    }

    /// Values at the pixels, from values at the nodes.
    pub(super) fn spread(&self, arch: Arch, values: &AtNodes, tile: &mut OnTile) {
        arch.dispatch(Spread(self, values, tile));
    }
}

/// Lagrange's polynomial of each node, at `x`.
fn lagrange(nodes: &[f64; NODES], angles: &[f64; NODES], x: f64) -> [f64; NODES] {
    if let Some(at) = nodes.iter().position(|&node| node == x) {
        return std::array::from_fn(|k| f64::from(u8::from(k == at)));
    }
    let share = |k: usize| {
        let sign = if k.is_multiple_of(2) { 1.0 } else { -1.0 };
        sign * angles[k].sin() / (x - nodes[k])
    };
    let shares: [f64; NODES] = std::array::from_fn(share);
    let sum: f64 = shares.iter().sum();
    shares.map(|share| share / sum)
}

/// The work, to be compiled for several widths of vectors.
struct Spread<'a>(&'a Interpolation, &'a AtNodes, &'a mut OnTile);

impl WithSimd for Spread<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Self(interpolation, values, tile) = self;
        let mut along_rows = [[0.0; TILE]; NODES];
        for (row, values) in along_rows.iter_mut().zip(values) {
            *row = combine(values, &interpolation.of_nodes);
        }
        for (row, of_nodes) in tile.iter_mut().zip(&interpolation.at_pixels) {
            *row = combine(of_nodes, &along_rows);
        }
    }
}

/// Σ factor · row.
#[inline(always)]
fn combine(factors: &[f64; NODES], rows: &[[f64; TILE]; NODES]) -> [f64; TILE] {
    let mut sum = [0.0; TILE];
    for (factor, row) in factors.iter().zip(rows) {
        for (sum, value) in sum.iter_mut().zip(row) {
            *sum += factor * value;
        }
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Values of a function of the pixel.
    fn interpolated(f: impl Fn(f64, f64) -> f64) -> OnTile {
        let interpolation = Interpolation::new();
        let nodes = interpolation.nodes;
        let values = nodes.map(|y| nodes.map(|x| f(x, y)));
        let mut tile = [[0.0; TILE]; TILE];
        interpolation.spread(Arch::new(), &values, &mut tile);
        tile
    }

    fn worst(tile: &OnTile, f: impl Fn(f64, f64) -> f64) -> f64 {
        let pixels = (0..TILE * TILE).map(|i| (i % TILE, i / TILE));
        let error = |(x, y): (usize, usize)| (tile[y][x] - f(x as f64, y as f64)).abs();
        pixels.map(error).fold(0.0, f64::max)
    }

    #[test]
    fn polynomials_come_out() {
        let f = |x: f64, y: f64| (x / 16.0 - 1.0).powi(11) - 2.0 * (y / 16.0 - 1.0).powi(10) + x;
        assert!(worst(&interpolated(f), f) < 1e-12);
    }

    #[test]
    fn a_pole_outside_leaves_the_error_that_is_stated() {
        // Four half sides from the middle.
        let f = |x: f64, _: f64| 1.0 / (x + 3.0 * 15.5);
        let r: f64 = 4.0;
        let expected = (r + (r * r - 1.0).sqrt()).powi(-(NODES as i32)) / 46.5;
        let error = worst(&interpolated(f), f);
        assert!(error < 4.0 * expected + 1e-17, "{error:e}");
    }
}

//! Pictures: the map of all pixels, tile by tile.
//!
//! Far from a line, its weight and displacement are smooth, so that of most
//! lines a tile needs no more than their sums at a few nodes, from which the
//! pixels' are interpolated. What is near is summed pixel by pixel.
//!
//! Guaranteed: the same as place by place, to 1e-12 of the displacements.

use super::bundle::{Bundle, block_of};
use super::interpolation::{Interpolation, NODES, OnTile, TILE};
use super::kernel::{BLOCK, Row, Sums};
use super::line::Line;
use crate::geometry::DVec2;
use rayon::prelude::*;

/// How far a line that counts as far is at least from the middle of a tile, in
/// half diagonals of the tile, for b up to 2. A function of the distance r has
/// its singularities where r = 0, also for complex places, which on the
/// outermost rows of the tile is 6.1 half sides from the middle: 12⁻¹² is
/// below 1e-12.
const FAR: f64 = 5.0;

/// What is added to it for each unit of b beyond, where weights fall so
/// fast that the error would grow tenfold a unit. On forty lines it is greatest
/// at b = 2: 3e-13 of the displacements.
const FARTHER: f64 = 1.0;

/// Interpolation pays from so many far lines on.
const ENOUGH: usize = 8;

/// Rows of a tile in a block.
const ROWS: usize = BLOCK / TILE;

/// The places of a picture's pixels, row by row.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Raster {
    /// The place of the first: the centre of a pixel in a corner.
    pub origin: DVec2,
    /// From there to the next in the row, and to the next row: (1, −1) for
    /// pictures that are read from above.
    pub step: DVec2,
    /// How many there are in a row; none counts as one.
    pub columns: usize,
}

impl Raster {
    /// The place of pixel `index`, counted row by row.
    #[must_use]
    pub fn place(&self, index: usize) -> DVec2 {
        let columns = self.columns.max(1);
        self.place_of((index % columns) as f64, (index / columns) as f64)
    }

    fn place_of(&self, column: f64, row: f64) -> DVec2 {
        self.origin + self.step * DVec2::new(column, row)
    }
}

/// A tile of the picture, perhaps cut off at its end.
#[derive(Clone, Copy)]
struct Tile {
    /// Of its first pixel, in the picture and in its band.
    column: usize,
    row: usize,
    /// Pixels that are in the picture.
    width: usize,
    height: usize,
}

/// Memory to work in, for a thread.
struct Scratch {
    /// Lines near to the tile.
    near: Vec<Line<1>>,
    /// Lines far from the tile.
    far: Vec<Line<1>>,
    /// Σ w and Σ w D, x and y, of far lines on the tile.
    on_tile: [OnTile; 3],
    /// Sums of the rows at hand.
    sums: Sums<1>,
}

impl Scratch {
    fn new() -> Self {
        Self {
            near: Vec::new(),
            far: Vec::new(),
            on_tile: [[[0.0; TILE]; TILE]; 3],
            sums: Sums::ZERO,
        }
    }
}

/// A bundle and a picture.
pub(super) struct Painter<'a> {
    bundle: &'a Bundle<1>,
    raster: Raster,
    interpolation: Interpolation,
}

impl<'a> Painter<'a> {
    pub(super) fn new(bundle: &'a Bundle<1>, raster: &Raster) -> Self {
        let columns = raster.columns.max(1);
        Self {
            bundle,
            raster: Raster { columns, ..*raster },
            interpolation: Interpolation::new(),
        }
    }

    /// Where each pixel is, as many as there is room for in both slices, which
    /// have one length; on all threads, band by band.
    pub(super) fn paint(&self, out_x: &mut [f64], out_y: &mut [f64]) {
        let band = TILE.saturating_mul(self.raster.columns);
        let bands = out_x.par_chunks_mut(band).zip(out_y.par_chunks_mut(band));
        bands
            .enumerate()
            .for_each_init(Scratch::new, |scratch, (band, (out_x, out_y))| {
                self.paint_band(band * TILE, scratch, [out_x, out_y]);
            });
    }

    /// The band that begins with a row.
    fn paint_band(&self, row: usize, scratch: &mut Scratch, mut out: [&mut [f64]; 2]) {
        let columns = self.raster.columns;
        let height = out[0].len().div_ceil(columns);
        for column in (0..columns.min(out[0].len())).step_by(TILE) {
            let tile = Tile {
                column,
                row,
                width: TILE.min(columns - column),
                height,
            };
            self.sort(tile, scratch);
            self.sum_far(tile, scratch);
            for first in (0..height).step_by(ROWS) {
                self.paint_rows(tile, first, scratch, &mut out);
            }
        }
    }

    /// Tells near lines from far ones.
    fn sort(&self, tile: Tile, scratch: &mut Scratch) {
        let Scratch { near, far, .. } = scratch;
        let place = |at: f64| self.place(tile, at, at);
        let last = (TILE - 1) as f64;
        let [low, middle, high] = [0.0, 0.5 * last, last].map(|at| self.bundle.scaled(place(at)));
        let radius = 0.5 * low.distance(high);
        let far_from = FAR + FARTHER * (self.bundle.falloff() - 2.0).max(0.0);
        let is_far = |line: &Line<1>| line.is_far(middle, radius, far_from * radius);
        near.clear();
        far.clear();
        for line in self.bundle.lines() {
            if is_far(line) {
                far.push(*line);
            } else {
                near.push(*line);
            }
        }
        if far.len() < ENOUGH {
            near.append(far);
        }
    }

    /// The place at a column and a row of a tile.
    fn place(&self, tile: Tile, column: f64, row: f64) -> DVec2 {
        let (first_column, first_row) = (tile.column as f64, tile.row as f64);
        self.raster.place_of(first_column + column, first_row + row)
    }

    /// The sums of far lines on a tile.
    fn sum_far(&self, tile: Tile, scratch: &mut Scratch) {
        let Scratch {
            far, on_tile, sums, ..
        } = scratch;
        if far.is_empty() {
            on_tile.as_flattened_mut().as_flattened_mut().fill(0.0);
            return;
        }
        let nodes = &self.interpolation.nodes;
        let mut values = [[[0.0; NODES]; NODES]; 3];
        for start in (0..NODES * NODES).step_by(BLOCK) {
            let count = BLOCK.min(NODES * NODES - start);
            let places = block_of(|lane| {
                let node = start + lane.min(count - 1);
                self.place(tile, nodes[node % NODES], nodes[node / NODES])
            });
            *sums = Sums::ZERO;
            self.bundle.add(far, &places, count, sums);
            let [[dx, dy]] = &sums.moved;
            for (values, sums) in values.iter_mut().zip([&sums.weight, dx, dy]) {
                let values = values.as_flattened_mut();
                values[start..start + count].copy_from_slice(&sums[..count]);
            }
        }
        for (values, tile) in values.iter().zip(on_tile) {
            self.interpolation.spread(self.bundle.arch, values, tile);
        }
    }

    /// The places of as many rows of a tile as a block has.
    fn rows(&self, tile: Tile, first: usize) -> [Row; 2] {
        let columns: [f64; TILE] = std::array::from_fn(|k| self.place(tile, k as f64, 0.0).x);
        let [mut x, mut y] = [[0.0; BLOCK]; 2];
        let rows = x.chunks_mut(TILE).zip(y.chunks_mut(TILE));
        for (row, (x, y)) in rows.enumerate() {
            x.copy_from_slice(&columns);
            y.fill(self.place(tile, 0.0, (first + row) as f64).y);
        }
        [x, y]
    }

    /// Maps as many rows of a tile as a block has.
    fn paint_rows(
        &self,
        tile: Tile,
        first: usize,
        scratch: &mut Scratch,
        out: &mut [&mut [f64]; 2],
    ) {
        let Scratch {
            near,
            on_tile,
            sums,
            ..
        } = scratch;
        let [[x, y]] = &mut sums.moved;
        for (sums, tile) in [&mut sums.weight, x, y].into_iter().zip(&*on_tile) {
            let rows = tile[first..].as_flattened();
            sums.copy_from_slice(&rows[..BLOCK]);
        }
        let places = self.rows(tile, first);
        self.bundle.add(near, &places, BLOCK, sums);
        let [moved] = self.bundle.means(sums);
        for row in 0..ROWS.min(tile.height - first) {
            let start = (first + row) * self.raster.columns + tile.column;
            let lanes = row * TILE..row * TILE + tile.width;
            for (out, (places, moved)) in out.iter_mut().zip(places.iter().zip(&moved)) {
                let Some(out) = out.get_mut(start..) else {
                    continue;
                };
                let found = places[lanes.clone()].iter().zip(&moved[lanes.clone()]);
                for (out, (place, by)) in out.iter_mut().zip(found) {
                    *out = place + by;
                }
            }
        }
    }
}

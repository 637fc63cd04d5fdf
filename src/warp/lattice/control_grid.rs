//! Control points of a lattice, most of which are zero.
//!
//! They are kept in blocks of 8 × 8, of which only those are made that a
//! feature touches: fine layers stay small.

use crate::geometry::DVec2;

/// Control points along a block's side: 2 to this power.
const SHIFT: usize = 3;
const SIDE: usize = 1 << SHIFT;

/// Control points, in blocks.
#[derive(Clone, Debug, Default)]
pub(super) struct ControlGrid {
    /// Blocks from left to right.
    columns: usize,
    /// The number of each block, from 1; 0 where there is none.
    directory: Vec<u32>,
    /// Which entries of the directory are not 0.
    made: Vec<usize>,
    blocks: Vec<ControlBlock>,
}

#[derive(Clone, Debug)]
struct ControlBlock {
    /// Sums of what was asked for, then the displacements.
    controls: [[DVec2; SIDE]; SIDE],
    weights: [[f64; SIDE]; SIDE],
}

impl ControlBlock {
    const EMPTY: Self = Self {
        controls: [[DVec2::ZERO; SIDE]; SIDE],
        weights: [[0.0; SIDE]; SIDE],
    };
}

impl ControlGrid {
    /// Room for so many columns and rows of control points, all of them zero.
    pub(super) fn reset(&mut self, size: [usize; 2]) {
        // Only what was made is undone: the directory of a fine layer is long.
        for entry in self.made.drain(..) {
            self.directory[entry] = 0;
        }
        self.blocks.clear();
        let [columns, rows] = size.map(|points| points.div_ceil(SIDE));
        self.columns = columns;
        self.directory.resize(columns * rows, 0);
    }

    /// Columns and rows of control points that there is room for.
    #[inline(always)]
    pub(super) fn size(&self) -> [usize; 2] {
        let rows = self.directory.len() / self.columns.max(1);
        [self.columns * SIDE, rows * SIDE]
    }

    /// Adds to the sums of the control point in a column and a row.
    pub(super) fn ask(&mut self, [column, row]: [usize; 2], asked: DVec2, weight: f64) {
        let block = self.block(column >> SHIFT, row >> SHIFT);
        block.controls[row % SIDE][column % SIDE] += asked;
        block.weights[row % SIDE][column % SIDE] += weight;
    }

    fn block(&mut self, column: usize, row: usize) -> &mut ControlBlock {
        let entry = row * self.columns + column;
        if self.directory[entry] == 0 {
            self.blocks.push(ControlBlock::EMPTY);
            self.made.push(entry);
            self.directory[entry] = self.blocks.len() as u32;
        }
        &mut self.blocks[self.directory[entry] as usize - 1]
    }

    /// Makes means of sums, each coordinate within ±`most`.
    pub(super) fn divide(&mut self, most: f64) {
        for block in &mut self.blocks {
            let rows = block.controls.iter_mut().zip(&block.weights);
            for (control, &weight) in rows.flat_map(|(c, w)| c.iter_mut().zip(w)) {
                if weight > 0.0 {
                    *control = (*control / weight).clamp(DVec2::splat(-most), DVec2::splat(most));
                }
            }
        }
    }

    /// Σ control point · basis, by columns and rows.
    #[inline(always)]
    pub(super) fn sum(&self, [i0, j0]: [usize; 2], bx: &[f64; 4], by: &[f64; 4]) -> DVec2 {
        let number =
            |i: usize, j: usize| self.directory[(j >> SHIFT) * self.columns + (i >> SHIFT)];
        // Four by four controls reach into the blocks of their corners, no others.
        let corners = [(0, 0), (3, 0), (0, 3), (3, 3)].map(|(i, j)| number(i0 + i, j0 + j));
        // Most of a fine layer is empty, and most places leave here.
        if corners == [0; 4] {
            return DVec2::ZERO;
        }
        let block = |corner: usize| {
            let number = (corners[corner] as usize).checked_sub(1)?;
            Some(&self.blocks[number].controls)
        };
        // So many of the four columns are in the left blocks.
        let (i, split) = (i0 % SIDE, (SIDE - i0 % SIDE).min(4));
        let (left, right) = bx.split_at(split);
        let dot = |controls: &[DVec2], basis: &[f64]| -> DVec2 {
            controls.iter().zip(basis).map(|(&c, &b)| c * b).sum()
        };
        let mut sum = DVec2::ZERO;
        for (j, &by) in (j0..).zip(by) {
            let half = if j >> SHIFT == j0 >> SHIFT { 0 } else { 2 };
            if let Some(controls) = block(half) {
                sum += dot(&controls[j % SIDE][i..], left) * by;
            }
            if let (false, Some(controls)) = (right.is_empty(), block(half + 1)) {
                sum += dot(&controls[j % SIDE], right) * by;
            }
        }
        sum
    }
}

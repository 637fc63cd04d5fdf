//! Sparse storage of a lattice's control points.
//!
//! Most control points are zero. They are stored in blocks of 8 × 8, and only blocks touched by a
//! feature are allocated, so that fine layers stay small.

use crate::geometry::DVec2;

/// Binary logarithm of [`SIDE`].
const SHIFT: usize = 3;
/// Number of control points along the side of a block (derived: at least 4, so that a 4 × 4
/// stencil touches at most four blocks).
const SIDE: usize = 1 << SHIFT;

/// Grid of control points, stored in blocks that are allocated only where a feature needs them.
#[derive(Clone, Debug, Default)]
pub(super) struct ControlGrid {
    /// Number of blocks in a row of blocks.
    columns: usize,
    /// For each block, row by row: its index in `blocks` plus 1, or 0 if it is not allocated.
    directory: Vec<u32>,
    /// Indices of the nonzero entries of `directory`.
    occupied: Vec<usize>,
    blocks: Vec<ControlBlock>,
}

/// Block of 8 × 8 control points, indexed by row and then column.
#[derive(Clone, Debug)]
struct ControlBlock {
    /// For each control point, the weighted sum of the displacements that features request for it;
    /// after [`ControlGrid::divide`], the displacement of the control point.
    controls: [[DVec2; SIDE]; SIDE],
    /// For each control point, the sum of the weights of the displacements that features request
    /// for it.
    weights: [[f64; SIDE]; SIDE],
}

impl ControlBlock {
    /// Block of zeros.
    const EMPTY: Self = Self {
        controls: [[DVec2::ZERO; SIDE]; SIDE],
        weights: [[0.0; SIDE]; SIDE],
    };
}

impl ControlGrid {
    /// Resizes the grid to `[columns, rows]` control points and sets all of them to zero.
    pub(super) fn reset(&mut self, size: [usize; 2]) {
        // `directory` has an entry for every block of the grid. On a fine grid these are many, and
        // nearly all are 0, so only the nonzero ones are reset.
        for entry in self.occupied.drain(..) {
            self.directory[entry] = 0;
        }
        self.blocks.clear();
        let [columns, rows] = size.map(|points| points.div_ceil(SIDE));
        self.columns = columns;
        self.directory.resize(columns * rows, 0);
    }

    /// Returns the number of columns and rows of control points, rounded up to whole blocks.
    #[inline(always)]
    pub(super) fn size(&self) -> [usize; 2] {
        let rows = self.directory.len() / self.columns.max(1);
        [self.columns * SIDE, rows * SIDE]
    }

    /// Adds a weighted displacement and its weight to the sums of one control point.
    pub(super) fn add(&mut self, [column, row]: [usize; 2], weighted: DVec2, weight: f64) {
        let block = self.block(column >> SHIFT, row >> SHIFT);
        block.controls[row % SIDE][column % SIDE] += weighted;
        block.weights[row % SIDE][column % SIDE] += weight;
    }

    /// Returns the block in the given column and row of blocks. Allocates the block if it does not
    /// exist yet.
    fn block(&mut self, column: usize, row: usize) -> &mut ControlBlock {
        let entry = row * self.columns + column;
        if self.directory[entry] == 0 {
            self.blocks.push(ControlBlock::EMPTY);
            self.occupied.push(entry);
            self.directory[entry] = self.blocks.len() as u32;
        }
        &mut self.blocks[self.directory[entry] as usize - 1]
    }

    /// Replaces the sum at each control point by the weighted mean of the displacements that
    /// features request for it. Each coordinate of the mean is clamped to ±`bound`.
    pub(super) fn divide(&mut self, bound: f64) {
        for block in &mut self.blocks {
            let rows = block.controls.iter_mut().zip(&block.weights);
            for (control, &weight) in rows.flat_map(|(c, w)| c.iter_mut().zip(w)) {
                if weight > 0.0 {
                    *control = (*control / weight).clamp(DVec2::splat(-bound), DVec2::splat(bound));
                }
            }
        }
    }

    /// Evaluates Σ bx[i] by[j] · control point (i0 + i, j0 + j) over the 4 × 4 stencil.
    #[inline(always)]
    pub(super) fn sum(&self, [i0, j0]: [usize; 2], bx: &[f64; 4], by: &[f64; 4]) -> DVec2 {
        let number =
            |i: usize, j: usize| self.directory[(j >> SHIFT) * self.columns + (i >> SHIFT)];
        // The stencil overlaps only the blocks that contain its four corners.
        let corners = [(0, 0), (3, 0), (0, 3), (3, 3)].map(|(i, j)| number(i0 + i, j0 + j));
        // Fast path: in fine layers most points lie in empty blocks.
        if corners == [0; 4] {
            return DVec2::ZERO;
        }
        let block = |corner: usize| {
            let number = (corners[corner] as usize).checked_sub(1)?;
            Some(&self.blocks[number].controls)
        };
        // The first `split` of the four columns lie in the left blocks, the others in the right
        // blocks.
        let (i, split) = (i0 % SIDE, (SIDE - i0 % SIDE).min(4));
        let (left, right) = bx.split_at(split);
        let dot = |controls: &[DVec2], basis: &[f64]| -> DVec2 {
            controls.iter().zip(basis).map(|(&c, &b)| c * b).sum()
        };
        let mut sum = DVec2::ZERO;
        for (j, &by) in (j0..).zip(by) {
            let left_corner = if j >> SHIFT == j0 >> SHIFT { 0 } else { 2 };
            if let Some(controls) = block(left_corner) {
                sum += dot(&controls[j % SIDE][i..], left) * by;
            }
            if let (false, Some(controls)) = (right.is_empty(), block(left_corner + 1)) {
                sum += dot(&controls[j % SIDE], right) * by;
            }
        }
        sum
    }
}

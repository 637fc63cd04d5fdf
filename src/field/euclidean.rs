//! Exact signed Euclidean distance transform in linear time.
//!
//! Makes two passes, as in Meijster, Roerdink and Hesselink 2000 and in Felzenszwalb and
//! Huttenlocher 2012: the first computes distances along each column, the second the lower envelope
//! of parabolas along each row.
//!
//! The same two passes compute the distances of inside and of outside cells, because a cell only
//! needs the nearest cell on the other side of the boundary. A row is divided into runs: maximal
//! sequences of cells that are all inside or all outside. The two cells that adjoin the ends of a
//! run are on the other side, and no cell in a column beyond them can be nearer to a cell of the
//! run. Each run therefore has its own envelope.
//!
//! Guaranteed: all squared distances are exact integers; only the final square root is rounded.

use rayon::prelude::*;
use std::sync::atomic::{AtomicUsize, Ordering};

use super::Mask;
use crate::work::progress::{Cancelled, Progress, checkpoint};

/// Number of columns in a strip, the unit of work of one thread in the first pass. Each strip is
/// one contiguous block of memory (resource limit: a strip of a 2048² mask fits into the
/// second-level cache, and one row of the strip takes two cache lines).
const STRIP: usize = 64;

/// Number of rows in a band, the unit of work of one thread in the second pass. Cancellation is
/// checked once per band (resource limit).
const BAND_ROWS: usize = 16;

/// Stored distance of a cell whose column has no cell on the other side of the boundary. Its square
/// exceeds every valid squared distance, and the sum of both fits in an `i32`.
const NONE: i16 = i16::MAX;

/// Computes the signed Euclidean distances of all cells of `mask` in row-major order.
pub(super) fn distances(mask: &Mask, progress: &dyn Progress) -> Result<Vec<f32>, Cancelled> {
    let strips = columns(mask);
    let (width, height) = (mask.width() as usize, mask.height() as usize);
    let done = AtomicUsize::new(0);
    let mut out = vec![0.0; mask.bits().len()];
    out.par_chunks_mut(width * BAND_ROWS)
        .enumerate()
        .try_for_each_init(
            || RowPass::new(width),
            |pass, (band, out)| {
                // Bands start in any order, so the reported fraction is computed from the number of
                // rows started.
                let rows_done = done.fetch_add(BAND_ROWS, Ordering::Relaxed);
                let fraction = rows_done as f64 / height as f64;
                checkpoint(progress, "measuring distances", fraction)?;
                for (i, out) in out.chunks_mut(width).enumerate() {
                    let y = band * BAND_ROWS + i;
                    pass.read(&strips, y, height);
                    pass.transform(&mask.bits()[y * width..][..width], out);
                }
                Ok(())
            },
        )?;
    Ok(out)
}

/// First pass: returns for each cell its distance, along its column, to the nearest cell on the
/// other side of the boundary, strip by strip; [`NONE`] if there is no such cell. The border of
/// outside cells around the mask counts, too.
fn columns(mask: &Mask) -> Vec<i16> {
    let (width, height) = (mask.width() as usize, mask.height() as usize);
    let strip_len = STRIP * height;
    let mut strips = vec![NONE; strip_len * width.div_ceil(STRIP)];
    let fill = |(strip, out): (usize, &mut [i16])| {
        let from = strip * STRIP;
        let to = width.min(from + STRIP);
        let row = |y: usize| &mask.bits()[y * width + from..y * width + to];
        sweep(out, (0..height).map(|y| (y, row(y))), |_, new| new);
        sweep(out, (0..height).rev().map(|y| (y, row(y))), i16::min);
    };
    (strips.par_chunks_mut(strip_len).enumerate()).for_each(fill);
    strips
}

/// Visits `rows` in the given order and counts, in each column of a strip, the cells since the
/// column last changed between inside and outside. Each column starts outside, in the border around
/// the mask. `merge` combines the stored distance with the new count.
fn sweep<'a>(
    strip: &mut [i16],
    rows: impl Iterator<Item = (usize, &'a [bool])>,
    merge: impl Fn(i16, i16) -> i16,
) {
    let mut counts = [NONE; STRIP];
    let mut previous_side = [0; STRIP];
    for (y, row) in rows {
        let out = &mut strip[y * STRIP..][..row.len()];
        let columns = out
            .iter_mut()
            .zip(row)
            .zip(&mut counts)
            .zip(&mut previous_side);
        for (((out, &inside), count), previous_side) in columns {
            // Branch-free, so that the compiler vectorises over columns.
            let side = -i16::from(inside); // all bits set if inside, none if outside
            *count = (*count & !(side ^ *previous_side)).saturating_add(1);
            *previous_side = side;
            *out = merge(*out, *count);
        }
    }
}

/// Section of a lower envelope: the parabola (x − `vertex`)² + `height`, which is the lowest one
/// from cell `start` to the start of the next section.
#[derive(Clone, Copy, Debug)]
struct ParabolaPiece {
    vertex: i32,
    height: i32,
    start: i32,
}

impl ParabolaPiece {
    fn at(&self, x: i32) -> i32 {
        (x - self.vertex) * (x - self.vertex) + self.height
    }
}

/// Buffers of the second pass, which transforms one row at a time.
struct RowPass {
    squares: Vec<i32>,
    envelope: Vec<ParabolaPiece>,
}

impl RowPass {
    fn new(width: usize) -> Self {
        Self {
            squares: vec![0; width.next_multiple_of(STRIP)],
            envelope: Vec::with_capacity(width + 2),
        }
    }

    /// Reads the squared column distances of row `y` from the strips.
    fn read(&mut self, strips: &[i16], y: usize, height: usize) {
        for (strip, out) in self.squares.chunks_exact_mut(STRIP).enumerate() {
            let row = &strips[(strip * height + y) * STRIP..][..STRIP];
            for (out, &d) in out.iter_mut().zip(row) {
                *out = i32::from(d) * i32::from(d);
            }
        }
    }

    /// Computes the signed distances of one row into `out`. `row` says for each of its cells
    /// whether it is inside.
    fn transform(&mut self, row: &[bool], out: &mut [f32]) {
        let mut from = 0;
        for run in row.chunk_by(|a, b| a == b) {
            let to = from + run.len();
            // The border of cells around the mask is outside. It therefore ends a run of inside
            // cells, but not a run of outside cells.
            let ends_left = from > 0 || run[0];
            let ends_right = to < row.len() || run[0];
            self.run(from, to, ends_left, ends_right);
            from = to;
        }
        let squares = &self.squares[..row.len()];
        for ((out, &square), &inside) in out.iter_mut().zip(squares).zip(row) {
            let distance = (f64::from(square).sqrt() - 0.5) as f32;
            *out = if inside { distance } else { -distance };
        }
    }

    /// Replaces the squared column distances of the run `from..to` by squared Euclidean distances.
    /// `ends_left` and `ends_right` say whether a cell on the other side of the boundary adjoins
    /// the run at that end.
    fn run(&mut self, from: usize, to: usize, ends_left: bool, ends_right: bool) {
        let (first, end) = (from as i32, to as i32);
        self.envelope.clear();
        if ends_left {
            self.push(first - 1, 0, first, end);
        }
        for x in from..to {
            self.push(x as i32, self.squares[x], first, end);
        }
        if ends_right {
            self.push(end, 0, first, end);
        }
        let mut end = to;
        for piece in self.envelope.iter().rev() {
            let start = piece.start as usize;
            for (i, out) in self.squares[start..end].iter_mut().enumerate() {
                *out = piece.at(piece.start + i as i32);
            }
            end = start;
        }
    }

    /// Adds a parabola to the envelope over the cells `first..end`. Its vertex must be to the right
    /// of all earlier vertices.
    fn push(&mut self, vertex: i32, height: i32, first: i32, end: i32) {
        let mut piece = ParabolaPiece {
            vertex,
            height,
            start: first,
        };
        while let Some(top) = self.envelope.last() {
            // All parabolas have the same curvature, and the new vertex is farther right. If the
            // new parabola is not above `top` where `top` starts, it is not above `top` anywhere
            // farther right, so it replaces `top`.
            if piece.at(top.start) > top.at(top.start) {
                piece.start = first_cell_below(top, &piece);
                break;
            }
            self.envelope.pop();
        }
        if piece.start < end {
            self.envelope.push(piece);
        }
    }
}

/// Returns the first cell where the parabola `right` is below the parabola `left`. In the cell
/// where `left` starts, it must be the lower one, so that the two cross at a non-negative position.
fn first_cell_below(left: &ParabolaPiece, right: &ParabolaPiece) -> i32 {
    let rise = right.vertex * right.vertex + right.height - left.vertex * left.vertex - left.height;
    let run = 2 * (right.vertex - left.vertex);
    (rise as u32 / run as u32) as i32 + 1
}

//! The exact signed Euclidean distance transform, in linear time.
//!
//! Two passes, as in Meijster, Roerdink and Hesselink 2000 and in Felzenszwalb
//! and Huttenlocher 2012: distances along each column, then the lower envelope
//! of parabolas along each row. Both signs come out of one sweep, because a
//! cell needs nothing but the nearest cell of the other side. And within a run
//! of cells of one side, nothing beyond the two cells that end it can be
//! nearer than they are, so that each run has an envelope of its own.
//!
//! All squares are integers and exact; only the last root is rounded.

use rayon::prelude::*;
use std::sync::atomic::{AtomicUsize, Ordering};

use super::Mask;
use crate::work::progress::{Cancelled, Progress, checkpoint};

/// Columns that a thread sweeps at a time. Stored one strip after the other: a
/// strip of a 2048² mask stays in the second-level cache, and a row of it is
/// two cache lines.
const STRIP: usize = 64;

/// Rows between two looks at whether the work was cancelled.
const ROWS: usize = 16;

/// No cell of the other side in this column. Its square is above every true
/// square and still leaves room for one more in an `i32`.
const NONE: i16 = i16::MAX;

/// Signed distances of all cells of `mask`.
pub(super) fn distances(mask: &Mask, progress: &dyn Progress) -> Result<Vec<f32>, Cancelled> {
    let strips = columns(mask);
    let (width, height) = (mask.width() as usize, mask.height() as usize);
    let done = AtomicUsize::new(0);
    let mut out = vec![0.0; mask.bits().len()];
    out.par_chunks_mut(width * ROWS)
        .enumerate()
        .try_for_each_init(
            || RowPass::new(width),
            |pass, (band, out)| {
                // Bands end in any order: counted, the progress only grows.
                let before = done.fetch_add(ROWS, Ordering::Relaxed);
                let fraction = before as f64 / height as f64;
                checkpoint(progress, "measuring distances", fraction)?;
                for (i, out) in out.chunks_mut(width).enumerate() {
                    let y = band * ROWS + i;
                    pass.read(&strips, y, height);
                    pass.transform(&mask.bits()[y * width..][..width], out);
                }
                Ok(())
            },
        )?;
    Ok(out)
}

/// Distances along the columns from each cell to the nearest of the other
/// side, the ring of empty cells around the mask included, strip by strip.
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

/// Counts cells since the last change of side in each column of a strip, row
/// by row, starting from the empty ring.
fn sweep<'a>(
    strip: &mut [i16],
    rows: impl Iterator<Item = (usize, &'a [bool])>,
    merge: impl Fn(i16, i16) -> i16,
) {
    let mut counts = [NONE; STRIP];
    let mut before = [0; STRIP];
    for (y, row) in rows {
        let out = &mut strip[y * STRIP..][..row.len()];
        let columns = out.iter_mut().zip(row).zip(&mut counts).zip(&mut before);
        for (((out, &inside), count), before) in columns {
            // Without a branch, the compiler counts many columns at once.
            let side = -i16::from(inside); // all bits or none
            *count = (*count & !(side ^ *before)).saturating_add(1);
            *before = side;
            *out = merge(*out, *count);
        }
    }
}

/// A piece of a lower envelope: the parabola (x − vertex)² + height, lowest
/// from `start` to the start of the next piece.
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

/// The second pass and what it needs for a row.
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

    /// Gathers the squared column distances of row `y` from the strips.
    fn read(&mut self, strips: &[i16], y: usize, height: usize) {
        for (strip, out) in self.squares.chunks_exact_mut(STRIP).enumerate() {
            let row = &strips[(strip * height + y) * STRIP..][..STRIP];
            for (out, &d) in out.iter_mut().zip(row) {
                *out = i32::from(d) * i32::from(d);
            }
        }
    }

    fn transform(&mut self, row: &[bool], out: &mut [f32]) {
        let mut from = 0;
        for run in row.chunk_by(|a, b| a == b) {
            let to = from + run.len();
            // The ring around the mask is empty, and ends inside runs only.
            let left = from > 0 || run[0];
            let right = to < row.len() || run[0];
            self.run(from, to, left, right);
            from = to;
        }
        let squares = &self.squares[..row.len()];
        for ((out, &square), &inside) in out.iter_mut().zip(squares).zip(row) {
            let distance = (f64::from(square).sqrt() - 0.5) as f32;
            *out = if inside { distance } else { -distance };
        }
    }

    /// Replaces the squares of the run `from..to` by the squared distances,
    /// with cells of the other side at its `left` and `right` end or none.
    fn run(&mut self, from: usize, to: usize, left: bool, right: bool) {
        let (first, end) = (from as i32, to as i32);
        self.envelope.clear();
        if left {
            self.push(first - 1, 0, first, end);
        }
        for x in from..to {
            self.push(x as i32, self.squares[x], first, end);
        }
        if right {
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

    fn push(&mut self, vertex: i32, height: i32, first: i32, end: i32) {
        let mut piece = ParabolaPiece {
            vertex,
            height,
            start: first,
        };
        while let Some(top) = self.envelope.last() {
            // All have one curvature, and the new vertex is farther right: what
            // beats the top where that starts beats it all along.
            if piece.at(top.start) > top.at(top.start) {
                piece.start = meeting(top, &piece);
                break;
            }
            self.envelope.pop();
        }
        if piece.start < end {
            self.envelope.push(piece);
        }
    }
}

/// The first cell where `right` is below `left`, which is lower at the cell
/// where it starts, so that no number here is negative.
fn meeting(left: &ParabolaPiece, right: &ParabolaPiece) -> i32 {
    let rise = right.vertex * right.vertex + right.height - left.vertex * left.vertex - left.height;
    let run = 2 * (right.vertex - left.vertex);
    (rise as u32 / run as u32) as i32 + 1
}

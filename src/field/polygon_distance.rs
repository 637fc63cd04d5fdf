//! The exact distance from samples to polygon edges.
//!
//! Blocks of samples are halved down to a few; each keeps the edges that can
//! be nearest to any of its samples. Let u be the direction from an edge's
//! nearest point to the centre of a block with radius r, and d the distance.
//! On the way to another point of the block the difference of two such
//! distances changes by no more than the difference of their directions, which
//! is at most 2, and at most |u − u₀| + 2 r / (d₀ − r): the way from a convex
//! set to a point changes by no more than the point moves. So an edge is out
//! where d > d₀ + r min(2, |u − u₀| + 2 r / (d₀ − r)), d₀ and u₀ those of the
//! nearest edge. Nothing is approximated: values are exact up to rounding, and
//! the brute-force minimum over all edges is the oracle in the tests.
//!
//! Cost: far from a smooth outline a block keeps a handful of edges; in the
//! centre of a circle it keeps all.

use rayon::prelude::*;
use std::sync::atomic::{AtomicUsize, Ordering};

use super::Grid;
use super::inside::ScanlineEdge;
use crate::geometry::DVec2;
use crate::work::progress::{Cancelled, Progress, checkpoint};

/// Rows that a thread takes at a time: fewer even out the threads, more leave
/// fewer edges to be sorted out again.
const ROWS: usize = 32;

/// Samples of a block that is not halved any more: below, sorting out edges
/// costs more than it saves.
const LEAF: usize = 16;

/// Rounding that the choice of edges allows for, in cells: far above that of
/// doubles at 8192 cells (1e-12), and an edge too many costs only time.
const SLACK: f64 = 1e-6;

/// Distances to the nearest of `edges`, in cells, for all samples of `grid`.
/// There must be an edge.
pub(super) fn distances(
    edges: &[ScanlineEdge],
    grid: &Grid,
    progress: &dyn Progress,
) -> Result<Vec<f32>, Cancelled> {
    let segments: Vec<PolygonSegment> = edges
        .iter()
        .map(|&(a, b)| PolygonSegment::new(a, b))
        .collect();
    let width = grid.width as usize;
    let done = AtomicUsize::new(0);
    let mut out = vec![0.0; grid.cells()];
    out.par_chunks_mut(width * ROWS)
        .enumerate()
        .try_for_each_init(
            || SegmentSearch::new(&segments),
            |search, (band, out)| {
                let before = done.fetch_add(ROWS, Ordering::Relaxed);
                let fraction = before as f64 / f64::from(grid.height);
                checkpoint(progress, "measuring distances", fraction)?;
                let block = SampleBlock {
                    x: (0, width),
                    y: (0, out.len() / width),
                };
                let first_row = band * ROWS;
                let mut band = RowBand {
                    first_row,
                    width,
                    out,
                };
                search.fill(block, 0, &mut band);
                Ok(())
            },
        )?;
    Ok(out)
}

/// A line segment, ready to be measured from.
#[derive(Clone, Copy, Debug)]
struct PolygonSegment {
    start: DVec2,
    along: DVec2,
    /// 1 / length², or 0 for a point.
    scale: f64,
}

impl PolygonSegment {
    fn new(start: DVec2, end: DVec2) -> Self {
        let along = end - start;
        let scale = along.length_squared().recip();
        Self {
            start,
            along,
            // A point has no direction to go along: 0 stays at its start.
            scale: if scale.is_finite() { scale } else { 0.0 },
        }
    }

    /// From the nearest point of the segment to `p`.
    fn to(&self, p: DVec2) -> DVec2 {
        let from_start = p - self.start;
        let s = (from_start.dot(self.along) * self.scale).clamp(0.0, 1.0);
        from_start - self.along * s
    }
}

/// The edge that is nearest to the centre of a block, against all others.
struct NearestCandidate {
    direction: DVec2,
    distance: f64,
    radius: f64,
    /// How far two directions can turn apart within the block.
    turn: f64,
    /// Square of the distance at which no edge can be nearest.
    limit: f64,
}

impl NearestCandidate {
    fn new(away: DVec2, radius: f64) -> Self {
        let distance = away.length();
        let clear = distance - radius;
        // Where the edge reaches into the block, directions may be any two.
        let turn = if clear > 0.0 {
            2.0 * radius / clear
        } else {
            2.0
        };
        Self {
            direction: away / distance,
            distance: distance * (1.0 + SLACK) + SLACK,
            radius,
            turn,
            limit: ((distance + 2.0 * radius) * (1.0 + SLACK) + SLACK).powi(2),
        }
    }

    /// Whether an edge, from which it is `away` to the centre, can be nearer
    /// somewhere in the block.
    fn leaves(&self, away: DVec2) -> bool {
        let square = away.length_squared();
        // Most edges are told by this, without a root.
        if square > self.limit {
            return false;
        }
        let distance = square.sqrt();
        let apart = (away / distance).distance(self.direction) + self.turn;
        // On the boundary there is no direction: `min` takes 2 over NaN.
        distance <= self.distance + self.radius * apart.min(2.0)
    }
}

/// Rows of samples that one thread fills.
struct RowBand<'a> {
    first_row: usize,
    width: usize,
    out: &'a mut [f32],
}

/// Half-open ranges of columns and, within a band, of rows.
#[derive(Clone, Copy, Debug)]
struct SampleBlock {
    x: (usize, usize),
    y: (usize, usize),
}

impl SampleBlock {
    fn size(&self) -> (usize, usize) {
        (self.x.1 - self.x.0, self.y.1 - self.y.0)
    }

    fn halves(&self) -> [Self; 2] {
        let (width, height) = self.size();
        if width >= height {
            let middle = self.x.0 + width / 2;
            [(self.x.0, middle), (middle, self.x.1)].map(|x| Self { x, ..*self })
        } else {
            let middle = self.y.0 + height / 2;
            [(self.y.0, middle), (middle, self.y.1)].map(|y| Self { y, ..*self })
        }
    }

    /// The centre of its samples, and how far the outermost are from it.
    fn disc(&self, first_row: usize) -> (DVec2, f64) {
        let (width, height) = self.size();
        let half = 0.5 * DVec2::new((width - 1) as f64, (height - 1) as f64);
        let lowest = DVec2::new(self.x.0 as f64, (first_row + self.y.0) as f64);
        (lowest + half, half.length())
    }
}

/// The edges that are still in question, as a stack: those of a block lie
/// above those of the block that it is a half of.
struct SegmentSearch<'a> {
    segments: &'a [PolygonSegment],
    stack: Vec<u32>,
    /// From each edge in question to the centre of the block.
    away: Vec<DVec2>,
}

impl<'a> SegmentSearch<'a> {
    fn new(segments: &'a [PolygonSegment]) -> Self {
        Self {
            segments,
            stack: (0..segments.len() as u32).collect(),
            away: Vec::new(),
        }
    }

    /// Fills a block of a band; the edges in question lie on the stack from
    /// `bottom` up.
    fn fill(&mut self, block: SampleBlock, bottom: usize, band: &mut RowBand<'_>) {
        let (columns, rows) = block.size();
        if columns * rows <= LEAF {
            return self.measure(block, bottom, band);
        }
        // Depth first: a half inherits what its block has kept, and gives back
        // the stack as it was.
        for half in block.halves() {
            let top = self.stack.len();
            let (centre, radius) = half.disc(band.first_row);
            self.keep_near(bottom, centre, radius);
            self.fill(half, top, band);
            self.stack.truncate(top);
        }
    }

    /// Pushes those edges from `bottom` up that can be nearest to a point
    /// within `radius` of `centre`.
    fn keep_near(&mut self, bottom: usize, centre: DVec2, radius: f64) {
        let segments = self.segments;
        let away = self.stack[bottom..]
            .iter()
            .map(|&i| segments[i as usize].to(centre));
        self.away.clear();
        self.away.extend(away);
        let Some(&nearest) = self
            .away
            .iter()
            .min_by(|a, b| a.length_squared().total_cmp(&b.length_squared()))
        else {
            return;
        };
        let rival = NearestCandidate::new(nearest, radius);
        for (k, &away) in self.away.iter().enumerate() {
            if rival.leaves(away) {
                self.stack.push(self.stack[bottom + k]);
            }
        }
    }

    fn measure(&self, block: SampleBlock, bottom: usize, band: &mut RowBand<'_>) {
        for y in block.y.0..block.y.1 {
            for x in block.x.0..block.x.1 {
                let p = DVec2::new(x as f64, (band.first_row + y) as f64);
                let square = self.stack[bottom..]
                    .iter()
                    .map(|&i| self.segments[i as usize].to(p).length_squared())
                    .fold(f64::INFINITY, f64::min);
                band.out[y * band.width + x] = square.sqrt() as f32;
            }
        }
    }
}

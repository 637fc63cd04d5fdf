//! Computes exact distances from grid samples to polygon edges.
//!
//! Blocks of samples are halved recursively; each block keeps as candidates only the edges that may
//! be nearest to one of its samples.
//!
//! The pruning bound: let r be the radius of a block. For an edge, let d be its distance from the
//! centre of the block and u the unit vector from its nearest point to that centre. Let d₀ and u₀
//! be the same for the edge that is nearest to the centre. When a point moves from the centre to
//! another place in the block, the difference between its distances from the two edges changes by
//! at most r times the maximum length of the difference of the two unit vectors. That length is at
//! most 2. It is also at most |u − u₀| + 2 r / (d₀ − r), because the vector from a convex set to a
//! point changes by no more than the point moves. An edge is therefore dropped if d > d₀ + r min(2,
//! |u − u₀| + 2 r / (d₀ − r)).
//!
//! Guaranteed: values are exact up to rounding; the tests compare them with the minimum over all
//! edges. Cost: far from a smooth outline a block keeps a handful of edges; at the centre of a
//! circle it keeps all.

use rayon::prelude::*;
use std::sync::atomic::{AtomicUsize, Ordering};

use super::Grid;
use super::inside::ScanlineEdge;
use crate::geometry::DVec2;
use crate::work::progress::{Cancelled, Progress, checkpoint};

/// Number of rows in a band, the unit of work of one thread (resource limit: smaller bands balance
/// the threads better, larger ones repeat less pruning).
const BAND_ROWS: usize = 32;

/// Maximum number of samples in a block that is not halved further (resource limit: in smaller
/// blocks, pruning edges takes longer than it saves).
const LEAF_SAMPLES: usize = 16;

/// Margin of the pruning bound: the bound is raised by this many cells plus this fraction of the
/// distance from the centre of the block to the nearest edge (tolerance: far above 1e-12, the
/// resolution of `f64` at 8192 cells; keeping an edge too many only costs time).
const SLACK: f64 = 1e-6;

/// Computes the unsigned distance from each sample of `grid` to the nearest of `edges`, in cells,
/// in row-major order. There must be at least one edge.
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
    out.par_chunks_mut(width * BAND_ROWS)
        .enumerate()
        .try_for_each_init(
            || SegmentSearch::new(&segments),
            |search, (band, out)| {
                let rows_done = done.fetch_add(BAND_ROWS, Ordering::Relaxed);
                let fraction = rows_done as f64 / f64::from(grid.height);
                checkpoint(progress, "measuring distances", fraction)?;
                let block = SampleBlock {
                    x: (0, width),
                    y: (0, out.len() / width),
                };
                let first_row = band * BAND_ROWS;
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

/// Polygon edge, prepared for distance queries.
#[derive(Clone, Copy, Debug)]
struct PolygonSegment {
    start: DVec2,
    along: DVec2,
    /// 1 / length², or 0 for a segment without length.
    scale: f64,
}

impl PolygonSegment {
    fn new(start: DVec2, end: DVec2) -> Self {
        let along = end - start;
        let scale = along.length_squared().recip();
        Self {
            start,
            along,
            // A segment without length has no direction; 0 keeps the nearest point at its start.
            scale: if scale.is_finite() { scale } else { 0.0 },
        }
    }

    /// Vector from the nearest point of the segment to `p`.
    fn to(&self, p: DVec2) -> DVec2 {
        let from_start = p - self.start;
        let s = (from_start.dot(self.along) * self.scale).clamp(0.0, 1.0);
        from_start - self.along * s
    }
}

/// Pruning bound of a block, computed from the edge nearest to its centre. All other edges are
/// compared with that edge.
struct PruningBound {
    /// Unit vector from the nearest edge to the centre of the block.
    direction: DVec2,
    /// Distance from the nearest edge to the centre, plus the margin for rounding.
    distance: f64,
    /// Distance from the centre to the outermost samples of the block.
    radius: f64,
    /// Maximum change of u − u₀ when a point moves from the centre to another place in the block.
    /// Here u is the unit vector to the point from any edge, u₀ that from the nearest edge. In the
    /// module documentation this is 2 r / (d₀ − r).
    max_divergence: f64,
    /// Squared distance from the centre beyond which an edge cannot be nearest to any sample,
    /// whatever its direction.
    limit: f64,
}

impl PruningBound {
    fn new(away: DVec2, radius: f64) -> Self {
        let distance = away.length();
        let clearance = distance - radius;
        // If the nearest edge may reach into the block, the unit vectors may point anywhere, and
        // their difference is at most 2.
        let max_divergence = if clearance > 0.0 {
            2.0 * radius / clearance
        } else {
            2.0
        };
        Self {
            direction: away / distance,
            distance: distance * (1.0 + SLACK) + SLACK,
            radius,
            max_divergence,
            limit: ((distance + 2.0 * radius) * (1.0 + SLACK) + SLACK).powi(2),
        }
    }

    /// Whether an edge may be nearest to a point of the block. `away` is the vector from the
    /// nearest point of the edge to the centre.
    fn can_be_nearest(&self, away: DVec2) -> bool {
        let square = away.length_squared();
        // Rejects most edges without a square root.
        if square > self.limit {
            return false;
        }
        let distance = square.sqrt();
        let divergence = (away / distance).distance(self.direction) + self.max_divergence;
        // If the centre lies on an edge, `divergence` is NaN, and `min` returns 2.
        distance <= self.distance + self.radius * divergence.min(2.0)
    }
}

/// Band: consecutive rows of samples that one thread fills.
struct RowBand<'a> {
    first_row: usize,
    width: usize,
    out: &'a mut [f32],
}

/// Block of samples: half-open ranges of columns and rows. Rows count from the first row of the
/// band.
#[derive(Clone, Copy, Debug)]
struct SampleBlock {
    x: (usize, usize),
    y: (usize, usize),
}

impl SampleBlock {
    /// Numbers of columns and rows.
    fn size(&self) -> (usize, usize) {
        (self.x.1 - self.x.0, self.y.1 - self.y.0)
    }

    /// Splits the block across its longer side.
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

    /// Smallest disc around the samples: its centre in lattice coordinates and its radius in cells.
    /// `first_row` is the first row of the band.
    fn disc(&self, first_row: usize) -> (DVec2, f64) {
        let (width, height) = self.size();
        let half = 0.5 * DVec2::new((width - 1) as f64, (height - 1) as f64);
        let lowest = DVec2::new(self.x.0 as f64, (first_row + self.y.0) as f64);
        (lowest + half, half.length())
    }
}

/// Recursive search for the nearest edges. Candidates are the edges that may be nearest to a sample
/// of a block, as indices into `segments`. On the stack, the candidates of a block lie above those
/// of its parent block.
struct SegmentSearch<'a> {
    segments: &'a [PolygonSegment],
    stack: Vec<u32>,
    /// Buffer for the vectors from each candidate edge to the centre of the block.
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

    /// Computes the distances of a block of `band`. The candidate edges of the block lie on the
    /// stack from `bottom` up.
    fn fill(&mut self, block: SampleBlock, bottom: usize, band: &mut RowBand<'_>) {
        let (columns, rows) = block.size();
        if columns * rows <= LEAF_SAMPLES {
            return self.measure(block, bottom, band);
        }
        // Prune the edges of the whole block again for each half. Afterwards restore the stack for
        // the other half.
        for half in block.halves() {
            let top = self.stack.len();
            let (centre, radius) = half.disc(band.first_row);
            self.push_near(bottom, centre, radius);
            self.fill(half, top, band);
            self.stack.truncate(top);
        }
    }

    /// Prunes the candidate edges on the stack from `bottom` up: pushes a copy of each edge that
    /// can be nearest to a point within `radius` of `centre`.
    fn push_near(&mut self, bottom: usize, centre: DVec2, radius: f64) {
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
        let bound = PruningBound::new(nearest, radius);
        for (k, &away) in self.away.iter().enumerate() {
            if bound.can_be_nearest(away) {
                self.stack.push(self.stack[bottom + k]);
            }
        }
    }

    /// Computes the distances of a block by brute force over its candidate edges, which lie on the
    /// stack from `bottom` up.
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

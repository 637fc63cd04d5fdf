//! Uniform grid that finds the edges of the advancing front near a line segment. Edges can be added
//! and removed.

use crate::geometry::{Bounds, DVec2};

/// Number of grid cells for each edge: about one edge in a cell if the edges are spread evenly
/// (heuristic).
const CELLS_PER_EDGE: f64 = 1.0;

/// Maximum number of cells along the longer side of the grid (resource limit: a long edge is listed
/// in many cells).
const MAX_CELLS_ALONG: f64 = 256.0;

/// Edge, given by the indices of its two vertices.
type GridEdge = [u32; 2];

/// Grid in which each cell lists the edges whose bounding boxes touch the cell.
#[derive(Clone, Debug)]
pub(super) struct EdgeGrid {
    origin: DVec2,
    cell_size: f64,
    columns: usize,
    rows: usize,
    edges_in_cell: Vec<Vec<GridEdge>>,
}

impl EdgeGrid {
    /// Creates an empty grid over the bounding box of `points`, with a cell size that suits the
    /// given number of edges.
    pub(super) fn around(points: &[DVec2], edges: usize) -> Self {
        let bounds = Bounds::of(points.iter().copied()).unwrap_or(Bounds::at(DVec2::ZERO));
        let size = bounds.size();
        let across = (CELLS_PER_EDGE * edges as f64)
            .sqrt()
            .clamp(1.0, MAX_CELLS_ALONG);
        let cell_size = size.max_element() / across;
        let along = |length: f64| (length / cell_size) as usize + 1;
        let (columns, rows) = (along(size.x), along(size.y));
        Self {
            origin: bounds.min,
            cell_size,
            columns,
            rows,
            edges_in_cell: vec![Vec::new(); columns * rows],
        }
    }

    /// Returns the indices of the cells that the bounding box of a line segment touches. Parts of
    /// the box outside the grid belong to the outermost cells.
    fn cells(&self, [a, b]: [DVec2; 2]) -> impl Iterator<Item = usize> + use<> {
        let at = |p: DVec2| {
            let [x, y] = ((p - self.origin) / self.cell_size).to_array();
            // The cast saturates: negative numbers become 0. If all points coincide, the numbers
            // are NaN, which becomes 0 too.
            [
                (x as usize).min(self.columns - 1),
                (y as usize).min(self.rows - 1),
            ]
        };
        let ([left, bottom], [right, top]) = (at(a.min(b)), at(a.max(b)));
        let columns = self.columns;
        (bottom..=top).flat_map(move |row| (left..=right).map(move |x| row * columns + x))
    }

    /// Adds an edge whose ends have the positions `ends`.
    pub(super) fn add(&mut self, edge: GridEdge, ends: [DVec2; 2]) {
        for cell in self.cells(ends) {
            self.edges_in_cell[cell].push(edge);
        }
    }

    /// Removes an edge; `ends` must be the positions with which it was added.
    pub(super) fn remove(&mut self, edge: GridEdge, ends: [DVec2; 2]) {
        for cell in self.cells(ends) {
            self.edges_in_cell[cell].retain(|other| *other != edge);
        }
    }

    /// Returns whether `is` holds for at least one edge near a line segment. An edge is near if its
    /// bounding box touches a cell that the segment's bounding box touches. This is only a coarse
    /// filter, so `is` must make the exact test. `is` may be called several times for one edge.
    pub(super) fn any_edge_near(&self, segment: [DVec2; 2], is: impl Fn(GridEdge) -> bool) -> bool {
        let mut cells = self.cells(segment);
        cells.any(|cell| self.edges_in_cell[cell].iter().any(|&edge| is(edge)))
    }
}

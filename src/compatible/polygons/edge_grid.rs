//! Which edges of a front are near a straight way: a grid of squares, each with
//! the edges whose box it touches. Edges come and go as the front moves.

use crate::geometry::{Bounds, DVec2};

/// Squares for each edge: about one edge in a square of an even front.
const SQUARES: f64 = 1.0;

/// Most squares along a side: an edge across all of them is listed in each.
const MOST: f64 = 256.0;

/// An edge by its vertices.
type GridEdge = [u32; 2];

#[derive(Clone, Debug)]
pub(super) struct EdgeGrid {
    origin: DVec2,
    square: f64,
    columns: usize,
    rows: usize,
    listed: Vec<Vec<GridEdge>>,
}

impl EdgeGrid {
    /// A grid for so many edges between points, none of them listed yet.
    pub(super) fn around(points: &[DVec2], edges: usize) -> Self {
        let bounds = Bounds::of(points.iter().copied()).unwrap_or(Bounds::at(DVec2::ZERO));
        let size = bounds.size();
        let across = (SQUARES * edges as f64).sqrt().clamp(1.0, MOST);
        let square = size.max_element() / across;
        let along = |length: f64| (length / square) as usize + 1;
        let (columns, rows) = (along(size.x), along(size.y));
        Self {
            origin: bounds.min,
            square,
            columns,
            rows,
            listed: vec![Vec::new(); columns * rows],
        }
    }

    /// The squares that the box of a segment touches; what lies beyond the
    /// grid is in its outermost ones.
    fn squares(&self, [a, b]: [DVec2; 2]) -> impl Iterator<Item = usize> + use<> {
        let at = |p: DVec2| {
            let [x, y] = ((p - self.origin) / self.square).to_array();
            // Below 0 is 0; so is NaN, where all points are one.
            [
                (x as usize).min(self.columns - 1),
                (y as usize).min(self.rows - 1),
            ]
        };
        let ([left, bottom], [right, top]) = (at(a.min(b)), at(a.max(b)));
        let columns = self.columns;
        (bottom..=top).flat_map(move |row| (left..=right).map(move |x| row * columns + x))
    }

    pub(super) fn add(&mut self, edge: GridEdge, ends: [DVec2; 2]) {
        for square in self.squares(ends) {
            self.listed[square].push(edge);
        }
    }

    pub(super) fn remove(&mut self, edge: GridEdge, ends: [DVec2; 2]) {
        for square in self.squares(ends) {
            self.listed[square].retain(|other| *other != edge);
        }
    }

    /// Whether something is true of an edge whose box may meet that of a way;
    /// of some it is asked more than once.
    pub(super) fn any(&self, way: [DVec2; 2], is: impl Fn(GridEdge) -> bool) -> bool {
        let mut squares = self.squares(way);
        squares.any(|square| self.listed[square].iter().any(|&edge| is(edge)))
    }
}

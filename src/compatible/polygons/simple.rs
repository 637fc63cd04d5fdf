//! Whether points make a simple, counter-clockwise polygon, exactly.

use super::PolygonsError;
use crate::compatible::Which;
use crate::geometry::{DVec2, orient2d};

/// Checks the count, the coordinates, that no two edges touch but neighbours
/// at their common vertex, and the direction. O(n log n) plus the pairs of
/// edges whose x ranges overlap.
pub(super) fn check(points: &[DVec2], which: Which) -> Result<(), PolygonsError> {
    if points.len() < 3 {
        return Err(PolygonsError::TooFewPoints {
            which,
            points: points.len(),
        });
    }
    if let Some(vertex) = points.iter().position(|p| !p.is_finite()) {
        return Err(PolygonsError::NotFinite { which, vertex });
    }
    if let Some(edges) = touching_edges(points) {
        return Err(PolygonsError::NotSimple { which, edges });
    }
    if !runs_counter_clockwise(points) {
        return Err(PolygonsError::Clockwise(which));
    }
    Ok(())
}

/// Two edges that touch where they must not, by a sweep along x.
fn touching_edges(points: &[DVec2]) -> Option<[usize; 2]> {
    let n = points.len();
    let edge = |i: usize| [points[i], points[(i + 1) % n]];
    let left = |i: usize| edge(i)[0].x.min(edge(i)[1].x);
    let right = |i: usize| edge(i)[0].x.max(edge(i)[1].x);
    let mut order: Vec<usize> = (0..n).collect();
    order.sort_by(|&i, &j| left(i).total_cmp(&left(j)));
    let mut active: Vec<usize> = Vec::new();
    for &i in &order {
        active.retain(|&j| right(j) >= left(i));
        if let Some(&j) = active.iter().find(|&&j| touch(points, i, j)) {
            return Some([i.min(j), i.max(j)]);
        }
        active.push(i);
    }
    None
}

fn touch(points: &[DVec2], i: usize, j: usize) -> bool {
    let n = points.len();
    let at = |k: usize| points[k % n];
    if (i + 1) % n == j {
        folds_back(at(i), at(j), at(j + 1))
    } else if (j + 1) % n == i {
        folds_back(at(j), at(i), at(i + 1))
    } else {
        segments_touch([at(i), at(i + 1)], [at(j), at(j + 1)])
    }
}

/// Whether the path a, b, c returns onto itself or stands still.
fn folds_back(a: DVec2, b: DVec2, c: DVec2) -> bool {
    a == b || b == c || (orient2d(a, b, c) == 0.0 && (within(b, a, c) || within(b, c, a)))
}

/// Whether two closed segments have a point in common.
pub(super) fn segments_touch([a, b]: [DVec2; 2], [c, d]: [DVec2; 2]) -> bool {
    let boxes_apart = a.max(b).cmplt(c.min(d)).any() || c.max(d).cmplt(a.min(b)).any();
    if boxes_apart {
        return false;
    }
    let (abc, abd) = (orient2d(a, b, c), orient2d(a, b, d));
    if (abc > 0.0 && abd > 0.0) || (abc < 0.0 && abd < 0.0) {
        return false;
    }
    let (cda, cdb) = (orient2d(c, d, a), orient2d(c, d, b));
    // Collinear segments whose boxes meet do touch.
    !((cda > 0.0 && cdb > 0.0) || (cda < 0.0 && cdb < 0.0))
}

/// For collinear points: whether `p` lies between `a` and `b`, ends included,
/// seen from `a`.
fn within(a: DVec2, p: DVec2, b: DVec2) -> bool {
    let (low, high) = (a.min(b), a.max(b));
    p.cmpge(low).all() && p.cmple(high).all()
}

/// The lexicographically first vertex of a simple polygon is a strict corner.
fn runs_counter_clockwise(points: &[DVec2]) -> bool {
    let n = points.len();
    let key = |i: usize| (points[i].x, points[i].y);
    let first = (0..n).reduce(|i, j| if key(j) < key(i) { j } else { i });
    first.is_some_and(|i| orient2d(points[(i + n - 1) % n], points[i], points[(i + 1) % n]) > 0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn verdict(points: &[(f64, f64)]) -> Result<(), PolygonsError> {
        let points: Vec<DVec2> = points.iter().copied().map(DVec2::from).collect();
        check(&points, Which::Source)
    }

    #[test]
    fn points_on_a_straight_side_are_welcome() {
        assert_eq!(
            verdict(&[(0.0, 0.0), (1.0, 0.0), (2.0, 0.0), (2.0, 1.0), (0.0, 1.0)]),
            Ok(())
        );
    }

    #[test]
    fn spikes_touches_and_wrong_direction_are_named() {
        let not_simple = |edges| {
            Err(PolygonsError::NotSimple {
                which: Which::Source,
                edges,
            })
        };
        let spike = [(0.0, 0.0), (2.0, 0.0), (1.0, 0.0), (1.0, 1.0)];
        assert_eq!(verdict(&spike), not_simple([0, 1]));
        let touch = [(0.0, 0.0), (4.0, 0.0), (4.0, 2.0), (2.0, 0.0), (0.0, 2.0)];
        assert_eq!(verdict(&touch), not_simple([0, 3]));
        let clockwise = [(0.0, 0.0), (0.0, 1.0), (1.0, 0.0)];
        assert_eq!(
            verdict(&clockwise),
            Err(PolygonsError::Clockwise(Which::Source))
        );
    }
}

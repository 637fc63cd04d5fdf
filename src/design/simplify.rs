//! Fewer points within a tolerance (Ramer 1972; Douglas and Peucker 1973).
//!
//! Every point of the given polygon is within the tolerance of the result,
//! and the result's points are points of the given polygon. The result may
//! cross itself where the polygon comes near to itself; `Regions::from_rings`
//! cleans that.

use crate::geometry::{DVec2, distance_squared_to_segment};

/// A closed polygon simplified. The two points between which it is opened are
/// the first one and the one that is farthest from it.
pub(super) fn closed(points: &[DVec2], tolerance: f64) -> Vec<DVec2> {
    let Some(&first) = points.first() else {
        return Vec::new();
    };
    let from_first = |p: &DVec2| p.distance_squared(first);
    let far = (0..points.len())
        .max_by(|&i, &j| from_first(&points[i]).total_cmp(&from_first(&points[j])))
        .unwrap_or(0);
    let end = points.len();
    // One more than points, for the first one closes the last span.
    let mut keep = vec![false; end + 1];
    keep[0] = true;
    keep[far] = true;
    // A stack and no recursion: spans lie in spans as often as there are points.
    let mut spans = vec![(0, far), (far, end)];
    while let Some((a, b)) = spans.pop() {
        if let Some(split) = farthest(points, a, b, tolerance) {
            keep[split] = true;
            spans.extend([(a, split), (split, b)]);
        }
    }
    points
        .iter()
        .zip(keep)
        .filter_map(|(&p, keep)| keep.then_some(p))
        .collect()
}

/// The point strictly between `a` and `b` that is farthest from their segment,
/// if it is farther than the tolerance. Index `points.len()` is the first.
fn farthest(points: &[DVec2], a: usize, b: usize, tolerance: f64) -> Option<usize> {
    let (start, end) = (points[a], points[b % points.len()]);
    (a + 1..b)
        .map(|i| (i, distance_squared_to_segment(points[i], start, end).sqrt()))
        .max_by(|x, y| x.1.total_cmp(&y.1))
        .filter(|&(_, distance)| distance > tolerance)
        .map(|(i, _)| i)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_circle_keeps_within_its_tolerance() {
        let circle: Vec<DVec2> = (0..1000)
            .map(|k| DVec2::from_angle(f64::from(k) * std::f64::consts::TAU / 1000.0))
            .collect();
        for tolerance in [1e-3, 1e-2, 1e-1] {
            let few = closed(&circle, tolerance);
            assert!(few.len() < 200);
            for p in &circle {
                let near = (0..few.len())
                    .map(|i| {
                        distance_squared_to_segment(*p, few[i], few[(i + 1) % few.len()]).sqrt()
                    })
                    .fold(f64::INFINITY, f64::min);
                assert!(near <= tolerance);
            }
        }
    }

    #[test]
    fn corners_stay_and_points_between_them_go() {
        let square = [
            (0, 0),
            (1, 0),
            (2, 0),
            (2, 1),
            (2, 2),
            (1, 2),
            (0, 2),
            (0, 1),
        ];
        let points = square.map(|(x, y)| DVec2::new(f64::from(x), f64::from(y)));
        assert_eq!(closed(&points, 1e-9).len(), 4);
        assert_eq!(closed(&points, 0.0).len(), 4);
        assert_eq!(closed(&[], 1.0), vec![]);
        assert_eq!(closed(&[DVec2::ONE], 1.0), vec![DVec2::ONE]);
    }
}

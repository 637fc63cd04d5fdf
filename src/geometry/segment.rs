//! Line segments: the nearest point to a given point, contact and crossing of two segments, and
//! intersection with a ray.

use super::{DVec2, orient2d};

/// Returns the position of the point nearest to `p` on the segment from `a` to `b`, as a fraction
/// in [0, 1]; 0 if the segment has no length.
///
/// ```
/// use morphospace::geometry::{DVec2, nearest_segment_parameter};
/// let (a, b) = (DVec2::ZERO, DVec2::new(4.0, 0.0));
/// assert_eq!(nearest_segment_parameter(DVec2::new(3.0, 5.0), a, b), 0.75);
/// ```
#[must_use]
pub fn nearest_segment_parameter(p: DVec2, a: DVec2, b: DVec2) -> f64 {
    let edge = b - a;
    // The quotient is 0 / 0 if the ends coincide, or are so close that the squared length
    // underflows.
    let along = (p - a).dot(edge) / edge.length_squared();
    if along.is_finite() {
        along.clamp(0.0, 1.0)
    } else {
        0.0
    }
}

/// Returns the squared distance from `p` to the segment from `a` to `b`.
///
/// ```
/// use morphospace::geometry::{DVec2, distance_squared_to_segment};
/// let far = distance_squared_to_segment(DVec2::new(7.0, 4.0), DVec2::ZERO, DVec2::new(4.0, 0.0));
/// assert_eq!(far, 25.0);
/// ```
#[must_use]
pub fn distance_squared_to_segment(p: DVec2, a: DVec2, b: DVec2) -> f64 {
    p.distance_squared(a + nearest_segment_parameter(p, a, b) * (b - a))
}

/// Returns whether two segments, including their end points, have a point in common (by exact
/// predicates).
///
/// ```
/// use morphospace::geometry::{DVec2, segments_touch};
/// let [o, x, y] = [DVec2::ZERO, DVec2::X, DVec2::Y];
/// assert!(segments_touch([o, x], [x, y]));
/// assert!(!segments_touch([o, x], [y, x + y]));
/// ```
#[must_use]
pub fn segments_touch([a, b]: [DVec2; 2], [c, d]: [DVec2; 2]) -> bool {
    let boxes_apart = a.max(b).cmplt(c.min(d)).any() || c.max(d).cmplt(a.min(b)).any();
    // Collinear segments touch exactly if their bounding boxes do.
    !boxes_apart && !on_same_side([a, b], c, d) && !on_same_side([c, d], a, b)
}

/// Returns whether two segments cross at a single point that is an end of neither (by exact
/// predicates).
///
/// ```
/// use morphospace::geometry::{DVec2, segments_cross};
/// let [o, x, y] = [DVec2::ZERO, DVec2::X, DVec2::Y];
/// assert!(segments_cross([o, x + y], [x, y]));
/// assert!(!segments_cross([o, x], [x, y]));
/// ```
#[must_use]
pub fn segments_cross([a, b]: [DVec2; 2], [c, d]: [DVec2; 2]) -> bool {
    // Segments with a common end do not cross. This shortcut helps neighbouring edges, for which
    // the exact predicate is slow.
    let shared = a == c || a == d || b == c || b == d;
    !shared && separates([a, b], c, d) && separates([c, d], a, b)
}

/// Returns the distance from `from` at which a ray hits the segment from `a` to `b`, as a multiple
/// of the length of `direction`; `None` if the ray misses, or if the distance is not positive.
pub(crate) fn ray_hit_parameter(from: DVec2, direction: DVec2, [a, b]: [DVec2; 2]) -> Option<f64> {
    let (edge, offset) = (b - a, a - from);
    let across = direction.perp_dot(edge);
    // If ray and segment are parallel, this quotient is infinite or NaN, and therefore outside 0 to
    // 1.
    let share = offset.perp_dot(direction) / across;
    let far = || offset.perp_dot(edge) / across;
    let meets = (0.0..=1.0).contains(&share);
    meets.then(far).filter(|far| *far > 0.0)
}

/// Returns whether `p` and `q` lie strictly on the same side of the line through `a` and `b`.
fn on_same_side([a, b]: [DVec2; 2], p: DVec2, q: DVec2) -> bool {
    let [p, q] = [p, q].map(|p| orient2d(a, b, p));
    (p > 0.0 && q > 0.0) || (p < 0.0 && q < 0.0)
}

/// Returns whether `p` and `q` lie strictly on different sides of the line through `a` and `b`.
fn separates([a, b]: [DVec2; 2], p: DVec2, q: DVec2) -> bool {
    let [p, q] = [p, q].map(|p| orient2d(a, b, p));
    (p > 0.0 && q < 0.0) || (p < 0.0 && q > 0.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn point() -> impl Strategy<Value = DVec2> {
        // Generate few different points, so that ends often coincide, lie on edges and are
        // collinear.
        (0i8..4, 0i8..4).prop_map(|(x, y)| DVec2::new(x.into(), y.into()))
    }

    /// Returns where the lines through two segments meet, as a fraction of each segment; `None` if
    /// they are parallel (oracle, exact for small integers).
    fn meeting([a, b]: [DVec2; 2], [c, d]: [DVec2; 2]) -> Option<[f64; 2]> {
        let across = (b - a).perp_dot(d - c);
        let shares = [(c - a).perp_dot(d - c), (c - a).perp_dot(b - a)];
        (across != 0.0).then(|| shares.map(|share| share / across))
    }

    /// Returns whether `p` lies on a segment, including its ends.
    fn on([a, b]: [DVec2; 2], p: DVec2) -> bool {
        distance_squared_to_segment(p, a, b) == 0.0
    }

    proptest! {
        #[test]
        fn contact_agrees_with_the_lines_solved(a in point(), b in point(), c in point(), d in point()) {
            let (s, t) = ([a, b], [c, d]);
            let ends = on(s, c) || on(s, d) || on(t, a) || on(t, b);
            let within = |open: bool| meeting(s, t).is_some_and(|shares| {
                shares.iter().all(|x| if open { *x > 0.0 && *x < 1.0 } else { (0.0..=1.0).contains(x) })
            });
            prop_assert_eq!(segments_touch(s, t), ends || within(false));
            prop_assert_eq!(segments_touch(t, s), segments_touch(s, t));
            prop_assert_eq!(segments_cross(s, t), within(true));
        }

        #[test]
        fn no_point_of_a_segment_is_nearer(p in point(), a in point(), b in point(), share in 0.0f64..=1.0) {
            let nearest = distance_squared_to_segment(p, a, b);
            prop_assert!(nearest <= p.distance_squared(a + share * (b - a)) + 1e-12);
        }
    }
}

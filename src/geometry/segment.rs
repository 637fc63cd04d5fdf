//! Straight pieces between two points: what of them is near a point, and
//! whether two of them meet.

use super::{DVec2, orient2d};

/// How far along the segment from `a` to `b` the point nearest to `p` lies,
/// in [0, 1]; 0 where the segment has no length.
///
/// ```
/// use morphospace::geometry::{DVec2, along_segment};
/// assert_eq!(along_segment(DVec2::new(3.0, 5.0), DVec2::ZERO, DVec2::new(4.0, 0.0)), 0.75);
/// ```
#[must_use]
pub fn nearest_segment_parameter(p: DVec2, a: DVec2, b: DVec2) -> f64 {
    let edge = b - a;
    // 0/0 where the ends are one, or so near that the square underflows.
    let along = (p - a).dot(edge) / edge.length_squared();
    if along.is_finite() {
        along.clamp(0.0, 1.0)
    } else {
        0.0
    }
}

/// The squared distance from `p` to the segment from `a` to `b`.
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

/// Whether two segments, ends included, have a point in common; exact.
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
    // Segments on one line whose boxes meet do touch.
    !boxes_apart && !one_side([a, b], c, d) && !one_side([c, d], a, b)
}

/// Whether two segments cross in a point that is an end of neither; exact.
///
/// ```
/// use morphospace::geometry::{DVec2, segments_cross};
/// let [o, x, y] = [DVec2::ZERO, DVec2::X, DVec2::Y];
/// assert!(segments_cross([o, x + y], [x, y]));
/// assert!(!segments_cross([o, x], [x, y]));
/// ```
#[must_use]
pub fn segments_cross([a, b]: [DVec2; 2], [c, d]: [DVec2; 2]) -> bool {
    // Neighbours share a point; the exact predicate is slow just there.
    let shared = a == c || a == d || b == c || b == d;
    !shared && parted([a, b], c, d) && parted([c, d], a, b)
}

/// How far along a ray the segment from `a` to `b` is met, in lengths of
/// `direction`; none if it is not, or lies behind.
pub(crate) fn ray_hit_parameter(
    from: DVec2,
    direction: DVec2,
    (a, b): (DVec2, DVec2),
) -> Option<f64> {
    let (edge, offset) = (b - a, a - from);
    let across = direction.perp_dot(edge);
    // Parallel lines: infinite or NaN, and so outside the range.
    let share = offset.perp_dot(direction) / across;
    let far = || offset.perp_dot(edge) / across;
    let meets = (0.0..=1.0).contains(&share);
    meets.then(far).filter(|far| *far > 0.0)
}

/// Whether both points lie strictly on the same side of the line.
fn one_side([a, b]: [DVec2; 2], p: DVec2, q: DVec2) -> bool {
    let [p, q] = [p, q].map(|p| orient2d(a, b, p));
    (p > 0.0 && q > 0.0) || (p < 0.0 && q < 0.0)
}

/// Whether the line runs strictly between the points.
fn parted([a, b]: [DVec2; 2], p: DVec2, q: DVec2) -> bool {
    let [p, q] = [p, q].map(|p| orient2d(a, b, p));
    (p > 0.0 && q < 0.0) || (p < 0.0 && q > 0.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn point() -> impl Strategy<Value = DVec2> {
        // Few places, so that ends meet, lie on edges and on one line.
        (0i8..4, 0i8..4).prop_map(|(x, y)| DVec2::new(x.into(), y.into()))
    }

    /// The point that the lines share, where they are not parallel, as shares
    /// of both segments: exact for small whole numbers.
    fn meeting([a, b]: [DVec2; 2], [c, d]: [DVec2; 2]) -> Option<[f64; 2]> {
        let across = (b - a).perp_dot(d - c);
        let shares = [(c - a).perp_dot(d - c), (c - a).perp_dot(b - a)];
        (across != 0.0).then(|| shares.map(|share| share / across))
    }

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

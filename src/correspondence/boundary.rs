//! Matches the points of two closed boundaries.
//!
//! Both curves are sampled by arc length with their corners included. Samples are compared by their
//! [`super::features`]. A cyclic dynamic program finds the cheapest closed path on the torus of all
//! sample pairs, over all starting points (Maes 1990). The first search compares only features that
//! do not depend on rotation. Its best few paths suggest rotations of one design onto the other
//! (poses); for each pose, a further search compares tangents and positions too. The best path is
//! then made strictly monotone, with evenly distributed stretch.
//!
//! Guarantees: the match is strictly monotone in both directions, goes around once, satisfies each
//! pin exactly and is deterministic. The match from B to A is the bitwise inverse of the match from
//! A to B, because each pair is solved in one canonical order. Among equally good matches, such as
//! those of a gear with itself, the one with the smallest rotation is chosen.
//!
//! Not guaranteed: that the rotation is the best of all; it is the best of the few that were tried.
//! Details finer than the sample spacing are matched by arc length.

use super::boundary_match::BoundaryMatch;
use super::curve::BoundaryCurve;
use super::curve_problem::CurveMatchProblem;
use super::options::{MatchError, MatchOptions, check};
use super::pins::{self, Pin};
use crate::geometry::{DVec2, lexicographic};
use std::cmp::Ordering;

/// Matches two closed boundaries that run in the same direction. The match satisfies each of `pins`
/// exactly.
///
/// # Errors
/// [`MatchError`] for contradictory pins, opposite orientations, or options
/// out of range.
///
/// ```
/// use morphospace::correspondence::{BoundaryCurve, MatchOptions, match_curves};
/// use morphospace::geometry::{DVec2, Ring};
/// let flag = [(0.0, 0.0), (3.0, 0.0), (1.0, 1.0), (0.0, 1.0)].map(DVec2::from);
/// let curve = BoundaryCurve::closed(&Ring::new(flag.to_vec())?)?;
/// let same = match_curves(&curve, &curve, &[], &MatchOptions::default())?;
/// assert!(same.knots().iter().all(|[a, b]| (a - b).abs() < 1e-12));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn match_curves(
    source: &BoundaryCurve,
    target: &BoundaryCurve,
    pins: &[Pin],
    options: &MatchOptions,
) -> Result<BoundaryMatch, MatchError> {
    check(source, target, options)?;
    let forward_pins = pins::sort_pins(pins, source, target)?;
    let swapped_pins: Vec<Pin> = pins.iter().map(|pin| pin.swapped()).collect();
    let backward_pins = pins::sort_pins(&swapped_pins, target, source)?;
    // Solve every pair in one canonical order, and invert the result if needed. Otherwise rounding
    // and ties would depend on the order of the arguments.
    if canonical_order(source, &forward_pins, target, &backward_pins) == Ordering::Greater {
        return Ok(
            CurveMatchProblem::new(target, source, backward_pins, options)
                .solve([target, source])
                .inverse(),
        );
    }
    Ok(CurveMatchProblem::new(source, target, forward_pins, options).solve([source, target]))
}

/// Compares two curves, each with its pins, in a total order. The smaller curve of a pair is always
/// the source when the pair is solved.
fn canonical_order(
    a: &BoundaryCurve,
    a_pins: &[[f64; 2]],
    b: &BoundaryCurve,
    b_pins: &[[f64; 2]],
) -> Ordering {
    let flat = |p: &DVec2| p.to_array();
    let points = |c: &BoundaryCurve| c.points().iter().flat_map(flat).collect::<Vec<_>>();
    let count = a.points().len().cmp(&b.points().len());
    let shape = || lexicographic(points(a), points(b));
    let pinned = || lexicographic(a_pins.concat(), b_pins.concat());
    count.then_with(shape).then_with(pinned)
}

//! Which point of one boundary is which of the other.
//!
//! Both curves are sampled by arc length with corners kept, samples are
//! compared by [`super::features`], and the cheapest closed path through the
//! pairs is sought over all starting points (Maes 1990). That is done blind to
//! rotation first; the rotations of its best few paths are the poses for which
//! tangents and positions are compared too. The path is then made strictly
//! monotone with even stretch.
//!
//! Guarantees: the match is strictly monotone both ways, goes once around,
//! honours each pin exactly, is deterministic, and the match from B to A is
//! the inverse of that from A to B bit by bit, since the pair is solved in one
//! order whichever way it is asked for. Equally good matches (a gear's own
//! symmetry) go to the least rotation.
//!
//! Does not guarantee: that the pose found is the best of all rotations, only
//! of the few tried; detail finer than the samples is matched by arc length.

use super::boundary_match::BoundaryMatch;
use super::curve::BoundaryCurve;
use super::curve_problem::CurveMatchProblem;
use super::options::{MatchError, MatchOptions, check};
use super::pins::{self, Pin};
use crate::geometry::{DVec2, lexicographic};
use std::cmp::Ordering;

/// Matches two boundaries that run the same way around.
///
/// # Errors
/// [`MatchError`] for contradictory pins, opposite orientations, or options
/// out of range.
///
/// ```
/// use morphospace::correspondence::{Curve, MatchOptions, match_curves};
/// use morphospace::geometry::{DVec2, Ring};
/// let flag = [(0.0, 0.0), (3.0, 0.0), (1.0, 1.0), (0.0, 1.0)].map(DVec2::from);
/// let curve = Curve::closed(&Ring::new(flag.to_vec())?)?;
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
    let there = pins::ordered(pins, source, target)?;
    let inverses: Vec<Pin> = pins.iter().map(|pin| pin.swapped()).collect();
    let back = pins::ordered(&inverses, target, source)?;
    // Solved in one order and turned round: sums and ties would else differ.
    if order(source, &there, target, &back) == Ordering::Greater {
        return Ok(CurveMatchProblem::new(target, source, back, options)
            .solve([target, source])
            .inverse());
    }
    Ok(CurveMatchProblem::new(source, target, there, options).solve([source, target]))
}

/// A total order of curves with their pins, so that a pair is solved in one
/// order only.
fn order(
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

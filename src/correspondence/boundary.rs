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
use super::curve::{Curve, CurveError};
use super::pins::{self, Pin, PinError};
use super::problem::Problem;
use crate::geometry::{DVec2, Ring};
use serde::{Deserialize, Serialize};
use std::cmp::Ordering;

/// How boundaries are matched.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields, rename_all = "kebab-case")]
pub struct MatchOptions {
    /// Samples along each curve, in 8..=1000; corners and pins come on top.
    /// Cost grows as n² log n.
    pub samples: u32,
    /// Keep "up": compare directions as drawn instead of up to a rotation.
    pub keep_up: bool,
    /// Price of stretch against bending, at least 0; 0.25 unless stated.
    pub stretch: f64,
    /// Price of differing thickness, at least 0; 1 unless stated.
    pub thickness: f64,
}

impl Default for MatchOptions {
    fn default() -> Self {
        Self {
            samples: 160,
            keep_up: false,
            stretch: 0.25,
            thickness: 1.0,
        }
    }
}

/// Why two curves cannot be matched.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum MatchError {
    /// A curve has no usable length.
    #[error(transparent)]
    Curve(#[from] CurveError),
    /// The pins contradict each other.
    #[error(transparent)]
    Pins(#[from] PinError),
    /// One curve is closed and the other open.
    #[error("a closed outline cannot be matched with an open line; close or open one of them")]
    ClosedWithOpen,
    /// One curve runs counter-clockwise and the other clockwise.
    #[error("the outlines run opposite ways around; reverse the points of one of them")]
    Orientation,
    /// The number of samples is out of range.
    #[error("{0} samples cannot be matched; choose a number from 8 to 1000")]
    Samples(u32),
    /// The price of stretch is negative or not finite.
    #[error("the price of stretch {0} is not a number of at least 0; choose one such as 0.25")]
    Stretch(f64),
    /// The price of differing thickness is negative or not finite.
    #[error("the price of thickness {0} is not a number of at least 0; choose one such as 1")]
    Thickness(f64),
}

/// Matches two closed boundaries that run the same way around.
///
/// # Errors
/// [`MatchError`] for contradictory pins, opposite orientations, options out
/// of range, or sizes that floating point cannot measure.
pub fn match_rings(
    source: &Ring,
    target: &Ring,
    pins: &[Pin],
    options: &MatchOptions,
) -> Result<BoundaryMatch, MatchError> {
    match_curves(
        &Curve::closed(source)?,
        &Curve::closed(target)?,
        pins,
        options,
    )
}

/// Matches two curves, both closed or both open. The ends of open curves are
/// matched to each other in the order given.
///
/// # Errors
/// As [`match_rings`], and for a closed curve with an open one.
pub fn match_curves(
    source: &Curve,
    target: &Curve,
    pins: &[Pin],
    options: &MatchOptions,
) -> Result<BoundaryMatch, MatchError> {
    check(source, target, options)?;
    let there = pins::ordered(pins, source, target)?;
    let inverses: Vec<Pin> = pins.iter().map(|pin| pin.swapped()).collect();
    let back = pins::ordered(&inverses, target, source)?;
    if order(source, &there, target, &back) == Ordering::Greater {
        return Ok(Problem::new(target, source, back, options)
            .solve([target, source])
            .inverse());
    }
    Ok(Problem::new(source, target, there, options).solve([source, target]))
}

fn check(source: &Curve, target: &Curve, options: &MatchOptions) -> Result<(), MatchError> {
    if source.is_closed() != target.is_closed() {
        return Err(MatchError::ClosedWithOpen);
    }
    if source.is_closed() && source.turning_number() * target.turning_number() < 0 {
        return Err(MatchError::Orientation);
    }
    if !(8..=1000).contains(&options.samples) {
        return Err(MatchError::Samples(options.samples));
    }
    if !(options.stretch.is_finite() && options.stretch >= 0.0) {
        return Err(MatchError::Stretch(options.stretch));
    }
    if !(options.thickness.is_finite() && options.thickness >= 0.0) {
        return Err(MatchError::Thickness(options.thickness));
    }
    Ok(())
}

/// A total order of curves with their pins, so that a pair is solved in one
/// order only.
fn order(a: &Curve, a_pins: &[[f64; 2]], b: &Curve, b_pins: &[[f64; 2]]) -> Ordering {
    fn compare(a: impl Iterator<Item = f64>, b: impl Iterator<Item = f64>) -> Ordering {
        let different = |(a, b): (f64, f64)| Some(a.total_cmp(&b)).filter(|o| o.is_ne());
        a.zip(b).find_map(different).unwrap_or(Ordering::Equal)
    }
    let flat = |p: &DVec2| p.to_array();
    let points = |c: &Curve| c.points().iter().flat_map(flat).collect::<Vec<_>>();
    let count = a.points().len().cmp(&b.points().len());
    let shape = || compare(points(a).into_iter(), points(b).into_iter());
    let pinned = || {
        compare(
            a_pins.iter().flatten().copied(),
            b_pins.iter().flatten().copied(),
        )
    };
    count.then_with(shape).then_with(pinned)
}

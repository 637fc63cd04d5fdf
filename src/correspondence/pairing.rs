//! Pairs the parts of two designs, and the holes of two parts.
//!
//! The pairing is an assignment of minimum cost in position, size, shape and appearance. All parts
//! of the design with fewer parts are paired. The other design's remaining parts stay unmatched, at
//! a cost that grows with their area. Pairs fixed by the user are preserved.
//!
//! Guarantees: the assignment is optimal and deterministic, and pairing B with A gives the same
//! result as pairing A with B. A part is never split into several.

use super::regions::{PartAppearance, PartAppearances};
use crate::geometry::{DVec2, Region, Regions, Ring, Side, lexicographic};
use crate::numerics::assignment::assign;
use std::cmp::Ordering;
use std::f64::consts::TAU;

/// Pairing of the parts of two designs, or of the holes of two parts. All numbers are indices in
/// the lists of these parts or holes.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct Pairing {
    /// Pairs `[source, target]`, ascending in the source.
    pub(super) pairs: Vec<[usize; 2]>,
    /// Unmatched parts of the source, ascending; they disappear.
    pub(super) source_only: Vec<usize>,
    /// Unmatched parts of the target, ascending; they appear.
    pub(super) target_only: Vec<usize>,
}

impl Pairing {
    /// Lists more parts as unmatched: `parts` of the source and of the target.
    pub(super) fn leave_unmatched(&mut self, parts: [Vec<usize>; 2]) {
        let [source, target] = parts;
        for (unmatched, more) in [
            (&mut self.source_only, source),
            (&mut self.target_only, target),
        ] {
            unmatched.extend(more);
            unmatched.sort_unstable();
        }
    }
}

/// Error in the pairs that the user fixed.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum PairError {
    /// A pair names a part that does not exist.
    #[error("part {part} does not exist: there are {count}, counted from 0; remove this pair")]
    NoSuchPart {
        /// Index that the pair gives for the part.
        part: usize,
        /// Number of parts in the design.
        count: usize,
    },
    /// The part with this index is in two different pairs.
    #[error("part {0} is paired twice; remove one of its pairs")]
    Twice(usize),
}

/// Weight, in the cost of pairing two parts, of the distance between their centres in units of the
/// design's size; the other weights are relative to it.
const POSITION: f64 = 1.0;
/// Weight, in the cost of pairing two parts, of the absolute logarithm of the ratio of their sizes
/// (heuristic).
const SIZE: f64 = 0.15;
/// Weight, in the cost of pairing two parts, of each of the three differences in shape: in
/// roundness, in slenderness and in the number of holes (heuristic).
const SHAPE: f64 = 0.25;

/// Cost of leaving all parts of a design unmatched. A single part costs a share of this in
/// proportion to its area (heuristic).
const UNMATCHED: f64 = 0.3;

/// Returns the centre of each region's outer boundary relative to the design's bounding box, in
/// units of the box's longer side.
pub(super) fn relative_centres(design: &Regions) -> Vec<DVec2> {
    let bounds = design.bounds();
    let (origin, size) = (bounds.centre(), bounds.size().max_element());
    let centre = |region: &Region| PartFeatures::of(&region.outer, 0, origin, size, 0.0).position;
    design.iter().map(centre).collect()
}

/// Pairs the regions of two designs. `fixed` pairs are preserved; `excluded` parts are neither
/// paired nor listed as unmatched.
///
/// Positions are relative to each design's bounding box, so the designs' own positions and sizes do
/// not matter.
///
/// # Errors
/// [`PairError`] if a fixed pair names a part that does not exist, or if a part is in two fixed
/// pairs.
pub(super) fn pair_parts(
    designs: [&Regions; 2],
    looks: &PartAppearances,
    fixed: &[[usize; 2]],
    excluded: [&[usize]; 2],
) -> Result<Pairing, PairError> {
    let [source, target] = Side::BOTH.map(|side| {
        let bounds = designs[side].bounds();
        let (origin, size) = (bounds.centre(), bounds.size().max_element());
        let part = |(k, region): (usize, &Region)| PartFeatures {
            appearance: looks.0[side].get(k).cloned().unwrap_or_default(),
            ..PartFeatures::of(&region.outer, region.holes.len(), origin, size, 0.0)
        };
        designs[side]
            .iter()
            .enumerate()
            .map(part)
            .collect::<Vec<_>>()
    });
    pair(&source, &target, fixed, excluded)
}

/// Pairs the holes of two regions. `fixed` pairs are preserved; `excluded` holes are neither paired
/// nor listed as unmatched. `rotation` is the rotation from source to target in the match of the
/// outer boundaries, in radians.
///
/// # Errors
/// As [`pair_parts`].
pub(super) fn pair_holes(
    source: &Region,
    target: &Region,
    rotation: f64,
    fixed: &[[usize; 2]],
    excluded: [&[usize]; 2],
) -> Result<Pairing, PairError> {
    let parts = |region: &Region, turn: f64| {
        // Origin and size must not depend on the region's rotation.
        let origin = moments(&region.outer).centre;
        let size = region.outer.signed_area().abs().sqrt();
        let part = |hole: &Ring| PartFeatures::of(hole, 0, origin, size, turn);
        region.holes.iter().map(part).collect::<Vec<_>>()
    };
    // Rotate each region by half the angle. Rounding is then the same if source and target are
    // exchanged.
    pair(
        &parts(source, 0.5 * rotation),
        &parts(target, -0.5 * rotation),
        fixed,
        excluded,
    )
}

/// Properties by which parts (or the holes of a part) are compared.
#[derive(Clone, Debug)]
struct PartFeatures {
    /// Centre of the part relative to the design's centre, in units of the design's size.
    position: DVec2,
    /// Logarithm of the ratio of the part's size (the square root of its area) to the design's
    /// size.
    log_size: f64,
    /// 4π · area / perimeter²: 1 for a circle, smaller for other shapes.
    roundness: f64,
    /// Ratio of the shorter to the longer axis of inertia, in [0, 1].
    slenderness: f64,
    /// Number of holes of the part.
    holes: f64,
    /// Properties that do not depend on the shape, such as paint and name.
    appearance: PartAppearance,
}

impl PartFeatures {
    /// Measures a part by its outer ring, or a hole by its ring. `origin` and `size` are the centre
    /// and the size of the design that contains the part, or of the part that contains the hole.
    /// `turn` is a rotation about `origin` in radians.
    fn of(ring: &Ring, holes: usize, origin: DVec2, size: f64, turn: f64) -> Self {
        let moments = moments(ring);
        let area = ring.signed_area().abs();
        // Avoid a division by 0 if the region has no extent.
        let size = if size > 0.0 { size } else { 1.0 };
        let roundness = 2.0 * TAU * area / ring.perimeter().powi(2);
        let position = DVec2::from_angle(turn).rotate((moments.centre - origin) / size);
        let finite_or_zero = |x: f64| if x.is_finite() { x } else { 0.0 };
        Self {
            position: DVec2::new(finite_or_zero(position.x), finite_or_zero(position.y)),
            // Clamp areas that underflow, so that the logarithm is finite.
            log_size: finite_or_zero(0.5 * area.max(f64::MIN_POSITIVE).ln() - size.ln()),
            roundness: finite_or_zero(roundness.min(1.0)),
            slenderness: finite_or_zero(moments.slenderness),
            holes: holes as f64,
            appearance: PartAppearance::default(),
        }
    }

    /// Returns the cost of pairing two parts, from their differences in position, size, shape and
    /// appearance.
    fn pairing_cost(&self, other: &Self) -> f64 {
        let holes = (self.holes - other.holes).abs().min(2.0);
        let form = POSITION * self.position.distance(other.position)
            + SIZE * (self.log_size - other.log_size).abs()
            + SHAPE * (self.roundness - other.roundness).abs()
            + SHAPE * (self.slenderness - other.slenderness).abs()
            + SHAPE * holes;
        self.appearance.cost(&other.appearance, form)
    }

    /// Returns the values by which lists of parts are put into a canonical order.
    fn key(&self) -> [f64; 7] {
        let Self {
            position: p,
            log_size,
            roundness,
            slenderness,
            holes,
            appearance: PartAppearance { height, .. },
        } = *self;
        [p.x, p.y, log_size, roundness, slenderness, holes, height]
    }
}

/// Centre and slenderness of a polygon's boundary.
struct BoundaryMoments {
    centre: DVec2,
    slenderness: f64,
}

/// Computes the moments of the boundary, not of the area, because the area can be zero.
fn moments(ring: &Ring) -> BoundaryMoments {
    // Sum relative to a point of the ring: far from the origin, sums would lose precision.
    let base = ring.points()[0];
    let (mut length, mut sum) = (0.0, DVec2::ZERO);
    for (a, b) in ring.edges() {
        let weight = a.distance(b);
        length += weight;
        sum += weight * (a.midpoint(b) - base);
    }
    let centre = base + sum / length;
    let (mut xx, mut xy, mut yy) = (0.0, 0.0, 0.0);
    for (a, b) in ring.edges() {
        let (p, weight) = (a.midpoint(b) - centre, a.distance(b));
        xx += weight * p.x * p.x;
        xy += weight * p.x * p.y;
        yy += weight * p.y * p.y;
    }
    let (mean, radius) = (0.5 * (xx + yy), (0.5 * (xx - yy)).hypot(xy));
    let ratio = ((mean - radius) / (mean + radius)).max(0.0);
    BoundaryMoments {
        centre,
        slenderness: ratio.sqrt(),
    }
}

/// Pairs two lists of parts: `fixed` pairs first, then the optimal assignment of the others.
fn pair(
    source: &[PartFeatures],
    target: &[PartFeatures],
    fixed: &[[usize; 2]],
    excluded: [&[usize]; 2],
) -> Result<Pairing, PairError> {
    check(fixed, source.len(), target.len())?;
    let unpaired = |pairs: &[[usize; 2]], count: usize, side: usize| -> Vec<usize> {
        (0..count)
            .filter(|k| pairs.iter().all(|pair| pair[side] != *k) && !excluded[side].contains(k))
            .collect()
    };
    let (a, b) = (
        unpaired(fixed, source.len(), 0),
        unpaired(fixed, target.len(), 1),
    );
    let keys = |parts: &[PartFeatures], free: &[usize]| -> Vec<f64> {
        free.iter().flat_map(|&k| parts[k].key()).collect()
    };
    // `assign` requires at most as many rows as columns, so the shorter list gives the rows. Lists
    // of equal length are ordered by their values, so that the reverse pairing has the same result.
    let order = a
        .len()
        .cmp(&b.len())
        .then_with(|| lexicographic(keys(source, &a), keys(target, &b)));
    let mut pairs = fixed.to_vec();
    // Every row is paired, so only columns can stay unmatched. The cost of the unmatched columns is
    // the cost of leaving all columns unmatched, minus that of leaving the paired columns
    // unmatched. The cost of a pair is therefore reduced by the cost of leaving its column
    // unmatched.
    if order == Ordering::Greater {
        let unmatched_cost = unmatched_costs(source);
        let cost =
            |r: usize, c: usize| target[b[r]].pairing_cost(&source[a[c]]) - unmatched_cost[a[c]];
        let assigned = assign(b.len(), a.len(), cost);
        pairs.extend(assigned.iter().enumerate().map(|(r, &c)| [a[c], b[r]]));
    } else {
        let unmatched_cost = unmatched_costs(target);
        let cost =
            |r: usize, c: usize| source[a[r]].pairing_cost(&target[b[c]]) - unmatched_cost[b[c]];
        let assigned = assign(a.len(), b.len(), cost);
        pairs.extend(assigned.iter().enumerate().map(|(r, &c)| [a[r], b[c]]));
    }
    pairs.sort_unstable();
    pairs.dedup();
    let source_only = unpaired(&pairs, source.len(), 0);
    let target_only = unpaired(&pairs, target.len(), 1);
    Ok(Pairing {
        pairs,
        source_only,
        target_only,
    })
}

/// Returns, for each part of a design, the cost of leaving this part unmatched.
fn unmatched_costs(parts: &[PartFeatures]) -> Vec<f64> {
    let areas: Vec<f64> = parts
        .iter()
        .map(|part| (2.0 * part.log_size).exp())
        .collect();
    // Avoid 0 / 0 if all areas underflow.
    let total = areas.iter().sum::<f64>().max(f64::MIN_POSITIVE);
    areas.iter().map(|area| UNMATCHED * area / total).collect()
}

/// Checks that fixed pairs name existing parts, and each part only once.
fn check(fixed: &[[usize; 2]], sources: usize, targets: usize) -> Result<(), PairError> {
    for (side, count) in [sources, targets].into_iter().enumerate() {
        let mut pair_of = vec![None; count];
        for pair in fixed {
            let part = pair[side];
            let slot = pair_of
                .get_mut(part)
                .ok_or(PairError::NoSuchPart { part, count })?;
            if slot.replace(pair).is_some_and(|other| other != pair) {
                return Err(PairError::Twice(part));
            }
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{FillRule, Similarity};

    const NONE: [&[usize]; 2] = [&[], &[]];

    fn block(x: f64, y: f64, w: f64, h: f64) -> Vec<DVec2> {
        [(x, y), (x + w, y), (x + w, y + h), (x, y + h)]
            .map(DVec2::from)
            .to_vec()
    }

    fn regions(rings: &[Vec<DVec2>]) -> Regions {
        Regions::from_rings(rings, FillRule::EvenOdd).expect("area")
    }

    /// Returns a plate with holes.
    fn plate(holes: &[Vec<DVec2>]) -> Regions {
        let mut rings = vec![block(0.0, 0.0, 10.0, 6.0)];
        rings.extend_from_slice(holes);
        regions(&rings)
    }

    fn swapped(pairing: &Pairing) -> Pairing {
        let mut pairs: Vec<_> = pairing.pairs.iter().map(|&[a, b]| [b, a]).collect();
        pairs.sort_unstable();
        Pairing {
            pairs,
            source_only: pairing.target_only.clone(),
            target_only: pairing.source_only.clone(),
        }
    }

    #[test]
    fn a_row_keeps_its_order_wherever_it_is() {
        let row = |k: usize| -> Vec<_> {
            (0..k)
                .map(|i| block(2.0 * i as f64, 0.0, 1.0, 1.5))
                .collect()
        };
        let four = regions(&row(4));
        let moved = Similarity {
            offset: DVec2::new(70.0, -9.0),
            scale: 5.0,
            ..Similarity::IDENTITY
        };
        let centres = |r: &Regions| {
            r.iter()
                .map(|p| p.outer.bounds().centre().x)
                .collect::<Vec<_>>()
        };
        let other = four.transformed(&moved);
        let pairing =
            pair_parts([&four, &other], &PartAppearances::default(), &[], NONE).expect("pairs");
        let (a, b) = (centres(&four), centres(&other));
        assert_eq!(pairing.pairs.len(), 4);
        for [i, j] in pairing.pairs {
            assert!((moved.apply(DVec2::new(a[i], 0.0)).x - b[j]).abs() < 1e-9);
        }
    }

    #[test]
    fn unmatched_parts_are_reported_and_the_reverse_pairing_is_the_inverse() {
        let three = regions(&[
            block(0.0, 0.0, 2.0, 2.0),
            block(5.0, 0.0, 1.0, 1.0),
            block(9.0, 0.0, 2.0, 2.0),
        ]);
        let two = regions(&[block(0.0, 0.0, 2.0, 2.0), block(9.0, 0.0, 2.0, 2.0)]);
        let there =
            pair_parts([&three, &two], &PartAppearances::default(), &[], NONE).expect("pairs");
        assert_eq!(
            (
                there.pairs.len(),
                there.source_only.len(),
                there.target_only.len()
            ),
            (2, 1, 0)
        );
        let middle = three.iter().nth(there.source_only[0]).expect("a part");
        assert!((middle.outer.signed_area() - 1.0).abs() < 1e-9);
        assert_eq!(
            pair_parts([&two, &three], &PartAppearances::default(), &[], NONE),
            Ok(swapped(&there))
        );
    }

    #[test]
    fn a_large_part_is_not_left_unmatched_for_a_closer_small_one() {
        let two = regions(&[block(0.0, 0.0, 2.0, 2.0), block(8.0, 0.0, 2.0, 2.0)]);
        let three = regions(&[
            block(0.0, 0.0, 0.6, 0.6),
            block(3.0, 0.0, 4.0, 4.0),
            block(9.4, 0.0, 0.6, 0.6),
        ]);
        let there =
            pair_parts([&two, &three], &PartAppearances::default(), &[], NONE).expect("pairs");
        let area = |part: usize| three.iter().nth(part).map_or(0.0, Region::area);
        assert_eq!(there.target_only.len(), 1);
        assert!(area(there.target_only[0]) < 1.0, "{there:?}");
        let back = pair_parts([&three, &two], &PartAppearances::default(), &[], NONE);
        assert_eq!(back, Ok(swapped(&there)));
    }

    #[test]
    fn holes_follow_the_rotation_of_their_part() {
        let holes = [
            block(1.0, 1.0, 1.0, 1.0),
            block(8.0, 1.0, 1.0, 1.0),
            block(4.0, 4.0, 1.0, 1.0),
        ];
        let source = plate(&holes);
        for rotation in [0.0, 1.0, std::f64::consts::PI, -2.0] {
            let turn = Similarity {
                rotation,
                ..Similarity::IDENTITY
            };
            let target = source.transformed(&turn);
            let (a, b) = (
                source.iter().next().expect("one"),
                target.iter().next().expect("one"),
            );
            let pairing = pair_holes(a, b, rotation, &[], NONE).expect("pairs");
            assert_eq!(pairing.pairs, vec![[0, 0], [1, 1], [2, 2]]);
            let back = pair_holes(b, a, -rotation, &[], NONE).expect("pairs");
            assert_eq!(back, swapped(&pairing));
        }
    }

    #[test]
    fn fixed_pairs_are_preserved_and_checked() {
        let two = regions(&[block(0.0, 0.0, 2.0, 2.0), block(9.0, 0.0, 2.0, 2.0)]);
        let crossed =
            pair_parts([&two, &two], &PartAppearances::default(), &[[0, 1]], NONE).expect("pairs");
        assert_eq!(crossed.pairs, vec![[0, 1], [1, 0]]);
        assert_eq!(
            pair_parts(
                [&two, &two],
                &PartAppearances::default(),
                &[[0, 1], [0, 0]],
                NONE
            ),
            Err(PairError::Twice(0))
        );
        let missing = PairError::NoSuchPart { part: 7, count: 2 };
        assert_eq!(
            pair_parts([&two, &two], &PartAppearances::default(), &[[0, 7]], NONE),
            Err(missing)
        );
    }
}

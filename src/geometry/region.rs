//! Regions with holes, cleaned so that all later code may trust them.
//!
//! [`Regions`] guarantees simple, disjoint polygons: outer rings
//! counter-clockwise, holes clockwise. Cleaning is a union by fill rule
//! (`i_overlay` on a 64-bit integer grid), which moves points by less than
//! 1e-15 of the size unless they all but coincide. It does not simplify: a noisy outline stays noisy.

use super::sliver::SliverTest;
use super::{
    Bounds, DVec2, DesignSizeError, RANGE_MESSAGE, Repairs, Ring, Similarity, is_in_range,
};
use i_overlay::core::fill_rule::FillRule as OverlayRule;
use i_overlay::core::solver::{Precision, Solver};
use i_overlay::float::simplify::SimplifyShape;

/// How crossings are found: in rounds, each of which joins what is nearer than
/// a radius that grows. By the library's own step of √2, 31 points that nearly
/// lie on one line, over and over, took 2.5 s; by 4, 0.4 s. Drawings need one
/// round or two.
const SOLVER: Solver = Solver {
    precision: Precision {
        start: 0,
        progression: 4,
    },
    ..Solver::AUTO
};

/// One connected piece.
#[derive(Clone, Debug, PartialEq)]
pub struct Region {
    /// The outside, counter-clockwise.
    pub outer: Ring,
    /// The holes, each clockwise.
    pub holes: Vec<Ring>,
}

/// One or more disjoint pieces; only those that were [stacked](Regions::stacked)
/// may lie over each other.
#[derive(Clone, Debug, PartialEq)]
pub struct Regions(Vec<Region>);

impl Region {
    /// The outer ring, then the holes.
    pub fn rings(&self) -> impl Iterator<Item = &Ring> {
        std::iter::once(&self.outer).chain(&self.holes)
    }

    /// Enclosed area, holes left out.
    #[must_use]
    pub fn area(&self) -> f64 {
        self.outer.signed_area() + self.holes.iter().map(Ring::signed_area).sum::<f64>()
    }

    /// Whether `p` lies inside; on a boundary either answer may come.
    #[must_use]
    pub fn contains(&self, p: DVec2) -> bool {
        self.rings().map(|ring| ring.winding(p)).sum::<i32>() != 0
    }
}

/// Which points a set of rings encloses.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FillRule {
    /// Where the rings wind around at all.
    NonZero,
    /// Where the rings wind around an odd number of times.
    EvenOdd,
}

/// Why rings enclose nothing that could be used.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum RegionsError {
    /// A coordinate is no number, or beyond [`MAX_COORDINATE`].
    ///
    /// [`MAX_COORDINATE`]: super::MAX_COORDINATE
    #[error("point {} of outline {} {RANGE_MESSAGE}", point + 1, ring + 1)]
    OutOfRange {
        /// Index of the ring.
        ring: usize,
        /// Index of the point in it.
        point: usize,
    },
    /// All points lie on one another, or as good as.
    #[error(transparent)]
    Size(#[from] DesignSizeError),
    /// No area is left.
    #[error("the outlines enclose no area; draw a closed, filled shape")]
    Empty,
}

impl Regions {
    /// Smallest area, relative to the square of the size, that counts as a
    /// piece, however it came about. A self-touching outline leaves slivers of about 1e-18.
    const MIN_RELATIVE_AREA: f64 = 1e-14;

    /// Points nearer than this to the one before, relative to the size, are one with
    /// it. An outline that ends where it began is left with a last edge of about
    /// 1e-15, which vanishes where the outline is made small.
    const MIN_RELATIVE_EDGE: f64 = 1e-12;

    /// Cleans the rings: self-crossings, overlaps, duplicates and collinear
    /// points are resolved by the fill rule. Rings of fewer than three points
    /// enclose nothing and are left out.
    ///
    /// # Errors
    /// [`RegionsError`] if a coordinate is out of range or nothing is enclosed.
    ///
    /// ```
    /// use morphospace::geometry::{DVec2, FillRule, Regions};
    /// let square = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)].map(DVec2::from).to_vec();
    /// let regions = Regions::from_rings(&[square], FillRule::NonZero)?;
    /// assert!((regions.area() - 1.0).abs() < 1e-9);
    /// # Ok::<(), morphospace::geometry::RegionsError>(())
    /// ```
    pub fn from_rings(rings: &[Vec<DVec2>], rule: FillRule) -> Result<Self, RegionsError> {
        check_range(rings)?;
        Self::cleaned(rings, rule).map(|(regions, _)| regions)
    }

    /// As [`Regions::from_rings`], but an outline that is there twice counts
    /// once, and what had to be repaired is told.
    ///
    /// # Errors
    /// As [`Regions::from_rings`].
    pub fn from_rings_reporting(
        rings: &[Vec<DVec2>],
        rule: FillRule,
    ) -> Result<(Self, Repairs), RegionsError> {
        check_range(rings)?;
        let (kept, found) = Repairs::find(rings);
        let (regions, slivers) = Self::cleaned(&kept, rule)?;
        Ok((regions, Repairs { slivers, ..found }))
    }

    /// The regions and how many slivers were left out.
    fn cleaned(rings: &[Vec<DVec2>], rule: FillRule) -> Result<(Self, usize), RegionsError> {
        let bounds = Bounds::of(rings.iter().flatten().copied()).ok_or(RegionsError::Empty)?;
        let extent = DesignSizeError::check(&bounds)?;
        let area = Self::MIN_RELATIVE_AREA * extent * extent;
        let smallest = SliverLimits {
            area,
            edge: Self::MIN_RELATIVE_EDGE * extent,
            drawn: SliverTest::of(rings, extent, area),
        };
        let origin = bounds.centre(); // coordinates about zero use the grid best
        let subject: Vec<Vec<[f64; 2]>> = rings
            .iter()
            .filter(|ring| ring.len() >= 3)
            .map(|ring| ring.iter().map(|&p| (p - origin).to_array()).collect())
            .collect();
        // A grid of 32 bits would move points by some 1e-9 of the size.
        let shapes =
            subject.simplify_shape_custom_as::<i64>(rule.into(), Default::default(), SOLVER);
        let found: usize = shapes.iter().map(Vec::len).sum();
        let regions: Vec<Region> = shapes
            .into_iter()
            .filter_map(|shape| region_from(shape, origin, &smallest))
            .collect();
        if regions.is_empty() {
            return Err(RegionsError::Empty);
        }
        // The holes of an outside that was left out are slivers as well.
        let kept: usize = regions.iter().map(|region| 1 + region.holes.len()).sum();
        Ok((Self(regions), found - kept))
    }

    /// The pieces of several layers, one layer after the other: pieces of two
    /// layers may overlap, those of one do not. None of no layers.
    #[must_use]
    pub fn stacked(layers: impl IntoIterator<Item = Self>) -> Option<Self> {
        let pieces: Vec<Region> = layers.into_iter().flat_map(|layer| layer.0).collect();
        (!pieces.is_empty()).then_some(Self(pieces))
    }

    /// Only the pieces with these numbers; none of no pieces.
    pub(crate) fn only(&self, numbers: &[usize]) -> Option<Self> {
        let pieces = numbers.iter().filter_map(|&k| self.0.get(k).cloned());
        let pieces: Vec<Region> = pieces.collect();
        (!pieces.is_empty()).then_some(Self(pieces))
    }

    /// Each piece as another.
    pub(super) fn mapped(&self, map: impl Fn(&Region) -> Region) -> Self {
        Self(self.0.iter().map(map).collect())
    }

    /// The pieces.
    pub fn iter(&self) -> impl Iterator<Item = &Region> {
        self.0.iter()
    }

    /// How many pieces there are, at least one.
    #[must_use]
    #[expect(clippy::len_without_is_empty, reason = "never empty")]
    pub fn len(&self) -> usize {
        self.0.len()
    }

    /// All rings: each outer one followed by its holes.
    pub fn rings(&self) -> impl Iterator<Item = &Ring> {
        self.0.iter().flat_map(Region::rings)
    }

    /// Enclosed area, holes left out.
    #[must_use]
    pub fn area(&self) -> f64 {
        self.rings().map(Ring::signed_area).sum()
    }

    /// The smallest box around all pieces.
    #[must_use]
    pub fn bounds(&self) -> Bounds {
        // There is a piece: none is an error when regions are made.
        let first = self.0[0].outer.bounds();
        self.0
            .iter()
            .fold(first, |b, region| b.union(&region.outer.bounds()))
    }

    /// Whether `p` lies inside; on a boundary either answer may come.
    #[must_use]
    pub fn contains(&self, p: DVec2) -> bool {
        // Holes wind the other way: in them the sum is 0.
        self.rings().map(|ring| ring.winding(p)).sum::<i32>() != 0
    }

    /// The regions laid down by a similarity; a mirror keeps orientations.
    #[must_use]
    pub fn transformed(&self, by: &Similarity) -> Self {
        let place = |ring: &Ring| {
            let moved = ring.mapped(|p| by.apply(p));
            if by.mirror { moved.reversed() } else { moved }
        };
        Self(
            self.0
                .iter()
                .map(|r| Region {
                    outer: place(&r.outer),
                    holes: r.holes.iter().map(place).collect(),
                })
                .collect(),
        )
    }
}

impl From<FillRule> for OverlayRule {
    fn from(rule: FillRule) -> Self {
        match rule {
            FillRule::NonZero => Self::NonZero,
            FillRule::EvenOdd => Self::EvenOdd,
        }
    }
}

fn check_range(rings: &[Vec<DVec2>]) -> Result<(), RegionsError> {
    for (ring, points) in rings.iter().enumerate() {
        if let Some(point) = points.iter().position(|&p| !is_in_range(p)) {
            return Err(RegionsError::OutOfRange { ring, point });
        }
    }
    Ok(())
}

/// What is smaller does not count.
struct SliverLimits {
    area: f64,
    edge: f64,
    drawn: SliverTest,
}

impl SliverLimits {
    fn is_sliver(&self, contour: &Ring) -> bool {
        contour.signed_area().abs() <= self.area || self.drawn.leaves(contour)
    }
}

/// One cleaned shape, outer contour first; `None` for a sliver.
fn region_from(
    shape: Vec<Vec<[f64; 2]>>,
    origin: DVec2,
    smallest: &SliverLimits,
) -> Option<Region> {
    let is_same = |a: DVec2, b: DVec2| a.distance_squared(b) <= smallest.edge * smallest.edge;
    let mut rings = shape.into_iter().filter_map(|contour| {
        let points = contour.into_iter().map(|p| DVec2::from(p) + origin);
        let mut points: Vec<DVec2> = points.collect();
        points.dedup_by(|b, a| is_same(*a, *b));
        while points.len() > 1 && is_same(points[0], points[points.len() - 1]) {
            points.pop();
        }
        Ring::new(points).ok()
    });
    let outer = oriented(rings.next()?, true);
    if smallest.is_sliver(&outer) {
        return None;
    }
    let holes = rings
        .map(|hole| oriented(hole, false))
        .filter(|hole| !smallest.is_sliver(hole))
        .collect();
    Some(Region { outer, holes })
}

fn oriented(ring: Ring, ccw: bool) -> Ring {
    if (ring.signed_area() > 0.0) == ccw {
        ring
    } else {
        ring.reversed()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{MAX_COORDINATE, MIN_SIZE};
    use proptest::prelude::*;

    fn ring(points: &[(f64, f64)]) -> Vec<DVec2> {
        points.iter().map(|&p| p.into()).collect()
    }

    #[test]
    fn a_bow_tie_becomes_two_pieces() {
        let bow = ring(&[(0.0, 0.0), (2.0, 2.0), (2.0, 0.0), (0.0, 2.0)]);
        let regions = Regions::from_rings(&[bow], FillRule::EvenOdd).expect("area");
        assert_eq!(regions.len(), 2);
        assert!((regions.area() - 2.0).abs() < 1e-9);
    }

    #[test]
    fn a_hole_runs_clockwise_and_is_outside() {
        let outer = ring(&[(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (0.0, 4.0)]);
        let inner = ring(&[(1.0, 1.0), (3.0, 1.0), (3.0, 3.0), (1.0, 3.0)]);
        let regions = Regions::from_rings(&[outer, inner], FillRule::EvenOdd).expect("area");
        assert_eq!(regions.rings().count(), 2);
        assert!((regions.area() - 12.0).abs() < 1e-9);
        assert!(!regions.contains(DVec2::new(2.0, 2.0)));
        assert!(regions.contains(DVec2::new(0.5, 0.5)));
        let mirrored = regions.transformed(&Similarity {
            mirror: true,
            ..Similarity::IDENTITY
        });
        assert!((mirrored.area() - 12.0).abs() < 1e-9);
    }

    /// Any finite number, the extremes as often as the ordinary.
    fn finite() -> impl Strategy<Value = f64> {
        use proptest::num::f64::{NEGATIVE, NORMAL, POSITIVE, SUBNORMAL, ZERO};
        let bounds = [
            1e150,
            1e18,
            MAX_COORDINATE.next_up(),
            1e15,
            1e-18,
            1e-160,
            f64::MAX,
        ];
        prop_oneof![
            POSITIVE | NEGATIVE | NORMAL | SUBNORMAL | ZERO,
            (-4i32..5).prop_map(f64::from),
            prop::sample::select(bounds.to_vec()),
            (-4i32..5).prop_map(|i| 1e15 + f64::from(i)),
        ]
    }

    proptest! {
        #[test]
        fn any_finite_numbers_make_regions_or_are_refused(
            rings in prop::collection::vec(
                prop::collection::vec((finite(), finite()).prop_map(DVec2::from), 0..9), 0..4),
            even_odd in any::<bool>(),
        ) {
            let rule = if even_odd { FillRule::EvenOdd } else { FillRule::NonZero };
            let reported = Regions::from_rings_reporting(&rings, rule);
            for regions in [Regions::from_rings(&rings, rule), reported.map(|(found, _)| found)] {
                let Ok(regions) = regions else { continue };
                prop_assert!(regions.area() > 0.0 && regions.area().is_finite());
                for region in regions.iter() {
                    prop_assert!(region.outer.signed_area() > 0.0);
                    prop_assert!(region.holes.iter().all(|hole| hole.signed_area() < 0.0));
                }
            }
        }
    }

    #[test]
    fn the_bound_is_for_large_and_for_small() {
        let square = |size: f64| {
            let points = [(0.0, 0.0), (size, 0.0), (size, size), (0.0, size)];
            Regions::from_rings(&[ring(&points)], FillRule::NonZero)
        };
        for size in [MAX_COORDINATE, MIN_SIZE] {
            let area = square(size).expect("in range").area();
            assert!((area / (size * size) - 1.0).abs() < 1e-9);
        }
        let far = square(MAX_COORDINATE.next_up());
        assert!(matches!(
            far,
            Err(RegionsError::OutOfRange { ring: 0, point: 1 })
        ));
        let small = square(MIN_SIZE.next_down());
        assert!(matches!(small, Err(RegionsError::Size(_))));
        let away = |size: f64| {
            let points = [(0.0, 0.0), (size, 0.0), (size, size), (0.0, size)];
            let points = points.map(|(x, y)| (1e15 + x, y));
            Regions::from_rings(&[ring(&points)], FillRule::NonZero)
        };
        let area = away(2000.0).expect("fine enough").area();
        assert!((area / 4e6 - 1.0).abs() < 1e-3, "{area}");
        let coarse = away(10.0).expect_err("too coarse").to_string();
        assert!(
            coarse.contains("1e15 away") && coarse.contains("move"),
            "{coarse}"
        );
    }

    #[test]
    fn an_outline_that_all_but_ends_where_it_began_has_no_last_edge() {
        let last = (1.0, 24.0 + 6e-14);
        let nearly = ring(&[(1.0, 24.0), (0.0, 0.0), (24.0, 0.0), (24.0, 24.0), last]);
        let regions = Regions::from_rings(&[nearly], FillRule::NonZero).expect("a region");
        let points = regions.rings().next().expect("an outline").points();
        assert_eq!(points.len(), 4, "{points:?}");
    }

    #[test]
    fn nothing_enclosed_is_an_error() {
        let line = ring(&[(0.0, 0.0), (1.0, 1.0), (2.0, 2.0)]);
        assert_eq!(
            Regions::from_rings(&[line], FillRule::NonZero),
            Err(RegionsError::Empty)
        );
        assert_eq!(
            Regions::from_rings(&[], FillRule::NonZero),
            Err(RegionsError::Empty)
        );
        let nan = ring(&[(0.0, 0.0), (f64::NAN, 1.0), (2.0, 2.0)]);
        assert!(matches!(
            Regions::from_rings(&[nan], FillRule::NonZero),
            Err(RegionsError::OutOfRange { ring: 0, point: 1 })
        ));
    }

    #[test]
    fn edges_that_all_but_coincide_are_cleaned_soon() {
        // Found by the fuzzer, which waited 15 s for it.
        let rings: [&[(f64, f64)]; 5] = [
            &[
                (1.0843959206559366e16, 1.0843961455707782e16),
                (1.0843961455707782e16, 2429515387216289.5),
                (2.1429373431091396e-307, 5.076791793838071e-81),
                (1.0844159026807362e16, 1408271740096720.8),
                (1.0843961455690886e16, 6.032153789438771e-293),
            ],
            &[
                (1.0843961455707782e16, -2.5301701079419506e-98),
                (1.0843961455707782e16, 1.0843961455707782e16),
                (1.084396145570799e16, 5.076791793838071e-81),
                (1.0843961455707782e16, 1.0843965296738682e16),
            ],
            &[
                (1.0843961455707782e16, 1408271740096720.8),
                (1.0843961455709318e16, -9.169109864596823e-101),
                (-1.06578932171617e-220, 1.0843961455707782e16),
                (1.0843961455707782e16, 1.1072663377631062e16),
                (1.0843961455707782e16, 1.0843961455673344e16),
                (1.084396145570799e16, 2524806.525490196),
                (1.0843961455707782e16, 1.084396148041127e16),
                (1.0843994741704192e16, 1.0843961455707782e16),
                (1.0843987225511464e16, -2.752134346067909e-100),
                (1.0843961469392466e16, -2.1430515280367397e-307),
            ],
            &[
                (572194474715240.4, 1.1072663377631062e16),
                (1.0843961455707782e16, 1.0843961455673344e16),
                (1.084396145570799e16, 4.218927018705964e-149),
                (1.0843961455707782e16, 1.0844132109092486e16),
                (1.0843961446925958e16, 4399840224190881.5),
                (1.0843961455707782e16, 1.0843961455707782e16),
                (562949953421312.0, 1.0705345681196678e16),
            ],
            &[
                (1.0843961455707782e16, 1.0844858295211862e16),
                (1.084396410650791e16, 1.0843961455707782e16),
                (-2.5301701079419506e-98, 1.084396145576103e16),
                (1.0696051371968134e16, 1.0843961446891654e16),
                (8.5073e-320, 0.0),
            ],
        ];
        let rings = rings.map(|ring| ring.iter().copied().map(DVec2::from).collect::<Vec<_>>());
        let regions = Regions::from_rings(&rings, FillRule::EvenOdd).expect("an area");
        assert!(regions.area().is_finite() && regions.area() > 0.0);
    }
}

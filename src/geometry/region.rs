//! Regions with holes, cleaned so that later code can rely on them.
//!
//! [`Regions`] guarantees simple polygons with counter-clockwise outer rings and clockwise holes.
//! Regions are disjoint unless they were [stacked](Regions::stacked). Cleaning is a union by fill
//! rule (`i_overlay` on a 64-bit integer grid). It moves points by less than 1e-15 of the size of
//! all rings, unless points nearly coincide. It does not simplify: a noisy outline stays noisy.

use super::sliver::SliverTest;
use super::{
    Bounds, DVec2, DesignSizeError, RANGE_MESSAGE, Repairs, Ring, Similarity, is_in_range,
    signed_area,
};
use i_overlay::core::fill_rule::FillRule as OverlayRule;
use i_overlay::core::solver::{Precision, Solver};
use i_overlay::float::simplify::SimplifyShape;
use std::collections::{HashMap, HashSet};

/// Settings of the crossing search in `i_overlay`. The search runs in rounds, each of which joins
/// points closer than a radius. A `progression` of 4 quadruples the radius from round to round.
/// This is faster than the library's default, a factor of √2, and bounds the number of rounds for
/// points that nearly lie on one line (heuristic).
const SOLVER: Solver = Solver {
    precision: Precision {
        start: 0,
        progression: 4,
    },
    ..Solver::AUTO
};

/// Connected region with holes.
#[derive(Clone, Debug, PartialEq)]
pub struct Region {
    /// Outer boundary, counter-clockwise.
    pub outer: Ring,
    /// Holes, each clockwise.
    pub holes: Vec<Ring>,
}

/// One or more disjoint regions; only those that were [stacked](Regions::stacked) may overlap.
#[derive(Clone, Debug, PartialEq)]
pub struct Regions(Vec<Region>);

impl Region {
    /// Returns the outer ring, then the holes.
    pub fn rings(&self) -> impl Iterator<Item = &Ring> {
        std::iter::once(&self.outer).chain(&self.holes)
    }

    /// Returns the enclosed area, without the holes.
    #[must_use]
    pub fn area(&self) -> f64 {
        self.outer.signed_area() + self.holes.iter().map(Ring::signed_area).sum::<f64>()
    }

    /// Returns whether `p` lies inside; on a boundary the answer may be either.
    #[must_use]
    pub fn contains(&self, p: DVec2) -> bool {
        self.rings().map(|ring| ring.winding(p)).sum::<i32>() != 0
    }
}

/// Rule that decides which points a set of rings encloses.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FillRule {
    /// The points whose winding number is not zero.
    NonZero,
    /// The points whose winding number is odd.
    EvenOdd,
}

/// Reason why rings form no region. Indices start at 0 in fields and at 1 in messages.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum RegionsError {
    /// A coordinate is not a number, or its absolute value exceeds [`MAX_COORDINATE`].
    ///
    /// [`MAX_COORDINATE`]: super::MAX_COORDINATE
    #[error("point {} of outline {} {RANGE_MESSAGE}", point + 1, ring + 1)]
    OutOfRange {
        /// Index of the ring.
        ring: usize,
        /// Index of the point in the ring.
        point: usize,
    },
    /// The design is too small, or too far from the origin for its size.
    #[error(transparent)]
    Size(#[from] DesignSizeError),
    /// The rings enclose no area.
    #[error("the outlines enclose no area; draw a closed, filled shape")]
    Empty,
}

impl Regions {
    /// Minimum area of a region or hole, as a fraction of the square of the longer side of all
    /// rings' bounding box; a smaller one is removed as a sliver (tolerance: outlines that touch
    /// themselves leave slivers of about 1e-18).
    const MIN_RELATIVE_AREA: f64 = 1e-14;

    /// Minimum distance between neighbouring points, as a fraction of the longer side of all rings'
    /// bounding box; a point closer to the previous one is merged with it (tolerance: an outline
    /// that ends where it began keeps a last edge of about 1e-15, which vanishes when the outline
    /// is scaled down).
    const MIN_RELATIVE_EDGE: f64 = 1e-12;

    /// Creates regions from rings. The fill rule resolves self-crossings, overlaps, duplicates and
    /// collinear points. Rings with fewer than three points are ignored.
    ///
    /// # Errors
    /// [`RegionsError`] if a coordinate is out of range, if the rings are too small or too far from
    /// the origin, or if they enclose nothing.
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
        Self::clean(rings, rule).map(|(regions, _)| regions)
    }

    /// As [`Regions::from_rings`], but outlines that occur several times count once, and the
    /// repairs are returned too.
    ///
    /// # Errors
    /// As [`Regions::from_rings`].
    pub fn from_rings_reporting(
        rings: &[Vec<DVec2>],
        rule: FillRule,
    ) -> Result<(Self, Repairs), RegionsError> {
        check_range(rings)?;
        let (used_rings, repairs) = Repairs::find(rings);
        let (regions, slivers) = Self::clean(&used_rings, rule)?;
        Ok((regions, Repairs { slivers, ..repairs }))
    }

    /// Returns the cleaned regions and the number of slivers that were removed.
    fn clean(rings: &[Vec<DVec2>], rule: FillRule) -> Result<(Self, usize), RegionsError> {
        let bounds = Bounds::of(rings.iter().flatten().copied()).ok_or(RegionsError::Empty)?;
        let extent = DesignSizeError::check(&bounds)?;
        let area = Self::MIN_RELATIVE_AREA * extent * extent;
        let smallest = SliverLimits {
            area,
            edge: Self::MIN_RELATIVE_EDGE * extent,
            leftover_test: SliverTest::of(rings, extent, area),
        };
        let origin = bounds.centre(); // the grid is finest around zero
        let subject: Vec<Vec<[f64; 2]>> = rings
            .iter()
            .filter(|ring| ring.len() >= 3)
            .map(|ring| ring.iter().map(|&p| (p - origin).to_array()).collect())
            .collect();
        // Use a grid of 64 bits: one of 32 bits would move points by about 1e-9 of the size.
        let shapes =
            subject.simplify_shape_custom_as::<i64>(rule.into(), Default::default(), SOLVER);
        let shapes = shapes.into_iter();
        let shapes: Vec<Vec<Vec<DVec2>>> = shapes
            .map(|shape| contours_of(shape, origin, &smallest))
            .collect();
        let contours: usize = shapes.iter().map(Vec::len).sum();
        let regions: Vec<Region> = shapes
            .into_iter()
            .filter_map(|shape| region_from(shape, &smallest))
            .collect();
        if regions.is_empty() {
            return Err(RegionsError::Empty);
        }
        // The holes of a removed sliver count as slivers too.
        let remaining: usize = regions.iter().map(|region| 1 + region.holes.len()).sum();
        Ok((Self(regions), contours - remaining))
    }

    /// Combines the regions of several layers, layer by layer, into one list. Regions of different
    /// layers may overlap; those of one layer do not. Returns `None` for no layers.
    #[must_use]
    pub fn stacked(layers: impl IntoIterator<Item = Self>) -> Option<Self> {
        let pieces: Vec<Region> = layers.into_iter().flat_map(|layer| layer.0).collect();
        (!pieces.is_empty()).then_some(Self(pieces))
    }

    /// Returns the regions with the given indices, ignoring indices that do not exist. Returns
    /// `None` if no region remains.
    pub(crate) fn subset(&self, numbers: &[usize]) -> Option<Self> {
        let pieces = numbers.iter().filter_map(|&k| self.0.get(k).cloned());
        let pieces: Vec<Region> = pieces.collect();
        (!pieces.is_empty()).then_some(Self(pieces))
    }

    /// Returns the regions with each one replaced by its image under `map`.
    pub(super) fn map_regions(&self, map: impl Fn(&Region) -> Region) -> Self {
        Self(self.0.iter().map(map).collect())
    }

    /// Returns the regions in order.
    pub fn iter(&self) -> impl Iterator<Item = &Region> {
        self.0.iter()
    }

    /// Returns the number of regions, at least one.
    #[must_use]
    #[expect(clippy::len_without_is_empty, reason = "never empty")]
    pub fn len(&self) -> usize {
        self.0.len()
    }

    /// Returns all rings: each outer ring, followed by its holes.
    pub fn rings(&self) -> impl Iterator<Item = &Ring> {
        self.0.iter().flat_map(Region::rings)
    }

    /// Returns the enclosed area of all regions, without the holes.
    #[must_use]
    pub fn area(&self) -> f64 {
        self.rings().map(Ring::signed_area).sum()
    }

    /// Returns the smallest box around all regions.
    #[must_use]
    pub fn bounds(&self) -> Bounds {
        // There is at least one region.
        let first = self.0[0].outer.bounds();
        self.0
            .iter()
            .fold(first, |b, region| b.union(&region.outer.bounds()))
    }

    /// Returns whether `p` lies inside; on a boundary the answer may be either.
    #[must_use]
    pub fn contains(&self, p: DVec2) -> bool {
        // Holes run the other way, so the winding numbers cancel inside them.
        self.rings().map(|ring| ring.winding(p)).sum::<i32>() != 0
    }

    /// Applies a similarity. If it mirrors, the points of each ring are reversed, so that the ring
    /// keeps its orientation.
    #[must_use]
    pub fn transformed(&self, by: &Similarity) -> Self {
        let place = |ring: &Ring| {
            let mapped = ring.mapped(|p| by.apply(p));
            if by.mirror { mapped.reversed() } else { mapped }
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

/// Checks that all points are in range.
fn check_range(rings: &[Vec<DVec2>]) -> Result<(), RegionsError> {
    for (ring, points) in rings.iter().enumerate() {
        if let Some(point) = points.iter().position(|&p| !is_in_range(p)) {
            return Err(RegionsError::OutOfRange { ring, point });
        }
    }
    Ok(())
}

/// Limits for removing slivers: contours with at most the area `area`, or too thin by
/// `leftover_test`, are removed. Points at most `edge` apart are merged.
struct SliverLimits {
    area: f64,
    edge: f64,
    leftover_test: SliverTest,
}

impl SliverLimits {
    /// Returns whether a contour is too small or too thin to keep.
    fn is_sliver(&self, contour: &Ring) -> bool {
        contour.signed_area().abs() <= self.area || self.leftover_test.is_sliver(contour)
    }
}

/// Returns the contours of one cleaned shape, the outer one first, with neighbouring points that
/// nearly coincide merged. Contours that touch themselves are split (see [`simple_loops`]).
fn contours_of(
    shape: Vec<Vec<[f64; 2]>>,
    origin: DVec2,
    smallest: &SliverLimits,
) -> Vec<Vec<DVec2>> {
    let is_same = |a: DVec2, b: DVec2| a.distance_squared(b) <= smallest.edge * smallest.edge;
    let mut outer = None;
    let mut holes = Vec::new();
    for contour in shape {
        let points = contour.into_iter().map(|p| DVec2::from(p) + origin);
        let mut points: Vec<DVec2> = points.collect();
        // `dedup_by` passes the later point first.
        points.dedup_by(|b, a| is_same(*a, *b));
        while points.len() > 1 && is_same(points[0], points[points.len() - 1]) {
            points.pop();
        }
        let (first, others) = simple_loops(points, outer.is_none(), smallest);
        match outer {
            None => outer = Some(first),
            Some(_) => holes.push(first),
        }
        holes.extend(others);
    }
    outer.into_iter().chain(holes).collect()
}

/// Converts the contours of one cleaned shape, outer contour first, into a region; `None` for a
/// sliver.
fn region_from(contours: Vec<Vec<DVec2>>, smallest: &SliverLimits) -> Option<Region> {
    let mut rings = contours
        .into_iter()
        .filter_map(|points| Ring::new(points).ok());
    let outer = with_orientation(rings.next()?, true);
    if smallest.is_sliver(&outer) {
        return None;
    }
    let holes = rings
        .map(|hole| with_orientation(hole, false))
        .filter(|hole| !smallest.is_sliver(hole))
        .collect();
    Some(Region { outer, holes })
}

/// Splits a contour that touches itself in corners into loops that do not. Returns the loop that is
/// the contour of the region (`is_outer`) or one of its holes, and the other holes. A contour with
/// loops that are no holes, as two squares that touch in a corner, or that are slivers is returned
/// whole.
fn simple_loops(
    contour: Vec<DVec2>,
    is_outer: bool,
    smallest: &SliverLimits,
) -> (Vec<DVec2>, Vec<Vec<DVec2>>) {
    let key = |p: DVec2| [p.x + 0.0, p.y + 0.0].map(f64::to_bits);
    let mut seen = HashSet::with_capacity(contour.len());
    if contour.iter().all(|&p| seen.insert(key(p))) {
        return (contour, Vec::new());
    }
    // The points of the loop that is still open, and the index of each of them.
    let (mut open, mut index_of): (Vec<DVec2>, HashMap<[u64; 2], usize>) = Default::default();
    let mut loops = Vec::new();
    for &p in &contour {
        if let Some(&first) = index_of.get(&key(p)) {
            let closed = open.split_off(first);
            closed.iter().for_each(|&q| {
                index_of.remove(&key(q));
            });
            loops.push(closed);
        }
        index_of.insert(key(p), open.len());
        open.push(p);
    }
    loops.push(open);
    let area = |points: &Vec<DVec2>| signed_area(points);
    loops.sort_by(|a, b| area(b).abs().total_cmp(&area(a).abs()));
    // Loops inside the outer contour run the other way; the loops of holes run alike.
    let runs_as_first = |k: usize| (area(&loops[k]) > 0.0) == (area(&loops[0]) > 0.0);
    let is_sliver = |points: &Vec<DVec2>| {
        Ring::new(points.clone()).map_or(true, |ring| smallest.is_sliver(&ring))
    };
    if (1..loops.len()).any(|k| runs_as_first(k) == is_outer) || loops.iter().any(is_sliver) {
        return (contour, Vec::new());
    }
    let first = loops.remove(0);
    (first, loops)
}

/// Returns the ring counter-clockwise if `ccw`, and clockwise otherwise.
fn with_orientation(ring: Ring, ccw: bool) -> Ring {
    if (ring.signed_area() > 0.0) == ccw {
        ring
    } else {
        ring.reversed()
    }
}

#[cfg(test)]
mod tests;

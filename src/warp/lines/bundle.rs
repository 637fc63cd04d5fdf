//! Lines that move the plane together, and places moved by them.
//!
//! All coordinates and lengths are scaled by one power of two, so that the
//! largest coordinate is about 1. That changes no digit, and leaves exponents
//! to spare for products of many.

use super::kernel::{self, BLOCK, LARGEST_A, LEAST_A, Lines, Places, Row, Sums};
use super::line::{Feature, Line};
use super::map::Segment;
use super::options::Constants;
use crate::geometry::{Bounds, DVec2};
use pulp::Arch;

/// Lines that move the plane together, into N designs.
#[derive(Clone, Debug)]
pub(super) struct Bundle<const N: usize> {
    pub(super) arch: Arch,
    constants: Constants,
    plane: Scaled,
    /// a, scaled.
    a: f64,
    lines: Vec<Line<N>>,
}

impl<const N: usize> Bundle<N> {
    /// No lines, with memory for so many.
    pub(super) fn new(constants: Constants, capacity: usize) -> Self {
        Self {
            arch: Arch::new(),
            constants,
            plane: Scaled::default(),
            a: constants.a,
            lines: Vec::with_capacity(capacity),
        }
    }

    /// Replaces the lines. Those that overflowed on their way are left out.
    pub(super) fn fill(&mut self, features: impl Iterator<Item = Feature<N>> + Clone) {
        let features = features.filter(Feature::is_finite);
        self.plane = Scaled::around(features.clone());
        let (plane, a) = (self.plane, self.constants.a * self.plane.per_unit);
        self.a = a.clamp(LEAST_A, LARGEST_A);
        self.lines.clear();
        let lines = features.map(|feature| Line::new(&plane.feature(&feature), a));
        self.lines.extend(lines);
        self.weigh();
    }

    /// Makes strengths of lengths, relative to the greatest.
    fn weigh(&mut self) {
        let lengths = self.lines.iter().map(|line| line.strength);
        let greatest = lengths.fold(0.0, f64::max);
        let exponent = self.constants.b * self.constants.p;
        for line in &mut self.lines {
            line.strength = (line.strength / greatest).min(1.0).powf(exponent);
        }
    }

    /// The lines, scaled.
    pub(super) fn lines(&self) -> &[Line<N>] {
        &self.lines
    }

    /// The paper's b.
    pub(super) fn falloff(&self) -> f64 {
        self.constants.b
    }

    /// A place as the lines know it.
    pub(super) fn scaled(&self, place: DVec2) -> DVec2 {
        place * self.plane.per_unit - self.plane.centre
    }

    /// Where each place is looked up in each design. All slices are as long
    /// as `places`, or what is beyond the shortest is left as it is.
    pub(super) fn map_into(&self, places: &[DVec2], mut designs: [&mut [DVec2]; N]) {
        for (block, places) in places.chunks(BLOCK).enumerate() {
            let last = places.len() - 1;
            let block_of_places = block_of(|lane| places[lane.min(last)]);
            let mut sums = Sums::ZERO;
            self.add(&self.lines, &block_of_places, places.len(), &mut sums);
            let means = self.means(&sums);
            for (design, [dx, dy]) in designs.iter_mut().zip(&means) {
                let design = design.iter_mut().skip(block * BLOCK);
                for (lane, (out, &place)) in design.zip(places).enumerate() {
                    *out = place + DVec2::new(dx[lane], dy[lane]);
                }
            }
        }
    }

    /// Adds the part of some of the lines to the sums of the first `count`
    /// places.
    pub(super) fn add(&self, lines: &[Line<N>], xy: &[Row; 2], count: usize, sums: &mut Sums<N>) {
        let [x, y] = xy;
        let places = Places {
            x,
            y,
            count,
            per_unit: self.plane.per_unit,
            centre: self.plane.centre,
        };
        let (a, b) = (self.a, self.constants.b);
        kernel::add(self.arch, Lines { lines, a, b }, places, sums);
    }

    /// What is to be added to places, in each design, x and y: Σ w D / Σ w,
    /// and nothing where there are no lines.
    pub(super) fn means(&self, sums: &Sums<N>) -> [[Row; 2]; N] {
        kernel::means(self.arch, sums, self.plane.unit)
    }
}

/// The coordinates of so many places, x and y.
pub(super) fn block_of(place: impl Fn(usize) -> DVec2) -> [Row; 2] {
    let mut block = [[0.0; BLOCK]; 2];
    let [x, y] = &mut block;
    for (lane, (x, y)) in x.iter_mut().zip(y).enumerate() {
        [*x, *y] = place(lane).to_array();
    }
    block
}

/// The plane with features about its origin, none much beyond 1.
#[derive(Clone, Copy, Debug)]
struct Scaled {
    /// Units of the plane in one of the scaled plane, and its reciprocal.
    unit: f64,
    per_unit: f64,
    /// What lies at the origin, in scaled coordinates.
    centre: DVec2,
}

impl Default for Scaled {
    fn default() -> Self {
        Self {
            unit: 1.0,
            per_unit: 1.0,
            centre: DVec2::ZERO,
        }
    }
}

impl Scaled {
    fn around<const N: usize>(features: impl Iterator<Item = Feature<N>> + Clone) -> Self {
        let points = features.flat_map(|feature| feature.points());
        let extent = points.clone().map(|p| p.abs().max_element());
        let unit = power_of_two_at(extent.fold(0.0, f64::max));
        let per_unit = unit.recip();
        let bounds = Bounds::of(points.map(|p| p * per_unit));
        Self {
            unit,
            per_unit,
            centre: bounds.map_or(DVec2::ZERO, |bounds| bounds.centre()),
        }
    }

    fn feature<const N: usize>(&self, feature: &Feature<N>) -> Feature<N> {
        let segment = |segment: Segment| segment.map(|p| p * self.per_unit - self.centre);
        Feature {
            in_frame: segment(feature.in_frame),
            in_designs: feature.in_designs.map(segment),
            nominal: feature.nominal.map(|length| length * self.per_unit),
        }
    }
}

/// The power of two at or below a magnitude; both it and its reciprocal are
/// normal. 1 for 0.
fn power_of_two_at(magnitude: f64) -> f64 {
    if magnitude == 0.0 {
        return 1.0;
    }
    let exponent = magnitude.to_bits() >> 52;
    f64::from_bits(exponent.clamp(2, 2044) << 52)
}

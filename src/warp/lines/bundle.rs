//! Lines that move the plane together, and places moved by them.

use super::kernel::{self, LARGEST_A, LEAST_A, Lines};
use super::line::{Feature, Line};
use super::options::Constants;
use super::scaled::Scaled;
use crate::geometry::DVec2;
use pulp::Arch;

/// Lines that move the plane together, into both designs.
#[derive(Clone, Debug)]
pub(super) struct Bundle {
    pub(super) arch: Arch,
    constants: Constants,
    plane: Scaled,
    /// a, scaled.
    a: f64,
    lines: Vec<Line>,
}

impl Bundle {
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
    pub(super) fn fill(&mut self, features: impl Iterator<Item = Feature> + Clone) {
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

    /// Where each place is looked up in both designs. All slices are as long
    /// as `places`, or what is beyond the shortest is left as it is.
    pub(super) fn map_into(&self, places: &[DVec2], designs: [&mut [DVec2]; 2]) {
        let lines = Lines {
            lines: &self.lines,
            plane: self.plane,
            a: self.a,
            b: self.constants.b,
        };
        kernel::look_up(self.arch, lines, places, designs);
    }
}

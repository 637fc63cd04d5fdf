//! The warp by line features.
//!
//! Beier, Neely, "Feature-based image metamorphosis" (1992). A line PQ of the
//! frame and its fellow P′Q′ of a design say of a place X, which lies u along
//! and v across PQ (§3.1), that P′ + u P′Q′ + v n′ is seen there: u counts in
//! lengths of the line, v in units, with its sign. Of many lines (§3.2) the
//! weighted mean of the displacements D is taken,
//!
//! X′ = X + Σ w D / Σ w,  w = (lengthᵖ / (a + dist))ᵇ,
//!
//! where dist is that to the segment. At t the lines of the frame lie between
//! those of the two designs (§3.3), and both designs are looked up by them.
//!
//! Beyond the paper, points count too: a pin is a line without direction and
//! moves what is near it as it moves itself, with the weight of a line a
//! tenth of the frame's diameter long. A line that shrinks to a thousandth of
//! its fellow's length, or below, becomes such a point by and by; the paper's
//! formula divides by that length.
//!
//! Guaranteed: at t = 0 every place is looked up in the source where it is,
//! and at t = 1 in the target; a single pair of lines of one length is a rigid
//! motion; swapping the designs plays the film backwards; finite features give
//! finite places. Not guaranteed: that nothing folds. Lines that cross in the
//! one design and not in the other must fold, and so may close lines that turn
//! against each other.
//!
//! - `options`: the paper's constants, and what may be wrong
//! - `between`: where a line is at t
//! - `line`: a line with everything that a place needs of it
//! - `scaled`: coordinates whose products neither overflow nor vanish
//! - `kernel`: weights and the sums over lines, many places at a time

mod kernel;
mod line;
mod moving_line;
mod options;
mod scaled_plane;

#[cfg(test)]
mod tests;

pub use options::{LineInterpolation, LineOptions, LinesError};

use super::features::{FeatureError, check};
use super::plane::{PlaneWarp, in_chunks};
use crate::correspondence::{LinePair, PointPair};
use crate::geometry::{Bounds, DVec2};
use kernel::{LARGEST_A, LEAST_A};
use line::{FieldLine, LineFeature};
use moving_line::MovingLine;
use options::BeierNeelyConstants;
use pulp::Arch;
use scaled_plane::ScaledPlane;

/// The length, in diameters of the frame, of a line that weighs as much as a
/// pin: about that of the lines which people draw along a feature.
const PIN_LENGTH: f64 = 0.1;

/// How many places a thread takes at a time: some 0.1 ms of work.
const CHUNK: usize = 1024;

/// A warp of the plane by pairs of lines and of points.
///
/// ```
/// use morphospace::correspondence::LinePair;
/// use morphospace::geometry::{Bounds, DVec2};
/// use morphospace::warp::{LineOptions, Lines, PlaneWarp};
///
/// let line = LinePair {
///     source: [DVec2::ZERO, DVec2::X],
///     target: [DVec2::Y, DVec2::Y + DVec2::X], // one up
/// };
/// let frame = Bounds { min: DVec2::NEG_ONE, max: DVec2::ONE };
/// let mut lines = Lines::new(&frame, &[line], &[], &LineOptions::default())?;
/// let [mut in_source, mut in_target] = [[DVec2::ZERO]; 2];
/// lines.look_up(0.25, &[DVec2::ZERO], &mut in_source, &mut in_target);
/// assert!(in_source[0].distance(DVec2::new(0.0, -0.25)) < 1e-15);
/// assert!(in_target[0].distance(DVec2::new(0.0, 0.75)) < 1e-15);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct LineWarp {
    features: Vec<(MovingLine, Option<f64>)>,
    between: LineInterpolation,
    at_t: LinesAtTime,
}

/// The lines at a t, which move the plane together, into both designs.
#[derive(Clone, Debug)]
struct LinesAtTime {
    arch: Arch,
    constants: BeierNeelyConstants,
    plane: ScaledPlane,
    /// a, scaled.
    a: f64,
    lines: Vec<FieldLine>,
}

impl LineWarp {
    /// A warp by lines and pins, in the coordinates of the frame. Without any
    /// nothing moves.
    ///
    /// # Errors
    /// [`LinesError`] if a coordinate is not finite or an option out of range.
    pub fn new(
        frame: &Bounds,
        lines: &[LinePair],
        points: &[PointPair],
        options: &LineOptions,
    ) -> Result<Self, LinesError> {
        let diameter = diameter(frame)?;
        check(points, lines)?;
        let line = |line: &LinePair| MovingLine::new(line.source, line.target);
        let pin = |pin: &PointPair| MovingLine::new([pin.source; 2], [pin.target; 2]);
        // A pin has no length to be weighed by.
        let nominal = |moving: MovingLine| {
            let length = moving.is_point().then_some(PIN_LENGTH * diameter);
            (moving, length)
        };
        let moving = lines.iter().map(line).chain(points.iter().map(pin));
        Ok(Self {
            features: moving.map(nominal).collect(),
            between: options.between,
            at_t: LinesAtTime::new(options.constants(diameter)?),
        })
    }
}

/// The frame's diagonal; 1 for a frame that is a point.
fn diameter(frame: &Bounds) -> Result<f64, FeatureError> {
    let size = frame.size();
    let diameter = size.x.hypot(size.y);
    if !diameter.is_finite() {
        return Err(FeatureError::Frame);
    }
    Ok(if diameter > 0.0 { diameter } else { 1.0 })
}

impl LinesAtTime {
    /// No lines yet.
    fn new(constants: BeierNeelyConstants) -> Self {
        Self {
            arch: Arch::new(),
            constants,
            plane: ScaledPlane::default(),
            a: constants.a,
            lines: Vec::new(),
        }
    }

    /// Replaces the lines. Those that overflowed on their way are left out.
    fn fill(&mut self, features: impl Iterator<Item = LineFeature> + Clone) {
        let features = features.filter(LineFeature::is_finite);
        self.plane = ScaledPlane::around(features.clone());
        let (plane, a) = (self.plane, self.constants.a * self.plane.per_unit);
        // The kernel's weights are finite for an a in this range only.
        self.a = a.clamp(LEAST_A, LARGEST_A);
        self.lines.clear();
        let lines = features.map(|feature| FieldLine::new(&plane.feature(&feature), a));
        self.lines.extend(lines);
        self.weigh();
    }

    /// Makes strengths of lengths, relative to the greatest.
    fn weigh(&mut self) {
        let lengths = self.lines.iter().map(|line| line.strength);
        // A factor common to all weights cancels in Σ w D / Σ w, and no power
        // of a share is above 1.
        let greatest = lengths.fold(0.0, f64::max);
        let exponent = self.constants.b * self.constants.p;
        for line in &mut self.lines {
            line.strength = (line.strength / greatest).min(1.0).powf(exponent);
        }
    }

    /// Where each place is looked up in both designs. All slices are as long
    /// as `places`, or what is beyond the shortest is left as it is.
    fn map_into(&self, places: &[DVec2], designs: [&mut [DVec2]; 2]) {
        let lines = kernel::ScaledLines {
            lines: &self.lines,
            plane: self.plane,
            a: self.a,
            b: self.constants.b,
        };
        kernel::look_up(self.arch, lines, places, designs);
    }
}

impl PlaneWarp for LineWarp {
    fn look_up(
        &mut self,
        t: f64,
        frame: &[DVec2],
        in_source: &mut [DVec2],
        in_target: &mut [DVec2],
    ) {
        let lines = &mut self.at_t;
        lines.fill(self.features.iter().map(|(moving, nominal)| LineFeature {
            in_frame: moving.at(t, self.between),
            in_designs: [moving.source, moving.target],
            nominal: *nominal,
        }));
        in_chunks(CHUNK, frame, [in_source, in_target], |places, looks| {
            lines.map_into(places, looks);
        });
    }
}

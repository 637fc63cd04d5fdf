//! Line warp: field morphing by pairs of line segments.
//!
//! Beier, Neely, "Feature-based image metamorphosis" (1992). Let PQ be a line in the frame and P′Q′
//! the corresponding line in a design, with the unit normal n′. A frame point X at u along and v
//! across PQ (§3.1) shows the design point P′ + u P′Q′ + v n′, where u is a fraction of the length
//! of PQ and v a signed distance. For several lines (§3.2), the displacements from X to these
//! design points, D, are averaged:
//!
//! X′ = X + Σ w D / Σ w,  w = (lengthᵖ / (a + dist))ᵇ,
//!
//! where length is that of PQ, dist the distance of X from the segment PQ, and a, b and p are
//! options. At time t the lines in the frame are interpolated between those of the two designs
//! (§3.3), and each design is sampled with its own mapping.
//!
//! There are two extensions of the paper. A pin is a line without direction: it translates its
//! neighbourhood and weighs as much as a line whose length is a tenth of the frame's diameter. A
//! line that becomes shorter than a thousandth of its counterpart gradually turns into a pin,
//! because the paper's formula divides by the length.
//!
//! Guaranteed: at t = 0 the mapping to the source is exactly the identity; at t = 1 the mapping to
//! the target is. A single pair of lines that keeps its length gives a rigid motion. Exchanging the
//! designs reverses the motion. Finite features give finite points. Not guaranteed: absence of
//! folds. Two lines that cross each other in only one design always cause a fold, and neighbouring
//! lines that rotate in opposite directions may cause one.
//!
//! - `options`: the paper's constants and their validation
//! - `moving_line`: interpolation of a line at t
//! - `line`: a line in the form used by the kernel
//! - `scaled_plane`: coordinates scaled so that products neither overflow nor underflow
//! - `kernel`: vectorised weights and sums over lines

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
use kernel::{MAX_A, MIN_A};
use line::{FieldLine, LineFeature};
use moving_line::MovingLine;
use options::BeierNeelyConstants;
use pulp::Arch;
use scaled_plane::ScaledPlane;

/// Length of a line that weighs as much as a pin, in frame diameters: about the length of a line
/// that users draw along a feature (heuristic).
const PIN_LENGTH: f64 = 0.1;

/// Number of points per parallel work item (resource limit: about 0.1 ms of work, which hides the
/// scheduling overhead).
const CHUNK: usize = 1024;

/// Plane warp controlled by line pairs and point pairs.
///
/// ```
/// use morphospace::correspondence::LinePair;
/// use morphospace::geometry::{Bounds, DVec2};
/// use morphospace::warp::{LineOptions, LineWarp, PlaneWarp};
///
/// let line = LinePair {
///     source: [DVec2::ZERO, DVec2::X],
///     target: [DVec2::Y, DVec2::Y + DVec2::X], // one up
/// };
/// let frame = Bounds { min: DVec2::NEG_ONE, max: DVec2::ONE };
/// let mut lines = LineWarp::new(&frame, &[line], &[], &LineOptions::default())?;
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

/// The lines at one t, prepared for sampling both designs.
#[derive(Clone, Debug)]
struct LinesAtTime {
    arch: Arch,
    constants: BeierNeelyConstants,
    plane: ScaledPlane,
    /// Constant a of Beier and Neely, in the scaled coordinates of `plane`.
    a: f64,
    lines: Vec<FieldLine>,
}

impl LineWarp {
    /// Creates a warp from lines and pins in frame coordinates.
    ///
    /// Without any lines or pins the warp is the identity.
    ///
    /// # Errors
    /// [`LinesError`] if a coordinate is not finite or an option is out of range.
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
        // A pin has no length, which would determine its weight, so it gets a nominal one.
        let with_nominal_length = |moving: MovingLine| {
            let length = moving.is_point().then_some(PIN_LENGTH * diameter);
            (moving, length)
        };
        let moving = lines.iter().map(line).chain(points.iter().map(pin));
        Ok(Self {
            features: moving.map(with_nominal_length).collect(),
            between: options.between,
            at_t: LinesAtTime::new(options.constants(diameter)?),
        })
    }
}

/// Returns the length of the frame's diagonal, or 1 for a frame of zero size.
fn diameter(frame: &Bounds) -> Result<f64, FeatureError> {
    let size = frame.size();
    let diameter = size.x.hypot(size.y);
    if !diameter.is_finite() {
        return Err(FeatureError::Frame);
    }
    Ok(if diameter > 0.0 { diameter } else { 1.0 })
}

impl LinesAtTime {
    /// Creates an empty set of lines.
    fn new(constants: BeierNeelyConstants) -> Self {
        Self {
            arch: Arch::new(),
            constants,
            plane: ScaledPlane::default(),
            a: constants.a,
            lines: Vec::new(),
        }
    }

    /// Replaces `lines` by those of `features`. Lines whose interpolated coordinates are not finite
    /// are left out.
    fn fill(&mut self, features: impl Iterator<Item = LineFeature> + Clone) {
        let features = features.filter(LineFeature::is_finite);
        self.plane = ScaledPlane::around(features.clone());
        let (plane, a) = (self.plane, self.constants.a * self.plane.per_unit);
        // The kernel's weights are finite only if a is in this range.
        self.a = a.clamp(MIN_A, MAX_A);
        self.lines.clear();
        let lines = features.map(|feature| FieldLine::new(&plane.feature(&feature), a));
        self.lines.extend(lines);
        self.weigh();
    }

    /// Replaces the `strength` of each line, which has held the line's length so far, by
    /// (length / greatest length)^(b p), with the exponents b and p of Beier and Neely.
    fn weigh(&mut self) {
        let lengths = self.lines.iter().map(|line| line.strength);
        // A factor common to all weights cancels in the weighted mean of the displacements.
        // Dividing by the greatest length keeps the powers at or below 1.
        let greatest = lengths.fold(0.0, f64::max);
        let exponent = self.constants.b * self.constants.p;
        for line in &mut self.lines {
            line.strength = (line.strength / greatest).min(1.0).powf(exponent);
        }
    }

    /// Computes the points of both designs shown at `places`.
    ///
    /// If the slices differ in length, elements beyond the shortest are left unchanged.
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

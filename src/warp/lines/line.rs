//! A line as affine functions of the frame point, the form that the kernel evaluates.
//!
//! The coordinates along and across the line and the displacement D are affine functions of the
//! point X. Let e, n and m be the direction, normal and midpoint of the line PQ in the frame, and
//! e′, n′ and m′ those of the line P′Q′ in the design. Then
//! D = m′ − m + ((|P′Q′| e′ / |PQ| − e) eᵀ + (n′ − n) nᵀ) (X − m).
//!
//! Guaranteed: D is exactly 0 if both lines are equal, and all coefficients are finite. As an
//! extension of the paper, a line whose length differs extremely between frame and design is
//! treated as a point.

use crate::geometry::{DMat2, DVec2};

/// Start and end point of a line.
pub(super) type LineEnds = [DVec2; 2];

/// A line has one length in the frame and another in a design. If the ratio of the shorter to the
/// longer is below this value, the line gradually turns into a point (heuristic).
const POINT_LENGTH_RATIO: f64 = 1e-3;

/// Scaled length below which a line is a point (tolerance: squares of larger lengths are normal
/// numbers).
const NO_LENGTH: f64 = 1e-150;

/// A line in the frame and its counterparts in both designs.
#[derive(Clone, Copy, Debug)]
pub(super) struct LineFeature {
    pub(super) in_frame: LineEnds,
    pub(super) in_designs: [LineEnds; 2],
    /// Length that determines the weight; `None` if that is the line's own length.
    pub(super) nominal: Option<f64>,
}

/// Coefficients [c, a, b] of c + a x + b y at a scaled point (x, y).
pub(super) type AffineFunction = [f64; 3];

/// A line in scaled coordinates as the kernel evaluates it.
#[derive(Clone, Copy, Debug)]
pub(super) struct FieldLine {
    /// Signed distance of a point from the line's midpoint, measured along the line, as a function
    /// of the point.
    pub(super) along: AffineFunction,
    /// Signed distance of a point from the line, as a function of the point; positive on the left
    /// of the line.
    pub(super) across: AffineFunction,
    /// Half the length of the line in the frame.
    pub(super) half: f64,
    /// Factor of the weight: (length / greatest length of all lines)^(b p). Holds the length until
    /// [`super::LinesAtTime`] replaces it.
    pub(super) strength: f64,
    /// For each design, the x and y components of the displacement D, which leads from a frame
    /// point to the design point that the line assigns to it.
    pub(super) carries: [[AffineFunction; 2]; 2],
}

impl LineFeature {
    /// Returns the end points in the frame and in both designs.
    pub(super) fn all_ends(&self) -> impl Iterator<Item = DVec2> + Clone + use<> {
        let designs = self.in_designs.into_iter().flatten();
        self.in_frame.into_iter().chain(designs)
    }

    /// Returns whether all end points are finite.
    pub(super) fn is_finite(&self) -> bool {
        self.all_ends().all(DVec2::is_finite)
    }
}

/// A line segment, given by its midpoint, the vector between its ends, and its length.
#[derive(Clone, Copy)]
struct MidpointLine {
    middle: DVec2,
    vector: DVec2,
    length: f64,
}

impl MidpointLine {
    fn new([from, to]: LineEnds) -> Self {
        let vector = to - from;
        Self {
            middle: 0.5 * (from + to),
            vector,
            length: vector.x.hypot(vector.y),
        }
    }
}

impl FieldLine {
    /// Creates the line of a feature in scaled coordinates.
    ///
    /// `strength` initially holds the length that determines the weight. This is the nominal
    /// length, if there is one. Otherwise it is the line's own length, but at least
    /// [`POINT_LENGTH_RATIO`] times the longest of the three lines, or `a` if all three are points.
    pub(super) fn new(feature: &LineFeature, a: f64) -> Self {
        let frame = MidpointLine::new(feature.in_frame);
        let designs = feature.in_designs.map(MidpointLine::new);
        let lengths = designs.iter().map(|design| design.length);
        let longest = lengths.fold(frame.length, f64::max);
        let own_length = if longest > 0.0 {
            frame.length.max(POINT_LENGTH_RATIO * longest)
        } else {
            a
        };
        let has_length = frame.length > NO_LENGTH;
        let direction = if has_length {
            frame.vector / frame.length
        } else {
            DVec2::X
        };
        // Coordinate of a point along `axis`, relative to the midpoint of the line.
        let coordinate = |axis: DVec2| [-axis.dot(frame.middle), axis.x, axis.y];
        Self {
            along: coordinate(direction),
            across: coordinate(direction.perp()),
            half: 0.5 * frame.length,
            strength: feature.nominal.unwrap_or(own_length).max(f64::MIN_POSITIVE),
            carries: designs.map(|design| carry(&frame, &design)),
        }
    }
}

/// Returns the x and y component of the displacement D from the frame to a design.
///
/// All coefficients are exactly zero if the two lines are equal.
fn carry(frame: &MidpointLine, design: &MidpointLine) -> [AffineFunction; 2] {
    let shift = design.middle - frame.middle;
    let [shorter, longer] = [
        frame.length.min(design.length),
        frame.length.max(design.length),
    ];
    if shorter <= NO_LENGTH {
        return [[shift.x, 0.0, 0.0], [shift.y, 0.0, 0.0]];
    }
    let direction = frame.vector / frame.length;
    let along = (design.vector - frame.vector) / frame.length;
    let across = (design.vector / design.length - direction).perp();
    let ratio = shorter / (POINT_LENGTH_RATIO * longer);
    let share = if ratio < 1.0 { ratio * ratio } else { 1.0 };
    let matrix = DMat2::from_cols(
        share * (along * direction.x - across * direction.y),
        share * (along * direction.y + across * direction.x),
    );
    let shift = shift - matrix * frame.middle;
    let [x, y] = [matrix.row(0), matrix.row(1)];
    [[shift.x, x.x, x.y], [shift.y, y.x, y.y]]
}

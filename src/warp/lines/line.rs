//! A line of the frame with its fellows in both designs, and what a place
//! needs of it.
//!
//! How far along and across a place is, and its displacement D, are affine in
//! the place: with e the line's direction, n its normal and those of its
//! fellow e′ and n′, D = m′ − m + ((|P′Q′| e′ / |PQ| − e) eᵀ + (n′ − n) nᵀ)
//! (X − m) about the middles m and m′.
//!
//! Guaranteed: D of a line that is its own fellow is exactly 0; all numbers are
//! finite. Beyond the paper: a line that is short against its fellow, or long,
//! turns into a point.

use crate::geometry::{DMat2, DVec2};

/// A line from end to end.
pub(super) type LineEnds = [DVec2; 2];

/// A line, or its fellow, shorter than this part of the other becomes a point
/// by and by.
const POINTLIKE: f64 = 1e-3;

/// Scaled lengths below this are none: the squares of larger ones are normal.
const NO_LENGTH: f64 = 1e-150;

/// A line of the frame and its fellows.
#[derive(Clone, Copy, Debug)]
pub(super) struct LineFeature {
    pub(super) in_frame: LineEnds,
    pub(super) in_designs: [LineEnds; 2],
    /// The length by which it is weighed, if not by that of the line.
    pub(super) nominal: Option<f64>,
}

/// c, a and b of c + a x + b y for a place (x, y), scaled.
pub(super) type AffineFunction = [f64; 3];

/// A line as the kernel reads it.
#[derive(Clone, Copy, Debug)]
pub(super) struct FieldLine {
    /// How far along the line a place is, from its middle.
    pub(super) along: AffineFunction,
    /// How far to the left of the line it is.
    pub(super) across: AffineFunction,
    /// Half the length.
    pub(super) half: f64,
    /// (length / greatest length)^(b p).
    pub(super) strength: f64,
    /// The displacement D into each design, x and y.
    pub(super) carries: [[AffineFunction; 2]; 2],
}

impl LineFeature {
    pub(super) fn points(&self) -> impl Iterator<Item = DVec2> + Clone + use<> {
        let designs = self.in_designs.into_iter().flatten();
        self.in_frame.into_iter().chain(designs)
    }

    pub(super) fn is_finite(&self) -> bool {
        self.points().all(DVec2::is_finite)
    }
}

/// A segment by its middle, the vector from end to end, and its length.
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
    /// The line of a scaled feature, its strength being its length still, at
    /// least so long as its fellows make it; `a` where none has any.
    pub(super) fn new(feature: &LineFeature, a: f64) -> Self {
        let frame = MidpointLine::new(feature.in_frame);
        let designs = feature.in_designs.map(MidpointLine::new);
        let lengths = designs.iter().map(|design| design.length);
        let longest = lengths.fold(frame.length, f64::max);
        let own = if longest > 0.0 {
            frame.length.max(POINTLIKE * longest)
        } else {
            a
        };
        let has_length = frame.length > NO_LENGTH;
        let direction = if has_length {
            frame.vector / frame.length
        } else {
            DVec2::X
        };
        let seen = |by: DVec2| [-by.dot(frame.middle), by.x, by.y];
        Self {
            along: seen(direction),
            across: seen(direction.perp()),
            half: 0.5 * frame.length,
            strength: feature.nominal.unwrap_or(own).max(f64::MIN_POSITIVE),
            carries: designs.map(|design| carry(&frame, &design)),
        }
    }
}

/// D of a place as seen from a line and its fellow. All of it vanishes exactly
/// if the two are the same.
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
    let ratio = shorter / (POINTLIKE * longer);
    let share = if ratio < 1.0 { ratio * ratio } else { 1.0 };
    let matrix = DMat2::from_cols(
        share * (along * direction.x - across * direction.y),
        share * (along * direction.y + across * direction.x),
    );
    let shift = shift - matrix * frame.middle;
    let [x, y] = [matrix.row(0), matrix.row(1)];
    [[shift.x, x.x, x.y], [shift.y, y.x, y.y]]
}

//! The match of two designs with all their parts and holes.
//!
//! Parts are paired, each pair's outer boundaries and holes are matched, and
//! what one design alone has is given a partner: a hole closes to a point, its
//! ring is cut open, or the rest is matched without it; a part is split off the
//! other design's or is born from a point. The outcome is a list of
//! [`PieceMatch`]es, each one connected and with as many rings on either side:
//! what a common triangulation can be made of.
//!
//! Guaranteed: corresponding rings have the same number of vertices; all
//! points of the given outlines are vertices, bit by bit; pins are honoured
//! exactly or refused in words; the match the other way is made of the same
//! pieces. A point stands for a ring of at most [`POINT_SIZE`] of the
//! design's diameter.
//!
//! Not guaranteed: that the piece split off or the place of a cut is the best
//! of all, only of those that were tried.

mod automatic_pins;
mod closing;
mod groups;
mod large_unmatched;
mod locate;
mod many_rings;
mod matched_curves;
mod part_match;
mod part_matcher;
mod plan;
mod region_match;
mod ring_cut;
mod slit_boundary;
mod slit_vertices;
mod split;
#[cfg(test)]
mod tests;
mod unpair;

use super::MatchSettings;
pub(crate) use crate::correspondence::looks::{PartLook, PartLooks};
use crate::geometry::Regions;
use crate::work::progress::{Progress, checkpoint};
pub(crate) use groups::{PartGroup, paired_parts};
pub(crate) use part_matcher::HolePolicy;
pub(crate) use plan::MatchPlan;

pub use region_match::{
    MatchNote, POINT_SIZE, PieceMatch, RegionMatch, RegionMatchError, RingKind, RingMatch,
};

/// Matches two designs with all their parts and holes.
///
/// # Errors
/// [`RegionMatchError`] for pins, links or cuts that contradict each other,
/// sizes that floating point cannot measure, or if the work is cancelled.
///
/// ```
/// use morphospace::correspondence::{Matching, match_regions};
/// use morphospace::geometry::{DVec2, FillRule, Regions};
/// use morphospace::work::progress::Silent;
/// let square = |s: f64| [(-s, -s), (s, -s), (s, s), (-s, s)].map(DVec2::from).to_vec();
/// let frame = Regions::from_rings(&[square(2.0), square(1.0)], FillRule::EvenOdd)?;
/// let matched = match_regions(&frame, &frame, &Matching::default(), &Silent)?;
/// assert_eq!((matched.pieces.len(), matched.pieces[0].rings.len()), (1, 2));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn match_regions(
    source: &Regions,
    target: &Regions,
    wanted: &MatchSettings,
    progress: &dyn Progress,
) -> Result<RegionMatch, RegionMatchError> {
    checkpoint(progress, "matching", 0.0)?;
    let alike = PartLooks::default();
    MatchPlan::new([source, target], &alike, wanted, progress)?.matched(&wanted.options(), progress)
}

//! Matches two designs with all their parts and holes.
//!
//! Parts are paired, and the outer boundaries and holes of each pair are matched. If a hole exists
//! in only one design, it closes to a point or opens from one, or its part is cut open from the
//! hole to a boundary, or its part is matched as if there were no hole. If a part exists in only
//! one design, it is matched with a piece split off a part of the other design, or it shrinks to a
//! point or grows from one. The result is a list of [`PieceMatch`]es. Each piece is connected and
//! has the same number of rings in both designs, so that both designs can share one triangulation.
//!
//! Guaranteed: corresponding rings have the same number of vertices, and contain all vertices of
//! the given outlines without rounding. Pins are satisfied exactly or rejected with an error.
//! Matching in the other direction gives the same pieces. Where a hole or a part closes to a point,
//! or grows from one, each of its rings is matched with a tiny ring that represents the point. The
//! diameter of a tiny ring is at most [`POINT_SIZE`] times the diameter of a part. For a hole, this
//! is the part of the other design in which the tiny ring lies; for a part, it is the part itself.
//!
//! Not guaranteed: that a split or a cut is the best possible. It is only the best of those tried.

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
pub(crate) use crate::correspondence::looks::{PartAppearance, PartAppearances};
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
/// [`RegionMatchError`] for pins, links or cuts that contradict each other, for sizes that floating
/// point cannot represent, or if the work is cancelled.
///
/// ```
/// use morphospace::correspondence::{MatchSettings, match_regions};
/// use morphospace::geometry::{DVec2, FillRule, Regions};
/// use morphospace::work::progress::Silent;
/// let square = |s: f64| [(-s, -s), (s, -s), (s, s), (-s, s)].map(DVec2::from).to_vec();
/// let frame = Regions::from_rings(&[square(2.0), square(1.0)], FillRule::EvenOdd)?;
/// let matched = match_regions(&frame, &frame, &MatchSettings::default(), &Silent)?;
/// assert_eq!((matched.pieces.len(), matched.pieces[0].rings.len()), (1, 2));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn match_regions(
    source: &Regions,
    target: &Regions,
    settings: &MatchSettings,
    progress: &dyn Progress,
) -> Result<RegionMatch, RegionMatchError> {
    checkpoint(progress, "matching", 0.0)?;
    let no_looks = PartAppearances::default();
    MatchPlan::new([source, target], &no_looks, settings, progress)?
        .match_all_groups(&settings.options(), progress)
}

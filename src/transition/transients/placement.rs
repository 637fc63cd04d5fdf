//! Chooses the position and the time window of each part that exists in only one design.
//!
//! In the other design, such a part is a tiny seed shape ([`TransientPart`]), whose position is
//! chosen here. The part grows from the seed shape, or shrinks to it, within its time window.
//! Alternatively the part swells: it grows in thickness and stays within its final outline.
//! Positions and time windows are chosen such that the part collides with nothing
//! ([`TransientScene`]). Parts are placed one after the other, the largest first, and avoid both
//! the matched parts and the parts placed before them.
//!
//! Guaranteed: swapping the designs gives the same positions and the reversed time windows, unless
//! two parts have equal area or the search reaches [`MAX_TESTED_PAIRS`]. Not guaranteed: that a
//! position without collisions exists, or that nothing collides between the sample times
//! ([`SampleTimes`]).

mod anchor;
mod scene;
mod seed_shape;

use self::scene::TransientScene;
use self::seed_shape::TransientPart;
use super::holes::PieceHole;
use super::layers::PieceLayers;
use super::sample_times::SampleTimes;
use super::schedule::TransientSchedule;
use crate::compatible::CompatibleMesh;
use crate::content::TransientHole;
use crate::correspondence::{PieceMatch, RegionMatch};
use crate::geometry::DVec2;
use crate::transition::options::BuildQuality;
use crate::warp::{Arap, TimeWindow};
use crate::work::progress::{Cancelled, Progress, check_cancelled};

/// Work after which no positions of further parts are searched, in pairs of a vertex and an outline
/// (see [`TransientScene::tested_pairs`]). Time windows and positions are searched with this limit
/// each, the largest parts first; a single part may exceed it (resource limit: with 50 nested rings,
/// it is reached after 4 s of processor time).
const MAX_TESTED_PAIRS: u64 = 200_000_000;

/// Returns the initial time windows: [0, 1] for a piece that exists in only one design, `None` for
/// a matched piece.
pub(in crate::transition) fn lives(matched: &RegionMatch) -> Vec<Option<TimeWindow>> {
    let life = |piece: &PieceMatch| piece.only_side().map(TimeWindow::whole);
    matched.pieces.iter().map(life).collect()
}

/// Creates the schedule of the holes and parts that exist in only one design, the holes first.
pub(in crate::transition) fn timetable(
    matched: &RegionMatch,
    film: &Arap,
    (holes, levels): (&[PieceHole], &PieceLayers),
    quality: BuildQuality,
) -> TransientSchedule {
    timetable_of(&TransientPart::all(matched, levels), film, holes, quality)
}

fn timetable_of(
    specks: &[TransientPart],
    film: &Arap,
    holes: &[PieceHole],
    quality: BuildQuality,
) -> TransientSchedule {
    let holes = holes.iter().map(|(_, hole)| hole);
    let parts = specks
        .iter()
        .map(|speck| (speck.side, speck.ends[speck.side], &speck.rings[..]));
    match quality {
        BuildQuality::Draft => TransientSchedule::long(
            holes
                .map(TransientHole::side)
                .chain(parts.map(|(side, ..)| side)),
        ),
        BuildQuality::Best => TransientSchedule::of(film, holes, parts),
    }
}

/// A match and its mesh, after all parts that exist in only one design were moved to their chosen
/// positions.
pub(in crate::transition) struct PlacedTransients {
    pub matched: RegionMatch,
    pub mesh: CompatibleMesh,
    /// For each piece, its time window; `None` for a matched piece.
    pub lives: Vec<Option<TimeWindow>>,
    /// Indices of the pieces that swell, that is, grow in thickness within their outline.
    pub swelling: Vec<usize>,
    /// Number of parts whose positions were not searched because of [`MAX_TESTED_PAIRS`].
    pub unsearched: usize,
}

/// Places all parts that exist in only one design. Returns `None` if there are none, or if rounding
/// folds a face of the moved mesh. In a draft, no positions are searched and no part swells.
///
/// # Errors
/// If the work is cancelled.
pub(in crate::transition) fn placed(
    matched: &RegionMatch,
    film: &Arap,
    (holes, levels, steps): (&[PieceHole], &PieceLayers, &SampleTimes),
    quality: BuildQuality,
    progress: &dyn Progress,
) -> Result<Option<PlacedTransients>, Cancelled> {
    let max_pairs = match quality {
        BuildQuality::Draft => 0,
        BuildQuality::Best => MAX_TESTED_PAIRS,
    };
    if lives(matched).iter().all(Option::is_none) {
        return Ok(None);
    }
    let specks = TransientPart::all(matched, levels);
    let mut scene = TransientScene::of(film, (holes, &specks), (levels, steps));
    let mut timetable = timetable_of(&specks, film, holes, quality);
    for (k, (_, hole)) in holes.iter().enumerate() {
        timetable.set(k, hole.window);
    }
    let prices = |k: usize| match scene.tested_pairs() < max_pairs {
        true => scene.prices(&specks[k - holes.len()], film),
        false => Vec::new(),
    };
    timetable.plan(holes.len(), prices, progress)?;
    let priced = scene.tested_pairs();
    let mut unsearched = 0;
    for (rank, speck) in specks.iter().enumerate() {
        check_cancelled(progress)?;
        let is_searched = scene.tested_pairs() - priced < max_pairs;
        unsearched += usize::from(quality == BuildQuality::Best && !is_searched);
        scene.place(
            speck,
            (&mut timetable, holes.len() + rank),
            film,
            is_searched,
        );
    }
    Ok(with_placements(matched, film, &scene, unsearched))
}

/// Moves all placed parts of a scene to their positions; `None` if rounding folds a face of the
/// moved mesh.
fn with_placements(
    matched: &RegionMatch,
    film: &Arap,
    scene: &TransientScene,
    unsearched: usize,
) -> Option<PlacedTransients> {
    let mut lives = lives(matched);
    let mut swelling = Vec::new();
    let mut by = vec![[DVec2::ZERO; 2]; matched.pieces.len()];
    for (speck, birth) in scene.births() {
        by[speck.piece][speck.side.other()] = birth.place - speck.ends[speck.side.other()];
        lives[speck.piece] = Some(birth.life);
        swelling.extend(birth.swells.then_some(speck.piece));
    }
    let mesh = film.mesh().with_parts_translated(&by)?;
    let mut matched = matched.clone();
    for (piece, by) in matched.pieces.iter_mut().zip(&by) {
        for ring in &mut piece.rings {
            ring.source.iter_mut().for_each(|p| *p += by[0]);
            ring.target.iter_mut().for_each(|p| *p += by[1]);
        }
    }
    Some(PlacedTransients {
        matched,
        mesh,
        lives,
        swelling,
        unsearched,
    })
}

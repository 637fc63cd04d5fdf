//! Where and when the parts that one design has alone are born and die.
//!
//! Such a part is a [`TransientPart`] in the other design, at a place that nobody
//! drew, and is free to change its size within a time of its own; or it
//! swells, which keeps it within its outline. All are chosen in the [`TransientScene`] so
//! that it meets nothing as it grows: the largest part first, against the film of
//! the parts that both designs have and of those placed before it.
//!
//! Guaranteed: exchanging the designs gives the same places, and the times
//! reversed, unless two parts are equal in size. Not guaranteed: that there
//! is a free place; nor anything between the [`SampleTimes`] that are looked at.

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

/// Parts beyond so many are not searched a place for; each costs a look at all
/// others at every step. Beyond 24, two of the 74 parts of an icon met.
const SEARCHED: usize = 100;

/// When each piece changes its size, before anything is chosen: a part of one
/// design alone all the time.
pub(in crate::transition) fn lives(matched: &RegionMatch) -> Vec<Option<TimeWindow>> {
    let life = |piece: &PieceMatch| piece.only_side().map(TimeWindow::whole);
    matched.pieces.iter().map(life).collect()
}

/// When holes and parts come and go; the holes first.
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

/// A match and its mesh with all that is born or dies in its place.
pub(in crate::transition) struct PlacedTransients {
    pub matched: RegionMatch,
    pub mesh: CompatibleMesh,
    /// When each piece changes its size, if it is born or dies.
    pub lives: Vec<Option<TimeWindow>>,
    /// The pieces that swell.
    pub swelling: Vec<usize>,
}

/// The match and the film's mesh with all parts that are born or die in their
/// places and times; `None` where there are none. In a draft all grow, and in their own
/// places: of 120 first films of icons 8 cross either way, and the slowest is there after
/// 0.9 s and not after 1.3 s.
pub(in crate::transition) fn placed(
    matched: &RegionMatch,
    film: &Arap,
    (holes, levels, steps): (&[PieceHole], &PieceLayers, &SampleTimes),
    quality: BuildQuality,
    progress: &dyn Progress,
) -> Result<Option<PlacedTransients>, Cancelled> {
    let searched = match quality {
        BuildQuality::Draft => 0,
        BuildQuality::Best => SEARCHED,
    };
    let mut lives = lives(matched);
    if lives.iter().all(Option::is_none) {
        return Ok(None);
    }
    let specks = TransientPart::all(matched, levels);
    let mut scene = TransientScene::of(film, (holes, &specks), (levels, steps));
    let mut timetable = timetable_of(&specks, film, holes, quality);
    for (k, (_, hole)) in holes.iter().enumerate() {
        timetable.set(k, hole.window);
    }
    let prices = |k: usize| scene.prices(&specks[k - holes.len()], film);
    timetable.plan(holes.len(), prices, progress)?;
    for (rank, speck) in specks.iter().enumerate() {
        check_cancelled(progress)?;
        scene.place(
            speck,
            (&mut timetable, holes.len() + rank),
            film,
            rank < searched,
        );
    }
    let mut swelling = Vec::new();
    let mut by = vec![[DVec2::ZERO; 2]; matched.pieces.len()];
    for (speck, birth) in scene.births() {
        by[speck.piece][speck.side.other()] = birth.place - speck.ends[speck.side.other()];
        lives[speck.piece] = Some(birth.life);
        swelling.extend(birth.swells.then_some(speck.piece));
    }
    let Some(mesh) = film.mesh().with_parts_translated(&by) else {
        return Ok(None);
    };
    let mut matched = matched.clone();
    for (piece, by) in matched.pieces.iter_mut().zip(&by) {
        for ring in &mut piece.rings {
            ring.source.iter_mut().for_each(|p| *p += by[0]);
            ring.target.iter_mut().for_each(|p| *p += by[1]);
        }
    }
    Ok(Some(PlacedTransients {
        matched,
        mesh,
        lives,
        swelling,
    }))
}

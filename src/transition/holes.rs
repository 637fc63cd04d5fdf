//! Holes that one design has alone, and which the film moves as if they were
//! not there: where they are in it, and when they come and go.
//!
//! The largest first, each takes as much of the film as it can without crossing
//! a boundary or a hole that has its time. Looked at at a few steps: what is
//! crossed between two is missed.

use super::births::times;
use super::levels::Levels;
use super::outline::Outline;
use super::steps::{LAST, time};
use super::walks::Walks;
use crate::compatible::CompatibleMesh;
use crate::content::Hole;
use crate::correspondence::{PieceMatch, RingMatch};
use crate::geometry::DVec2;
use crate::progress::{Cancelled, Progress, still_wanted};
use crate::warp::{Arap, Life, Warp};

/// A hole, and the number of the piece that it is in.
pub(super) type HoleOf = (usize, Hole);

/// All holes that one design has alone, in their times. Piece k is component k
/// of the film's mesh.
pub(super) fn timed(
    pieces: &[PieceMatch],
    film: &Arap,
    levels: &Levels,
    progress: &dyn Progress,
) -> Result<Vec<HoleOf>, Cancelled> {
    let mut holes = untimed(pieces, film.mesh());
    if holes.is_empty() {
        return Ok(holes);
    }
    let mut scene = Scene::of(film, levels);
    for (piece, hole) in &mut holes {
        still_wanted(progress)?;
        let level = levels.of_piece(*piece);
        hole.life = scene.life(hole, level);
        scene.add(hole, level);
    }
    Ok(holes)
}

/// All holes that one design has alone, in times that are known already, in
/// this order; none if there are not as many.
pub(super) fn with_lives(
    pieces: &[PieceMatch],
    mesh: &CompatibleMesh,
    lives: &[Life],
) -> Option<Vec<HoleOf>> {
    let mut holes = untimed(pieces, mesh);
    for ((_, hole), &life) in holes.iter_mut().zip(lives) {
        hole.life = life;
    }
    (holes.len() == lives.len()).then_some(holes)
}

/// The largest first. Of equal ones the order of the pieces decides, which a
/// film run backwards has as well.
fn untimed(pieces: &[PieceMatch], mesh: &CompatibleMesh) -> Vec<HoleOf> {
    if pieces.iter().all(|piece| piece.lone.is_empty()) {
        return Vec::new();
    }
    let parts = mesh.components();
    let places = [mesh.source(), mesh.target()];
    let of_piece = |(k, piece): (usize, &PieceMatch)| -> Vec<HoleOf> {
        let is_here = |face: &&[u32; 3]| parts[face[0] as usize] as usize == k;
        let faces: Vec<[u32; 3]> = mesh.faces().iter().filter(is_here).copied().collect();
        let hole = |ring: &RingMatch| {
            let (side, points) = ring.whole()?;
            let hole = Hole::new(side, points, &faces, places[side], Life::WHOLE)?;
            Some((k, hole))
        };
        piece.lone.iter().filter_map(hole).collect()
    };
    let mut holes: Vec<HoleOf> = pieces.iter().enumerate().flat_map(of_piece).collect();
    holes.sort_by(|(_, a), (_, b)| b.area().total_cmp(&a.area()));
    holes
}

/// What is there at each step.
struct Scene {
    /// Where all vertices are.
    places: Vec<Vec<DVec2>>,
    outlines: Vec<Vec<Outline>>,
}

impl Scene {
    fn of(film: &Arap, levels: &Levels) -> Self {
        let walks = Walks::of(film);
        let mut placer = film.placer();
        let place = |step: u32| {
            placer.place(time(step));
            placer.placement().in_frame.clone()
        };
        let places: Vec<Vec<DVec2>> = (1..LAST).map(place).collect();
        let outlines = places.iter().map(|places| walks.outlines(places, levels));
        Self {
            outlines: outlines.collect(),
            places,
        }
    }

    /// The longest time in which a hole crosses least.
    fn life(&self, hole: &Hole, level: usize) -> Life {
        let mut best = (usize::MAX, Life::WHOLE);
        for life in times(hole.side()) {
            let mut hole = hole.clone();
            hole.life = life;
            let crossed = self.crossed(&hole, level, best.0);
            if crossed < best.0 {
                best = (crossed, life);
            }
        }
        best.1
    }

    /// The number of steps at which it crosses something or itself, counted on to `most`.
    fn crossed(&self, hole: &Hole, level: usize, most: usize) -> usize {
        let steps = (1..LAST).zip(self.places.iter().zip(&self.outlines));
        let crosses = |(step, (places, others)): (u32, (&Vec<DVec2>, &Vec<Outline>))| {
            let ring = hole.at(places, time(step));
            let ring = ring.map(|ring| Outline::of(ring, level));
            ring.is_some_and(|ring| {
                ring.crosses(&ring) || others.iter().any(|other| ring.crosses(other))
            })
        };
        steps.filter(|&step| crosses(step)).take(most).count()
    }

    fn add(&mut self, hole: &Hole, level: usize) {
        for (step, (places, outlines)) in (1..LAST).zip(self.places.iter().zip(&mut self.outlines))
        {
            let ring = hole.at(places, time(step));
            outlines.extend(ring.map(|ring| Outline::of(ring, level)));
        }
    }
}

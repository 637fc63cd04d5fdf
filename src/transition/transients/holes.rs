//! Holes that one design has alone, and which the film moves as if they were
//! not there: where they are in it, and when they come and go.
//!
//! The largest first, each takes, of the times in which it crosses no boundary and no hole
//! that has its time, the one that suits the timetable best; one that cannot keeps the time
//! in which it crosses least, and the others make way. Looked at at a few steps: what is
//! crossed between two is missed.

use super::boundary_loops::SharedPartLoops;
use super::layered_outline::LayeredOutline;
use super::layers::PieceLayers;
use super::sample_times::SampleTimes;
use super::schedule::{TransientSchedule, eighths};
use crate::compatible::CompatibleMesh;
use crate::content::TransientHole;
use crate::correspondence::{PieceMatch, RingMatch};
use crate::geometry::DVec2;
use crate::warp::{Arap, Placer, TimeWindow, Warp};
use crate::work::progress::{Cancelled, Progress, check_cancelled};
use rayon::prelude::*;

/// How often holes make way: the pairs of icons and of glyphs that need it take one, and
/// each time costs as much as the first.
const MAKING_WAY: u32 = 3;

/// What it costs in the plan to cross anything: more than a film can be restless.
const CROSSING: f64 = 10.0;

/// A hole, and the number of the piece that it is in.
pub(in crate::transition) type PieceHole = (usize, TransientHole);

/// All holes that one design has alone, in their times. Piece k is component k
/// of the film's mesh.
pub(in crate::transition) fn timed(
    pieces: &[PieceMatch],
    film: &Arap,
    levels: &PieceLayers,
    progress: &dyn Progress,
) -> Result<Vec<PieceHole>, Cancelled> {
    let long =
        |holes: &[PieceHole]| TransientSchedule::long(holes.iter().map(|(_, hole)| hole.side()));
    timed_by(pieces, film, levels, &long, progress)
}

/// The same, in times that suit those of what else comes and goes.
pub(in crate::transition) fn timed_by(
    pieces: &[PieceMatch],
    film: &Arap,
    levels: &PieceLayers,
    timetable: &dyn Fn(&[PieceHole]) -> TransientSchedule,
    progress: &dyn Progress,
) -> Result<Vec<PieceHole>, Cancelled> {
    let mut holes = untimed(pieces, film.mesh());
    if holes.is_empty() {
        return Ok(holes);
    }
    let mut scene = HoleScene::of(film, levels);
    let mut timetable = timetable(&holes);
    let prices = |k| match holes.get(k) {
        Some((piece, hole)) => scene.prices(hole, levels.of_piece(*piece)),
        None => Vec::new(), // a part
    };
    timetable.plan(0, prices, progress)?;
    let mut order: Vec<(usize, Option<TimeWindow>)> = (0..holes.len()).map(|k| (k, None)).collect();
    let mut best = (usize::MAX, Vec::new());
    for _ in 0..=MAKING_WAY {
        let lives = scene.lives((&holes, &order), levels, timetable.clone(), progress)?;
        let crossed = lives.iter().map(|(_, _, crossed)| crossed).sum();
        let late = lives.iter().position(|&(_, _, crossed)| crossed > 0);
        // The first that crosses something comes before the others.
        let late = late.filter(|&late| late > 0);
        if let Some(late) = late {
            order[late].1 = Some(lives[late].1);
            order[..=late].rotate_right(1);
        }
        if crossed < best.0 {
            best = (crossed, lives);
        }
        if late.is_none() {
            break;
        }
    }
    for (hole, life, _) in best.1 {
        holes[hole].1.window = life;
    }
    Ok(holes)
}

/// All holes that one design has alone, in times that are known already, in
/// this order; none if there are not as many.
pub(in crate::transition) fn with_lives(
    pieces: &[PieceMatch],
    mesh: &CompatibleMesh,
    lives: &[TimeWindow],
) -> Option<Vec<PieceHole>> {
    let mut holes = untimed(pieces, mesh);
    let is_of = |((_, hole), life): (&PieceHole, &TimeWindow)| hole.side() == life.side;
    if holes.len() != lives.len() || !holes.iter().zip(lives).all(is_of) {
        return None;
    }
    for ((_, hole), &life) in holes.iter_mut().zip(lives) {
        hole.window = life;
    }
    Some(holes)
}

/// The largest first. Of equal ones the order of the pieces decides, which a
/// film run backwards has as well.
fn untimed(pieces: &[PieceMatch], mesh: &CompatibleMesh) -> Vec<PieceHole> {
    if pieces.iter().all(|piece| piece.lone.is_empty()) {
        return Vec::new();
    }
    let parts = mesh.components();
    let places = [mesh.source(), mesh.target()];
    let of_piece = |(k, piece): (usize, &PieceMatch)| -> Vec<PieceHole> {
        let is_here = |face: &&[u32; 3]| parts[face[0] as usize] as usize == k;
        let faces: Vec<[u32; 3]> = mesh.faces().iter().filter(is_here).copied().collect();
        let hole = |ring: &RingMatch| {
            let (side, points) = ring.transient_side()?;
            let hole = TransientHole::new(points, &faces, places[side], TimeWindow::whole(side))?;
            Some((k, hole))
        };
        piece.lone.iter().filter_map(hole).collect()
    };
    let mut holes: Vec<PieceHole> = pieces.iter().enumerate().flat_map(of_piece).collect();
    holes.sort_by(|(_, a), (_, b)| b.area().total_cmp(&a.area()));
    holes
}

/// What is there at each step within the film.
struct HoleScene {
    times: Vec<f64>,
    /// Where all vertices are.
    places: Vec<Vec<DVec2>>,
    outlines: Vec<Vec<LayeredOutline>>,
}

impl HoleScene {
    fn of(film: &Arap, levels: &PieceLayers) -> Self {
        let walks = SharedPartLoops::of(film);
        let steps = SampleTimes::default();
        let times = steps.times()[1..steps.last()].to_vec();
        let at = |placer: &mut Placer, &t: &f64| {
            placer.place(t);
            let places = placer.placement().in_frame.clone();
            let outlines = walks.outlines(&places, levels);
            (places, outlines)
        };
        let all = times.par_iter().map_init(|| film.placer(), at);
        let (places, outlines) = all.unzip();
        Self {
            times,
            places,
            outlines,
        }
    }

    /// The holes in an order, when each is there if they choose in it, but for those of
    /// which that is known, and at how many steps each then crosses anything.
    fn lives(
        &mut self,
        (holes, order): (&[PieceHole], &[(usize, Option<TimeWindow>)]),
        levels: &PieceLayers,
        mut timetable: TransientSchedule,
        progress: &dyn Progress,
    ) -> Result<Vec<(usize, TimeWindow, usize)>, Cancelled> {
        let of_both = self.outlines[0].len();
        let mut lives = Vec::new();
        for &(k, known) in order {
            check_cancelled(progress)?;
            let (piece, hole) = &holes[k];
            let level = levels.of_piece(*piece);
            let times = timetable.ranked(k);
            let (life, crossed) = self.life(hole, &times, known, level);
            timetable.set(k, life);
            let mut hole = hole.clone();
            hole.window = life;
            self.add(&hole, level);
            lives.push((k, life, crossed));
        }
        self.outlines
            .iter_mut()
            .for_each(|all| all.truncate(of_both));
        Ok(lives)
    }

    /// What each of the times costs a hole that are chosen from.
    fn prices(&self, hole: &TransientHole, level: usize) -> Vec<f64> {
        let price = |life: TimeWindow| {
            let mut hole = hole.clone();
            hole.window = life;
            CROSSING * self.crossed(&hole, level, 1) as f64
        };
        let lives: Vec<TimeWindow> = eighths(hole.side()).collect();
        lives.into_par_iter().map(price).collect()
    }

    /// The first of the times in which a hole crosses least, or the one that is known.
    fn life(
        &self,
        hole: &TransientHole,
        times: &[(f64, TimeWindow)],
        known: Option<TimeWindow>,
        level: usize,
    ) -> (TimeWindow, usize) {
        let mut best = (usize::MAX, TimeWindow::whole(hole.side()));
        let all = times.iter().map(|&(_, life)| life);
        for life in all.filter(|life| known.is_none_or(|known| known == *life)) {
            let mut hole = hole.clone();
            hole.window = life;
            let crossed = self.crossed(&hole, level, best.0);
            if crossed < best.0 {
                best = (crossed, life);
            }
        }
        (best.1, best.0)
    }

    /// The number of steps at which it crosses something or itself, counted on to `most`.
    fn crossed(&self, hole: &TransientHole, level: usize, most: usize) -> usize {
        let steps = self
            .times
            .iter()
            .zip(self.places.iter().zip(&self.outlines));
        let crosses = |&(&t, (places, others)): &(&f64, (&Vec<DVec2>, &Vec<LayeredOutline>))| {
            let ring = hole
                .ring_at(places, t)
                .map(|ring| LayeredOutline::of(ring, level));
            ring.is_some_and(|ring| {
                ring.crosses(&ring) || others.iter().any(|other| ring.crosses(other))
            })
        };
        steps.filter(crosses).take(most).count()
    }

    fn add(&mut self, hole: &TransientHole, level: usize) {
        let steps = self
            .times
            .iter()
            .zip(self.places.iter().zip(&mut self.outlines));
        for (&t, (places, outlines)) in steps {
            let ring = hole.ring_at(places, t);
            outlines.extend(ring.map(|ring| LayeredOutline::of(ring, level)));
        }
    }
}

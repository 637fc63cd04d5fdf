//! Holes that exist in only one design and do not affect the motion: their position and time
//! window.
//!
//! Time windows are chosen for one hole after the other, the largest first. Each hole gets the time
//! window that suits the schedule best among those in which it crosses no boundary and no hole
//! placed before it. If the hole crosses something in every time window, it gets the one with the
//! fewest crossings. The time windows of all other holes are then chosen again, so that they avoid
//! it. Crossings are detected only at sample times; those between two sample times are missed.

use super::boundary_loops::SharedPartLoops;
use super::layered_outline::{LayeredEdges, LayeredOutline};
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

/// Maximum number of times that the time windows of all holes are chosen again (resource limit:
/// each takes as long as the first choice).
const MAKING_WAY: u32 = 3;

/// Cost of a time window in which a hole crosses something. It is added to the relative overshoot
/// of turning and area beyond the two designs (heuristic).
const CROSSING: f64 = 10.0;

/// Index of a piece, and a hole in it that exists in only one design.
pub(in crate::transition) type PieceHole = (usize, TransientHole);

/// Returns all holes that exist in only one design, with time windows that are as long as possible.
/// Piece k is component k of the mesh of `film`.
///
/// # Errors
/// If the work is cancelled.
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

/// Returns all holes that exist in only one design, with time windows from the schedule that
/// `timetable` creates for them.
///
/// # Errors
/// If the work is cancelled.
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
        // In the next pass over all holes, the first hole with a crossing keeps its time window and
        // comes first. If it came first already, nothing can improve.
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

/// Returns all holes that exist in only one design, with the given time windows in this order;
/// `None` if the number of holes, or the design of one of them, does not fit the time windows.
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

/// Returns all holes that exist in only one design, with the time window [0, 1], the largest first.
/// Holes of equal area are in the order of their pieces, which is the same when the designs are
/// swapped.
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

/// The motion at the sample times between t = 0 and t = 1, with the outlines that holes must not
/// cross.
struct HoleScene {
    times: Vec<f64>,
    /// Positions of all vertices at each time.
    places: Vec<Vec<DVec2>>,
    /// Edges of the matched parts at each time.
    parts: Vec<LayeredEdges>,
    /// Edges of the holes placed so far, at each time.
    placed: Vec<LayeredEdges>,
}

impl HoleScene {
    fn of(film: &Arap, levels: &PieceLayers) -> Self {
        let walks = SharedPartLoops::of(film);
        let steps = SampleTimes::default();
        let times = steps.times()[1..steps.last()].to_vec();
        let at = |placer: &mut Placer, &t: &f64| {
            placer.place(t);
            let places = placer.placement().in_frame.clone();
            let parts = LayeredEdges::of(&walks.outlines(&places, levels));
            (places, parts)
        };
        let all = times.par_iter().map_init(|| film.placer(), at);
        let (places, parts) = all.unzip();
        let placed = times.iter().map(|_| LayeredEdges::default()).collect();
        Self {
            times,
            places,
            parts,
            placed,
        }
    }

    /// Chooses the time windows of the holes in the given order; a hole with a time window in
    /// `order` keeps it. Returns the index of each hole, its time window, and the number of sample
    /// times at which it crosses something.
    fn lives(
        &mut self,
        (holes, order): (&[PieceHole], &[(usize, Option<TimeWindow>)]),
        levels: &PieceLayers,
        mut timetable: TransientSchedule,
        progress: &dyn Progress,
    ) -> Result<Vec<(usize, TimeWindow, usize)>, Cancelled> {
        self.placed.fill_with(LayeredEdges::default);
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
        Ok(lives)
    }

    /// Returns a cost for each time window in [`eighths`]: [`CROSSING`] if the hole crosses
    /// something in that time window, otherwise 0.
    fn prices(&self, hole: &TransientHole, level: usize) -> Vec<f64> {
        let price = |life: TimeWindow| {
            let mut hole = hole.clone();
            hole.window = life;
            CROSSING * self.crossed(&hole, level, 1) as f64
        };
        let lives: Vec<TimeWindow> = eighths(hole.side()).collect();
        lives.into_par_iter().map(price).collect()
    }

    /// Returns the time window in `times` in which the hole crosses something at the fewest sample
    /// times, and their number. Of several such time windows, the first is chosen. If `known` is
    /// given, only that time window is considered.
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

    /// Returns the number of sample times, at most `most`, at which the hole crosses itself or
    /// something else.
    fn crossed(&self, hole: &TransientHole, level: usize, most: usize) -> usize {
        let crosses = |&step: &usize| {
            let ring = hole.ring_at(&self.places[step], self.times[step]);
            let ring = ring.map(|ring| LayeredOutline::of(ring, level));
            ring.is_some_and(|ring| {
                ring.crosses_itself()
                    || self.parts[step].are_crossed_by(&ring)
                    || self.placed[step].are_crossed_by(&ring)
            })
        };
        (0..self.times.len()).filter(crosses).take(most).count()
    }

    fn add(&mut self, hole: &TransientHole, level: usize) {
        let steps = self.times.iter().zip(&self.places).zip(&mut self.placed);
        for ((&t, places), placed) in steps {
            if let Some(ring) = hole.ring_at(places, t) {
                placed.add(&LayeredOutline::of(ring, level));
            }
        }
    }
}

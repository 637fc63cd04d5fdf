//! Avoids collisions in a motion that could not be proved free of folds and crossings.
//!
//! The as-rigid-as-possible motion does not know of collisions: faces may fold, and outlines may
//! pass through each other. Every motion is therefore examined at every t
//! ([`crate::recording::proof`]). If that proof fails, two remedies are tried one after the other,
//! each of them forwards and backwards in t:
//!
//! 1. If a part that exists in only one design collides, its time window is shortened, so that the
//!    part appears later or disappears earlier.
//! 2. Vertices are displaced, step by step in t, wherever faces would fold or outlines would come
//!    too close. The displacements minimise a smoothing energy, so that they are smooth dents
//!    without spikes.
//!
//! Each result is examined again. Where the proof still fails, the second remedy is repeated with
//! smaller steps of t. The caller can also choose new positions for the colliding parts
//! ([`FailedProof::births`]).
//!
//! Guaranteed: a motion that can be proved is returned unchanged, bit for bit; at t = 0 and t = 1
//! the designs are unchanged; swapping the designs reverses the result, except for rounding. Not
//! guaranteed: that every collision can be avoided. A shape that meets another one head-on stops;
//! it finds no way around. If a limb lies on the other side of another limb in the target, it must
//! pass through that limb. If no result can be proved, the one with the fewest folded faces and
//! crossings is returned.
//!
//! - `defects`: the first fold or collision of a motion
//! - `drawn_pieces`: boundary loops that are drawn, and when
//! - `window_shifts`: shortens the time windows of colliding parts
//! - `outlines`: vertices and edges that must not meet, and pairs of them that are close
//! - `compliance`: displacement of the whole mesh when one vertex is pushed
//! - `push`: the smallest displacement that satisfies all contact constraints
//! - `stepper`: steps through the motion and displaces colliding vertices

mod compliance;
mod defects;
mod drawn_pieces;
mod outlines;
mod push;
mod stepper;
#[cfg(test)]
mod tests;
mod window_shifts;

use super::error::BuildError;
use super::transients::layers::PieceLayers;
use crate::geometry::{DVec2, count_crossings, orient2d};
use crate::recording::proof::DrawnLoop;
use crate::warp::{Arap, Guard, Warp};
use crate::work::progress::{Progress, check_cancelled};
use defects::{FirstDefect, trouble};
use drawn_pieces::DrawnPieces;
use outlines::GuardedOutlines;
use rayon::prelude::*;
use window_shifts::WindowShift;

/// Number of equal steps of t from 0 to 1 in the first pass that displaces vertices (heuristic).
const EVEN: u32 = 64;
/// Additional times in the first pass: after t = 0, when the two sides of a cut begin to move
/// apart, and equally long before t = 1 (heuristic).
const NEAR_ENDS: [f64; 4] = [1.0 / 1024.0, 1.0 / 512.0, 1.0 / 256.0, 1.0 / 128.0];

/// Times closer than this are treated as one (tolerance: far shorter than a step).
const SAME: f64 = 1e-6;

/// Maximum number of times that a time window is shortened (resource limit).
const SHIFTS: u32 = 8;
/// Maximum number of passes that displace vertices (resource limit).
const PUSHES: u32 = 4;

/// Motions with more faces are returned unchanged (resource limit: stepping through one with 20,000
/// faces takes seconds).
const MOST_FACES: usize = 20_000;

/// Number of equal steps of t over which folded faces and crossings are counted to compare two
/// results (resource limit).
const COMPARED: u32 = 256;

/// Motion that could not be proved free of folds and crossings, once from t = 0 to 1 and once with
/// source and target swapped.
pub(super) struct FailedProof([(GuardDirection, GuardCandidate); 2]);

impl FailedProof {
    /// Examines a motion at every t. Returns `None` if it is proved, if it has too many faces, or
    /// if it cannot be recorded.
    ///
    /// `pieces` is the number of pieces. `swelling` contains the indices of the pieces that swell,
    /// that is, grow in thickness within their outline. Their drawn outlines differ from the
    /// boundary of the mesh, so they are not examined.
    ///
    /// # Errors
    /// If the motion cannot be swapped or the work is cancelled.
    pub(super) fn of(
        film: &Arap,
        (pieces, swelling): (usize, &[usize]),
        levels: &PieceLayers,
        progress: &dyn Progress,
    ) -> Result<Option<Self>, BuildError> {
        if film.mesh().faces().len() > MOST_FACES {
            return Ok(None);
        }
        Self::of_drawn(film, DrawnPieces::of(pieces, swelling, levels), progress)
    }

    fn of_drawn(
        film: &Arap,
        drawn: DrawnPieces,
        progress: &dyn Progress,
    ) -> Result<Option<Self>, BuildError> {
        let there = GuardDirection {
            plain: film.clone(),
            drawn,
        };
        let plain = match there.tried(film.clone(), progress)? {
            Some(plain) if plain.trouble.is_some() => plain,
            _ => return Ok(None),
        };
        // Both directions are examined, so that swapping the designs does not change the result.
        let back = GuardDirection {
            plain: film.swapped(progress)?,
            drawn: there.drawn.clone(),
        };
        let from_back = back.tried(back.plain.clone(), progress)?;
        Ok(from_back.map(|from_back| Self([(there, plain), (back, from_back)])))
    }

    /// Returns the times at which a part that exists in only one design collides: the first such
    /// collision from t = 0, and the first from t = 1. Either is missing if another defect comes
    /// first.
    pub(super) fn births(&self) -> Vec<f64> {
        let [there, back] = self.0.each_ref().map(|(way, film)| way.birth(film));
        there.into_iter().chain(back.map(|t| 1.0 - t)).collect()
    }

    /// Shortens time windows and then displaces vertices until the proof succeeds. If it never
    /// does, returns the motion with the fewest folded faces and crossings.
    ///
    /// # Errors
    /// If a motion cannot be built or the work is cancelled.
    pub(super) fn kept_apart(&self, progress: &dyn Progress) -> Result<Arap, BuildError> {
        let [(there, plain), (back, from_back)] = &self.0;
        let both = |of: &GuardStage,
                    films: [&GuardCandidate; 2]|
         -> Result<[GuardCandidate; 2], BuildError> {
            let (a, b) = rayon::join(|| of(there, films[0]), || of(back, films[1]));
            Ok([a?, b?])
        };
        let mut best = both(&|way, film| way.retimed(film, progress), [plain, from_back])?;
        if best.iter().all(|film| film.trouble.is_some()) {
            best = both(&|way, film| way.pushed(film, progress), best.each_ref())?;
        }
        let [forwards, backwards] = best;
        if forwards.order() <= backwards.order() {
            return Ok(forwards.film);
        }
        Ok(backwards.film.swapped(progress)?)
    }
}

/// A function that changes a motion to avoid its collisions. The returned motion has the same
/// direction of t.
type GuardStage<'a> =
    dyn Fn(&GuardDirection, &GuardCandidate) -> Result<GuardCandidate, BuildError> + Sync + 'a;

/// A motion, possibly changed to avoid collisions, with its defects.
#[derive(Clone)]
struct GuardCandidate {
    film: Arap,
    trouble: Option<FirstDefect>,
    /// Number of folded faces and crossings, summed over [`COMPARED`] samples; 0 if the motion is
    /// proved.
    seen: usize,
    /// Difference from the original motion: the sum of the squared displacements, plus the total
    /// time by which time windows were shortened.
    differs: f64,
}

impl GuardCandidate {
    /// Returns the cost by which changed motions are compared; the lowest is best. Proved motions
    /// come first, then those with fewer folded faces and crossings, then those that differ less
    /// from the original.
    fn order(&self) -> f64 {
        let differs = self.differs / (1.0 + self.differs);
        match self.trouble {
            None => differs,
            Some(_) => 1.0 + self.seen as f64 + differs,
        }
    }
}

/// The original motion in one direction of t, and the pieces that are drawn.
struct GuardDirection {
    plain: Arap,
    drawn: DrawnPieces,
}

impl GuardDirection {
    /// Records a motion and counts its defects. Returns `None` if the motion cannot be recorded.
    fn tried(
        &self,
        film: Arap,
        progress: &dyn Progress,
    ) -> Result<Option<GuardCandidate>, BuildError> {
        let Some(trouble) = trouble(&film, &self.drawn, progress)? else {
            return Ok(None);
        };
        let lives = |film: &Arap| -> f64 {
            let each = film.time_windows().iter().flatten();
            each.map(|life| life.to - life.from).sum()
        };
        let pushed = film.guard().map_or(0.0, Guard::total);
        Ok(Some(GuardCandidate {
            trouble,
            seen: trouble.map_or(0, |_| seen(&film, &self.drawn.walks(&film))),
            differs: pushed + lives(&self.plain) - lives(&film),
            film,
        }))
    }

    /// Returns the time at which a part that exists in only one design collides, if that is the
    /// first defect.
    fn birth(&self, film: &GuardCandidate) -> Option<f64> {
        let meeting = film.trouble?.meeting?;
        let parts = film.film.mesh().components();
        let both = [meeting.vertex, meeting.edge[0]].map(|v| parts[v as usize] as usize);
        let lives = film.film.time_windows();
        let is_born = |&piece: &usize| lives.get(piece).is_some_and(Option::is_some);
        let is_born = both.iter().any(is_born);
        is_born.then_some(meeting.t)
    }

    /// Shortens the time windows of colliding parts that exist in only one design. Returns `plain`
    /// unchanged if a time window would become too short.
    fn retimed(
        &self,
        plain: &GuardCandidate,
        progress: &dyn Progress,
    ) -> Result<GuardCandidate, BuildError> {
        let mut tried = plain.clone();
        for _ in 0..SHIFTS {
            let Some(trouble) = tried.trouble else {
                break;
            };
            let lives = match window_shifts::shifted(&tried.film, &trouble) {
                WindowShift::To(lives) => lives,
                WindowShift::TooShort => return Ok(plain.clone()),
                WindowShift::NotTransient => break,
            };
            let film = tried.film.with_time_windows(lives, progress)?;
            let Some(next) = self.tried(film, progress)? else {
                break;
            };
            tried = next;
        }
        Ok(tried)
    }

    /// Displaces colliding vertices, with finer time steps after each motion that could not be
    /// proved. Returns the best motion, which may be `start`.
    fn pushed(
        &self,
        start: &GuardCandidate,
        progress: &dyn Progress,
    ) -> Result<GuardCandidate, BuildError> {
        let walks = self.drawn.walks(&start.film);
        let mut best = start.clone();
        let (Some(outlines), Some(mut trouble)) =
            (GuardedOutlines::of(&start.film, &walks), start.trouble)
        else {
            return Ok(best);
        };
        let mut times = times();
        for _ in 0..PUSHES {
            check_cancelled(progress)?;
            divide(&mut times, trouble.t);
            let moved = stepper::through(&start.film, &outlines, &times, progress)?;
            let Some(guard) = moved.and_then(guard) else {
                break;
            };
            let Some(tried) = self.tried(start.film.with_guard(Some(guard)), progress)? else {
                break;
            };
            let next = tried.trouble;
            if tried.order() < best.order() {
                best = tried;
            }
            match next {
                Some(next) => trouble = next,
                None => break,
            }
        }
        Ok(best)
    }
}

/// Returns the times at which the first pass displaces vertices, in increasing order.
fn times() -> Vec<f64> {
    let even = (0..=EVEN).map(|k| f64::from(k) / f64::from(EVEN));
    let near = NEAR_ENDS.iter().flat_map(|&t| [t, 1.0 - t]);
    let mut times: Vec<f64> = even.chain(near).collect();
    times.sort_by(f64::total_cmp);
    times
}

/// Adds the time `t`, and the midpoints between it and its two neighbours.
fn divide(times: &mut Vec<f64>, t: f64) {
    let after = times
        .partition_point(|&time| time <= t)
        .clamp(1, times.len() - 1);
    let about = [times[after - 1], t, times[after]];
    times.extend([t, about[0].midpoint(t), t.midpoint(about[2])]);
    times.sort_by(f64::total_cmp);
    times.dedup_by(|b, a| *b - *a < SAME);
}

/// Creates a guard, the stored displacements of a motion, from the displacements at all times. The
/// guard starts one time before the first displacement and ends one time after the last.
fn guard(moved: stepper::GuardDisplacements) -> Option<Guard> {
    let moves = |k: &usize| moved[*k].1.iter().any(|&by| by != DVec2::ZERO);
    let first = (0..moved.len()).find(moves)?.saturating_sub(1);
    let last = ((0..moved.len()).rfind(moves)? + 1).min(moved.len() - 1);
    let within = moved.into_iter().skip(first).take(last + 1 - first);
    let (times, moved): (Vec<f64>, Vec<Vec<DVec2>>) = within.unzip();
    Guard::new(times, &moved)
}

/// Returns the number of folded faces and crossings, summed over the samples between t = 0 and
/// t = 1 in [`COMPARED`] equal steps.
fn seen(film: &Arap, drawn: &[DrawnLoop]) -> usize {
    let at = |step: u32| {
        let t = f64::from(step) / f64::from(COMPARED);
        let mut placer = film.placer();
        placer.place(t);
        let places = &placer.placement().in_frame;
        let is_folded = |face: &&[u32; 3]| {
            let [a, b, c] = face.map(|v| places[v as usize]);
            orient2d(a, b, c) <= 0.0
        };
        let levels = drawn.iter().map(|walk| walk.layer).max().unwrap_or(0);
        let crossings = (0..=levels).map(|level| {
            let is_there = |walk: &&DrawnLoop| {
                walk.layer == level && walk.visible_interval[0] < t && t < walk.visible_interval[1]
            };
            let ring =
                |walk: &DrawnLoop| walk.vertices.iter().map(|&v| places[v as usize]).collect();
            let rings: Vec<Vec<DVec2>> = drawn.iter().filter(is_there).map(ring).collect();
            count_crossings(&rings)
        });
        film.mesh().faces().iter().filter(is_folded).count() + crossings.sum::<usize>()
    };
    (1..COMPARED).into_par_iter().map(at).sum()
}

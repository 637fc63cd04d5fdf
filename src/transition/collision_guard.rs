//! A film that keeps out of its own way, at every t.
//!
//! Rigid parts fold where their neighbours want something else, and outlines go through
//! each other where nothing tells them not to. Each film is proved
//! ([`crate::recording::proof`]); one that cannot be is guarded. Where it is what comes or goes
//! that is met, who gives all of it its place is told when ([`FailedProof::births`]); and
//! what still is comes later, or goes earlier. Where that is not enough, the film is
//! walked through, and what would meet is pushed aside by as little as keeps it apart:
//! the smallest displacement, in an energy that knows of no spikes, for which faces stay
//! positive and outlines apart. Both are done from either end. Each film so found is
//! proved anew, and looked at more closely where that fails.
//!
//! Guaranteed: where nothing is wrong the film is the plain one, bit for bit; both ends
//! are the designs; the film backwards is that of the exchanged designs. Not
//! guaranteed: that what meets can be kept apart. What runs into another head-on is held
//! up by it and not led around, and a limb that goes all the way through another is on
//! its other side when the design is reached; of films that are not proved the one is
//! kept that shows less.
//!
//! - `trouble`: what is first not proved
//! - `drawn`: what is drawn as the mesh has it, and when
//! - `lives`: what comes later, or goes earlier
//! - `outlines`: what may meet what, and which of it is near
//! - `yielding`: how a mesh gives way where it is pushed
//! - `push`: the smallest displacement that keeps so much apart
//! - `walk`: through the film, pushing aside what is in the way

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

/// Even steps of a walk through the film; near both ends, where seams open, more.
const EVEN: u32 = 64;
const NEAR_ENDS: [f64; 4] = [1.0 / 1024.0, 1.0 / 512.0, 1.0 / 256.0, 1.0 / 128.0];

/// Steps that are nearer to each other are one.
const SAME: f64 = 1e-6;

/// How often lives are shifted, and how often what is in the way is pushed aside: of 60
/// pairs of icons none was proved that took more than three of either.
const SHIFTS: u32 = 8;
const PUSHES: u32 = 4;

/// Films of more faces are as they are: to walk through one of 20,000 takes seconds.
const MOST_FACES: usize = 20_000;

/// Steps of two films that are compared.
const COMPARED: u32 = 256;

/// A film that is not proved, from either end.
pub(super) struct FailedProof([(GuardDirection, GuardCandidate); 2]);

impl FailedProof {
    /// Nothing where the film is proved, or too large to be guarded. `swelling` are the
    /// pieces that are not drawn as the mesh has them.
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
        // From either end: none of the designs is the first.
        let back = GuardDirection {
            plain: film.swapped(progress)?,
            drawn: there.drawn.clone(),
        };
        let from_back = back.tried(back.plain.clone(), progress)?;
        Ok(from_back.map(|from_back| Self([(there, plain), (back, from_back)])))
    }

    /// When parts of one design alone meet something, as far as that is known.
    pub(super) fn births(&self) -> Vec<f64> {
        let [there, back] = self.0.each_ref().map(|(way, film)| way.birth(film));
        there.into_iter().chain(back.map(|t| 1.0 - t)).collect()
    }

    /// The film in which the least is wrong.
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

/// What makes another of a film.
type GuardStage<'a> =
    dyn Fn(&GuardDirection, &GuardCandidate) -> Result<GuardCandidate, BuildError> + Sync + 'a;

/// A film that was tried.
#[derive(Clone)]
struct GuardCandidate {
    film: Arap,
    trouble: Option<FirstDefect>,
    /// Faces that are folded and crossings, over all steps.
    seen: usize,
    /// By how much it differs from the plain film.
    differs: f64,
}

impl GuardCandidate {
    /// The less, the better: what is proved, then what shows less, then what differs
    /// less.
    fn order(&self) -> f64 {
        let differs = self.differs / (1.0 + self.differs);
        match self.trouble {
            None => differs,
            Some(_) => 1.0 + self.seen as f64 + differs,
        }
    }
}

/// A film from its t = 0.
struct GuardDirection {
    plain: Arap,
    drawn: DrawnPieces,
}

impl GuardDirection {
    /// A film that was found for it; none where it does not settle.
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

    /// When a part of one design alone meets something, if that is what comes first.
    fn birth(&self, film: &GuardCandidate) -> Option<f64> {
        let meeting = film.trouble?.meeting?;
        let parts = film.film.mesh().components();
        let both = [meeting.vertex, meeting.edge[0]].map(|v| parts[v as usize] as usize);
        let lives = film.film.time_windows();
        let is_born = |&piece: &usize| lives.get(piece).is_some_and(Option::is_some);
        let is_born = both.iter().any(is_born);
        is_born.then_some(meeting.t)
    }

    /// The film in which what comes or goes does so later or earlier; the plain one where
    /// it would have no time left.
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

    /// The best of the films in which what is in the way is pushed aside.
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

/// The steps of a first walk.
fn times() -> Vec<f64> {
    let even = (0..=EVEN).map(|k| f64::from(k) / f64::from(EVEN));
    let near = NEAR_ENDS.iter().flat_map(|&t| [t, 1.0 - t]);
    let mut times: Vec<f64> = even.chain(near).collect();
    times.sort_by(f64::total_cmp);
    times
}

/// Adds a step at a time, and divides those about it.
fn divide(times: &mut Vec<f64>, t: f64) {
    let after = times
        .partition_point(|&time| time <= t)
        .clamp(1, times.len() - 1);
    let about = [times[after - 1], t, times[after]];
    times.extend([t, about[0].midpoint(t), t.midpoint(about[2])]);
    times.sort_by(f64::total_cmp);
    times.dedup_by(|b, a| *b - *a < SAME);
}

/// A guard of the times at which anything is moved, and those beside them.
fn guard(moved: stepper::GuardDisplacements) -> Option<Guard> {
    let moves = |k: &usize| moved[*k].1.iter().any(|&by| by != DVec2::ZERO);
    let first = (0..moved.len()).find(moves)?.saturating_sub(1);
    let last = ((0..moved.len()).rfind(moves)? + 1).min(moved.len() - 1);
    let within = moved.into_iter().skip(first).take(last + 1 - first);
    let (times, moved): (Vec<f64>, Vec<Vec<DVec2>>) = within.unzip();
    Guard::new(times, &moved)
}

/// How much of a film is folded or crosses, at steps.
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

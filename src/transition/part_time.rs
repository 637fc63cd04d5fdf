//! Parts that make their way in their own time.
//!
//! What is said of a part is said by a point of a design, and holds for all that
//! the part becomes: where it is split, for each of the pieces.

use super::moved::AnyWarp;
use super::note::Note;
use super::ready::Inner;
use crate::content::{Clocks, Coat, Coating, Content, Solid};
use crate::correspondence::{PieceMatch, RegionMatch};
use crate::easing::Ease;
use crate::geometry::{DVec2, RANGE, Side, Similarity, is_in_range, twice_signed_area};
use crate::warp::{Arap, Clock, Staggered};
use serde::{Deserialize, Serialize};

/// When a part makes its way within the film.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct PartTime {
    /// The design in which the part is named.
    pub side: Side,
    /// A point in or near it: in a document in the design's own coordinates, in a
    /// specification in those of the common frame.
    pub at: DVec2,
    /// When it sets out, from 0.
    #[serde(default)]
    pub from: f64,
    /// When it arrives, later than that, up to 1.
    #[serde(default = "one")]
    pub to: f64,
    /// How it runs in between.
    #[serde(default)]
    pub easing: Ease,
}

fn one() -> f64 {
    1.0
}

/// A time that cannot be meant. Parts count from 1 in messages.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum PartTimeError {
    /// The point is too far out.
    #[error("the part of time {} {RANGE}", .0 + 1)]
    Place(usize),
    /// It does not set out and then arrive.
    #[error(
        "a part cannot make its way from t = {from} to t = {to}; give two numbers from 0 to 1, the first of them smaller"
    )]
    Span {
        /// When it was to set out.
        from: f64,
        /// When it was to arrive.
        to: f64,
    },
}

impl PartTime {
    /// Checks that all are places and times that can be meant.
    ///
    /// # Errors
    /// [`PartTimeError`] names the first that is none.
    pub fn check(all: &[Self]) -> Result<(), PartTimeError> {
        for (k, &Self { at, from, to, .. }) in all.iter().enumerate() {
            if !is_in_range(at) {
                return Err(PartTimeError::Place(k));
            }
            if !(0.0 <= from && from < to && to <= 1.0) {
                return Err(PartTimeError::Span { from, to });
            }
        }
        Ok(())
    }

    /// When it makes its way.
    #[must_use]
    pub fn clock(&self) -> Clock {
        let Self {
            from, to, easing, ..
        } = *self;
        Clock { from, to, easing }
    }

    /// The same by another clock.
    #[must_use]
    pub fn with_clock(self, Clock { from, to, easing }: Clock) -> Self {
        Self {
            from,
            to,
            easing,
            ..self
        }
    }

    /// The same said of designs that were laid down by one similarity each.
    #[must_use]
    pub fn placed(&self, by: &[Similarity; 2]) -> Self {
        Self {
            at: by[self.side].apply(self.at),
            ..*self
        }
    }

    /// The same of the designs exchanged, whose film runs the other way.
    #[must_use]
    pub fn swapped(&self) -> Self {
        Self {
            side: self.side.other(),
            ..self.with_clock(self.clock().backwards())
        }
    }
}

impl Inner {
    /// The same transition, in which parts have these times of their own and no
    /// others. Only rigid parts have any.
    pub(super) fn timed(mut self, times: &[PartTime]) -> Self {
        self.moved.notes.retain(|note| *note != Note::OneTime);
        let arap = match (&self.content, &self.moved.warp) {
            (Content::Solid(_), AnyWarp::Rigid(arap)) => arap.clone(),
            (Content::Solid(_), AnyWarp::Staggered(warp)) => warp.arap().clone(),
            _ => {
                if !times.is_empty() {
                    self.moved.notes.push(Note::OneTime);
                }
                return self;
            }
        };
        let Content::Solid(solid) = &mut self.content else {
            return self;
        };
        if times.is_empty() {
            solid.take_clocks();
            self.moved.warp = AnyWarp::Rigid(arap);
            return self;
        }
        let clocks: Vec<Clock> = times.iter().map(PartTime::clock).collect();
        let of_parts = of_parts(&arap, self.moved.matched.as_ref(), times);
        solid.put_clocks(&arap, &clocks, &of_parts);
        self.moved.warp = AnyWarp::Staggered(Staggered::new(arap, &clocks, &of_parts));
        self
    }
}

/// For each connected part the number of the time that it has, the last of several.
fn of_parts(film: &Arap, matched: Option<&RegionMatch>, times: &[PartTime]) -> Vec<Option<usize>> {
    let of_vertices = film.mesh().components();
    let count = of_vertices
        .iter()
        .max()
        .map_or(0, |&most| most as usize + 1);
    let mut of_parts = vec![None; count];
    let pieces: &[PieceMatch] = matched.map_or(&[], |matched| &matched.pieces);
    for (k, time) in times.iter().enumerate() {
        let Some(named) = part_at(film, &of_vertices, time.side, time.at) else {
            continue;
        };
        of_parts[named] = Some(k);
        let part = |piece: usize| {
            let piece = pieces.get(piece)?;
            [piece.source_part, piece.target_part][time.side]
        };
        // A part that is split has several pieces.
        if let Some(own) = part(named) {
            let pieces = (0..count).filter(|&piece| part(piece) == Some(own));
            pieces.for_each(|piece| of_parts[piece] = Some(k));
        }
    }
    of_parts
}

/// The connected part that a point of a design is in, or else the nearest one.
fn part_at(film: &Arap, of_vertices: &[u32], side: Side, at: DVec2) -> Option<usize> {
    let mesh = film.mesh();
    let places = [mesh.source(), mesh.target()][side];
    let holds = |face: &&[u32; 3]| {
        let [a, b, c] = face.map(|v| places[v as usize]);
        let beside = [[a, b], [b, c], [c, a]];
        let is_left = |[a, b]: &[DVec2; 2]| twice_signed_area(*a, *b, at) >= 0.0;
        twice_signed_area(a, b, c) > 0.0 && beside.iter().all(is_left)
    };
    let vertex = mesh.faces().iter().find(holds).map(|face| face[0] as usize);
    let far = |v: &usize| places[*v].distance_squared(at);
    let vertex = vertex.or_else(|| (0..places.len()).min_by(|a, b| far(a).total_cmp(&far(b))));
    Some(of_vertices[vertex?] as usize)
}

impl Solid {
    fn take_clocks(&mut self) {
        self.clocks = None;
        // It was there for the sake of the clocks.
        self.coating = self.coating.take().filter(|coating| !is_plain(coating));
    }

    /// Parts in one colour are coats too: it goes with their time.
    fn put_clocks(&mut self, film: &Arap, clocks: &[Clock], of_parts: &[Option<usize>]) {
        let of_vertices = film.mesh().components();
        let clock = |v: u32| of_parts[of_vertices[v as usize] as usize].unwrap_or(clocks.len());
        let of_walk = |walk: &Vec<u32>| walk.first().map_or(clocks.len(), |&v| clock(v));
        self.clocks = Some(Clocks {
            of_walks: self.loops.iter().map(of_walk).collect(),
            of_holes: self
                .holes
                .iter()
                .map(|hole| clock(hole.face(0)[0]))
                .collect(),
            clocks: clocks.iter().copied().chain([Clock::WHOLE]).collect(),
        });
        if self.coating.is_none() && !self.loops.is_empty() {
            self.coating = Some(Coating::plain(self.loops.len(), self.holes.len()));
        }
    }
}

/// Whether it says nothing.
fn is_plain(coating: &Coating) -> bool {
    let is_plain = |coat: &Coat| coat.paints == [None; 2] && coat.lines == [None; 2];
    coating.coats.iter().all(is_plain)
}

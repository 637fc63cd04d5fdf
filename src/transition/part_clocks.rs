//! Gives the parts of a film their own times.

use super::any_warp::AnyWarp;
use super::note::TransitionNote;
use super::part_time::PartTime;
use super::transition::{RecordingSlot, TransitionData};
use crate::content::{BarClocks, Content, PaintLayerStack, PlacedPaintLayer, SolidContent};
use crate::correspondence::{PieceMatch, RegionMatch};
use crate::geometry::{DVec2, twice_signed_area};
use crate::warp::{Arap, PartClock, StaggeredArap};
use std::collections::BTreeMap;

impl TransitionData {
    /// The same transition, in which parts have these times of their own and no
    /// others. Only rigid parts have any.
    pub(super) fn timed(mut self, times: &[PartTime]) -> Self {
        self.moved
            .notes
            .retain(|note| *note != TransitionNote::OneTime);
        let arap = match (&self.content, &self.moved.warp) {
            (Content::Solid(_), AnyWarp::Rigid(arap)) => arap.clone(),
            (Content::Solid(_), AnyWarp::Staggered(warp)) => warp.arap().clone(),
            _ => {
                if !times.is_empty() {
                    self.moved.notes.push(TransitionNote::OneTime);
                }
                return self;
            }
        };
        let Content::Solid(solid) = &mut self.content else {
            return self;
        };
        // What was recorded has other times, unless none had any.
        if !times.is_empty() || matches!(self.moved.warp, AnyWarp::Staggered(_)) {
            self.film = RecordingSlot::default();
        }
        if times.is_empty() {
            solid.take_clocks();
            self.moved.warp = AnyWarp::Rigid(arap);
            return self;
        }
        let clocks: Vec<PartClock> = times.iter().map(PartTime::clock).collect();
        let of_parts = of_parts(&arap, self.moved.matched.as_ref(), times);
        let (clocks, of_parts) = in_use(&clocks, &of_parts);
        solid.put_clocks(&arap, &clocks, &of_parts);
        self.moved.warp = AnyWarp::Staggered(StaggeredArap::new(arap, &clocks, &of_parts));
        self
    }
}

/// The clocks that parts go by, each once, and for each part the number of its own.
fn in_use(
    clocks: &[PartClock],
    of_parts: &[Option<usize>],
) -> (Vec<PartClock>, Vec<Option<usize>>) {
    let mut used: Vec<PartClock> = Vec::new();
    let mut renumbered = BTreeMap::new();
    let number = |of_part: &Option<usize>| {
        let own = (*of_part)?;
        Some(*renumbered.entry(own).or_insert_with(|| {
            let same = used.iter().position(|clock| *clock == clocks[own]);
            same.unwrap_or_else(|| {
                used.push(clocks[own]);
                used.len() - 1
            })
        }))
    };
    let of_parts = of_parts.iter().map(number).collect();
    (used, of_parts)
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
        let part = |piece: usize| {
            let piece = pieces.get(piece)?;
            [piece.source_part, piece.target_part][time.side]
        };
        let Some(named) = part_at(film, &of_vertices, time, part) else {
            continue;
        };
        of_parts[named] = Some(k);
        // A part that is split has several pieces.
        if let Some(own) = part(named) {
            let pieces = (0..count).filter(|&piece| part(piece) == Some(own));
            pieces.for_each(|piece| of_parts[piece] = Some(k));
        }
    }
    of_parts
}

/// The connected part that the point of a time is in, or else the nearest one. Of several that
/// hold it the uppermost: parts of a design are painted in the order of their numbers.
fn part_at(
    film: &Arap,
    of_vertices: &[u32],
    time: &PartTime,
    part: impl Fn(usize) -> Option<usize>,
) -> Option<usize> {
    let mesh = film.mesh();
    let places = [mesh.source(), mesh.target()][time.side];
    let holds = |face: &&[u32; 3]| {
        let [a, b, c] = face.map(|v| places[v as usize]);
        let beside = [[a, b], [b, c], [c, a]];
        let is_left = |[a, b]: &[DVec2; 2]| twice_signed_area(*a, *b, time.at) >= 0.0;
        twice_signed_area(a, b, c) > 0.0 && beside.iter().all(is_left)
    };
    let component = |v: usize| of_vertices[v] as usize;
    let holding = mesh.faces().iter().filter(holds);
    let uppermost = holding
        .map(|face| component(face[0] as usize))
        .max_by_key(|&component| part(component));
    let far = |v: &usize| places[*v].distance_squared(time.at);
    uppermost.or_else(|| {
        let nearest = (0..places.len()).min_by(|a, b| far(a).total_cmp(&far(b)))?;
        Some(component(nearest))
    })
}

impl SolidContent {
    fn take_clocks(&mut self) {
        self.clocks = None;
        // It was there for the sake of the clocks.
        self.coating = self.coating.take().filter(|coating| !is_plain(coating));
    }

    /// Parts in one colour are coats too: it goes with their time.
    fn put_clocks(&mut self, film: &Arap, clocks: &[PartClock], of_parts: &[Option<usize>]) {
        let of_vertices = film.mesh().components();
        let clock = |v: u32| of_parts[of_vertices[v as usize] as usize].unwrap_or(clocks.len());
        let of_walk = |walk: &Vec<u32>| walk.first().map_or(clocks.len(), |&v| clock(v));
        self.clocks = Some(BarClocks {
            of_walks: self.loops.iter().map(of_walk).collect(),
            of_holes: self
                .holes
                .iter()
                .map(|hole| clock(hole.face(0)[0]))
                .collect(),
            of_vertices: (0..of_vertices.len() as u32).map(clock).collect(),
            clocks: clocks.iter().copied().chain([PartClock::WHOLE]).collect(),
        });
        if self.coating.is_none() && !self.loops.is_empty() {
            self.coating = Some(PaintLayerStack::plain(self.loops.len(), self.holes.len()));
        }
    }
}

/// Whether it says nothing.
fn is_plain(coating: &PaintLayerStack) -> bool {
    let is_plain = |coat: &PlacedPaintLayer| coat.paints == [None; 2] && coat.lines == [None; 2];
    coating.coats.iter().all(is_plain)
}

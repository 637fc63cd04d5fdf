//! Applies part timings, the time windows of individual parts, to a transition.

use super::any_warp::AnyWarp;
use super::note::TransitionNote;
use super::part_time::PartTime;
use super::transition::{RecordingSlot, TransitionData};
use crate::content::{Content, PaintLayerStack, PlacedPaintLayer, SolidClocks, SolidContent};
use crate::correspondence::{PieceMatch, RegionMatch};
use crate::geometry::{DVec2, twice_signed_area};
use crate::warp::{Arap, PartClock, StaggeredArap};
use std::collections::BTreeMap;

impl TransitionData {
    /// Replaces the part timings. If the method is not rigid parts, nothing changes except that a
    /// note is added.
    pub(super) fn with_part_times(mut self, times: &[PartTime]) -> Self {
        self.built_warp
            .notes
            .retain(|note| *note != TransitionNote::PartTimesIgnored);
        let arap = match (&self.content, &self.built_warp.warp) {
            (Content::Solid(_), AnyWarp::Rigid(arap)) => arap.clone(),
            (Content::Solid(_), AnyWarp::Staggered(warp)) => warp.arap().clone(),
            _ => {
                if !times.is_empty() {
                    self.built_warp.notes.push(TransitionNote::PartTimesIgnored);
                }
                return self;
            }
        };
        let Content::Solid(solid) = &mut self.content else {
            return self;
        };
        // An existing recording is kept only if there were no timings before and there are none
        // now.
        if !times.is_empty() || matches!(self.built_warp.warp, AnyWarp::Staggered(_)) {
            self.recording = RecordingSlot::default();
        }
        if times.is_empty() {
            solid.take_clocks();
            self.built_warp.warp = AnyWarp::Rigid(arap);
            return self;
        }
        let clocks: Vec<PartClock> = times.iter().map(PartTime::clock).collect();
        let of_parts = clock_of_parts(&arap, self.built_warp.matched.as_ref(), times);
        let (clocks, of_parts) = used_clocks(&clocks, &of_parts);
        solid.put_clocks(&arap, &clocks, &of_parts);
        self.built_warp.warp = AnyWarp::Staggered(StaggeredArap::new(arap, &clocks, &of_parts));
        self
    }
}

/// Removes duplicate and unused clocks (a clock is the time window and easing of a part). Returns
/// the remaining clocks and, for each part, the index of its clock among them; `None` for a part
/// without a clock. `of_parts` holds, for each part, the index of its clock in `clocks`.
fn used_clocks(
    clocks: &[PartClock],
    of_parts: &[Option<usize>],
) -> (Vec<PartClock>, Vec<Option<usize>>) {
    let mut distinct: Vec<PartClock> = Vec::new();
    let mut renumbered = BTreeMap::new();
    let index_of = |of_part: &Option<usize>| {
        let own = (*of_part)?;
        Some(*renumbered.entry(own).or_insert_with(|| {
            let same = distinct.iter().position(|clock| *clock == clocks[own]);
            same.unwrap_or_else(|| {
                distinct.push(clocks[own]);
                distinct.len() - 1
            })
        }))
    };
    let of_parts = of_parts.iter().map(index_of).collect();
    (distinct, of_parts)
}

/// Returns, for each connected part of the mesh, the index of its timing in `times`; `None` if no
/// timing applies to the part. If several timings apply, the last one wins.
fn clock_of_parts(
    arap: &Arap,
    matched: Option<&RegionMatch>,
    times: &[PartTime],
) -> Vec<Option<usize>> {
    let of_vertices = arap.mesh().components();
    let count = of_vertices
        .iter()
        .max()
        .map_or(0, |&highest| highest as usize + 1);
    let mut of_parts = vec![None; count];
    let pieces: &[PieceMatch] = matched.map_or(&[], |matched| &matched.pieces);
    for (k, time) in times.iter().enumerate() {
        let part = |piece: usize| {
            let piece = pieces.get(piece)?;
            [piece.source_part, piece.target_part][time.side]
        };
        let Some(named) = part_at(arap, &of_vertices, time, part) else {
            continue;
        };
        of_parts[named] = Some(k);
        // A part that is split has several pieces, which share its timing.
        if let Some(own) = part(named) {
            let pieces = (0..count).filter(|&piece| part(piece) == Some(own));
            pieces.for_each(|piece| of_parts[piece] = Some(k));
        }
    }
    of_parts
}

/// Returns the connected part that contains the point of a timing, or else the part nearest to the
/// point. If several parts contain the point, returns the uppermost one. Parts of the design are
/// painted in ascending order, so the uppermost part is the one for which `part` returns the
/// highest index.
fn part_at(
    arap: &Arap,
    of_vertices: &[u32],
    time: &PartTime,
    part: impl Fn(usize) -> Option<usize>,
) -> Option<usize> {
    let mesh = arap.mesh();
    let places = [mesh.source(), mesh.target()][time.side];
    let contains_point = |face: &&[u32; 3]| {
        let [a, b, c] = face.map(|v| places[v as usize]);
        let edges = [[a, b], [b, c], [c, a]];
        let is_left = |[a, b]: &[DVec2; 2]| twice_signed_area(*a, *b, time.at) >= 0.0;
        twice_signed_area(a, b, c) > 0.0 && edges.iter().all(is_left)
    };
    let component = |v: usize| of_vertices[v] as usize;
    let containing = mesh.faces().iter().filter(contains_point);
    let uppermost = containing
        .map(|face| component(face[0] as usize))
        .max_by_key(|&component| part(component));
    let distance_squared = |v: &usize| places[*v].distance_squared(time.at);
    uppermost.or_else(|| {
        let nearest =
            (0..places.len()).min_by(|a, b| distance_squared(a).total_cmp(&distance_squared(b)))?;
        Some(component(nearest))
    })
}

impl SolidContent {
    /// Removes the time windows and easings of all parts, so that all parts move at the same time.
    fn take_clocks(&mut self) {
        if self.part_clocks.take().is_some() {
            // If the design is shown in one colour, its paint layer was added together with the
            // clocks, so it is removed too.
            self.paint_layers = self
                .paint_layers
                .take()
                .filter(|layers| !is_single_plain_layer(layers));
        }
    }

    /// Assigns a clock (time window and easing) to each loop, hole and vertex. A design in one
    /// colour also gets a paint layer, because the colour of each part then follows the clock of
    /// that part.
    fn put_clocks(&mut self, arap: &Arap, clocks: &[PartClock], of_parts: &[Option<usize>]) {
        let of_vertices = arap.mesh().components();
        let clock_of = |v: u32| of_parts[of_vertices[v as usize] as usize].unwrap_or(clocks.len());
        let clock_of_loop = |boundary_loop: &Vec<u32>| {
            let first = boundary_loop.first();
            first.map_or(clocks.len(), |&v| clock_of(v))
        };
        self.part_clocks = Some(SolidClocks {
            of_loops: self.loops.iter().map(clock_of_loop).collect(),
            of_holes: self
                .holes
                .iter()
                .map(|hole| clock_of(hole.host_face(0)[0]))
                .collect(),
            of_vertices: (0..of_vertices.len() as u32).map(clock_of).collect(),
            clocks: clocks.iter().copied().chain([PartClock::WHOLE]).collect(),
        });
        if self.paint_layers.is_none() && !self.loops.is_empty() {
            self.paint_layers = Some(PaintLayerStack::single_layer(
                self.loops.len(),
                self.holes.len(),
            ));
        }
    }
}

/// Returns whether there is a single layer, and it has no paint and no stroke.
fn is_single_plain_layer(layers: &PaintLayerStack) -> bool {
    let is_plain =
        |layer: &PlacedPaintLayer| layer.paints == [None; 2] && layer.strokes == [None; 2];
    layers.layers.len() == 1 && layers.layers.iter().all(is_plain)
}

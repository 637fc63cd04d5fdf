//! Searches for the position and the time window of a part that exists in only one design, such
//! that the part collides as little as possible with everything else that is drawn during the
//! motion.
//!
//! The part's *own position* is the position to which the outlines around it would carry it. Among
//! positions that are equally free of collisions, the nearest to the own position is chosen; among
//! time windows, the one that suits the schedule best ([`TransientSchedule`]).

use super::anchor::{carried_among, carried_within};
use super::seed_shape::TransientPart;
use crate::geometry::{Bounds, DVec2, Side};
use crate::transition::transients::boundary_loops::SharedPartLoops;
use crate::transition::transients::holes::PieceHole;
use crate::transition::transients::layered_outline::{LayeredEdges, LayeredOutline};
use crate::transition::transients::layers::PieceLayers;
use crate::transition::transients::sample_times::{FINE_STEP, SampleTimes};
use crate::transition::transients::schedule::{TransientSchedule, eighths};
use crate::warp::{Arap, Placer, TimeWindow, Warp};
use rayon::prelude::*;
use std::sync::atomic::{AtomicU64, Ordering};

/// Required clearance around a growing part, as a fraction of its current size; it decreases to 0
/// at full size (heuristic).
const MARGIN: f64 = 0.05;

/// Number of candidate positions along each side of the bounding box (heuristic).
const PLACES: u32 = 10;
/// Maximum total number of candidate positions of all parts (resource limit: a hundred nested
/// rings, none of which finds a free position, took minutes).
const PLACES_OF_ALL: f64 = 2400.0;

/// Number of candidate positions that are examined in parallel (heuristic: more would be examined
/// before the best cost so far is known).
const ABREAST: usize = 8;

/// Cost for each unit of t during which a part collides: 5 for a step of 1/64 (heuristic).
const MEETING: f64 = 320.0;
/// Cost for each diameter of the design between a candidate position and the part's own position,
/// to which the surrounding outlines would carry it (heuristic).
const DISTANCE: f64 = 0.25;
/// Additional cost of the shortest time window, in which a part appears or disappears at once
/// (heuristic).
const AT_ONCE: f64 = 0.5;

/// Largest cost that [`TransientScene::prices`] assigns to a time window (heuristic).
const DEAR: f64 = 1.0;

/// Position, time window and kind of growth of a part that exists in only one design.
#[derive(Clone, Copy)]
pub(super) struct TransientPlacement {
    /// Position of the part's centroid in the design in which the part is a seed shape.
    pub(super) place: DVec2,
    pub(super) life: TimeWindow,
    /// Whether the part grows in thickness within its outline instead of from a seed shape.
    pub(super) swells: bool,
}

impl TransientPlacement {
    /// Returns the outlines of the part at `t`. A growing part is enlarged to keep its clearance:
    /// by nearly the fraction `margin` of its size while it is small, and not at all at full size.
    fn at(&self, speck: &TransientPart, film: &Arap, t: f64, margin: f64) -> Vec<LayeredOutline> {
        let share = self.life.fraction_done(t);
        // Nothing is drawn while the part has no size.
        if self.life.is_absent(t) {
            return Vec::new();
        }
        let centre = film.carried_position(speck.ends_at(self.place), share, t);
        if self.swells {
            return speck.swollen(centre, share);
        }
        let size = speck.size(share);
        speck.at(centre, size * (1.0 + margin * (1.0 - size)))
    }
}

impl TransientPlacement {
    /// Returns the position at `t` of a point that lies at `here` in the design that has the part,
    /// and that moves with the part.
    fn takes(&self, speck: &TransientPart, film: &Arap, here: DVec2, t: f64) -> DVec2 {
        let share = self.life.fraction_done(t);
        let centre = film.carried_position(speck.ends_at(self.place), share, t);
        let from_centre = here - speck.ends[speck.side];
        match self.swells {
            // A swelling part keeps its outline and only grows in thickness, so the point moves as
            // the whole part does.
            true => centre + speck.off_middle_at(share) + from_centre,
            false => centre + from_centre * speck.size(share),
        }
    }
}

/// A part whose placement is chosen.
struct SceneTransient<'a> {
    speck: &'a TransientPart,
    birth: TransientPlacement,
    /// Outlines of the part at each sample time.
    outlines: Vec<Vec<LayeredOutline>>,
}

/// A part that is not placed yet.
struct UnplacedTransient {
    /// The design that has the part.
    side: Side,
    /// Outlines of the part in that design.
    outlines: Vec<LayeredOutline>,
    edges: LayeredEdges,
}

/// Everything that is drawn at each sample time, t = 0 and t = 1 included.
pub(super) struct TransientScene<'a> {
    steps: &'a SampleTimes,
    /// Outlines of the matched parts at each sample time.
    outlines: Vec<Vec<LayeredOutline>>,
    /// Edges of `outlines`, of the visible holes that exist in only one design, and of the parts
    /// that are already placed, at each sample time.
    edges: Vec<LayeredEdges>,
    /// Parts that are already placed.
    born: Vec<SceneTransient<'a>>,
    /// Parts that are not placed yet. The next part to be placed is the last entry.
    unplaced: Vec<UnplacedTransient>,
    bounds: Bounds,
    /// Candidate positions, in addition to those along the part's own outline.
    grid: Vec<DVec2>,
    /// See [`Self::tested_pairs`].
    tested_pairs: AtomicU64,
}

impl<'a> TransientScene<'a> {
    /// Collects the outlines of the matched parts and of the holes at each sample time. `specks`
    /// are the parts to be placed, in this order.
    pub(super) fn of(
        film: &Arap,
        (holes, specks): (&[PieceHole], &[TransientPart]),
        (levels, steps): (&PieceLayers, &'a SampleTimes),
    ) -> Self {
        let walks = SharedPartLoops::of(film);
        let at = |placer: &mut Placer, &t: &f64| -> (Vec<LayeredOutline>, LayeredEdges) {
            placer.place(t);
            let places = &placer.placement().in_frame;
            let outlines = walks.outlines(places, levels);
            let mut edges = LayeredEdges::of(&outlines);
            for (piece, hole) in holes {
                if let Some(ring) = hole.ring_at(places, t) {
                    edges.add(&LayeredOutline::of(ring, levels.of_piece(*piece)));
                }
            }
            (outlines, edges)
        };
        let all = steps.times().par_iter().map_init(|| film.placer(), at);
        let (outlines, edges) = all.unzip();
        let bounds = film.mesh().bounds();
        let unplaced = |speck: &TransientPart| {
            let outlines = speck.at(speck.ends[speck.side], 1.0);
            UnplacedTransient {
                side: speck.side,
                edges: LayeredEdges::of(&outlines),
                outlines,
            }
        };
        Self {
            steps,
            born: Vec::new(),
            unplaced: specks.iter().rev().map(unplaced).collect(),
            outlines,
            edges,
            grid: grid(bounds, specks.len()),
            bounds,
            tested_pairs: AtomicU64::new(0),
        }
    }

    /// Returns the work done so far: the number of pairs of a vertex of a candidate outline and an
    /// outline around it, over all sample times and parts. It does not depend on the number of
    /// threads: [`Self::cheapest`] lowers its bound only between chunks of fixed size, and the
    /// number is read only between parts.
    pub(super) fn tested_pairs(&self) -> u64 {
        self.tested_pairs.load(Ordering::Relaxed)
    }

    /// Places the next part, which has the index `k` in the schedule. If `is_searched` is false,
    /// the part gets its own position and does not swell.
    pub(super) fn place(
        &mut self,
        speck: &'a TransientPart,
        (timetable, k): (&mut TransientSchedule, usize),
        film: &Arap,
        is_searched: bool,
    ) {
        self.unplaced.pop();
        let birth = self.best(speck, (timetable, k), film, is_searched);
        timetable.set(k, birth.life);
        if birth.swells {
            timetable.set_growth(k, speck.swelling(film.mesh().diameter()));
        }
        let times = self.steps.times().iter();
        let outlines: Vec<Vec<LayeredOutline>> =
            times.map(|&t| birth.at(speck, film, t, 0.0)).collect();
        for (edges, outlines) in self.edges.iter_mut().zip(&outlines) {
            outlines.iter().for_each(|outline| edges.add(outline));
        }
        self.born.push(SceneTransient {
            speck,
            birth,
            outlines,
        });
    }

    /// Returns the parts that are placed, with their placements.
    pub(super) fn births(&self) -> impl Iterator<Item = (&TransientPart, &TransientPlacement)> {
        self.born.iter().map(|born| (born.speck, &born.birth))
    }

    /// Returns the placement of a part with the lowest cost: the cost of its time window in the
    /// schedule plus the costs of distance and collisions.
    fn best(
        &self,
        speck: &TransientPart,
        (timetable, k): (&TransientSchedule, usize),
        film: &Arap,
        is_searched: bool,
    ) -> TransientPlacement {
        let mut best = (
            f64::INFINITY,
            TransientPlacement {
                place: speck.ends[speck.side.other()],
                life: TimeWindow::whole(speck.side),
                swells: false,
            },
        );
        let diameter = film.mesh().diameter();
        let extra = |birth: &TransientPlacement| match birth.swells {
            true => timetable.extra(k, birth.life, speck.swelling(diameter)),
            false => 0.0,
        };
        let ranked = timetable.ranked(k);
        // Appearing or disappearing at once is the last resort, so it costs more than all other
        // time windows.
        let most = ranked.last().map_or(0.0, |(cost, _)| *cost);
        let at_once = (most + AT_ONCE, speck.at_once());
        for (unrest, life) in ranked.into_iter().chain([at_once]) {
            if unrest >= best.0 {
                break; // the next one costs more
            }
            let births = self.births_in(speck, film, life, is_searched);
            let cost = |birth: &TransientPlacement| unrest + extra(birth);
            if let Some(cheaper) = self.cheapest((speck, births), film, cost, best.0) {
                best = cheaper;
            }
        }
        best.1
    }

    /// Returns the collision cost of each time window in [`eighths`] for a part: the lowest sum of
    /// the costs of distance and collisions that any position gives, at most [`DEAR`].
    pub(super) fn prices(&self, speck: &TransientPart, film: &Arap) -> Vec<f64> {
        let price = |life: TimeWindow| {
            let mut births = self.births_in(speck, film, life, true);
            // Whether growing in thickness (swelling) pays off depends on the other parts, so it is
            // not considered here.
            births.retain(|(_, birth)| !birth.swells);
            let cheapest = self.cheapest((speck, births), film, |_| 0.0, DEAR);
            cheapest.map_or(DEAR, |(cost, _)| cost)
        };
        let lives: Vec<TimeWindow> = eighths(speck.side).collect();
        lives.into_par_iter().map(price).collect()
    }

    /// Returns the placement with the lowest cost, and the cost; `None` if all cost at least
    /// `most`. Each placement in `births` comes with its distance from the part's own position;
    /// `more` returns a further cost of a placement.
    fn cheapest(
        &self,
        (speck, mut births): (&TransientPart, Vec<(f64, TransientPlacement)>),
        film: &Arap,
        more: impl Fn(&TransientPlacement) -> f64 + Sync,
        most: f64,
    ) -> Option<(f64, TransientPlacement)> {
        let mut best = (most, None);
        // The nearest placements are examined first: they have the lowest cost, so costlier ones
        // are abandoned early. Swelling is last, because it takes longest to examine.
        births.sort_by(|(a, p), (b, q)| p.swells.cmp(&q.swells).then(a.total_cmp(b)));
        // Most parts can stay at their own position, so that position is examined alone.
        let (own, others) = births.split_at(1);
        for some in std::iter::once(own).chain(others.chunks(ABREAST)) {
            let cost = |(distance, birth): &(f64, TransientPlacement)| {
                let far = DISTANCE * distance / self.bounds.diameter();
                // The further cost of a part that grows in thickness takes long to compute, so it
                // is computed only if the cost of distance alone is not too high.
                let known = (far < best.0).then(|| far + more(birth))?;
                let most = (best.0 - known) / MEETING;
                (known < best.0).then(|| known + MEETING * self.meetings(speck, birth, film, most))
            };
            let costs: Vec<Option<f64>> = match some {
                // A single placement is examined on this thread, because starting others would take
                // longer.
                [one] => vec![cost(one)],
                _ => some.par_iter().map(cost).collect(),
            };
            for (cost, (_, birth)) in costs.into_iter().zip(some) {
                if let Some(cost) = cost.filter(|&cost| cost < best.0) {
                    best = (cost, Some(*birth));
                }
            }
        }
        let (cost, birth) = best;
        birth.map(|birth| (cost, birth))
    }

    /// Returns the candidate placements for a time window, each with its distance from the part's
    /// own position. The own position comes first. Other positions, some of them along the part's
    /// own outline, and growth in thickness are included only if `is_searched`.
    fn births_in(
        &self,
        speck: &TransientPart,
        film: &Arap,
        life: TimeWindow,
        is_searched: bool,
    ) -> Vec<(f64, TransientPlacement)> {
        let own = self.carried(speck, life, film);
        let nearby = speck.own_places(own).into_iter();
        let others = nearby.chain(self.grid.iter().copied());
        let others = others.filter(|_| is_searched);
        // The part is scaled about the candidate point. Parts that grow from the same point then
        // behave like one scaled picture and do not collide while they are small.
        let end = film.uncarried_ends(speck.ends[speck.side], [0.0, 1.0][speck.side]);
        let others = others.map(|place| place.lerp(end[speck.side.other()], speck.least));
        let growing = std::iter::once(own).chain(others);
        let grows = |place: DVec2| {
            let birth = TransientPlacement {
                place,
                life,
                swells: false,
            };
            (place.distance(own), birth)
        };
        // A part that grows in thickness either moves with the outlines around it, or starts
        // exactly where it is drawn in its design.
        let drawn = film.uncarried_ends(speck.ends[speck.side], begins(speck, life));
        let swells = |place: DVec2| {
            let birth = TransientPlacement {
                place: place + speck.off_middle(),
                life,
                swells: true,
            };
            (place.distance(own), birth)
        };
        let swelling = [own, drawn[speck.side.other()]].into_iter().map(swells);
        let swelling = swelling.filter(|_| is_searched);
        growing.map(grows).chain(swelling).collect()
    }

    /// Returns the total length of t during which the part collides. Counting stops once it exceeds
    /// `most`.
    fn meetings(
        &self,
        speck: &TransientPart,
        birth: &TransientPlacement,
        film: &Arap,
        most: f64,
    ) -> f64 {
        let mut long = 0.0;
        // Every second sample time is examined first. Most collisions last long, so the count soon
        // exceeds `most`.
        let last = self.steps.last();
        let steps = (0..=last).step_by(2).chain((1..=last).step_by(2));
        for step in steps {
            // The loop starts at the design that has the part, because the part is largest and
            // collides most near this design. In the design itself (step 0), the part cannot
            // collide.
            if long > most || step == 0 {
                continue;
            }
            let step = [step, last - step][speck.side];
            let t = self.steps.times()[step];
            let rings = birth.at(speck, film, t, MARGIN);
            let vertices: usize = rings.iter().map(|ring| ring.points.len()).sum();
            let pairs = vertices * (self.outlines[step].len() + self.born.len());
            self.tested_pairs.fetch_add(pairs as u64, Ordering::Relaxed);
            let side = speck.side;
            if !(self.crosses_none(step, side, &rings) && self.is_apart(step, side, &rings)) {
                long += self.steps.weight(step);
            }
        }
        long
    }

    /// Returns the outlines, except holes, that a part of design `side` must avoid at a sample
    /// time.
    fn there(&self, step: usize, side: Side) -> impl Iterator<Item = &LayeredOutline> {
        let born = self.born.iter().flat_map(move |born| &born.outlines[step]);
        let placed = self.outlines[step].iter().chain(born);
        let unplaced = self.unplaced_near(step, side);
        placed.chain(unplaced.flat_map(|part| &part.outlines))
    }

    /// Returns the parts of the other design that are not placed yet, if the sample time is near
    /// the t of that design; their positions are known only there.
    fn unplaced_near(&self, step: usize, side: Side) -> impl Iterator<Item = &UnplacedTransient> {
        let t = self.steps.times()[step];
        let is_near = [1.0 - t, t][side] <= FINE_STEP;
        let unplaced = self.unplaced.iter();
        unplaced.filter(move |part| is_near && part.side != side)
    }

    fn crosses_none(&self, step: usize, side: Side, rings: &[LayeredOutline]) -> bool {
        let crosses = |ring: &LayeredOutline| {
            let mut unplaced = self.unplaced_near(step, side);
            self.edges[step].are_crossed_by(ring)
                || unplaced.any(|part| part.edges.are_crossed_by(ring))
        };
        !rings.iter().any(crosses)
    }

    /// Returns whether the part lies neither inside another part or a hole nor around another part.
    fn is_apart(&self, step: usize, side: Side, rings: &[LayeredOutline]) -> bool {
        let Some(outer) = rings.first() else {
            return true;
        };
        let place = outer.points[0];
        let unplaced = self.unplaced_near(step, side);
        let around_it: i32 = std::iter::once(&self.edges[step])
            .chain(unplaced.map(|part| &part.edges))
            .map(|edges| edges.winding(outer.layer, place))
            .sum();
        let around = |p: DVec2| rings.iter().map(|o| o.winding(p)).sum::<i32>();
        let mut others = self.there(step, side);
        around_it == 0
            && !others.any(|other| other.layer == outer.layer && around(other.points[0]) != 0)
    }

    /// Returns the part's own position as a seed shape, to which the innermost outline around the
    /// part carries it. If no outline lies around the part, the outlines nearby carry it.
    fn carried(&self, speck: &TransientPart, life: TimeWindow, film: &Arap) -> DVec2 {
        let (side, here) = (speck.side, speck.ends[speck.side]);
        let begins = begins(speck, life);
        // Outlines of matched parts with the same index in `now` and `then` correspond to each
        // other. Parts that are already placed follow their own motion, so they are treated
        // separately.
        let then = &self.outlines[self.steps.before(begins)];
        let now = &self.outlines[[0, self.steps.last()][side]];
        let born = self.born.iter().filter(|born| born.speck.side == side);
        let born = born.filter_map(|born| {
            let size = born.speck.size_around(here)?;
            Some((size, born.birth.takes(born.speck, film, here, begins)))
        });
        let around = born.chain(carried_within(here, now, then));
        let innermost = around.min_by(|a, b| a.0.total_cmp(&b.0));
        let place = innermost.map_or_else(|| carried_among(here, now, then), |(_, place)| place);
        film.uncarried_ends(place, begins)[side.other()]
    }
}

/// Returns the time at which a part starts to grow from its seed shape, or ends shrinking to it.
fn begins(speck: &TransientPart, life: TimeWindow) -> f64 {
    [life.to, life.from][speck.side]
}

/// Returns a grid of candidate positions in `bounds`. The more `parts` there are, the coarser it
/// is.
fn grid(bounds: Bounds, parts: usize) -> Vec<DVec2> {
    let most = (PLACES_OF_ALL / parts.max(1) as f64).sqrt();
    let places = PLACES.min(most as u32);
    let at = |k: u32| (f64::from(k) + 0.5) / f64::from(places);
    let place = |i: u32, j: u32| bounds.min + bounds.size() * DVec2::new(at(i), at(j));
    (0..places)
        .flat_map(|i| (0..places).map(move |j| (i, j)))
        .map(|(i, j)| place(i, j))
        .collect()
}

//! What is there on the way, and where in it a part can grow.
//!
//! Of the places that are as free the one is taken that is nearest to a
//! part's own place in the whole, and of the times the one that suits the
//! [`TransientSchedule`] best.

use super::anchor::{carried_among, carried_within};
use super::seed_shape::TransientPart;
use crate::geometry::{Bounds, DVec2, Side};
use crate::transition::transients::boundary_loops::SharedPartLoops;
use crate::transition::transients::holes::PieceHole;
use crate::transition::transients::layered_outline::LayeredOutline;
use crate::transition::transients::layers::PieceLayers;
use crate::transition::transients::sample_times::{FINE_STEP, SampleTimes};
use crate::transition::transients::schedule::{TransientSchedule, eighths};
use crate::warp::{Arap, Placer, TimeWindow, Warp};
use rayon::prelude::*;

/// A growing part keeps this share of its size free around itself, less the
/// nearer it is to the size that was drawn.
/// Enough that it is seen to keep clear; no pair fixed it.
const MARGIN: f64 = 0.05;

/// Positions searched along each side of the bounding box (heuristic).
const PLACES: u32 = 10;
/// Positions searched for all parts together (resource limit: a hundred nested rings, none of
/// which finds a free position, took minutes).
const PLACES_OF_ALL: f64 = 2400.0;

/// Births that are looked at beside each other. More would be looked at without
/// knowing how good the best of them is.
const ABREAST: usize = 8;

/// What it costs to meet another part all the time (5 for an even step), the distance from
/// its own place, in diameters, and to come at once, against the unrest of the film. Were
/// distance four times as dear, the worst tenth of the area of 60 pairs of icons would be 0.24
/// instead of 0.20.
const MEETING: f64 = 320.0;
const DISTANCE: f64 = 0.25;
const AT_ONCE: f64 = 0.5;

/// What it costs at most in the plan that a time is not free.
const DEAR: f64 = 1.0;

/// Where, when and how a part is born or dies.
#[derive(Clone, Copy)]
pub(super) struct TransientPlacement {
    /// Where its centroid is where it is a speck.
    pub(super) place: DVec2,
    pub(super) life: TimeWindow,
    /// In thickness instead of in size.
    pub(super) swells: bool,
}

impl TransientPlacement {
    /// The part at `t`, larger by a share of its size the smaller it is.
    fn at(&self, speck: &TransientPart, film: &Arap, t: f64, margin: f64) -> Vec<LayeredOutline> {
        let share = self.life.fraction_done(t);
        // A speck is not drawn.
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
    /// Where at `t` a place is that lies in the part where it is drawn.
    fn takes(&self, speck: &TransientPart, film: &Arap, here: DVec2, t: f64) -> DVec2 {
        let share = self.life.fraction_done(t);
        let centre = film.carried_position(speck.ends_at(self.place), share, t);
        let from_centre = here - speck.ends[speck.side];
        match self.swells {
            // It goes with its middle.
            true => centre + speck.off_middle_at(share) + from_centre,
            false => centre + from_centre * speck.size(share),
        }
    }
}

/// What has got its place.
struct SceneTransient<'a> {
    speck: &'a TransientPart,
    birth: TransientPlacement,
    /// At each step.
    outlines: Vec<Vec<LayeredOutline>>,
}

/// What is there at each step, both ends included.
pub(super) struct TransientScene<'a> {
    steps: &'a SampleTimes,
    /// Of what both designs have.
    outlines: Vec<Vec<LayeredOutline>>,
    /// Of holes that come and go: as many as there are at each step.
    holes: Vec<Vec<LayeredOutline>>,
    /// What has got its place.
    born: Vec<SceneTransient<'a>>,
    /// What has none yet, as it was drawn, the next one last.
    unplaced: Vec<(Side, Vec<LayeredOutline>)>,
    bounds: Bounds,
    /// Candidate positions.
    grid: Vec<DVec2>,
}

impl<'a> TransientScene<'a> {
    /// Of the pieces that both designs have, for parts that get their places in this order.
    pub(super) fn of(
        film: &Arap,
        (holes, specks): (&[PieceHole], &[TransientPart]),
        (levels, steps): (&PieceLayers, &'a SampleTimes),
    ) -> Self {
        let walks = SharedPartLoops::of(film);
        let at = |placer: &mut Placer, &t: &f64| -> (Vec<LayeredOutline>, Vec<LayeredOutline>) {
            placer.place(t);
            let places = &placer.placement().in_frame;
            let there = holes.iter().filter_map(|(piece, hole)| {
                let ring = hole.ring_at(places, t)?;
                Some(LayeredOutline::of(ring, levels.of_piece(*piece)))
            });
            (walks.outlines(places, levels), there.collect())
        };
        let all = steps.times().par_iter().map_init(|| film.placer(), at);
        let (outlines, holes): (Vec<Vec<LayeredOutline>>, _) = all.unzip();
        let bounds = film.mesh().bounds();
        let drawn = |speck: &TransientPart| (speck.side, speck.at(speck.ends[speck.side], 1.0));
        Self {
            steps,
            born: Vec::new(),
            unplaced: specks.iter().rev().map(drawn).collect(),
            outlines,
            holes,
            grid: grid(bounds, specks.len()),
            bounds,
        }
    }

    /// Gives the next one, which has this number in the timetable, its best birth; its place
    /// is searched for only where that is asked for.
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
        let outlines = times.map(|&t| birth.at(speck, film, t, 0.0)).collect();
        self.born.push(SceneTransient {
            speck,
            birth,
            outlines,
        });
    }

    /// Where, when and how all were born that have got their places.
    pub(super) fn births(&self) -> impl Iterator<Item = (&TransientPart, &TransientPlacement)> {
        self.born.iter().map(|born| (born.speck, &born.birth))
    }

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
        // What comes at once is for want of better.
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

    /// What each of the times costs a part that are chosen from: how far from its own place it
    /// is to be, and for how long it meets something even so.
    pub(super) fn prices(&self, speck: &TransientPart, film: &Arap) -> Vec<f64> {
        let price = |life: TimeWindow| {
            let mut births = self.births_in(speck, film, life, true);
            // What that does to the film depends on the others.
            births.retain(|(_, birth)| !birth.swells);
            let cheapest = self.cheapest((speck, births), film, |_| 0.0, DEAR);
            cheapest.map_or(DEAR, |(cost, _)| cost)
        };
        let lives: Vec<TimeWindow> = eighths(speck.side).collect();
        lives.into_par_iter().map(price).collect()
    }

    /// The one of some births, of which it is known how far each is from the part's own place,
    /// that costs least, if that is less than `most`. Each costs something more by itself.
    fn cheapest(
        &self,
        (speck, mut births): (&TransientPart, Vec<(f64, TransientPlacement)>),
        film: &Arap,
        more: impl Fn(&TransientPlacement) -> f64 + Sync,
        most: f64,
    ) -> Option<(f64, TransientPlacement)> {
        let mut best = (most, None);
        // The nearest first: they cost least, and what costs more than they do need
        // not be looked at to its end. What swells last: it takes longest to look at.
        births.sort_by(|(a, p), (b, q)| p.swells.cmp(&q.swells).then(a.total_cmp(b)));
        // Most need no other place than their own.
        let (own, others) = births.split_at(1);
        for some in std::iter::once(own).chain(others.chunks(ABREAST)) {
            let cost = |(distance, birth): &(f64, TransientPlacement)| {
                let far = DISTANCE * distance / self.bounds.diameter();
                // How a part swells takes long to find out.
                let known = (far < best.0).then(|| far + more(birth))?;
                let most = (best.0 - known) / MEETING;
                (known < best.0).then(|| known + MEETING * self.meetings(speck, birth, film, most))
            };
            let costs: Vec<Option<f64>> = match some {
                // To share that out would take longer.
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

    /// The births of a time, with how far each is from the part's own place; where they are
    /// searched also those at other places and along the part's own outline, and those that
    /// swell.
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
        // What begins at one place grows out of it as one picture would: nothing of it
        // meets, however small it is.
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
        // In the place that it will have, or along with what is around it.
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

    /// The share of the film in which it meets something, counted on to `most`.
    fn meetings(
        &self,
        speck: &TransientPart,
        birth: &TransientPlacement,
        film: &Arap,
        most: f64,
    ) -> f64 {
        let mut long = 0.0;
        // Every other first: most that meet anything do so for long.
        let last = self.steps.last();
        let steps = (0..=last).step_by(2).chain((1..=last).step_by(2));
        for step in steps {
            // At its own end it is as it was drawn; near that it is large and meets most.
            if long > most || step == 0 {
                continue;
            }
            let step = [step, last - step][speck.side];
            let t = self.steps.times()[step];
            let rings = birth.at(speck, film, t, MARGIN);
            let side = speck.side;
            if !(self.crosses_none(step, side, &rings) && self.is_apart(step, side, &rings)) {
                long += self.steps.weight(step);
            }
        }
        long
    }

    /// What is there at a step, but for holes, for what one design has alone. What the
    /// other has alone and has no place yet is there at its own end, whatever place it
    /// gets: of some 80 parts of an icon one grew out of another that had just begun to go.
    fn there(&self, step: usize, side: Side) -> impl Iterator<Item = &LayeredOutline> {
        let t = self.steps.times()[step];
        let is_near = [1.0 - t, t][side] <= FINE_STEP;
        let unplaced = self.unplaced.iter();
        let unplaced = unplaced.filter(move |(of, _)| is_near && *of != side);
        let unplaced = unplaced.flat_map(|(_, rings)| rings);
        let born = self.born.iter().flat_map(move |born| &born.outlines[step]);
        self.outlines[step].iter().chain(born).chain(unplaced)
    }

    fn crosses_none(&self, step: usize, side: Side, rings: &[LayeredOutline]) -> bool {
        let others = || self.there(step, side).chain(&self.holes[step]);
        let crosses = |ring: &LayeredOutline| others().any(|other| ring.crosses(other));
        !rings.iter().any(crosses)
    }

    /// Whether it neither lies in another part nor over one.
    fn is_apart(&self, step: usize, side: Side, rings: &[LayeredOutline]) -> bool {
        let Some(outer) = rings.first() else {
            return true;
        };
        let is_beside = |other: &&LayeredOutline| other.layer == outer.layer;
        let place = outer.points[0];
        let others = self
            .there(step, side)
            .chain(&self.holes[step])
            .filter(is_beside);
        let is_within = others.map(|o| o.winding(place)).sum::<i32>() != 0;
        let around = |p: DVec2| rings.iter().map(|o| o.winding(p)).sum::<i32>();
        let mut others = self.there(step, side).filter(is_beside);
        !is_within && !others.any(|other| around(other.points[0]) != 0)
    }

    /// Its own place when it is a speck: where what it lies in is then, or
    /// what lies around it.
    fn carried(&self, speck: &TransientPart, life: TimeWindow, film: &Arap) -> DVec2 {
        let (side, here) = (speck.side, speck.ends[speck.side]);
        let begins = begins(speck, life);
        // Of what both designs have, which is there in the same order at each step.
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

/// When a part is a speck that grows, or was one.
fn begins(speck: &TransientPart, life: TimeWindow) -> f64 {
    [life.to, life.from][speck.side]
}

/// Grid of candidate positions in `bounds` for each of `parts` parts.
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

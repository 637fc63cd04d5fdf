//! What is there on the way, and where in it a part can grow.
//!
//! Of the places that are as free the one is taken that is nearest to a
//! part's own place in the whole, and of the times the longest.

use super::carried::carried_among;
use super::speck::Speck;
use crate::geometry::{Bounds, DVec2};
use crate::transition::conflicts::STEPS;
use crate::transition::holes::HoleOf;
use crate::transition::outline::Outline;
use crate::transition::walks::Walks;
use crate::warp::{Arap, Life, Warp};

/// A growing part keeps this share of its size free around itself, less the
/// nearer it is to the size that was drawn.
/// Enough that it is seen to keep clear; no pair fixed it.
const MARGIN: f64 = 0.05;

/// Places along either side of the box that are searched.
const PLACES: u32 = 7;

/// What a step at which a part meets another costs, and the distance from its
/// own place, in diameters, against the share of the film that it waits.
const MEETING: f64 = 10.0;
const DISTANCE: f64 = 2.0;

/// What is there at each step, both ends included.
pub(super) struct Scene {
    steps: Vec<Vec<Outline>>,
    /// Of holes that come and go: as many as there are at each step.
    holes: Vec<Vec<Outline>>,
    bounds: Bounds,
}

impl Scene {
    /// Of the pieces that both designs have.
    pub(super) fn of(film: &Arap, holes: &[HoleOf]) -> Self {
        let walks = Walks::of(film);
        let mut placer = film.placer();
        let steps = (0..=STEPS).map(|step| {
            placer.place(time(step));
            let places = &placer.placement().in_frame;
            let rings = walks.rings(places).into_iter().map(Outline::of).collect();
            let there = holes
                .iter()
                .filter_map(|(_, hole)| hole.at(places, time(step)));
            (rings, there.map(Outline::of).collect())
        });
        let (steps, holes) = steps.unzip();
        Self {
            steps,
            holes,
            bounds: film.mesh().bounds(),
        }
    }

    /// The best place and time, searched for only where it is asked to.
    pub(super) fn best(&self, speck: &Speck, film: &Arap, is_searched: bool) -> (DVec2, Life) {
        let mut best = (f64::INFINITY, (speck.ends[speck.side.other()], Life::WHOLE));
        let places = if is_searched { self.grid() } else { Vec::new() };
        for life in speck.times() {
            let waits = 1.0 - (life.to - life.from);
            if waits >= best.0 {
                break; // a shorter time costs more
            }
            let own = self.carried(speck, life, film);
            let nearby = if is_searched {
                speck.own_places(own)
            } else {
                Vec::new()
            };
            for place in std::iter::once(own)
                .chain(nearby)
                .chain(places.iter().copied())
            {
                let known = waits + DISTANCE * place.distance(own) / self.bounds.diameter();
                if known >= best.0 {
                    continue;
                }
                let most = (best.0 - known) / MEETING;
                let cost = known + MEETING * self.meetings(speck, place, life, film, most);
                if cost < best.0 {
                    best = (cost, (place, life));
                }
            }
        }
        best.1
    }

    fn grid(&self) -> Vec<DVec2> {
        let at = |k: u32| (f64::from(k) + 0.5) / f64::from(PLACES);
        let place =
            |i: u32, j: u32| self.bounds.min + self.bounds.size() * DVec2::new(at(i), at(j));
        (0..PLACES)
            .flat_map(|i| (0..PLACES).map(move |j| (i, j)))
            .map(|(i, j)| place(i, j))
            .collect()
    }

    /// The number of steps at which it meets something, counted on to `most`.
    fn meetings(&self, speck: &Speck, place: DVec2, life: Life, film: &Arap, most: f64) -> f64 {
        let mut count = 0.0;
        for step in 0..=STEPS {
            let share = life.share(time(step));
            let is_speck = share == [1.0, 0.0][speck.side];
            let is_whole = share == [0.0, 1.0][speck.side];
            // Where it is whole it is as it was drawn.
            if count > most || is_whole {
                continue;
            }
            let centre = film.carried(speck.ends_at(place), share, time(step));
            let size = speck.size(share);
            let rings = speck.at(centre, size * (1.0 + MARGIN * (1.0 - size)));
            // Nobody sees a pixel that lies in another part.
            let is_free =
                self.crosses_none(step, &rings) && (is_speck || self.is_apart(step, &rings));
            if !is_free {
                count += 1.0;
            }
        }
        count
    }

    fn crosses_none(&self, step: u32, rings: &[Outline]) -> bool {
        let others = || {
            let [rings, holes] = [&self.steps, &self.holes].map(|all| &all[step as usize]);
            rings.iter().chain(holes)
        };
        let crosses = |ring: &Outline| others().any(|other| ring.crosses(other));
        !rings.iter().any(crosses)
    }

    /// Whether it neither lies in another part nor over one.
    fn is_apart(&self, step: u32, rings: &[Outline]) -> bool {
        let others = &self.steps[step as usize];
        let around = |p: DVec2, all: &[Outline]| all.iter().map(|o| o.winding(p)).sum::<i32>();
        let holes = &self.holes[step as usize];
        let is_within = rings.first().is_some_and(|outer| {
            let place = outer.points[0];
            around(place, others) + around(place, holes) != 0
        });
        !is_within
            && !others
                .iter()
                .any(|other| around(other.points[0], rings) != 0)
    }

    /// Adds a speck that has got its place.
    pub(super) fn add(&mut self, speck: &Speck, place: DVec2, life: Life, film: &Arap) {
        for step in 0..=STEPS {
            let t = time(step);
            let share = life.share(t);
            let centre = film.carried(speck.ends_at(place), share, t);
            let size = speck.size(share);
            self.steps[step as usize].extend(speck.at(centre, size));
        }
    }

    /// Its own place when it is a speck: where what it lies in is then, or
    /// what lies around it.
    fn carried(&self, speck: &Speck, life: Life, film: &Arap) -> DVec2 {
        let (side, here) = (speck.side, speck.ends[speck.side]);
        let begins = [life.to, life.from][side];
        let then = &self.steps[(f64::from(STEPS) * begins) as usize];
        let now = &self.steps[[0, STEPS as usize][side]];
        let place = carried_among(here, now, then);
        film.carried_back(place, begins)[side.other()]
    }
}

fn time(step: u32) -> f64 {
    f64::from(step) / f64::from(STEPS)
}

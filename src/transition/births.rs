//! Where and when the parts that one design has alone are born and die.
//!
//! Such a part is a speck in the other design, at a place that nobody drew,
//! and is free to change its size within a time of its own. Both are chosen so
//! that it meets nothing as it grows: the largest part first, against the
//! film of the parts that both designs have and of those placed before it. Of
//! the places that are as free the one is taken that is nearest to its own
//! place in the whole, and of the times the longest.
//!
//! Guaranteed: exchanging the designs gives the same places, and the times
//! reversed, unless two parts are equal in size. Not guaranteed: that there is a free place; nor
//! anything between the steps that are looked at.

use super::conflicts::{STEPS, Walks, is_in_both};
use crate::compatible::CompatibleMesh;
use crate::correspondence::{PieceMatch, RegionMatch};
use crate::geometry::{Bounds, DVec2, Side, ring_edges, segments_cross, signed_area, winding};
use crate::progress::{Cancelled, Progress, still_wanted};
use crate::warp::{Arap, Life, Warp};

/// A part changes its size within so many eighths of the film at least.
/// Shorter would be a jump.
const SHORTEST: u32 = 1;
const EIGHTHS: u32 = 8;

/// A growing part keeps this share of its size free around itself, less the
/// nearer it is to the size that was drawn.
/// Enough that it is seen to keep clear; no pair fixed it.
const MARGIN: f64 = 0.05;

/// Places along either side of the box, and along its own outline, that are
/// searched.
const PLACES: u32 = 7;
const OWN_PLACES: usize = 12;

/// Parts beyond so many are not searched a place for; each costs a
/// look at all others at every step.
const SEARCHED: usize = 24;

/// What a step at which a part meets another costs, and the distance from its
/// own place, in diameters, against the share of the film that it waits.
const MEETING: f64 = 10.0;
const DISTANCE: f64 = 2.0;

/// When each piece changes its size, before anything is chosen: a part of one
/// design alone all the time.
pub(super) fn lives(matched: &RegionMatch) -> Vec<Option<Life>> {
    let life = |piece: &PieceMatch| (!is_in_both(piece)).then_some(Life::WHOLE);
    matched.pieces.iter().map(life).collect()
}

/// A match and its mesh with all that is born or dies in its place.
pub(super) struct Placed {
    pub matched: RegionMatch,
    pub mesh: CompatibleMesh,
    /// When each piece changes its size, if it is born or dies.
    pub lives: Vec<Option<Life>>,
}

/// The match and its mesh with all parts that are born or die in their places
/// and times; `None` where there are none.
pub(super) fn placed(
    matched: &RegionMatch,
    mesh: &CompatibleMesh,
    film: &Arap,
    progress: &dyn Progress,
) -> Result<Option<Placed>, Cancelled> {
    let mut lives = lives(matched);
    if lives.iter().all(Option::is_none) {
        return Ok(None);
    }
    let mut scene = Scene::of(film);
    let mut by = vec![[DVec2::ZERO; 2]; matched.pieces.len()];
    for (rank, speck) in Speck::all(matched).into_iter().enumerate() {
        still_wanted(progress)?;
        let (place, life) = scene.best(&speck, film, rank < SEARCHED);
        by[speck.piece][speck.side.other()] = place - speck.ends[speck.side.other()];
        lives[speck.piece] = Some(life);
        scene.add(&speck, place, life, film);
    }
    let Some(mesh) = mesh.with_parts_moved(&by) else {
        return Ok(None);
    };
    let mut matched = matched.clone();
    for (piece, by) in matched.pieces.iter_mut().zip(&by) {
        for ring in &mut piece.rings {
            ring.source.iter_mut().for_each(|p| *p += by[0]);
            ring.target.iter_mut().for_each(|p| *p += by[1]);
        }
    }
    Ok(Some(Placed {
        matched,
        mesh,
        lives,
    }))
}

/// A part of one design alone.
struct Speck {
    piece: usize,
    /// The design that has it.
    side: Side,
    area: f64,
    /// Its centroids in source and target.
    ends: [DVec2; 2],
    /// Its rings about its centroid, as large as they are.
    rings: Vec<Vec<DVec2>>,
    /// Its size across as a share of its own.
    least: f64,
}

impl Speck {
    /// All of a match, the largest first.
    fn all(matched: &RegionMatch) -> Vec<Self> {
        let pieces = matched.pieces.iter().enumerate();
        let mut all: Vec<Self> = pieces
            .filter(|(_, piece)| !is_in_both(piece))
            .map(|(k, piece)| Self::of(k, piece))
            .collect();
        let key = |s: &Self| [s.ends[s.side].x, s.ends[s.side].y];
        all.sort_by(|a, b| {
            let order = b.area.total_cmp(&a.area);
            // The order of the pieces is another in the film run backwards.
            let [p, q] = [key(a), key(b)];
            order
                .then(p[0].total_cmp(&q[0]))
                .then(p[1].total_cmp(&q[1]))
        });
        all
    }

    fn of(piece: usize, matched: &PieceMatch) -> Self {
        let side = match matched.source_part {
            Some(_) => Side::Source,
            None => Side::Target,
        };
        let rings = |side: Side| {
            matched
                .rings
                .iter()
                .map(move |r| [&r.source, &r.target][side])
        };
        let ends = Side::BOTH.map(|side| centroid(rings(side)));
        let area = |side: Side| rings(side).map(|r| signed_area(r)).sum::<f64>();
        let whole = area(side);
        let about = |ring: &Vec<DVec2>| ring.iter().map(|&p| p - ends[side]).collect();
        Self {
            rings: rings(side).map(about).collect(),
            least: (area(side.other()) / whole).abs().sqrt(),
            area: whole,
            piece,
            side,
            ends,
        }
    }

    /// How large it is where so much of its change is done.
    fn size(&self, share: f64) -> f64 {
        let grown = match self.side {
            Side::Source => 1.0 - share,
            Side::Target => share,
        };
        self.least * (1.0 - grown) + grown
    }

    fn ends_at(&self, place: DVec2) -> [DVec2; 2] {
        match self.side {
            Side::Source => [self.ends[0], place],
            Side::Target => [place, self.ends[1]],
        }
    }

    /// Places along its own outline, were it at `place`: from a tip a crescent
    /// grows around what lies in it.
    fn own_places(&self, place: DVec2) -> Vec<DVec2> {
        let outer = self.rings.first().map_or(&[][..], Vec::as_slice);
        let step = outer.len().div_ceil(OWN_PLACES).max(1);
        outer.iter().step_by(step).map(|&p| place + p).collect()
    }

    fn at(&self, centre: DVec2, size: f64) -> Vec<Outline> {
        let placed = |ring: &Vec<DVec2>| ring.iter().map(|&p| centre + p * size).collect();
        self.rings.iter().map(placed).map(Outline::of).collect()
    }

    /// The times in which it may change its size, the longest first.
    fn times(&self) -> impl Iterator<Item = Life> {
        let side = self.side;
        (SHORTEST..=EIGHTHS).rev().map(move |eighths| {
            let long = f64::from(eighths) / f64::from(EIGHTHS);
            match side {
                Side::Source => Life {
                    from: 0.0,
                    to: long,
                },
                Side::Target => Life {
                    from: 1.0 - long,
                    to: 1.0,
                },
            }
        })
    }
}

/// The centroid of what some rings enclose together.
fn centroid<'a>(rings: impl Iterator<Item = &'a Vec<DVec2>>) -> DVec2 {
    let (mut sum, mut total, mut base) = (DVec2::ZERO, 0.0, None);
    for ring in rings {
        // About a point of its own: far from the origin sums lose their digits.
        let base = *base.get_or_insert(ring[0]);
        for (a, b) in ring_edges(ring) {
            let (a, b) = (a - base, b - base);
            let twice = a.perp_dot(b);
            sum += twice * (a + b) / 3.0;
            total += twice;
        }
    }
    base.unwrap_or_default() + sum / total
}

/// A closed walk and the box around it.
struct Outline {
    points: Vec<DVec2>,
    bounds: Bounds,
}

impl Outline {
    fn of(points: Vec<DVec2>) -> Self {
        let bounds = Bounds::of(points.iter().copied()).unwrap_or_else(|| Bounds::at(DVec2::ZERO));
        Self { points, bounds }
    }

    fn crosses(&self, other: &Self) -> bool {
        if !overlap(&self.bounds, &other.bounds) {
            return false;
        }
        ring_edges(&self.points).any(|(a, b)| {
            let edge = Bounds {
                min: a.min(b),
                max: a.max(b),
            };
            overlap(&edge, &other.bounds)
                && ring_edges(&other.points).any(|(p, q)| segments_cross([a, b], [p, q]))
        })
    }

    fn winding(&self, p: DVec2) -> i32 {
        if self.bounds.contains(p) {
            winding(&self.points, p)
        } else {
            0
        }
    }
}

fn overlap(a: &Bounds, b: &Bounds) -> bool {
    a.min.cmple(b.max).all() && b.min.cmple(a.max).all()
}

/// What is there at each step, both ends included.
struct Scene {
    steps: Vec<Vec<Outline>>,
    bounds: Bounds,
}

impl Scene {
    /// Of the pieces that both designs have.
    fn of(film: &Arap) -> Self {
        let walks = Walks::of(film);
        let mut placer = film.placer();
        let steps = (0..=STEPS).map(|step| {
            placer.place(time(step));
            let rings = walks.rings(film, &placer.placement().in_frame);
            rings.into_iter().map(Outline::of).collect()
        });
        Self {
            steps: steps.collect(),
            bounds: film.mesh().bounds(),
        }
    }

    /// The best place and time, searched for only where it is asked to.
    fn best(&self, speck: &Speck, film: &Arap, is_searched: bool) -> (DVec2, Life) {
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
        let others = &self.steps[step as usize];
        let crosses = |ring: &Outline| others.iter().any(|other| ring.crosses(other));
        !rings.iter().any(crosses)
    }

    /// Whether it neither lies in another part nor over one.
    fn is_apart(&self, step: u32, rings: &[Outline]) -> bool {
        let others = &self.steps[step as usize];
        let around = |p: DVec2, all: &[Outline]| all.iter().map(|o| o.winding(p)).sum::<i32>();
        let is_within = rings
            .first()
            .is_some_and(|outer| around(outer.points[0], others) != 0);
        !is_within
            && !others
                .iter()
                .any(|other| around(other.points[0], rings) != 0)
    }

    /// Adds a speck that has got its place.
    fn add(&mut self, speck: &Speck, place: DVec2, life: Life, film: &Arap) {
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

/// Where outlines, as they are and as they are then, take a place.
fn carried_among(here: DVec2, now: &[Outline], then: &[Outline]) -> DVec2 {
    let both = || now.iter().zip(then);
    let around = both().filter(|(now, _)| now.winding(here) != 0);
    let size = |outline: &Outline| signed_area(&outline.points).abs();
    let innermost = around.min_by(|a, b| size(a.0).total_cmp(&size(b.0)));
    if let Some((now, then)) = innermost {
        return similar(&now.points, &then.points, here);
    }
    // Shepard 1968, near neighbours counting most.
    let (mut sum, mut total) = (DVec2::ZERO, 0.0);
    for (now, then) in both() {
        for (p, q) in now.points.iter().zip(&then.points) {
            let weight = p
                .distance_squared(here)
                .powi(2)
                .max(f64::MIN_POSITIVE)
                .recip();
            sum += weight * (*q - *p);
            total += weight;
        }
    }
    if total > 0.0 {
        here + sum / total
    } else {
        here
    }
}

/// Where the similarity that fits a ring's points best takes a point.
fn similar(from: &[DVec2], to: &[DVec2], p: DVec2) -> DVec2 {
    let mean = |ring: &[DVec2]| ring.iter().sum::<DVec2>() / ring.len() as f64;
    let (a, b) = (mean(from), mean(to));
    let (mut turn, mut size) = (DVec2::ZERO, 0.0);
    for (&p, &q) in from.iter().zip(to) {
        let (p, q) = (p - a, q - b);
        turn += DVec2::new(p.dot(q), p.perp_dot(q));
        size += p.length_squared();
    }
    b + (turn / size).rotate(p - a)
}

fn time(step: u32) -> f64 {
    f64::from(step) / f64::from(STEPS)
}

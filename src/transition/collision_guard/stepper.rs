//! Steps through a motion from t = 0 and displaces vertices that would collide.
//!
//! Each step starts from positions without collisions. If a vertex and an edge are close to each
//! other in these positions, a line is placed between them. The line rotates with the edge, and
//! after the step vertex and edge must still lie on different sides of the line. Vertices therefore
//! cannot slip through edges between two steps. Vertices that stay away from all edges are not
//! displaced.

use super::compliance::MeshCompliance;
use super::outlines::{GuardedOutlines, GuardedPair};
use super::push::{ContactConstraint, smallest};
use crate::geometry::{DVec2, twice_signed_area};
use crate::warp::{Arap, Placer, Warp};
use crate::work::progress::{Cancelled, Progress, check_cancelled};

/// Maximum number of times that the displacements at one time t are computed (resource limit). They
/// are computed again because the constraints on face areas are linearised, and because the
/// separating line of a vertex that slides around a corner rotates.
const CORRECTIONS: u32 = 6;

/// Accuracy of the displacements, as a fraction of the clearance between outlines (tolerance:
/// invisible).
const EXACT: f64 = 0.01;

/// Area below which the displacements must not shrink a face, as a fraction of the smaller of its
/// areas in the two designs (heuristic).
const FACE: f64 = 0.125;

/// Largest permitted displacement of a vertex, as a fraction of the mesh diameter. If it is
/// exceeded, [`through`] returns `None` (heuristic).
const FARTHEST: f64 = 0.25;

/// Maximum number of pairs of a vertex and an edge that are close to each other in a step, above
/// which [`through`] returns `None` (resource limit: more take longer than 0.1 s and mean that many
/// parts overlap).
const MOST_LINES: usize = 200_000;

/// Times from 0 to 1, each with the displacements of all vertices.
pub(super) type GuardDisplacements = Vec<(f64, Vec<DVec2>)>;

/// Returns the displacements of all vertices at `times`, which run from 0 to 1; `None` if
/// displacements do not suffice to avoid collisions.
///
/// # Errors
/// If the work is cancelled.
pub(super) fn through(
    film: &Arap,
    outlines: &GuardedOutlines,
    times: &[f64],
    progress: &dyn Progress,
) -> Result<Option<GuardDisplacements>, Cancelled> {
    let still = vec![DVec2::ZERO; film.mesh().source().len()];
    let Ok(yielding) = MeshCompliance::of(film) else {
        return Ok(None);
    };
    // The first and the last time show the designs, which are not displaced.
    let [first, steps @ .., last] = times else {
        return Ok(None);
    };
    let mut stepper = GuardStepper {
        film,
        placer: film.placer(),
        outlines,
        yielding,
        parts: film.mesh().components(),
    };
    let plain = stepper.plain(*first);
    let mut moments = vec![GuardMoment::of(*first, plain)];
    for &t in steps {
        check_cancelled(progress)?;
        let plain = stepper.plain(t);
        let Some(next) = moments
            .last()
            .and_then(|before| stepper.step(before, plain, t))
        else {
            return Ok(None);
        };
        moments.push(next);
    }
    let moved = moments.into_iter().map(|moment| (moment.t, moment.moved));
    Ok(Some(moved.chain([(*last, still)]).collect()))
}

/// Positions of all vertices at one time: `plain` in the original motion, and `places` after
/// displacement by `moved`. In `places`, vertices and edges that are close to each other are apart.
struct GuardMoment {
    t: f64,
    plain: Vec<DVec2>,
    moved: Vec<DVec2>,
    places: Vec<DVec2>,
}

impl GuardMoment {
    fn of(t: f64, plain: Vec<DVec2>) -> Self {
        Self {
            t,
            moved: vec![DVec2::ZERO; plain.len()],
            places: plain.clone(),
            plain,
        }
    }
}

/// The line between a vertex and an edge that are close to each other.
struct SeparatingLine {
    pair: GuardedPair,
    /// Unit normal of the line, from the edge towards the vertex.
    normal: DVec2,
}

struct GuardStepper<'a> {
    film: &'a Arap,
    placer: Placer,
    outlines: &'a GuardedOutlines,
    yielding: MeshCompliance,
    parts: Vec<u32>,
}

impl GuardStepper<'_> {
    fn plain(&mut self, t: f64) -> Vec<DVec2> {
        self.placer.place(t);
        self.placer.placement().in_frame.clone()
    }

    fn step(&mut self, before: &GuardMoment, plain: Vec<DVec2>, t: f64) -> Option<GuardMoment> {
        let apart = self.outlines.apart();
        let mut moved = before.moved.clone();
        let mut places = sum(&plain, &moved);
        let mut lines: Vec<SeparatingLine> = Vec::new();
        for correction in 0..CORRECTIONS {
            if correction > 0 {
                self.turned(&mut lines, &places);
            }
            let near = self
                .outlines
                .near([&before.places, &places], 2.0 * apart, t);
            if near.len() > MOST_LINES {
                return None;
            }
            let known = lines.len();
            for pair in near {
                if lines[..known]
                    .binary_search_by_key(&pair, |line| line.pair)
                    .is_err()
                {
                    let normal = self.line(pair, before, &plain);
                    lines.push(SeparatingLine { pair, normal });
                }
            }
            lines.sort_unstable_by_key(|line| line.pair);
            let mut rows = self.contacts(&lines, &plain, &places, t);
            self.faces(&plain, &places, &moved, &mut rows);
            let next = smallest(&rows, &mut self.yielding, EXACT * apart)?;
            let farthest = next.iter().fold(0.0, |far: f64, by| far.max(by.length()));
            if farthest > FARTHEST * self.film.mesh().diameter() {
                return None;
            }
            let changes = next.iter().zip(&moved).map(|(a, b)| a.distance(*b));
            let change = changes.fold(0.0, f64::max);
            moved = next;
            places = sum(&plain, &moved);
            if change < EXACT * apart {
                break;
            }
        }
        Some(GuardMoment {
            t,
            plain,
            moved,
            places,
        })
    }

    /// Returns the normal of the line that separates a vertex from an edge: the direction from the
    /// edge to the vertex before the step, rotated as the edge rotates during the step.
    fn line(&self, pair: GuardedPair, before: &GuardMoment, plain: &[DVec2]) -> DVec2 {
        let towards = self.outlines.towards(pair, &before.places);
        let along = |places: &[DVec2]| {
            let [a, b] = self.outlines.edge(pair).map(|v| places[v as usize]);
            (b - a).normalize_or_zero()
        };
        let (was, is) = (along(&before.plain), along(plain));
        if towards.length() <= self.outlines.touches() {
            // The vertex touches the edge, like the two sides of a closed cut, so the vector
            // between them has no direction. The outward normal of the edge is used.
            return -is.perp();
        }
        let turn = DVec2::new(was.dot(is), was.perp_dot(is));
        let turn = turn.try_normalize().unwrap_or(DVec2::X);
        turn.rotate(towards.normalize_or_zero())
    }

    /// Updates the normal of the separating line of each pair that is apart to the current
    /// direction from the edge to the vertex, so that the vertex can slide along the edge.
    fn turned(&self, lines: &mut [SeparatingLine], places: &[DVec2]) {
        for SeparatingLine { pair, normal } in lines {
            let towards = self.outlines.towards(*pair, places);
            if self.between(*pair, *normal, places) > 0.0
                && towards.length() > self.outlines.touches()
            {
                *normal = towards.normalize_or_zero();
            }
        }
    }

    /// Returns the smaller of the distances of the vertex from the two ends of the edge, measured
    /// along `line`; negative if the vertex is not beyond both ends.
    fn between(&self, pair: GuardedPair, line: DVec2, places: &[DVec2]) -> f64 {
        let p = places[self.outlines.vertex(pair) as usize];
        let [a, b] = self.outlines.edge(pair).map(|v| places[v as usize]);
        line.dot(p - a).min(line.dot(p - b))
    }

    fn contacts(
        &self,
        lines: &[SeparatingLine],
        plain: &[DVec2],
        places: &[DVec2],
        t: f64,
    ) -> Vec<ContactConstraint> {
        let apart = self.outlines.apart();
        let mut rows = Vec::new();
        for &SeparatingLine { pair, normal: line } in lines {
            if self.between(pair, line, places) > 2.0 * apart {
                continue;
            }
            let gap = asked(self.outlines.gap(pair, t), self.between(pair, line, plain));
            let vertex = self.outlines.vertex(pair);
            for end in self.outlines.edge(pair) {
                let now = line.dot(plain[vertex as usize] - plain[end as usize]);
                rows.push(ContactConstraint {
                    terms: vec![(vertex, line), (end, -line)],
                    least: gap - now,
                });
            }
        }
        rows
    }

    /// Adds to `rows` a constraint for each face that is close to folding: its area must not become
    /// too small.
    fn faces(
        &self,
        plain: &[DVec2],
        places: &[DVec2],
        moved: &[DVec2],
        rows: &mut Vec<ContactConstraint>,
    ) {
        let mesh = self.film.mesh();
        for face in mesh.faces().iter() {
            // A part that exists in only one design keeps its shape.
            let part = self.parts[face[0] as usize] as usize;
            if self
                .film
                .time_windows()
                .get(part)
                .is_some_and(Option::is_some)
            {
                continue;
            }
            let at = |points: &[DVec2]| face.map(|v| points[v as usize]);
            let area = |points: &[DVec2]| {
                let [a, b, c] = at(points);
                twice_signed_area(a, b, c)
            };
            let least = FACE * area(mesh.source()).min(area(mesh.target()));
            let (least, now) = (asked(least, area(plain)), area(places));
            if now > 2.0 * least {
                continue;
            }
            let [a, b, c] = at(places);
            let (second, third) = (-(c - a).perp(), (b - a).perp());
            let gradients = [-(second + third), second, third];
            let longest = gradients.iter().fold(0.0, |m: f64, g| m.max(g.length()));
            if longest == 0.0 {
                continue;
            }
            let terms: Vec<(u32, DVec2)> =
                (0..3).map(|k| (face[k], gradients[k] / longest)).collect();
            let so_far: f64 = terms.iter().map(|&(v, g)| g.dot(moved[v as usize])).sum();
            rows.push(ContactConstraint {
                terms,
                least: (least - now) / longest + so_far,
            });
        }
    }
}

/// Returns the required value of a clearance or an area. If the original motion has a positive
/// value `by_itself` below `wanted`, only that value is required, but at least a quarter of
/// `wanted`.
fn asked(wanted: f64, by_itself: f64) -> f64 {
    if by_itself > 0.0 {
        wanted.min(by_itself.max(0.25 * wanted))
    } else {
        wanted
    }
}

fn sum(plain: &[DVec2], moved: &[DVec2]) -> Vec<DVec2> {
    plain.iter().zip(moved).map(|(p, by)| *p + *by).collect()
}

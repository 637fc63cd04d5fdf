//! Where the connected parts are as a whole, which the energy leaves open.
//!
//! Parts move as [`PartPath`] says. Centroids use fixed vertex masses: an area
//! centroid is 0/0 where a path collapses.

use super::assembly::LocalMaps;
use super::evaluation_times::EvaluationTimes;
use super::options::ArapPath;
use super::time_window::TimeWindow;
use crate::compatible::CompatibleMesh;
use crate::geometry::{DMat2, DVec2};
use crate::warp::part_path::{PartPath, centroid};
use std::ops::Range;

/// The connected parts and how they drift.
#[derive(Clone, Debug)]
pub(super) struct PartTranslations {
    parts: Vec<PartPath>,
    /// Of parts that are points in one of the designs.
    lives: Vec<Option<TimeWindow>>,
    /// The centroids of each part in source and target.
    centres: Vec<[DVec2; 2]>,
    /// The design's centroid in source and target.
    centroid: [DVec2; 2],
    /// Vertices by part.
    vertices: Vec<PartRun>,
    /// Unknowns in elimination order by part.
    unknowns: Vec<PartRun>,
    /// For each unknown in elimination order its share of its part's mass.
    shares: Vec<f64>,
    whole_angle: f64,
    /// The anchor's place in elimination order and its part.
    anchor: Option<(u32, u32)>,
    /// The whole turns about its pole.
    about_pole: bool,
}

/// Where half the turn of the whole has a smaller sine, the pole is a hundred times as
/// far away as the whole travels, or there is none: the way is straight.
const NO_POLE: f64 = 5e-3;

/// Neighbours in some order that belong to the same part.
#[derive(Clone, Debug)]
struct PartRun {
    range: Range<usize>,
    part: usize,
}

impl PartRun {
    /// All runs, given the part of each member of the order.
    fn all(part_of: &[u32]) -> Vec<Self> {
        let mut end = 0;
        let runs = part_of.chunk_by(|a, b| a == b).map(|run| {
            let range = end..end + run.len();
            end = range.end;
            let part = run[0] as usize;
            Self { range, part }
        });
        runs.collect()
    }
}

impl PartTranslations {
    pub(super) fn new(
        mesh: &CompatibleMesh,
        maps: &LocalMaps,
        place: &[u32],
        path: ArapPath,
        lives: Vec<Option<TimeWindow>>,
    ) -> Self {
        let component = mesh.components();
        let count = component.iter().max().map_or(0, |&last| last as usize + 1);
        let mut mass = vec![0.0; count];
        for (&part, &m) in component.iter().zip(&maps.masses) {
            mass[part as usize] += m;
        }
        let mut shares = vec![0.0; place.len()];
        let mut part_of_unknown = vec![0; place.len()];
        let mut centres = vec![[DVec2::ZERO; 2]; count];
        for (v, &part) in component.iter().enumerate() {
            let share = maps.masses[v] / mass[part as usize];
            shares[place[v] as usize] = share;
            part_of_unknown[place[v] as usize] = part;
            centres[part as usize][0] += mesh.source()[v] * share;
            centres[part as usize][1] += mesh.target()[v] * share;
        }
        let anchor = match path {
            ArapPath::Centroid | ArapPath::Pole => None,
            ArapPath::Anchor(v) => Some((place[v as usize], component[v as usize])),
        };
        // Where the whole is does not depend on where points are put.
        let counted = |part: usize| lives.get(part).is_none_or(Option::is_none);
        if (0..count).any(counted) {
            let points = (0..count).filter(|&part| !counted(part));
            points.for_each(|part| mass[part] = 0.0);
        }
        Self {
            parts: PartPath::all(&centres, &mass, maps.whole_angle),
            centroid: centroid(centres.iter().copied(), &mass),
            centres,
            lives,
            vertices: PartRun::all(&component),
            unknowns: PartRun::all(&part_of_unknown),
            shares,
            whole_angle: maps.whole_angle,
            anchor,
            about_pole: path == ArapPath::Pole,
        }
    }

    /// How far the whole is beside the straight line of its centroid; exactly 0 at both
    /// ends.
    ///
    /// A rotation by θ about the pole takes the centroid along an arc whose chord d is
    /// its travel: after tθ it has gone R((t − 1) θ/2) d · sin(tθ/2) / sin(θ/2).
    fn bend(&self, t: f64) -> DVec2 {
        let half = 0.5 * self.whole_angle;
        if !self.about_pole || half.sin().abs() < NO_POLE {
            return DVec2::ZERO;
        }
        let travel = self.centroid[1] - self.centroid[0];
        let along = (t * half).sin() / half.sin();
        DMat2::from_angle((t - 1.0) * half) * travel * along - travel * t
    }

    /// Where the centroid of the whole is.
    fn centre(&self, t: f64) -> DVec2 {
        let [from, to] = self.centroid;
        from * (1.0 - t) + to * t + self.bend(t)
    }

    /// How many connected parts there are.
    pub(super) fn part_count(&self) -> usize {
        self.parts.len()
    }

    /// The time in which a part changes its size, if it is a point in one of
    /// the designs.
    pub(super) fn life(&self, part: usize) -> Option<TimeWindow> {
        self.lives.get(part).copied().flatten()
    }

    pub(super) fn lives(&self) -> &[Option<TimeWindow>] {
        &self.lives
    }

    /// Where a part with these centroids is at t, when so much of its own way
    /// is done.
    pub(super) fn carried(&self, ends: [DVec2; 2], share: f64, t: f64) -> DVec2 {
        let path = PartPath::of(ends, self.centroid, self.whole_angle);
        self.centre(t) + path.at_share(t, share, self.whole_angle)
    }

    /// The places in source and target that the whole carries to one at t.
    pub(super) fn carried_back(&self, place: DVec2, t: f64) -> [DVec2; 2] {
        let [from, to] = self.centroid;
        let offset = place - self.centre(t);
        let turned = |by: f64| DMat2::from_angle(by * self.whole_angle) * offset;
        [from + turned(-t), to + turned(1.0 - t)]
    }

    /// Ranges that hold every vertex once, and the part of each range.
    pub(super) fn runs(&self) -> impl Iterator<Item = (Range<usize>, usize)> {
        self.vertices
            .iter()
            .map(|run| (run.range.clone(), run.part))
    }

    /// What has to be added to the deviations (all x, all y, in elimination
    /// order) of each part.
    pub(super) fn shifts(&self, times: EvaluationTimes, deviation: &[f64], shifts: &mut [DVec2]) {
        let (dx, dy) = deviation.split_at(deviation.len() / 2);
        shifts.fill(DVec2::ZERO);
        // By runs, so that `dot` reads rows of numbers and no part for each.
        for PartRun { range, part } in &self.unknowns {
            let [shares, dx, dy] = [&self.shares, dx, dy].map(|all| &all[range.clone()]);
            shifts[*part] -= DVec2::new(dot(shares, dx), dot(shares, dy));
        }
        for (part, shift) in shifts.iter_mut().enumerate() {
            let t = times.of_part(part);
            match self.life(part) {
                // The ends are met to the last bit.
                Some(_) if t == 0.0 || t == 1.0 => *shift = DVec2::ZERO,
                Some(life) => {
                    let ([from, to], share) = (self.centres[part], life.share(t));
                    let straight = from * (1.0 - share) + to * share;
                    *shift = self.carried([from, to], share, t) - straight;
                }
                None => *shift += self.parts[part].deviation(t, self.whole_angle) + self.bend(t),
            }
        }
        if let Some((at, part)) = self.anchor {
            // All parts move along, or those without the anchor would tear away.
            let of_anchor = DVec2::new(dx[at as usize], dy[at as usize]) + shifts[part as usize];
            shifts.iter_mut().for_each(|shift| *shift -= of_anchor);
        }
    }
}

/// Σ aᵢ bᵢ, in several sums at once that do not wait for each other.
fn dot(a: &[f64], b: &[f64]) -> f64 {
    let ((a, a_rest), (b, b_rest)) = (a.as_chunks::<8>(), b.as_chunks::<8>());
    let mut sums = [0.0; 8];
    for (a, b) in a.iter().zip(b) {
        for (sum, (a, b)) in sums.iter_mut().zip(a.iter().zip(b)) {
            *sum += a * b;
        }
    }
    let rest = a_rest.iter().zip(b_rest).map(|(a, b)| a * b);
    sums.iter().sum::<f64>() + rest.sum::<f64>()
}

//! Translations of the connected parts, which the energy leaves undetermined.
//!
//! The centroid of each part follows its [`PartPath`]. Centroids use vertex masses that do not
//! depend on t, because an area centroid would be 0/0 where a part collapses.

use super::assembly::LocalMaps;
use super::evaluation_times::EvaluationTimes;
use super::options::ArapPath;
use super::time_window::TimeWindow;
use crate::compatible::CompatibleMesh;
use crate::geometry::{DMat2, DVec2};
use crate::warp::part_path::{PartPath, centroid};
use std::ops::Range;

/// The connected parts with the paths of their centroids.
#[derive(Clone, Debug)]
pub(super) struct PartTranslations {
    parts: Vec<PartPath>,
    /// For each part that is a point in one of the designs, its time window; `None` for other
    /// parts.
    time_windows: Vec<Option<TimeWindow>>,
    /// Centroid of each part in source and target.
    centres: Vec<[DVec2; 2]>,
    /// Centroid of the design in source and target.
    centroid: [DVec2; 2],
    /// Runs of consecutive vertices that belong to the same part.
    vertices: Vec<PartRun>,
    /// Runs of consecutive vertices in elimination order, the order of the unknowns, that belong to
    /// the same part.
    unknowns: Vec<PartRun>,
    /// For each vertex, in elimination order: its mass as a fraction of the mass of its part.
    shares: Vec<f64>,
    /// Rotation of the design in radians.
    whole_angle: f64,
    /// Place of the anchor vertex in the elimination order, and the index of its part; `None`
    /// without an anchor.
    anchor: Option<(u32, u32)>,
    /// Whether the design rotates about its pole (the fixed point of its rigid motion) instead of
    /// its centroid.
    rotates_about_pole: bool,
}

/// Sine of half the design's rotation below which there is no rotation about the pole: the design's
/// centroid moves on a straight line instead of an arc (tolerance: the pole does not exist or is
/// more than a hundred times as far away as the centroid moves).
const NO_POLE: f64 = 5e-3;

/// Range of consecutive items that belong to one part.
#[derive(Clone, Debug)]
struct PartRun {
    range: Range<usize>,
    part: usize,
}

impl PartRun {
    /// Returns the runs (maximal ranges of consecutive items that belong to one part) of a list in
    /// which entry i is the part of item i.
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
        time_windows: Vec<Option<TimeWindow>>,
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
        // Transient parts must not affect the position of the whole design.
        let is_permanent = |part: usize| time_windows.get(part).is_none_or(Option::is_none);
        if (0..count).any(is_permanent) {
            let transient = (0..count).filter(|&part| !is_permanent(part));
            transient.for_each(|part| mass[part] = 0.0);
        }
        Self {
            parts: PartPath::all(&centres, &mass, maps.whole_angle),
            centroid: centroid(centres.iter().copied(), &mass),
            centres,
            time_windows,
            vertices: PartRun::all(&component),
            unknowns: PartRun::all(&part_of_unknown),
            shares,
            whole_angle: maps.whole_angle,
            anchor,
            rotates_about_pole: path == ArapPath::Pole,
        }
    }

    /// Returns the deviation of the design's centroid from its straight path; exactly 0 at t = 0
    /// and t = 1.
    ///
    /// A rotation by θ about the pole moves the centroid along an arc whose chord is the vector d.
    /// At t the centroid has moved by R((t − 1) θ/2) d · sin(tθ/2) / sin(θ/2), where R(α) is the
    /// rotation by α.
    fn bend(&self, t: f64) -> DVec2 {
        let half = 0.5 * self.whole_angle;
        if !self.rotates_about_pole || half.sin().abs() < NO_POLE {
            return DVec2::ZERO;
        }
        let chord = self.centroid[1] - self.centroid[0];
        let ratio = (t * half).sin() / half.sin();
        DMat2::from_angle((t - 1.0) * half) * chord * ratio - chord * t
    }

    /// Returns the design's centroid at t.
    fn centre(&self, t: f64) -> DVec2 {
        let [from, to] = self.centroid;
        from * (1.0 - t) + to * t + self.bend(t)
    }

    /// Returns the number of connected parts.
    pub(super) fn part_count(&self) -> usize {
        self.parts.len()
    }

    /// Returns the time window of a part, or `None` if the part is not a point in either design.
    pub(super) fn time_window(&self, part: usize) -> Option<TimeWindow> {
        self.time_windows.get(part).copied().flatten()
    }

    /// Returns the time windows of all parts; the list may be shorter than the number of parts.
    pub(super) fn time_windows(&self) -> &[Option<TimeWindow>] {
        &self.time_windows
    }

    /// Returns the position at t of a point that moves with the design and, in addition, relative
    /// to it.
    ///
    /// `ends` holds the positions of the point in source and target. `share`, from 0 to 1, is the
    /// completed fraction of its motion relative to the design.
    pub(super) fn carried_position(&self, ends: [DVec2; 2], share: f64, t: f64) -> DVec2 {
        let path = PartPath::of(ends, self.centroid, self.whole_angle);
        self.centre(t) + path.offset_at_fraction(t, share, self.whole_angle)
    }

    /// Returns the positions in source and target of a point that moves rigidly with the design and
    /// is at `place` at t.
    pub(super) fn uncarried_ends(&self, place: DVec2, t: f64) -> [DVec2; 2] {
        let [from, to] = self.centroid;
        let offset = place - self.centre(t);
        let turned = |by: f64| DMat2::from_angle(by * self.whole_angle) * offset;
        [from + turned(-t), to + turned(1.0 - t)]
    }

    /// Returns ranges that cover every vertex once, each with its part.
    pub(super) fn runs(&self) -> impl Iterator<Item = (Range<usize>, usize)> {
        self.vertices
            .iter()
            .map(|run| (run.range.clone(), run.part))
    }

    /// Writes to `shifts`, for each part, the translation that must be added to the deviations of
    /// its vertices so that the part's centroid follows its path. With an anchor, all parts are
    /// also shifted by one common vector, so that the anchor moves straight.
    ///
    /// `deviation` holds all x and then all y in elimination order.
    pub(super) fn shifts(&self, times: EvaluationTimes, deviation: &[f64], shifts: &mut [DVec2]) {
        let (dx, dy) = deviation.split_at(deviation.len() / 2);
        shifts.fill(DVec2::ZERO);
        // Within a run, `dot` reads contiguous numbers and need not look up the part of each.
        for PartRun { range, part } in &self.unknowns {
            let [shares, dx, dy] = [&self.shares, dx, dy].map(|all| &all[range.clone()]);
            shifts[*part] -= DVec2::new(dot(shares, dx), dot(shares, dy));
        }
        for (part, shift) in shifts.iter_mut().enumerate() {
            let t = times.of_part(part);
            match self.time_window(part) {
                // The formula of the next case would leave rounding errors at t = 0 and t = 1.
                Some(_) if t == 0.0 || t == 1.0 => *shift = DVec2::ZERO,
                Some(window) => {
                    let ([from, to], share) = (self.centres[part], window.fraction_done(t));
                    let straight = from * (1.0 - share) + to * share;
                    *shift = self.carried_position([from, to], share, t) - straight;
                }
                None => *shift += self.parts[part].deviation(t, self.whole_angle) + self.bend(t),
            }
        }
        if let Some((at, part)) = self.anchor {
            // All parts are shifted by the same vector; otherwise the parts without the anchor
            // would drift away from the anchored part.
            let anchor_shift = DVec2::new(dx[at as usize], dy[at as usize]) + shifts[part as usize];
            shifts.iter_mut().for_each(|shift| *shift -= anchor_shift);
        }
    }
}

/// Returns Σ aᵢ bᵢ, computed as eight independent sums for instruction-level parallelism.
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

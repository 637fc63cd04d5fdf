//! Choosing among matches: candidates, the film of each, and the one whose
//! film has the least trouble.
//!
//! No measure of two boundaries alone tells what becomes of the inside, so a
//! match is judged by its film. Candidates come in rounds: first the match at
//! the prices that were asked for, its parts out of each other's way, and at
//! other prices beside it where the shapes are unlike; then, as long as the
//! best film folds, the others. Of all films so far the best is the
//! one with the fewest folded faces over all its steps, then the fewest
//! crossings of its outlines, then the least distortion, outlines that grow
//! jagged on the way included, then the earliest.

use super::births::lives;
use super::conflicts::Walks;
use super::error::BuildError;
use super::rigid::arap;
use super::settled::{parted, placed};
use super::spec::TransitionSpec;
use crate::compatible::CompatibleMesh;
use crate::correspondence::{MatchOptions, Matching, Prepared, RegionMatch};
use crate::geometry::{DVec2, Regions, count_crossings, orient2d, turning, turning_excess};
use crate::progress::{Cancelled, Progress, Several, Span, checkpoint, still_wanted};
use crate::warp::{Arap, Warp};
use rayon::prelude::*;

/// A match of at most this cost whose film does not fold is taken at once.
/// Two poses of a thing cost up to about 0.3, unlike things 0.4 and more.
const ALIKE: f64 = 0.34;

/// Prices of stretch that are tried for unlike shapes, after the default.
const OTHER_PRICES: [f64; 2] = [0.6, 1.2];

/// The price of inner distances of a match that is tried for unlike shapes as
/// well. It sees limbs and strokes, and with this price little else.
const INNER: f64 = 8.0;

/// What is tried where all of those fold: prices without regard to
/// thickness, which of a thick body and thin arms makes one arm the body.
const LAST_PRICES: [f64; 4] = [0.12, 0.25, 0.5, 1.0];

/// Steps of a film that is looked at for folds and crossings.
/// Each costs a frame of every candidate; a fold between two is missed.
const STEPS: u32 = 16;

/// How much is done once the outlines are matched, and once the films are there
/// that most pairs need, as it is told.
const FIRST: f64 = 0.1;
const SECOND: f64 = 0.7;

/// How much of a candidate is done once it has its mesh.
const MESHED: f64 = 0.9;

/// The share of the area whose distortion is not looked at: the corners of
/// any triangulation hold some.
const WORST: f64 = 0.05;

/// The power of the outlines' turning, as a ratio to that between the ends,
/// by which distortion counts as more. By 5 the worst tenth of the distortion of
/// 60 pairs of silhouettes grew from 22 to 24.
const JAGGED: i32 = 3;

/// A match with its film, and how good that is.
struct Candidate {
    matched: RegionMatch,
    film: Arap,
    trouble: Trouble,
    distortion: f64,
}

/// What is seen of a film.
struct Trouble {
    /// Faces that are not positive, over all steps.
    folds: usize,
    /// Crossings of the outlines of what both designs have, over all steps.
    crossings: usize,
    /// The share by which the outlines turn more than between the ends.
    turning: f64,
}

/// The match of both outlines that is kept, and its film, settled.
pub(super) fn best(
    spec: &TransitionSpec,
    outlines: &[Regions; 2],
    progress: &dyn Progress,
) -> Result<(RegionMatch, Arap), BuildError> {
    let [source, target] = outlines;
    let asked = &spec.options.matching;
    let begin = Span::new(progress, 0.0, FIRST);
    checkpoint(&begin, "matching", 0.0)?;
    let mut prepared = Prepared::new([source, target], asked, &begin)?;
    let middle = Span::new(progress, FIRST, SECOND);
    let shares = Several::new(&middle, 2 + OTHER_PRICES.len());
    // What the default match fails with, others would fail with.
    let first = parted(&mut prepared, spec, &shares.part(0))?;
    let is_alike = first.0.pieces.iter().all(|piece| piece.cost <= ALIKE);
    let film = |matched, share: &dyn Progress| Candidate::new(matched, spec, share);
    // The best of a round, the first among equals; none of none.
    let other = |round: &[MatchOptions], shares: &Several, from: usize| {
        let found = round.par_iter().enumerate().map(|(k, options)| {
            let share = shares.part(from + k);
            let [begin, rest] = [(0.0, FIRST), (FIRST, 1.0)].map(|(a, b)| Span::new(&share, a, b));
            let tried = prepared.matched(options, &begin).map_err(BuildError::from);
            let tried = tried.and_then(|matched| film(matched, &rest));
            // What cannot be had is no better: there is the first one. But a
            // cancel is an answer.
            still_wanted(progress)?;
            Ok(tried.ok())
        });
        let found: Vec<Option<Candidate>> = found.collect::<Result<_, BuildError>>()?;
        let found = found.into_iter().flatten();
        Ok::<_, BuildError>(found.reduce(|best, next| best.or(Some(next))))
    };
    let rounds = if prepared.is_crowd() {
        Vec::new()
    } else {
        rounds(asked)
    };
    let mut rounds = rounds.into_iter();
    let beside = if is_alike { None } else { rounds.next() }.unwrap_or_default();
    let first = Candidate::of(first, progress)?;
    let mut best = first.or(other(&beside, &shares, 1)?);
    let last = Span::new(progress, SECOND, 1.0);
    for round in rounds {
        // Folds alone: the last prices match worse, and are for want of better.
        // Tried against crossings too they take twice as long and help one
        // pair of icons of 58.
        if best.trouble.folds == 0 {
            break;
        }
        best = best.or(other(&round, &Several::new(&last, round.len()), 0)?);
    }
    placed((best.matched, best.film), progress)
}

/// What is tried after the match that was asked for, round by round; nothing
/// where somebody settled the price.
fn rounds(asked: &Matching) -> Vec<Vec<MatchOptions>> {
    if asked.stretch.is_some() {
        return Vec::new();
    }
    let asked = asked.options();
    let priced = |stretch: f64, thickness: f64| MatchOptions {
        stretch,
        thickness,
        ..asked.clone()
    };
    let inside = MatchOptions {
        inner: INNER,
        ..asked.clone()
    };
    let mut others = OTHER_PRICES
        .map(|price| priced(price, asked.thickness))
        .to_vec();
    others.push(inside);
    vec![others, LAST_PRICES.map(|price| priced(price, 0.0)).to_vec()]
}

impl Candidate {
    fn new(
        matched: RegionMatch,
        spec: &TransitionSpec,
        progress: &dyn Progress,
    ) -> Result<Self, BuildError> {
        let options = &spec.options;
        let [meshing, filming] =
            [(0.0, MESHED), (MESHED, 1.0)].map(|(from, to)| Span::new(progress, from, to));
        let mesh = CompatibleMesh::from_outlines(&matched, &options.triangulation, &meshing)?;
        let film = arap(&mesh, &options.arap, &lives(&matched), &filming)?;
        Self::of((matched, mesh, film), progress)
    }

    fn of(
        (matched, mesh, film): (RegionMatch, CompatibleMesh, Arap),
        progress: &dyn Progress,
    ) -> Result<Self, BuildError> {
        Ok(Self {
            trouble: Trouble::of(&film, progress)?,
            distortion: mesh.distortion(WORST),
            matched,
            film,
        })
    }

    /// The better one, this one among equals.
    fn or(self, other: Option<Self>) -> Self {
        match other {
            // NaN compares false: what cannot be measured is not better.
            Some(other) if other.trouble() < self.trouble() => other,
            _ => self,
        }
    }

    /// What makes one film worse than another, first things first.
    fn trouble(&self) -> (usize, usize, f64) {
        let Trouble {
            folds,
            crossings,
            turning,
        } = self.trouble;
        let jagged = (1.0 + turning).powi(JAGGED);
        (folds, crossings, self.distortion * jagged)
    }
}

impl Trouble {
    fn of(arap: &Arap, progress: &dyn Progress) -> Result<Self, Cancelled> {
        let mesh = arap.mesh();
        let (loops, diameter) = (mesh.boundary_loops(), mesh.diameter());
        let [mut folds, mut crossings] = [0; 2];
        let mut turned = Vec::new();
        let walks = Walks::of(arap);
        let mut placer = arap.placer();
        for step in 0..=STEPS {
            still_wanted(progress)?;
            let t = f64::from(step) / f64::from(STEPS);
            placer.place(t);
            let places = &placer.placement().in_frame;
            let ring = |ring: &Vec<u32>| ring.iter().map(|&v| places[v as usize]).collect();
            let rings: Vec<Vec<DVec2>> = loops.iter().map(ring).collect();
            turned.push([t, turning(&rings, diameter)]);
            // The ends are the designs.
            if step > 0 && step < STEPS {
                folds += folded(arap, places);
                crossings += count_crossings(&walks.rings(places));
            }
        }
        Ok(Self {
            folds,
            crossings,
            turning: turning_excess(&turned),
        })
    }
}

/// Faces that are not positive.
fn folded(arap: &Arap, places: &[DVec2]) -> usize {
    let is_folded = |face: &&[u32; 3]| {
        let [a, b, c] = face.map(|v| places[v as usize]);
        orient2d(a, b, c) <= 0.0
    };
    arap.mesh().faces().iter().filter(is_folded).count()
}

//! Two outlines as rigid parts: matched, triangulated, interpolated.
//!
//! Where the shapes are much alike the first match is taken. Where they are
//! not, or its film folds, matches at other prices are tried, and
//! the one whose film folds least, then distorts least, is kept: no measure
//! of two boundaries alone tells what becomes of the inside.

use super::{BuildError, TransitionSpec};
use crate::compatible::CompatibleMesh;
use crate::correspondence::{Matching, RegionMatch, match_regions};
use crate::geometry::orient2d;
use crate::progress::Progress;
use crate::warp::{Arap, Warp};
use rayon::prelude::*;

/// A match of at most this cost whose film does not fold is taken at once.
/// Two poses of a thing cost up to about 0.3, unlike things 0.4 and more.
const ALIKE: f64 = 0.34;

/// Prices of stretch that are tried for unlike shapes, after the default.
const OTHER_PRICES: [f64; 2] = [0.6, 1.2];

/// What is tried where all of those fold: prices without regard to
/// thickness, which of a thick body and thin arms makes one arm the body.
const LAST_PRICES: [f64; 4] = [0.12, 0.25, 0.5, 1.0];

/// Steps of a film that is looked at for folds.
const STEPS: u32 = 16;

/// A match with its film, and how good that is.
struct Candidate {
    matched: RegionMatch,
    arap: Arap,
    folds: usize,
    distortion: f64,
}

/// The match of both outlines with its interpolation.
pub(super) fn best(
    spec: &TransitionSpec,
    bar_width: f64,
    progress: &dyn Progress,
) -> Result<(RegionMatch, Arap), BuildError> {
    let outlines = [
        spec.source.outline(bar_width)?,
        spec.target.outline(bar_width)?,
    ];
    let matched = |matching: &Matching| {
        let [source, target] = &outlines;
        match_regions(source, target, matching, progress)
    };
    let film = |matched: RegionMatch| Candidate::new(matched, spec, progress);
    let first = matched(&spec.options.matching)?;
    let is_settled = spec.options.matching.stretch.is_some();
    let is_alike = first.pieces.iter().all(|piece| piece.cost <= ALIKE);
    let others = || {
        let others = OTHER_PRICES.map(|price| priced(spec, price, spec.options.matching.thickness));
        best_of(&others, |matching| film(matched(matching)?))
    };
    let mut best = if is_settled || is_alike {
        film(first)?
    } else {
        let (first, others) = rayon::join(|| film(first), others);
        first?.or(others?)
    };
    if is_settled || best.folds == 0 {
        return Ok((best.matched, best.arap));
    }
    if is_alike {
        best = best.or(others()?);
    }
    if best.folds > 0 {
        let last = LAST_PRICES.map(|price| priced(spec, price, Some(0.0)));
        best = best.or(best_of(&last, |matching| film(matched(matching)?))?);
    }
    Ok((best.matched, best.arap))
}

/// The settings at other prices of stretch and of thickness.
fn priced(spec: &TransitionSpec, stretch: f64, thickness: Option<f64>) -> Matching {
    Matching {
        stretch: Some(stretch),
        thickness,
        ..spec.options.matching.clone()
    }
}

/// The best of several, the first among equals; none of none.
fn best_of(
    matchings: &[Matching],
    candidate: impl Fn(&Matching) -> Result<Candidate, BuildError> + Sync + Send,
) -> Result<Option<Candidate>, BuildError> {
    let found: Result<Vec<Candidate>, BuildError> = matchings.par_iter().map(candidate).collect();
    Ok(found?.into_iter().reduce(|best, next| best.or(Some(next))))
}

impl Candidate {
    fn new(
        matched: RegionMatch,
        spec: &TransitionSpec,
        progress: &dyn Progress,
    ) -> Result<Self, BuildError> {
        let mesh = CompatibleMesh::from_outlines(&matched, &spec.options.triangulation, progress)?;
        let arap = Arap::build(&mesh, &spec.options.arap, progress)?;
        Ok(Self {
            folds: folds(&arap),
            distortion: mesh.distortion(),
            matched,
            arap,
        })
    }

    /// The better one, this one among equals.
    fn or(self, other: Option<Self>) -> Self {
        match other {
            Some(other) if other.is_better_than(&self) => other,
            _ => self,
        }
    }

    fn is_better_than(&self, other: &Self) -> bool {
        (self.folds, self.distortion) < (other.folds, other.distortion)
    }
}

/// Faces that are not positive, over all steps of a film.
fn folds(arap: &Arap) -> usize {
    let mut placer = arap.placer();
    (1..STEPS)
        .map(|step| {
            placer.place(f64::from(step) / f64::from(STEPS));
            let places = &placer.placement().in_frame;
            let is_folded = |face: &&[u32; 3]| {
                let [a, b, c] = face.map(|v| places[v as usize]);
                orient2d(a, b, c) <= 0.0
            };
            arap.mesh().faces().iter().filter(is_folded).count()
        })
        .sum()
}

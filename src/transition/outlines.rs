//! Two outlines as rigid parts: matched, triangulated, interpolated.
//!
//! Where the shapes are much alike the first match is taken. Where they are
//! not, or its film folds, matches at other prices are tried, and
//! the one whose film folds least, then distorts least, is kept: no measure
//! of two boundaries alone tells what becomes of the inside.

use super::{BuildError, TransitionSpec};
use crate::compatible::CompatibleMesh;
use crate::correspondence::{Matching, RegionMatch, match_regions};
use crate::geometry::{Regions, orient2d};
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
    let first = candidate(&outlines, &spec.matching, spec, progress)?;
    if spec.matching.stretch.is_some() || first.is_good() {
        return Ok((first.matched, first.arap));
    }
    let priced = |stretch: f64, thickness: Option<f64>| Matching {
        stretch: Some(stretch),
        thickness,
        ..spec.matching.clone()
    };
    let others = OTHER_PRICES.map(|price| priced(price, spec.matching.thickness));
    let mut best = best_of(first, &others, &outlines, spec, progress)?;
    if best.folds > 0 {
        let last = LAST_PRICES.map(|price| priced(price, Some(0.0)));
        best = best_of(best, &last, &outlines, spec, progress)?;
    }
    Ok((best.matched, best.arap))
}

/// The best of a candidate and others yet to be made.
fn best_of(
    mut best: Candidate,
    others: &[Matching],
    outlines: &[Regions; 2],
    spec: &TransitionSpec,
    progress: &dyn Progress,
) -> Result<Candidate, BuildError> {
    let others = others
        .par_iter()
        .map(|matching| candidate(outlines, matching, spec, progress));
    for next in others.collect::<Result<Vec<_>, _>>()? {
        if next.is_better_than(&best) {
            best = next;
        }
    }
    Ok(best)
}

fn candidate(
    [source, target]: &[Regions; 2],
    matching: &Matching,
    spec: &TransitionSpec,
    progress: &dyn Progress,
) -> Result<Candidate, BuildError> {
    let matched = match_regions(source, target, matching, progress)?;
    let mesh = CompatibleMesh::from_outlines(&matched, &spec.triangulation, progress)?;
    let arap = Arap::build(&mesh, &spec.arap, progress)?;
    Ok(Candidate {
        folds: folds(&arap),
        distortion: mesh.distortion(),
        matched,
        arap,
    })
}

impl Candidate {
    fn is_good(&self) -> bool {
        let alike = |piece: &crate::correspondence::PieceMatch| piece.cost <= ALIKE;
        self.folds == 0 && self.matched.pieces.iter().all(alike)
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

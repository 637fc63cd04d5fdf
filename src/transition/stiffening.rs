//! A film without folds, where stiffness alone can have it.
//!
//! Along its local map no face turns over; it folds where its neighbours want
//! something else. So those that fold are held stiffer, again and again, until
//! none does or it is of no use. Both ends stay as they are, since there every
//! face is as its local map says.
//!
//! Looked at at [`STEPS`] steps: a fold between two is missed. Not guaranteed:
//! where a film folds in the large, stiffness only moves the fold.

use super::error::BuildError;
use crate::geometry::orient2d;
use crate::warp::{Arap, Warp};
use crate::work::progress::{Progress, still_wanted};
use rayon::prelude::*;

/// Steps of a film that is looked at.
const STEPS: u32 = 64;

/// How often stiffness is raised, and by how much where a face folds.
const ROUNDS: u32 = 8;
const RAISE: f64 = 4.0;

/// Films of more faces are not looked at: one subdivided is stiff already where
/// that before did fold, and to look at a million faces took 4 s a round.
const MOST_FACES: usize = 100_000;

/// The film that has the fewest folds of those that were tried.
pub(super) fn stiffen_folds(film: Arap, progress: &dyn Progress) -> Result<Arap, BuildError> {
    if film.mesh().faces().len() > MOST_FACES {
        return Ok(film);
    }
    let mut folded = folds(&film);
    if folded.is_empty() || !film.options().homotopy.keeps_orientation() {
        return Ok(film);
    }
    let mut stiffness = film.stiffness().to_vec();
    stiffness.resize(film.mesh().faces().len(), 1.0);
    let (mut best, mut least) = (film, folded.len());
    for _ in 0..ROUNDS {
        still_wanted(progress)?;
        folded.sort_unstable();
        folded.dedup();
        for &face in &folded {
            stiffness[face] *= RAISE;
        }
        let Ok(stiffer) = best.stiffened(&stiffness, progress) else {
            break;
        };
        folded = folds(&stiffer);
        if folded.len() < least {
            least = folded.len();
            best = stiffer;
        }
        if folded.is_empty() {
            break;
        }
    }
    still_wanted(progress)?;
    Ok(best)
}

/// The faces that are not positive, once for each step at which they are not.
fn folds(film: &Arap) -> Vec<usize> {
    let at = |step: u32| {
        let mut placer = film.placer();
        placer.place(f64::from(step) / f64::from(STEPS));
        let places = &placer.placement().in_frame;
        let is_folded = |face: &[u32; 3]| {
            let [a, b, c] = face.map(|v| places[v as usize]);
            orient2d(a, b, c) <= 0.0
        };
        let faces = film.mesh().faces().iter().enumerate();
        let folded = faces.filter(|(_, face)| is_folded(face)).map(|(k, _)| k);
        folded.collect::<Vec<_>>()
    };
    (1..STEPS).into_par_iter().flat_map_iter(at).collect()
}

//! Films whose outlines turn as their edges do, where that does no harm.
//!
//! A face along the outline may turn as its edge does instead of as a whole
//! ([`Arap::leads_along_edges`]): what is smooth in both designs is then smoother
//! between them. Where a design changes much it may fold or cross by it, so each
//! piece is looked at in both films, and is led by its edges only where it folds and
//! crosses no more and its outlines turn less.
//!
//! Looked at at [`STEPS`] steps: a fold or a crossing between two is missed.

use super::error::BuildError;
use super::levels::Levels;
use super::unfolded::unfolded;
use super::walks::Walks;
use crate::geometry::{DVec2, crossings, orient2d, turning, turning_excess};
use crate::homotopy::Homotopy;
use crate::progress::{Progress, still_wanted};
use crate::warp::{Arap, Warp};
use rayon::prelude::*;

/// Steps of a film that is looked at.
const STEPS: u32 = 32;

/// The film without folds that stiffness can mend, and each of its pieces led by its
/// edges where that is better.
pub(super) fn smoothed(
    film: Arap,
    levels: &Levels,
    progress: &dyn Progress,
) -> Result<Arap, BuildError> {
    let led = film.led(&film.leads_along_edges());
    let plain = unfolded(film, progress)?;
    if plain.options().homotopy != Homotopy::Polar {
        return Ok(plain);
    }
    let led = unfolded(led, progress)?;
    let [as_plain, as_led] = [&plain, &led].map(|film| Seen::of(film, levels));
    still_wanted(progress)?;
    let takes = as_led.better_than(&as_plain);
    if !takes.contains(&true) {
        return Ok(plain);
    }
    let mixed = mixed([&plain, &led], &takes, progress)?;
    // What is led may be in the way of what is not.
    let is_worse = Seen::of(&mixed, levels).is_worse_than(&as_plain);
    still_wanted(progress)?;
    Ok(if is_worse { plain } else { mixed })
}

/// The film in which the pieces that take it are as in the second one.
fn mixed(films: [&Arap; 2], takes: &[bool], progress: &dyn Progress) -> Result<Arap, BuildError> {
    let mesh = films[0].mesh();
    let parts = mesh.components();
    let film = |face: usize| usize::from(takes[parts[mesh.faces()[face][0] as usize] as usize]);
    let leads = films.map(Arap::leads);
    let leads: Vec<f64> = (0..mesh.faces().len()).map(|f| leads[film(f)][f]).collect();
    let stiffness = films.map(Arap::stiffness);
    if stiffness.iter().all(|each| each.is_empty()) {
        return Ok(films[0].led(&leads));
    }
    let stiff = |f: usize| stiffness[film(f)].get(f).copied().unwrap_or(1.0);
    let stiffness: Vec<f64> = (0..mesh.faces().len()).map(stiff).collect();
    Ok(films[0].stiffened(&stiffness, progress)?.led(&leads))
}

/// What is seen of each piece.
struct Seen(Vec<OfPiece>);

#[derive(Clone, Default)]
struct OfPiece {
    folds: usize,
    /// Crossings with itself and others.
    crossings: usize,
    turning: f64,
}

/// What is seen of each piece at a step.
type Step = Vec<(usize, usize, f64)>;

impl Seen {
    fn of(film: &Arap, levels: &Levels) -> Self {
        let walks = Walks::of(film);
        let parts = film.mesh().components();
        let count = parts.iter().max().map_or(0, |&last| last as usize + 1);
        let diameter = film.mesh().diameter();
        let steps = (0..=STEPS).into_par_iter().map(|step| {
            let mut placer = film.placer();
            placer.place(f64::from(step) / f64::from(STEPS));
            let places = &placer.placement().in_frame;
            let mut seen: Step = vec![(0, 0, 0.0); count];
            let rings = walks.rings(places);
            for (ring, &piece) in rings.iter().zip(walks.pieces()) {
                seen[piece].2 += turning(std::slice::from_ref(ring), diameter);
            }
            // The ends are the designs.
            if step > 0 && step < STEPS {
                folds(film, &parts, places, &mut seen);
                for crossing in crossings(&rings) {
                    let [a, b] = crossing.edges.map(|edge| walks.pieces()[edge.ring]);
                    if levels.of_piece(a) == levels.of_piece(b) {
                        seen[a].1 += 1;
                        seen[b].1 += 1;
                    }
                }
            }
            seen
        });
        let steps: Vec<Step> = steps.collect();
        let of_piece = |piece: usize| {
            let turned = steps.iter().enumerate();
            let turned: Vec<[f64; 2]> = turned
                .map(|(k, seen)| [k as f64 / f64::from(STEPS), seen[piece].2])
                .collect();
            OfPiece {
                folds: steps.iter().map(|seen| seen[piece].0).sum(),
                crossings: steps.iter().map(|seen| seen[piece].1).sum(),
                turning: turning_excess(&turned),
            }
        };
        Self((0..count).map(of_piece).collect())
    }

    /// For each piece whether it is better here than there.
    fn better_than(&self, other: &Self) -> Vec<bool> {
        let is_better = |(here, there): (&OfPiece, &OfPiece)| {
            here.folds <= there.folds
                && here.crossings <= there.crossings
                && here.turning < there.turning
        };
        self.0.iter().zip(&other.0).map(is_better).collect()
    }

    /// Whether it folds or crosses more, all pieces together.
    fn is_worse_than(&self, other: &Self) -> bool {
        let sums = |of: fn(&OfPiece) -> usize| [self, other].map(|s| s.0.iter().map(of).sum());
        let [folds, crossings]: [[usize; 2]; 2] =
            [sums(|piece| piece.folds), sums(|piece| piece.crossings)];
        folds[0] > folds[1] || crossings[0] > crossings[1]
    }
}

/// Counts the faces of each piece that are not positive.
fn folds(film: &Arap, parts: &[u32], places: &[DVec2], seen: &mut Step) {
    for face in film.mesh().faces().iter() {
        let [a, b, c] = face.map(|v| places[v as usize]);
        if orient2d(a, b, c) <= 0.0 {
            seen[parts[face[0] as usize] as usize].0 += 1;
        }
    }
}

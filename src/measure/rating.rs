//! Rating of a film by its defects, for comparing methods, and the choice of the best method.

use super::film_report::{FilmReport, film_report};
use crate::content::ContentKind;
use crate::transition::{BuildError, Transition, TransitionMethod, TransitionSpec};
use crate::warp::WarpKind;
use crate::work::progress::{Progress, ProgressShares, ProgressSpan};
use std::cmp::Ordering;
use std::fmt;

/// Number of t at which a film is sampled for its rating. Defects shorter than a sixteenth of the
/// film may be missed (heuristic).
const SAMPLES: usize = 17;

/// Progress reported for a method once its transition is built, in [0, 1] (heuristic).
const BUILT_FRACTION: f64 = 0.9;

/// Rating of a film by the largest number of each kind of defect at any sampled t. Ratings of
/// different methods can be compared.
///
/// A film that disappears completely at some t is worse than one that does not. Otherwise, the film
/// with fewer defects is better. With equal numbers of defects, the film with less overshoot is
/// better. Overshoot is the turning of the outlines and the change of area beyond what the shapes
/// at t = 0 and t = 1 require.
///
/// ```
/// use morphospace::measure::FilmRating;
/// use morphospace::{project::gallery, transition::Transition, work::progress::Silent};
///
/// let transition = Transition::build(&gallery::load("triangle-polar")?.spec()?, &Silent)?;
/// let rating = FilmRating::of(&transition, &Silent)?.expect("a solid");
/// assert_eq!(rating.to_string(), "no folds, no crossings");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FilmRating {
    folds: usize,
    crossings: usize,
    /// Largest number of connected regions of the shape at any sampled t, minus the number at t = 0
    /// or t = 1, whichever is larger.
    extra_pieces: usize,
    /// Largest number of holes of the shape at any sampled t, minus the number at t = 0 or t = 1,
    /// whichever is larger.
    extra_holes: usize,
    /// Whether the shape disappears completely at some t.
    disappears: bool,
    /// Turning of the outlines plus change of area, beyond what the shapes at t = 0 and t = 1
    /// require, both as fractions.
    overshoot: f64,
    is_solid: bool,
}

impl FilmRating {
    /// Samples and rates a film; returns `None` for pictures, which have no measures.
    ///
    /// # Errors
    /// [`Cancelled`](crate::work::progress::Cancelled) if the work was cancelled.
    pub fn of(
        transition: &Transition,
        progress: &dyn Progress,
    ) -> Result<Option<Self>, crate::work::progress::Cancelled> {
        let content = transition.method().content();
        if content == ContentKind::Colours {
            return Ok(None);
        }
        let report = film_report(transition, SAMPLES, progress)?;
        Ok(Some(Self::of_report(&report, content)))
    }

    /// Rates a film that was already sampled.
    #[must_use]
    pub fn of_report(report: &FilmReport, content: ContentKind) -> Self {
        let samples = report.samples.iter();
        Self {
            folds: report.worst_folds.unwrap_or(0),
            crossings: report.worst_crossings.unwrap_or(0),
            extra_pieces: report.pieces_excess.unwrap_or(0),
            extra_holes: report.holes_excess.unwrap_or(0),
            disappears: samples.clone().any(|sample| sample.area <= 0.0),
            overshoot: report.turning_excess + report.area_variation_excess,
            is_solid: content == ContentKind::Solid,
        }
    }

    /// Returns the total number of folds, crossings, extra pieces and extra holes.
    fn defects(&self) -> usize {
        self.folds + self.crossings + self.extra_pieces + self.extra_holes
    }

    /// Returns whether the film has no defects and never disappears.
    #[must_use]
    pub fn is_flawless(&self) -> bool {
        !self.disappears && self.defects() == 0
    }

    /// Returns whether this film has fewer defects than `other`, regardless of overshoot.
    /// Disappearing counts more than any number of defects.
    #[must_use]
    pub fn has_fewer_defects_than(&self, other: &Self) -> bool {
        (self.disappears, self.defects()) < (other.disappears, other.defects())
    }

    /// Returns the turning of the outlines plus the change of area, beyond what the shapes at t = 0
    /// and t = 1 require, both as fractions; 0 if there is no excess.
    #[must_use]
    pub fn overshoot(&self) -> f64 {
        self.overshoot
    }

    /// Orders two ratings: `Less` if this one is better.
    #[must_use]
    pub fn compare(&self, other: &Self) -> Ordering {
        let by_disappearing = self.disappears.cmp(&other.disappears);
        let by_defects = self.defects().cmp(&other.defects());
        let by_overshoot = self.overshoot.total_cmp(&other.overshoot);
        by_disappearing.then(by_defects).then(by_overshoot)
    }

    /// Returns the index of the best rating, the first of several equal ones.
    ///
    /// Returns `None` if fewer than two films are rated.
    #[must_use]
    pub fn index_of_best(ratings: &[Option<Self>]) -> Option<usize> {
        let indexed = ratings.iter().enumerate();
        let rated: Vec<(usize, &Self)> = indexed
            .filter_map(|(k, rating)| Some((k, rating.as_ref()?)))
            .collect();
        let best = rated.iter().min_by(|(_, a), (_, b)| a.compare(b))?;
        (rated.len() > 1).then_some(best.0)
    }
}

impl fmt::Display for FilmRating {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let counts = [
            (self.folds, "face folds", "faces fold"),
            (self.crossings, "crossing", "crossings"),
            (self.extra_pieces, "extra piece", "extra pieces"),
            (self.extra_holes, "extra hole", "extra holes"),
        ];
        let nonzero = counts.into_iter().filter(|(count, ..)| *count > 0);
        let defects: Vec<String> = nonzero
            .map(|(count, one, many)| format!("{count} {}", if count == 1 { one } else { many }))
            .collect();
        f.write_str(
            &match (self.disappears, defects.is_empty(), self.is_solid) {
                (true, ..) => "disappears in between".to_owned(),
                (_, false, _) => defects.join(", "),
                (.., true) => "no folds, no crossings".to_owned(),
                (.., false) => "no extra pieces or holes".to_owned(),
            },
        )
    }
}

/// Builds a transition with each of the three methods for shapes, and returns the best one with its
/// rating.
///
/// The methods are rigid parts, distance fields carried by rigid parts, and distance fields
/// blended in place; of equal ratings the first wins. Pictures are built with the specified
/// method and are not rated.
///
/// # Errors
/// [`BuildError`] if the work was cancelled; if no method can be built, the error of the first one.
pub fn build_best_method(
    spec: &TransitionSpec,
    progress: &dyn Progress,
) -> Result<(Transition, Option<FilmRating>), BuildError> {
    if spec.method.content() == ContentKind::Colours {
        return Ok((Transition::build(spec, progress)?, None));
    }
    let carried = TransitionMethod::new(WarpKind::Arap, ContentKind::Field)?;
    let methods = [
        TransitionMethod::RIGID_PARTS,
        carried,
        TransitionMethod::FIELD_BLEND,
    ];
    let shares = ProgressShares::new(progress, methods.len());
    let mut built = Vec::new();
    let mut first_error = None;
    for (k, cell) in methods.into_iter().enumerate() {
        let spec = TransitionSpec {
            method: cell,
            ..spec.clone()
        };
        let share = shares.part(k);
        match Transition::build(&spec, &ProgressSpan::new(&share, 0.0, BUILT_FRACTION)) {
            Ok(transition) => {
                let rating_span = ProgressSpan::new(&share, BUILT_FRACTION, 1.0);
                let rating = FilmRating::of(&transition, &rating_span)?;
                built.push((transition, rating));
            }
            Err(error) if progress.is_cancelled() => return Err(error),
            Err(error) => first_error = first_error.or(Some(error)),
        }
    }
    let ratings: Vec<Option<FilmRating>> = built.iter().map(|(_, rating)| *rating).collect();
    let best = FilmRating::index_of_best(&ratings).unwrap_or(0);
    match (best < built.len(), first_error) {
        (true, _) => Ok(built.swap_remove(best)),
        (false, Some(error)) => Err(error),
        (false, None) => unreachable!("each method is built or fails"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rating(crossings: usize, extra_pieces: usize, overshoot: f64) -> FilmRating {
        FilmRating {
            folds: 0,
            crossings,
            extra_pieces,
            extra_holes: 0,
            disappears: false,
            overshoot,
            is_solid: extra_pieces == 0,
        }
    }

    #[test]
    fn defects_count_before_overshoot_and_disappearing_is_worst() {
        let (steady, overshooting) = (rating(0, 0, 0.1), rating(0, 0, 0.4));
        let (crossing, broken) = (rating(2, 0, 0.0), rating(0, 3, 0.0));
        let disappearing = FilmRating {
            disappears: true,
            ..steady
        };
        let mut all = [disappearing, broken, crossing, overshooting, steady];
        all.sort_by(FilmRating::compare);
        assert_eq!(all, [steady, overshooting, crossing, broken, disappearing]);
        let texts = [crossing, broken, disappearing, steady].map(|rating| rating.to_string());
        let expected = [
            "2 crossings",
            "3 extra pieces",
            "disappears in between",
            "no folds, no crossings",
        ];
        assert_eq!(texts, expected);
    }

    #[test]
    fn the_first_of_the_best_wins_if_at_least_two_are_rated() {
        let (a, b) = (rating(0, 0, 0.1), rating(1, 0, 0.0));
        assert_eq!(
            FilmRating::index_of_best(&[Some(b), None, Some(a), Some(a)]),
            Some(2)
        );
        assert_eq!(FilmRating::index_of_best(&[None, Some(a)]), None);
        assert_eq!(FilmRating::index_of_best(&[]), None);
    }
}

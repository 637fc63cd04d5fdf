//! How much trouble a film is, to hold one method against another.

use super::film_report::{FilmReport, film};
use crate::content::ContentKind;
use crate::transition::{BuildError, Transition, TransitionMethod, TransitionSpec};
use crate::warp::WarpKind;
use crate::work::progress::{Progress, ProgressShares, ProgressSpan};
use std::cmp::Ordering;
use std::fmt;

/// Samples of a film that is rated: what lasts for less than a sixteenth of it
/// tells little of a method.
const SAMPLES: usize = 17;

/// How much of a method is done once it is built.
const BUILT: f64 = 0.9;

/// How much trouble a film is. Of two, the lesser is the one with fewer things
/// that are wrong at its worst t; of two alike, the one whose outlines turn and
/// whose area changes less beyond what its ends need.
///
/// ```
/// use morphospace::measure::Rating;
/// use morphospace::{progress::Silent, project::gallery, transition::Transition};
///
/// let transition = Transition::build(&gallery::load("triangle-polar")?.spec()?, &Silent)?;
/// let rating = Rating::of(&transition, &Silent)?.expect("a solid");
/// assert_eq!(rating.to_string(), "no folds, no crossings");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FilmRating {
    folds: usize,
    crossings: usize,
    /// Pieces and holes that neither design has.
    pieces: usize,
    holes: usize,
    /// Nothing is left of it.
    is_gone: bool,
    /// Turning and area beyond the ends, as shares.
    unrest: f64,
    is_solid: bool,
}

impl FilmRating {
    /// A look at a film; none of pictures, of which nothing is measured.
    ///
    /// # Errors
    /// [`Cancelled`](crate::progress::Cancelled) if nobody wants it any more.
    pub fn of(
        transition: &Transition,
        progress: &dyn Progress,
    ) -> Result<Option<Self>, crate::work::progress::Cancelled> {
        let content = transition.cell().content();
        if content == ContentKind::Colours {
            return Ok(None);
        }
        let report = film(transition, SAMPLES, progress)?;
        Ok(Some(Self::of_report(&report, content)))
    }

    /// What a look that was taken comes to, at as many moments as it has.
    #[must_use]
    pub fn of_report(report: &FilmReport, content: ContentKind) -> Self {
        let inner = report.samples.iter();
        Self {
            folds: report.worst_folds.unwrap_or(0),
            crossings: report.worst_crossings.unwrap_or(0),
            pieces: report.pieces_excess.unwrap_or(0),
            holes: report.holes_excess.unwrap_or(0),
            is_gone: inner.clone().any(|sample| sample.area <= 0.0),
            unrest: report.turning_excess + report.area_variation_excess,
            is_solid: content == ContentKind::Solid,
        }
    }

    fn faults(&self) -> usize {
        self.folds + self.crossings + self.pieces + self.holes
    }

    /// Nothing is wrong with it.
    #[must_use]
    pub fn is_flawless(&self) -> bool {
        !self.is_gone && self.faults() == 0
    }

    /// Less is wrong with it, however calm the two are.
    #[must_use]
    pub fn has_fewer_faults_than(&self, other: &Self) -> bool {
        (self.is_gone, self.faults()) < (other.is_gone, other.faults())
    }

    /// Turning and change of area beyond what the ends need, as shares.
    #[must_use]
    pub fn unrest(&self) -> f64 {
        self.unrest
    }

    /// Which of two is less trouble.
    #[must_use]
    pub fn compare(&self, other: &Self) -> Ordering {
        let gone = self.is_gone.cmp(&other.is_gone);
        let faults = self.faults().cmp(&other.faults());
        gone.then(faults).then(self.unrest.total_cmp(&other.unrest))
    }

    /// The number of the one with the least trouble, the first of several; none
    /// where there are not two to choose from.
    #[must_use]
    pub fn best(ratings: &[Option<Self>]) -> Option<usize> {
        let known = ratings.iter().enumerate();
        let known: Vec<(usize, &Self)> = known
            .filter_map(|(k, rating)| Some((k, rating.as_ref()?)))
            .collect();
        let best = known.iter().min_by(|(_, a), (_, b)| a.compare(b))?;
        (known.len() > 1).then_some(best.0)
    }
}

impl fmt::Display for FilmRating {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let counts = [
            (self.folds, "face folds", "faces fold"),
            (self.crossings, "crossing", "crossings"),
            (self.pieces, "piece too many", "pieces too many"),
            (self.holes, "hole too many", "holes too many"),
        ];
        let told = counts.into_iter().filter(|(count, ..)| *count > 0);
        let told: Vec<String> = told
            .map(|(count, one, many)| format!("{count} {}", if count == 1 { one } else { many }))
            .collect();
        f.write_str(&match (self.is_gone, told.is_empty(), self.is_solid) {
            (true, ..) => "vanishes on the way".to_owned(),
            (_, false, _) => told.join(", "),
            (.., true) => "no folds, no crossings".to_owned(),
            (.., false) => "nothing tears".to_owned(),
        })
    }
}

/// Builds two designs by each cell that could suit shapes (rigid parts, fields
/// that rigid parts carry, fields that blend where they are), and keeps the one
/// whose film is the least trouble, the first of several, with its rating.
/// Pictures are built as the specification has them, and not rated.
///
/// # Errors
/// [`BuildError`] where none can be built: why the first cannot; and on a
/// cancel.
pub fn auto(
    spec: &TransitionSpec,
    progress: &dyn Progress,
) -> Result<(Transition, Option<FilmRating>), BuildError> {
    if spec.cell.content() == ContentKind::Colours {
        return Ok((Transition::build(spec, progress)?, None));
    }
    let carried = TransitionMethod::new(WarpKind::Arap, ContentKind::Field)?;
    let cells = [
        TransitionMethod::RIGID_PARTS,
        carried,
        TransitionMethod::FIELD_BLEND,
    ];
    let shares = ProgressShares::new(progress, cells.len());
    let mut built = Vec::new();
    let mut failed = None;
    for (k, cell) in cells.into_iter().enumerate() {
        let spec = TransitionSpec {
            cell,
            ..spec.clone()
        };
        let share = shares.part(k);
        match Transition::build(&spec, &ProgressSpan::new(&share, 0.0, BUILT)) {
            Ok(transition) => {
                let rating = FilmRating::of(&transition, &ProgressSpan::new(&share, BUILT, 1.0))?;
                built.push((transition, rating));
            }
            Err(error) if progress.is_cancelled() => return Err(error),
            Err(error) => failed = failed.or(Some(error)),
        }
    }
    let ratings: Vec<Option<FilmRating>> = built.iter().map(|(_, rating)| *rating).collect();
    let best = FilmRating::best(&ratings).unwrap_or(0);
    match (best < built.len(), failed) {
        (true, _) => Ok(built.swap_remove(best)),
        (false, Some(error)) => Err(error),
        (false, None) => unreachable!("each cell is built or fails"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rating(crossings: usize, pieces: usize, unrest: f64) -> FilmRating {
        FilmRating {
            folds: 0,
            crossings,
            pieces,
            holes: 0,
            is_gone: false,
            unrest,
            is_solid: pieces == 0,
        }
    }

    #[test]
    fn faults_count_before_unrest_and_nothing_is_worst() {
        let (calm, restless) = (rating(0, 0, 0.1), rating(0, 0, 0.4));
        let (crossed, torn) = (rating(2, 0, 0.0), rating(0, 3, 0.0));
        let gone = FilmRating {
            is_gone: true,
            ..calm
        };
        let mut all = [gone, torn, crossed, restless, calm];
        all.sort_by(FilmRating::compare);
        assert_eq!(all, [calm, restless, crossed, torn, gone]);
        let words = [crossed, torn, gone, calm].map(|rating| rating.to_string());
        let wanted = [
            "2 crossings",
            "3 pieces too many",
            "vanishes on the way",
            "no folds, no crossings",
        ];
        assert_eq!(words, wanted);
    }

    #[test]
    fn the_first_of_the_best_is_chosen_where_there_is_a_choice() {
        let (a, b) = (rating(0, 0, 0.1), rating(1, 0, 0.0));
        assert_eq!(
            FilmRating::best(&[Some(b), None, Some(a), Some(a)]),
            Some(2)
        );
        assert_eq!(FilmRating::best(&[None, Some(a)]), None);
        assert_eq!(FilmRating::best(&[]), None);
    }
}

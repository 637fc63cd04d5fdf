//! Check of a film: finds its defects with their place, cause and remedy, and describes them in
//! words.
//!
//! Every cause is a measured fact about the place of the worst defect: an angle, a boundary
//! stretch, an overlap. A remedy that changes an option was tested on the same designs at the same
//! t; pins and edits of vertices cannot be tested and are only suggested. Every reported defect was
//! found at a sampled t. Defects between samples are missed, and a cause need not be the only one.
//!
//! - `defect_scan`: counts defects at each sampled t
//! - `cause`: finds the cause of a defect of rigid parts
//! - `solid`, `field`, `plane`: defects of solids, of distance fields, and of warps of the plane
//! - `remedy`: tests changed options
//! - `finding`, `sentences`: the data of a finding, and its text

mod cause;
mod defect_scan;
mod field;
mod finding;
mod plane;
mod remedy;
mod sentences;
mod solid;
#[cfg(test)]
mod tests;

pub use finding::{Finding, FindingCause, FindingKind, Remedy, SettingChange};

use crate::content::Content;
use crate::measure::film_report::FilmReport;
use crate::transition::{Transition, TransitionNote};
use crate::work::progress::{Cancelled, OverallProgress, Progress, ProgressSpan};
use defect_scan::MomentCounts;
use serde::Serialize;

/// Result of checking a film: its defects. [`Self::headline`] lists them in words.
///
/// The notes of the transition are included, but do not count as defects.
///
/// ```
/// use morphospace::measure::Verdict;
/// use morphospace::{project::gallery, transition::Transition, work::progress::Silent};
///
/// let spec = gallery::load("triangle-polar")?.spec()?;
/// let verdict = Verdict::of(&Transition::build(&spec, &Silent)?, 65, &Silent)?;
/// assert_eq!(verdict.headline(), "no folds, no crossings");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Verdict {
    /// Number of t at which defects were counted; 0 for pictures.
    pub steps: usize,
    /// Headline if no defects were found. It depends on the kind of content.
    pub clear: &'static str,
    /// Defects, at most one of each kind, folds first.
    pub findings: Vec<Finding>,
    /// Notes of the transition: deviations from the requested options, and suggestions.
    pub notes: Vec<TransitionNote>,
}

/// Minimum number of t at which a warp of the plane is checked for folds (heuristic).
const PLANE_STEPS: usize = 33;

impl Verdict {
    /// Checks a transition at `steps` evenly spaced t, at least 2.
    ///
    /// If there are defects, changed options are tested, each at the cost of one more scan of the
    /// film. On large meshes options are not tested.
    ///
    /// # Errors
    /// [`Cancelled`] if the work was cancelled.
    pub fn of(
        transition: &Transition,
        steps: usize,
        progress: &dyn Progress,
    ) -> Result<Self, Cancelled> {
        let overall = OverallProgress::new(progress);
        let moments = defect_scan::scan_transition(
            transition,
            steps,
            &ProgressSpan::new(&overall, 0.0, 0.4),
        )?;
        Self::of_moments(transition, &moments, &ProgressSpan::new(&overall, 0.4, 1.0))
    }

    /// Checks a film that has already been measured.
    ///
    /// # Errors
    /// [`Cancelled`] if the work was cancelled.
    pub fn of_film(
        transition: &Transition,
        film: &FilmReport,
        progress: &dyn Progress,
    ) -> Result<Self, Cancelled> {
        let moments: Vec<_> = film.samples.iter().map(MomentCounts::of_sample).collect();
        Self::of_moments(transition, &moments, &OverallProgress::new(progress))
    }

    fn of_moments(
        transition: &Transition,
        moments: &[MomentCounts],
        progress: &dyn Progress,
    ) -> Result<Self, Cancelled> {
        let content_progress = &ProgressSpan::new(progress, 0.0, 0.8);
        let (clear, mut findings) = match transition.content() {
            Content::Solid(solid) => (
                match (solid.loops.is_empty(), transition.compatible()) {
                    (true, _) => "no folds",
                    (false, Some(_)) => "no folds, no crossings",
                    (false, None) => "no crossings",
                },
                solid::solid_findings(transition, solid, moments, content_progress)?,
            ),
            Content::Field(fields) => (
                "no extra pieces or holes",
                field::field_findings(transition, fields.first_pair(), moments, content_progress)?,
            ),
            Content::Colours(_) => ("no folds", Vec::new()),
        };
        // For pictures, `moments` is empty. At least [`PLANE_STEPS`] t are checked, because a fold
        // of the plane may last only a short time.
        let steps = moments.len().max(PLANE_STEPS);
        let plane_progress = ProgressSpan::new(progress, 0.8, 1.0);
        findings.extend(plane::plane_findings(transition, steps, &plane_progress)?);
        Ok(Self {
            steps: moments.len(),
            clear,
            findings,
            notes: transition.notes().to_vec(),
        })
    }

    /// Returns all findings in one line, or [`Self::clear`] if there are none.
    #[must_use]
    pub fn headline(&self) -> String {
        if self.is_clear() {
            return self.clear.to_owned();
        }
        let findings: Vec<_> = self.findings.iter().map(Finding::headline).collect();
        findings.join("; ")
    }

    /// Returns whether no defects were found.
    #[must_use]
    pub fn is_clear(&self) -> bool {
        self.findings.is_empty()
    }
}

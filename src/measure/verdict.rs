//! A film in words: what goes wrong, where, why, and what helps.
//!
//! Every cause is a measured fact about the place where the trouble is worst:
//! an angle, a stretch of the boundary, an overlap. A remedy that changes an
//! option was tried on the same designs at the same t, and says what it
//! leaves; pins and edits, which cannot be tried, are named with their place.
//! Guaranteed: what is said was seen at one of the steps. Not guaranteed:
//! anything between two steps, or that a cause is the only one.
//!
//! - `scan`: at each t, how much is wrong
//! - `cause`: rigid parts at the t of a trouble, and the facts about it
//! - `solid`, `field`, `plane`: what is found in rigid parts and boundaries, in
//!   fields, and with warps of the plane
//! - `remedy`: what was tried
//! - `finding`, `words`: what can be found, and how it is said

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
use crate::work::progress::{Cancelled, Progress, ProgressSpan, WholeProgress};
use defect_scan::MomentCounts;
use serde::Serialize;

/// What is wrong with a film; see [`Self::headline`]. What is noted of how it
/// was made is told, but is no trouble.
///
/// ```
/// use morphospace::measure::Verdict;
/// use morphospace::{progress::Silent, project::gallery, transition::Transition};
///
/// let spec = gallery::load("triangle-polar")?.spec()?;
/// let verdict = Verdict::of(&Transition::build(&spec, &Silent)?, 65, &Silent)?;
/// assert_eq!(verdict.headline(), "no folds, no crossings");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Verdict {
    /// At how many t the film was looked at.
    pub steps: usize,
    /// What can be said where nothing was found.
    pub clear: &'static str,
    /// What was found, one of each kind of trouble, folds first.
    pub findings: Vec<Finding>,
    /// What was done otherwise than asked while the film was made.
    pub notes: Vec<TransitionNote>,
}

/// At how many t warps of the plane are looked at where nothing else is
/// measured.
const PLANE_STEPS: usize = 33;

impl Verdict {
    /// Looks at a transition at `steps` evenly spaced t, at least 2. Where
    /// something is wrong, options are tried, each at the cost of another
    /// look; not for more than some thousand faces.
    ///
    /// # Errors
    /// [`Cancelled`] if nobody wants the result any more.
    pub fn of(
        transition: &Transition,
        steps: usize,
        progress: &dyn Progress,
    ) -> Result<Self, Cancelled> {
        let whole = WholeProgress::new(progress);
        let glances =
            defect_scan::transition(transition, steps, &ProgressSpan::new(&whole, 0.0, 0.4))?;
        Self::of_glances(transition, &glances, &ProgressSpan::new(&whole, 0.4, 1.0))
    }

    /// The verdict on a film that has been measured already.
    ///
    /// # Errors
    /// [`Cancelled`] if nobody wants the result any more.
    pub fn of_film(
        transition: &Transition,
        film: &FilmReport,
        progress: &dyn Progress,
    ) -> Result<Self, Cancelled> {
        let glances: Vec<_> = film.samples.iter().map(MomentCounts::of_sample).collect();
        Self::of_glances(transition, &glances, &WholeProgress::new(progress))
    }

    fn of_glances(
        transition: &Transition,
        glances: &[MomentCounts],
        progress: &dyn Progress,
    ) -> Result<Self, Cancelled> {
        let of_content = &ProgressSpan::new(progress, 0.0, 0.8);
        let (clear, mut findings) = match transition.content() {
            Content::Solid(solid) => (
                match (solid.loops.is_empty(), transition.compatible()) {
                    (true, _) => "no folds",
                    (false, Some(_)) => "no folds, no crossings",
                    (false, None) => "no crossings",
                },
                solid::findings(transition, solid, glances, of_content)?,
            ),
            Content::Field(fields) => (
                "no more pieces or holes than at the ends",
                field::findings(transition, fields.first(), glances, of_content)?,
            ),
            Content::Colours(_) => ("no folds", Vec::new()),
        };
        // Pictures have no glances, and a fold of the plane may be short.
        let steps = glances.len().max(PLANE_STEPS);
        let of_plane = ProgressSpan::new(progress, 0.8, 1.0);
        findings.extend(plane::findings(transition, steps, &of_plane)?);
        Ok(Self {
            steps: glances.len(),
            clear,
            findings,
            notes: transition.notes().to_vec(),
        })
    }

    /// Everything that was found on one line, or that nothing was.
    #[must_use]
    pub fn headline(&self) -> String {
        if self.is_clear() {
            return self.clear.to_owned();
        }
        let findings: Vec<_> = self.findings.iter().map(Finding::headline).collect();
        findings.join("; ")
    }

    /// Whether nothing was found.
    #[must_use]
    pub fn is_clear(&self) -> bool {
        self.findings.is_empty()
    }
}

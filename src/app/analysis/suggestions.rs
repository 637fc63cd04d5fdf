//! Suggestions: when the film has defects, tries changes of the settings in the background and
//! offers those that reduce the defects. The remedies of the findings are tried first.
//!
//! The film of each change is built and rated exactly as the film on the stage is. A suggestion is
//! offered together with the defects that remain.

use std::cmp::Ordering;
use std::sync::mpsc::{Receiver, Sender, channel};
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

use bevy::prelude::{DetectChangesMut, MessageReader, Res, ResMut, Resource};

use crate::app::analysis::film_measures::{
    FILM_SAMPLES, FilmMeasures, StageMeasures, measure_film,
};
use crate::app::analysis::is_same;
use crate::app::input::gesture::Gesture;
use crate::app::input::intent::Intent;
use crate::app::jobs::job::BackgroundJob;
use crate::app::session::state::Session;
use crate::content::ContentKind;
use crate::correspondence::{HoleRule, PartRule};
use crate::measure::{FilmRating, FilmReport, Finding, FindingKind, Remedy, Verdict, film_report};
use crate::project::{LoadedProject, Project, ProjectError};
use crate::settings::Choice;
use crate::transition::{BuildError, DesignFit, Transition, TransitionMethod};
use crate::warp::WarpKind;
use crate::work::progress::{Progress, check_cancelled};

/// Time from the discovery of defects to the start of the search, so that nothing is tried during a
/// drag (heuristic).
const SEARCH_DELAY: Duration = Duration::from_millis(800);

/// Maximum number of suggestions (heuristic: they share one line).
const MAX_SUGGESTIONS: usize = 3;

/// Maximum overshoot that a suggestion may add to the film. Overshoot is the sum of two fractions:
/// the excess of the turning over its values interpolated between the designs, and the excess of
/// the total change of area over the difference between the designs' areas. Without this limit, a
/// change that lets all parts appear and disappear would be offered, although hardly anything of
/// the designs is visible halfway (heuristic).
const MAX_ADDED_OVERSHOOT: f64 = 0.2;

/// Value added to the overshoot of a suggestion that mirrors or rotates the target. It ranks the
/// suggestion below similar ones that keep the target as drawn (heuristic).
const CHANGED_TARGET_PENALTY: f64 = 0.25;

/// Whether a remedy is a change of settings that can be tried and applied with one click.
#[must_use]
pub fn is_one_click(remedy: &Remedy) -> bool {
    matches!(
        remedy,
        Remedy::Change { .. } | Remedy::Lattices | Remedy::LetFold
    )
}

/// Applies a remedy to the project's settings.
fn apply_remedy(project: &mut Project, remedy: &Remedy) {
    match remedy {
        Remedy::Change { change, .. } => change.apply(&mut project.options),
        Remedy::Lattices => {
            project.warp = Some(WarpKind::Lattice);
            project.options.lattice.fold_free = true;
        }
        Remedy::LetFold => project.options.lattice.fold_free = false,
        // All other remedies need a decision by the user, so `is_one_click` gives them no button.
        _ => {}
    }
}

/// Whether a remedy for `finding` helps, given the findings without and with it: the
/// defect becomes smaller, and no other kind of defect is new.
fn removes(finding: &Finding, before: &[Finding], after: &[Finding]) -> bool {
    let of_kind = |findings: &[Finding], kind: &FindingKind| -> Option<f64> {
        let same = findings.iter().map(|found| &found.trouble);
        let extents = same.filter(|found| found.is_same_kind(kind));
        extents.map(FindingKind::extent).reduce(f64::max)
    };
    let remaining = of_kind(after, &finding.trouble).unwrap_or(0.0);
    remaining < finding.trouble.extent()
        && after
            .iter()
            .all(|found| of_kind(before, &found.trouble).is_some())
}

/// A change of the settings that may remove defects.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SuggestedChange {
    /// Mirror the target.
    Mirror,
    /// Rotate the target counter-clockwise by this angle, in degrees.
    Turn(i32),
    /// Align the designs with each other by another rule.
    Fit(DesignFit),
    /// Use another rule for unmatched holes.
    Holes(HoleRule),
    /// Use another rule for unmatched parts.
    Parts(PartRule),
    /// Use another method.
    Method(TransitionMethod),
}

/// A change and the rating of the film it gives.
#[derive(Clone, Debug, PartialEq)]
pub struct Suggestion {
    /// The change of the settings.
    pub change: SuggestedChange,
    /// Rating of the resulting film.
    pub rating: FilmRating,
}

impl SuggestedChange {
    /// Returns the changes to try for a project, in order. Mirroring and rotating the target come
    /// last, because they change a design.
    fn all(loaded: &LoadedProject) -> Vec<Self> {
        let matching = &loaded.project.options.matching;
        let other_rules = PartRule::ALL
            .into_iter()
            .filter(|rule| *rule != matching.parts);
        let mut all: Vec<Self> = other_rules.map(Self::Parts).collect();
        if matching.holes != HoleRule::Auto {
            // `Auto` uses the best of the other rules, so those are not tried one by one.
            all.push(Self::Holes(HoleRule::Auto));
        }
        if matches!(loaded.project.fit, DesignFit::Auto | DesignFit::AsDrawn) {
            all.push(Self::Fit(DesignFit::Centred));
        }
        let methods = [
            (WarpKind::Arap, ContentKind::Solid),
            (WarpKind::Arap, ContentKind::Field),
            (WarpKind::None, ContentKind::Field),
        ];
        let methods = methods
            .into_iter()
            .filter_map(|(warp, content)| TransitionMethod::new(warp, content).ok());
        let current = loaded.method().ok();
        let is_available = |method: &TransitionMethod| {
            let can_build = loaded.check_available(method.warp(), method.content());
            Some(*method) != current && can_build.is_ok()
        };
        all.extend(methods.filter(is_available).map(Self::Method));
        // Pins and other points of the designs stay valid, because they move with the target.
        all.push(Self::Mirror);
        all.extend([180, 90, -90].map(Self::Turn));
        all
    }

    /// Whether the change mirrors or rotates the target.
    fn changes_the_target(self) -> bool {
        matches!(self, Self::Mirror | Self::Turn(_))
    }

    /// Applies the change to a project.
    pub fn apply(self, project: &mut Project) {
        match self {
            Self::Method(method) => {
                project.warp = Some(method.warp());
                project.content = Some(method.content());
            }
            Self::Fit(fit) => project.fit = fit,
            Self::Holes(holes) => project.options.matching.holes = holes,
            Self::Parts(parts) => project.options.matching.parts = parts,
            Self::Mirror | Self::Turn(_) => {
                let Some(target) = project.designs.get_mut(1) else {
                    return;
                };
                let place = &mut target.placement;
                match self {
                    Self::Turn(degrees) => place.rotation += f64::from(degrees).to_radians(),
                    _ => place.mirror = !place.mirror,
                }
            }
        }
    }

    /// Short label of the change.
    #[must_use]
    pub fn label(self) -> String {
        match self {
            Self::Mirror => "Flip the target".to_owned(),
            Self::Turn(degrees) => format!("Rotate the target by {degrees}°"),
            Self::Fit(fit) => format!("Align: {}", fit.name().title.to_lowercase()),
            Self::Holes(holes) => format!("Holes: {}", holes.name().title.to_lowercase()),
            Self::Parts(parts) => format!("Parts: {}", parts.name().title.to_lowercase()),
            Self::Method(method) => format!("Use {}", method.name()),
        }
    }
}

impl Suggestion {
    /// Whether the film of this suggestion has fewer defects than the film on the stage, whose
    /// rating is `now`, without much more overshoot.
    fn helps(&self, now: &FilmRating) -> bool {
        let is_within_limit = self.rating.overshoot() <= now.overshoot() + MAX_ADDED_OVERSHOOT;
        self.rating.has_fewer_defects_than(now) && is_within_limit
    }

    /// Order of suggestions: fewer defects first, then less overshoot, with a penalty for showing
    /// the target differently from how it was drawn.
    fn compare(&self, other: &Self) -> Ordering {
        let fewer = |a: &Self, b: &Self| a.rating.has_fewer_defects_than(&b.rating);
        let cost = |suggestion: &Self| {
            let changes = suggestion.change.changes_the_target();
            suggestion.rating.overshoot() + if changes { CHANGED_TARGET_PENALTY } else { 0.0 }
        };
        match (fewer(self, other), fewer(other, self)) {
            (true, _) => Ordering::Less,
            (_, true) => Ordering::Greater,
            _ => cost(self).total_cmp(&cost(other)),
        }
    }
}

/// Suggestions for the film on the stage.
#[derive(Resource, Debug, Default)]
pub struct Suggestions {
    /// The transition on the stage.
    transition: Option<Transition>,
    /// Time at which the film was found to have defects; the search starts [`SEARCH_DELAY`] later.
    since: Option<Instant>,
    search: Option<SuggestionJob>,
    /// Rating of the film on the stage.
    rating: Option<FilmRating>,
    /// Suggestions so far, best first.
    suggestions: Vec<Suggestion>,
    /// Remedies of the findings that were tried and help.
    remedies: Vec<Remedy>,
    is_done: bool,
}

/// A change that was tried and helps.
#[derive(Debug)]
enum HelpfulChange {
    Suggestion(Suggestion),
    Remedy(Remedy),
}

/// A running search for suggestions, which arrive through a channel.
#[derive(Debug)]
struct SuggestionJob {
    job: BackgroundJob<(), ProjectError>,
    receiver: Mutex<Receiver<HelpfulChange>>,
}

impl Suggestions {
    /// Suggestions found so far, the best one first; at most `MAX_SUGGESTIONS`.
    #[must_use]
    pub fn suggestions(&self) -> &[Suggestion] {
        &self.suggestions[..self.suggestions.len().min(MAX_SUGGESTIONS)]
    }

    /// Whether this remedy of a finding was tried and helps.
    #[must_use]
    pub fn offers(&self, remedy: &Remedy) -> bool {
        self.remedies.contains(remedy)
    }

    /// Whether a remedy of a finding was tried and helps.
    #[must_use]
    pub fn has_remedies(&self) -> bool {
        !self.remedies.is_empty()
    }

    /// Rating of the film on the stage, comparable with the ratings of the suggestions; `None`
    /// before the first search.
    #[must_use]
    pub fn current_rating(&self) -> Option<FilmRating> {
        self.rating
    }

    /// Whether a search is running or about to start.
    #[must_use]
    pub fn is_busy(&self) -> bool {
        self.search.is_some() || self.since.is_some()
    }

    /// Whether a search is running.
    #[must_use]
    pub fn is_trying(&self) -> bool {
        self.search.is_some()
    }

    /// Whether the search for this film has ended: all changes were tried, enough flawless films
    /// were found, or it was cancelled.
    #[must_use]
    pub fn is_done(&self) -> bool {
        self.is_done
    }

    /// Cancels the search; no other search starts for this film.
    pub fn stop(&mut self) {
        self.is_done |= self.is_busy();
        (self.search, self.since) = (None, None);
    }

    /// Starts a search for the film on the stage, given its measures.
    fn start(&mut self, session: &Session, measures: &FilmMeasures) {
        self.since = None;
        self.suggestions.clear();
        self.remedies.clear();
        let transition = self.transition.as_ref();
        self.rating = transition.and_then(|of| rating(of, &measures.film));
        let Some(staged) = session.staged_segment() else {
            self.is_done = true;
            return;
        };
        let (sender, receiver) = channel();
        let (rating, verdict) = (self.rating, measures.verdict.clone());
        let job = BackgroundJob::start("the search for suggestions", move |progress| {
            try_remedies(&staged, &verdict, &sender, progress)?;
            // Pictures have no rating by which other changes could be compared.
            rating.map_or(Ok(()), |now| try_all(&staged, &now, &sender, progress))
        });
        self.search = Some(SuggestionJob {
            job,
            receiver: Mutex::new(receiver),
        });
    }

    /// Collects new suggestions; returns whether a suggestion has arrived or the search has ended.
    fn collect_results(&mut self) -> bool {
        let Some(search) = &self.search else {
            return false;
        };
        // The job is polled before receiving, so that all suggestions sent before its end are in
        // the channel.
        let is_done = search.job.poll().is_some();
        let receiver = search
            .receiver
            .lock()
            .unwrap_or_else(PoisonError::into_inner);
        let received: Vec<HelpfulChange> = receiver.try_iter().collect();
        drop(receiver);
        let is_new = is_done || !received.is_empty();
        for change in received {
            match change {
                HelpfulChange::Suggestion(suggestion) => self.suggestions.push(suggestion),
                HelpfulChange::Remedy(remedy) => self.remedies.push(remedy),
            }
        }
        self.suggestions.sort_by(Suggestion::compare);
        if is_done {
            self.search = None;
            self.is_done = true;
        }
        is_new
    }
}

/// Rating of a film, from the same measures as the check for defects; `None` for pictures.
fn rating(transition: &Transition, film: &FilmReport) -> Option<FilmRating> {
    let content = transition.method().content();
    (content != ContentKind::Colours).then(|| FilmRating::of_report(film, content))
}

/// Builds and checks the film of each remedy of the findings that needs no further input; sends
/// those that help.
fn try_remedies(
    loaded: &LoadedProject,
    before: &Verdict,
    sender: &Sender<HelpfulChange>,
    progress: &dyn Progress,
) -> Result<(), ProjectError> {
    let mut tried: Vec<&Remedy> = Vec::new();
    for finding in &before.findings {
        let remedy = &finding.remedy;
        if !is_one_click(remedy) || tried.contains(&remedy) {
            continue;
        }
        tried.push(remedy);
        let mut other = loaded.clone();
        apply_remedy(&mut other.project, remedy);
        if other.project == loaded.project {
            continue;
        }
        let built = Transition::build(&other.spec()?, progress);
        check_cancelled(progress).map_err(BuildError::from)?;
        // A remedy whose film cannot be built does not help.
        let Ok(built) = built else {
            continue;
        };
        let measures = measure_film(&built, progress).map_err(BuildError::from)?;
        if removes(finding, &before.findings, &measures.verdict.findings) {
            // Sending fails once the search has been cancelled.
            sender.send(HelpfulChange::Remedy(remedy.clone())).ok();
        }
    }
    Ok(())
}

/// Builds and rates the film of each change. Sends a suggestion for each change that has fewer
/// defects than `now`, the rating of the film on the stage, without much more overshoot. Stops
/// early when enough films are flawless.
fn try_all(
    loaded: &LoadedProject,
    now: &FilmRating,
    sender: &Sender<HelpfulChange>,
    progress: &dyn Progress,
) -> Result<(), ProjectError> {
    let mut flawless = 0;
    for what in SuggestedChange::all(loaded) {
        let mut other = loaded.clone();
        what.apply(&mut other.project);
        let built = Transition::build(&other.spec()?, progress);
        check_cancelled(progress).map_err(BuildError::from)?;
        // A change whose film cannot be built is not suggested.
        let Ok(built) = built else {
            continue;
        };
        let report = film_report(&built, FILM_SAMPLES, progress).map_err(BuildError::from)?;
        let Some(rating) = rating(&built, &report) else {
            continue;
        };
        let suggestion = Suggestion {
            change: what,
            rating,
        };
        if suggestion.helps(now) {
            flawless += usize::from(rating.is_flawless());
            // Sending fails once the search has been cancelled.
            sender.send(HelpfulChange::Suggestion(suggestion)).ok();
        }
        if flawless >= MAX_SUGGESTIONS {
            break;
        }
    }
    Ok(())
}

/// Discards the suggestions when the stage changes, starts a search if the film has defects, and
/// collects new suggestions.
pub fn follow(
    session: Res<Session>,
    measured: Res<StageMeasures>,
    mut suggestions: ResMut<Suggestions>,
) {
    // This system runs in every screen update but seldom changes the resource. It bypasses Bevy's
    // change detection and reports changes itself.
    let now = suggestions.bypass_change_detection();
    let was_busy = now.is_busy();
    let transition = session.transition();
    if !is_same(now.transition.as_ref(), transition) {
        *now = Suggestions {
            transition: transition.cloned(),
            ..Suggestions::default()
        };
    }
    let defective = measured
        .measures()
        .filter(|measures| !measures.verdict.is_clear());
    // Changes apply to a pair of designs, so there are no suggestions for a path on the map.
    let is_pair = session
        .whole_project()
        .is_some_and(|project| !project.follows_path());
    match defective.filter(|_| is_pair && session.work().is_none()) {
        None => (now.search, now.since) = (None, None),
        Some(defective) if now.search.is_none() && !now.is_done => {
            let since = *now.since.get_or_insert_with(Instant::now);
            if since.elapsed() >= SEARCH_DELAY {
                now.start(&session, defective);
            }
        }
        Some(_) => {}
    }
    if now.collect_results() || now.is_busy() != was_busy {
        suggestions.set_changed();
    }
}

/// Applies a suggestion or a remedy chosen by the user; a remedy only if it was tried and helps.
pub fn apply(
    mut intents: MessageReader<Intent>,
    mut session: ResMut<Session>,
    measured: Res<StageMeasures>,
    suggestions: Res<Suggestions>,
    gesture: Res<Gesture>,
) {
    for intent in intents.read() {
        match *intent {
            Intent::ApplySuggestion(index) => {
                if let Some(suggestion) = suggestions.suggestions().get(index) {
                    session.change(gesture.id(), |project| suggestion.change.apply(project));
                }
            }
            Intent::ApplyRemedy(index) => {
                let findings = measured.measures().map(|m| &m.verdict.findings);
                let finding = findings.and_then(|all| all.get(index));
                if let Some(finding) = finding.filter(|of| suggestions.offers(&of.remedy)) {
                    session.change(gesture.id(), |project| {
                        apply_remedy(project, &finding.remedy);
                    });
                }
            }
            _ => {}
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::DVec2;
    use crate::measure::FindingCause;

    fn finding(trouble: FindingKind) -> Finding {
        Finding {
            trouble,
            t: 0.5,
            span: [0.5, 0.5],
            place: DVec2::ZERO,
            cause: FindingCause::Unclear,
            remedy: Remedy::Lattices,
        }
    }

    #[test]
    fn a_remedy_helps_if_its_defect_shrinks_and_no_other_kind_appears() {
        let share = |share: f64| finding(FindingKind::PlaneFolds { share });
        let missed = || finding(FindingKind::Missed { count: 1, by: 0.1 });
        let before = [share(0.2)];
        let helps = |after: &[Finding]| removes(&before[0], &before, after);
        assert!(helps(&[]) && helps(&[share(0.1)]));
        assert!(!helps(&[share(0.2)]), "nothing changes");
        assert!(!helps(&[missed()]), "the pins are missed instead");
        let both = [share(0.2), missed()];
        assert!(removes(&both[0], &both, &[missed()]), "it was there before");
    }
}

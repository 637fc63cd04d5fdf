//! The project that is open and the transition on the stage.
//!
//! Work that takes time runs beside the window: the stage shows the old transition until the new
//! one is ready, and keeps it where the new one cannot be had. While a build is running, newer
//! settings wait for it to end, so that a slider that is being dragged shows its way; a build that
//! takes long is given up for the newest settings.

use std::path::{Path, PathBuf};
use std::sync::{Arc, LazyLock};
use std::time::Duration;

use bevy::prelude::Resource;

use crate::app::jobs::job::JobError;
use crate::app::session::document::OpenDocument;
use crate::app::session::history::{ProjectSnapshot, UndoHistory};
use crate::app::session::load::{LoadError, LoadRequest, TransitionProblem};
use crate::app::session::save::SaveError;
use crate::app::session::transition_work::TransitionWork;
use crate::app::session::unsaved_project::UnsavedProject;
use crate::content::ContentKind;
use crate::design::{Design, DesignForm};
use crate::geometry::Bounds;
use crate::project::{LoadedProject, Project, ProjectError};
use crate::transition::{
    BuildError, Sequence, Timing, Transition, TransitionStop, TransitionStyle, segment_at, style_of,
};
use crate::warp::{Arap, WarpKind};

/// What [`Session::poll`] found.
#[derive(Debug)]
pub enum WorkOutcome {
    /// Another project is open; [`Session::problem`] tells why, where it has no transition.
    Opened,
    /// The open project has a new transition.
    Rebuilt,
    /// The settings make no transition, the old one stays; [`Session::problem`] tells why.
    NotRebuilt,
    /// It did not work.
    Failed(JobError<LoadError>),
}

/// Why a method cannot be had.
#[derive(Debug, thiserror::Error)]
pub enum MethodUnavailable {
    /// There is nothing to show by it.
    #[error("no project is open")]
    NothingOpen,
    /// The designs are not of its kind.
    #[error(transparent)]
    Designs(#[from] BuildError),
}

/// The project that is open, its transition, and the work on the next one.
#[derive(Resource, Debug, Default)]
pub struct Session {
    open: Option<OpenDocument>,
    work: Option<TransitionWork>,
    is_stale: bool,
}

/// What is done sooner is not worth a word: while a slider or a pin is dragged, one build follows
/// the other.
const WORTH_A_WORD: Duration = Duration::from_millis(300);

/// What is told of the work once its draft can be played.
const IMPROVING: &str = "improving the film";

static NO_TIMING: LazyLock<Timing> = LazyLock::new(Timing::default);

/// What is open.
impl Session {
    /// The leg that is looked at with all its settings: two designs, of a project that may have
    /// more.
    #[must_use]
    pub fn project(&self) -> Option<&Project> {
        self.open.as_ref().map(OpenDocument::seen)
    }

    /// The open project with all its legs.
    #[must_use]
    pub fn whole(&self) -> Option<&Project> {
        self.open.as_ref().map(|open| &open.loaded.project)
    }

    /// The open project, as it is now, with all its designs.
    #[must_use]
    pub fn whole_loaded(&self) -> Option<LoadedProject> {
        self.open.as_ref().map(|open| open.loaded.clone())
    }

    /// The designs of the leg that is looked at as their files have them.
    #[must_use]
    pub fn designs(&self) -> Vec<&Arc<Design>> {
        let open = self.open.as_ref();
        open.map_or_else(Vec::new, |open| open.designs().to_vec())
    }

    /// All designs as their files have them.
    #[must_use]
    pub fn all_designs(&self) -> &[Arc<Design>] {
        let open = self.open.as_ref();
        open.map_or(&[], |open| &open.loaded.designs)
    }

    /// The names of the designs that the film comes by, at each whole t.
    #[must_use]
    pub fn names_on_the_way(&self) -> Vec<String> {
        self.open.as_ref().map_or_else(Vec::new, |open| {
            let whole = open.whole_on_stage();
            let names = whole.names_on_the_way().into_iter();
            names.map(str::to_owned).collect()
        })
    }

    /// The transition on the stage, of the leg that is looked at.
    #[must_use]
    pub fn transition(&self) -> Option<&Transition> {
        self.open.as_ref()?.transition()
    }

    /// All transitions on the stage, where there is one of each leg.
    #[must_use]
    pub fn sequence(&self) -> Option<Sequence> {
        self.open.as_ref()?.sequence()
    }

    /// The box that holds every frame of what is on the stage, nearly.
    #[must_use]
    pub fn bounds(&self) -> Option<Bounds> {
        self.open.as_ref()?.bounds()
    }

    /// The number of the leg that is looked at, from 0.
    #[must_use]
    pub fn leg(&self) -> usize {
        self.open.as_ref().map_or(0, OpenDocument::leg)
    }

    /// How many legs there are.
    #[must_use]
    pub fn leg_count(&self) -> usize {
        self.whole().map_or(1, Project::leg_count)
    }

    /// Where in the leg that is looked at a t of the whole is.
    #[must_use]
    pub fn within(&self, t: f64) -> f64 {
        t - self.leg() as f64
    }

    /// The t of the whole that is there in the leg that is looked at.
    #[must_use]
    pub fn beyond(&self, within: f64) -> f64 {
        within + self.leg() as f64
    }

    /// The leg of what is on the stage that is shown at a t.
    #[must_use]
    pub fn leg_at(&self, t: f64) -> usize {
        let legs = self.open.as_ref().map_or(1, OpenDocument::leg_count);
        segment_at(legs, t).0
    }

    /// Looks at another leg.
    pub fn look_at(&mut self, leg: usize) {
        if let Some(open) = &mut self.open {
            open.look_at(leg);
        }
    }

    /// The settings that the transition on the stage was built from.
    #[must_use]
    pub fn staged_settings(&self) -> Option<&Project> {
        let stage = self.open.as_ref()?.stage()?;
        Some(&stage.settings.pair)
    }

    /// Two designs with the settings that the transition on the stage was built from.
    #[must_use]
    pub fn staged(&self) -> Option<LoadedProject> {
        let open = self.open.as_ref()?;
        open.stage()?;
        Some(open.leg_on_stage())
    }

    /// Why the settings, as they are now, make no transition.
    #[must_use]
    pub fn problem(&self) -> Option<&TransitionProblem> {
        self.open.as_ref()?.problem()
    }

    /// How time runs.
    #[must_use]
    pub fn timing(&self) -> &Timing {
        self.whole().map_or(&NO_TIMING, |project| &project.timing)
    }

    /// How the open project is painted.
    #[must_use]
    pub fn style(&self) -> TransitionStyle {
        self.whole()
            .map_or_else(TransitionStyle::default, |p| p.style)
    }

    /// How the leg that is looked at is painted.
    #[must_use]
    pub fn style_here(&self) -> TransitionStyle {
        style_of(self.leg(), self.way(), &self.style())
    }

    /// How many legs there are, and whether they lead back.
    #[must_use]
    pub fn way(&self) -> (usize, bool) {
        let leads_back = self.whole().is_some_and(Project::leads_back);
        (self.leg_count(), leads_back)
    }

    /// The stops of the open project.
    #[must_use]
    pub fn stops(&self) -> &[TransitionStop] {
        self.whole().map_or(&[], |project| &project.stops)
    }

    /// The file that the project is saved to.
    #[must_use]
    pub fn path(&self) -> Option<&Path> {
        self.open.as_ref()?.path()
    }

    /// The bundled project that is open.
    #[must_use]
    pub fn gallery_name(&self) -> Option<&str> {
        self.open.as_ref()?.gallery_name()
    }

    /// The files that its designs were read from.
    #[must_use]
    pub fn files(&self) -> Vec<PathBuf> {
        self.open
            .as_ref()
            .map_or_else(Vec::new, OpenDocument::files)
    }

    /// What the open project is called.
    #[must_use]
    pub fn title(&self) -> String {
        self.open
            .as_ref()
            .map_or_else(String::new, OpenDocument::title)
    }

    /// What files that belong to the project are called.
    #[must_use]
    pub fn file_stem(&self) -> String {
        let open = self.open.as_ref();
        open.map_or_else(|| "untitled".to_owned(), OpenDocument::file_stem)
    }

    /// Whether the open designs can be shown by this cell; otherwise why not.
    ///
    /// # Errors
    /// The reason, for a grey button.
    pub fn available(&self, warp: WarpKind, content: ContentKind) -> Result<(), MethodUnavailable> {
        let open = self.open.as_ref().ok_or(MethodUnavailable::NothingOpen)?;
        for leg in open.whole_on_stage().legs() {
            leg.available(warp, content)?;
        }
        Ok(())
    }

    /// How many parts can turn on their own.
    #[must_use]
    pub fn parts(&self) -> usize {
        let arap = self.transition().and_then(Transition::arap);
        arap.map_or(0, Arap::part_count)
    }

    /// Some design is a truss.
    #[must_use]
    pub fn has_bars(&self) -> bool {
        let mut designs = self.all_designs().iter();
        designs.any(|design| matches!(design.form, DesignForm::Truss(_)))
    }

    /// Some design names its own colours.
    #[must_use]
    pub fn has_paints(&self) -> bool {
        let is_painted = |design: &Arc<Design>| match &design.form {
            DesignForm::Truss(truss) => !truss.parts().colours.is_empty(),
            _ => !design.coats.is_empty(),
        };
        self.all_designs().iter().any(is_painted)
    }

    /// Both designs are outlines: there is something to match. On a path over the map all are
    /// matched with all.
    #[must_use]
    pub fn can_match(&self) -> bool {
        let pair = self.designs();
        !self.whole().is_some_and(Project::follows_path)
            && !pair.is_empty()
            && pair
                .iter()
                .all(|d| matches!(d.form, DesignForm::Outline(_)))
    }
}

/// Its changes.
impl Session {
    /// There are changes that are not saved.
    #[must_use]
    pub fn is_dirty(&self) -> bool {
        self.open.as_ref().is_some_and(OpenDocument::is_dirty)
    }

    /// Two designs that were opened together are open, as they came.
    #[must_use]
    pub fn is_new_pair(&self) -> bool {
        self.open.as_ref().is_some_and(OpenDocument::is_new_pair)
    }

    /// The film on the stage is by the method that is asked for, be it as a draft.
    #[must_use]
    pub fn has_film(&self) -> bool {
        let is_by_it = |work: &TransitionWork| work.has_draft;
        self.transition().is_some() && self.work.as_ref().is_none_or(is_by_it)
    }

    /// The open project was taken up again after the program had ended without saving it.
    #[must_use]
    pub fn is_rescued(&self) -> bool {
        self.open.as_ref().is_some_and(|open| open.is_rescued)
    }

    /// Something else is being opened.
    #[must_use]
    pub fn is_opening(&self) -> bool {
        let work = self.work.as_ref();
        work.is_some_and(|work| work.origin.is_some())
    }

    /// What is to be kept of the open project until it is saved.
    ///
    /// # Errors
    /// A project cannot be written as text.
    #[must_use]
    pub fn kept(&self) -> Option<Result<UnsavedProject, ProjectError>> {
        self.open.as_ref().map(OpenDocument::kept)
    }

    /// What to ask about them.
    #[must_use]
    pub fn unsaved_text(&self) -> String {
        format!("“{}” has changes that are not saved.", self.title())
    }

    /// Takes the changes for saved.
    pub fn forget_changes(&mut self) {
        if let Some(open) = &mut self.open {
            open.forget_changes();
        }
    }

    /// Changes the open project, as the leg that is looked at has it: what is said of its two
    /// designs is changed there, all else for all legs. Changes of one mark are one step of its
    /// history.
    pub fn change(&mut self, mark: Option<u64>, edit: impl FnOnce(&mut Project)) {
        let Some(open) = &mut self.open else {
            return;
        };
        // A copy, so that an edit that comes to nothing is no step of the history.
        let mut changed = open.seen().clone();
        edit(&mut changed);
        if changed != *open.seen() {
            open.edit_leg(changed, mark);
            self.look();
        }
    }

    /// Changes the open project as a whole.
    pub fn change_whole(&mut self, mark: Option<u64>, edit: impl FnOnce(&mut Project)) {
        let Some(open) = &mut self.open else {
            return;
        };
        let mut changed = open.loaded.project.clone();
        edit(&mut changed);
        if changed != open.loaded.project {
            open.edit(changed, mark);
            self.look();
        }
    }

    /// Looks whether the settings, which have changed, make another transition than that which is
    /// on the stage or on its way there.
    fn look(&mut self) {
        let Some(open) = &mut self.open else {
            return;
        };
        self.is_stale = open.is_stale();
        let building = self.work.take_if(|work| work.origin.is_none());
        // Where the stage shows again what is asked for, nobody waits for another.
        if let Some(work) = building.filter(|_| self.is_stale) {
            self.is_stale = work.is_not_of(&open.loaded.project);
            self.work = Some(work);
        }
    }

    /// There is a change to take back.
    #[must_use]
    pub fn can_undo(&self) -> bool {
        self.open.as_ref().is_some_and(|o| o.history.can_undo())
    }

    /// There is a change to make again.
    #[must_use]
    pub fn can_redo(&self) -> bool {
        self.open.as_ref().is_some_and(|o| o.history.can_redo())
    }

    /// Takes the last change back; `false` where there is none.
    ///
    /// # Errors
    /// A bundled design that it names cannot be written; the project is as it was.
    pub fn undo(&mut self) -> Result<bool, SaveError> {
        self.go(UndoHistory::undo)
    }

    /// Makes the change again that was taken back last; `false` where there is none.
    ///
    /// # Errors
    /// As [`undo`](Self::undo).
    pub fn redo(&mut self) -> Result<bool, SaveError> {
        self.go(UndoHistory::redo)
    }

    fn go(
        &mut self,
        step: impl FnOnce(&mut UndoHistory) -> Option<ProjectSnapshot>,
    ) -> Result<bool, SaveError> {
        let Some(open) = &mut self.open else {
            return Ok(false);
        };
        let is_gone = open.go(step)?;
        if is_gone {
            self.look();
        }
        Ok(is_gone)
    }

    /// Writes the project to its file, or to another, which is its file from then on.
    ///
    /// # Errors
    /// There is nothing to write, or it cannot be written; the project is as it was.
    pub fn save(&mut self, to: Option<&Path>) -> Result<PathBuf, SaveError> {
        let path = to.or(self.path()).map(Path::to_owned);
        let (Some(open), Some(path)) = (&mut self.open, path) else {
            return Err(SaveError::NothingOpen);
        };
        open.save(path.clone())?;
        Ok(path)
    }
}

/// The work on the next transition.
impl Session {
    /// What is being worked on and how far it is.
    #[must_use]
    pub fn work(&self) -> Option<(&'static str, f64)> {
        self.work.as_ref().map(|work| work.job.progress())
    }

    /// The work, once it is worth a word.
    #[must_use]
    pub fn told_work(&self) -> Option<(&'static str, f64)> {
        let work = self.work.as_ref()?;
        let (stage, share) = work.job.progress();
        let stage = if work.has_draft { IMPROVING } else { stage };
        (work.job.lasts() > WORTH_A_WORD).then_some((stage, share))
    }

    /// Builds what would take very long, which was refused for that, and from now on whatever is
    /// asked for of this project.
    pub fn insist(&mut self) {
        if let Some(open) = &mut self.open {
            open.loaded.patient = true;
            // It is tried again, and says anew what is wrong.
            open.forget_problems();
            self.is_stale = true;
        }
    }

    /// Reads the designs of the open project again.
    pub fn reread(&mut self) {
        if let Some(open) = &mut self.open {
            open.must_reread = true;
            self.is_stale = true;
        }
    }

    /// Opens something else, beside the stage.
    pub fn open(&mut self, request: LoadRequest) {
        self.is_stale = false;
        self.work = Some(TransitionWork::start(request));
    }

    /// Gives up the work; the settings go back to what the stage shows.
    pub fn cancel(&mut self) {
        // Dropped, the job hears that it is not wanted; nobody waits for it to end.
        let Some(work) = self.work.take() else {
            return;
        };
        self.is_stale = false;
        if let (None, Some(open)) = (work.origin, &mut self.open) {
            open.give_up_changes();
        }
    }

    /// Takes in work that is done and starts what waits for it. A better film than the draft that
    /// is on the stage waits until it `may_change`, which nobody should see.
    pub fn poll(&mut self, may_change: bool) -> Option<WorkOutcome> {
        let is_held = |work: &TransitionWork| work.has_draft && !may_change;
        let outcome = match &self.work {
            Some(work) if is_held(work) => None,
            _ => self.take_work().or_else(|| self.take_meanwhile()),
        };
        // A build runs on while a slider is dragged, so that its way is seen; but not for long.
        let is_free = self
            .work
            .as_ref()
            .is_none_or(TransitionWork::can_be_given_up);
        if self.is_stale
            && is_free
            && let Some(open) = &self.open
        {
            self.is_stale = false;
            self.work = Some(TransitionWork::start(LoadRequest::Rebuild(Box::new(
                open.rebuild(),
            ))));
        }
        outcome
    }

    fn take_meanwhile(&mut self) -> Option<WorkOutcome> {
        let work = self.work.as_mut()?;
        let opened = work.opened();
        let (loaded, origin) = work.take_meanwhile()?;
        match (origin, &mut self.open) {
            (Some(origin), open) => {
                self.is_stale = false;
                *open = Some(opened(loaded, origin));
                Some(WorkOutcome::Opened)
            }
            (None, Some(open)) => open.restage(loaded).then_some(WorkOutcome::Rebuilt),
            (None, None) => None,
        }
    }

    fn take_work(&mut self) -> Option<WorkOutcome> {
        let answer = self.work.as_ref()?.job.poll()?;
        let work = self.work.take()?;
        let (opened, origin) = (work.opened(), work.origin);
        Some(match (answer, origin, &mut self.open) {
            (Ok(loaded), Some(origin), open) => {
                self.is_stale = false;
                *open = Some(opened(loaded, origin));
                WorkOutcome::Opened
            }
            (Ok(built), None, Some(open)) => {
                if open.restage(built) {
                    WorkOutcome::Rebuilt
                } else {
                    WorkOutcome::NotRebuilt
                }
            }
            // What is open is never closed, only followed by something else.
            (Ok(_), None, None) => return None,
            (Err(error), origin, open) => {
                if let (None, Some(open)) = (origin, open) {
                    // What cannot be read would fail at every build from now on.
                    open.give_up_designs();
                }
                WorkOutcome::Failed(error)
            }
        })
    }
}

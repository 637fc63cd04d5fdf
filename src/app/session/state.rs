//! The open project, the transition on the stage, and the background work on the next one.
//!
//! The stage keeps showing the old transition until the new one is ready, and afterwards if the new
//! one cannot be built. While a build runs, newer settings wait for it, so that intermediate
//! results appear while a slider is dragged; a build that takes long is abandoned in favour of the
//! newest settings.

mod work;

use std::path::{Path, PathBuf};
use std::sync::{Arc, LazyLock};

use bevy::prelude::Resource;

use crate::app::session::document::OpenDocument;
use crate::app::session::history::{ProjectSnapshot, UndoHistory};
use crate::app::session::save::SaveError;
use crate::app::session::transition_problem::TransitionProblem;
use crate::app::session::transition_work::TransitionWork;
use crate::app::session::unsaved_project::UnsavedProject;
use crate::colour::Rgb;
use crate::content::ContentKind;
use crate::design::{Design, DesignForm};
use crate::geometry::Bounds;
use crate::project::{LoadedProject, Project, ProjectError};
use crate::transition::{
    BuildError, Sequence, SequenceLayout, Timing, Transition, TransitionMethod, TransitionStop,
    TransitionStyle, segment_at, style_of,
};
use crate::warp::{Arap, WarpKind};

pub use work::WorkOutcome;

/// Reason why a method is not available.
#[derive(Debug, thiserror::Error)]
pub enum MethodUnavailable {
    /// No project is open.
    #[error("no project is open")]
    NothingOpen,
    /// The method does not suit the designs.
    #[error(transparent)]
    Designs(#[from] BuildError),
}

/// The open project, its transitions, and the work on the next ones.
#[derive(Resource, Debug, Default)]
pub struct Session {
    open: Option<OpenDocument>,
    work: Option<TransitionWork>,
    is_stale: bool,
    /// Number of projects opened so far.
    opened_count: u64,
}

/// Timing reported while no project is open.
static DEFAULT_TIMING: LazyLock<Timing> = LazyLock::new(Timing::default);

/// Queries about the open project.
impl Session {
    /// Current settings of the current segment: two designs, out of a project that may have more.
    #[must_use]
    pub fn project(&self) -> Option<&Project> {
        self.open.as_ref().map(OpenDocument::segment_project)
    }

    /// The whole open project.
    #[must_use]
    pub fn whole_project(&self) -> Option<&Project> {
        self.open.as_ref().map(|open| &open.loaded.project)
    }

    /// The whole open project with its designs.
    #[must_use]
    pub fn loaded_project(&self) -> Option<LoadedProject> {
        self.open.as_ref().map(|open| open.loaded.clone())
    }

    /// The two designs of the current segment, as imported.
    #[must_use]
    pub fn designs(&self) -> Vec<&Arc<Design>> {
        let open = self.open.as_ref();
        open.map_or_else(Vec::new, |open| open.designs().to_vec())
    }

    /// All designs, as imported.
    #[must_use]
    pub fn all_designs(&self) -> &[Arc<Design>] {
        let open = self.open.as_ref();
        open.map_or(&[], |open| &open.loaded.designs)
    }

    /// Names of the designs along the film, one for each integer t, starting at 0.
    #[must_use]
    pub fn names_along_path(&self) -> Vec<String> {
        self.open.as_ref().map_or_else(Vec::new, |open| {
            let project = open.staged_project();
            let names = project.stop_names().into_iter();
            names.map(str::to_owned).collect()
        })
    }

    /// Transition on the stage for the current segment.
    #[must_use]
    pub fn transition(&self) -> Option<&Transition> {
        self.open.as_ref()?.transition()
    }

    /// All transitions on the stage; `None` unless every segment has one.
    #[must_use]
    pub fn sequence(&self) -> Option<Sequence> {
        self.open.as_ref()?.sequence()
    }

    /// Approximate bounding box of all in-betweens on the stage, sampled over t.
    #[must_use]
    pub fn bounds(&self) -> Option<Bounds> {
        self.open.as_ref()?.bounds()
    }

    /// Index of the current segment, from 0.
    #[must_use]
    pub fn segment(&self) -> usize {
        self.open.as_ref().map_or(0, OpenDocument::segment)
    }

    /// Number of segments of the project.
    #[must_use]
    pub fn segment_count(&self) -> usize {
        self.whole_project().map_or(1, Project::segment_count)
    }

    /// Converts t of the whole film to t within the current segment.
    #[must_use]
    pub fn segment_t(&self, t: f64) -> f64 {
        t - self.segment() as f64
    }

    /// Converts t within the current segment to t of the whole film.
    #[must_use]
    pub fn whole_t(&self, within: f64) -> f64 {
        within + self.segment() as f64
    }

    /// Index of the segment that is shown at `t` of the whole film.
    #[must_use]
    pub fn segment_at(&self, t: f64) -> usize {
        let segment_count = self.open.as_ref().map_or(1, OpenDocument::segment_count);
        segment_at(segment_count, t).0
    }

    /// Makes another segment the current one.
    pub fn select_segment(&mut self, segment: usize) {
        if let Some(open) = &mut self.open {
            open.select_segment(segment);
        }
    }

    /// Settings that the current segment on the stage was built from.
    #[must_use]
    #[cfg_attr(not(feature = "testing"), expect(dead_code, reason = "read by tests"))]
    pub fn staged_settings(&self) -> Option<&Project> {
        let stage = self.open.as_ref()?.stage()?;
        Some(&stage.settings.segment_project)
    }

    /// The current segment with the settings it was built from, and its two designs.
    #[must_use]
    pub fn staged_segment(&self) -> Option<LoadedProject> {
        let open = self.open.as_ref()?;
        open.stage()?;
        Some(open.staged_segment())
    }

    /// Reason why the current settings give no transition; `None` if they give one.
    #[must_use]
    pub fn problem(&self) -> Option<&TransitionProblem> {
        self.open.as_ref()?.problem()
    }

    /// Timing of the film.
    #[must_use]
    pub fn timing(&self) -> &Timing {
        self.whole_project()
            .map_or(&DEFAULT_TIMING, |project| &project.timing)
    }

    /// Colours of the project.
    #[must_use]
    pub fn style(&self) -> TransitionStyle {
        self.whole_project()
            .map_or_else(TransitionStyle::default, |p| p.style)
    }

    /// Colours of the current segment.
    #[must_use]
    pub fn segment_style(&self) -> TransitionStyle {
        style_of(self.segment(), self.sequence_layout(), &self.style())
    }

    /// Number of segments, and whether they form a closed loop.
    #[must_use]
    pub fn sequence_layout(&self) -> SequenceLayout {
        SequenceLayout {
            segment_count: self.segment_count(),
            is_closed: self
                .whole_project()
                .is_some_and(Project::ends_where_it_starts),
        }
    }

    /// Stops of the project; empty if no project is open.
    #[must_use]
    pub fn stops(&self) -> &[TransitionStop] {
        self.whole_project().map_or(&[], |project| &project.stops)
    }

    /// File that the project is saved to; `None` if it has none yet.
    #[must_use]
    pub fn path(&self) -> Option<&Path> {
        self.open.as_ref()?.path()
    }

    /// Folder of the project file or, if the project has none, of its first design that is
    /// not text.
    #[must_use]
    pub fn folder(&self) -> Option<PathBuf> {
        let folder = self.open.as_ref()?.folder();
        folder.filter(|folder| folder.is_dir())
    }

    /// Gallery name of the open project; `None` if it is not a bundled one.
    #[must_use]
    pub fn gallery_name(&self) -> Option<&str> {
        self.open.as_ref()?.gallery_name()
    }

    /// Number that tells the open project from those opened before; `None` if no project is open.
    #[must_use]
    pub fn document_number(&self) -> Option<u64> {
        self.open.as_ref().map(|_| self.opened_count)
    }

    /// Sources of all designs that are not bundled, in order.
    #[must_use]
    pub fn design_paths(&self) -> Vec<PathBuf> {
        let sources = self.open.as_ref().map(OpenDocument::sources);
        let sources = sources.into_iter().flatten();
        sources.map(|source| source.to_path()).collect()
    }

    /// Files that the designs were read from.
    #[must_use]
    pub fn files(&self) -> Vec<PathBuf> {
        self.open
            .as_ref()
            .map_or_else(Vec::new, OpenDocument::files)
    }

    /// Title of the open project.
    #[must_use]
    pub fn title(&self) -> String {
        self.open
            .as_ref()
            .map_or_else(String::new, OpenDocument::title)
    }

    /// Base name for files exported from the project.
    #[must_use]
    pub fn file_stem(&self) -> String {
        let open = self.open.as_ref();
        open.map_or_else(|| "untitled".to_owned(), OpenDocument::file_stem)
    }

    /// Whether the open designs can be shown by this method.
    ///
    /// # Errors
    /// The reason why not, worded as the tooltip of a disabled button.
    pub fn check_method(
        &self,
        warp: WarpKind,
        content: ContentKind,
    ) -> Result<(), MethodUnavailable> {
        let open = self.open.as_ref().ok_or(MethodUnavailable::NothingOpen)?;
        for segment in open.staged_project().segments() {
            segment.check_available(warp, content)?;
        }
        Ok(())
    }

    /// Number of parts of the current transition that can be rotated individually; 0 for warps
    /// without parts.
    #[must_use]
    pub fn parts(&self) -> usize {
        let arap = self.transition().and_then(Transition::arap);
        arap.map_or(0, Arap::part_count)
    }

    /// Whether any design is a truss.
    #[must_use]
    pub fn has_bars(&self) -> bool {
        let mut designs = self.all_designs().iter();
        designs.any(|design| matches!(design.form, DesignForm::Truss(_)))
    }

    /// Whether any design has its own colours.
    #[must_use]
    pub fn has_paints(&self) -> bool {
        let is_painted = |design: &Arc<Design>| match &design.form {
            DesignForm::Truss(truss) => !truss.parts().colours.is_empty(),
            _ => design.is_painted(),
        };
        self.all_designs().iter().any(is_painted)
    }

    /// Colours in which other programs show the first and the last design, if no design names any.
    #[must_use]
    pub fn drawn_colours(&self) -> Option<[Rgb; 2]> {
        self.open.as_ref()?.loaded.drawn_colours()
    }

    /// Whether the match editor applies: both designs are outlines, and the film is not a path on
    /// the map, for which all designs are matched together.
    #[must_use]
    pub fn has_match_editor(&self) -> bool {
        let pair = self.designs();
        !self.whole_project().is_some_and(Project::follows_path)
            && !pair.is_empty()
            && pair
                .iter()
                .all(|d| matches!(d.form, DesignForm::Outline(_)))
    }
}

/// Changes to the project.
impl Session {
    /// Whether there are unsaved changes.
    #[must_use]
    pub fn is_dirty(&self) -> bool {
        self.open.as_ref().is_some_and(OpenDocument::is_dirty)
    }

    /// Whether the project consists of different designs that were opened together and not changed
    /// since.
    #[must_use]
    pub fn has_new_designs(&self) -> bool {
        let open = self.open.as_ref();
        open.is_some_and(OpenDocument::has_new_designs)
    }

    /// Whether the film on the stage uses the requested method, possibly as a draft.
    #[must_use]
    pub fn has_film(&self) -> bool {
        let shows_draft = |work: &TransitionWork| work.has_draft;
        self.transition().is_some() && self.work.as_ref().is_none_or(shows_draft)
    }

    /// Whether the open project was recovered from an autosave.
    #[must_use]
    pub fn is_recovered(&self) -> bool {
        self.open.as_ref().is_some_and(|open| open.is_recovered)
    }

    /// Whether another project is being opened.
    #[must_use]
    pub fn is_opening(&self) -> bool {
        let work = self.work.as_ref();
        work.is_some_and(|work| work.origin.is_some())
    }

    /// Data for an autosave of the open project.
    ///
    /// # Errors
    /// The project cannot be written as text.
    #[must_use]
    pub fn unsaved_project(&self) -> Option<Result<UnsavedProject, ProjectError>> {
        self.open.as_ref().map(OpenDocument::unsaved_project)
    }

    /// Text of the question about unsaved changes.
    #[must_use]
    pub fn unsaved_text(&self) -> String {
        format!("“{}” has unsaved changes.", self.title())
    }

    /// Whether another program or window has changed the project file since it was read or last
    /// saved. Reads the file.
    #[must_use]
    pub fn is_changed_elsewhere(&self) -> bool {
        let open = self.open.as_ref();
        open.is_some_and(OpenDocument::is_changed_elsewhere)
    }

    /// Treats the current settings as saved.
    pub fn mark_saved(&mut self) {
        if let Some(open) = &mut self.open {
            open.mark_saved();
        }
    }

    /// Edits the settings of the current segment. Match settings and the timing of parts change for
    /// this segment only, all other settings for the whole project. Changes with the same gesture
    /// number `mark` form one undo step.
    pub fn change(&mut self, mark: Option<u64>, edit: impl FnOnce(&mut Project)) {
        let Some(open) = &mut self.open else {
            return;
        };
        // Edits a copy, so that an edit without effect creates no undo step.
        let mut changed = open.segment_project().clone();
        edit(&mut changed);
        if changed != *open.segment_project() {
            open.edit_segment(changed, mark);
            self.check_stale();
        }
    }

    /// Edits the settings of the whole project. Changes with the same gesture number `mark` form
    /// one undo step.
    pub fn change_whole(&mut self, mark: Option<u64>, edit: impl FnOnce(&mut Project)) {
        let Some(open) = &mut self.open else {
            return;
        };
        let mut changed = open.loaded.project.clone();
        edit(&mut changed);
        if changed != open.loaded.project {
            open.edit(changed, mark);
            self.check_stale();
        }
    }

    /// Updates `is_stale`: whether the changed settings require another transition than the one on
    /// the stage and the one being built. Cancels a rebuild that is no longer needed.
    fn check_stale(&mut self) {
        let Some(open) = &mut self.open else {
            return;
        };
        self.is_stale = open.is_stale();
        // A running job that opens another project continues; only a rebuild can become
        // unnecessary.
        let building = self.work.take_if(|work| work.origin.is_none());
        // If the stage already shows what is requested, the running build is cancelled.
        if let Some(work) = building.filter(|_| self.is_stale) {
            // A running build of exactly these settings continues.
            self.is_stale = work.builds_other_than(&open.loaded.project);
            self.work = Some(work);
        }
    }

    /// Whether there is a change to undo.
    #[must_use]
    pub fn can_undo(&self) -> bool {
        self.open.as_ref().is_some_and(|o| o.history.can_undo())
    }

    /// Whether there is a change to redo.
    #[must_use]
    pub fn can_redo(&self) -> bool {
        self.open.as_ref().is_some_and(|o| o.history.can_redo())
    }

    /// Undoes the last change; returns `false` if there is none.
    ///
    /// # Errors
    /// A bundled design of the restored project cannot be written; the project stays as it was.
    pub fn undo(&mut self) -> Result<bool, SaveError> {
        self.step_history(UndoHistory::undo)
    }

    /// Redoes the change that was undone last; returns `false` if there is none.
    ///
    /// # Errors
    /// As [`undo`](Self::undo).
    pub fn redo(&mut self) -> Result<bool, SaveError> {
        self.step_history(UndoHistory::redo)
    }

    fn step_history(
        &mut self,
        step: impl FnOnce(&mut UndoHistory) -> Option<ProjectSnapshot>,
    ) -> Result<bool, SaveError> {
        let Some(open) = &mut self.open else {
            return Ok(false);
        };
        let has_changed = open.step_history(step)?;
        if has_changed {
            self.check_stale();
            self.restage_earlier();
        }
        Ok(has_changed)
    }

    /// Puts the film back on the stage that was built for the current settings before, if it is
    /// still known. A build for other settings is then cancelled.
    fn restage_earlier(&mut self) {
        let is_rebuilding = self.work.as_ref().is_some_and(|work| work.origin.is_none());
        if (self.is_stale || is_rebuilding)
            && let Some(open) = &mut self.open
            && open.restage_earlier()
        {
            self.is_stale = false;
            self.work.take_if(|work| work.origin.is_none());
        }
    }

    /// The method that was requested last and could not be built; `None` once another one was.
    #[must_use]
    pub fn unavailable_method(&self) -> Option<TransitionMethod> {
        self.open.as_ref()?.unavailable_method()
    }

    /// Saves the project to its file, or to `to`, which becomes its file; returns the path.
    ///
    /// # Errors
    /// No project is open, or it cannot be written; the project stays as it was.
    pub fn save(&mut self, to: Option<&Path>) -> Result<PathBuf, SaveError> {
        let path = to.or(self.path()).map(Path::to_owned);
        let (Some(open), Some(path)) = (&mut self.open, path) else {
            return Err(SaveError::NothingOpen);
        };
        open.save(path.clone())?;
        Ok(path)
    }
}

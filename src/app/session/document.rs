//! A project that is open: where it comes from, how it was changed, what of it is on the stage.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use crate::app::session::history::{ProjectSnapshot, UndoHistory};
use crate::app::session::load;
use crate::app::session::load::{
    BuiltProject, BuiltSegment, PlayableSegment, RebuildRequest, TransitionProblem,
};
use crate::app::session::origin::ProjectOrigin;
use crate::app::session::save;
use crate::app::session::save::SaveError;
use crate::app::session::unsaved_project::UnsavedProject;
use crate::design::{Design, DesignSource};
use crate::geometry::Bounds;
use crate::io::file_name::safe;
use crate::io::sanitize::SanitizedLine;
use crate::project::{LoadedProject, Project, ProjectError};
use crate::transition::{Sequence, Transition, TransitionMethod};

/// A project that is open.
#[derive(Debug)]
pub struct OpenDocument {
    /// The settings as they are now, and the designs of what is on the stage.
    pub loaded: LoadedProject,
    /// The settings of what is on the stage.
    pub staged: Project,
    /// The steps that can be taken back.
    pub history: UndoHistory,
    /// A file of its designs has changed.
    pub must_reread: bool,
    /// It was taken up again after the program had ended without saving it.
    pub is_rescued: bool,
    /// What there is of each leg of what is on the stage.
    legs: Vec<BuiltSegment>,
    /// The leg that is looked at.
    leg: usize,
    /// The project of that leg, as it is now.
    seen: Project,
    origin: ProjectOrigin,
    /// As it was opened or saved last.
    saved: Project,
}

impl OpenDocument {
    /// A project that has just been read.
    #[must_use]
    pub fn new(loaded: BuiltProject, origin: ProjectOrigin) -> Self {
        let project = loaded.project.project.clone();
        Self {
            seen: project.leg(0),
            loaded: loaded.project,
            staged: loaded.settings,
            history: UndoHistory::default(),
            must_reread: false,
            is_rescued: false,
            legs: loaded.legs,
            leg: 0,
            origin,
            saved: project,
        }
    }

    /// The same with changes that no file has: they were made before the program ended.
    #[must_use]
    pub fn unsaved(loaded: BuiltProject, origin: ProjectOrigin) -> Self {
        Self {
            saved: Project::pair("", ""),
            is_rescued: true,
            ..Self::new(loaded, origin)
        }
    }

    /// Two designs that were opened together, as they came.
    #[must_use]
    pub fn is_new_pair(&self) -> bool {
        let is_pair = match self.loaded.project.designs.as_slice() {
            [a, b] => a.path != b.path,
            _ => false,
        };
        is_pair && self.origin == ProjectOrigin::Unsaved && !self.is_dirty()
    }

    /// What is kept of it until it is saved.
    ///
    /// # Errors
    /// As [`UnsavedProject::new`].
    pub fn kept(&self) -> Result<UnsavedProject, ProjectError> {
        UnsavedProject::new(self.title(), &self.origin, &self.loaded)
    }

    /// The number of the leg that is looked at.
    #[must_use]
    pub fn leg(&self) -> usize {
        self.leg
    }

    /// How many legs are on the stage.
    #[must_use]
    pub fn leg_count(&self) -> usize {
        self.legs.len()
    }

    /// Looks at another leg.
    pub fn look_at(&mut self, leg: usize) {
        self.leg = leg.min(self.legs.len().saturating_sub(1));
        self.look_again();
    }

    /// The settings of the leg that is looked at, or of the last one where it is gone.
    fn look_again(&mut self) {
        let last = self.loaded.project.leg_count() - 1;
        self.seen = self.loaded.project.leg(self.leg.min(last));
    }

    /// The project of the leg that is looked at, as it is now.
    #[must_use]
    pub fn seen(&self) -> &Project {
        &self.seen
    }

    /// The project with the designs and the settings that are on the stage.
    #[must_use]
    pub fn whole_on_stage(&self) -> LoadedProject {
        self.loaded.with(self.staged.clone())
    }

    /// The leg that is looked at, with the designs and the settings that are on the stage.
    #[must_use]
    pub fn leg_on_stage(&self) -> LoadedProject {
        let mut legs = self.whole_on_stage().legs();
        let leg = self.leg.min(legs.len() - 1);
        legs.swap_remove(leg)
    }

    /// The designs of the leg that is looked at.
    #[must_use]
    pub fn designs(&self) -> [&Arc<Design>; 2] {
        self.staged
            .leg_designs(self.leg)
            .map(|k| &self.loaded.designs[k])
    }

    /// What is on the stage of the leg that is looked at.
    #[must_use]
    pub fn transition(&self) -> Option<&Transition> {
        self.stage().map(|stage| &stage.transition)
    }

    /// The same, with what it was built from.
    #[must_use]
    pub fn stage(&self) -> Option<&PlayableSegment> {
        self.legs.get(self.leg)?.stage.as_ref()
    }

    /// All that is on the stage, where every leg has something to show.
    #[must_use]
    pub fn sequence(&self) -> Option<Sequence> {
        let legs = self
            .legs
            .iter()
            .map(|leg| Some(leg.stage.as_ref()?.transition.clone()));
        let sequence = Sequence::new(legs.collect::<Option<_>>()?)?;
        Some(sequence.leading_back(self.staged.leads_back()))
    }

    /// The box that holds every frame of what is on the stage, nearly.
    #[must_use]
    pub fn bounds(&self) -> Option<Bounds> {
        let stages = self.legs.iter().filter_map(|leg| leg.stage.as_ref());
        let boxes = stages.map(|stage| stage.transition.bounds());
        boxes.reduce(|a, b| a.union(&b))
    }

    /// Why the settings, as they are now, make no transition: of the leg that is looked at, or of
    /// another.
    #[must_use]
    pub fn problem(&self) -> Option<&TransitionProblem> {
        let here = self.legs.get(self.leg).and_then(|leg| leg.problem.as_ref());
        here.or_else(|| self.legs.iter().find_map(|leg| leg.problem.as_ref()))
    }

    /// There is no problem any more.
    pub fn forget_problems(&mut self) {
        for leg in &mut self.legs {
            leg.problem = None;
        }
    }

    /// The file that it is saved to.
    #[must_use]
    pub fn path(&self) -> Option<&Path> {
        match &self.origin {
            ProjectOrigin::File(path) => Some(path),
            ProjectOrigin::Gallery(_) | ProjectOrigin::Unsaved => None,
        }
    }

    /// Its name, where it is a bundled one.
    #[must_use]
    pub fn gallery_name(&self) -> Option<&str> {
        match &self.origin {
            ProjectOrigin::Gallery(name) => Some(name),
            ProjectOrigin::File(_) | ProjectOrigin::Unsaved => None,
        }
    }

    /// The files that its designs are read from.
    #[must_use]
    pub fn files(&self) -> Vec<PathBuf> {
        let folder = self.loaded.folder.as_deref();
        let entries = self.loaded.project.designs.iter();
        let sources = entries.filter_map(|entry| match folder {
            Some(folder) => Some(DesignSource::in_folder(folder, &entry.path)),
            // A file that took the place of a bundled design.
            None => entry
                .path
                .is_absolute()
                .then(|| DesignSource::of(&entry.path)),
        });
        sources
            .filter_map(|source| Some(source.file()?.to_owned()))
            .collect()
    }

    fn stem(&self) -> Option<String> {
        let stem = self.path().and_then(Path::file_stem);
        stem.map(|stem| SanitizedLine(stem.to_string_lossy()).to_string())
    }

    /// What it is called.
    #[must_use]
    pub fn title(&self) -> String {
        let stem = self.stem();
        // A title that was given says more than the name of a file, and that more than those of the
        // designs.
        stem.filter(|_| self.loaded.project.title.is_empty())
            .unwrap_or_else(|| self.loaded.title())
    }

    /// What files that belong to it are called.
    #[must_use]
    pub fn file_stem(&self) -> String {
        let name = || self.gallery_name().map(str::to_owned);
        let stem = self.stem().or_else(name).unwrap_or_else(|| self.title());
        let path = &self.loaded.project.map.path;
        match path.is_none() || path.name.is_empty() {
            true => safe(&stem),
            false => safe(&format!("{stem}-{}", path.name)),
        }
    }

    /// There are changes that are not saved.
    #[must_use]
    pub fn is_dirty(&self) -> bool {
        self.loaded.project != self.saved
    }

    /// Takes the changes for saved.
    pub fn forget_changes(&mut self) {
        self.is_rescued = false;
        self.saved = self.loaded.project.clone();
    }

    /// Changes the settings. Changes of one mark are one step of the history.
    pub fn edit(&mut self, project: Project, mark: Option<u64>) {
        let before = self.snapshot();
        self.loaded.project = project;
        self.look_again();
        self.history.note(before, self.snapshot(), mark);
    }

    /// Changes the settings of the leg that is looked at, as [`Self::edit`] does.
    pub fn edit_leg(&mut self, pair: Project, mark: Option<u64>) {
        let mut whole = self.loaded.project.clone();
        let last = whole.leg_count() - 1;
        whole.take_leg(self.leg.min(last), pair);
        self.edit(whole, mark);
    }

    /// Takes the settings of a step of the history; `false` where there is none.
    ///
    /// # Errors
    /// A bundled design that the step names cannot be written; the project is as it was.
    pub fn go(
        &mut self,
        step: impl FnOnce(&mut UndoHistory) -> Option<ProjectSnapshot>,
    ) -> Result<bool, SaveError> {
        let Some(ProjectSnapshot { project, folder }) = step(&mut self.history) else {
            return Ok(false);
        };
        self.loaded.project = match &self.loaded.folder {
            // Saved elsewhere since: the step names its designs from a folder that is no longer the
            // project's.
            Some(now) if folder.as_ref() != Some(now) => {
                save::named_from(project, folder.as_deref(), now)?
            }
            _ => project,
        };
        self.look_again();
        Ok(true)
    }

    /// Whether the settings make another transition than that on the stage. Where they are those
    /// of the stage again, there is no problem any more.
    pub fn is_stale(&mut self) -> bool {
        let is_stale = self.must_reread || load::needs_build(&self.staged, &self.loaded.project);
        if !is_stale {
            self.forget_problems_of_what_is_shown();
        }
        is_stale
    }

    fn forget_problems_of_what_is_shown(&mut self) {
        for leg in self.legs.iter_mut().filter(|leg| leg.stage.is_some()) {
            leg.problem = None;
        }
    }

    /// What is to be built where it is stale.
    #[must_use]
    pub fn rebuild(&self) -> RebuildRequest {
        RebuildRequest {
            now: self.loaded.clone(),
            staged: self.staged.clone(),
            stages: self
                .legs
                .iter()
                .filter_map(|leg| leg.stage.clone())
                .collect(),
            must_reread: self.must_reread,
        }
    }

    /// Takes in what was built; whether there is a new transition. The settings may have changed
    /// again meanwhile: they stay, and so does what is on the stage where there is nothing new.
    pub fn restage(&mut self, built: BuiltProject) -> bool {
        let can_stay = built.legs.len() == self.legs.len();
        if can_stay && built.legs.iter().all(|leg| leg.problem.is_some()) {
            // What was built in its place is on the stage already, or something better.
            let new = self.legs.iter_mut().zip(built.legs);
            new.for_each(|(leg, built)| leg.problem = built.problem);
            return false;
        }
        // The settings are not taken from what was built: they may be newer.
        self.loaded.designs = built.project.designs;
        self.staged = built.settings;
        self.must_reread = false;
        let mut before = std::mem::take(&mut self.legs).into_iter();
        let merged = |built: BuiltSegment| {
            let old = before
                .next()
                .filter(|_| can_stay && built.problem.is_some());
            BuiltSegment {
                stage: old.and_then(|old| old.stage).or(built.stage),
                problem: built.problem,
            }
        };
        self.legs = built.legs.into_iter().map(merged).collect();
        self.look_at(self.leg);
        true
    }

    /// The settings go back to those of the stage; no step of the history is left of it.
    pub fn give_up_changes(&mut self) {
        self.must_reread = false;
        let cell = self.cell_on_stage();
        self.amend(|now, staged| {
            now.clone_from(staged);
            // What was refused as it was opened is not what the stage shows.
            if let Some(cell) = cell {
                (now.warp, now.content) = (Some(cell.warp()), Some(cell.content()));
            }
        });
        // What could not be had is not asked for any more.
        self.forget_problems_of_what_is_shown();
    }

    /// By what all legs are shown; none where they differ.
    fn cell_on_stage(&self) -> Option<TransitionMethod> {
        let cell = |leg: &BuiltSegment| Some(leg.stage.as_ref()?.transition.cell());
        let first = cell(self.legs.first()?)?;
        let is_same = |leg: &BuiltSegment| cell(leg) == Some(first);
        self.legs.iter().all(is_same).then_some(first)
    }

    /// The designs go back to those of the stage: a file that cannot be read is not kept.
    pub fn give_up_designs(&mut self) {
        self.must_reread = false;
        self.amend(|now, staged| {
            // Another number of them has other legs.
            if now.designs.len() == staged.designs.len() {
                now.designs.clone_from(&staged.designs);
                now.fit = staged.fit;
            } else {
                now.clone_from(staged);
            }
        });
    }

    fn amend(&mut self, change: impl FnOnce(&mut Project, &Project)) {
        let before = self.snapshot();
        change(&mut self.loaded.project, &self.staged);
        self.look_again();
        self.history.amend(before, self.snapshot());
    }

    /// Writes it to a file, which is its file from then on.
    ///
    /// # Errors
    /// The document or a bundled design cannot be written; the project is as it was.
    pub fn save(&mut self, path: PathBuf) -> Result<(), SaveError> {
        // What is on the stage may be another film than the project asks for, a draft of it.
        if !load::needs_build(&self.staged, &self.loaded.project) {
            for (k, leg) in self.legs.iter().enumerate() {
                if let Some(found) = leg.stage.as_ref().and_then(|s| s.transition.found()) {
                    self.loaded.project.keep_found(k, found);
                }
            }
        }
        save::save(&mut self.loaded, &path)?;
        self.look_again();
        self.saved = self.loaded.project.clone();
        // Only their names have changed, which is no reason to build again.
        if self.staged.designs.len() == self.saved.designs.len() {
            self.staged.designs.clone_from(&self.saved.designs);
            for (k, leg) in self.legs.iter_mut().enumerate() {
                if let Some(stage) = &mut leg.stage {
                    stage.settings.rename(&self.staged, k);
                }
            }
        }
        self.origin = ProjectOrigin::File(path);
        self.is_rescued = false;
        Ok(())
    }

    fn snapshot(&self) -> ProjectSnapshot {
        ProjectSnapshot {
            project: self.loaded.project.clone(),
            folder: self.loaded.folder.clone(),
        }
    }
}

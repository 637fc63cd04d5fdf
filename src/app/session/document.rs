//! The open project: its current and its saved settings, its undo history, and the segments on the
//! stage.

mod replaced_stage;

use std::path::{Path, PathBuf};
use std::sync::Arc;

use crate::app::session::history::{ProjectSnapshot, UndoHistory};
use crate::app::session::load;
use crate::app::session::load::{BuiltProject, BuiltSegment, PlayableSegment, RebuildRequest};
use crate::app::session::origin::ProjectOrigin;
use crate::app::session::save;
use crate::app::session::save::SaveError;
use crate::app::session::transition_problem::TransitionProblem;
use crate::app::session::unsaved_project::UnsavedProject;
use crate::design::{Design, DesignSource};
use crate::geometry::Bounds;
use crate::io::file_name::safe_file_name;
use crate::io::sanitize::SanitizedName;
use crate::project::{LoadedProject, Project, ProjectError};
use crate::transition::{Sequence, Transition, TransitionMethod};

/// A project that is open.
#[derive(Debug)]
pub struct OpenDocument {
    /// Current settings, with the designs that the segments on the stage were built from.
    pub loaded: LoadedProject,
    /// Settings that the segments on the stage were built from.
    pub staged: Project,
    /// Undo history.
    pub history: UndoHistory,
    /// Whether a design file has changed on disk, so that the designs must be read again.
    pub must_reread: bool,
    /// Whether the project was recovered from an autosave and has not been saved since.
    pub is_recovered: bool,
    /// The segments on the stage: one for each pair of consecutive designs.
    segments: Vec<BuiltSegment>,
    /// Segments that were on the stage before, the latest last.
    earlier: Vec<PlayableSegment>,
    /// Settings that were refused because their transition would take too long or too much memory.
    refused: Option<Project>,
    /// The method that was requested last and could not be built.
    unavailable: Option<TransitionMethod>,
    /// Index of the current segment: the one at the current t.
    segment_index: usize,
    /// Current settings of the current segment, as a project of two designs.
    segment_settings: Project,
    origin: ProjectOrigin,
    /// Settings as last opened or saved.
    saved: Project,
}

impl OpenDocument {
    /// Opens a project that has just been read.
    #[must_use]
    pub fn new(loaded: BuiltProject, origin: ProjectOrigin) -> Self {
        let project = loaded.project.project.clone();
        Self {
            segment_settings: project.segment(0),
            loaded: loaded.project,
            staged: loaded.settings,
            history: UndoHistory::default(),
            must_reread: false,
            is_recovered: false,
            segments: loaded.segments,
            earlier: Vec::new(),
            refused: None,
            unavailable: None,
            segment_index: 0,
            origin,
            saved: project,
        }
    }

    /// Opens a recovered project; all its settings count as unsaved.
    #[must_use]
    pub fn unsaved(loaded: BuiltProject, origin: ProjectOrigin) -> Self {
        Self {
            saved: Project::from_pair("", ""),
            is_recovered: true,
            ..Self::new(loaded, origin)
        }
    }

    /// Whether the project consists of different designs that were opened together and not changed
    /// since.
    #[must_use]
    pub fn has_new_designs(&self) -> bool {
        let designs = &self.loaded.project.designs;
        // A single design is paired with itself, so both paths are equal.
        let are_different = designs.windows(2).any(|pair| pair[0].path != pair[1].path);
        are_different && self.origin == ProjectOrigin::Unsaved && !self.is_dirty()
    }

    /// Data for an autosave of the project.
    ///
    /// # Errors
    /// As [`UnsavedProject::new`].
    pub fn unsaved_project(&self) -> Result<UnsavedProject, ProjectError> {
        UnsavedProject::new(self.title(), &self.origin, &self.loaded)
    }

    /// Index of the current segment.
    #[must_use]
    pub fn segment(&self) -> usize {
        self.segment_index
    }

    /// Number of segments on the stage.
    #[must_use]
    pub fn segment_count(&self) -> usize {
        self.segments.len()
    }

    /// Makes another segment the current one.
    pub fn select_segment(&mut self, segment_index: usize) {
        self.segment_index = segment_index.min(self.segments.len().saturating_sub(1));
        self.refresh_segment();
    }

    /// Updates [`Self::segment_project`]. If the current segment no longer exists in the settings,
    /// the last one takes its place.
    fn refresh_segment(&mut self) {
        let last = self.loaded.project.segment_count() - 1;
        self.segment_settings = self.loaded.project.segment(self.segment_index.min(last));
    }

    /// Current settings of the current segment, as a project of two designs.
    #[must_use]
    pub fn segment_project(&self) -> &Project {
        &self.segment_settings
    }

    /// The whole project, with the designs and settings that the stage was built from.
    #[must_use]
    pub fn staged_project(&self) -> LoadedProject {
        self.loaded.with_project(self.staged.clone())
    }

    /// The current segment as a project of two designs, with the settings that the stage was built
    /// from.
    #[must_use]
    pub fn staged_segment(&self) -> LoadedProject {
        let mut segments = self.staged_project().segments();
        let index = self.segment_index.min(segments.len() - 1);
        segments.swap_remove(index)
    }

    /// The two designs of the current segment.
    #[must_use]
    pub fn designs(&self) -> [&Arc<Design>; 2] {
        self.staged
            .segment_designs(self.segment_index)
            .map(|k| &self.loaded.designs[k])
    }

    /// Transition on the stage for the current segment.
    #[must_use]
    pub fn transition(&self) -> Option<&Transition> {
        self.stage().map(|stage| &stage.transition)
    }

    /// Transition on the stage for the current segment, with the settings that it was built from;
    /// `None` if the segment has no transition.
    #[must_use]
    pub fn stage(&self) -> Option<&PlayableSegment> {
        self.segments.get(self.segment_index)?.playable.as_ref()
    }

    /// Transitions of all segments on the stage, as one sequence; `None` unless every segment has
    /// one.
    #[must_use]
    pub fn sequence(&self) -> Option<Sequence> {
        let segments = self
            .segments
            .iter()
            .map(|segment| Some(segment.playable.as_ref()?.transition.clone()));
        let sequence = Sequence::new(segments.collect::<Option<_>>()?)?;
        Some(sequence.closed(self.staged.ends_where_it_starts()))
    }

    /// Approximate bounding box of the in-betweens of all segments, sampled over t.
    #[must_use]
    pub fn bounds(&self) -> Option<Bounds> {
        let segments = self.segments.iter();
        let stages = segments.filter_map(|segment| segment.playable.as_ref());
        let boxes = stages.map(|stage| stage.transition.bounds());
        boxes.reduce(|a, b| a.union(&b))
    }

    /// Reason why the current settings give no transition: the problem of the current segment, or
    /// else the first problem of another segment.
    #[must_use]
    pub fn problem(&self) -> Option<&TransitionProblem> {
        let current = self
            .segments
            .get(self.segment_index)
            .and_then(|segment| segment.problem.as_ref());
        current.or_else(|| {
            self.segments
                .iter()
                .find_map(|segment| segment.problem.as_ref())
        })
    }

    /// Clears the problems of all segments.
    pub fn clear_problems(&mut self) {
        for segment in &mut self.segments {
            segment.problem = None;
        }
    }

    /// File that the project is saved to; `None` if it has none yet.
    #[must_use]
    pub fn path(&self) -> Option<&Path> {
        match &self.origin {
            ProjectOrigin::File(path) => Some(path),
            ProjectOrigin::Gallery(_) | ProjectOrigin::Unsaved => None,
        }
    }

    /// Gallery name of the project; `None` if it is not a bundled one.
    #[must_use]
    pub fn gallery_name(&self) -> Option<&str> {
        match &self.origin {
            ProjectOrigin::Gallery(name) => Some(name),
            ProjectOrigin::File(_) | ProjectOrigin::Unsaved => None,
        }
    }

    /// Files that the designs are read from.
    #[must_use]
    pub fn files(&self) -> Vec<PathBuf> {
        let sources = self.sources().into_iter();
        sources
            .filter_map(|source| Some(source.file()?.to_owned()))
            .collect()
    }

    /// Folder of the project file or, if the project has none, of its first design that is not
    /// text.
    #[must_use]
    pub fn folder(&self) -> Option<PathBuf> {
        let sources = self.sources().into_iter();
        let mut drawings = sources.filter_map(|source| match source {
            DesignSource::File { path, .. } => Some(path),
            DesignSource::Text { .. } => None,
        });
        let file = self.path().map(Path::to_owned).or_else(|| drawings.next());
        Some(file?.parent()?.to_owned())
    }

    /// Sources of the designs that are not bundled.
    #[must_use]
    pub fn sources(&self) -> Vec<DesignSource> {
        let folder = self.loaded.folder.as_deref();
        let entries = self.loaded.project.designs.iter();
        let sources = entries.filter_map(|entry| match folder {
            Some(folder) => Some(DesignSource::in_folder(folder, &entry.path)),
            // In a bundled project, only a user's file that replaced a design has an absolute path.
            None => entry
                .path
                .is_absolute()
                .then(|| DesignSource::from_path(&entry.path)),
        });
        sources.collect()
    }

    /// Name of the project file without extension; `None` if the project has no file.
    fn stem(&self) -> Option<String> {
        let stem = self.path().and_then(Path::file_stem);
        stem.map(|stem| SanitizedName(&stem.to_string_lossy()).to_string())
    }

    /// Title of the project: its explicit title, else the name of its file, else the names of its
    /// designs.
    #[must_use]
    pub fn title(&self) -> String {
        let stem = self.stem();
        stem.filter(|_| self.loaded.project.title.is_empty())
            .unwrap_or_else(|| self.loaded.title())
    }

    /// Base name, without extension, for files exported from the project. It includes the name of
    /// the path on the map, if the path has one.
    #[must_use]
    pub fn file_stem(&self) -> String {
        // A gallery project whose designs were replaced has lost its title, and so its name.
        let has_title = !self.loaded.project.title.is_empty();
        let name = || self.gallery_name().filter(|_| has_title).map(str::to_owned);
        let stem = self.stem().or_else(name).unwrap_or_else(|| self.title());
        let path = &self.loaded.project.map.path;
        match path.is_too_short() || path.name.is_empty() {
            true => safe_file_name(&stem),
            false => safe_file_name(&format!("{stem}-{}", path.name)),
        }
    }

    /// Whether there are unsaved changes.
    #[must_use]
    pub fn is_dirty(&self) -> bool {
        self.loaded.project != self.saved
    }

    /// Treats the current settings as saved.
    pub fn mark_saved(&mut self) {
        self.is_recovered = false;
        self.saved = self.loaded.project.clone();
    }

    /// Replaces the settings of the whole project. Changes with the same gesture number `mark` form
    /// one undo step.
    pub fn edit(&mut self, mut project: Project, mark: Option<u64>) {
        self.retry_unavailable_method(&mut project);
        let before = self.snapshot();
        self.loaded.project = project;
        self.refresh_segment();
        self.history.record(before, self.snapshot(), mark);
    }

    /// Replaces the settings of the current segment by those in `pair`; otherwise like
    /// [`Self::edit`].
    pub fn edit_segment(&mut self, pair: Project, mark: Option<u64>) {
        let mut project = self.loaded.project.clone();
        let last = project.segment_count() - 1;
        project.replace_segment(self.segment_index.min(last), pair);
        self.edit(project, mark);
    }

    /// Applies an undo or redo step; returns `false` if there is none.
    ///
    /// # Errors
    /// A bundled design named by the step cannot be written; the project stays as it was.
    pub fn step_history(
        &mut self,
        step: impl FnOnce(&mut UndoHistory) -> Option<ProjectSnapshot>,
    ) -> Result<bool, SaveError> {
        let Some(ProjectSnapshot { project, folder }) = step(&mut self.history) else {
            return Ok(false);
        };
        self.loaded.project = match &self.loaded.folder {
            // Since the step was recorded, the project has been saved to another folder, so its
            // paths must be relative to that folder.
            Some(now) if folder.as_ref() != Some(now) => {
                save::with_relative_paths(project, folder.as_deref(), now)?
            }
            _ => project,
        };
        self.refresh_segment();
        Ok(true)
    }

    /// Whether the settings require another transition than the one on the stage. If not, clears
    /// the problems of all segments that are shown.
    pub fn is_stale(&mut self) -> bool {
        let is_stale = self.must_reread || load::needs_build(&self.staged, &self.loaded.project);
        if !is_stale {
            self.clear_problems_of_shown_segments();
        }
        is_stale
    }

    /// Clears the problems of all segments that have a transition on the stage.
    fn clear_problems_of_shown_segments(&mut self) {
        for segment in self
            .segments
            .iter_mut()
            .filter(|segment| segment.playable.is_some())
        {
            segment.problem = None;
        }
    }

    /// Input for rebuilding the segments on the stage.
    #[must_use]
    pub fn rebuild(&self) -> RebuildRequest {
        RebuildRequest {
            requested: self.loaded.clone(),
            staged: self.staged.clone(),
            segments: self
                .segments
                .iter()
                .filter_map(|segment| segment.playable.clone())
                .collect(),
            earlier: self.earlier.clone(),
            must_reread: self.must_reread,
        }
    }

    /// Puts newly built segments on the stage; returns whether anything on the stage changes.
    ///
    /// The current settings stay, because they may have changed since the build started. While the
    /// number of segments stays the same, a segment whose replacement could not be built stays on
    /// the stage.
    pub fn restage(&mut self, built: BuiltProject) -> bool {
        let can_stay = built.segments.len() == self.segments.len();
        if can_stay
            && built
                .segments
                .iter()
                .all(|segment| segment.problem.is_some())
        {
            // Every replacement failed, so the segments on the stage stay as they are.
            let new = self.segments.iter_mut().zip(built.segments);
            new.for_each(|(segment, built)| segment.problem = built.problem);
            return false;
        }
        let is_reread = self.must_reread || load::reads_differently(&self.staged, &built.settings);
        if is_reread {
            // Segments of designs that have been read again since must not return.
            self.earlier.clear();
        } else {
            self.keep_earlier();
        }
        // The current settings, `loaded.project`, stay: they may be newer than those of the build.
        self.loaded.designs = built.project.designs;
        self.staged = built.settings;
        self.must_reread = false;
        let mut before = std::mem::take(&mut self.segments).into_iter();
        let merged = |built: BuiltSegment| {
            let old = before
                .next()
                .filter(|_| can_stay && built.problem.is_some());
            BuiltSegment {
                playable: old.and_then(|old| old.playable).or(built.playable),
                problem: built.problem,
            }
        };
        self.segments = built.segments.into_iter().map(merged).collect();
        self.select_segment(self.segment_index);
        true
    }

    /// Resets the settings to those that the stage was built from, and removes the rejected change
    /// from the undo history.
    pub fn reset_settings(&mut self) {
        self.must_reread = false;
        let method = self.method_on_stage();
        self.amend(|now, staged| {
            now.clone_from(staged);
            // If the requested method was refused on opening, the stage shows another one.
            if let Some(method) = method {
                (now.warp, now.content) = (Some(method.warp()), Some(method.content()));
            }
        });
        // The failed settings are no longer requested.
        self.clear_problems_of_shown_segments();
    }

    /// Method that all segments on the stage use; `None` if their methods differ or one has no
    /// transition.
    fn method_on_stage(&self) -> Option<TransitionMethod> {
        let method = |segment: &BuiltSegment| Some(segment.playable.as_ref()?.transition.method());
        let first = method(self.segments.first()?)?;
        let is_same = |segment: &BuiltSegment| method(segment) == Some(first);
        self.segments.iter().all(is_same).then_some(first)
    }

    /// Resets the designs to those on the stage, because the file of a new design cannot be read.
    pub fn reset_designs(&mut self) {
        self.must_reread = false;
        self.amend(|now, staged| {
            // With a different number of designs, the segments differ too, so all settings are
            // reset.
            if now.designs.len() == staged.designs.len() {
                now.designs.clone_from(&staged.designs);
                now.fit = staged.fit;
                // The title was dropped together with the designs.
                if now.title.is_empty() {
                    now.title.clone_from(&staged.title);
                }
            } else {
                now.clone_from(staged);
            }
        });
    }

    /// Changes the settings and corrects the last undo step accordingly. The arguments of `change`
    /// are the current settings and those that the stage was built from.
    fn amend(&mut self, change: impl FnOnce(&mut Project, &Project)) {
        let before = self.snapshot();
        change(&mut self.loaded.project, &self.staged);
        self.refresh_segment();
        self.history.amend(before, self.snapshot());
    }

    /// Whether another program or window has changed the project file since it was read or last
    /// saved.
    #[must_use]
    pub fn is_changed_elsewhere(&self) -> bool {
        let hash = self.loaded.file_hash;
        self.path()
            .is_some_and(|path| save::is_changed_elsewhere(path, hash))
    }

    /// Saves the project to `path`, which becomes its file.
    ///
    /// # Errors
    /// The project file or a bundled design cannot be written; the project stays as it was.
    pub fn save(&mut self, path: PathBuf) -> Result<(), SaveError> {
        // The matches found for the stage are saved only if they belong to the current settings.
        if !load::needs_build(&self.staged, &self.loaded.project) {
            for (k, segment) in self.segments.iter().enumerate() {
                if let Some(cached) = segment
                    .playable
                    .as_ref()
                    .and_then(|s| s.transition.cached_match())
                {
                    self.loaded.project.cache_match(k, cached);
                }
            }
        }
        save::save(&mut self.loaded, &path)?;
        self.refresh_segment();
        self.saved = self.loaded.project.clone();
        // Saving changes only the paths of designs, which requires no rebuild.
        if self.staged.designs.len() == self.saved.designs.len() {
            self.staged.designs.clone_from(&self.saved.designs);
            for (k, segment) in self.segments.iter_mut().enumerate() {
                if let Some(stage) = &mut segment.playable {
                    stage.settings.rename(&self.staged, k);
                }
            }
        }
        self.origin = ProjectOrigin::File(path);
        self.is_recovered = false;
        Ok(())
    }

    /// Current settings and project folder, for the undo history.
    fn snapshot(&self) -> ProjectSnapshot {
        ProjectSnapshot {
            project: self.loaded.project.clone(),
            folder: self.loaded.folder.clone(),
        }
    }
}

//! A project that is open: where it comes from, how it was changed, what of it is on the stage.

use std::path::{Path, PathBuf};

use crate::app::capturing::files::safe;
use crate::app::session::history::{History, Snapshot};
use crate::app::session::loading::{self, Loaded, Problem, Rebuild};
use crate::app::session::origin::Origin;
use crate::app::session::rescue::Kept;
use crate::app::session::saving::{self, SaveError};
use crate::design::Source;
use crate::one_line::OneLine;
use crate::project::{LoadedProject, Project, ProjectError};
use crate::transition::Transition;

/// A project that is open.
#[derive(Debug)]
pub struct Open {
    /// The settings as they are now, and the designs.
    pub loaded: LoadedProject,
    /// What is on the stage.
    pub transition: Option<Transition>,
    /// Why the settings, as they are now, make no transition.
    pub problem: Option<Problem>,
    /// The settings of what is on the stage.
    pub staged: Project,
    /// The steps that can be taken back.
    pub history: History,
    /// A file of its designs has changed.
    pub must_reread: bool,
    /// It was taken up again after the program had ended without saving it.
    pub is_rescued: bool,
    origin: Origin,
    /// As it was opened or saved last.
    saved: Project,
}

impl Open {
    /// A project that has just been read.
    #[must_use]
    pub fn new(loaded: Loaded, origin: Origin) -> Self {
        let project = loaded.project.project.clone();
        let (staged, transition) = match loaded.stage {
            Some(stage) => (stage.settings, Some(stage.transition)),
            None => (project.clone(), None),
        };
        Self {
            loaded: loaded.project,
            transition,
            problem: loaded.problem,
            staged,
            history: History::default(),
            must_reread: false,
            is_rescued: false,
            origin,
            saved: project,
        }
    }

    /// The same with changes that no file has: they were made before the program ended.
    #[must_use]
    pub fn unsaved(loaded: Loaded, origin: Origin) -> Self {
        Self {
            saved: Project::pair("", ""),
            is_rescued: true,
            ..Self::new(loaded, origin)
        }
    }

    /// What is kept of it until it is saved.
    ///
    /// # Errors
    /// As [`Kept::new`].
    pub fn kept(&self) -> Result<Kept, ProjectError> {
        Kept::new(self.title(), &self.origin, &self.loaded)
    }

    /// The file that it is saved to.
    #[must_use]
    pub fn path(&self) -> Option<&Path> {
        match &self.origin {
            Origin::File(path) => Some(path),
            Origin::Gallery(_) | Origin::Unsaved => None,
        }
    }

    /// Its name, where it is a bundled one.
    #[must_use]
    pub fn gallery_name(&self) -> Option<&str> {
        match &self.origin {
            Origin::Gallery(name) => Some(name),
            Origin::File(_) | Origin::Unsaved => None,
        }
    }

    /// The files that its designs are read from.
    #[must_use]
    pub fn files(&self) -> Vec<PathBuf> {
        let folder = self.loaded.folder.as_deref();
        let entries = self.loaded.project.designs.iter();
        let sources = entries.filter_map(|entry| match folder {
            Some(folder) => Some(Source::in_folder(folder, &entry.path)),
            // A file that took the place of a bundled design.
            None => entry.path.is_absolute().then(|| Source::of(&entry.path)),
        });
        sources
            .filter_map(|source| Some(source.file()?.to_owned()))
            .collect()
    }

    fn stem(&self) -> Option<String> {
        let stem = self.path().and_then(Path::file_stem);
        stem.map(|stem| OneLine(stem.to_string_lossy()).to_string())
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
        safe(&self.stem().or_else(name).unwrap_or_else(|| self.title()))
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
        self.history.note(before, self.snapshot(), mark);
    }

    /// Takes the settings of a step of the history; `false` where there is none.
    ///
    /// # Errors
    /// A bundled design that the step names cannot be written; the project is as it was.
    pub fn go(
        &mut self,
        step: impl FnOnce(&mut History) -> Option<Snapshot>,
    ) -> Result<bool, SaveError> {
        let Some(Snapshot { project, folder }) = step(&mut self.history) else {
            return Ok(false);
        };
        self.loaded.project = match &self.loaded.folder {
            // Saved elsewhere since: the step names its designs from a folder that is no longer the
            // project's.
            Some(now) if folder.as_ref() != Some(now) => {
                saving::named_from(project, folder.as_deref(), now)?
            }
            _ => project,
        };
        Ok(true)
    }

    /// Whether the settings make another transition than that on the stage. Where they are those
    /// of the stage again, there is no problem any more.
    pub fn is_stale(&mut self) -> bool {
        let is_stale = self.must_reread || loading::needs_build(&self.staged, &self.loaded.project);
        if !is_stale && self.transition.is_some() {
            self.problem = None;
        }
        is_stale
    }

    /// What is to be built where it is stale.
    #[must_use]
    pub fn rebuild(&self) -> Rebuild {
        Rebuild {
            now: self.loaded.clone(),
            staged: self.staged.clone(),
            transition: self.transition.clone(),
            must_reread: self.must_reread,
        }
    }

    /// Takes in what was built; whether there is a new transition. The settings may have changed
    /// again meanwhile: they stay, and so does what is on the stage where there is nothing new.
    pub fn restage(&mut self, built: Loaded) -> bool {
        self.problem = built.problem;
        // What was built in its place is on the stage already, or something better.
        let stage = built.stage.filter(|_| self.problem.is_none());
        let is_new = stage.is_some();
        if let Some(stage) = stage {
            // The settings are not taken from what was built: they may be newer.
            self.loaded.designs = built.project.designs;
            self.must_reread = false;
            (self.transition, self.staged) = (Some(stage.transition), stage.settings);
        }
        is_new
    }

    /// The settings go back to those of the stage; no step of the history is left of it.
    pub fn give_up_changes(&mut self) {
        self.must_reread = false;
        self.amend(|now, staged| now.clone_from(staged));
        // What could not be had is not asked for any more.
        self.problem.take_if(|_| self.transition.is_some());
    }

    /// The designs go back to those of the stage: a file that cannot be read is not kept.
    pub fn give_up_designs(&mut self) {
        self.must_reread = false;
        self.amend(|now, staged| {
            now.designs.clone_from(&staged.designs);
            now.fit = staged.fit;
        });
    }

    fn amend(&mut self, change: impl FnOnce(&mut Project, &Project)) {
        let before = self.snapshot();
        change(&mut self.loaded.project, &self.staged);
        self.history.amend(before, self.snapshot());
    }

    /// Writes it to a file, which is its file from then on.
    ///
    /// # Errors
    /// The document or a bundled design cannot be written; the project is as it was.
    pub fn save(&mut self, path: PathBuf) -> Result<(), SaveError> {
        let found = self.transition.as_ref().and_then(Transition::found);
        // What is on the stage may be another film than the project asks for, a draft of it.
        if let Some(found) =
            found.filter(|_| !loading::needs_build(&self.staged, &self.loaded.project))
        {
            self.loaded.project.found = found;
        }
        saving::save(&mut self.loaded, &path)?;
        self.saved = self.loaded.project.clone();
        // Only their names have changed, which is no reason to build again.
        self.staged.designs.clone_from(&self.saved.designs);
        self.origin = Origin::File(path);
        self.is_rescued = false;
        Ok(())
    }

    fn snapshot(&self) -> Snapshot {
        Snapshot {
            project: self.loaded.project.clone(),
            folder: self.loaded.folder.clone(),
        }
    }
}

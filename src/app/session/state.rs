//! The project that is open and the transition on the stage.
//!
//! Work that takes time runs in a [`Job`]: the stage shows the old transition until the new one is
//! ready, and keeps it where the new one cannot be had. While a build is running, newer settings
//! wait for it to end, so that a slider that is being dragged shows its way; a build that takes
//! long is given up for the newest settings.

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use bevy::prelude::Resource;

use crate::app::capturing::files::safe;
use crate::app::session::history::{History, Snapshot};
use crate::app::session::loading;
use crate::app::session::loading::{LoadError, Loaded, Problem, Rebuild, Request};
use crate::app::session::saving;
use crate::app::telling::job::Job;
use crate::content::ContentKind;
use crate::design::{Design, Form};
use crate::project::{LoadedProject, Project};
use crate::transition::{Stop, Timing, Transition};
use crate::warp::{Arap, WarpKind};

/// A build that takes longer is given up when the settings change again.
const PATIENCE: Duration = Duration::from_millis(1500);

/// Where the open project comes from.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Origin {
    /// A bundled project, by its name.
    Gallery(String),
    /// A file.
    File(PathBuf),
    /// Designs that were opened together, or a project that was changed beyond its file.
    Unsaved,
}

/// A project that is open.
#[derive(Debug)]
struct Open {
    loaded: Loaded,
    origin: Origin,
    /// As it was opened or saved last.
    saved: Project,
    /// As it is on the stage.
    staged: Project,
    history: History,
    /// Why the settings, as they are now, make no transition.
    problem: Option<Problem>,
}

impl Open {
    fn snapshot(&self) -> Snapshot {
        Snapshot {
            project: self.loaded.project.project.clone(),
            folder: self.loaded.project.folder.clone(),
        }
    }
}

/// Work that is going on.
#[derive(Debug)]
struct Work {
    job: Job<Result<Loaded, LoadError>>,
    started: Instant,
    kind: WorkKind,
}

#[derive(Clone, Debug, PartialEq)]
enum WorkKind {
    Open(Origin),
    Rebuild,
}

/// What [`Session::poll`] found.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Outcome {
    /// Another project is open.
    Opened,
    /// Another project is open, but it has no transition; a sentence for the user tells why.
    OpenedWithout(String),
    /// The open project has a new transition.
    Rebuilt,
    /// The settings make no transition, the old one stays; a sentence for the user.
    NotRebuilt(String),
    /// It did not work; a sentence for the user.
    Failed(String),
}

/// The project that is open, its transition, and the work on the next one.
#[derive(Resource, Debug, Default)]
pub struct Session {
    open: Option<Open>,
    work: Option<Work>,
    is_stale: bool,
}

static NO_TIMING: std::sync::LazyLock<Timing> = std::sync::LazyLock::new(Timing::default);

impl Session {
    /// The open project with all its settings.
    #[must_use]
    pub fn project(&self) -> Option<&Project> {
        self.open.as_ref().map(|open| &open.loaded.project.project)
    }

    /// The transition on the stage.
    #[must_use]
    pub fn transition(&self) -> Option<&Transition> {
        self.open.as_ref()?.loaded.transition.as_ref()
    }

    /// How time runs.
    #[must_use]
    pub fn timing(&self) -> &Timing {
        self.project().map_or(&NO_TIMING, |project| &project.timing)
    }

    /// The stops of the open project.
    #[must_use]
    pub fn stops(&self) -> &[Stop] {
        self.project().map_or(&[], |project| &project.stops)
    }

    /// The file that the project is saved to.
    #[must_use]
    pub fn path(&self) -> Option<&Path> {
        match &self.open.as_ref()?.origin {
            Origin::File(path) => Some(path),
            Origin::Gallery(_) | Origin::Unsaved => None,
        }
    }

    /// The bundled project that is open.
    #[must_use]
    pub fn gallery_name(&self) -> Option<&str> {
        match &self.open.as_ref()?.origin {
            Origin::Gallery(name) => Some(name),
            Origin::File(_) | Origin::Unsaved => None,
        }
    }

    /// What the open project is called.
    #[must_use]
    pub fn title(&self) -> String {
        let Some(project) = self.project() else {
            return String::new();
        };
        let stem = self
            .path()
            .and_then(Path::file_stem)
            .filter(|_| project.title.is_empty());
        let stem = stem.map(|stem| stem.to_string_lossy().into_owned());
        stem.or_else(|| Some(self.open.as_ref()?.loaded.project.title()))
            .unwrap_or_default()
    }

    /// What files that belong to the project are called.
    #[must_use]
    pub fn file_stem(&self) -> String {
        let stem = self
            .path()
            .and_then(Path::file_stem)
            .map(|s| s.to_string_lossy().into_owned());
        safe(
            &stem
                .or_else(|| self.gallery_name().map(str::to_owned))
                .unwrap_or_else(|| self.title()),
        )
    }

    /// There are changes that are not saved.
    #[must_use]
    pub fn is_dirty(&self) -> bool {
        self.open
            .as_ref()
            .is_some_and(|open| open.loaded.project.project != open.saved)
    }

    /// What to ask about them.
    #[must_use]
    pub fn unsaved_text(&self) -> String {
        format!("“{}” has changes that are not saved.", self.title())
    }

    /// Takes the changes for saved.
    pub fn forget_changes(&mut self) {
        if let Some(open) = &mut self.open {
            open.saved = open.loaded.project.project.clone();
        }
    }

    /// What is being worked on and how far it is.
    #[must_use]
    pub fn work(&self) -> Option<(&'static str, f64)> {
        self.work.as_ref().map(|work| work.job.progress())
    }

    /// How long the work has been going on.
    #[must_use]
    pub fn work_lasts(&self) -> Duration {
        self.work
            .as_ref()
            .map_or(Duration::ZERO, |work| work.started.elapsed())
    }

    /// Whether the open designs can be shown by this cell; otherwise why not.
    ///
    /// # Errors
    /// The reason, for a grey button.
    pub fn available(&self, warp: WarpKind, content: ContentKind) -> Result<(), String> {
        match &self.open {
            Some(open) => open
                .loaded
                .project
                .available(warp, content)
                .map_err(|error| error.to_string()),
            None => Err("no project is open".to_owned()),
        }
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
        self.open.as_ref().is_some_and(|open| {
            open.loaded
                .project
                .designs
                .iter()
                .any(|design| matches!(design.form, Form::Truss(_)))
        })
    }

    /// Opens something else, beside the stage.
    pub fn open(&mut self, request: Request, origin: Origin) {
        self.is_stale = false;
        self.start(WorkKind::Open(origin), request);
    }

    /// Changes the settings of the open project. Changes of one mark are one step of the history.
    pub fn edit(&mut self, project: Project, mark: Option<u64>) {
        let Some(open) = &mut self.open else {
            return;
        };
        let before = open.snapshot();
        open.loaded.project.project = project;
        open.history.note(before, open.snapshot(), mark);
        self.note_staleness();
    }

    /// Changes the open project; changes of one mark are one step of its history.
    pub fn change(&mut self, mark: Option<u64>, edit: impl FnOnce(&mut Project)) {
        let Some(project) = self.project() else {
            return;
        };
        let mut changed = project.clone();
        edit(&mut changed);
        if changed != *project {
            self.edit(changed, mark);
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
    /// A sentence for the user; the project is as it was.
    pub fn undo(&mut self) -> Result<bool, String> {
        self.go(History::undo)
    }

    /// Makes the change again that was taken back last; `false` where there is none.
    ///
    /// # Errors
    /// A sentence for the user; the project is as it was.
    pub fn redo(&mut self) -> Result<bool, String> {
        self.go(History::redo)
    }

    fn go(&mut self, step: impl FnOnce(&mut History) -> Option<Snapshot>) -> Result<bool, String> {
        let Some(open) = &mut self.open else {
            return Ok(false);
        };
        let Some(Snapshot { project, folder }) = step(&mut open.history) else {
            return Ok(false);
        };
        open.loaded.project.project = match &open.loaded.project.folder {
            Some(now) if folder.as_ref() != Some(now) => {
                saving::named_from(project, folder.as_deref(), now).map_err(|e| e.to_string())?
            }
            _ => project,
        };
        self.note_staleness();
        Ok(true)
    }

    fn note_staleness(&mut self) {
        let Some(open) = &mut self.open else {
            return;
        };
        self.is_stale = loading::needs_build(&open.staged, &open.loaded.project.project);
        if !self.is_stale && open.loaded.transition.is_some() {
            open.problem = None;
        }
    }

    /// The designs with the settings that the transition on the stage was built from.
    #[must_use]
    pub fn staged(&self) -> Option<LoadedProject> {
        let open = self.open.as_ref()?;
        open.loaded.transition.as_ref()?;
        Some(LoadedProject {
            project: open.staged.clone(),
            ..open.loaded.project.clone()
        })
    }

    /// Why the settings, as they are now, make no transition.
    #[must_use]
    pub fn problem(&self) -> Option<&str> {
        let problem = self.open.as_ref()?.problem.as_ref()?;
        Some(&problem.text)
    }

    /// The pins that the problem comes from, by their numbers in the project.
    #[must_use]
    pub fn problem_pins(&self) -> &[usize] {
        let problem = self.open.as_ref().and_then(|open| open.problem.as_ref());
        problem.map_or(&[], |problem| &problem.pins)
    }

    /// The designs as their files have them.
    #[must_use]
    pub fn designs(&self) -> &[Design] {
        let open = self.open.as_ref();
        open.map_or(&[], |open| &open.loaded.project.designs)
    }

    /// The settings that the transition on the stage was built from.
    #[must_use]
    pub fn staged_settings(&self) -> Option<&Project> {
        self.open.as_ref().map(|open| &open.staged)
    }

    /// Both designs are outlines: there is something to match.
    #[must_use]
    pub fn can_match(&self) -> bool {
        self.open.as_ref().is_some_and(|open| {
            let pair = open.loaded.project.designs.iter().take(2);
            pair.clone().count() == 2
                && pair.into_iter().all(|d| matches!(d.form, Form::Outline(_)))
        })
    }

    /// Gives up the work; the settings go back to what the stage shows.
    pub fn cancel(&mut self) {
        let Some(work) = self.work.take() else {
            return;
        };
        self.is_stale = false;
        if let (WorkKind::Rebuild, Some(open)) = (&work.kind, &mut self.open) {
            let before = open.snapshot();
            open.loaded.project.project = open.staged.clone();
            open.history.amend(before, open.snapshot());
        }
    }

    /// Writes the project to its file, or to another, which is its file from then on.
    ///
    /// # Errors
    /// A sentence for the user; the project is as it was.
    pub fn save(&mut self, to: Option<&Path>) -> Result<PathBuf, String> {
        let path = to.or(self.path()).map(Path::to_owned);
        let (Some(open), Some(path)) = (&mut self.open, path) else {
            return Err("There is no project to save.".to_owned());
        };
        saving::save(&mut open.loaded.project, &path).map_err(|error| error.to_string())?;
        open.saved = open.loaded.project.project.clone();
        open.staged.designs.clone_from(&open.saved.designs);
        open.origin = Origin::File(path.clone());
        Ok(path)
    }

    fn start(&mut self, kind: WorkKind, request: Request) {
        let job = Job::start("the transition", move |progress| {
            request.carry_out(progress)
        });
        self.work = Some(Work {
            job,
            started: Instant::now(),
            kind,
        });
    }

    /// Takes in work that is done and starts what waits for it.
    pub fn poll(&mut self) -> Option<Outcome> {
        let outcome = self.take_work();
        let is_free = match &self.work {
            None => true,
            Some(work) => work.kind == WorkKind::Rebuild && work.started.elapsed() > PATIENCE,
        };
        if self.is_stale
            && is_free
            && let Some(open) = &self.open
        {
            self.is_stale = false;
            let request = Request::Rebuild(Box::new(Rebuild {
                now: open.loaded.project.clone(),
                staged: open.staged.clone(),
                transition: open.loaded.transition.clone(),
            }));
            self.start(WorkKind::Rebuild, request);
        }
        outcome
    }

    fn take_work(&mut self) -> Option<Outcome> {
        let answer = self.work.as_ref()?.job.poll()?;
        let work = self.work.take()?;
        let result = answer.map_err(|broken| broken.to_string());
        let result = result.and_then(|done| done.map_err(|error| error.to_string()));
        Some(match (result, work.kind) {
            (Err(error), kind) => {
                if kind == WorkKind::Rebuild {
                    self.give_up_designs();
                }
                Outcome::Failed(error)
            }
            (Ok(loaded), WorkKind::Open(origin)) => self.adopt(loaded, origin),
            (Ok(loaded), WorkKind::Rebuild) => self.restage(loaded),
        })
    }

    fn adopt(&mut self, loaded: Loaded, origin: Origin) -> Outcome {
        self.is_stale = false;
        let project = loaded.project.project.clone();
        let problem = loaded.problem.clone();
        self.open = Some(Open {
            loaded,
            origin,
            saved: project.clone(),
            staged: project,
            history: History::default(),
            problem: problem.clone(),
        });
        problem.map_or(Outcome::Opened, |problem| {
            Outcome::OpenedWithout(problem.text)
        })
    }

    /// The settings may have changed again meanwhile: they stay, and so does what is on the stage
    /// where there is nothing new. A file that cannot be read is not kept among the designs.
    fn restage(&mut self, loaded: Loaded) -> Outcome {
        let Some(open) = &mut self.open else {
            return Outcome::Rebuilt;
        };
        open.problem.clone_from(&loaded.problem);
        if let Some(problem) = loaded.problem {
            return Outcome::NotRebuilt(problem.text);
        }
        open.loaded.transition = loaded.transition;
        open.loaded.project.designs = loaded.project.designs;
        open.staged = loaded.project.project;
        Outcome::Rebuilt
    }

    fn give_up_designs(&mut self) {
        if let Some(open) = &mut self.open {
            let before = open.snapshot();
            let project = &mut open.loaded.project.project;
            project.designs.clone_from(&open.staged.designs);
            project.fit = open.staged.fit;
            open.history.amend(before, open.snapshot());
        }
    }
}

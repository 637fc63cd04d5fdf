//! What takes time: reading files and building transitions, off the main thread.

use std::path::PathBuf;

use crate::app::session::origin::{Origin, absolute};
use crate::app::session::rescue::Kept;
use crate::correspondence::{PinError, RegionMatchError};
use crate::progress::{Cancelled, Progress, Span, checkpoint};
use crate::project::{LoadedProject, Project, ProjectError, gallery};
use crate::transition::{BuildError, Cell, Options, Style, Timing, Transition};

/// A project with its designs.
#[derive(Debug)]
pub struct Loaded {
    /// The project and its designs.
    pub project: LoadedProject,
    /// What can be played, if anything.
    pub stage: Option<Stage>,
    /// Why that is not what the project asks for.
    pub problem: Option<Problem>,
}

/// What can be played.
#[derive(Clone, Debug)]
pub struct Stage {
    /// What it was built from: the project's settings, or those with the plainest method.
    pub settings: Project,
    /// The transition.
    pub transition: Transition,
}

/// Why there is nothing to play.
#[derive(Debug, thiserror::Error)]
pub enum Problem {
    /// The settings do not go with the designs.
    #[error(transparent)]
    Project(#[from] ProjectError),
    /// No transition can be built from them.
    #[error(transparent)]
    Build(#[from] BuildError),
}

/// Work to be done.
#[derive(Clone, Debug)]
pub enum Request {
    /// Open a bundled project.
    Gallery(String),
    /// Open a project file.
    File(PathBuf),
    /// Open a project as it was before the program ended without saving it.
    Rescued(Box<Kept>),
    /// Open two designs as a new project.
    Pair(PathBuf, PathBuf),
    /// Build what is open with its new settings.
    Rebuild(Box<Rebuild>),
}

/// A project that is open, and what of it is on the stage.
#[derive(Clone, Debug)]
pub struct Rebuild {
    /// With the new settings and the old designs. Designs are read again where their file, or how
    /// it is read, has changed.
    pub now: LoadedProject,
    /// The settings of what is on the stage.
    pub staged: Project,
    /// What is on the stage.
    pub transition: Option<Transition>,
    /// A file of its designs has changed.
    pub must_reread: bool,
}

/// What is shown until what was asked for is there.
#[derive(Debug)]
pub enum Meanwhile {
    /// By the plainest method.
    Plain(Loaded),
    /// The first film of several.
    Draft(Loaded),
}

impl Rebuild {
    fn carry_out(
        self,
        progress: &dyn Progress,
        meanwhile: &mut dyn FnMut(Meanwhile),
    ) -> Result<Loaded, LoadError> {
        // Its sliders are dragged, and the distance transforms take far longer than the mixing.
        if !self.must_reread
            && let Some(transition) = self.mixed_otherwise().or_else(|| self.shown_otherwise())
        {
            return Ok(built(self.now, Ok(transition)));
        }
        let mut project = self.now;
        if self.must_reread || reads_differently(&self.staged, &project.project) {
            project = project.reread()?;
            choose_cell(&mut project);
        }
        Ok(built_by_steps(project, None, progress, meanwhile))
    }

    /// Where nothing but the times of parts and how coats lie has changed, the film is the same.
    fn shown_otherwise(&self) -> Option<Transition> {
        self.is_same_but_for(|options, now| {
            options.parts.clone_from(&now.parts);
            options.coats = now.coats;
        })?;
        let Options { parts, coats, .. } = self.now.spec().ok()?.options;
        let transition = self.transition.as_ref()?;
        Some(transition.with_coats(&coats).with_part_times(&parts))
    }

    /// Whether the settings on the stage would be the new ones if this were changed in them.
    fn is_same_but_for(&self, change: impl FnOnce(&mut Options, &Options)) -> Option<()> {
        let mut otherwise_same = self.staged.clone();
        change(&mut otherwise_same.options, &self.now.project.options);
        (!needs_build(&otherwise_same, &self.now.project)).then_some(())
    }

    /// Where nothing but the mixing of the fields has changed, they need not be measured again.
    fn mixed_otherwise(&self) -> Option<Transition> {
        self.is_same_but_for(|options, now| options.field.blend = now.field.blend)?;
        self.transition
            .as_ref()?
            .with_blend(self.now.project.options.field.blend)
            .ok()?
    }
}

/// Why nothing could be opened.
#[derive(Debug, thiserror::Error)]
pub enum LoadError {
    /// The project, or one of its designs.
    #[error(transparent)]
    Project(#[from] ProjectError),
    /// Nobody waits for it any more.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

impl Request {
    /// Where what it opens comes from; none where that is open already.
    #[must_use]
    pub fn origin(&self) -> Option<Origin> {
        Some(match self {
            Self::Gallery(name) => Origin::Gallery(name.clone()),
            Self::File(path) => Origin::File(path.clone()),
            Self::Rescued(kept) => kept.origin(),
            Self::Pair(..) => Origin::Unsaved,
            Self::Rebuild(_) => return None,
        })
    }

    /// The settings that it builds, where they are known before it is read.
    #[must_use]
    pub fn settings(&self) -> Option<&Project> {
        match self {
            Self::Rebuild(rebuild) => Some(&rebuild.now.project),
            Self::Gallery(_) | Self::File(_) | Self::Rescued(_) | Self::Pair(..) => None,
        }
    }

    /// Does the work. Where something is opened, `meanwhile` gets it by the plainest method before
    /// that which is asked for is built, and then as a draft; where the whole cannot be had, the
    /// last of these is the answer.
    ///
    /// # Errors
    /// The project or a design cannot be read. That a transition cannot be built from them is no
    /// error: it stands in the answer.
    pub fn carry_out(
        self,
        progress: &dyn Progress,
        mut meanwhile: impl FnMut(Meanwhile),
    ) -> Result<Loaded, LoadError> {
        checkpoint(progress, "Reading", 0.0)?;
        let mut project = match self {
            Self::Gallery(name) => gallery::load(&name)?,
            Self::File(path) => LoadedProject::open(&path)?,
            Self::Rescued(kept) => kept.load()?,
            Self::Pair(source, target) => {
                LoadedProject::open_pair(&absolute(&source), &absolute(&target))?
            }
            Self::Rebuild(rebuild) => return rebuild.carry_out(progress, &mut meanwhile),
        };
        choose_cell(&mut project);
        let plain = plainest(&project, progress);
        if plain.is_some() {
            meanwhile(Meanwhile::Plain(shown(&project, plain.clone())));
        }
        Ok(built_by_steps(project, plain, progress, &mut meanwhile))
    }
}

/// Writes down the cell that suits the designs, where the project names none that they can be
/// shown by, so that what the panel says is what the stage shows.
fn choose_cell(loaded: &mut LoadedProject) {
    let can = |cell: &Cell| loaded.available(cell.warp(), cell.content()).is_ok();
    let asked = loaded.cell().ok().filter(can);
    // What asks most of the designs comes first; what asks least is always among them.
    let suited = asked.or_else(|| Cell::all().find(can));
    if let Some(cell) = suited {
        loaded.project.warp = Some(cell.warp());
        loaded.project.content = Some(cell.content());
    }
}

fn built(project: LoadedProject, transition: Result<Transition, Problem>) -> Loaded {
    let (stage, problem) = match transition {
        Ok(transition) => {
            let settings = project.project.clone();
            let stage = Stage {
                settings,
                transition,
            };
            (Some(stage), None)
        }
        Err(problem) => (None, Some(problem)),
    };
    Loaded {
        project,
        stage,
        problem,
    }
}

/// How much of the work is done once there is a draft, as it is told: a quarter of most pairs'.
const DRAFTED: f64 = 0.25;

/// Builds what a project asks for, by way of a draft where that is sooner there; where it cannot be
/// had, the draft stands in its place, or what there is `already`.
fn built_by_steps(
    project: LoadedProject,
    already: Option<Stage>,
    progress: &dyn Progress,
    meanwhile: &mut dyn FnMut(Meanwhile),
) -> Loaded {
    let draft = draft(&project, &Span::new(progress, 0.0, DRAFTED));
    let from = if draft.is_some() { DRAFTED } else { 0.0 };
    if draft.is_some() {
        meanwhile(Meanwhile::Draft(shown(&project, draft.clone())));
    }
    let transition = transition_of(&project, &Span::new(progress, from, 1.0));
    let mut built = built(project, transition);
    built.stage = built.stage.or(draft).or(already);
    built
}

/// A project on the way to what it asks for.
fn shown(project: &LoadedProject, stage: Option<Stage>) -> Loaded {
    Loaded {
        project: project.clone(),
        stage,
        problem: None,
    }
}

/// The first film of a project that asks for the best of several; none where it asks for nothing
/// of the kind, or it cannot be had.
fn draft(project: &LoadedProject, progress: &dyn Progress) -> Option<Stage> {
    let spec = project.spec().ok()?.draft(progress)?;
    let mut settings = project.project.clone();
    settings.options.quality = spec.options.quality;
    let transition = Transition::build(&spec, progress).ok()?;
    Some(Stage {
        settings,
        transition,
    })
}

/// The transition of a project by the method that moves nothing, which is had of almost any two
/// designs, and at once; none where that is what it asks for.
fn plainest(project: &LoadedProject, progress: &dyn Progress) -> Option<Stage> {
    let asked = project.cell().ok()?;
    let cell = asked.plain();
    if cell == asked {
        return None;
    }
    let mut plain = project.clone();
    plain.project.warp = Some(cell.warp());
    plain.project.content = Some(cell.content());
    let transition = transition_of(&plain, &Unsaid(progress)).ok()?;
    Some(Stage {
        settings: plain.project,
        transition,
    })
}

/// Hears that it is cancelled and tells nothing: a bar that ran once would run again.
struct Unsaid<'a>(&'a dyn Progress);

impl Progress for Unsaid<'_> {
    fn report(&self, _stage: &'static str, _fraction: f64) {}

    fn is_cancelled(&self) -> bool {
        self.0.is_cancelled()
    }
}

/// Builds the transition of a project.
///
/// # Errors
/// The settings do not go with the designs, or no transition can be built from them.
pub fn transition_of(
    project: &LoadedProject,
    progress: &dyn Progress,
) -> Result<Transition, Problem> {
    Ok(Transition::build(&project.spec()?, progress)?)
}

impl Problem {
    /// It would take very long, or much memory, and can be had all the same.
    #[must_use]
    pub fn is_too_much(&self) -> bool {
        matches!(self, Self::Build(error) if matches!(error.reason(), BuildError::TooMuch(_)))
    }

    /// The pins that it comes from, by their numbers in the project.
    #[must_use]
    pub fn pins(&self) -> Vec<usize> {
        let Self::Build(error) = self else {
            return Vec::new();
        };
        match error.reason() {
            BuildError::Match(RegionMatchError::Pins(error)) => match error {
                PinError::NotFinite(a) => vec![*a],
                PinError::SamePoint(a, b) | PinError::Crossing(a, b) => vec![*a, *b],
            },
            BuildError::Match(RegionMatchError::PinAcross(a)) => vec![*a],
            // All else is wrong with the designs or the method, and no pin is to blame.
            _ => Vec::new(),
        }
    }
}

/// The settings that a transition is built from differ: all but those of how it is told, played
/// and painted.
#[must_use]
pub fn needs_build(staged: &Project, now: &Project) -> bool {
    let built = |project: &Project| Project {
        // Reset on both sides: a setting that is added later makes a new build, which may be
        // needless but is never wrong.
        title: String::new(),
        description: String::new(),
        timing: Timing::default(),
        style: Style::default(),
        stops: Vec::new(),
        ..project.clone()
    };
    built(staged) != built(now)
}

fn reads_differently(staged: &Project, now: &Project) -> bool {
    let reading = |project: &Project| -> Vec<_> {
        project
            .designs
            .iter()
            .map(|entry| (entry.path.clone(), entry.import))
            .collect()
    };
    reading(staged) != reading(now)
}

//! What takes time: reading files and building transitions, off the main thread.

use std::path::PathBuf;
use std::sync::Arc;

use crate::app::session::origin::{ProjectOrigin, absolute};
use crate::app::session::unsaved_project::UnsavedProject;
use crate::content::ContentKind;
use crate::correspondence::{PinError, RegionMatchError};
use crate::design::{Design, DesignForm};
use crate::project::{DesignEntry, LoadedProject, MapSettings, Project, ProjectError, gallery};
use crate::space::SpaceError;
use crate::transition::{
    BuildError, BuildQuality, DesignFit, Timing, Transition, TransitionMethod, TransitionOptions,
    TransitionStyle,
};
use crate::work::progress::{Cancelled, Progress, ProgressShares, ProgressSpan, checkpoint};

/// A project with its designs.
#[derive(Debug)]
pub struct BuiltProject {
    /// The project and its designs.
    pub project: LoadedProject,
    /// What its legs were built from: the project's settings, or those with the plainest
    /// method, or those of drafts.
    pub settings: Project,
    /// What there is of each leg.
    pub legs: Vec<BuiltSegment>,
}

/// What there is of a leg.
#[derive(Debug, Default)]
pub struct BuiltSegment {
    /// What can be played, if anything.
    pub stage: Option<PlayableSegment>,
    /// Why that is not what the project asks for.
    pub problem: Option<TransitionProblem>,
}

/// What can be played of a leg.
#[derive(Clone, Debug)]
pub struct PlayableSegment {
    /// What it was built from.
    pub settings: SegmentSettings,
    /// The transition.
    pub transition: Transition,
}

/// What a leg is built from.
#[derive(Clone, Debug)]
pub struct SegmentSettings {
    /// Two designs, and all that is said of them.
    pub pair: Project,
    /// The designs of the whole, where the leg hangs on them: they are laid over the first of
    /// them, and fields share one grid.
    among: Vec<DesignEntry>,
    /// The number of the leg, where it is one of a path over the map.
    path_leg: Option<usize>,
}

impl SegmentSettings {
    /// Those of a leg of a project.
    #[must_use]
    pub fn of(whole: &LoadedProject, leg: usize) -> Self {
        let project = &whole.project;
        let has_bars = |design: &Arc<Design>| matches!(design.form, DesignForm::Truss(_));
        let stands_alone = project.follows_path()
            || !project.is_sequence()
            || (project.content == Some(ContentKind::Solid)
                && project.fit == DesignFit::AsDrawn
                && !whole.designs.iter().any(has_bars));
        Self {
            pair: project.leg(leg),
            path_leg: project.follows_path().then_some(leg),
            among: if stands_alone {
                Vec::new()
            } else {
                project.designs.clone()
            },
        }
    }

    /// The designs have other names by now, and are the same.
    pub fn rename(&mut self, whole: &Project, leg: usize) {
        self.pair.designs = whole.leg(leg).designs;
        if !self.among.is_empty() {
            self.among.clone_from(&whole.designs);
        }
    }

    /// Whether another transition is to be built for these.
    fn needs_build(&self, now: &Self) -> bool {
        let own = (&self.among, self.path_leg);
        needs_build(&self.pair, &now.pair) || own != (&now.among, now.path_leg)
    }
}

/// Why there is nothing to play.
#[derive(Debug, thiserror::Error)]
pub enum TransitionProblem {
    /// The settings do not go with the designs.
    #[error(transparent)]
    Project(#[from] ProjectError),
    /// No transition can be built from them.
    #[error(transparent)]
    Build(#[from] BuildError),
}

/// Work to be done.
#[derive(Clone, Debug)]
pub enum LoadRequest {
    /// Open a bundled project.
    Gallery(String),
    /// Open a project file.
    File(PathBuf),
    /// Open a project as it was before the program ended without saving it.
    Rescued(Box<UnsavedProject>),
    /// Open designs, one after the other, as a new project.
    Designs(Vec<PathBuf>),
    /// Build what is open with its new settings.
    Rebuild(Box<RebuildRequest>),
}

/// A project that is open, and what of it is on the stage.
#[derive(Clone, Debug)]
pub struct RebuildRequest {
    /// With the new settings and the old designs. Designs are read again where their file, or how
    /// it is read, has changed.
    pub now: LoadedProject,
    /// The settings of what is on the stage.
    pub staged: Project,
    /// What is on the stage.
    pub stages: Vec<PlayableSegment>,
    /// A file of its designs has changed.
    pub must_reread: bool,
}

/// What is shown until what was asked for is there.
#[derive(Debug)]
pub enum InterimResult {
    /// By the plainest method.
    Plain(BuiltProject),
    /// The first film of several.
    Draft(BuiltProject),
}

impl RebuildRequest {
    fn carry_out(
        self,
        progress: &dyn Progress,
        meanwhile: &mut dyn FnMut(InterimResult),
    ) -> Result<BuiltProject, LoadError> {
        // Its sliders are dragged, and the distance transforms take far longer than the mixing.
        if !self.must_reread
            && let Some(stages) = self.mixed_otherwise().or_else(|| self.shown_otherwise())
        {
            return Ok(done(self.now, stages));
        }
        let (mut project, mut known) = (self.now, self.stages);
        if self.must_reread {
            project = project.reread()?;
            // Of files that have changed nothing is known any more.
            known.clear();
            choose_cell(&mut project);
        } else if reads_differently(&self.staged, &project.project) {
            project = project.read_beside(&self.staged)?;
            choose_cell(&mut project);
        }
        Ok(built_by_steps(
            project,
            &known,
            Vec::new(),
            progress,
            meanwhile,
        ))
    }

    /// Where nothing but the times of parts and how coats lie has changed, the film is the same.
    fn shown_otherwise(&self) -> Option<Vec<PlayableSegment>> {
        let change = |options: &mut TransitionOptions, now: &TransitionOptions| {
            options.parts.clone_from(&now.parts);
            options.coats = now.coats;
        };
        self.changed(change, |leg, transition| {
            let TransitionOptions { parts, coats, .. } = leg.spec().ok()?.options;
            Some(transition.with_coats(&coats).with_part_times(&parts))
        })
    }

    /// Where nothing but the mixing of the fields has changed, they need not be measured again.
    fn mixed_otherwise(&self) -> Option<Vec<PlayableSegment>> {
        let blend = self.now.project.options.field.blend;
        let change = |options: &mut TransitionOptions, now: &TransitionOptions| {
            options.field.blend = now.field.blend
        };
        self.changed(change, |_, transition| transition.with_blend(blend).ok()?)
    }

    /// Another transition of each leg, where what is on the stage would be what is asked for if
    /// this were changed in its settings. What stands there in place of what could not be had has
    /// other settings.
    fn changed(
        &self,
        change: impl Fn(&mut TransitionOptions, &TransitionOptions),
        make: impl Fn(&LoadedProject, &Transition) -> Option<Transition>,
    ) -> Option<Vec<PlayableSegment>> {
        // Designs that have come are not read yet.
        if self.now.project.leg_count() != self.stages.len() {
            return None;
        }
        let legs = self.now.legs();
        let made = legs.iter().zip(&self.stages).enumerate();
        let made = made.map(|(k, (leg, stage))| {
            let (mut was, settings) = (stage.settings.clone(), SegmentSettings::of(&self.now, k));
            change(&mut was.pair.options, &settings.pair.options);
            if was.needs_build(&settings) {
                return None;
            }
            Some(PlayableSegment {
                transition: make(leg, &stage.transition)?,
                settings,
            })
        });
        made.collect()
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

impl LoadRequest {
    /// Where what it opens comes from; none where that is open already.
    #[must_use]
    pub fn origin(&self) -> Option<ProjectOrigin> {
        Some(match self {
            Self::Gallery(name) => ProjectOrigin::Gallery(name.clone()),
            Self::File(path) => ProjectOrigin::File(path.clone()),
            Self::Rescued(kept) => kept.origin(),
            Self::Designs(_) => ProjectOrigin::Unsaved,
            Self::Rebuild(_) => return None,
        })
    }

    /// The settings that it builds, where they are known before it is read.
    #[must_use]
    pub fn settings(&self) -> Option<&Project> {
        match self {
            Self::Rebuild(rebuild) => Some(&rebuild.now.project),
            Self::Gallery(_) | Self::File(_) | Self::Rescued(_) | Self::Designs(_) => None,
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
        mut meanwhile: impl FnMut(InterimResult),
    ) -> Result<BuiltProject, LoadError> {
        checkpoint(progress, "Reading", 0.0)?;
        let mut project = match self {
            Self::Gallery(name) => gallery::load(&name)?,
            Self::File(path) => LoadedProject::open(&path)?,
            Self::Rescued(kept) => kept.load()?,
            Self::Designs(paths) => {
                let project = Project::of(paths.iter().map(|path| absolute(path)));
                LoadedProject::load(project, Some(PathBuf::new()))?
            }
            Self::Rebuild(rebuild) => return rebuild.carry_out(progress, &mut meanwhile),
        };
        choose_cell(&mut project);
        let plain = plainest(&project, progress);
        let stages = plain.as_ref().map_or_else(Vec::new, |plain| plain.stages());
        if let Some(plain) = plain {
            meanwhile(InterimResult::Plain(plain));
        }
        Ok(built_by_steps(
            project,
            &[],
            stages,
            progress,
            &mut meanwhile,
        ))
    }
}

/// Writes down the cell that suits the designs, where the project names none that they can be
/// shown by, so that what the panel says is what the stage shows.
fn choose_cell(loaded: &mut LoadedProject) {
    let legs = loaded.legs();
    let can = |cell: &TransitionMethod| {
        let can = |leg: &LoadedProject| leg.available(cell.warp(), cell.content()).is_ok();
        legs.iter().all(can)
    };
    let asked = legs[0].cell().ok().filter(can);
    // What asks most of the designs comes first; what asks least is always among them.
    let suited = asked.or_else(|| TransitionMethod::all().find(can));
    if let Some(cell) = suited {
        loaded.project.warp = Some(cell.warp());
        loaded.project.content = Some(cell.content());
    }
}

impl BuiltProject {
    fn stages(&self) -> Vec<Option<PlayableSegment>> {
        self.legs.iter().map(|leg| leg.stage.clone()).collect()
    }
}

/// A project all of whose legs are as it asks for.
fn done(project: LoadedProject, stages: Vec<PlayableSegment>) -> BuiltProject {
    let leg = |stage| BuiltSegment {
        stage: Some(stage),
        problem: None,
    };
    BuiltProject {
        settings: project.project.clone(),
        legs: stages.into_iter().map(leg).collect(),
        project,
    }
}

/// How much of the work is done once there is a draft, as it is told: a quarter of most pairs'.
const DRAFTED: f64 = 0.25;

/// Builds what a project asks for, by way of drafts where these are sooner there; where it cannot be
/// had, the draft stands in its place, or what there is `already`. Legs that are `known` stay as
/// they are.
fn built_by_steps(
    project: LoadedProject,
    known: &[PlayableSegment],
    already: Vec<Option<PlayableSegment>>,
    progress: &dyn Progress,
    meanwhile: &mut dyn FnMut(InterimResult),
) -> BuiltProject {
    let legs = project.legs();
    let known: Vec<Option<PlayableSegment>> = (0..legs.len())
        .map(|leg| of_settings(known, &SegmentSettings::of(&project, leg)))
        .collect();
    let drafting = ProgressShares::new(progress, legs.len());
    let draft = |leg: usize| {
        let part = drafting.part(leg);
        let is_known = known[leg].is_some();
        let draft = (!is_known).then(|| {
            draft(
                &project,
                (leg, &legs[leg]),
                &ProgressSpan::new(&part, 0.0, DRAFTED),
            )
        });
        draft.flatten()
    };
    let drafts: Vec<Option<PlayableSegment>> = (0..legs.len()).map(draft).collect();
    let has_drafts = drafts.iter().any(Option::is_some);
    let standing = |leg: usize| {
        let before = already.get(leg).cloned().flatten();
        known[leg].clone().or(drafts[leg].clone()).or(before)
    };
    if has_drafts {
        let stages = (0..legs.len()).map(standing).collect();
        let mut settings = project.project.clone();
        settings.options.quality = BuildQuality::Draft;
        meanwhile(InterimResult::Draft(shown(&project, settings, stages)));
    }
    let from = if has_drafts { DRAFTED } else { 0.0 };
    let building = ProgressSpan::new(progress, from, 1.0);
    let building = ProgressShares::new(&building, legs.len());
    let built = (0..legs.len()).map(|leg| match &known[leg] {
        Some(stage) => BuiltSegment {
            stage: Some(stage.clone()),
            problem: None,
        },
        None => built(
            &project,
            (leg, &legs[leg]),
            standing(leg),
            &building.part(leg),
        ),
    });
    BuiltProject {
        settings: project.project.clone(),
        legs: built.collect(),
        project,
    }
}

/// A leg as the project asks for it; where it cannot be had, what stands in its place.
fn built(
    whole: &LoadedProject,
    (leg, project): (usize, &LoadedProject),
    standing: Option<PlayableSegment>,
    progress: &dyn Progress,
) -> BuiltSegment {
    match transition_of(project, progress) {
        Ok(transition) => BuiltSegment {
            stage: Some(PlayableSegment {
                settings: SegmentSettings::of(whole, leg),
                transition,
            }),
            problem: None,
        },
        Err(problem) => BuiltSegment {
            stage: standing,
            problem: Some(problem),
        },
    }
}

/// What was built from these settings before.
fn of_settings(known: &[PlayableSegment], settings: &SegmentSettings) -> Option<PlayableSegment> {
    let found = known
        .iter()
        .find(|stage| !stage.settings.needs_build(settings));
    found.cloned()
}

/// A project on the way to what it asks for.
fn shown(
    project: &LoadedProject,
    settings: Project,
    stages: Vec<Option<PlayableSegment>>,
) -> BuiltProject {
    let leg = |stage| BuiltSegment {
        stage,
        problem: None,
    };
    BuiltProject {
        project: project.clone(),
        settings,
        legs: stages.into_iter().map(leg).collect(),
    }
}

/// The first film of a leg that asks for the best of several; none where it asks for nothing
/// of the kind, or it cannot be had.
fn draft(
    whole: &LoadedProject,
    (leg, project): (usize, &LoadedProject),
    progress: &dyn Progress,
) -> Option<PlayableSegment> {
    let (quality, transition) = project.draft(progress)?;
    let mut settings = SegmentSettings::of(whole, leg);
    settings.pair.options.quality = quality;
    Some(PlayableSegment {
        settings,
        transition,
    })
}

/// The transitions of a project by the method that moves nothing, which is had of almost any two
/// designs, and at once; none where that is what it asks for.
fn plainest(project: &LoadedProject, progress: &dyn Progress) -> Option<BuiltProject> {
    let asked = project.legs()[0].cell().ok()?;
    let cell = asked.plain();
    if cell == asked {
        return None;
    }
    let mut plain = project.clone();
    plain.project.warp = Some(cell.warp());
    plain.project.content = Some(cell.content());
    let stage = |(leg, pair): (usize, &LoadedProject)| {
        Some(PlayableSegment {
            settings: SegmentSettings::of(&plain, leg),
            transition: transition_of(pair, &CancelOnlyProgress(progress)).ok()?,
        })
    };
    let stages = plain.legs().iter().enumerate().map(stage).collect();
    Some(shown(project, plain.project.clone(), stages))
}

/// Hears that it is cancelled and tells nothing: a bar that ran once would run again.
struct CancelOnlyProgress<'a>(&'a dyn Progress);

impl Progress for CancelOnlyProgress<'_> {
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
) -> Result<Transition, TransitionProblem> {
    project.build(progress).map_err(|error| match error {
        ProjectError::Build(error) | ProjectError::Space(SpaceError::Build(error)) => {
            TransitionProblem::Build(error)
        }
        error => TransitionProblem::Project(error),
    })
}

impl TransitionProblem {
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
        style: TransitionStyle::default(),
        stops: Vec::new(),
        map: MapSettings::default(),
        ..project.clone()
    };
    !staged.map.plays_as(&now.map) || built(staged) != built(now)
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

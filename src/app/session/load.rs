//! Reads project and design files and builds transitions; runs in a background job.

use std::path::PathBuf;
use std::sync::Arc;

use crate::app::session::origin::{ProjectOrigin, absolute};
use crate::app::session::transition_problem::TransitionProblem;
use crate::app::session::unsaved_project::UnsavedProject;
use crate::content::ContentKind;
use crate::design::{Design, DesignForm};
use crate::project::{DesignEntry, LoadedProject, MapSettings, Project, ProjectError, gallery};
use crate::space::SpaceError;
use crate::transition::{
    BuildQuality, Timing, Transition, TransitionMethod, TransitionOptions, TransitionStyle,
};
use crate::work::progress::{Cancelled, Progress, ProgressShares, ProgressSpan, checkpoint};

/// A project with its designs and the transitions built from it.
#[derive(Debug)]
pub struct BuiltProject {
    /// The project and its designs.
    pub project: LoadedProject,
    /// Settings that the transitions were built from: those of `project` or, in an interim result,
    /// those of the plainest method (a blend without a warp) or of a draft.
    pub settings: Project,
    /// One entry per segment of the film.
    pub segments: Vec<BuiltSegment>,
}

/// Result of building one segment: the section of the film between two consecutive designs.
#[derive(Debug, Default)]
pub struct BuiltSegment {
    /// The transition to show and its settings; `None` if none could be built.
    pub playable: Option<PlayableSegment>,
    /// Reason why the requested transition could not be built; `None` if it was.
    pub problem: Option<TransitionProblem>,
}

/// A built segment that can be played.
#[derive(Clone, Debug)]
pub struct PlayableSegment {
    /// Settings that the transition was built from.
    pub settings: SegmentSettings,
    /// Transition between the two designs of the segment.
    pub transition: Transition,
}

/// All settings that determine a segment's transition.
#[derive(Clone, Debug)]
pub struct SegmentSettings {
    /// The two designs of the segment and their settings.
    pub segment_project: Project,
    /// All designs of the project, if the segment's transition depends on all of them: because they
    /// are aligned with the first design, or because their fields share one grid. Empty otherwise.
    all_designs: Vec<DesignEntry>,
    /// Index of the segment, if it belongs to a path on the map.
    path_segment: Option<usize>,
}

impl SegmentSettings {
    /// Settings of one segment of a project.
    #[must_use]
    pub fn of(loaded: &LoadedProject, segment: usize) -> Self {
        let project = &loaded.project;
        let is_truss = |design: &Arc<Design>| matches!(design.form, DesignForm::Truss(_));
        let is_independent = project.follows_path()
            || !project.is_sequence()
            || (project.content == Some(ContentKind::Solid)
                && !project.fit.depends_on_first(&loaded.designs)
                && !loaded.designs.iter().any(is_truss));
        Self {
            segment_project: project.segment(segment),
            path_segment: project.follows_path().then_some(segment),
            all_designs: if is_independent {
                Vec::new()
            } else {
                project.designs.clone()
            },
        }
    }

    /// Adopts new file names of unchanged designs, as after saving to another folder.
    pub fn rename(&mut self, project: &Project, segment_index: usize) {
        self.segment_project.designs = project.segment(segment_index).designs;
        if !self.all_designs.is_empty() {
            self.all_designs.clone_from(&project.designs);
        }
    }

    /// Whether the settings `now` require another transition than these settings.
    fn needs_build(&self, now: &Self) -> bool {
        let context = (&self.all_designs, self.path_segment);
        needs_build(&self.segment_project, &now.segment_project)
            || context != (&now.all_designs, now.path_segment)
    }
}

/// A request to open or rebuild a project.
#[derive(Clone, Debug)]
pub enum LoadRequest {
    /// Open a gallery project.
    Gallery(String),
    /// Open a project file.
    File(PathBuf),
    /// Open a project recovered from an autosave.
    Recovered(Box<UnsavedProject>),
    /// Open designs, in this order, as a new project.
    Designs(Vec<PathBuf>),
    /// Rebuild the open project with changed settings.
    Rebuild(Box<RebuildRequest>),
}

/// Input for rebuilding the open project: its new settings, and the segments on the stage, which
/// may be reused.
#[derive(Clone, Debug)]
pub struct RebuildRequest {
    /// New settings with the old designs. A design is read again if the new settings name another
    /// file or import it differently.
    pub requested: LoadedProject,
    /// Settings that the segments on the stage were built from.
    pub staged: Project,
    /// Segments on the stage.
    pub segments: Vec<PlayableSegment>,
    /// Segments that were on the stage before.
    pub earlier: Vec<PlayableSegment>,
    /// Whether a design file has changed on disk, so that all designs are read again.
    pub must_reread: bool,
}

/// Result that is shown while the requested one is being built.
#[derive(Debug)]
pub enum InterimResult {
    /// Built by the plainest method: a blend without a warp.
    Plain(BuiltProject),
    /// A draft: the first film found, before the search for a better one.
    Draft(BuiltProject),
}

impl RebuildRequest {
    /// Rebuilds the segments, reusing those on the stage as far as possible.
    fn carry_out(
        self,
        progress: &dyn Progress,
        on_interim: &mut dyn FnMut(InterimResult),
    ) -> Result<BuiltProject, LoadError> {
        // For some changes, new segments are derived quickly from those on the stage, so that the
        // stage follows a dragged slider.
        if !self.must_reread
            && let Some(stages) = self
                .with_new_field_blend()
                .or_else(|| self.with_new_part_times())
        {
            return Ok(fully_built(self.requested, stages));
        }
        let mut reusable = [self.segments, self.earlier].concat();
        let mut project = self.requested;
        if self.must_reread {
            project = project.reread()?;
            // Segments built from the old files cannot be reused.
            reusable.clear();
            choose_method(&mut project);
        } else if reads_differently(&self.staged, &project.project) {
            project = project.reread_changed(&self.staged)?;
            choose_method(&mut project);
        }
        Ok(build_in_steps(
            project,
            &reusable,
            Vec::new(),
            progress,
            on_interim,
        ))
    }

    /// Segments derived from those on the stage, if only the time windows of parts or the order of
    /// paint layers have changed; `None` otherwise.
    fn with_new_part_times(&self) -> Option<Vec<PlayableSegment>> {
        let change = |options: &mut TransitionOptions, now: &TransitionOptions| {
            options.parts.clone_from(&now.parts);
            options.coats = now.coats;
        };
        self.reuse_segments(change, |segment, transition| {
            let TransitionOptions { parts, coats, .. } = segment.spec().ok()?.options;
            Some(transition.with_paint_layers(&coats).with_part_times(&parts))
        })
    }

    /// Segments that reuse the distance transforms of those on the stage, if only the blend of the
    /// distance fields has changed; `None` otherwise.
    fn with_new_field_blend(&self) -> Option<Vec<PlayableSegment>> {
        let blend = self.requested.project.options.field.blend;
        let change = |options: &mut TransitionOptions, now: &TransitionOptions| {
            options.field.blend = now.field.blend
        };
        self.reuse_segments(change, |_, transition| transition.with_blend(blend).ok()?)
    }

    /// Derives the new transition of each segment with `make` from the one on the stage. Returns
    /// `None` if the settings differ in more than the options that `change` copies from the new
    /// settings to the old ones.
    ///
    /// A fallback on the stage, shown for a segment that could not be built, has other settings and
    /// is never reused.
    fn reuse_segments(
        &self,
        change: impl Fn(&mut TransitionOptions, &TransitionOptions),
        make: impl Fn(&LoadedProject, &Transition) -> Option<Transition>,
    ) -> Option<Vec<PlayableSegment>> {
        // With another number of segments, designs may have been added that have not been read yet.
        if self.requested.project.segment_count() != self.segments.len() {
            return None;
        }
        let segments = self.requested.segments();
        let pairs = segments.iter().zip(&self.segments).enumerate();
        let reused = pairs.map(|(k, (segment, stage))| {
            let (mut staged_settings, settings) = (
                stage.settings.clone(),
                SegmentSettings::of(&self.requested, k),
            );
            change(
                &mut staged_settings.segment_project.options,
                &settings.segment_project.options,
            );
            if staged_settings.needs_build(&settings) {
                return None;
            }
            Some(PlayableSegment {
                transition: make(segment, &stage.transition)?,
                settings,
            })
        });
        reused.collect()
    }
}

/// Reason why a project could not be opened or rebuilt.
#[derive(Debug, thiserror::Error)]
pub enum LoadError {
    /// The project or one of its designs cannot be read.
    #[error(transparent)]
    Project(#[from] ProjectError),
    /// The request was cancelled.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

impl LoadRequest {
    /// Origin of the project to open; `None` for a rebuild.
    #[must_use]
    pub fn origin(&self) -> Option<ProjectOrigin> {
        Some(match self {
            Self::Gallery(name) => ProjectOrigin::Gallery(name.clone()),
            Self::File(path) => ProjectOrigin::File(path.clone()),
            Self::Recovered(unsaved) => unsaved.origin(),
            Self::Designs(_) => ProjectOrigin::Unsaved,
            Self::Rebuild(_) => return None,
        })
    }

    /// Settings to be built, if known before reading any file: only for a rebuild.
    #[must_use]
    pub fn settings(&self) -> Option<&Project> {
        match self {
            Self::Rebuild(rebuild) => Some(&rebuild.requested.project),
            Self::Gallery(_) | Self::File(_) | Self::Recovered(_) | Self::Designs(_) => None,
        }
    }

    /// Carries out the request.
    ///
    /// When opening, `on_interim` receives the project built by the plainest method, and then a
    /// draft, while the requested transition is being built. If the requested transition cannot be
    /// built, the last interim result takes its place.
    ///
    /// # Errors
    /// The project or a design cannot be read. A transition that cannot be built is no error: the
    /// returned segment contains the reason.
    pub fn carry_out(
        self,
        progress: &dyn Progress,
        mut on_interim: impl FnMut(InterimResult),
    ) -> Result<BuiltProject, LoadError> {
        checkpoint(progress, "Reading", 0.0)?;
        let mut project = match self {
            Self::Gallery(name) => gallery::load(&name)?,
            Self::File(path) => LoadedProject::open(&path)?,
            Self::Recovered(unsaved) => unsaved.load()?,
            Self::Designs(paths) => {
                let project = Project::from_paths(paths.iter().map(|path| absolute(path)));
                let mut loaded = LoadedProject::load(project, Some(PathBuf::new()))?;
                loaded.adopt_drawn_colours();
                loaded
            }
            Self::Rebuild(rebuild) => return rebuild.carry_out(progress, &mut on_interim),
        };
        choose_method(&mut project);
        let plain = build_plainest(&project, progress);
        let stages = plain.as_ref().map_or_else(Vec::new, |plain| plain.stages());
        if let Some(plain) = plain {
            on_interim(InterimResult::Plain(plain));
        }
        Ok(build_in_steps(
            project,
            &[],
            stages,
            progress,
            &mut on_interim,
        ))
    }
}

/// Replaces an unspecified or unsupported method by one that suits the designs, so that the panel
/// names the method that the stage shows.
fn choose_method(loaded: &mut LoadedProject) {
    let segments = loaded.segments();
    let suits_all = |method: &TransitionMethod| {
        let suits = |segment: &LoadedProject| {
            segment
                .check_available(method.warp(), method.content())
                .is_ok()
        };
        segments.iter().all(suits)
    };
    let requested = segments[0].method().ok().filter(suits_all);
    // Methods with the strictest requirements come first; the last one suits any designs.
    let chosen = requested.or_else(|| TransitionMethod::all().find(suits_all));
    if let Some(method) = chosen {
        loaded.project.warp = Some(method.warp());
        loaded.project.content = Some(method.content());
    }
}

impl BuiltProject {
    /// For each segment, its transition and settings; `None` if it could not be built.
    fn stages(&self) -> Vec<Option<PlayableSegment>> {
        self.segments
            .iter()
            .map(|segment| segment.playable.clone())
            .collect()
    }
}

/// A project whose segments are all built as requested.
fn fully_built(project: LoadedProject, stages: Vec<PlayableSegment>) -> BuiltProject {
    let built_segment = |stage| BuiltSegment {
        playable: Some(stage),
        problem: None,
    };
    BuiltProject {
        settings: project.project.clone(),
        segments: stages.into_iter().map(built_segment).collect(),
        project,
    }
}

/// Progress, in [0, 1], at which all drafts are built and the final builds begin (heuristic).
const DRAFT_SHARE: f64 = 0.25;

/// Builds the segments of a project, with drafts first where they are quicker.
///
/// A segment that `reusable` contains with the same settings is not built again. A segment that
/// cannot be built is replaced by its draft, or else by its entry in `plain`.
fn build_in_steps(
    project: LoadedProject,
    reusable: &[PlayableSegment],
    plain: Vec<Option<PlayableSegment>>,
    progress: &dyn Progress,
    on_interim: &mut dyn FnMut(InterimResult),
) -> BuiltProject {
    let segments = project.segments();
    let reusable: Vec<Option<PlayableSegment>> = (0..segments.len())
        .map(|index| find_reusable(reusable, &SegmentSettings::of(&project, index)))
        .collect();
    let drafting = ProgressShares::new(progress, segments.len());
    let draft = |index: usize| {
        let part = drafting.part(index);
        let is_known = reusable[index].is_some();
        let span = ProgressSpan::new(&part, 0.0, DRAFT_SHARE);
        let draft = (!is_known).then(|| draft(&project, index, &segments[index], &span));
        draft.flatten()
    };
    let drafts: Vec<Option<PlayableSegment>> = (0..segments.len()).map(draft).collect();
    let has_drafts = drafts.iter().any(Option::is_some);
    // The fallback is shown until the segment is built, and stays if building it fails.
    let fallback = |index: usize| {
        let before = plain.get(index).cloned().flatten();
        reusable[index].clone().or(drafts[index].clone()).or(before)
    };
    if has_drafts {
        let stages = (0..segments.len()).map(fallback).collect();
        let mut settings = project.project.clone();
        settings.options.quality = BuildQuality::Draft;
        on_interim(InterimResult::Draft(with_interim_segments(
            &project, settings, stages,
        )));
    }
    let from = if has_drafts { DRAFT_SHARE } else { 0.0 };
    let building = ProgressSpan::new(progress, from, 1.0);
    let building = ProgressShares::new(&building, segments.len());
    let built = (0..segments.len()).map(|index| match &reusable[index] {
        Some(stage) => BuiltSegment {
            playable: Some(stage.clone()),
            problem: None,
        },
        None => build_segment(
            &project,
            index,
            &segments[index],
            fallback(index),
            &building.part(index),
        ),
    });
    BuiltProject {
        settings: project.project.clone(),
        segments: built.collect(),
        project,
    }
}

/// Builds one segment; if that fails, `fallback` takes its place.
fn build_segment(
    whole_project: &LoadedProject,
    index: usize,
    project: &LoadedProject,
    fallback: Option<PlayableSegment>,
    progress: &dyn Progress,
) -> BuiltSegment {
    match transition_of(project, progress) {
        Ok(transition) => BuiltSegment {
            playable: Some(PlayableSegment {
                settings: SegmentSettings::of(whole_project, index),
                transition,
            }),
            problem: None,
        },
        Err(problem) => BuiltSegment {
            playable: fallback,
            problem: Some(problem),
        },
    }
}

/// The candidate that was built from the settings `settings`; `None` if there is none.
pub fn find_reusable(
    candidates: &[PlayableSegment],
    settings: &SegmentSettings,
) -> Option<PlayableSegment> {
    let same = candidates
        .iter()
        .find(|stage| !stage.settings.needs_build(settings));
    same.cloned()
}

/// Interim result: a project with segments that were built from `settings`.
fn with_interim_segments(
    project: &LoadedProject,
    settings: Project,
    stages: Vec<Option<PlayableSegment>>,
) -> BuiltProject {
    let built_segment = |stage| BuiltSegment {
        playable: stage,
        problem: None,
    };
    BuiltProject {
        project: project.clone(),
        settings,
        segments: stages.into_iter().map(built_segment).collect(),
    }
}

/// Draft of a segment. `None` if its settings do not ask for the best of several films, or if the
/// draft cannot be built.
fn draft(
    whole_project: &LoadedProject,
    index: usize,
    project: &LoadedProject,
    progress: &dyn Progress,
) -> Option<PlayableSegment> {
    let (quality, transition) = project.draft(progress)?;
    let mut settings = SegmentSettings::of(whole_project, index);
    settings.segment_project.options.quality = quality;
    Some(PlayableSegment {
        settings,
        transition,
    })
}

/// Segments built by the method without a warp, which suits almost any two designs and takes hardly
/// any time; `None` if the project asks for that method anyway.
fn build_plainest(project: &LoadedProject, progress: &dyn Progress) -> Option<BuiltProject> {
    let requested = project.segments()[0].method().ok()?;
    let method = requested.fallback();
    if method == requested {
        return None;
    }
    let mut plain = project.clone();
    plain.project.warp = Some(method.warp());
    plain.project.content = Some(method.content());
    let stage = |(index, pair): (usize, &LoadedProject)| {
        Some(PlayableSegment {
            settings: SegmentSettings::of(&plain, index),
            transition: transition_of(pair, &CancelOnlyProgress(progress)).ok()?,
        })
    };
    let stages = plain.segments().iter().enumerate().map(stage).collect();
    Some(with_interim_segments(
        project,
        plain.project.clone(),
        stages,
    ))
}

/// Forwards cancellation but hides progress; otherwise the progress bar would run twice.
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
/// The settings do not fit the designs, or no transition can be built from them.
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

/// Whether two projects differ in settings that affect a transition: all settings except title,
/// description, timing, stops, colours and the layout of the map.
#[must_use]
pub fn needs_build(staged: &Project, now: &Project) -> bool {
    let relevant = |project: &Project| Project {
        // Settings without effect on the transition are reset in both projects; all others are
        // compared. A setting added later therefore causes a rebuild by default, which is never
        // wrong.
        title: String::new(),
        description: String::new(),
        timing: Timing::default(),
        style: TransitionStyle::default(),
        stops: Vec::new(),
        map: MapSettings::default(),
        ..project.clone()
    };
    !staged.map.has_same_film(&now.map) || relevant(staged) != relevant(now)
}

/// Whether some design is read from another file or in another way.
#[must_use]
pub fn reads_differently(staged: &Project, now: &Project) -> bool {
    let reading = |project: &Project| -> Vec<_> {
        project
            .designs
            .iter()
            .map(|entry| (entry.path.clone(), entry.import))
            .collect()
    };
    reading(staged) != reading(now)
}

//! Systems that open, edit and save projects: they apply the intents that change the [`Session`]
//! and report the results as notices.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use bevy::ecs::system::SystemParam;
use bevy::prelude::{
    Commands, DetectChanges, DetectChangesMut, Local, MessageReader, Res, ResMut, Resource,
};

use crate::app::editing::editor::MatchEditor;
use crate::app::files::drop::DroppedDesign;
use crate::app::files::invitation::START_PROJECT;
use crate::app::input::gesture::Gesture;
use crate::app::input::intent::Intent;
use crate::app::notices::{NoticeTopic, Notices};
use crate::app::playback::player::{Playback, STOP_TOLERANCE_T};
use crate::app::presentation::presenter::Presentation;
use crate::app::session::load::LoadRequest;
use crate::app::session::origin::absolute;
use crate::app::session::save::SaveError;
use crate::app::session::save_conflict::ConflictQuestion;
use crate::app::session::state::{Session, WorkOutcome};
use crate::app::session::transition_problem::TransitionProblem;
use crate::app::stage_area::AutoFit;
use crate::app::unsaved_question::{UnsavedKind, UnsavedQuestion};
use crate::content::ContentKind;
use crate::design::Design;
use crate::project::{DesignEntry, Project, gallery};
use crate::transition::{PlayMode, Transition, TransitionStop};
use crate::warp::WarpKind;

/// Opens projects and designs; asks first if unsaved changes would be lost.
pub fn open(
    mut intents: MessageReader<Intent>,
    mut session: ResMut<Session>,
    mut question: ResMut<UnsavedQuestion>,
    mut drop: ResMut<DroppedDesign>,
    mut notices: ResMut<Notices>,
    mut to_play: ResMut<PlayWhenOpened>,
) {
    for intent in intents.read() {
        if matches!(intent, Intent::Open(_)) {
            // Files opened now replace those that the question is about.
            drop.close();
        }
        let request = match intent {
            Intent::New => {
                if session.is_dirty() {
                    question.ask(intent.clone(), UnsavedKind::Changes, session.unsaved_text());
                } else {
                    session.close();
                    notices.leave_project();
                }
                continue;
            }
            Intent::OpenGallery(name) | Intent::PlayGallery(name) => {
                LoadRequest::Gallery(name.clone())
            }
            Intent::Welcome => LoadRequest::Gallery(START_PROJECT.to_owned()),
            Intent::Open(paths) => match request_to_open(paths, &mut drop, &mut notices) {
                Some(request) => request,
                None => continue,
            },
            // A single design is paired with itself until another one is added.
            Intent::OpenAlone(design) => {
                drop.close();
                LoadRequest::Designs(vec![design.clone(), design.clone()])
            }
            _ => continue,
        };
        if session.is_dirty() {
            // The intent is sent again once the user has answered.
            question.ask(intent.clone(), UnsavedKind::Changes, session.unsaved_text());
        } else {
            to_play.0 = match (intent, &request) {
                (Intent::PlayGallery(_) | Intent::Welcome, LoadRequest::Gallery(name)) => {
                    Some(name.clone())
                }
                _ => None,
            };
            session.open(request);
        }
    }
}

/// Returns the request for files that are opened together. A film needs two designs, so a single
/// one asks for the second; a project cannot be combined with other files.
fn request_to_open(
    paths: &[PathBuf],
    drop: &mut DroppedDesign,
    notices: &mut Notices,
) -> Option<LoadRequest> {
    match paths {
        [] => None,
        [project] if Project::has_document_extension(project) => {
            Some(LoadRequest::File(project.clone()))
        }
        [design] => {
            drop.ask(design.clone());
            None
        }
        designs => {
            let mut all = designs.iter();
            if all.any(|path| Project::has_document_extension(path)) {
                notices.problem(NoticeTopic::Opening, too_many_files(paths.len()));
                return None;
            }
            Some(LoadRequest::Designs(designs.to_vec()))
        }
    }
}

/// Name of the gallery project that starts to play as soon as it is open.
#[derive(Resource, Clone, Debug, Default, PartialEq, Eq)]
pub struct PlayWhenOpened(Option<String>);

/// The gallery projects; empty if a bundled project is invalid, which the tests rule out.
#[derive(Resource, Clone, Debug, PartialEq, Eq)]
pub struct GalleryEntries(pub Vec<gallery::GalleryEntry>);

impl Default for GalleryEntries {
    fn default() -> Self {
        Self(gallery::list().unwrap_or_default())
    }
}

fn too_many_files(files: usize) -> String {
    format!("Cannot open {files} files together. Open one project, or only designs")
}

/// Applies the intents that change the open project.
pub fn edit(
    mut intents: MessageReader<Intent>,
    mut session: ResMut<Session>,
    mut notices: ResMut<Notices>,
    playback: Res<Playback>,
    gesture: Res<Gesture>,
) {
    let mark = gesture.id();
    for intent in intents.read() {
        match intent {
            Intent::CancelWork => session.cancel(),
            Intent::BuildAnyway => session.build_anyway(),
            Intent::Undo => {
                let undone = session.undo();
                report_result(undone, "Nothing to undo", &mut notices);
            }
            Intent::Redo => {
                let redone = session.redo();
                report_result(redone, "Nothing to redo", &mut notices);
            }
            Intent::NextMethod => match next_method(&session) {
                Some((warp, content)) => {
                    session.change(mark, |project| set_method(project, warp, content));
                }
                None => notices.confirm("These designs support only one method"),
            },
            Intent::AddStop => {
                let added = add_stop(&mut session, playback.t(), mark);
                report_result(Ok(added), "There is already a stop here", &mut notices);
            }
            Intent::ReplaceSettings(changed) => {
                session.change(mark, |project| project.clone_from(changed))
            }
            Intent::SetMethod(warp, content) => {
                session.change(mark, |project| set_method(project, *warp, *content));
            }
            Intent::CyclePlayMode => {
                session.change(mark, |project| cycle_play_mode(&mut project.timing.play));
            }
            Intent::ReplaceDesign(index, path) => change_designs(&mut session, mark, |project| {
                replace_design(project, *index, path);
            }),
            Intent::InsertDesigns(at, paths) => change_designs(&mut session, mark, |project| {
                insert_designs(project, *at, paths);
            }),
            Intent::ReorderDesigns(designs) => change_designs(&mut session, mark, |project| {
                project.set_designs(designs.clone());
            }),
            Intent::CloseLoop(closed) => {
                session.change_whole(mark, |project| project.set_closed(*closed));
            }
            _ => {}
        }
    }
}

/// Reports an error as a problem; shows `nothing` as a confirmation if there was nothing to do.
fn report_result(result: Result<bool, SaveError>, nothing: &str, notices: &mut Notices) {
    match result {
        Ok(true) => {}
        Ok(false) => notices.confirm(nothing),
        Err(error) => notices.problem(NoticeTopic::Saving, error.to_string()),
    }
}

fn cycle_play_mode(mode: &mut PlayMode) {
    *mode = match mode {
        PlayMode::Once => PlayMode::Loop,
        PlayMode::Loop => PlayMode::PingPong,
        PlayMode::PingPong => PlayMode::Once,
    };
}

/// Changes the designs of the project. A title that was given to other designs is dropped: the
/// project is then named after its file or its designs.
fn change_designs(session: &mut Session, mark: Option<u64>, change: impl FnOnce(&mut Project)) {
    session.change_whole(mark, |project| {
        let sorted_paths = |project: &Project| {
            let designs = project.designs.iter();
            designs
                .map(|entry| entry.path.clone())
                .collect::<BTreeSet<_>>()
        };
        let before = sorted_paths(project);
        change(project);
        if sorted_paths(project) != before {
            project.title.clear();
        }
    });
}

/// Replaces a design's file and drops the settings that refer to points of the old design.
fn replace_design(project: &mut Project, index: usize, path: &Path) {
    let Some(entry) = project.designs.get_mut(index) else {
        return;
    };
    *entry = DesignEntry::new(absolute(path));
    for segment in 0..project.pair_count() {
        if project.pair_designs(segment).contains(&index) {
            let mut pair = project.pair_project(segment);
            // Pins and part settings refer to points of the old design.
            pair.options.matching = pair.options.matching.without_places();
            pair.options.parts.clear();
            project.replace_pair(segment, pair);
        }
    }
}

/// Inserts designs before index `at`, or appends them.
fn insert_designs(project: &mut Project, at: usize, paths: &[PathBuf]) {
    let mut designs = project.designs_with_indices();
    let at = at.min(designs.len());
    let new = paths
        .iter()
        .map(|path| (DesignEntry::new(absolute(path)), None));
    designs.splice(at..at, new);
    project.set_designs(designs);
}

fn set_method(project: &mut Project, warp: WarpKind, content: ContentKind) {
    project.warp = Some(warp);
    project.content = Some(content);
}

/// The next method after the current one, in cyclic order, that the designs support.
fn next_method(session: &Session) -> Option<(WarpKind, ContentKind)> {
    let project = session.project()?;
    // All warps for the same content are tried first, so that pictures stay pictures.
    let methods: Vec<_> = ContentKind::ALL
        .into_iter()
        .flat_map(|content| WarpKind::ALL.map(|warp| (warp, content)))
        .collect();
    // A method that could not be built is not tried again at once; those after it follow.
    let unavailable = session.unavailable_method();
    let current = match unavailable {
        Some(method) => (method.warp(), method.content()),
        None => (project.warp?, project.content?),
    };
    let current = methods.iter().position(|method| *method == current)?;
    // All other methods, in cyclic order from the current one.
    let after = methods
        .iter()
        .cycle()
        .skip(current + 1)
        .take(methods.len() - 1);
    after
        .copied()
        .filter(|method| (Some(method.0), Some(method.1)) != (project.warp, project.content))
        .find(|(warp, content)| session.check_method(*warp, *content).is_ok())
}

/// Adds a stop at `t`; returns `false` if there is one already.
fn add_stop(session: &mut Session, t: f64, mark: Option<u64>) -> bool {
    let mut is_added = false;
    session.change(mark, |project| {
        // Stops are sorted by t.
        let index = project
            .stops
            .partition_point(|stop| stop.t < t - STOP_TOLERANCE_T);
        if project
            .stops
            .iter()
            .all(|stop| (stop.t - t).abs() >= STOP_TOLERANCE_T)
        {
            project.stops.insert(index, TransitionStop::at(t));
            is_added = true;
        }
    });
    is_added
}

/// Saves the project, reports the result, and sends the intent that waited for the save. Asks first
/// if the file has been changed elsewhere.
pub fn save(
    mut intents: MessageReader<Intent>,
    mut session: ResMut<Session>,
    mut conflict: ResMut<ConflictQuestion>,
    mut question: ResMut<UnsavedQuestion>,
    mut notices: ResMut<Notices>,
    mut commands: Commands,
) {
    let mut waiting = None;
    for intent in intents.read() {
        let saved = match intent {
            Intent::Save if session.is_changed_elsewhere() => {
                conflict.ask(session.document_number());
                continue;
            }
            Intent::Save if session.path().is_some() => session.save(None),
            Intent::SaveTo(path) => session.save(Some(path)),
            _ => continue,
        };
        match saved {
            Ok(path) => {
                notices.resolve(NoticeTopic::Saving);
                notices.confirm(format!("Saved {}", path.display()));
                waiting = question.take_if_resolved(UnsavedKind::Changes);
            }
            Err(error) => {
                notices.problem(NoticeTopic::Saving, error.to_string());
                question.save_cancelled();
            }
        }
    }
    if let Some(intent) = waiting {
        commands.write_message(intent);
    }
}

/// Data that [`poll`] needs over several screen updates, to show each design's notes once and to
/// start playback.
#[derive(SystemParam)]
pub struct PollState<'w, 's> {
    /// Open designs whose notes have been shown.
    reported: Local<'s, Vec<Arc<Design>>>,
    /// Whether the opened project starts to play as soon as it has a film.
    is_to_play: Local<'s, bool>,
    /// The gallery project chosen to be played.
    to_play: ResMut<'w, PlayWhenOpened>,
}

/// Adopts opened projects and finished builds, and reports their problems and notes.
pub fn poll(
    mut session: ResMut<Session>,
    mut notices: ResMut<Notices>,
    mut playback: ResMut<Playback>,
    mut auto_fit: ResMut<AutoFit>,
    editor: Res<MatchEditor>,
    presentation: Res<Presentation>,
    mut state: PollState,
) {
    // The session is polled in every screen update; only an outcome counts as a change.
    let can_swap = playback.can_swap_film(session.timing());
    let outcome = session.bypass_change_detection().poll(can_swap);
    if outcome.is_some() {
        session.set_changed();
    }
    if session.is_changed() && session.problem().is_none() {
        notices.resolve(NoticeTopic::Transition);
    }
    match outcome {
        None => return,
        // No notice is needed: the open match editor shows the problem.
        Some(WorkOutcome::RebuildFailed) if editor.is_open => return,
        Some(WorkOutcome::RebuildFailed) => {}
        Some(WorkOutcome::Rebuilt) => {
            // The new film may have fewer segments, so that t lies beyond its last design.
            let end = session.segment_count() as f64;
            if playback.t() > end && session.timing().to <= end {
                let (timing, stops) = (*session.timing(), session.stops().to_vec());
                playback.seek(end, &timing, &stops);
            }
        }
        Some(WorkOutcome::Failed(error)) => {
            notices.problem(NoticeTopic::Opening, error.to_string());
            return;
        }
        Some(WorkOutcome::Opened) => {
            notices.leave_project();
            playback.rewind(session.timing());
            auto_fit.0 = true;
            // New designs play at once, and so does a chosen gallery project; saved ones do not.
            let chosen = state.to_play.0.take();
            let is_chosen = chosen.is_some() && chosen.as_deref() == session.gallery_name();
            let plays = session.has_new_designs() || is_chosen && !session.is_recovered();
            *state.is_to_play = plays && !presentation.is_active();
        }
    }
    // Playback starts once a film by the requested method, even a draft, is on the stage, unless
    // the user has already moved t.
    if *state.is_to_play && session.has_film() {
        *state.is_to_play = false;
        if !playback.is_playing() && playback.t() == session.timing().from {
            playback.toggle(session.timing(), session.stops());
        }
    }
    notices.resolve(NoticeTopic::Opening);
    show_notes(session.all_designs(), &mut state.reported, &mut notices);
    if let Some(problem) = session.problem() {
        // Only the latest problem is shown, because earlier ones concern settings that have been
        // replaced.
        notices.resolve(NoticeTopic::Transition);
        let text = problem_text(problem, session.transition());
        match session.work() {
            None => notices.problem(NoticeTopic::Transition, text),
            // The other segments are being built by the method that plays instead, which ends the
            // problem before it can be read.
            Some(_) => notices.note(text),
        }
    }
}

/// Shows the notes of each design once: they report repairs and omissions made when it was read.
fn show_notes(designs: &[Arc<Design>], reported: &mut Vec<Arc<Design>>, notices: &mut Notices) {
    for design in designs {
        // A single design, paired with itself, has been read twice.
        let is_reported = reported.contains(design);
        reported.push(Arc::clone(design));
        let mut notes = design.notes.iter().filter(|_| !is_reported);
        if let Some(first) = notes.next() {
            let more = match notes.count() {
                0 => String::new(),
                n => format!(" (and {n} more, see Designs)"),
            };
            notices.note(format!("{}: {first}{more}", design.name));
        }
    }
    // Forgets designs that are no longer open: when opened again, their notes are shown again.
    *reported = designs.to_vec();
}

/// Describes a problem, and names the method shown instead, if any.
fn problem_text(problem: &TransitionProblem, shown: Option<&Transition>) -> String {
    let fallback = shown.map(|shown| format!(". Showing {} instead", shown.method().name()));
    format!("{problem}{}", fallback.unwrap_or_default())
}

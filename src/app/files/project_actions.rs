//! Opening, editing and saving: the intents that change the [`Session`].

use std::path::{Path, PathBuf};
use std::sync::Arc;

use bevy::prelude::{
    Commands, DetectChanges, DetectChangesMut, Local, MessageReader, Res, ResMut, Resource,
};

use crate::app::editing::editor::MatchEditor;
use crate::app::files::drop::DroppedDesign;
use crate::app::input::gesture::Gesture;
use crate::app::input::intent::Intent;
use crate::app::notices::{NoticeTopic, Notices};
use crate::app::playback::player::{Playback, SAME_T};
use crate::app::presentation::presenter::Presentation;
use crate::app::session::load::{LoadRequest, TransitionProblem};
use crate::app::session::origin::absolute;
use crate::app::session::save::SaveError;
use crate::app::session::state::{Session, WorkOutcome};
use crate::app::unsaved_question::{UnsavedKind, UnsavedQuestion};
use crate::app::view::stage_area::AutoFit;
use crate::content::ContentKind;
use crate::design::Design;
use crate::project::{DesignEntry, Project, gallery};
use crate::transition::{PlayMode, Transition, TransitionStop};
use crate::warp::WarpKind;

/// Acts on the intents that open something; asks first where changes would be lost.
pub fn open(
    mut intents: MessageReader<Intent>,
    mut session: ResMut<Session>,
    mut question: ResMut<UnsavedQuestion>,
    mut drop: ResMut<DroppedDesign>,
    mut notices: ResMut<Notices>,
) {
    for intent in intents.read() {
        let request = match intent {
            Intent::OpenGallery(name) => LoadRequest::Gallery(name.clone()),
            Intent::Open(paths) => match paths.as_slice() {
                [project] if Project::is_named(project) => LoadRequest::File(project.clone()),
                [design] if session.project().is_some() => {
                    drop.ask(design.clone());
                    continue;
                }
                // A design alone is its own partner until it gets another.
                [design] => LoadRequest::Designs(vec![design.clone(), design.clone()]),
                [] => continue,
                _ if paths.iter().any(|path| Project::is_named(path)) => {
                    notices.problem(NoticeTopic::Opening, too_many(paths.len()));
                    continue;
                }
                designs => LoadRequest::Designs(designs.to_vec()),
            },
            _ => continue,
        };
        if session.is_dirty() {
            // The intent comes again once it is decided, and is then looked at anew.
            question.ask(intent.clone(), UnsavedKind::Changes, session.unsaved_text());
        } else {
            session.open(request);
        }
    }
}

/// The bundled projects; none where a bundled document is wrong, which the tests rule out.
#[derive(Resource, Clone, Debug, PartialEq, Eq)]
pub struct GalleryEntries(pub Vec<gallery::GalleryEntry>);

impl Default for GalleryEntries {
    fn default() -> Self {
        Self(gallery::list().unwrap_or_default())
    }
}

fn too_many(files: usize) -> String {
    format!("{files} files cannot be opened together: open one project alone, or designs.")
}

/// Acts on the intents that change the open project.
pub fn edit(
    mut intents: MessageReader<Intent>,
    mut session: ResMut<Session>,
    mut notices: ResMut<Notices>,
    (playback, gesture): (Res<Playback>, Res<Gesture>),
) {
    let mark = gesture.mark();
    for intent in intents.read() {
        match intent {
            Intent::CancelWork => session.cancel(),
            Intent::Insist => session.insist(),
            Intent::Undo => {
                let undone = session.undo();
                tell(undone, "There is nothing to undo.", &mut notices);
            }
            Intent::Redo => {
                let redone = session.redo();
                tell(redone, "There is nothing to redo.", &mut notices);
            }
            Intent::NextMethod => match next_cell(&session) {
                Some(cell) => session.change(mark, |project| set_cell(project, cell)),
                None => notices.done("These designs can be shown by one method only."),
            },
            Intent::AddStop => {
                let added = add_stop(&mut session, playback.t(), mark);
                tell(Ok(added), "There is a stop here already.", &mut notices);
            }
            Intent::Edit(changed) => session.change(mark, |project| project.clone_from(changed)),
            Intent::UseCell(warp, content) => {
                session.change(mark, |project| set_cell(project, (*warp, *content)));
            }
            Intent::CyclePlayMode => {
                session.change(mark, |project| cycle(&mut project.timing.play));
            }
            Intent::ReplaceDesign(index, path) => {
                session.change_whole(mark, |project| replace_design(project, *index, path));
            }
            Intent::InsertDesigns(at, paths) => {
                session.change_whole(mark, |project| insert_designs(project, *at, paths));
            }
            Intent::Arrange(designs) => {
                session.change_whole(mark, |project| project.rearrange(designs.clone()));
            }
            Intent::LeadBack(closed) => {
                session.change_whole(mark, |project| project.close(*closed));
            }
            _ => {}
        }
    }
}

fn tell(went: Result<bool, SaveError>, nothing: &str, notices: &mut Notices) {
    match went {
        Ok(true) => {}
        Ok(false) => notices.done(nothing),
        Err(error) => notices.problem(NoticeTopic::Saving, error.to_string()),
    }
}

fn cycle(mode: &mut PlayMode) {
    *mode = match mode {
        PlayMode::Once => PlayMode::Loop,
        PlayMode::Loop => PlayMode::PingPong,
        PlayMode::PingPong => PlayMode::Once,
    };
}

fn replace_design(project: &mut Project, index: usize, path: &Path) {
    let Some(entry) = project.designs.get_mut(index) else {
        return;
    };
    *entry = DesignEntry::new(absolute(path));
    for leg in 0..project.pair_count() {
        if project.pair_designs(leg).contains(&index) {
            let mut pair = project.pair_alone(leg);
            // What was said of points of the old one means nothing in the new one.
            pair.options.matching = pair.options.matching.without_places();
            pair.options.parts.clear();
            project.take_pair(leg, pair);
        }
    }
}

fn insert_designs(project: &mut Project, at: usize, paths: &[PathBuf]) {
    let mut designs = project.in_order();
    let at = at.min(designs.len());
    let new = paths
        .iter()
        .map(|path| (DesignEntry::new(absolute(path)), None));
    designs.splice(at..at, new);
    project.rearrange(designs);
}

fn set_cell(project: &mut Project, (warp, content): (WarpKind, ContentKind)) {
    project.warp = Some(warp);
    project.content = Some(content);
}

/// The next cell of the table, after the one in use, that can be had.
fn next_cell(session: &Session) -> Option<(WarpKind, ContentKind)> {
    let project = session.project()?;
    // All warps of what is seen first: pictures stay pictures.
    let cells: Vec<_> = ContentKind::ALL
        .into_iter()
        .flat_map(|content| WarpKind::ALL.map(|warp| (warp, content)))
        .collect();
    let here = (project.warp?, project.content?);
    let here = cells.iter().position(|cell| *cell == here)?;
    // All but the one in use, which would be found again after a full round.
    let after = cells.iter().cycle().skip(here + 1).take(cells.len() - 1);
    after
        .copied()
        .find(|(warp, content)| session.available(*warp, *content).is_ok())
}

/// Whether a stop was put there; where there is one already, none is.
fn add_stop(session: &mut Session, t: f64, mark: Option<u64>) -> bool {
    let mut is_added = false;
    session.change(mark, |project| {
        // Stops stand in the order of t.
        let place = project.stops.partition_point(|stop| stop.t < t - SAME_T);
        if project
            .stops
            .iter()
            .all(|stop| (stop.t - t).abs() >= SAME_T)
        {
            project.stops.insert(place, TransitionStop::at(t));
            is_added = true;
        }
    });
    is_added
}

/// Acts on the intents that save; tells what was saved, and lets go on what waited for it.
pub fn save(
    mut intents: MessageReader<Intent>,
    mut session: ResMut<Session>,
    mut question: ResMut<UnsavedQuestion>,
    mut notices: ResMut<Notices>,
    mut commands: Commands,
) {
    let mut waiting = None;
    for intent in intents.read() {
        let saved = match intent {
            Intent::Save if session.path().is_some() => session.save(None),
            Intent::SaveTo(path) => session.save(Some(path)),
            _ => continue,
        };
        match saved {
            Ok(path) => {
                notices.well(NoticeTopic::Saving);
                notices.done(format!("Saved {}", path.display()));
                waiting = question.safe(UnsavedKind::Changes);
            }
            Err(error) => {
                notices.problem(NoticeTopic::Saving, error.to_string());
                question.not_saved();
            }
        }
    }
    if let Some(intent) = waiting {
        commands.write_message(intent);
    }
}

/// Takes in what was opened or built.
pub fn poll(
    mut session: ResMut<Session>,
    mut notices: ResMut<Notices>,
    mut playback: ResMut<Playback>,
    (mut keeps_fit, editor, presenting): (ResMut<AutoFit>, Res<MatchEditor>, Res<Presentation>),
    mut told: Local<Vec<Arc<Design>>>,
    mut is_to_play: Local<bool>,
) {
    // Polled in each frame: only an outcome is a change.
    let may_change = playback.may_change_film(session.timing());
    let outcome = session.bypass_change_detection().poll(may_change);
    if outcome.is_some() {
        session.set_changed();
    }
    if session.is_changed() && session.problem().is_none() {
        notices.well(NoticeTopic::Transition);
    }
    match outcome {
        None => return,
        // The match editor says it where it was caused.
        Some(WorkOutcome::NotRebuilt) if editor.is_open => return,
        Some(WorkOutcome::NotRebuilt) => {}
        Some(WorkOutcome::Rebuilt) => {
            // The last leg may be gone.
            let end = session.leg_count() as f64;
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
            playback.begin(session.timing());
            keeps_fit.0 = true;
            // Who brings two wants to see what lies between them; of more a way is chosen
            // first, and a project is played by whoever shows it.
            *is_to_play = session.is_new_pair() && !presenting.is_on();
        }
    }
    if *is_to_play && session.has_film() {
        *is_to_play = false;
        if !playback.is_playing() && playback.t() == session.timing().from {
            playback.toggle(session.timing(), session.stops());
        }
    }
    notices.well(NoticeTopic::Opening);
    tell_notes(session.all_designs(), &mut told, &mut notices);
    if let Some(problem) = session.problem() {
        // Only the last one: what was tried before it is no longer asked for.
        notices.well(NoticeTopic::Transition);
        notices.problem(
            NoticeTopic::Transition,
            why_not(problem, session.transition()),
        );
    }
}

/// Says what of each design was repaired or left out, once while it is open.
fn tell_notes(designs: &[Arc<Design>], told: &mut Vec<Arc<Design>>, notices: &mut Notices) {
    for design in designs {
        // A design alone is its own partner, read twice.
        let is_told = told.contains(design);
        told.push(Arc::clone(design));
        let mut notes = design.notes.iter().filter(|_| !is_told);
        if let Some(first) = notes.next() {
            let more = match notes.count() {
                0 => String::new(),
                n => format!(" (and {n} more, see Designs)"),
            };
            notices.note(format!("{}: {first}{more}", design.name));
        }
    }
    *told = designs.to_vec();
}

/// Why there is nothing to see, or something else than was asked for.
fn why_not(problem: &TransitionProblem, shown: Option<&Transition>) -> String {
    let instead = shown.map(|shown| format!(" (shown meanwhile: {})", shown.cell().name()));
    format!("{problem}{}", instead.unwrap_or_default())
}

//! Applies the user's actions on the map: moving the marker and the designs, drawing and recording
//! the path, saving blends.

use bevy::prelude::{MessageReader, Res, ResMut};

use crate::app::input::gesture::Gesture;
use crate::app::input::intent::Intent;
use crate::app::map::map_view::MapView;
use crate::app::map::thumbnails::MAP_HALF_SIDE;
use crate::app::notices::Notices;
use crate::app::session::state::Session;
use crate::geometry::DVec2;
use crate::project::{MAX_PLACES, MapSettings, SavedBlend};
use crate::space::{MapPath, Waypoint, simplify_polyline};

/// Distance on the map within which a new stop snaps to a design or another stop (heuristic).
const SNAP_DISTANCE: f64 = 0.05 * MAP_HALF_SIDE;

/// Maximum distance on the map between a line drawn by hand and the path simplified from it
/// (heuristic: removes the trembling of the hand).
const PATH_TOLERANCE: f64 = 0.015 * MAP_HALF_SIDE;

/// Applies the intents that concern the map.
pub fn apply(
    mut intents: MessageReader<Intent>,
    mut view: ResMut<MapView>,
    mut session: ResMut<Session>,
    mut notices: ResMut<Notices>,
    gesture: Res<Gesture>,
) {
    for intent in intents.read() {
        match intent {
            Intent::ToggleMap if view.is_shown => view.hide(),
            Intent::ToggleMap => view.is_shown = true,
            Intent::MoveMarker(to) if to.is_finite() => view.move_marker(*to),
            Intent::ShowMapMeasure(shown) => view.measure = *shown,
            Intent::SetPathDrawing(on) => view.is_drawing_path = *on,
            Intent::TogglePathRecording => match view.toggle_recording() {
                Some(points) if points.len() > 1 => {
                    let mut path = extend_path(MapPath::default(), &points, &view);
                    path.places.truncate(MAX_PLACES);
                    session.change_whole(gesture.id(), |project| project.set_path(path));
                }
                Some(_) => notices.confirm("The marker did not move, so no path was recorded"),
                None => {
                    notices.confirm("Recording a path: move the marker, then press W to finish")
                }
            },
            Intent::ExtendPath(through) => {
                let path = session
                    .whole_project()
                    .map(|project| project.map.path.clone());
                let path = path.map(|path| extend_path(path, through, &view));
                if let Some(path) = path.filter(|path| path.places.len() <= MAX_PLACES) {
                    let last = path.places.last().map(|place| place.at);
                    last.into_iter().for_each(|last| view.move_marker(last));
                    session.change_whole(gesture.id(), |project| project.set_path(path));
                }
            }
            _ => change_project(intent, &view, &mut session, gesture.id()),
        }
    }
}

/// Applies those intents of the map that change only the project.
fn change_project(
    intent: &Intent,
    view: &MapView,
    session: &mut ResMut<Session>,
    mark: Option<u64>,
) {
    match intent {
        Intent::SetMapLayout(layout) => session.change_whole(mark, |project| {
            (project.map.layout, project.map.sites) = (*layout, Vec::new());
        }),
        Intent::MoveMapDesign(design, to) => {
            if let Some(sites) = view.sites_with(*design, *to) {
                session.change_whole(mark, |project| project.map.sites = sites);
            }
        }
        Intent::RemoveLastPathStop => session.change_whole(mark, |project| {
            let mut path = project.map.path.clone();
            remove_last_stop(&mut path);
            project.set_path(path);
        }),
        Intent::SaveBlend if view.pictures().is_some() && view.is_shown => {
            let place = saved_blend(view);
            session.change_whole(mark, |project| {
                if project.map.kept.len() < MAX_PLACES {
                    project.map.kept.push(place);
                }
            });
        }
        Intent::EditMap(changed) => session.change_whole(mark, |project| {
            let path = std::mem::take(&mut project.map.path);
            project.map = MapSettings {
                path,
                ..MapSettings::clone(changed)
            };
            project.set_path(changed.path.clone());
        }),
        _ => {}
    }
}

/// Extends a path through these points; the last becomes a stop.
fn extend_path(mut path: MapPath, through: &[DVec2], view: &MapView) -> MapPath {
    let Some((&to, before)) = through.split_last() else {
        return path;
    };
    let mut points = simplify_polyline(through, PATH_TOLERANCE);
    if path.places.is_empty() && !before.is_empty() {
        // If the path is empty, a line drawn by hand starts it with a stop.
        path.places.push(new_stop(points.remove(0), &path, view));
    } else {
        points.remove(0);
    }
    points.pop();
    path.places.extend(points.into_iter().map(Waypoint::via));
    let last = new_stop(to, &path, view);
    // A second click on the same place adds nothing.
    if path.places.last().is_none_or(|place| place.at != last.at) {
        path.places.push(last);
    }
    path
}

/// Returns a named stop at a point or, if a design or stop lies close to the point, at that place.
fn new_stop(at: DVec2, path: &MapPath, view: &MapView) -> Waypoint {
    let pictures = view.pictures();
    let sites = pictures.map_or(&[][..], |pictures| pictures.map().sites());
    let stops = path.places.iter().filter(|place| !place.passed);
    let snap_points = sites.iter().copied().chain(stops.map(|place| place.at));
    let nearest = snap_points.min_by(|a, b| a.distance(at).total_cmp(&b.distance(at)));
    let at = nearest
        .filter(|nearest| nearest.distance(at) < SNAP_DISTANCE)
        .unwrap_or(at);
    Waypoint {
        name: blend_name(at, view),
        ..Waypoint::stop(at)
    }
}

/// Default name of the blend at a point; empty until the map is built.
fn blend_name(at: DVec2, view: &MapView) -> String {
    view.pictures().map_or_else(String::new, |pictures| {
        let mut weights = vec![0.0; pictures.map().sites().len()];
        pictures.map().weights(at, &mut weights);
        pictures.space().blend_label(&weights)
    })
}

/// New saved blend at the marker, with its default name.
fn saved_blend(view: &MapView) -> SavedBlend {
    SavedBlend {
        name: blend_name(view.marker(), view),
        ..SavedBlend::new(view.marker())
    }
}

/// Removes the last stop and the points leading to it.
fn remove_last_stop(path: &mut MapPath) {
    path.places.pop();
    while path.places.last().is_some_and(|place| place.passed) {
        path.places.pop();
    }
    if path.places.is_empty() {
        *path = MapPath::default();
    }
}

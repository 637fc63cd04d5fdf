//! Actions on the map: moving the marker and the designs, drawing the path, saving blends.

use bevy::prelude::{MessageReader, Res, ResMut};

use crate::app::input::gesture::Gesture;
use crate::app::input::intent::Intent;
use crate::app::map::map_view::MapView;
use crate::app::map::thumbnails::REACH;
use crate::app::notices::Notices;
use crate::app::session::state::Session;
use crate::geometry::DVec2;
use crate::project::{MOST_PLACES, MapSettings, SavedPlace};
use crate::space::{MapPath, Waypoint, thinned};

/// Distance within which a new stop snaps to a design or another stop (heuristic).
const SNAP_DISTANCE: f64 = 0.05 * REACH;

/// Maximum deviation of the simplified path from a line drawn by hand (heuristic: removes the
/// trembling of a hand).
const PATH_TOLERANCE: f64 = 0.015 * REACH;

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
            Intent::ToggleMap => view.is_shown = !view.is_shown,
            Intent::Puck(to) if to.is_finite() => view.move_puck(*to),
            Intent::ShowMeasure(shown) => view.shown = *shown,
            Intent::DrawPath(on) => view.draws_path = *on,
            Intent::RecordPath => match view.record() {
                Some(way) if way.len() > 1 => {
                    let mut path = extended(MapPath::default(), &way, &view);
                    path.places.truncate(MOST_PLACES);
                    session.change_whole(gesture.mark(), |project| project.follow(path));
                }
                Some(_) => notices.done("The marker did not move, so no path was recorded"),
                None => notices.done("Recording a path: move the marker, then press W to finish"),
            },
            Intent::ExtendPath(through) => {
                let path = session.whole().map(|whole| whole.map.path.clone());
                let path = path.map(|path| extended(path, through, &view));
                if let Some(path) = path.filter(|path| path.places.len() <= MOST_PLACES) {
                    let last = path.places.last().map(|place| place.at);
                    last.into_iter().for_each(|last| view.move_puck(last));
                    session.change_whole(gesture.mark(), |project| project.follow(path));
                }
            }
            _ => change(intent, &view, &mut session, gesture.mark()),
        }
    }
}

/// Applies those intents that only change the project.
fn change(intent: &Intent, view: &MapView, session: &mut ResMut<Session>, mark: Option<u64>) {
    match intent {
        Intent::LayOut(layout) => session.change_whole(mark, |project| {
            (project.map.layout, project.map.sites) = (*layout, Vec::new());
        }),
        Intent::MoveSite(design, to) => {
            if let Some(sites) = view.sites_with(*design, *to) {
                session.change_whole(mark, |project| project.map.sites = sites);
            }
        }
        Intent::ShortenPath => session.change_whole(mark, |project| {
            let mut path = project.map.path.clone();
            shorten(&mut path);
            project.follow(path);
        }),
        Intent::Keep if view.made().is_some() && view.is_shown => {
            let place = saved_blend(view);
            session.change_whole(mark, |project| {
                if project.map.kept.len() < MOST_PLACES {
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
            project.follow(changed.path.clone());
        }),
        _ => {}
    }
}

/// Extends a path through these points; the last becomes a stop.
fn extended(mut path: MapPath, through: &[DVec2], view: &MapView) -> MapPath {
    let Some((&to, before)) = through.split_last() else {
        return path;
    };
    let mut way = thinned(through, PATH_TOLERANCE);
    if path.places.is_empty() && !before.is_empty() {
        // A path drawn in one go also starts with a stop.
        path.places.push(stop(way.remove(0), &path, view));
    } else {
        way.remove(0);
    }
    way.pop();
    path.places.extend(way.into_iter().map(Waypoint::passed));
    let last = stop(to, &path, view);
    // A second click on the same place adds nothing.
    if path.places.last().is_none_or(|place| place.at != last.at) {
        path.places.push(last);
    }
    path
}

/// A named stop at a point, snapped to the nearest design or stop.
fn stop(at: DVec2, path: &MapPath, view: &MapView) -> Waypoint {
    let made = view.made();
    let sites = made.map_or(&[][..], |made| made.map().sites());
    let stops = path.places.iter().filter(|place| !place.passed);
    let known = sites.iter().copied().chain(stops.map(|place| place.at));
    let near = known.min_by(|a, b| a.distance(at).total_cmp(&b.distance(at)));
    let at = near
        .filter(|near| near.distance(at) < SNAP_DISTANCE)
        .unwrap_or(at);
    Waypoint {
        name: blend_name(at, view),
        ..Waypoint::stop(at)
    }
}

/// Name of the blend at a point.
fn blend_name(at: DVec2, view: &MapView) -> String {
    view.made().map_or_else(String::new, |made| {
        let mut weights = vec![0.0; made.map().sites().len()];
        made.map().weights(at, &mut weights);
        made.space().told(&weights)
    })
}

/// Saved blend at the marker.
fn saved_blend(view: &MapView) -> SavedPlace {
    SavedPlace {
        name: blend_name(view.puck(), view),
        ..SavedPlace::new(view.puck())
    }
}

/// Removes the last stop and the points leading to it.
fn shorten(path: &mut MapPath) {
    path.places.pop();
    while path.places.last().is_some_and(|place| place.passed) {
        path.places.pop();
    }
    if path.places.is_empty() {
        *path = MapPath::default();
    }
}

//! View of the stage in the window: fits, pans and zooms it, and places the cameras of the stage
//! and of the comparison.

use crate::app::capture::film_framing::FilmFraming;
use crate::app::compare::comparison::Comparison;
use crate::app::editing::editor::MatchEditor;
use crate::app::editing::panes::PaneView;
use crate::app::input::editor_action::EditorPane;
use crate::app::input::intent::Intent;
use crate::app::session::state::Session;
use crate::app::stage_area::{AutoFit, StageArea};
use crate::geometry::Bounds;
use crate::stage::{StageCamera, StageView};
use bevy::camera::Viewport;
use bevy::ecs::system::SystemParam;
use bevy::prelude::*;
use bevy::window::PrimaryWindow;

/// Margin around the fitted transition, as a fraction of its diameter: strokes and marks of defects
/// extend beyond the shapes (heuristic).
const MARGIN: f64 = 0.04;

/// Applies the intents that fit, pan and zoom the view.
pub fn apply(
    mut intents: MessageReader<Intent>,
    mut view: ResMut<StageView>,
    mut auto_fit: ResMut<AutoFit>,
) {
    for intent in intents.read() {
        match intent {
            Intent::FitView => auto_fit.0 = true,
            Intent::Pan(delta) => {
                view.pan_px(*delta);
                auto_fit.0 = false;
            }
            Intent::Zoom { at, factor } => {
                view.zoom_at(*at, f64::from(*factor));
                auto_fit.0 = false;
            }
            _ => {}
        }
    }
}

/// Values that [`fit`] keeps from one frame of the window to the next.
#[derive(SystemParam)]
pub struct FitState<'s> {
    /// Values at the last fit: the fitted bounds in the plane, the size of the stage area, and the
    /// zoom and pan of the film pane.
    last: Local<'s, Option<(Bounds, Vec2, PaneView)>>,
    /// View of the stage before the film pane replaced it; `None` while the film pane is closed.
    stage_view: Local<'s, Option<StageView>>,
}

/// Fits the view again when the stage area, the transition or the rectangle of the export changes.
/// If the user has panned or zoomed, only the film pane of the match editor is fitted.
pub fn fit(
    session: Res<Session>,
    editor: Res<MatchEditor>,
    area: Res<StageArea>,
    auto_fit: Res<AutoFit>,
    film: Res<FilmFraming>,
    mut view: ResMut<StageView>,
    mut state: FitState,
) {
    // The film pane of the match editor has its own view; leaving the editor restores the view of
    // the stage.
    let pane = editor
        .shows_film()
        .then(|| editor.panes.view(EditorPane::Film));
    if pane.is_some() && state.stage_view.is_none() {
        *state.stage_view = Some(view.clone());
    } else if pane.is_none()
        && let Some(before) = state.stage_view.take()
    {
        *view = before;
        *state.last = None;
    }
    if !auto_fit.0 && pane.is_none() {
        // The last fit is forgotten, so that the next fit happens even if nothing has changed
        // since.
        *state.last = None;
        return;
    }
    // All segments share one view, so that the drawing does not jump between them.
    let Some(bounds) = session.bounds() else {
        return;
    };
    let bounds = match &film.0 {
        Some(framed) => bounds.union(&framed.bounds()),
        None => bounds,
    };
    let bounds = bounds.padded(MARGIN * bounds.diameter());
    let pane = pane.unwrap_or_default();
    let key = Some((bounds, area.size, pane));
    if *state.last != key {
        view.fit(bounds, area.size);
        view.zoom_at(0.5 * area.size, f64::from(pane.zoom));
        view.pan_px(pane.pan);
        *state.last = key;
    }
}

/// Restricts the stage's camera to the stage area.
pub fn place_camera(
    area: Res<StageArea>,
    window: Single<&Window, With<PrimaryWindow>>,
    mut camera: Single<&mut Camera, With<StageCamera>>,
) {
    let viewport = viewport(*area, &window);
    let is_same = |old: &Viewport| {
        viewport.as_ref().is_some_and(|new| {
            (old.physical_position, old.physical_size) == (new.physical_position, new.physical_size)
        })
    };
    // An unchanged viewport is not written: writing would mark the camera as changed, and Bevy
    // would look up the camera's render targets again.
    if !camera.viewport.as_ref().is_some_and(is_same) {
        camera.viewport = viewport;
    }
}

/// Marks the camera of the comparison.
#[derive(Component, Debug)]
pub struct ComparisonCamera;

/// Components that define a camera's view.
type CameraState<'w> = (&'w Camera, &'w Transform, &'w Projection);

/// Places the comparison's camera to the right of the stage, with the same view.
pub fn place_comparison_camera(
    area: Res<StageArea>,
    comparison: Res<Comparison>,
    editor: Res<MatchEditor>,
    window: Single<&Window, With<PrimaryWindow>>,
    stage: Single<CameraState<'static>, (With<StageCamera>, Without<ComparisonCamera>)>,
    comparison_view: Single<(&mut Camera, &mut Transform, &mut Projection), With<ComparisonCamera>>,
) {
    let (camera, transform, projection) = stage.into_inner();
    let (mut comparison_camera, mut comparison_transform, mut comparison_projection) =
        comparison_view.into_inner();
    let right = StageArea {
        corner: area.corner + Vec2::new(area.size.x, 0.0),
        ..*area
    };
    let viewport = viewport(right, &window).filter(|_| comparison.is_shown && !editor.is_open);
    let is_active = viewport.is_some();
    if comparison_camera.is_active != is_active {
        comparison_camera.is_active = is_active;
    }
    if !is_active {
        return;
    }
    // The viewport gets the same size in pixels as that of the stage, so that both show the same
    // section of the plane.
    let viewport = viewport.map(|comparison_view| Viewport {
        physical_size: camera
            .viewport
            .as_ref()
            .map_or(comparison_view.physical_size, |first| {
                first.physical_size.min(comparison_view.physical_size)
            }),
        ..comparison_view
    });
    comparison_camera.viewport = viewport;
    *comparison_transform = *transform;
    *comparison_projection = projection.clone();
}

/// Returns the viewport of an area, clipped to the window: the window may be smaller than the area
/// while it is being resized. Returns `None` if nothing of the area is in the window: the camera of
/// the stage then fills the window, and that of the comparison is off.
fn viewport(area: StageArea, window: &Window) -> Option<Viewport> {
    let scale = window.scale_factor();
    let window_px = window.physical_size();
    let corner = (area.corner * scale).round().as_uvec2();
    let size = (area.size * scale)
        .round()
        .as_uvec2()
        .min(window_px.saturating_sub(corner));
    (size.min_element() > 0).then(|| Viewport {
        physical_position: corner,
        physical_size: size,
        ..default()
    })
}

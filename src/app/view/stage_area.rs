//! Where the stage is seen: its place in the window, fit, pan, zoom, whole screen.

use bevy::camera::Viewport;
use bevy::prelude::*;
use bevy::window::{PrimaryWindow, WindowMode};

use crate::app::analysis::film_measures::StageMeasures;
use crate::app::analysis::method_search::MethodSearch;
use crate::app::analysis::suggestions::Suggestions;
use crate::app::capture::film_exporter::FilmExporter;
use crate::app::capture::film_framing::FilmFraming;
use crate::app::compare::comparison::Comparison;
use crate::app::editing::editor::MatchEditor;
use crate::app::editing::panes::{EditorPane, PaneView};
use crate::app::files::drop::DroppedDesign;
use crate::app::input::intent::Intent;
use crate::app::input::preferences::Preferences;
use crate::app::map::map_view::MapView;
use crate::app::persistence::autosave::Autosave;
use crate::app::presentation::presenter::{Presentation, fullscreen_mode};
use crate::app::session::state::Session;
use crate::app::unsaved_question::UnsavedQuestion;
use crate::geometry::Bounds;
use crate::stage::{StageCamera, StageView};

/// Room around the transition when all of it is shown, as a part of its size: outlines and the
/// marks of findings reach beyond the forms.
const ROOM: f64 = 0.04;

/// The part of the window that the panels leave to the stage, in logical pixels.
#[derive(Resource, Clone, Copy, Debug, PartialEq)]
pub struct StageArea {
    /// Upper left corner, y down.
    pub corner: Vec2,
    /// Width and height.
    pub size: Vec2,
}

impl Default for StageArea {
    fn default() -> Self {
        Self {
            corner: Vec2::ZERO,
            size: Vec2::new(1280.0, 720.0),
        }
    }
}

/// The view shows the whole transition and is to go on doing so when the area changes.
#[derive(Resource, Clone, Copy, Debug, PartialEq, Eq)]
pub struct AutoFit(pub bool);

impl Default for AutoFit {
    fn default() -> Self {
        Self(true)
    }
}

/// Acts on the intents that concern the view.
pub fn apply(
    mut intents: MessageReader<Intent>,
    mut view: ResMut<StageView>,
    mut keeps_fit: ResMut<AutoFit>,
) {
    for intent in intents.read() {
        match intent {
            Intent::FitView => keeps_fit.0 = true,
            Intent::Pan(delta) => {
                view.pan_px(*delta);
                keeps_fit.0 = false;
            }
            Intent::Zoom { at, factor } => {
                view.zoom_at(*at, f64::from(*factor));
                keeps_fit.0 = false;
            }
            _ => {}
        }
    }
}

/// Fits the view wherever it is to be fitted and something about it changed.
pub fn fit(
    (session, editor): (Res<Session>, Res<MatchEditor>),
    area: Res<StageArea>,
    keeps_fit: Res<AutoFit>,
    film: Res<FilmFraming>,
    mut view: ResMut<StageView>,
    mut last: Local<Option<(Bounds, Vec2, PaneView)>>,
    mut left: Local<Option<StageView>>,
) {
    // The editor looks at the film in its own way, and whoever leaves it finds the stage as it was.
    let pane = editor
        .shows_film()
        .then(|| editor.panes.view(EditorPane::Film));
    if pane.is_some() && left.is_none() {
        *left = Some(view.clone());
    } else if pane.is_none()
        && let Some(before) = left.take()
    {
        *view = before;
        *last = None;
    }
    if !keeps_fit.0 && pane.is_none() {
        // Forgotten, so that the next fit is made even where nothing has changed since the last
        // one.
        *last = None;
        return;
    }
    // All legs in one view, or the drawing would jump where one ends.
    let Some(bounds) = session.bounds() else {
        return;
    };
    let bounds = match &film.0 {
        Some(framed) => bounds.union(&framed.bounds()),
        None => bounds,
    };
    let bounds = bounds.padded(ROOM * bounds.diameter());
    let pane = pane.unwrap_or_default();
    let now = Some((bounds, area.size, pane));
    if *last != now {
        view.fit(bounds, area.size);
        view.zoom_at(0.5 * area.size, f64::from(pane.zoom));
        view.pan_px(pane.pan);
        *last = now;
    }
}

/// Lets the stage's camera draw into its part of the window alone.
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
    // A camera that is written to counts as changed, and its targets are looked up anew.
    if !camera.viewport.as_ref().is_some_and(is_same) {
        camera.viewport = viewport;
    }
}

/// The camera that shows the second method.
#[derive(Component, Debug)]
pub struct ComparisonCamera;

/// What a camera looks at.
type CameraState<'w> = (&'w Camera, &'w Transform, &'w Projection);

/// Lets the second camera draw beside the first, what the first one shows of the plane.
pub fn place_twin(
    area: Res<StageArea>,
    twin: Res<Comparison>,
    editor: Res<MatchEditor>,
    window: Single<&Window, With<PrimaryWindow>>,
    stage: Single<CameraState<'static>, (With<StageCamera>, Without<ComparisonCamera>)>,
    beside: Single<(&mut Camera, &mut Transform, &mut Projection), With<ComparisonCamera>>,
) {
    let (camera, transform, projection) = stage.into_inner();
    let (mut twin_camera, mut twin_transform, mut twin_projection) = beside.into_inner();
    let right = StageArea {
        corner: area.corner + Vec2::new(area.size.x, 0.0),
        ..*area
    };
    let viewport = viewport(right, &window).filter(|_| twin.is_shown && !editor.is_open);
    let is_active = viewport.is_some();
    if twin_camera.is_active != is_active {
        twin_camera.is_active = is_active;
    }
    if !is_active {
        return;
    }
    // As many pixels as the first one has, so that both show the same to the last one.
    let viewport = viewport.map(|beside| Viewport {
        physical_size: camera
            .viewport
            .as_ref()
            .map_or(beside.physical_size, |first| {
                first.physical_size.min(beside.physical_size)
            }),
        ..beside
    });
    twin_camera.viewport = viewport;
    *twin_transform = *transform;
    *twin_projection = projection.clone();
}

/// At least a pixel, and within the window even while it is being resized; the whole window
/// where that cannot be.
fn viewport(area: StageArea, window: &Window) -> Option<Viewport> {
    let scale = window.scale_factor();
    let whole = window.physical_size();
    let corner = (area.corner * scale).round().as_uvec2();
    let size = (area.size * scale)
        .round()
        .as_uvec2()
        .min(whole.saturating_sub(corner));
    (size.min_element() > 0).then(|| Viewport {
        physical_position: corner,
        physical_size: size,
        ..default()
    })
}

/// Whole screen, and the way back out of everything.
pub fn window_mode(
    mut intents: MessageReader<Intent>,
    mut window: Single<&mut Window, With<PrimaryWindow>>,
) {
    for intent in intents.read() {
        if *intent == Intent::ToggleFullscreen {
            window.mode = match window.mode {
                WindowMode::Windowed => fullscreen_mode(),
                _ => WindowMode::Windowed,
            };
        }
    }
}

/// What Esc answers before all else.
type EscapeBlockers<'w> = (
    Res<'w, UnsavedQuestion>,
    Res<'w, DroppedDesign>,
    Res<'w, Autosave>,
    Res<'w, Presentation>,
);

/// Work that Esc stops.
type CancellableWork<'w> = (
    ResMut<'w, MethodSearch>,
    ResMut<'w, StageMeasures>,
    ResMut<'w, Suggestions>,
);

/// Esc: the help goes first, then work that is told of, then what hid the panels, then the whole
/// screen, and when nothing else is left to leave a recording.
pub fn back(
    mut intents: MessageReader<Intent>,
    mut preferences: ResMut<Preferences>,
    mut window: Query<&mut Window, With<PrimaryWindow>>,
    (mut editor, mut twin, mut map): (ResMut<MatchEditor>, ResMut<Comparison>, ResMut<MapView>),
    (question, drop, autosave, presenting): EscapeBlockers,
    (mut session, recorder): (ResMut<Session>, Res<FilmExporter>),
    (mut choosing, mut measured, mut helping): CancellableWork,
) {
    let is_asked = question.text().is_some() || drop.asks() || autosave.lost().is_some();
    if is_asked || presenting.is_on() {
        intents.clear(); // Esc answers the question, or ends the talk, and nothing else.
        return;
    }
    let backs = intents
        .read()
        .filter(|intent| **intent == Intent::Back)
        .count();
    for _ in 0..backs {
        if preferences.help {
            preferences.help = false;
        } else if preferences.panels && session.told_work().is_some() {
            session.cancel();
        } else if preferences.panels && choosing.told().is_some() {
            choosing.stop();
        } else if preferences.panels && measured.told().is_some() {
            measured.stop();
        } else if preferences.panels && !editor.is_open && helping.is_trying() {
            helping.stop();
        } else if editor.bypass_change_detection().back() {
            editor.set_changed();
        } else if preferences.film_options {
            preferences.film_options = false;
        } else if map.is_shown {
            map.is_shown = false;
        } else if std::mem::take(&mut twin.is_shown) {
            // The second method is gone.
        } else if !preferences.panels {
            preferences.panels = true;
        } else if let Ok(mut window) = window.single_mut()
            && window.mode != WindowMode::Windowed
        {
            window.mode = WindowMode::Windowed;
        } else if preferences.times {
            preferences.times = false;
        } else {
            recorder.cancel();
        }
    }
}

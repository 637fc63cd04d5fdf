//! System that keeps the map up to date; whenever the marker moves, it redraws the blend under the
//! marker in the same screen update.

use bevy::math::Vec2;
use bevy::prelude::{DetectChanges, DetectChangesMut, Query, Res, ResMut, With};
use bevy::window::{PrimaryWindow, Window};

use crate::app::map::map_view::MapView;
use crate::app::playback::player::Playback;
use crate::app::session::state::Session;
use crate::app::stage_area::StageArea;
use crate::export::PixelSize;

/// Maximum length of the blend image's longer side, in pixels (heuristic: limits the time per move
/// on large windows).
const MAX_SIDE_PX: f32 = 1400.0;

/// Rebuilds the map if the project has changed, moves the marker along with playback, and draws the
/// blend under the marker.
pub fn follow(
    session: Res<Session>,
    area: Res<StageArea>,
    playback: Res<Playback>,
    window: Query<&Window, With<PrimaryWindow>>,
    mut view: ResMut<MapView>,
) {
    let is_new = session.is_changed() || view.is_changed();
    // This system runs in every screen update but seldom changes the resource. It bypasses Bevy's
    // change detection and reports changes itself.
    let map = view.bypass_change_detection();
    let mut is_changed = map.update(&session, is_new);
    is_changed |= map.follow_playback(playback.t());
    if map.is_shown {
        let scale = window.single().map_or(1.0, Window::scale_factor);
        let area_px = area.size * scale;
        let size_px = area_px * (MAX_SIDE_PX / area_px.max_element()).min(1.0);
        let size_px = size_px.max(Vec2::ONE).as_uvec2();
        if let Ok(size) = PixelSize::new(size_px.x, size_px.y) {
            is_changed |= map.draw_blend(size, session.style());
        }
    }
    if is_changed {
        view.set_changed();
    }
}

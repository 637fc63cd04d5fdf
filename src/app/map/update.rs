//! The blend under the puck, drawn as large as it is seen, in the frame in which the puck moves.

use bevy::math::Vec2;
use bevy::prelude::{DetectChanges, DetectChangesMut, Query, Res, ResMut, With};
use bevy::window::{PrimaryWindow, Window};

use crate::app::map::map_view::MapView;
use crate::app::playback::player::Playback;
use crate::app::session::state::Session;
use crate::app::view::stage_area::StageArea;
use crate::export::PixelSize;

/// Pixels along the longer side of the blend's picture, at most: a trade for the time of a
/// move on a large window.
const LONGEST_PX: f32 = 1400.0;

/// Has the map built and drawn, and draws the blend.
pub fn follow(
    session: Res<Session>,
    area: Res<StageArea>,
    playback: Res<Playback>,
    window: Query<&Window, With<PrimaryWindow>>,
    mut view: ResMut<MapView>,
) {
    let is_new = session.is_changed() || view.is_changed();
    // Marked as changed by hand: it is looked at in each frame, and seldom new.
    let map = view.bypass_change_detection();
    let mut is_changed = map.work(&session, is_new);
    is_changed |= map.go_with(playback.t());
    if map.is_shown {
        let scale = window.single().map_or(1.0, Window::scale_factor);
        let seen = area.size * scale;
        let wanted = seen * (LONGEST_PX / seen.max_element()).min(1.0);
        let wanted = wanted.max(Vec2::ONE).as_uvec2();
        if let Ok(size) = PixelSize::new(wanted.x, wanted.y) {
            is_changed |= map.look(size, session.style());
        }
    }
    if is_changed {
        view.set_changed();
    }
}

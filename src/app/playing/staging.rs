//! Hands the session's transition, t and style to the stage.

use bevy::app::Propagate;
use bevy::camera::visibility::RenderLayers;
use bevy::prelude::*;

use crate::app::looking::preferences::Preferences;
use crate::app::looking::twin::{OnTwin, Twin};
use crate::app::playing::playback::Playback;
use crate::app::session::state::Session;
use crate::stage::{Blend, StageStyle, StageTransition};
use crate::transition::Style;

/// The render layer of what is beside the stage.
pub const TWIN_LAYER: RenderLayers = RenderLayers::layer(1);

/// The entity that is on the stage.
#[derive(Component, Debug)]
pub struct OnStage;

/// Puts the transition on the stage wherever it is another one.
pub fn stage_transition(
    mut commands: Commands,
    session: Res<Session>,
    playback: Res<Playback>,
    staged: Query<(Entity, &StageTransition), With<OnStage>>,
) {
    if !session.is_changed() {
        return;
    }
    let blend = Blend { t: playback.t() };
    match (session.transition(), staged.single()) {
        (Some(new), Ok((_, StageTransition(old))))
            if std::ptr::eq(new.content(), old.content()) => {}
        (Some(new), Ok((entity, _))) => {
            commands
                .entity(entity)
                .insert((StageTransition(new.clone()), blend));
        }
        (Some(new), Err(_)) => {
            commands.spawn((OnStage, StageTransition(new.clone()), blend));
        }
        (None, Ok((entity, _))) => commands.entity(entity).despawn(),
        (None, Err(_)) => {}
    }
}

/// Puts the second method beside the stage wherever it is another one, and takes it away.
pub fn stage_twin(
    mut commands: Commands,
    twin: Res<Twin>,
    playback: Res<Playback>,
    staged: Query<(Entity, &StageTransition), With<OnTwin>>,
) {
    if !twin.is_changed() {
        return;
    }
    let blend = Blend { t: playback.t() };
    match (twin.transition(), staged.single()) {
        (Some(new), Ok((_, StageTransition(old))))
            if std::ptr::eq(new.content(), old.content()) => {}
        (Some(new), Ok((entity, _))) => {
            commands
                .entity(entity)
                .insert((StageTransition(new.clone()), blend));
        }
        (Some(new), Err(_)) => {
            commands.spawn((
                OnTwin,
                Propagate(TWIN_LAYER),
                StageTransition(new.clone()),
                blend,
            ));
        }
        (None, Ok((entity, _))) => commands.entity(entity).despawn(),
        (None, Err(_)) => {}
    }
}

/// On the stage, or beside it.
type Shown = Or<(With<OnStage>, With<OnTwin>)>;

/// Moves what is on the stage to t.
pub fn stage_t(playback: Res<Playback>, mut blends: Query<&mut Blend, Shown>) {
    for mut blend in &mut blends {
        if blend.t != playback.t() {
            blend.t = playback.t();
        }
    }
}

/// Dresses what is on the stage in the project's colours and shows what is to be shown.
pub fn stage_style(
    session: Res<Session>,
    preferences: Res<Preferences>,
    mut styles: Query<&mut StageStyle, Shown>,
    mut ground: ResMut<ClearColor>,
) {
    let style = session
        .project()
        .map_or_else(Style::default, |project| project.style);
    let [r, g, b] = style.ground.0;
    let colour = Color::srgb_u8(r, g, b);
    if ground.0 != colour {
        ground.0 = colour;
    }
    let show = preferences.show;
    for mut staged in &mut styles {
        if staged.style != style || staged.show != show {
            *staged = StageStyle { style, show };
        }
    }
}

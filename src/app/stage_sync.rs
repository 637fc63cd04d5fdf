//! Hands the session's transition, t and style to the stage.

use bevy::app::Propagate;
use bevy::camera::visibility::RenderLayers;
use bevy::prelude::*;

use crate::app::compare::comparison::{Comparison, OnComparison};
use crate::app::input::preferences::Preferences;
use crate::app::playback::player::Playback;
use crate::app::session::state::Session;
use crate::stage::{Blend, StageStyle, StageTransition};
use crate::transition::Transition;

/// The render layer of what is beside the stage.
pub const TWIN_LAYER: RenderLayers = RenderLayers::layer(1);

/// The entity that is on the stage.
#[derive(Component, Debug)]
pub struct OnStage;

/// What of a kind is on the stage already.
type StagedEntity<'w, 's, Of> = Query<'w, 's, (Entity, &'static StageTransition), With<Of>>;

/// Puts the transition on the stage wherever it is another one.
pub fn stage_transition(
    mut commands: Commands,
    session: Res<Session>,
    playback: Res<Playback>,
    staged: StagedEntity<OnStage>,
) {
    if session.is_changed() {
        let blend = Blend {
            t: session.within(playback.t()),
        };
        stage(&mut commands, session.transition(), blend, &staged, OnStage);
    }
}

/// Puts the second method beside the stage wherever it is another one, and takes it away.
pub fn stage_twin(
    mut commands: Commands,
    twin: Res<Comparison>,
    (playback, session): (Res<Playback>, Res<Session>),
    staged: StagedEntity<OnComparison>,
) {
    if twin.is_changed() {
        let blend = Blend {
            t: session.within(playback.t()),
        };
        let marks = (OnComparison, Propagate(TWIN_LAYER));
        stage(&mut commands, twin.transition(), blend, &staged, marks);
    }
}

/// Brings the entity with these marks up to the transition; there is none where that is none.
fn stage<Of: Component>(
    commands: &mut Commands,
    transition: Option<&Transition>,
    blend: Blend,
    staged: &StagedEntity<Of>,
    marks: impl Bundle,
) {
    match (transition, staged.single()) {
        (Some(new), Ok((_, StageTransition(old))))
            // Clones share what they are made of; inserting one would upload its meshes anew.
            if new.is(old) => {}
        (Some(new), Ok((entity, _))) => {
            let new = (StageTransition(new.clone()), blend);
            commands.entity(entity).insert(new);
        }
        (Some(new), Err(_)) => {
            commands.spawn((marks, StageTransition(new.clone()), blend));
        }
        (None, Ok((entity, _))) => commands.entity(entity).despawn(),
        (None, Err(_)) => {}
    }
}

/// On the stage, or beside it.
type StageOrComparison = Or<(With<OnStage>, With<OnComparison>)>;

/// Moves what is on the stage to t.
pub fn stage_t(
    playback: Res<Playback>,
    session: Res<Session>,
    mut blends: Query<&mut Blend, StageOrComparison>,
) {
    let t = session.within(playback.t());
    for mut blend in &mut blends {
        // A blend that is written to is solved, though it be the same t.
        if blend.t != t {
            blend.t = t;
        }
    }
}

/// Looks at the leg that t is in.
pub fn follow_leg(playback: Res<Playback>, mut session: ResMut<Session>) {
    let leg = session.leg_at(playback.t());
    // Looked at first: what is written to counts as changed.
    if leg != session.leg() {
        session.look_at(leg);
    }
}

/// Dresses what is on the stage in the project's colours and shows what is to be shown.
pub fn stage_style(
    session: Res<Session>,
    preferences: Res<Preferences>,
    mut styles: Query<&mut StageStyle, StageOrComparison>,
    mut ground: ResMut<ClearColor>,
) {
    let style = session.style_here();
    let [r, g, b] = style.ground.0;
    let colour = Color::srgb_u8(r, g, b);
    // Compared first, here and below: what is written to counts as changed and is drawn anew.
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

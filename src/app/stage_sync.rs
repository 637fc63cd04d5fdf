//! Passes the session's transition, t and colours to the entities on the stage.

use bevy::app::Propagate;
use bevy::camera::visibility::RenderLayers;
use bevy::prelude::*;

use crate::app::compare::comparison::{Comparison, OnComparison};
use crate::app::input::preferences::Preferences;
use crate::app::playback::player::Playback;
use crate::app::session::state::Session;
use crate::stage::{Blend, StageStyle, StageTransition};
use crate::transition::Transition;

/// Render layer of the comparison; only the comparison's camera draws it.
pub const COMPARISON_LAYER: RenderLayers = RenderLayers::layer(1);

/// Marks the entity that shows the session's transition on the stage.
#[derive(Component, Debug)]
pub struct OnStage;

/// Query for the entity with the marker component `Of`, and its transition.
type StagedEntity<'w, 's, Of> = Query<'w, 's, (Entity, &'static StageTransition), With<Of>>;

/// Puts the transition of the current segment on the stage whenever the session changes.
pub fn stage_transition(
    mut commands: Commands,
    session: Res<Session>,
    playback: Res<Playback>,
    staged: StagedEntity<OnStage>,
) {
    if session.is_changed() {
        let blend = Blend {
            t: session.segment_t(playback.t()),
        };
        stage(&mut commands, session.transition(), blend, &staged, OnStage);
    }
}

/// Adds, replaces or removes the comparison's transition whenever the comparison changes.
pub fn stage_comparison(
    mut commands: Commands,
    comparison: Res<Comparison>,
    playback: Res<Playback>,
    session: Res<Session>,
    staged: StagedEntity<OnComparison>,
) {
    if comparison.is_changed() {
        let blend = Blend {
            t: session.segment_t(playback.t()),
        };
        let markers = (OnComparison, Propagate(COMPARISON_LAYER));
        stage(
            &mut commands,
            comparison.transition(),
            blend,
            &staged,
            markers,
        );
    }
}

/// Updates the transition of the entity with the marker `Of`. Spawns the entity with all `markers`
/// if it is missing, and despawns it if `transition` is `None`.
fn stage<Of: Component>(
    commands: &mut Commands,
    transition: Option<&Transition>,
    blend: Blend,
    staged: &StagedEntity<Of>,
    markers: impl Bundle,
) {
    match (transition, staged.single()) {
        (Some(new), Ok((_, StageTransition(old))))
            // Clones of a transition share their data; inserting a clone would upload the same
            // meshes again.
            if new.is_same(old) => {}
        (Some(new), Ok((entity, _))) => {
            let new = (StageTransition(new.clone()), blend);
            commands.entity(entity).insert(new);
        }
        (Some(new), Err(_)) => {
            commands.spawn((markers, StageTransition(new.clone()), blend));
        }
        (None, Ok((entity, _))) => commands.entity(entity).despawn(),
        (None, Err(_)) => {}
    }
}

/// Query filter: entities on the stage or in the comparison.
type StageOrComparison = Or<(With<OnStage>, With<OnComparison>)>;

/// Sets t of the stage and of the comparison.
pub fn stage_t(
    playback: Res<Playback>,
    session: Res<Session>,
    mut blends: Query<&mut Blend, StageOrComparison>,
) {
    let t = session.segment_t(playback.t());
    for mut blend in &mut blends {
        // Any write to a blend triggers a solve of its warp, even if t is the same.
        if blend.t != t {
            blend.t = t;
        }
    }
}

/// Makes the segment that contains the playback's t the current one.
pub fn select_segment(playback: Res<Playback>, mut session: ResMut<Session>) {
    let segment = session.segment_at(playback.t());
    // The segment is compared first, because writing it marks the session as changed.
    if segment != session.segment() {
        session.select_segment(segment);
    }
}

/// Applies the project's colours and the display preferences to the stage and the comparison.
pub fn stage_style(
    session: Res<Session>,
    preferences: Res<Preferences>,
    mut styles: Query<&mut StageStyle, StageOrComparison>,
    mut clear_colour: ResMut<ClearColor>,
) {
    let style = session.segment_style();
    let [r, g, b] = style.ground.0;
    let colour = Color::srgb_u8(r, g, b);
    // Compared first, here and below, because each write counts as a change and causes a redraw.
    if clear_colour.0 != colour {
        clear_colour.0 = colour;
    }
    let show = preferences.show;
    for mut staged in &mut styles {
        if staged.style != style || staged.visibility != show {
            *staged = StageStyle {
                style,
                visibility: show,
            };
        }
    }
}

//! One system draws: wherever a frame moved, or looks otherwise, its parts are
//! brought up to it, each in its own way.
//!
//! Guarantees: only vertices that are seen are written, in place, and only then
//! is the mesh marked as changed; hidden parts are written when they are shown.

use bevy::platform::time::Instant;
use bevy::prelude::*;
use bevy::render::render_resource::Buffer;

use crate::content::Content;
use crate::transition::Frame;

use super::components::{Morph, StageStyle};
use super::field_material::{FieldKind, FieldLook, FieldMaterial};
use super::frame_times::FrameTimes;
use super::ink_material::linear;
use super::paint::{StagePaint, StagePaints};
use super::parts::{MissingParts, PartKind, StagePart};
use super::picture_material::ColourLook;
use super::recorded_material::{PlayedMaterial, RecordedSum};
use super::uploaded_recording::UploadState;
use super::warp_grid::GridLook;

type DrawnRoots = (
    Ref<'static, Morph>,
    Ref<'static, StageStyle>,
    &'static Children,
    Option<&'static UploadState>,
);

/// A frame, or how it looks, or what shows it, is new.
type DrawChanges = Or<(Changed<Morph>, Changed<StageStyle>, Changed<Children>)>;

/// Writes vertices and materials.
pub(super) fn draw_morphs(
    roots: Query<DrawnRoots, DrawChanges>,
    mut parts: Query<(&mut StagePart, &mut Visibility, &Mesh2d)>,
    mut paints: StagePaints,
    mut times: ResMut<FrameTimes>,
) {
    let start = Instant::now();
    let (mut some_played, mut some_read) = (false, false);
    for (morph, style, children, sent) in &roots {
        let frame = morph.frame();
        let mut parts = parts.iter_many_mut(children);
        while let Some((mut part, mut visibility, mesh)) = parts.fetch_next() {
            let (has_moved, is_restyled) = (morph.is_changed(), style.is_changed());
            // What is hidden stays stale until it is shown, however far the
            // frame moves on.
            part.stale |= part.kind.outdated(has_moved, is_restyled, frame);
            let is_shown = part.kind.is_shown(&style);
            visibility.set_if_neq(if is_shown {
                Visibility::Inherited
            } else {
                Visibility::Hidden
            });
            if !is_shown {
                continue;
            }
            if let Some(MissingParts(make)) = part.unmade.take() {
                // It stands for this part alone, and for as long.
                paints.meshes.insert(mesh, make(frame)).ok();
            }
            // What is played stays as stale as what is hidden.
            let is_played = part.is_played(sent, frame.t());
            some_played |= is_played;
            some_read |= part.reads(frame, frame.t(), &style, sent);
            if part.stale
                && !is_played
                && let Some(mut mesh) = paints.meshes.get_mut(mesh)
            {
                part.write(frame, &style, &mut mesh);
            }
            paint(&part, frame, &style, sent, &mut paints);
        }
    }
    if !roots.is_empty() {
        times.draw.record(start.elapsed());
        times.is_played = some_played && !some_read;
    }
}

/// Brings a part's material up to the frame.
fn paint(
    part: &StagePart,
    frame: &Frame,
    style: &StageStyle,
    sent: Option<&UploadState>,
    paints: &mut StagePaints,
) {
    let (t, origin) = (frame.t(), part.origin);
    match (&part.paint, frame.transition().content()) {
        (StagePaint::Ink(ink), _) => {
            let colour = linear(part.kind.colour(t, style));
            renew(&mut paints.inks, ink, |ink| &mut ink.colour, colour);
            if let PartKind::Coats(coats) = &part.kind {
                let gradients = coats.gradients().clone();
                renew(&mut paints.inks, ink, |ink| &mut ink.gradients, gradients);
            }
        }
        (StagePaint::Played(played), _) => {
            let colour = linear(part.kind.colour(t, style));
            renew(&mut paints.played, played, |part| &mut part.colour, colour);
            let sum = match sent.and_then(|sent| sent.at(t)) {
                Some((reel, sum)) => {
                    change_reel(&mut paints.played, played, reel);
                    sum
                }
                None => RecordedSum::default(),
            };
            renew(&mut paints.played, played, |part| &mut part.sum, sum);
        }
        (StagePaint::Grid(grid), _) => {
            let look = GridLook::new(frame, origin, style);
            renew(&mut paints.grids, grid, |grid| &mut grid.look, look);
        }
        (StagePaint::Field(field), Content::Field(fields)) => {
            let (pair, within) = fields.place(t);
            change_pair(&mut paints.fields, field, pair);
            let look = FieldLook::new(&fields.pairs()[pair], within, t, style);
            renew(&mut paints.fields, field, |field| &mut field.look, look);
            let kind = FieldKind::new(fields, style);
            renew(&mut paints.fields, field, |field| &mut field.kind, kind);
        }
        (StagePaint::Picture(picture), Content::Colours(pair)) => {
            let look = ColourLook::new(pair, t, origin);
            renew(&mut paints.colours, picture, |part| &mut part.look, look);
        }
        // An entity has parts of one transition only.
        (StagePaint::Field(_) | StagePaint::Picture(_), _) => {}
    }
}

fn change_reel(materials: &mut Assets<PlayedMaterial>, of: &Handle<PlayedMaterial>, reel: &Buffer) {
    if let Some(mut material) = materials.get_mut(of)
        && material.bypass_change_detection().reel.id() != reel.id()
    {
        material.reel = reel.clone();
    }
}

fn change_pair(materials: &mut Assets<FieldMaterial>, of: &Handle<FieldMaterial>, pair: usize) {
    let is_other = materials.get(of).is_some_and(|field| !field.shows(pair));
    if is_other && let Some(mut material) = materials.get_mut(of) {
        material.show(pair);
    }
}

/// Writes how a material looks only where that is otherwise, so that what
/// stands still is not sent to the graphics card.
fn renew<M: Asset, L: PartialEq>(
    materials: &mut Assets<M>,
    of: &Handle<M>,
    look: fn(&mut M) -> &mut L,
    wanted: L,
) {
    if let Some(mut material) = materials.get_mut(of)
        // Borrowed in the usual way it would count as changed even if it stays
        // as it is.
        && *look(material.bypass_change_detection()) != wanted
    {
        *look(&mut material) = wanted;
    }
}

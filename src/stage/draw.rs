//! Draws morphs: updates the meshes and materials of all render parts of morphs whose frame or
//! style changed.
//!
//! Guaranteed: only the meshes of visible render parts are written, in place, and only written
//! meshes are marked as changed. Hidden render parts are written when they become visible.

use bevy::platform::time::Instant;
use bevy::prelude::*;
use bevy::render::render_resource::Buffer;

use crate::content::Content;
use crate::transition::Frame;

use super::components::{Morph, StageStyle};
use super::field_material::{FieldKind, FieldMaterial, FieldUniform};
use super::frame_times::FrameTimes;
use super::ink_material::linear_rgba_from_rgb;
use super::paint::{StagePaint, StagePaints};
use super::parts::{DeferredMesh, PartKind, StagePart};
use super::picture_material::PictureUniform;
use super::recorded_material::{RecordedMaterial, RecordedSum};
use super::uploaded_recording::UploadState;
use super::warp_grid::GridUniform;

/// Components of a morph entity that drawing needs.
type DrawnRoots = (
    Ref<'static, Morph>,
    Ref<'static, StageStyle>,
    &'static Children,
    Option<&'static UploadState>,
);

/// Filter for morphs whose frame, style or render parts changed.
type DrawChanges = Or<(Changed<Morph>, Changed<StageStyle>, Changed<Children>)>;

/// Updates vertices, visibility and materials of all changed morphs.
pub(super) fn draw_morphs(
    roots: Query<DrawnRoots, DrawChanges>,
    mut parts: Query<(&mut StagePart, &mut Visibility, &Mesh2d)>,
    mut paints: StagePaints,
    mut times: ResMut<FrameTimes>,
) {
    let start = Instant::now();
    let (mut any_played, mut any_read) = (false, false);
    for (morph, style, children, upload) in &roots {
        let frame = morph.frame();
        let mut parts = parts.iter_many_mut(children);
        while let Some((mut part, mut visibility, mesh)) = parts.fetch_next() {
            let (has_moved, is_restyled) = (morph.is_changed(), style.is_changed());
            // A hidden render part stays stale (its vertices are outdated) until it is shown.
            part.is_stale |= part.kind.is_outdated(has_moved, is_restyled, frame);
            let is_shown = part.kind.is_shown(&style);
            visibility.set_if_neq(if is_shown {
                Visibility::Inherited
            } else {
                Visibility::Hidden
            });
            if !is_shown {
                continue;
            }
            if let Some(DeferredMesh(make)) = part.deferred_mesh.take() {
                // This cannot fail: the handle was reserved for this render part and lives as long.
                paints.meshes.insert(mesh, make(frame)).ok();
            }
            // If the graphics card evaluates a render part from a recording, the mesh of this
            // render part is not written and stays stale (outdated).
            let is_played = part.is_gpu_played(upload, frame.t());
            any_played |= is_played;
            any_read |= part.needs_positions(frame, frame.t(), &style, upload);
            if part.is_stale
                && !is_played
                && let Some(mut mesh) = paints.meshes.get_mut(mesh)
            {
                part.write(frame, &style, &mut mesh);
            }
            paint(&part, frame, &style, upload, &mut paints);
        }
    }
    if !roots.is_empty() {
        times.draw.record(start.elapsed());
        times.is_gpu_played = any_played && !any_read;
    }
}

/// Updates the material of a render part to the current frame and style.
fn paint(
    part: &StagePart,
    frame: &Frame,
    style: &StageStyle,
    upload: Option<&UploadState>,
    paints: &mut StagePaints,
) {
    let (t, origin) = (frame.t(), part.origin);
    match (&part.paint, frame.transition().content()) {
        (StagePaint::Ink(ink), _) => {
            let colour = linear_rgba_from_rgb(part.kind.colour(t, style));
            set_if_changed(&mut paints.inks, ink, |ink| &mut ink.colour, colour);
            if let PartKind::PaintLayers(layers) = &part.kind {
                let gradients = layers.gradients().clone();
                set_if_changed(&mut paints.inks, ink, |ink| &mut ink.gradients, gradients);
            }
        }
        (StagePaint::Recorded(played), _) => {
            let colour = linear_rgba_from_rgb(part.kind.colour(t, style));
            set_if_changed(&mut paints.played, played, |part| &mut part.colour, colour);
            let sum = match upload.and_then(|upload| upload.at(t)) {
                Some((rows, sum)) => {
                    bind_interval(&mut paints.played, played, rows);
                    sum
                }
                None => RecordedSum::default(),
            };
            set_if_changed(&mut paints.played, played, |part| &mut part.sum, sum);
        }
        (StagePaint::Grid(grid), _) => {
            let look = GridUniform::new(frame, origin, style);
            set_if_changed(&mut paints.grids, grid, |grid| &mut grid.look, look);
        }
        (StagePaint::Field(field), Content::Field(fields)) => {
            let (pair, within) = fields.pair_at(t);
            bind_field_pair(&mut paints.fields, field, pair);
            let look = FieldUniform::new(&fields.pairs()[pair], within, t, style);
            set_if_changed(&mut paints.fields, field, |field| &mut field.look, look);
            let kind = FieldKind::new(fields, style);
            set_if_changed(&mut paints.fields, field, |field| &mut field.kind, kind);
        }
        (StagePaint::Picture(picture), Content::Colours(pair)) => {
            let look = PictureUniform::new(pair, t, origin);
            set_if_changed(&mut paints.colours, picture, |part| &mut part.look, look);
        }
        // This cannot happen, since an entity has render parts of one transition only.
        (StagePaint::Field(_) | StagePaint::Picture(_), _) => {}
    }
}

/// Binds the buffer of a recorded interval to a material, unless it is already bound.
fn bind_interval(
    materials: &mut Assets<RecordedMaterial>,
    handle: &Handle<RecordedMaterial>,
    rows: &Buffer,
) {
    if let Some(mut material) = materials.get_mut(handle)
        && material.bypass_change_detection().reel.id() != rows.id()
    {
        material.reel = rows.clone();
    }
}

/// Makes a material show the pair of distance fields with the index `pair`, unless it already does.
fn bind_field_pair(
    materials: &mut Assets<FieldMaterial>,
    handle: &Handle<FieldMaterial>,
    pair: usize,
) {
    let is_changed = materials
        .get(handle)
        .is_some_and(|field| !field.shows_pair(pair));
    if is_changed && let Some(mut material) = materials.get_mut(handle) {
        material.show_pair(pair);
    }
}

/// Sets a value in a material if it differs. Unchanged materials are not marked as changed, so they
/// are not sent to the graphics card again.
fn set_if_changed<M: Asset, L: PartialEq>(
    materials: &mut Assets<M>,
    handle: &Handle<M>,
    field: fn(&mut M) -> &mut L,
    value: L,
) {
    if let Some(mut material) = materials.get_mut(handle)
        // A mutable borrow marks the material as changed, so values are compared without one.
        && *field(material.bypass_change_detection()) != value
    {
        *field(&mut material) = value;
    }
}

//! Writes the render meshes of distance fields, pictures and the warp grid: vertex positions, and
//! for each vertex its positions in source and target, where the shader looks up the designs.
//!
//! The fragment shader needs three interpolated points. The position in the plane is stored as
//! texture coordinates. The lookup positions in source and target are stored as a vertex colour of
//! four floats, which Bevy interpolates without conversion.

use bevy::mesh::VertexAttributeValues;
use bevy::prelude::*;
use glam::DVec2;

use crate::content::{Content, PictureLayer};
use crate::transition::Frame;

use super::vertices::{positions, write_points};

/// Writes the vertices of a frame into a mesh with the same number of vertices.
///
/// Positions are relative to `origin`. Lookup positions, at which the shader reads source and
/// target, are in grid samples for distance fields, in fractions of the sides for pictures, and
/// relative to `origin` for the warp grid, whose `content` is `None`.
pub(super) fn write(frame: &Frame, origin: DVec2, content: Option<&Content>, mesh: &mut Mesh) {
    let places = &frame.placement().in_frame;
    write_points(places, origin, positions(mesh));
    if let Some(VertexAttributeValues::Float32x2(coordinates)) =
        mesh.attribute_mut(Mesh::ATTRIBUTE_UV_0)
    {
        for (out, &p) in coordinates.iter_mut().zip(places) {
            // The difference is taken in double precision, since designs may lie far from zero.
            *out = (p - origin).as_vec2().to_array();
        }
    }
    let Some(VertexAttributeValues::Float32x4(out)) = mesh.attribute_mut(Mesh::ATTRIBUTE_COLOR)
    else {
        return;
    };
    match content {
        None => write_lookups(frame, out, |p| p - origin, |p| p - origin),
        Some(Content::Field(fields)) => {
            let grid = fields.first_pair().grid();
            let in_samples = |p: DVec2| grid.lattice_from_plane(p);
            write_lookups(frame, out, in_samples, in_samples);
        }
        Some(Content::Colours(pair)) => {
            let [source, target] = pair.layers().each_ref().map(picture_fractions);
            write_lookups(frame, out, source, target);
        }
        Some(Content::Solid(_)) => {} // needs no lookup
    }
}

/// Returns the mapping from points of the plane to fractions of the picture's width and height.
fn picture_fractions(layer: &PictureLayer) -> impl Fn(DVec2) -> DVec2 {
    let (width, height) = layer.picture().pixels().dimensions();
    let size = DVec2::new(f64::from(width), f64::from(height));
    move |p| layer.pixel_from_plane(p) / size
}

/// Writes the positions of all vertices in source and target to `out`. The functions `source` and
/// `target` convert them to the positions at which the shader reads the designs.
fn write_lookups(
    frame: &Frame,
    out: &mut [[f32; 4]],
    source: impl Fn(DVec2) -> DVec2,
    target: impl Fn(DVec2) -> DVec2,
) {
    let placement = frame.placement();
    let pairs = placement.in_source.iter().zip(&placement.in_target);
    for (out, (&a, &b)) in out.iter_mut().zip(pairs) {
        let (a, b) = (source(a).as_vec2(), target(b).as_vec2());
        *out = [a.x, a.y, b.x, b.y];
    }
}

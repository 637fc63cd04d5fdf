//! The render mesh of what a warp carries: fields and pictures.
//!
//! Its vertices are those of the placement. Each brings along where it is in
//! the plane (as texture coordinates) and where to look in the source and in
//! the target (as a colour of four floats: Bevy interpolates those as they
//! are), so that the fragment shader knows all three.

use bevy::mesh::VertexAttributeValues;
use bevy::prelude::*;
use glam::DVec2;

use crate::content::Content;
use crate::transition::Frame;

use super::shapes::write_points;

/// In what the places to look at are told.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Lookups {
    /// In samples of the fields, or in shares of the pictures' sides.
    OfContent,
    /// In units of the plane, relative to the part's origin.
    OfPlane,
}

/// The lengths are those of the placement's vertices.
pub(super) fn write(frame: &Frame, origin: DVec2, lookups: Lookups, mesh: &mut Mesh) {
    let places = &frame.placement().in_frame;
    if let Some(VertexAttributeValues::Float32x3(positions)) =
        mesh.attribute_mut(Mesh::ATTRIBUTE_POSITION)
    {
        write_points(places, origin, positions);
    }
    if let Some(VertexAttributeValues::Float32x2(coordinates)) =
        mesh.attribute_mut(Mesh::ATTRIBUTE_UV_0)
    {
        for (out, &p) in coordinates.iter_mut().zip(places) {
            *out = (p - origin).as_vec2().to_array();
        }
    }
    if let Some(VertexAttributeValues::Float32x4(out)) = mesh.attribute_mut(Mesh::ATTRIBUTE_COLOR) {
        match lookups {
            Lookups::OfContent => write_lookups(frame, out),
            Lookups::OfPlane => {
                let placement = frame.placement();
                let pairs = placement.in_source.iter().zip(&placement.in_target);
                for (out, (&a, &b)) in out.iter_mut().zip(pairs) {
                    let (a, b) = ((a - origin).as_vec2(), (b - origin).as_vec2());
                    *out = [a.x, a.y, b.x, b.y];
                }
            }
        }
    }
}

fn write_lookups(frame: &Frame, out: &mut [[f32; 4]]) {
    let placement = frame.placement();
    let pairs = placement.in_source.iter().zip(&placement.in_target);
    let write =
        |out: &mut [[f32; 4]], source: &dyn Fn(DVec2) -> DVec2, target: &dyn Fn(DVec2) -> DVec2| {
            for (out, (&a, &b)) in out.iter_mut().zip(pairs) {
                let (a, b) = (source(a).as_vec2(), target(b).as_vec2());
                *out = [a.x, a.y, b.x, b.y];
            }
        };
    match frame.transition().content() {
        Content::Field(pair) => {
            let in_samples = |p: DVec2| pair.grid().lattice_from_plane(p);
            write(out, &in_samples, &in_samples);
        }
        Content::Colours(pair) => {
            let [source, target] = pair.layers();
            let share = |k: usize| {
                let (width, height) = pair.layers()[k].picture().pixels().dimensions();
                DVec2::new(f64::from(width), f64::from(height))
            };
            let sizes = [share(0), share(1)];
            write(out, &|p| source.pixel_from_plane(p) / sizes[0], &|p| {
                target.pixel_from_plane(p) / sizes[1]
            });
        }
        Content::Solid(_) => {}
    }
}

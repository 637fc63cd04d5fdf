//! Encodes gradients for the shader: a uniform table of numbers with all gradients, and for each
//! vertex the index of its gradient in the table and its position in the gradient's own space.

use bevy::prelude::*;
use bevy::render::render_resource::ShaderType;
use glam::{DAffine2, DVec2};

use crate::colour::{Gradient, GradientGeometry, GradientSpread, Paint};

/// Size of the gradient table, in vectors of four numbers; the same as in `ink.wgsl`. A gradient
/// takes two vectors plus two per stop. Gradients that do not fit are drawn in their mean colour
/// (resource limit: 8 KiB of uniforms).
const CAPACITY: usize = 512;

/// Uniform with the table of all gradients of a frame.
#[derive(Clone, Debug, PartialEq, ShaderType)]
pub(super) struct GradientUniform {
    numbers: [Vec4; CAPACITY],
}

impl Default for GradientUniform {
    fn default() -> Self {
        Self {
            numbers: [Vec4::ZERO; CAPACITY],
        }
    }
}

/// Builder of the [`GradientUniform`] of a frame.
#[derive(Default)]
pub(super) struct GradientTable {
    pub(super) gradients: GradientUniform,
    /// For each gradient: the index of its first vector in the table.
    firsts: Vec<usize>,
    /// Number of vectors of the table that are in use.
    used: usize,
}

/// Place of a gradient in the table, with the mapping into the gradient's own space.
#[derive(Clone, Copy, Debug)]
pub(super) struct GradientSlot {
    /// Index of the gradient's first vector in the table.
    first: usize,
    /// Mapping from the plane to the gradient's own space.
    gradient_from_plane: DAffine2,
}

impl GradientTable {
    /// Adds a gradient to the table. Returns `None` if the table has no room for it, or if the
    /// gradient has no stops or a singular affine transform.
    pub(super) fn insert(&mut self, gradient: &Gradient) -> Option<GradientSlot> {
        let into = gradient.frame.inverse();
        if !into.is_finite() || gradient.stops.is_empty() {
            return None;
        }
        let spread = match gradient.spread {
            GradientSpread::Pad => 0.0,
            GradientSpread::Reflect => 1.0,
            GradientSpread::Repeat => 2.0,
        };
        let (kind, focus, inner) = match gradient.geometry {
            GradientGeometry::Linear => (0.0, DVec2::ZERO, 0.0),
            GradientGeometry::Radial { focus, inner } => (1.0, focus, inner),
        };
        let head = Vec4::new(kind, spread, gradient.stops.len() as f32, inner as f32);
        let focus = focus.as_vec2().extend(0.0).extend(0.0);
        let stops = gradient.stops.iter().flat_map(|stop| {
            let at = Vec4::new(stop.offset as f32, 0.0, 0.0, 0.0);
            [encode_srgb(stop.paint), at]
        });
        let numbers: Vec<Vec4> = [head, focus].into_iter().chain(stops).collect();
        Some(GradientSlot {
            first: self.put_numbers(&numbers)?,
            gradient_from_plane: into,
        })
    }

    /// Returns the index in the table of a gradient's first vector, and adds the vectors if they
    /// are new. Gradients that differ only in their position share their vectors.
    fn put_numbers(&mut self, numbers: &[Vec4]) -> Option<usize> {
        let is_there = |&first: &usize| self.gradients.numbers[first..].starts_with(numbers);
        if let Some(&first) = self.firsts.iter().find(|first| is_there(first)) {
            return Some(first);
        }
        let first = self.used;
        let room = self
            .gradients
            .numbers
            .get_mut(first..first + numbers.len())?;
        room.copy_from_slice(numbers);
        self.firsts.push(first);
        self.used += numbers.len();
        Some(first)
    }
}

impl GradientSlot {
    /// Returns a vertex colour that encodes the gradient's index in the table. Its negative opacity
    /// distinguishes it from a real colour.
    pub(super) fn vertex_colour(&self) -> [f32; 4] {
        [self.first as f32, 0.0, 0.0, -1.0]
    }

    /// Converts a point of the plane to the gradient's own space.
    pub(super) fn gradient_coordinates(&self, p: DVec2) -> [f32; 2] {
        self.gradient_from_plane
            .transform_point2(p)
            .as_vec2()
            .to_array()
    }
}

/// Encodes a paint as sRGB with straight alpha, the space in which gradients are interpolated.
fn encode_srgb(paint: Paint) -> Vec4 {
    let [red, green, blue] = paint.colour.0.map(|channel| f32::from(channel) / 255.0);
    Vec4::new(red, green, blue, paint.opacity as f32)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::colour::{GradientStop, Rgb};

    #[test]
    fn gradients_without_room_are_left_out() {
        let stop = |at: f64| GradientStop {
            offset: at,
            paint: Rgb([9; 3]).into(),
        };
        let gradient = |count: u32| Gradient {
            geometry: GradientGeometry::Linear,
            frame: DAffine2::from_scale(DVec2::splat(2.0)),
            stops: (0..count).map(|k| stop(f64::from(k) / 300.0)).collect(),
            spread: GradientSpread::Pad,
        };
        let mut table = GradientTable::default();
        assert!(table.insert(&gradient(0)).is_none());
        let first = table.insert(&gradient(200)).expect("room");
        assert_eq!(first.gradient_coordinates(DVec2::new(1.0, 4.0)), [0.5, 2.0]);
        assert!(table.insert(&gradient(60)).is_none());
        let again = table.insert(&gradient(200)).expect("is there");
        assert_eq!(again.vertex_colour(), first.vertex_colour());
        let second = table.insert(&gradient(2)).expect("room");
        assert_eq!(second.vertex_colour()[0], 402.0);
        let flat = gradient(2).transformed(DAffine2::from_scale(DVec2::X));
        assert!(table.insert(&flat).is_none());
    }
}

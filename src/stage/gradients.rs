//! Gradients as the shader reads them: a uniform table of numbers, and per vertex the position in
//! the gradient's own space.

use bevy::prelude::*;
use bevy::render::render_resource::ShaderType;
use glam::{DAffine2, DVec2};

use crate::colour::{Gradient, GradientGeometry, GradientSpread, Paint};

/// Size of the table, in vectors of four numbers; the same as in `ink.wgsl`. A gradient takes two
/// vectors plus two per stop; gradients that do not fit are drawn in their mean colour (resource
/// limit: 8 KiB of uniforms).
const CAPACITY: usize = 512;

/// Uniform with all gradients of a frame.
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

/// Builder of the uniform table.
#[derive(Default)]
pub(super) struct GradientTable {
    pub(super) gradients: GradientUniform,
    /// Index of the first vector of each gradient.
    firsts: Vec<usize>,
    /// Number of vectors in use.
    used: usize,
}

/// Reference to a gradient in the table.
#[derive(Clone, Copy, Debug)]
pub(super) struct GradientSlot {
    /// Index of the first vector of the gradient.
    first: usize,
    /// Map from the plane to the gradient's own space.
    into: DAffine2,
}

impl GradientTable {
    /// Adds a gradient. Returns `None` if there is no room, it has no stops, or its frame is
    /// degenerate.
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
            into,
        })
    }

    /// Index of a sequence of vectors, which is added if it is new. Equal gradients at different
    /// positions share it.
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
    /// Vertex colour that refers to the gradient. The negative opacity distinguishes it from a
    /// colour.
    pub(super) fn vertex_colour(&self) -> [f32; 4] {
        [self.first as f32, 0.0, 0.0, -1.0]
    }

    /// Converts a point of the plane to the gradient's own space.
    pub(super) fn gradient_coordinates(&self, p: DVec2) -> [f32; 2] {
        self.into.transform_point2(p).as_vec2().to_array()
    }
}

/// sRGB with straight opacity, the space in which gradients are mixed.
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

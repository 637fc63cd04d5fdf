//! Gradients as shaders are told them: a table of numbers, and in each vertex where it
//! is in its gradient's own space.

use bevy::prelude::*;
use bevy::render::render_resource::ShaderType;
use glam::{DAffine2, DVec2};

use crate::colour::{Gradient, GradientGeometry, GradientSpread, Paint};

/// How many numbers there are, four at a time: a gradient takes two of them, and two for
/// each stop. What has no place any more shows its mean.
const ROOM: usize = 512;

/// All gradients of a frame.
#[derive(Clone, Debug, PartialEq, ShaderType)]
pub(super) struct GradientTextures {
    numbers: [Vec4; ROOM],
}

impl Default for GradientTextures {
    fn default() -> Self {
        Self {
            numbers: [Vec4::ZERO; ROOM],
        }
    }
}

/// Gradients as they are put into the table.
#[derive(Default)]
pub(super) struct GradientTable {
    pub(super) gradients: GradientTextures,
    /// Where each begins.
    firsts: Vec<usize>,
    taken: usize,
}

/// A gradient in the table.
#[derive(Clone, Copy, Debug)]
pub(super) struct ShadedFaces {
    first: usize,
    /// From the plane to the gradient's own space.
    into: DAffine2,
}

impl GradientTable {
    /// Puts a gradient in, if there is room and it is not flat.
    pub(super) fn put(&mut self, gradient: &Gradient) -> Option<ShadedFaces> {
        let into = gradient.frame.inverse();
        if !into.is_finite() || gradient.stops.is_empty() {
            return None;
        }
        let spread = match gradient.spread {
            GradientSpread::Pad => 0.0,
            GradientSpread::Reflect => 1.0,
            GradientSpread::Repeat => 2.0,
        };
        let (kind, focus, inner) = match gradient.course {
            GradientGeometry::Straight => (0.0, DVec2::ZERO, 0.0),
            GradientGeometry::Round { focus, inner } => (1.0, focus, inner),
        };
        let head = Vec4::new(kind, spread, gradient.stops.len() as f32, inner as f32);
        let focus = focus.as_vec2().extend(0.0).extend(0.0);
        let stops = gradient.stops.iter().flat_map(|stop| {
            let at = Vec4::new(stop.at as f32, 0.0, 0.0, 0.0);
            [encoded(stop.paint), at]
        });
        let numbers: Vec<Vec4> = [head, focus].into_iter().chain(stops).collect();
        Some(ShadedFaces {
            first: self.put_numbers(&numbers)?,
            into,
        })
    }

    /// Where the numbers are; those that are the same, in another place of the plane, only
    /// once.
    fn put_numbers(&mut self, numbers: &[Vec4]) -> Option<usize> {
        let is_there = |&first: &usize| self.gradients.numbers[first..].starts_with(numbers);
        if let Some(&first) = self.firsts.iter().find(|first| is_there(first)) {
            return Some(first);
        }
        let first = self.taken;
        let room = self
            .gradients
            .numbers
            .get_mut(first..first + numbers.len())?;
        room.copy_from_slice(numbers);
        self.firsts.push(first);
        self.taken += numbers.len();
        Some(first)
    }
}

impl ShadedFaces {
    /// What stands in the place of a colour: no opacity is negative.
    pub(super) fn mark(&self) -> [f32; 4] {
        [self.first as f32, 0.0, 0.0, -1.0]
    }

    /// Where a point of the plane is in the gradient's own space.
    pub(super) fn place(&self, p: DVec2) -> [f32; 2] {
        self.into.transform_point2(p).as_vec2().to_array()
    }
}

/// sRGB with straight opacity, as gradients mix it.
fn encoded(paint: Paint) -> Vec4 {
    let [red, green, blue] = paint.colour.0.map(|channel| f32::from(channel) / 255.0);
    Vec4::new(red, green, blue, paint.opacity as f32)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::colour::{GradientStop, Rgb};

    #[test]
    fn what_has_no_room_is_left_out() {
        let stop = |at: f64| GradientStop {
            at,
            paint: Rgb([9; 3]).into(),
        };
        let gradient = |count: u32| Gradient {
            course: GradientGeometry::Straight,
            frame: DAffine2::from_scale(DVec2::splat(2.0)),
            stops: (0..count).map(|k| stop(f64::from(k) / 300.0)).collect(),
            spread: GradientSpread::Pad,
        };
        let mut table = GradientTable::default();
        assert!(table.put(&gradient(0)).is_none());
        let first = table.put(&gradient(200)).expect("room");
        assert_eq!(first.place(DVec2::new(1.0, 4.0)), [0.5, 2.0]);
        assert!(table.put(&gradient(60)).is_none());
        let again = table.put(&gradient(200)).expect("is there");
        assert_eq!(again.mark(), first.mark());
        let second = table.put(&gradient(2)).expect("room");
        assert_eq!(second.mark()[0], 402.0);
        let flat = gradient(2).moved(DAffine2::from_scale(DVec2::X));
        assert!(table.put(&flat).is_none());
    }
}

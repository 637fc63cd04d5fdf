//! Linear and radial gradients, their mean paint, and interpolation between them.
//!
//! Within a gradient, colours between two stops are mixed as in SVG 2, section 14.2: in sRGB with
//! straight opacity. Between two gradients, paints are interpolated in OKLab, like all other
//! paints.

use super::{Paint, Rgb};
use glam::{DAffine2, DVec2};

/// A linear or radial gradient.
#[derive(Clone, Debug, PartialEq)]
pub struct Gradient {
    /// Kind of the gradient, with its inner circle if it is radial.
    pub geometry: GradientGeometry,
    /// Affine map from the gradient's own space to the plane. In its own space, a linear gradient
    /// runs from x = 0 to x = 1, and a radial gradient from its inner circle to the unit circle.
    pub frame: DAffine2,
    /// Stops in ascending order of offset. Two stops with the same offset form a hard edge, at
    /// which the paint jumps.
    pub stops: Vec<GradientStop>,
    /// Continuation of the gradient beyond the offsets 0 and 1.
    pub spread: GradientSpread,
}

/// Geometry of a gradient in its own space.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum GradientGeometry {
    /// Runs along x, from 0 to 1, in the gradient's own space.
    Linear,
    /// Runs from an inner circle to the unit circle, which contains the inner circle.
    Radial {
        /// Centre of the inner circle, in the gradient's own space.
        focus: DVec2,
        /// Radius of the inner circle, in the gradient's own space.
        inner: f64,
    },
}

/// A paint at an offset along the gradient.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GradientStop {
    /// Offset along the gradient, from 0 to 1.
    pub offset: f64,
    /// Paint at that offset.
    pub paint: Paint,
}

/// Continuation of a gradient beyond the offsets 0 and 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum GradientSpread {
    /// Continues with the paint of the nearer end.
    Pad,
    /// Repeats; every second repetition is mirrored.
    Reflect,
    /// Repeats; every repetition runs from offset 0 to offset 1.
    Repeat,
}

impl Gradient {
    /// Returns the mean paint over the offsets from 0 to 1; a transparent paint if there are no
    /// stops.
    #[must_use]
    pub fn mean(&self) -> Paint {
        let (Some(first), Some(last)) = (self.stops.first(), self.stops.last()) else {
            return TRANSPARENT;
        };
        // The paint of the first stop also fills the offsets before it, and that of the last stop
        // the offsets after it.
        let ends = [(first.paint, first.offset), (last.paint, 1.0 - last.offset)];
        let between = self.stops.windows(2).map(|pair| {
            let paint = pair[0].paint.mixed(pair[1].paint, 0.5);
            (paint, pair[1].offset - pair[0].offset)
        });
        Paint::mean(ends.into_iter().chain(between))
    }

    /// Returns the gradient transformed by an affine map of the plane.
    #[must_use]
    pub fn transformed(&self, by: DAffine2) -> Self {
        Self {
            frame: by * self.frame,
            ..self.clone()
        }
    }

    /// Returns the gradient with the paint of each stop replaced by the result of `paint`.
    #[must_use]
    pub fn map_paints(&self, paint: impl Fn(Paint) -> Paint) -> Self {
        let stop = |stop: &GradientStop| GradientStop {
            paint: paint(stop.paint),
            ..*stop
        };
        Self {
            stops: self.stops.iter().map(stop).collect(),
            ..self.clone()
        }
    }

    /// Interpolates towards another gradient. `t` is clamped to [0, 1]; `t` = 0 returns `self` and
    /// `t` = 1 returns `other` exactly.
    ///
    /// Gradients of the same kind and spread are interpolated offset by offset. Otherwise all
    /// paints of `self` first change to the mean paint of both gradients, which is reached at t =
    /// 0.5. From there, the mean paint changes to the paints of `other`.
    #[must_use]
    pub fn mixed(&self, other: &Self, t: f64) -> Self {
        let t = t.clamp(0.0, 1.0);
        match self.geometry.mixed(other.geometry, t) {
            _ if t == 0.0 => self.clone(),
            _ if t == 1.0 => other.clone(),
            Some(geometry) if self.spread == other.spread => Self {
                geometry,
                frame: DAffine2 {
                    matrix2: self.frame.matrix2 * (1.0 - t) + other.frame.matrix2 * t,
                    translation: self.frame.translation.lerp(other.frame.translation, t),
                },
                stops: self.mixed_stops(other, t),
                spread: self.spread,
            },
            _ => {
                let mean_of_both = self.mean().mixed(other.mean(), 0.5);
                let (nearer, share) = match t < 0.5 {
                    true => (self, 2.0 * t),
                    false => (other, 2.0 - 2.0 * t),
                };
                nearer.map_paints(|paint| paint.mixed(mean_of_both, share))
            }
        }
    }

    /// Interpolated stops at all offsets where either gradient has a stop; two stops at a hard
    /// edge, one for each side.
    fn mixed_stops(&self, other: &Self, t: f64) -> Vec<GradientStop> {
        let stops = self.stops.iter().chain(&other.stops);
        let mut offsets: Vec<f64> = stops.map(|stop| stop.offset).collect();
        offsets.sort_by(f64::total_cmp);
        offsets.dedup();
        let mixed = offsets.into_iter().flat_map(|at| {
            let [a, b] = [self, other].map(|gradient| gradient.paints_around(at));
            let [before, after] = [0, 1].map(|k| a[k].mixed(b[k], t));
            let paints = [Some(before), Some(after).filter(|after| *after != before)];
            paints
                .into_iter()
                .flatten()
                .map(move |paint| GradientStop { offset: at, paint })
        });
        mixed.collect()
    }

    /// Paints just before and just after the offset `at`; they differ at a hard edge only.
    fn paints_around(&self, at: f64) -> [Paint; 2] {
        let stops = &self.stops;
        let (Some(first), Some(last)) = (stops.first(), stops.last()) else {
            return [TRANSPARENT; 2];
        };
        let between = |next: usize| match (next.checked_sub(1), stops.get(next)) {
            (None, _) => first.paint,
            (_, None) => last.paint,
            (Some(k), Some(next)) => {
                let here = stops[k];
                let share = (at - here.offset) / (next.offset - here.offset);
                here.paint.mixed_in_srgb(next.paint, share)
            }
        };
        let before = stops.partition_point(|stop| stop.offset < at);
        let after = stops.partition_point(|stop| stop.offset <= at);
        if before == after {
            return [between(before); 2];
        }
        [stops[before].paint, stops[after - 1].paint]
    }
}

impl GradientGeometry {
    /// Interpolates towards `other`; returns `None` if one gradient is linear and the other radial.
    fn mixed(self, other: Self, t: f64) -> Option<Self> {
        match (self, other) {
            (Self::Linear, Self::Linear) => Some(Self::Linear),
            (Self::Radial { focus: f, inner: r }, Self::Radial { focus: g, inner: s }) => {
                Some(Self::Radial {
                    focus: f.lerp(g, t),
                    inner: r * (1.0 - t) + s * t,
                })
            }
            _ => None,
        }
    }
}

/// A fully transparent paint.
const TRANSPARENT: Paint = Paint {
    colour: Rgb([0; 3]),
    opacity: 0.0,
};

impl Paint {
    /// Returns the weighted mean of (paint, weight) pairs, in OKLab with premultiplied opacity; a
    /// transparent paint if there are no pairs.
    pub(crate) fn mean(paints: impl Iterator<Item = (Self, f64)>) -> Self {
        let (mean, _) = paints.fold((TRANSPARENT, 0.0), |(mean, total), (paint, weight)| {
            let sum = total + weight;
            let share = if sum > 0.0 { weight / sum } else { 0.0 };
            (mean.mixed(paint, share), sum)
        });
        mean
    }

    /// Interpolates towards `other` in sRGB with straight opacity, as between two stops of one
    /// gradient. `share` is in [0, 1].
    fn mixed_in_srgb(self, other: Self, share: f64) -> Self {
        let mixed = |a: f64, b: f64| a * (1.0 - share) + b * share;
        let channel = |k: usize| {
            let [a, b] = [self, other].map(|paint| f64::from(paint.colour.0[k]));
            mixed(a, b).round() as u8
        };
        Self {
            colour: Rgb(std::array::from_fn(channel)),
            opacity: mixed(self.opacity, other.opacity),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn straight(stops: &[(f64, [u8; 3])]) -> Gradient {
        let stop = |&(at, colour): &(f64, [u8; 3])| GradientStop {
            offset: at,
            paint: Rgb(colour).into(),
        };
        Gradient {
            geometry: GradientGeometry::Linear,
            frame: DAffine2::IDENTITY,
            stops: stops.iter().map(stop).collect(),
            spread: GradientSpread::Pad,
        }
    }

    const BLACK: [u8; 3] = [0; 3];
    const WHITE: [u8; 3] = [255; 3];

    #[test]
    fn gradients_of_one_kind_are_mixed_offset_by_offset() {
        let a = straight(&[(0.0, BLACK), (1.0, WHITE)]);
        let b = straight(&[(0.0, WHITE), (0.5, BLACK), (0.5, WHITE), (1.0, WHITE)]);
        let b = b.transformed(DAffine2::from_translation(DVec2::new(4.0, 0.0)));
        assert_eq!(a.mixed(&b, 0.0), a);
        assert_eq!(a.mixed(&b, 1.0), b);
        let half = a.mixed(&b, 0.5);
        assert_eq!(half.frame.translation, DVec2::new(2.0, 0.0));
        let offsets: Vec<f64> = half.stops.iter().map(|stop| stop.offset).collect();
        assert_eq!(offsets, [0.0, 0.5, 0.5, 1.0]);
        let grey = |k: usize| half.stops[k].paint.colour.0[0];
        assert!(grey(1) < grey(2), "the edge stays one");
    }

    #[test]
    fn gradients_of_two_kinds_meet_in_the_mean_of_both() {
        let a = straight(&[(0.0, BLACK), (1.0, BLACK)]);
        let mut b = straight(&[(0.0, WHITE), (1.0, WHITE)]);
        b.geometry = GradientGeometry::Radial {
            focus: DVec2::ZERO,
            inner: 0.0,
        };
        let [near, far] = [0.5 - 1e-9, 0.5 + 1e-9].map(|t| a.mixed(&b, t));
        assert_eq!([near.geometry, far.geometry], [a.geometry, b.geometry]);
        assert_eq!(near.stops[0].paint.colour, far.stops[0].paint.colour);
        assert_eq!(a.mean().colour, Rgb(BLACK));
    }

    #[test]
    fn the_mean_includes_the_padding_at_the_ends() {
        let late = straight(&[(0.8, BLACK), (1.0, WHITE)]);
        let early = straight(&[(0.0, BLACK), (0.2, WHITE)]);
        assert!(late.mean().colour.0[0] < 80 && early.mean().colour.0[0] > 180);
        assert_eq!(straight(&[]).mean().opacity, 0.0);
    }
}

//! Gradients: paints that change along a line, or from a point outwards.
//!
//! Between two stops colours are mixed as drawings have it (SVG 2, section 14.2): in
//! sRGB, opacity straight. From one gradient to another paints go as all paints do.

use super::{Paint, Rgb};
use glam::{DAffine2, DVec2};

/// A paint that changes from place to place.
#[derive(Clone, Debug, PartialEq)]
pub struct Gradient {
    /// Along what it changes.
    pub course: GradientGeometry,
    /// From the gradient's own space to the plane. A straight one runs from 0 to 1
    /// along x, a round one from its focus to the unit circle.
    pub frame: DAffine2,
    /// Paints along the way, by ascending place; two at one place are an edge.
    pub stops: Vec<GradientStop>,
    /// What comes before the first stop's end of the way and after the last one's.
    pub spread: GradientSpread,
}

/// The way of a gradient in its own space.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum GradientGeometry {
    /// Along x.
    Straight,
    /// From a circle within the unit circle to that.
    Round {
        /// The middle of the inner circle.
        focus: DVec2,
        /// Its radius.
        inner: f64,
    },
}

/// A paint at a place of the way, from 0 to 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GradientStop {
    /// The place.
    pub at: f64,
    /// The paint there.
    pub paint: Paint,
}

/// How a gradient goes on beyond its way.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum GradientSpread {
    /// As it is at its ends.
    Pad,
    /// Back and forth.
    Reflect,
    /// From the beginning.
    Repeat,
}

impl Gradient {
    /// The mean along its way.
    #[must_use]
    pub fn mean(&self) -> Paint {
        let (Some(first), Some(last)) = (self.stops.first(), self.stops.last()) else {
            return NOTHING;
        };
        // The ends go on as they are.
        let ends = [(first.paint, first.at), (last.paint, 1.0 - last.at)];
        let between = self.stops.windows(2).map(|pair| {
            let paint = pair[0].paint.mixed(pair[1].paint, 0.5);
            (paint, pair[1].at - pair[0].at)
        });
        Paint::mean(ends.into_iter().chain(between))
    }

    /// The same where the plane is moved.
    #[must_use]
    pub fn moved(&self, by: DAffine2) -> Self {
        Self {
            frame: by * self.frame,
            ..self.clone()
        }
    }

    /// The same with each paint as another.
    #[must_use]
    pub fn repainted(&self, paint: impl Fn(Paint) -> Paint) -> Self {
        let stop = |stop: &GradientStop| GradientStop {
            paint: paint(stop.paint),
            ..*stop
        };
        Self {
            stops: self.stops.iter().map(stop).collect(),
            ..self.clone()
        }
    }

    /// The gradient at `t` in [0, 1] on the way to another. Two of one kind become each
    /// other, place by place; of two kinds the first goes to the mean of both until the
    /// middle, and from there the second comes. The ends are exact.
    #[must_use]
    pub fn mixed(&self, other: &Self, t: f64) -> Self {
        let t = t.clamp(0.0, 1.0);
        match self.course.mixed(other.course, t) {
            _ if t == 0.0 => self.clone(),
            _ if t == 1.0 => other.clone(),
            Some(course) if self.spread == other.spread => Self {
                course,
                frame: DAffine2 {
                    matrix2: self.frame.matrix2 * (1.0 - t) + other.frame.matrix2 * t,
                    translation: self.frame.translation.lerp(other.frame.translation, t),
                },
                stops: self.mixed_stops(other, t),
                spread: self.spread,
            },
            _ => {
                let middle = self.mean().mixed(other.mean(), 0.5);
                let (near, share) = match t < 0.5 {
                    true => (self, 2.0 * t),
                    false => (other, 2.0 - 2.0 * t),
                };
                near.repainted(|paint| paint.mixed(middle, share))
            }
        }
    }

    /// Stops at all places where either has one, on both sides of edges.
    fn mixed_stops(&self, other: &Self, t: f64) -> Vec<GradientStop> {
        let all = self.stops.iter().chain(&other.stops);
        let mut places: Vec<f64> = all.map(|stop| stop.at).collect();
        places.sort_by(f64::total_cmp);
        places.dedup();
        let stops = places.into_iter().flat_map(|at| {
            let [a, b] = [self, other].map(|gradient| gradient.around(at));
            let [before, after] = [0, 1].map(|k| a[k].mixed(b[k], t));
            let paints = [Some(before), Some(after).filter(|after| *after != before)];
            paints
                .into_iter()
                .flatten()
                .map(move |paint| GradientStop { at, paint })
        });
        stops.collect()
    }

    /// The paints right before and right after a place of the way.
    fn around(&self, at: f64) -> [Paint; 2] {
        let stops = &self.stops;
        let (Some(first), Some(last)) = (stops.first(), stops.last()) else {
            return [NOTHING; 2];
        };
        let between = |next: usize| match (next.checked_sub(1), stops.get(next)) {
            (None, _) => first.paint,
            (_, None) => last.paint,
            (Some(k), Some(next)) => {
                let here = stops[k];
                let share = (at - here.at) / (next.at - here.at);
                here.paint.in_srgb(next.paint, share)
            }
        };
        let before = stops.partition_point(|stop| stop.at < at);
        let after = stops.partition_point(|stop| stop.at <= at);
        if before == after {
            return [between(before); 2];
        }
        [stops[before].paint, stops[after - 1].paint]
    }
}

impl GradientGeometry {
    /// On the way to another of the same kind.
    fn mixed(self, other: Self, t: f64) -> Option<Self> {
        match (self, other) {
            (Self::Straight, Self::Straight) => Some(Self::Straight),
            (Self::Round { focus: f, inner: r }, Self::Round { focus: g, inner: s }) => {
                Some(Self::Round {
                    focus: f.lerp(g, t),
                    inner: r * (1.0 - t) + s * t,
                })
            }
            _ => None,
        }
    }
}

const NOTHING: Paint = Paint {
    colour: Rgb([0; 3]),
    opacity: 0.0,
};

impl Paint {
    /// The mean of paints by their weights; of none a paint that shows nothing.
    pub(crate) fn mean(paints: impl Iterator<Item = (Self, f64)>) -> Self {
        let (mean, _) = paints.fold((NOTHING, 0.0), |(mean, total), (paint, weight)| {
            let sum = total + weight;
            let share = if sum > 0.0 { weight / sum } else { 0.0 };
            (mean.mixed(paint, share), sum)
        });
        mean
    }

    /// A share of the way to another, as within a gradient.
    fn in_srgb(self, other: Self, share: f64) -> Self {
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
            at,
            paint: Rgb(colour).into(),
        };
        Gradient {
            course: GradientGeometry::Straight,
            frame: DAffine2::IDENTITY,
            stops: stops.iter().map(stop).collect(),
            spread: GradientSpread::Pad,
        }
    }

    const BLACK: [u8; 3] = [0; 3];
    const WHITE: [u8; 3] = [255; 3];

    #[test]
    fn gradients_of_one_kind_become_each_other_place_by_place() {
        let a = straight(&[(0.0, BLACK), (1.0, WHITE)]);
        let b = straight(&[(0.0, WHITE), (0.5, BLACK), (0.5, WHITE), (1.0, WHITE)]);
        let b = b.moved(DAffine2::from_translation(DVec2::new(4.0, 0.0)));
        assert_eq!(a.mixed(&b, 0.0), a);
        assert_eq!(a.mixed(&b, 1.0), b);
        let half = a.mixed(&b, 0.5);
        assert_eq!(half.frame.translation, DVec2::new(2.0, 0.0));
        let at: Vec<f64> = half.stops.iter().map(|stop| stop.at).collect();
        assert_eq!(at, [0.0, 0.5, 0.5, 1.0]);
        let grey = |k: usize| half.stops[k].paint.colour.0[0];
        assert!(grey(1) < grey(2), "the edge stays one");
    }

    #[test]
    fn gradients_of_two_kinds_meet_in_the_mean_of_both() {
        let a = straight(&[(0.0, BLACK), (1.0, BLACK)]);
        let mut b = straight(&[(0.0, WHITE), (1.0, WHITE)]);
        b.course = GradientGeometry::Round {
            focus: DVec2::ZERO,
            inner: 0.0,
        };
        let [near, far] = [0.5 - 1e-9, 0.5 + 1e-9].map(|t| a.mixed(&b, t));
        assert_eq!([near.course, far.course], [a.course, b.course]);
        assert_eq!(near.stops[0].paint.colour, far.stops[0].paint.colour);
        assert_eq!(a.mean().colour, Rgb(BLACK));
    }

    #[test]
    fn the_mean_goes_on_at_the_ends() {
        let late = straight(&[(0.8, BLACK), (1.0, WHITE)]);
        let early = straight(&[(0.0, BLACK), (0.2, WHITE)]);
        assert!(late.mean().colour.0[0] < 80 && early.mean().colour.0[0] > 180);
        assert_eq!(straight(&[]).mean().opacity, 0.0);
    }
}

//! Gradients as formats know them that have two points and no affine map.
//!
//! A straight one keeps its looks under every map: its lines of one colour are what is
//! mapped. A round one that is squashed is drawn round, as large on average.

use crate::colour::{Gradient, GradientGeometry};
use crate::geometry::DVec2;

/// A gradient by points of the picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum TwoPointGradient {
    /// From one point to another.
    Straight { from: DVec2, to: DVec2 },
    /// From a focus to the circle around a middle.
    Round {
        middle: DVec2,
        radius: f64,
        focus: DVec2,
        /// Radius of the circle around the focus.
        inner: f64,
    },
}

impl TwoPointGradient {
    pub(super) fn of(gradient: &Gradient) -> Self {
        let frame = gradient.frame;
        let [x, y] = [frame.matrix2.x_axis, frame.matrix2.y_axis];
        match gradient.course {
            GradientGeometry::Straight => {
                // Lines of one colour run along y; across them is the way.
                let across = DVec2::new(y.y, -y.x);
                let length = across.length_squared();
                let way = if length > 0.0 {
                    across * (x.dot(across) / length)
                } else {
                    x
                };
                Self::Straight {
                    from: frame.translation,
                    to: frame.translation + way,
                }
            }
            GradientGeometry::Round { focus, inner } => {
                let radius = frame.matrix2.determinant().abs().sqrt();
                Self::Round {
                    middle: frame.translation,
                    radius,
                    focus: frame.transform_point2(focus),
                    inner: inner * radius,
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::colour::GradientSpread;
    use crate::geometry::{DAffine2, DMat2};

    #[test]
    fn a_straight_gradient_that_is_sheared_keeps_its_lines_of_one_colour() {
        let frame = DAffine2 {
            matrix2: DMat2::from_cols(DVec2::new(4.0, 1.0), DVec2::new(1.0, 2.0)),
            translation: DVec2::new(3.0, 5.0),
        };
        let gradient = Gradient {
            course: GradientGeometry::Straight,
            frame,
            stops: Vec::new(),
            spread: GradientSpread::Pad,
        };
        let TwoPointGradient::Straight { from, to } = TwoPointGradient::of(&gradient) else {
            panic!("it is straight");
        };
        let way = to - from;
        for at in [
            DVec2::new(0.3, 0.0),
            DVec2::new(0.3, 2.0),
            DVec2::new(1.0, -1.0),
        ] {
            let share = (frame.transform_point2(at) - from).dot(way) / way.length_squared();
            assert!((share - at.x).abs() < 1e-12, "{share} at {at}");
        }
    }
}

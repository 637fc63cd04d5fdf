//! Gradients reduced to points and radii, for animation formats without an affine gradient
//! transform.
//!
//! Linear gradients are reproduced exactly under every affine map. A radial gradient that an affine
//! map makes elliptical becomes circular, with the same area.

use crate::colour::{Gradient, GradientGeometry};
use crate::geometry::DVec2;

/// Gradient given by points and radii in the image, in pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum TwoPointGradient {
    /// Linear gradient from one point to another.
    Linear { from: DVec2, to: DVec2 },
    /// Radial gradient from the circle with radius `inner` around `focus` to the circle with radius
    /// `radius` around `middle`.
    Radial {
        middle: DVec2,
        radius: f64,
        focus: DVec2,
        /// Radius of the circle at which the gradient starts.
        inner: f64,
    },
}

impl TwoPointGradient {
    /// Reduces a gradient, which has an affine transform, to points and radii.
    pub(super) fn of(gradient: &Gradient) -> Self {
        let frame = gradient.frame;
        let [x, y] = [frame.matrix2.x_axis, frame.matrix2.y_axis];
        match gradient.geometry {
            GradientGeometry::Linear => {
                // Lines of equal colour run along the y axis of the gradient as transformed to the
                // image. The vector from start to end is the component of the transformed x axis
                // perpendicular to these lines.
                let across = DVec2::new(y.y, -y.x);
                let length = across.length_squared();
                let vector = if length > 0.0 {
                    across * (x.dot(across) / length)
                } else {
                    x
                };
                Self::Linear {
                    from: frame.translation,
                    to: frame.translation + vector,
                }
            }
            GradientGeometry::Radial { focus, inner } => {
                let radius = frame.matrix2.determinant().abs().sqrt();
                Self::Radial {
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
    fn a_sheared_linear_gradient_keeps_its_lines_of_equal_colour() {
        let frame = DAffine2 {
            matrix2: DMat2::from_cols(DVec2::new(4.0, 1.0), DVec2::new(1.0, 2.0)),
            translation: DVec2::new(3.0, 5.0),
        };
        let gradient = Gradient {
            geometry: GradientGeometry::Linear,
            frame,
            stops: Vec::new(),
            spread: GradientSpread::Pad,
        };
        let TwoPointGradient::Linear { from, to } = TwoPointGradient::of(&gradient) else {
            panic!("expected a linear gradient");
        };
        let vector = to - from;
        for at in [
            DVec2::new(0.3, 0.0),
            DVec2::new(0.3, 2.0),
            DVec2::new(1.0, -1.0),
        ] {
            let offset = (frame.transform_point2(at) - from).dot(vector) / vector.length_squared();
            assert!((offset - at.x).abs() < 1e-12, "{offset} at {at}");
        }
    }
}

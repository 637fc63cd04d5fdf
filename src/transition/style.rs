//! The colours in which a transition is shown, in the application and in exported files.

use crate::colour::{Gradient, Paint, Rgb};
use serde::{Deserialize, Serialize};

/// Colours in which a transition is shown, and whether joints are drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields, rename_all = "kebab-case")]
pub struct TransitionStyle {
    /// Fill colour at t = 0 of shapes without a paint.
    pub source: Rgb,
    /// Fill colour at t = 1 of shapes without a paint.
    pub target: Rgb,
    /// Colour of the background.
    pub ground: Rgb,
    /// Whether the joints of a truss are drawn.
    pub joints: bool,
}

impl Default for TransitionStyle {
    /// Returns blue to orange on warm white, which are distinguishable with every common form of
    /// colour blindness.
    fn default() -> Self {
        Self {
            source: Rgb([0x2f, 0x6f, 0xb3]),
            target: Rgb([0xd9, 0x82, 0x2b]),
            ground: Rgb([0xf7, 0xf5, 0xf0]),
            joints: true,
        }
    }
}

impl TransitionStyle {
    /// Returns the fill colour at `t`, which is clamped to [0, 1].
    #[must_use]
    pub fn fill_at(&self, t: f64) -> Rgb {
        self.source.mixed(self.target, t)
    }

    /// Returns the paint at `t` of a shape with these paints in source and target; a missing paint
    /// is replaced by the style's colour at that end.
    #[must_use]
    pub fn paint_at(&self, ends: [Option<Paint>; 2], t: f64) -> Paint {
        match ends {
            [None, None] => self.fill_at(t).into(),
            [source, target] => {
                let source = source.unwrap_or(self.source.into());
                source.mixed(target.unwrap_or(self.target.into()), t)
            }
        }
    }

    /// Returns the gradient at `t` of a shape with a gradient in source, target or both; the other
    /// end contributes its paint. `None` if neither end has a gradient.
    #[must_use]
    pub fn gradient_at(
        &self,
        ends: [Option<&Gradient>; 2],
        paints: [Option<Paint>; 2],
        t: f64,
    ) -> Option<Gradient> {
        let t = t.clamp(0.0, 1.0);
        match ends {
            [None, None] => None,
            [Some(source), Some(target)] => Some(source.mixed(target, t)),
            [Some(source), None] => {
                let target = self.paint_at(paints, 1.0);
                Some(source.map_paints(|paint| paint.mixed(target, t)))
            }
            [None, Some(target)] => {
                let source = self.paint_at(paints, 0.0);
                Some(target.map_paints(|paint| source.mixed(paint, t)))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ends_are_exact_and_colours_are_not_extrapolated() {
        let style = TransitionStyle::default();
        for (t, colour) in [
            (-1.0, style.source),
            (0.0, style.source),
            (1.0, style.target),
            (9.0, style.target),
        ] {
            assert_eq!(style.fill_at(t), colour);
        }
        let red = Paint::from(Rgb([255, 0, 0]));
        assert_eq!(style.paint_at([Some(red), None], 0.0), red);
        assert_eq!(style.paint_at([Some(red), None], 1.0), style.target.into());
        assert_eq!(style.paint_at([None, None], 0.5), style.fill_at(0.5).into());
    }
}

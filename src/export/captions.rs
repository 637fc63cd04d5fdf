//! Captions below the frames of a film. Each shows the name of a stop (a named moment) or, without
//! named stops, of a design. It fades in before the t of this stop or design, and out after it.

use super::drawing::Drawing;
use crate::colour::{Paint, Rgb};
use crate::geometry::DVec2;
use crate::io::sanitize::without_direction_controls;
use crate::transition::TransitionStop;

/// Share of the way from a caption's t to the midpoint between this caption and its neighbour.
/// Within this share, the caption is fully opaque (heuristic).
const OPAQUE_UNTIL: f64 = 0.5;

/// Share of the way from a caption's t to the midpoint between this caption and its neighbour.
/// Beyond this share, the caption is hidden (heuristic).
const HIDDEN_FROM: f64 = 0.9;

/// Captions with the t of each, and their colour.
#[derive(Clone, Debug, PartialEq)]
pub struct Captions {
    /// The t and the text of each caption, by ascending t.
    names: Vec<(f64, String)>,
    colour: Rgb,
}

impl Captions {
    /// Maximum width of a caption, as a fraction of the image width (heuristic).
    pub const MAX_WIDTH: f64 = 0.92;

    /// Text height of a caption, as a fraction of the image's shorter side (heuristic).
    pub const TEXT_HEIGHT: f64 = 0.055;

    /// Height of the band reserved for captions, as a fraction of the image's shorter side
    /// (heuristic).
    pub const BAND_HEIGHT: f64 = 0.12;

    /// Creates captions from the names of the stops (named moments of a transition). If no stop has
    /// a name, the captions are the names of the designs, one at each whole t. The text is dark or
    /// light, whichever is readable on the background.
    #[must_use]
    pub fn new<'a>(
        stops: &[TransitionStop],
        designs: impl IntoIterator<Item = &'a str>,
        ground: Rgb,
    ) -> Self {
        let named = stops
            .iter()
            .map(|stop| (stop.t, without_direction_controls(&stop.name)));
        let mut names: Vec<(f64, String)> = named.filter(|(_, name)| !name.is_empty()).collect();
        if names.is_empty() {
            let designs = designs.into_iter().enumerate();
            names = designs
                .map(|(k, name)| (k as f64, without_direction_controls(name)))
                .collect();
        }
        names.sort_by(|a, b| a.0.total_cmp(&b.0));
        // Threshold on relative luminance: 0.2 is about a middle grey in sRGB.
        let [r, g, b] = ground.to_linear();
        let is_light = 0.2126 * r + 0.7152 * g + 0.0722 * b > 0.2;
        Self {
            names,
            colour: Rgb(if is_light {
                [28, 32, 38]
            } else {
                [236, 238, 240]
            }),
        }
    }

    /// Returns the caption at `t` and its opacity in (0, 1], or `None` where no caption is visible.
    #[must_use]
    pub fn at(&self, t: f64) -> Option<(&str, f64)> {
        let distance = |name: &&(f64, String)| (name.0 - t).abs();
        let nearest = self
            .names
            .iter()
            .min_by(|a, b| distance(a).total_cmp(&distance(b)))?;
        let beyond = |name: &&(f64, String)| (name.0 - nearest.0) * (t - nearest.0) > 0.0;
        let next = self.names.iter().filter(beyond);
        let gap = next.map(|name| (name.0 - nearest.0).abs()).reduce(f64::min);
        // The first caption does not fade before its t, nor the last one after its t, because there
        // is no neighbour on that side.
        let to_midpoint = gap.map_or(0.0, |gap| 2.0 * (t - nearest.0).abs() / gap);
        let opacity =
            1.0 - ((to_midpoint - OPAQUE_UNTIL) / (HIDDEN_FROM - OPAQUE_UNTIL)).clamp(0.0, 1.0);
        (opacity > 0.0).then_some((nearest.1.as_str(), opacity))
    }

    /// Returns the text colour of the captions.
    #[must_use]
    pub fn colour(&self) -> Rgb {
        self.colour
    }

    /// Draws the caption of the frame at `t`.
    pub(super) fn push(&self, drawing: &mut Drawing, t: f64) {
        let Some((words, opacity)) = self.at(t) else {
            return;
        };
        let size = drawing.size.as_dvec2();
        let shorter = size.min_element();
        let room = [Self::MAX_WIDTH * size.x, Self::TEXT_HEIGHT * shorter];
        let base = DVec2::new(0.5 * size.x, size.y - 0.45 * Self::BAND_HEIGHT * shorter);
        let paint = Paint {
            opacity,
            ..self.colour.into()
        };
        drawing.push_label_within(words, base, room, paint);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn stop(t: f64, name: &str) -> TransitionStop {
        TransitionStop::at(t).with_name(name)
    }

    #[test]
    fn a_name_is_visible_near_its_stop_and_hidden_midway_between_two() {
        let stops = [stop(1.0, "end"), stop(0.0, "start"), stop(0.5, "")];
        let captions = Captions::new(&stops, ["a", "b"], Rgb([255; 3]));
        assert_eq!(captions.at(0.0), Some(("start", 1.0)));
        assert_eq!(captions.at(0.2), Some(("start", 1.0)));
        assert_eq!(captions.at(0.5), None);
        assert_eq!(captions.at(0.9), Some(("end", 1.0)));
        assert_eq!(captions.at(7.0), Some(("end", 1.0)));
        let (words, opacity) = captions.at(0.35).expect("half of it");
        assert!(words == "start" && (0.4..0.6).contains(&opacity));
        let plain = Captions::new(&[], ["a", "b"], Rgb([0; 3]));
        assert_eq!(plain.at(0.0), Some(("a", 1.0)));
        assert_ne!(plain.colour, captions.colour);
    }
}

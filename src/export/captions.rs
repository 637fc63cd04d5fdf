//! Words below a film: the names of its stops, each while the film is near it.

use super::drawing::Drawing;
use crate::colour::{Paint, Rgb};
use crate::geometry::DVec2;
use crate::transition::TransitionStop;

/// The share of the way to the middle between two names that one stays whole, and that
/// at which it is gone.
const WHOLE: f64 = 0.5;
const GONE: f64 = 0.9;

/// What stands below a film, and when.
#[derive(Clone, Debug, PartialEq)]
pub struct Captions {
    /// Names by ascending t.
    names: Vec<(f64, String)>,
    colour: Rgb,
}

impl Captions {
    /// How much of a picture's width a caption may have.
    pub const WIDEST: f64 = 0.92;

    /// The height of a line of letters, of the shorter side.
    pub const LETTERS: f64 = 0.055;

    /// The height of the band that captions stand in, of a picture's shorter side.
    pub const BAND: f64 = 0.12;

    /// The names of the stops; where none has one, those of the designs, one at each whole
    /// t. They are dark or light, whichever can be read on that ground.
    #[must_use]
    pub fn new<'a>(
        stops: &[TransitionStop],
        designs: impl IntoIterator<Item = &'a str>,
        ground: Rgb,
    ) -> Self {
        let named = stops.iter().filter(|stop| !stop.name.is_empty());
        let mut names: Vec<(f64, String)> = named.map(|s| (s.t, s.name.clone())).collect();
        if names.is_empty() {
            let designs = designs.into_iter().enumerate();
            names = designs
                .map(|(k, name)| (k as f64, name.to_owned()))
                .collect();
        }
        names.sort_by(|a, b| a.0.total_cmp(&b.0));
        // As bright as a middle grey looks.
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

    /// The name at `t`, and how much of it is seen, in [0, 1].
    #[must_use]
    pub fn at(&self, t: f64) -> Option<(&str, f64)> {
        let far = |name: &&(f64, String)| (name.0 - t).abs();
        let nearest = self.names.iter().min_by(|a, b| far(a).total_cmp(&far(b)))?;
        let beyond = |name: &&(f64, String)| (name.0 - nearest.0) * (t - nearest.0) > 0.0;
        let next = self.names.iter().filter(beyond);
        let gap = next.map(|name| (name.0 - nearest.0).abs()).reduce(f64::min);
        // Beyond the last one it stays.
        let way = gap.map_or(0.0, |gap| 2.0 * (t - nearest.0).abs() / gap);
        let seen = 1.0 - ((way - WHOLE) / (GONE - WHOLE)).clamp(0.0, 1.0);
        (seen > 0.0).then_some((nearest.1.as_str(), seen))
    }

    /// What they are written in.
    #[must_use]
    pub fn colour(&self) -> Rgb {
        self.colour
    }

    /// Adds what stands below the frame at `t`.
    pub(super) fn push(&self, drawing: &mut Drawing, t: f64) {
        let Some((words, seen)) = self.at(t) else {
            return;
        };
        let size = drawing.size.as_dvec2();
        let shorter = size.min_element();
        let room = [Self::WIDEST * size.x, Self::LETTERS * shorter];
        let base = DVec2::new(0.5 * size.x, size.y - 0.45 * Self::BAND * shorter);
        let paint = Paint {
            opacity: seen,
            ..self.colour.into()
        };
        drawing.push_label_within(words, base, room, paint);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn stop(t: f64, name: &str) -> TransitionStop {
        TransitionStop::at(t).named(name)
    }

    #[test]
    fn a_name_is_seen_near_its_stop_and_gone_between_two() {
        let stops = [stop(1.0, "end"), stop(0.0, "start"), stop(0.5, "")];
        let captions = Captions::new(&stops, ["a", "b"], Rgb([255; 3]));
        assert_eq!(captions.at(0.0), Some(("start", 1.0)));
        assert_eq!(captions.at(0.2), Some(("start", 1.0)));
        assert_eq!(captions.at(0.5), None);
        assert_eq!(captions.at(0.9), Some(("end", 1.0)));
        assert_eq!(captions.at(7.0), Some(("end", 1.0)));
        let (words, seen) = captions.at(0.35).expect("half of it");
        assert!(words == "start" && (0.4..0.6).contains(&seen));
        let plain = Captions::new(&[], ["a", "b"], Rgb([0; 3]));
        assert_eq!(plain.at(0.0), Some(("a", 1.0)));
        assert_ne!(plain.colour, captions.colour);
    }
}

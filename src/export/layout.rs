//! How a film lies in its pictures: their shape and size, and the room around it.
//!
//! Sizes go by the shorter side, as screens are named: 1080 is 1920 × 1080 where
//! pictures are wide, 1080 × 1920 where they are tall and 1080 × 1080 where they are
//! square.

use super::captions::Captions;
use super::size::{PixelSize, PixelSizeError};
use super::view::PlaneView;
use crate::geometry::{Bounds, DVec2};
use crate::settings::choice::named;

/// The shape of a picture.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Aspect {
    /// That of the drawing.
    Own,
    /// 16 to 9.
    #[default]
    Wide,
    /// 4 to 3.
    Classic,
    /// 1 to 1.
    Square,
    /// 9 to 16.
    Tall,
}

named! { Aspect {
    Wide: "16:9", "16:9", "Slides and screens";
    Classic: "4:3", "4:3", "Older slides, and tablets";
    Square: "1:1", "1:1", "Posts";
    Tall: "9:16", "9:16", "Telephones, held upright";
    Own: "own", "Own", "As the drawing is";
} }

impl Aspect {
    /// Width by height; none where it is the drawing's.
    fn ratio(self) -> Option<f64> {
        match self {
            Self::Own => None,
            Self::Wide => Some(16.0 / 9.0),
            Self::Classic => Some(4.0 / 3.0),
            Self::Square => Some(1.0),
            Self::Tall => Some(9.0 / 16.0),
        }
    }
}

/// The longest that a drawing's own shape is shown, of its shorter side.
const LONGEST: f64 = 16.0 / 9.0;

/// The shape and the size of pictures, and what is left free in them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PictureLayout {
    /// Their shape.
    pub aspect: Aspect,
    /// Pixels along the shorter side.
    pub lines: u32,
    /// What is free all around, a fraction of the shorter side in [0, 0.4].
    pub margin: f64,
    /// Whether there is room for a caption below.
    pub has_captions: bool,
}

impl Default for PictureLayout {
    fn default() -> Self {
        Self {
            aspect: Aspect::default(),
            lines: 1080,
            margin: 0.0,
            has_captions: false,
        }
    }
}

impl PictureLayout {
    /// The view of all that lies in `bounds`. Sides are even, as films want them.
    ///
    /// ```
    /// use morphospace::export::{Aspect, Layout};
    /// use morphospace::geometry::{Bounds, DVec2};
    /// let bounds = Bounds { min: DVec2::ZERO, max: DVec2::new(2.0, 3.0) };
    /// let post = Layout { aspect: Aspect::Tall, ..Layout::default() };
    /// assert_eq!(post.view(bounds)?.size().to_string(), "1080x1920");
    /// # Ok::<(), morphospace::export::SizeError>(())
    /// ```
    ///
    /// # Errors
    /// [`PixelSizeError`] where there are no lines, or too many.
    pub fn view(&self, bounds: Bounds) -> Result<PlaneView, PixelSizeError> {
        Ok(self.view_of(bounds, self.size(bounds)?))
    }

    /// The view of all that lies in `bounds` in a picture of another size, with margin
    /// and room for a caption as asked for.
    #[must_use]
    pub fn view_of(&self, bounds: Bounds, size: PixelSize) -> PlaneView {
        let shorter = size.as_dvec2().min_element();
        let margin = self.margin.clamp(0.0, 0.4) * shorter;
        let below = if self.has_captions {
            Captions::BAND * shorter
        } else {
            0.0
        };
        let corner = DVec2::splat(margin);
        let cell = size.as_dvec2() - 2.0 * corner - DVec2::new(0.0, below);
        PlaneView::fit_cell(bounds, size, corner, cell.max(DVec2::ONE))
    }

    fn size(&self, bounds: Bounds) -> Result<PixelSize, PixelSizeError> {
        let shorter = f64::from(self.lines);
        let Some(ratio) = self.aspect.ratio() else {
            let own = bounds.size();
            let longer = own.max_element() / own.min_element();
            let longer = if longer.is_finite() {
                longer.min(LONGEST)
            } else {
                1.0
            };
            // Refused here where it is too large; a shape is only made smaller.
            PixelSize::new(self.lines, self.lines)?;
            return Ok(PixelSize::of_shape(
                bounds,
                (shorter * longer).round() as u32,
            ));
        };
        let size = DVec2::new(ratio.max(1.0), (1.0 / ratio).max(1.0)) * shorter;
        let [width, height] = size.to_array().map(|side| side.round() as u32);
        Ok(PixelSize::new(width, height)?.to_even())
    }
}

/// Layouts for what films are mostly made for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum LayoutPreset {
    /// Slides of a talk.
    Deck,
    /// A square post.
    Post,
    /// Upright, for telephones.
    Story,
    /// Small, for a page or a message.
    Page,
}

named! { LayoutPreset {
    Deck: "deck", "Slides", "16:9, 1920 × 1080, with captions from the stops";
    Post: "post", "Post", "1:1, 1080 × 1080";
    Story: "story", "Story", "9:16, 1080 × 1920, with captions from the stops";
    Page: "page", "Page", "The drawing's own shape, small";
} }

impl LayoutPreset {
    /// Its layout.
    #[must_use]
    pub fn layout(self) -> PictureLayout {
        let (aspect, lines, has_captions) = match self {
            Self::Deck => (Aspect::Wide, 1080, true),
            Self::Post => (Aspect::Square, 1080, false),
            Self::Story => (Aspect::Tall, 1080, true),
            Self::Page => (Aspect::Own, 480, false),
        };
        PictureLayout {
            aspect,
            lines,
            has_captions,
            ..PictureLayout::default()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn wide() -> Bounds {
        Bounds {
            min: DVec2::new(-3.0, 1.0),
            max: DVec2::new(37.0, 5.0),
        }
    }

    #[test]
    fn sizes_go_by_the_shorter_side() {
        let sizes = Aspect::ALL.map(|aspect| {
            let layout = PictureLayout {
                aspect,
                lines: 720,
                ..PictureLayout::default()
            };
            layout.view(wide()).expect("a view").size().to_string()
        });
        // A drawing ten times as long as high is shown as long as slides are.
        assert_eq!(
            sizes,
            ["1280x720", "960x720", "720x720", "720x1280", "1280x128"]
        );
    }

    #[test]
    fn margins_and_captions_are_left_free() {
        let layout = PictureLayout {
            margin: 0.1,
            has_captions: true,
            ..LayoutPreset::Post.layout()
        };
        let view = layout.view(wide()).expect("a view");
        let [low, high] = [wide().min, wide().max].map(|p| view.to_px(p));
        assert!((low.x - 108.0).abs() < 1e-9 && (high.x - 972.0).abs() < 1e-9);
        assert!(low.y < 0.9 * 1080.0 - Captions::BAND * 1080.0);
    }

    #[test]
    fn no_lines_and_too_many_are_refused() {
        for (aspect, lines) in [(Aspect::Wide, 0), (Aspect::Own, 0), (Aspect::Own, 99_999)] {
            let layout = PictureLayout {
                aspect,
                lines,
                ..PictureLayout::default()
            };
            assert!(layout.view(wide()).is_err(), "{layout:?}");
        }
    }
}

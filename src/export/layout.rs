//! Image layout of a film: aspect ratio, size in pixels, margin, and room for captions.
//!
//! Sizes are given by the shorter side, as in the video format 1080p: 1080 means 1920 × 1080 for
//! wide images, 1080 × 1920 for tall ones and 1080 × 1080 for square ones.

use super::captions::Captions;
use super::size::{PixelSize, PixelSizeError};
use super::view::PlaneView;
use crate::geometry::{Bounds, DVec2};
use crate::settings::named;

/// Aspect ratio of an image.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Aspect {
    /// Aspect ratio of the drawing itself.
    Original,
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
    Square: "1:1", "1:1", "Square posts";
    Tall: "9:16", "9:16", "Phones, upright";
    Original: "own", "Original", "Same shape as the drawing";
} }

impl Aspect {
    /// Returns width divided by height; `None` for the aspect ratio of the drawing.
    fn ratio(self) -> Option<f64> {
        match self {
            Self::Original => None,
            Self::Wide => Some(16.0 / 9.0),
            Self::Classic => Some(4.0 / 3.0),
            Self::Square => Some(1.0),
            Self::Tall => Some(9.0 / 16.0),
        }
    }
}

/// Maximum length of the longer side for [`Aspect::Original`], in multiples of
/// [`PictureLayout::lines`] (heuristic: that of a 16:9 image). For more elongated drawings, the
/// shorter side is reduced below `lines` instead.
const MAX_LONGER_SIDE: f64 = 16.0 / 9.0;

/// Aspect ratio and size of images, and the space left free in them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PictureLayout {
    /// Aspect ratio of the images.
    pub aspect: Aspect,
    /// Length of the shorter side of the images, in pixels.
    pub lines: u32,
    /// Free margin on all sides, as a fraction of the shorter side, in [0, 0.4].
    pub margin: f64,
    /// Whether room is reserved for a caption at the bottom.
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
    /// Returns the view that shows all of `bounds`. Both sides of the image are even, as video
    /// encoders require.
    ///
    /// ```
    /// use morphospace::export::{Aspect, PictureLayout};
    /// use morphospace::geometry::{Bounds, DVec2};
    /// let bounds = Bounds { min: DVec2::ZERO, max: DVec2::new(2.0, 3.0) };
    /// let post = PictureLayout { aspect: Aspect::Tall, ..PictureLayout::default() };
    /// assert_eq!(post.view(bounds)?.size().to_string(), "1080x1920");
    /// # Ok::<(), morphospace::export::PixelSizeError>(())
    /// ```
    ///
    /// # Errors
    /// [`PixelSizeError`] if `lines` is 0 or the image would be too large.
    pub fn view(&self, bounds: Bounds) -> Result<PlaneView, PixelSizeError> {
        Ok(self.view_of(bounds, self.size(bounds)?))
    }

    /// Returns the view that shows all of `bounds` in an image of the given size, with the margin
    /// and caption space of this layout. The aspect ratio and `lines` of the layout are ignored.
    #[must_use]
    pub fn view_of(&self, bounds: Bounds, size: PixelSize) -> PlaneView {
        let shorter = size.as_dvec2().min_element();
        let margin = self.margin.clamp(0.0, 0.4) * shorter;
        let below = if self.has_captions {
            Captions::BAND_HEIGHT * shorter
        } else {
            0.0
        };
        let corner = DVec2::splat(margin);
        let cell = size.as_dvec2() - 2.0 * corner - DVec2::new(0.0, below);
        PlaneView::fit_cell(bounds, size, corner, cell.max(DVec2::ONE))
    }

    /// Returns the size of the image for a drawing with these bounds.
    fn size(&self, bounds: Bounds) -> Result<PixelSize, PixelSizeError> {
        let shorter = f64::from(self.lines);
        let Some(ratio) = self.aspect.ratio() else {
            let drawing = bounds.size();
            let ratio = drawing.max_element() / drawing.min_element();
            // The bounds of a point, or of a horizontal or vertical line, have no finite ratio.
            let longer = if ratio.is_finite() {
                ratio.min(MAX_LONGER_SIDE)
            } else {
                1.0
            };
            // Checks the limits first: `of_shape` would silently clamp a size that is too large.
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

/// Ready-made layouts for common uses of a film.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum LayoutPreset {
    /// Slides for a talk.
    Deck,
    /// Square, for posts.
    Post,
    /// Upright, for phones.
    Story,
    /// Small, for a web page or a message.
    WebPage,
}

named! { LayoutPreset {
    Deck: "deck", "Slides", "16:9, 1920 × 1080, with captions from the stops";
    Post: "post", "Post", "1:1, 1080 × 1080";
    Story: "story", "Story", "9:16, 1080 × 1920, with captions from the stops";
    WebPage: "page", "Web page", "Original shape, 480 px";
} }

impl LayoutPreset {
    /// Returns the layout of this preset.
    #[must_use]
    pub fn layout(self) -> PictureLayout {
        let (aspect, lines, has_captions) = match self {
            Self::Deck => (Aspect::Wide, 1080, true),
            Self::Post => (Aspect::Square, 1080, false),
            Self::Story => (Aspect::Tall, 1080, true),
            Self::WebPage => (Aspect::Original, 480, false),
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
        // The drawing is ten times as wide as high: its longer side is limited to that of a 16:9
        // image.
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
        assert!(low.y < 0.9 * 1080.0 - Captions::BAND_HEIGHT * 1080.0);
    }

    #[test]
    fn no_lines_and_too_many_are_refused() {
        for (aspect, lines) in [
            (Aspect::Wide, 0),
            (Aspect::Original, 0),
            (Aspect::Original, 99_999),
        ] {
            let layout = PictureLayout {
                aspect,
                lines,
                ..PictureLayout::default()
            };
            assert!(layout.view(wide()).is_err(), "{layout:?}");
        }
    }
}

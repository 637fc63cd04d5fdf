//! Pictures in drawings. Each is replaced by a rectangle in its mean colour, so that its place in
//! the drawing is kept.

use super::SvgPainter;
use crate::colour::{Paint, Rgb};
use crate::design::silhouette::decode;
use crate::design::svg::ink_layers::{WindingRings, clip_rings};
use image::RgbaImage;
use usvg::{Image, ImageKind};

impl SvgPainter<'_> {
    /// Adds a rectangle in the mean colour of a picture. Pictures that cannot be decoded are
    /// ignored and reported.
    pub(super) fn picture(&mut self, image: &Image, clip: Option<&WindingRings>) {
        let data = match image.kind() {
            ImageKind::PNG(data)
            | ImageKind::JPEG(data)
            | ImageKind::GIF(data)
            | ImageKind::WEBP(data) => data,
            ImageKind::SVG(_) => return,
        };
        let Some(mean) = self.mean_of_picture(data) else {
            let label = self.current_label();
            self.painted
                .lost
                .ignore("picture that cannot be read", &label);
            return;
        };
        self.approximate("picture", "replaced by a rectangle in its mean colour");
        let size = image.size();
        let rectangle = [0.0, 0.0, size.width().into(), size.height().into()];
        let rings = self.rectangle(rectangle, self.frame);
        self.add_shape(clip_rings(rings, clip), mean, None);
    }

    /// Returns the mean colour of an encoded picture; `None` if it cannot be decoded or exceeds the
    /// limit.
    fn mean_of_picture(&mut self, data: &[u8]) -> Option<Paint> {
        let format = image::guess_format(data).ok()?;
        if self.picture_pixels_left == 0 {
            return None;
        }
        let picture = decode(data, format).ok()?;
        let pixels = u64::from(picture.width()) * u64::from(picture.height());
        self.picture_pixels_left = self.picture_pixels_left.saturating_sub(pixels);
        Some(mean_paint(&picture))
    }
}

/// Returns the mean of the pixels of a picture, weighted by their opacity.
fn mean_paint(picture: &RgbaImage) -> Paint {
    let (mut colour, mut opacity) = ([0_u64; 3], 0_u64);
    for pixel in picture.pixels() {
        let [r, g, b, a] = pixel.0.map(u64::from);
        for (sum, channel) in colour.iter_mut().zip([r, g, b]) {
            *sum += channel * a;
        }
        opacity += a;
    }
    let weight = opacity.max(1);
    let pixels = u64::from(picture.width()) * u64::from(picture.height());
    Paint {
        colour: Rgb(colour.map(|sum| ((sum + weight / 2) / weight) as u8)),
        opacity: opacity as f64 / (255 * pixels) as f64,
    }
}

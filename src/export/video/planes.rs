//! Converts images to the planes of YUV pixels that ffmpeg encodes, in limited-range BT.709.
//!
//! Guarantees: opacity is exact, straight (colours are not premultiplied), and of full range. The
//! invisible colours of transparent pixels continue those around them, so that neither the coarser
//! chroma nor the compression darkens edges.

use image::RgbaImage;
use yuv::{
    YuvChromaSubsampling, YuvConversionMode, YuvPlanarImageMut, YuvRange, YuvStandardMatrix,
    rgba_to_yuv420,
};

/// Layout of the planes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum PixelFormat {
    /// Luma of all pixels, then two chroma samples for each 2 × 2 pixels, 8 bits each.
    Yuv420,
    /// As above, then the opacity of all pixels.
    Yuva420,
    /// Luma and two chroma samples of all pixels, 10 bits each, in 2 bytes with the lower one
    /// first.
    Yuv444TenBit,
    /// As above, then the opacity of all pixels.
    Yuva444TenBit,
}

impl PixelFormat {
    /// Returns the name that ffmpeg has for the format.
    pub(super) fn ffmpeg_name(self) -> &'static str {
        match self {
            Self::Yuv420 => "yuv420p",
            Self::Yuva420 => "yuva420p",
            Self::Yuv444TenBit => "yuv444p10le",
            Self::Yuva444TenBit => "yuva444p10le",
        }
    }

    /// Converts an image. ffmpeg could convert instead, but on a single thread, and after more
    /// bytes have passed through the pipe.
    pub(super) fn planes(self, mut image: RgbaImage) -> Vec<u8> {
        let opacity: Vec<u8> = match self {
            Self::Yuv420 | Self::Yuv444TenBit => Vec::new(),
            Self::Yuva420 | Self::Yuva444TenBit => image.pixels().map(|pixel| pixel.0[3]).collect(),
        };
        if !opacity.is_empty() {
            colour_transparent_pixels(&mut image);
        }
        match self {
            Self::Yuv420 | Self::Yuva420 => [yuv420(&image), opacity].concat(),
            Self::Yuv444TenBit | Self::Yuva444TenBit => {
                let opacity = opacity.into_iter().map(ten_bit_opacity);
                yuv444(&image)
                    .into_iter()
                    .chain(opacity)
                    .flat_map(u16::to_le_bytes)
                    .collect()
            }
        }
    }
}

/// Converts an image to planar 4:2:0.
fn yuv420(image: &RgbaImage) -> Vec<u8> {
    let (width, height) = image.dimensions();
    let mut planes = YuvPlanarImageMut::alloc(width, height, YuvChromaSubsampling::Yuv420);
    let (range, matrix) = (YuvRange::Limited, YuvStandardMatrix::Bt709);
    let mode = YuvConversionMode::Balanced;
    let stride = 4 * width;
    // The conversion fails only if the buffer sizes do not match, and they come from one image.
    let conversion = rgba_to_yuv420(&mut planes, image.as_raw(), stride, range, matrix, mode);
    debug_assert!(conversion.is_ok());
    let planes = [planes.y_plane, planes.u_plane, planes.v_plane];
    planes.each_ref().map(|plane| plane.borrow()).concat()
}

/// Converts an image to planar 4:4:4 with 10 bits.
fn yuv444(image: &RgbaImage) -> Vec<u16> {
    // Luma weights of red and blue (ITU-R BT.709, item 3.2).
    let [red, blue] = [0.2126, 0.0722];
    // Ranges of 10-bit luma and chroma (ITU-R BT.709, item 4.6).
    let [luma_min, luma_range, chroma_zero, chroma_range] = [64.0, 876.0, 512.0, 896.0];
    let pixels = image.pixels().map(|pixel| {
        let [r, g, b, _] = pixel.0.map(|channel| f32::from(channel) / 255.0);
        let luma = red * r + (1.0 - red - blue) * g + blue * b;
        let chroma = [
            0.5 * (b - luma) / (1.0 - blue),
            0.5 * (r - luma) / (1.0 - red),
        ];
        let [u, v] = chroma.map(|chroma| chroma_zero + chroma_range * chroma);
        [luma_min + luma_range * luma, u, v].map(|level| level.round() as u16)
    });
    let pixels: Vec<[u16; 3]> = pixels.collect();
    let plane = |k: usize| pixels.iter().map(move |pixel| pixel[k]);
    plane(0).chain(plane(1)).chain(plane(2)).collect()
}

/// Converts an opacity from 8 to 10 bits, such that 255 becomes 1023.
fn ten_bit_opacity(opacity: u8) -> u16 {
    ((u32::from(opacity) * 1023 + 127) / 255) as u16
}

/// Gives each pixel without opacity the mean colour of the smallest block around it that contains a
/// visible pixel, where blocks have a power of two of pixels along each side.
fn colour_transparent_pixels(image: &mut RgbaImage) {
    let (width, height) = image.dimensions();
    let is_done = image.pixels().all(|pixel| pixel.0[3] > 0);
    if is_done || (width <= 1 && height <= 1) {
        return;
    }
    let mut halved = halved(image);
    colour_transparent_pixels(&mut halved);
    for (x, y, pixel) in image.enumerate_pixels_mut() {
        if pixel.0[3] == 0 {
            let [r, g, b, _] = halved.get_pixel(x / 2, y / 2).0;
            pixel.0 = [r, g, b, 0];
        }
    }
}

/// Returns an image in which each pixel is the mean of 2 × 2 pixels, weighted by their opacity. Its
/// opacity is 0 only if all of them are transparent.
fn halved(image: &RgbaImage) -> RgbaImage {
    let (width, height) = image.dimensions();
    let mean = |x: u32, y: u32| {
        let mut sum = [0u32; 4];
        for (x, y) in [
            (2 * x, 2 * y),
            (2 * x + 1, 2 * y),
            (2 * x, 2 * y + 1),
            (2 * x + 1, 2 * y + 1),
        ] {
            if let Some(pixel) = image.get_pixel_checked(x, y) {
                let [r, g, b, a] = pixel.0.map(u32::from);
                let weighted = [r * a, g * a, b * a, a];
                (0..4).for_each(|k| sum[k] += weighted[k]);
            }
        }
        let [r, g, b, a] = sum;
        let colour = [r, g, b].map(|channel| (channel / a.max(1)) as u8);
        image::Rgba([colour[0], colour[1], colour[2], a.div_ceil(4) as u8])
    };
    RgbaImage::from_fn(width.div_ceil(2), height.div_ceil(2), mean)
}

#[cfg(test)]
mod tests {
    use super::*;
    use image::Rgba;

    #[test]
    fn transparent_pixels_take_the_colour_of_visible_ones() {
        let mut image = RgbaImage::new(9, 5);
        image.put_pixel(7, 4, Rgba([200, 100, 50, 255]));
        image.put_pixel(8, 4, Rgba([10, 20, 30, 7]));
        colour_transparent_pixels(&mut image);
        assert_eq!(image.get_pixel(7, 4).0, [200, 100, 50, 255]);
        assert_eq!(image.get_pixel(8, 4).0, [10, 20, 30, 7]);
        assert_eq!(image.get_pixel(6, 4).0, [200, 100, 50, 0]);
        let [r, g, b, a] = image.get_pixel(0, 0).0;
        assert!(r > 190 && g > 90 && b > 40 && a == 0, "{r} {g} {b} {a}");
        let mut empty = RgbaImage::new(3, 3);
        colour_transparent_pixels(&mut empty);
        assert!(empty.pixels().all(|pixel| pixel.0 == [0; 4]));
    }

    #[test]
    fn planes_have_the_size_and_the_ends_of_their_ranges() {
        let white = RgbaImage::from_pixel(4, 2, Rgba([255; 4]));
        let words = |bytes: Vec<u8>| -> Vec<u16> {
            let pairs = bytes.chunks_exact(2);
            pairs.map(|b| u16::from_le_bytes([b[0], b[1]])).collect()
        };
        let planes = words(PixelFormat::Yuva444TenBit.planes(white.clone()));
        assert_eq!(planes[..8], [940; 8]);
        assert_eq!(planes[8..24], [512; 16]);
        assert_eq!(planes[24..], [1023; 8]);
        let red = RgbaImage::from_pixel(4, 2, Rgba([255, 0, 0, 255]));
        let planes = words(PixelFormat::Yuv444TenBit.planes(red));
        assert_eq!([planes[0], planes[8], planes[16]], [250, 409, 960]);
        assert_eq!(planes.len(), 24);
        let planes = PixelFormat::Yuva420.planes(white.clone());
        assert_eq!(planes[..8], [235; 8]);
        assert_eq!(planes[8..12], [128; 4]);
        assert_eq!(planes[12..], [255; 8]);
        assert_eq!(PixelFormat::Yuv420.planes(white).len(), 12);
    }
}

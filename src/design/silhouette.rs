//! Importer of pictures: decodes them and traces the outline of the silhouette.
//!
//! In a picture with a transparent border, opacity separates the figure from the background.
//! Otherwise grey levels, or distances from the colour of the background, are separated by Otsu's
//! threshold (Otsu 1979, "A threshold selection method from gray-level histograms"), and the class
//! (lighter or darker) of most border pixels is the background. The submodule [`reading`] chooses.
//! The boundary runs where the opacity or grey level, interpolated between pixel centres, crosses
//! the threshold, so anti-aliased edges give sub-pixel accuracy.
//!
//! A pixel is one unit, the origin is the picture's lower left corner and y points up. A figure
//! that reaches the border of the picture is closed along this border. One threshold applies to the
//! whole picture; the submodule `flat_colours` can separate several colours.

pub(super) mod flat_colours;
mod polygon_fit;
mod reading;

pub(super) use reading::choose_tones;
pub use reading::{SilhouetteCandidate, silhouette_candidates};

use self::polygon_fit::TracedPoint;
use super::options::{ImportOptions, ImportOptionsError};
use crate::field::{SampledField, SampledFieldError, contour};
use crate::geometry::{DVec2, FillRule, Regions, RegionsError};
use crate::mesh::components;
use image::{DynamicImage, ImageDecoder, ImageError, ImageFormat, ImageReader, Limits, RgbaImage};
use rayon::prelude::*;
use std::io::Cursor;

/// Error of decoding a picture or tracing its silhouette.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SilhouetteError {
    /// The header declares more pixels than are supported.
    #[error(
        "the picture has {width} × {height} pixels, but at most {} million are supported; save a smaller one",
        MAX_PIXELS / 1_000_000
    )]
    TooManyPixels {
        /// Width in pixels.
        width: u32,
        /// Height in pixels.
        height: u32,
    },
    /// The picture has no pixels.
    #[error("the picture has no pixels; export it again")]
    NoPixels,
    /// The file ends before the picture is complete.
    #[error("the picture file is incomplete; copy or export it again")]
    Truncated,
    /// The decoder reports an error.
    #[error("the picture is damaged ({0}); export it again")]
    Damaged(#[source] ImageError),
    /// All pixels have the same grey level, so no threshold separates them.
    #[error("the picture has a single grey level; use one with a figure in front of a background")]
    OneTone,
    /// The figure has no pixels, or only islands that are smaller than the speck size.
    #[error(
        "the silhouette is empty at threshold {threshold}; change the threshold, lower the speck size or invert the picture"
    )]
    Empty {
        /// Opacity or grey level that separates figure and background.
        threshold: u8,
    },
    /// The boundary has too many points before simplification.
    #[error(
        "the silhouette has more than {MAX_POINTS} boundary points; raise the speck size, change the threshold or use a smaller picture"
    )]
    TooRagged,
    /// An option is out of range.
    #[error(transparent)]
    Options(#[from] ImportOptionsError),
    /// The number of samples is 0 or differs from the number of pixels.
    #[error(transparent)]
    Samples(#[from] SampledFieldError),
    /// The boundary does not form valid regions.
    #[error(transparent)]
    Regions(#[from] RegionsError),
}

/// Maximum number of pixels of a picture (resource limit: removing specks needs up to 20 bytes per
/// pixel, 1 GB in total; separating flat colours needs half as much again).
pub(in crate::design) const MAX_PIXELS: u64 = 8192 * 6144;

/// Maximum number of boundary points before simplification (resource limit: a 2048 × 2048
/// photograph of gravel has about this many).
const MAX_POINTS: usize = 2_000_000;

/// A pixel counts as saturated, that is, as entirely figure or entirely background, if its sample
/// exceeds this fraction of the most extreme sample on the same side of the threshold (tolerance:
/// JPEG noise).
const SATURATED: f32 = 0.9;

/// Uncertainty, in pixels, of a boundary point between a pixel that is entirely figure and one that
/// is entirely background (derived: the true boundary may run anywhere between the two pixel
/// centres).
const SATURATED_SLACK: f64 = 0.5;

/// Length of the longer side, in pixels, below which a picture counts as pixel art and keeps
/// its stair steps (heuristic).
const PIXEL_ART_SIDE: u32 = 64;

/// Uncertainty of a boundary point next to an anti-aliased pixel, in pixels (tolerance: the error
/// of a traced straight edge if the value of each pixel is exactly the fraction of its area that
/// the figure covers).
const ANTIALIASED_SLACK: f64 = 0.05;

/// Opacity or grey level of each pixel, one byte per pixel, with the threshold that separates
/// figure and background. With this type, the colours of the picture can be freed before tracing.
pub(super) struct PictureTones {
    width: u32,
    height: u32,
    /// Opacity or grey level of each pixel, lowest row first.
    bytes: Vec<u8>,
    threshold: u8,
    above_is_figure: bool,
}

impl PictureTones {
    /// Traces the silhouette, in pixels from the picture's lower left corner.
    pub(super) fn regions(self, options: &ImportOptions) -> Result<Regions, SilhouetteError> {
        let tolerance = options.tolerance * f64::from(self.width.max(self.height));
        let mut figure = self.figure();
        figure.remove_specks(options.specks_px);
        figure.trace(tolerance)
    }

    /// Converts the opacities or grey levels to signed samples.
    fn figure(self) -> FigureSamples {
        let sign = if self.above_is_figure { 1.0 } else { -1.0 };
        // Half a level below the threshold, so that no sample is zero.
        let level = f32::from(self.threshold) - 0.5;
        let sample = |&tone: &u8| sign * (f32::from(tone) - level);
        FigureSamples {
            width: self.width,
            height: self.height,
            samples: self.bytes.iter().map(sample).collect(),
            threshold: self.threshold,
        }
    }
}

/// Returns whether an end-of-image marker (0xd9) follows the last start-of-scan marker (0xda) of a
/// JPEG. Scan data contains neither marker, because 0xff is escaped there.
fn is_jpeg_complete(bytes: &[u8]) -> bool {
    let last_marker = |marker: u8| bytes.windows(2).rposition(|pair| pair == [0xff, marker]);
    last_marker(0xd9) > last_marker(0xda)
}

/// Decodes a picture and applies the orientation in its metadata.
///
/// # Errors
/// [`SilhouetteError`] if the picture is empty, too large, incomplete or damaged.
pub(super) fn decode(bytes: &[u8], format: ImageFormat) -> Result<RgbaImage, SilhouetteError> {
    if format == ImageFormat::Jpeg && !is_jpeg_complete(bytes) {
        // The decoder would silently fill the missing rows with grey.
        return Err(SilhouetteError::Truncated);
    }
    // The PNG decoder reports the size only after it has found pixel data, so the size is read from
    // the header first.
    if let Some((width, height)) = png_header_size(bytes, format) {
        check_size(width, height)?;
    }
    let mut limits = Limits::default();
    limits.max_alloc = Some(MAX_PIXELS * 8); // four channels of 16 bits
    let mut reader = ImageReader::with_format(Cursor::new(bytes), format);
    reader.limits(limits);
    let mut decoder = reader.into_decoder().map_err(classify_decode_error)?;
    let (width, height) = decoder.dimensions();
    check_size(width, height)?;
    let orientation = decoder.orientation().map_err(classify_decode_error)?;
    let mut picture = DynamicImage::from_decoder(decoder).map_err(classify_decode_error)?;
    picture.apply_orientation(orientation);
    Ok(picture.into_rgba8())
}

/// Returns width and height from the header of a PNG, which is at a fixed position; `None` for
/// other formats.
fn png_header_size(bytes: &[u8], format: ImageFormat) -> Option<(u32, u32)> {
    let number = |at: usize| Some(u32::from_be_bytes(bytes.get(at..at + 4)?.try_into().ok()?));
    (format == ImageFormat::Png && bytes.get(12..16) == Some(b"IHDR"))
        .then(|| Some((number(16)?, number(20)?)))
        .flatten()
}

/// Checks that a picture is neither empty nor too large.
fn check_size(width: u32, height: u32) -> Result<(), SilhouetteError> {
    match u64::from(width) * u64::from(height) {
        0 => Err(SilhouetteError::NoPixels),
        1..=MAX_PIXELS => Ok(()),
        _ => Err(SilhouetteError::TooManyPixels { width, height }),
    }
}

/// Converts a decoder error to the error for an incomplete or a damaged file.
fn classify_decode_error(error: ImageError) -> SilhouetteError {
    match &error {
        ImageError::IoError(e) if e.kind() == std::io::ErrorKind::UnexpectedEof => {
            SilhouetteError::Truncated
        }
        _ => SilhouetteError::Damaged(error),
    }
}

/// Signed samples at the pixel centres, lowest row first: positive in the figure, negative in the
/// background, never zero. The magnitude says how clearly a pixel belongs to figure or background:
/// the distance of its opacity or grey level from the threshold, or |b − a| / (a + b) in a picture
/// of flat colours. There, a is the distance of the pixel's colour from the traced flat colour, and
/// b its distance from the closest other flat colour.
struct FigureSamples {
    width: u32,
    height: u32,
    samples: Vec<f32>,
    threshold: u8,
}

impl FigureSamples {
    /// Removes islands with fewer than `min_pixels` pixels, then fills holes with fewer than
    /// `min_pixels` pixels. Background that reaches the border of the picture is not a hole.
    fn remove_specks(&mut self, min_pixels: u32) {
        if min_pixels > 1 {
            self.remove_specks_of(1.0, min_pixels);
            self.remove_specks_of(-1.0, min_pixels);
        }
    }

    /// Flips the sign of the samples in all 4-connected components that have the given sign and
    /// fewer than `min_pixels` pixels. Magnitudes stay the same.
    fn remove_specks_of(&mut self, sign: f32, min_pixels: u32) {
        let (count, width) = (self.samples.len(), self.width as usize);
        let across = (1..count).filter(|i| !i.is_multiple_of(width));
        let across = across.map(|i| [i - 1, i]);
        let upwards = (width..count).map(|i| [i - width, i]);
        let has_same_sign = |&[a, b]: &[usize; 2]| self.samples[a] * self.samples[b] > 0.0;
        let links = across.chain(upwards).filter(has_same_sign);
        // The cast cannot overflow: MAX_PIXELS is far below 2^32.
        let pieces = components(count, links.map(|ends| ends.map(|i| i as u32)));
        let mut sizes = vec![0u32; count]; // at most one component per pixel
        for (i, &piece) in pieces.iter().enumerate() {
            // Background that reaches the border counts as infinitely large.
            let is_open = sign < 0.0 && is_on_border(i, width, count);
            let size = &mut sizes[piece as usize];
            *size = size.saturating_add(if is_open { u32::MAX } else { 1 });
        }
        for (sample, piece) in self.samples.iter_mut().zip(pieces) {
            if *sample * sign > 0.0 && sizes[piece as usize] < min_pixels {
                *sample = -*sample;
            }
        }
    }

    /// Traces the zero contour of the samples and simplifies it. The result deviates from the exact
    /// boundary by about `tolerance` pixels on average, and by more where the pixels do not
    /// determine the boundary that accurately.
    fn trace(&self, tolerance: f64) -> Result<Regions, SilhouetteError> {
        let threshold = self.threshold;
        // `tolerance` is a mean deviation, `flatness` a maximum deviation, in pixels.
        let flatness = (2.0 * tolerance).max(ANTIALIASED_SLACK);
        // The number of points is checked before tracing, which allocates the rings.
        self.check_raggedness()?;
        let samples = SampledField::new(self.width, self.height, &self.samples)?;
        // Points of the contour have the centre of the lower left pixel as origin, points of the
        // outline the lower left corner of this pixel.
        let corner_from_centre = DVec2::splat(0.5);
        let uncertainty = BoundarySlack::of(self);
        let outline = |ring: &Vec<DVec2>| {
            let traced = |&p: &DVec2| TracedPoint {
                point: p + corner_from_centre,
                slack: uncertainty.slack(p).max(flatness),
            };
            let boundary: Vec<TracedPoint> = ring.iter().map(traced).collect();
            polygon_fit::fit_outline(&polygon_fit::densify(&boundary), flatness)
        };
        let traced = contour::trace_samples(&samples, 0.0);
        let rings: Vec<Vec<DVec2>> = traced.par_iter().map(outline).collect();
        if rings.is_empty() {
            return Err(SilhouetteError::Empty { threshold });
        }
        // The even-odd rule fits, because rings do not cross, and outer rings and holes alternate
        // with increasing nesting depth.
        Regions::from_rings(&rings, FillRule::EvenOdd).map_err(|error| match error {
            RegionsError::Empty => SilhouetteError::Empty { threshold },
            error => error.into(),
        })
    }

    /// Returns an error if the boundary has too many points. The number of points equals the number
    /// of sign changes along rows and columns.
    fn check_raggedness(&self) -> Result<(), SilhouetteError> {
        let width = self.width as usize;
        let changes = |pair: (&f32, &f32)| (pair.0 * pair.1) < 0.0;
        let across: usize = self
            .samples
            .chunks(width)
            .map(|row| row.iter().zip(&row[1..]).filter(|&p| changes(p)).count())
            .sum();
        let upwards = self.samples.iter().zip(&self.samples[width..]);
        if across + upwards.filter(|&p| changes(p)).count() > MAX_POINTS {
            return Err(SilhouetteError::TooRagged);
        }
        Ok(())
    }
}

/// Estimates the uncertainty of boundary points from the pixels around them.
struct BoundarySlack<'a> {
    figure: &'a FigureSamples,
    /// For the figure and for the background: the magnitude above which a sample is saturated, that
    /// is, its pixel counts as entirely figure or entirely background.
    saturated: [f32; 2],
}

impl<'a> BoundarySlack<'a> {
    fn of(figure: &'a FigureSamples) -> Self {
        let extreme = |sign: f32| {
            figure
                .samples
                .iter()
                .fold(0.0, |m, s| f32::max(m, sign * s))
        };
        Self {
            figure,
            saturated: [1.0, -1.0].map(|sign| SATURATED * extreme(sign)),
        }
    }

    /// Returns the maximum distance, in pixels, between the true boundary and the traced point `p`.
    /// The point lies between two neighbouring samples, and the origin of its coordinates is the
    /// lower left sample.
    fn slack(&self, p: DVec2) -> f64 {
        let sample = |p: DVec2| {
            let (width, height) = (f64::from(self.figure.width), f64::from(self.figure.height));
            let is_inside = p.x >= 0.0 && p.y >= 0.0 && p.x < width && p.y < height;
            is_inside.then(|| self.figure.samples[(p.y * width + p.x) as usize])
        };
        let is_saturated = |sample: Option<f32>| match sample {
            Some(sample) => sample > self.saturated[0] || sample < -self.saturated[1],
            // Along the border of the picture the boundary is exact.
            None => false,
        };
        let is_pixel_art = self.figure.width.max(self.figure.height) < PIXEL_ART_SIDE;
        if !is_pixel_art && is_saturated(sample(p.floor())) && is_saturated(sample(p.ceil())) {
            SATURATED_SLACK
        } else {
            ANTIALIASED_SLACK
        }
    }
}

/// Returns the Rec. 709 luma, 0 to 255. It uses the gamma-coded channels, in which equal steps look
/// about equal.
fn luminance([r, g, b, _]: [u8; 4]) -> u8 {
    let luma = 0.2126 * f32::from(r) + 0.7152 * f32::from(g) + 0.0722 * f32::from(b);
    luma.round() as u8
}

/// Returns the threshold between the two classes of levels that have the largest variance between
/// them (Otsu 1979): the mean of the means of the two classes. Returns `None` if all levels are
/// equal.
///
/// At the optimum each level is nearer to the mean of its own class, so the threshold separates the
/// classes. The figure covers half of a pixel with this level, if the two classes are plain, so the
/// boundary of an antialiased figure is traced where it lies.
fn otsu(tones: &[u8]) -> Option<u8> {
    let mut histogram = [0u64; 256];
    for &tone in tones {
        histogram[usize::from(tone)] += 1;
    }
    let total = tones.len() as f64;
    let weighted = |(tone, &n): (usize, &u64)| tone as f64 * n as f64;
    let sum: f64 = histogram.iter().enumerate().map(weighted).sum();
    let (mut below, mut sum_below) = (0.0, 0.0);
    let mut best = (0.0, 0.0); // variance and threshold
    for threshold in 1..256 {
        below += histogram[threshold - 1] as f64;
        sum_below += weighted((threshold - 1, &histogram[threshold - 1]));
        let above = total - below;
        if below == 0.0 || above == 0.0 {
            continue;
        }
        let means = [sum_below / below, (sum - sum_below) / above];
        // The variance between the two classes, up to a constant factor.
        let variance = below * above * (means[1] - means[0]).powi(2);
        if variance > best.0 {
            best = (variance, 0.5 * (means[0] + means[1]));
        }
    }
    // A level belongs to the upper class from the threshold on.
    (best.0 > 0.0).then(|| best.1.ceil() as u8)
}

/// Returns whether at least half of the border pixels are at or above the threshold, so that the
/// lighter class is the background. The lighter class wins a tie, because paper is lighter than
/// ink.
fn border_is_above(tones: &[u8], width: usize, threshold: u8) -> bool {
    let border = (tones.iter().enumerate()).filter(|(i, _)| is_on_border(*i, width, tones.len()));
    let (mut above, mut all) = (0usize, 0usize);
    for (_, &tone) in border {
        all += 1;
        above += usize::from(tone >= threshold);
    }
    2 * above >= all
}

/// Returns whether a pixel, given by its index, lies on the border of a picture with `count`
/// pixels.
fn is_on_border(pixel: usize, width: usize, count: usize) -> bool {
    let column = pixel % width;
    pixel < width || pixel >= count - width || column == 0 || column + 1 == width
}

#[cfg(test)]
mod tests;

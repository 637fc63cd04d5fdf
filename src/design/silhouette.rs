//! Silhouettes out of pictures.
//!
//! Where a picture has pixels that are not opaque, opacity tells figure from
//! ground. Otherwise tones are parted by Otsu's threshold (Otsu 1979, "A
//! threshold selection method from gray-level histograms") and the side that
//! most of the border belongs to is the ground. The boundary runs where the
//! tone crosses the threshold between pixel centres, not along the pixels'
//! edges, so that anti-aliasing gives sub-pixel accuracy.
//!
//! A pixel is one unit; the picture's lower left corner is the origin and y
//! points up. A figure that reaches the border is closed along it.
//!
//! Not guaranteed: colours of equal luminance are not told apart, and the
//! threshold is one for the whole picture; but where a picture is of flat
//! colours, `flat` can take each for itself.

pub(super) mod flat_colours;
mod polygon_fit;

use self::polygon_fit::TracedPoint;
use super::options::{ImportOptions, ImportOptionsError};
use crate::field::{SampledField, SampledFieldError, contour};
use crate::geometry::{DVec2, FillRule, Regions, RegionsError};
use crate::mesh::components;
use image::{DynamicImage, ImageDecoder, ImageError, ImageFormat, ImageReader, Limits, RgbaImage};
use rayon::prelude::*;
use std::io::Cursor;

/// Why a picture gives no silhouette.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SilhouetteError {
    /// The file says that it is larger than is read.
    #[error(
        "the picture claims {width} × {height} pixels, more than the {} million that are read; save a smaller one",
        MAX_PIXELS / 1_000_000
    )]
    TooManyPixels {
        /// Pixels across.
        width: u32,
        /// Pixels down.
        height: u32,
    },
    /// A side of the picture is 0.
    #[error("the picture has no pixels; save it again from where it was made")]
    NoPixels,
    /// The file ends before the picture does.
    #[error("the picture is cut off before its end; copy or save the file again")]
    Truncated,
    /// The decoder gives up.
    #[error("the picture is damaged ({0}); save it again from where it was made")]
    Damaged(#[source] ImageError),
    /// All pixels are alike.
    #[error(
        "the picture has one tone only, so no figure stands out; use one with a figure on a ground"
    )]
    OneTone,
    /// No pixel belongs to the figure.
    #[error(
        "nothing is left of the picture at threshold {threshold}; change the threshold, keep smaller specks, or invert it"
    )]
    Empty {
        /// Opacity or tone at which figure and ground were parted.
        threshold: u8,
    },
    /// A boundary of absurdly many points.
    #[error(
        "the silhouette has more than {MAX_POINTS} boundary points; leave specks out, change the threshold, or use a smaller picture"
    )]
    TooRagged,
    /// An option is out of range.
    #[error(transparent)]
    Options(#[from] ImportOptionsError),
    /// The samples do not fill the picture.
    #[error(transparent)]
    Samples(#[from] SampledFieldError),
    /// Nothing could be made of the boundary.
    #[error(transparent)]
    Regions(#[from] RegionsError),
}

/// Most pixels that are read: 8192 × 6144, more than all but the largest
/// cameras have. At up to 20 bytes a pixel, while specks are looked for in the
/// silhouette, this is 1 GB; by flat colours it is half as much again.
const MAX_PIXELS: u64 = 8192 * 6144;

/// Most boundary points before simplification; a photograph of gravel, parted
/// at its median, has about this many at 2048 × 2048.
const MAX_POINTS: usize = 2_000_000;

/// What counts as full ink or bare ground, as a share of the most there is: less
/// than all, since JPEG leaves noise.
const FULL: f32 = 0.9;

/// How far a boundary may run from where it crosses, in pixels: between full ink
/// and bare ground wherever no other pixel's middle is reached.
const STAIR: f64 = 0.5;

/// A picture of fewer pixels along its longer side was drawn pixel by pixel, and
/// keeps its stairs.
const SMALL: u32 = 64;

/// How far next to a grey pixel: as well as a straight edge is found in exact
/// coverage.
const GREY: f64 = 0.05;

/// What tells a picture's figure from its ground: a byte a pixel, lowest row
/// first, so that the colours need not be kept while the boundary is found.
pub(super) struct PictureTones {
    width: u32,
    height: u32,
    bytes: Vec<u8>,
    threshold: u8,
    above_is_figure: bool,
}

impl PictureTones {
    pub(super) fn of(
        picture: &RgbaImage,
        options: &ImportOptions,
    ) -> Result<Self, SilhouetteError> {
        let (width, height) = picture.dimensions();
        let by_opacity = picture.pixels().any(|p| p.0[3] != u8::MAX);
        // Rows from below, as y points up.
        let bytes: Vec<u8> = picture
            .rows()
            .rev()
            .flatten()
            .map(|p| if by_opacity { p.0[3] } else { luminance(p.0) })
            .collect();
        let threshold = match options.threshold {
            Some(threshold) => threshold,
            None if by_opacity => 128,
            None => otsu(&bytes).ok_or(SilhouetteError::OneTone)?,
        };
        let above = by_opacity || !border_is_above(&bytes, width as usize, threshold);
        Ok(Self {
            width,
            height,
            bytes,
            threshold,
            above_is_figure: above != options.invert,
        })
    }

    /// The silhouette that the picture shows, in pixels from its lower left
    /// corner.
    pub(super) fn regions(self, options: &ImportOptions) -> Result<Regions, SilhouetteError> {
        let tolerance = options.tolerance * f64::from(self.width.max(self.height));
        let mut figure = self.figure();
        figure.remove_specks(options.specks_px);
        figure.trace(tolerance)
    }

    fn figure(self) -> FigureSamples {
        let sign = if self.above_is_figure { 1.0 } else { -1.0 };
        let level = f32::from(self.threshold) - 0.5; // no tone is on it
        let sample = |&tone: &u8| sign * (f32::from(tone) - level);
        FigureSamples {
            width: self.width,
            height: self.height,
            samples: self.bytes.iter().map(sample).collect(),
            threshold: self.threshold,
        }
    }
}

/// Whether the last scan of a JPEG is followed by an end marker. Inside a scan
/// neither marker can occur, for there 0xff is escaped.
fn jpeg_ends(bytes: &[u8]) -> bool {
    let last = |marker: u8| bytes.windows(2).rposition(|pair| pair == [0xff, marker]);
    last(0xd9) > last(0xda)
}

/// The pixels of a picture of a known format, turned as it says.
pub(super) fn decode(bytes: &[u8], format: ImageFormat) -> Result<RgbaImage, SilhouetteError> {
    if format == ImageFormat::Jpeg && !jpeg_ends(bytes) {
        return Err(SilhouetteError::Truncated); // the decoder would fill up with grey
    }
    if let Some(size) = claimed_by_png(bytes, format) {
        check_size(size)?; // the decoder looks for pixels first
    }
    let mut limits = Limits::default();
    limits.max_alloc = Some(MAX_PIXELS * 8); // 16 bits in each of four channels
    let mut reader = ImageReader::with_format(Cursor::new(bytes), format);
    reader.limits(limits);
    let mut decoder = reader.into_decoder().map_err(damaged)?;
    check_size(decoder.dimensions())?;
    let orientation = decoder.orientation().map_err(damaged)?;
    let mut picture = DynamicImage::from_decoder(decoder).map_err(damaged)?;
    picture.apply_orientation(orientation);
    Ok(picture.into_rgba8())
}

/// Width and height from the header of a PNG, which is always in one place.
fn claimed_by_png(bytes: &[u8], format: ImageFormat) -> Option<(u32, u32)> {
    let number = |at: usize| Some(u32::from_be_bytes(bytes.get(at..at + 4)?.try_into().ok()?));
    (format == ImageFormat::Png && bytes.get(12..16) == Some(b"IHDR"))
        .then(|| Some((number(16)?, number(20)?)))
        .flatten()
}

fn check_size((width, height): (u32, u32)) -> Result<(), SilhouetteError> {
    match u64::from(width) * u64::from(height) {
        0 => Err(SilhouetteError::NoPixels),
        1..=MAX_PIXELS => Ok(()),
        _ => Err(SilhouetteError::TooManyPixels { width, height }),
    }
}

fn damaged(error: ImageError) -> SilhouetteError {
    match &error {
        ImageError::IoError(e) if e.kind() == std::io::ErrorKind::UnexpectedEof => {
            SilhouetteError::Truncated
        }
        _ => SilhouetteError::Damaged(error),
    }
}

/// Samples at the pixel centres, lowest row first: positive in the figure,
/// negative on the ground, never zero.
struct FigureSamples {
    width: u32,
    height: u32,
    samples: Vec<f32>,
    threshold: u8,
}

impl FigureSamples {
    /// Islands of fewer pixels than `least` go over to the ground, then holes
    /// to the figure. Ground that reaches the border is no hole.
    fn remove_specks(&mut self, least: u32) {
        if least > 1 {
            self.remove_specks_of(1.0, least);
            self.remove_specks_of(-1.0, least);
        }
    }

    /// Pixels hang together along their sides. A removed pixel's sample
    /// changes sign and keeps its size.
    fn remove_specks_of(&mut self, sign: f32, least: u32) {
        let (count, width) = (self.samples.len(), self.width as usize);
        let across = (1..count).filter(|i| !i.is_multiple_of(width));
        let across = across.map(|i| [i - 1, i]);
        let upwards = (width..count).map(|i| [i - width, i]);
        let alike = |&[a, b]: &[usize; 2]| self.samples[a] * self.samples[b] > 0.0;
        let links = across.chain(upwards).filter(alike);
        // The number of a pixel fits: 2^32 of them would take 16 GiB before this.
        let pieces = components(count, links.map(|ends| ends.map(|i| i as u32)));
        let mut sizes = vec![0u32; count]; // there are no more pieces than pixels
        for (i, &piece) in pieces.iter().enumerate() {
            // A hole that reaches the border is as large as can be.
            let is_open = sign < 0.0 && is_on_border(i, width, count);
            let size = &mut sizes[piece as usize];
            *size = size.saturating_add(if is_open { u32::MAX } else { 1 });
        }
        for (sample, piece) in self.samples.iter_mut().zip(pieces) {
            if *sample * sign > 0.0 && sizes[piece as usize] < least {
                *sample = -*sample;
            }
        }
    }

    /// The boundary at level zero, to within `tolerance` pixels in the mean, or
    /// within what the pixels leave open where that is more.
    fn trace(&self, tolerance: f64) -> Result<Regions, SilhouetteError> {
        let threshold = self.threshold;
        // Chords of a curve are off by two thirds of this, in the mean.
        let flatness = (2.0 * tolerance).max(GREY);
        // Before tracing, whose rings would take the room.
        self.check_raggedness()?;
        let samples = SampledField::new(self.width, self.height, &self.samples)?;
        // Samples lie at the middles of pixels, the origin at a corner.
        let corner_from_centre = DVec2::splat(0.5);
        let known = BoundarySlack::of(self);
        let outline = |ring: &Vec<DVec2>| {
            let traced = |&p: &DVec2| TracedPoint {
                point: p + corner_from_centre,
                slack: known.slack(p).max(flatness),
            };
            let boundary: Vec<TracedPoint> = ring.iter().map(traced).collect();
            polygon_fit::fit_outline(&polygon_fit::resampled(&boundary), flatness)
        };
        let traced = contour::trace_samples(&samples, 0.0);
        let rings: Vec<Vec<DVec2>> = traced.par_iter().map(outline).collect();
        if rings.is_empty() {
            return Err(SilhouetteError::Empty { threshold });
        }
        // Rings do not cross, and each lies within those of the other kind.
        Regions::from_rings(&rings, FillRule::EvenOdd).map_err(|error| match error {
            RegionsError::Empty => SilhouetteError::Empty { threshold },
            error => error.into(),
        })
    }

    /// Counts sign changes along rows and columns: as many as boundary points.
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

/// How well a picture knows where its boundary runs.
struct BoundarySlack<'a> {
    figure: &'a FigureSamples,
    /// What a sample of full ink and of bare ground has at least.
    full: [f32; 2],
}

impl<'a> BoundarySlack<'a> {
    fn of(figure: &'a FigureSamples) -> Self {
        let most = |sign: f32| {
            figure
                .samples
                .iter()
                .fold(0.0, |m, s| f32::max(m, sign * s))
        };
        Self {
            figure,
            full: [1.0, -1.0].map(|sign| FULL * most(sign)),
        }
    }

    /// How far from a point at which it crosses from one sample to the next, in
    /// pixels from the first sample, the boundary may run.
    fn slack(&self, p: DVec2) -> f64 {
        let sample = |p: DVec2| {
            let (width, height) = (f64::from(self.figure.width), f64::from(self.figure.height));
            let is_there = p.x >= 0.0 && p.y >= 0.0 && p.x < width && p.y < height;
            is_there.then(|| self.figure.samples[(p.y * width + p.x) as usize])
        };
        let is_full = |sample: Option<f32>| match sample {
            Some(sample) => sample > self.full[0] || sample < -self.full[1],
            // At the picture's border it is closed.
            None => false,
        };
        let is_small = self.figure.width.max(self.figure.height) < SMALL;
        if !is_small && is_full(sample(p.floor())) && is_full(sample(p.ceil())) {
            STAIR
        } else {
            GREY
        }
    }
}

/// Luma of Rec. 709 on the coded values, which are what looks evenly spaced.
fn luminance([r, g, b, _]: [u8; 4]) -> u8 {
    let luma = 0.2126 * f32::from(r) + 0.7152 * f32::from(g) + 0.0722 * f32::from(b);
    luma.round() as u8
}

/// The threshold that parts the tones with the largest variance between the
/// two classes: tones below it are one class. Where a whole run of thresholds
/// is as good, its middle, so that a black and white picture is parted at
/// half. `None` for a single tone.
fn otsu(tones: &[u8]) -> Option<u8> {
    let mut histogram = [0u64; 256];
    for &tone in tones {
        histogram[usize::from(tone)] += 1;
    }
    let total = tones.len() as f64;
    let weighted = |(tone, &n): (usize, &u64)| tone as f64 * n as f64;
    let sum: f64 = histogram.iter().enumerate().map(weighted).sum();
    let (mut below, mut sum_below) = (0.0, 0.0);
    let mut best = (0.0, 0, 0); // variance, first and last threshold that have it
    for threshold in 1..256 {
        below += histogram[threshold - 1] as f64;
        sum_below += weighted((threshold - 1, &histogram[threshold - 1]));
        // The variance between the classes, but for a factor that is the same for
        // all thresholds.
        let apart = sum_below * total - sum * below;
        let classes = below * (total - below);
        let variance = if classes > 0.0 {
            apart * apart / classes
        } else {
            0.0
        };
        if variance > best.0 {
            best = (variance, threshold, threshold);
        // The run goes on only where it has no gap.
        } else if variance == best.0 && best.0 > 0.0 && best.2 + 1 == threshold {
            best.2 = threshold;
        }
    }
    (best.0 > 0.0).then(|| (best.1 + best.2).div_ceil(2) as u8)
}

/// Whether most of the border is at or above the threshold. On a tie it is:
/// paper is lighter than ink.
fn border_is_above(tones: &[u8], width: usize, threshold: u8) -> bool {
    let border = (tones.iter().enumerate()).filter(|(i, _)| is_on_border(*i, width, tones.len()));
    let (mut above, mut all) = (0usize, 0usize);
    for (_, &tone) in border {
        all += 1;
        above += usize::from(tone >= threshold);
    }
    2 * above >= all
}

/// Whether a pixel of so many lies on the border of a picture of a width.
fn is_on_border(pixel: usize, width: usize, count: usize) -> bool {
    let column = pixel % width;
    pixel < width || pixel >= count - width || column == 0 || column + 1 == width
}

#[cfg(test)]
mod tests;

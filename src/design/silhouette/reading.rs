//! Ways to read a silhouette from a picture: by the opacity, the brightness or the colour of its
//! pixels.
//!
//! Opacity separates figure and background if both opaque and transparent pixels exist and most of
//! the picture's border is transparent. A picture that is transparent only in its corners, as a
//! rounded icon, is read by brightness, provided that its opaque pixels differ in brightness or
//! colour. Brightness separates if the mean grey levels of the two classes differ by more than
//! [`SAME_COLOUR`]; otherwise pixels are separated by the distance of their colour from that of the
//! background, if that differs more.

use super::flat_colours::SAME_COLOUR;
use super::{PictureTones, SilhouetteError, border_is_above, is_on_border, luminance, otsu};
use crate::design::options::{ImportOptions, PictureReading};
use crate::geometry::Regions;
use image::{Rgba, RgbaImage};
use std::collections::BTreeMap;

/// Opacity from which a pixel counts as opaque, if the user gives no threshold.
const OPAQUE: u8 = 128;

/// A silhouette that can be read from a picture.
#[derive(Clone, Debug, PartialEq)]
pub struct SilhouetteCandidate {
    /// Property of the pixels that separates figure and background.
    pub reading: PictureReading,
    /// The silhouette, in pixels from the picture's lower left corner.
    pub regions: Regions,
}

/// The tones from which the silhouette is traced.
pub(in crate::design) struct ChosenTones {
    pub(in crate::design) tones: PictureTones,
    /// Reading that was chosen, and the other one that is possible too; `None` if the choice is
    /// clear or the user has made it.
    pub(in crate::design) alternatives: Option<[PictureReading; 2]>,
}

/// Tones of a reading, with the mean difference between figure and background.
struct Reading {
    kind: PictureReading,
    tones: PictureTones,
    contrast: f64,
}

/// Returns the silhouettes that can be read from a picture, the one that an import with these
/// options uses first. Others follow if they separate the pixels clearly and differently.
///
/// # Errors
/// [`SilhouetteError`] as for the import of the picture.
pub fn silhouette_candidates(
    picture: &RgbaImage,
    options: &ImportOptions,
) -> Result<Vec<SilhouetteCandidate>, SilhouetteError> {
    options.check()?;
    let readings = Readings::of(picture, options);
    let chosen = readings.choose()?;
    let mut candidates = Vec::new();
    for reading in readings.others(&chosen) {
        // A reading without any visible figure is not offered.
        if let Ok(regions) = reading.tones.regions(options) {
            candidates.push(SilhouetteCandidate {
                reading: reading.kind,
                regions,
            });
        }
    }
    let first = SilhouetteCandidate {
        reading: chosen.kind,
        regions: chosen.tones.regions(options)?,
    };
    candidates.insert(0, first);
    Ok(candidates)
}

/// Chooses the reading of a picture.
///
/// # Errors
/// [`SilhouetteError::OneTone`] if nothing separates figure and background.
pub(in crate::design) fn choose_tones(
    picture: &RgbaImage,
    options: &ImportOptions,
) -> Result<ChosenTones, SilhouetteError> {
    let readings = Readings::of(picture, options);
    let is_clear = options.reading != PictureReading::Auto || readings.is_opacity_clear();
    let chosen = readings.choose()?;
    let other = match is_clear {
        true => None,
        false => readings.others(&chosen).into_iter().next(),
    };
    let alternatives = other.map(|other| [chosen.kind, other.kind]);
    Ok(ChosenTones {
        tones: chosen.tones,
        alternatives,
    })
}

/// A picture with the options of its import.
struct Readings<'a> {
    picture: &'a RgbaImage,
    options: &'a ImportOptions,
    /// Number of opaque and of transparent pixels, in the whole picture and along its border.
    opaque: [usize; 2],
    transparent: [usize; 2],
    has_opacity: bool,
}

impl<'a> Readings<'a> {
    fn of(picture: &'a RgbaImage, options: &'a ImportOptions) -> Self {
        let threshold = options.threshold.unwrap_or(OPAQUE);
        let (width, count) = (picture.width() as usize, picture.pixels().len());
        let (mut opaque, mut transparent, mut has_opacity) = ([0; 2], [0; 2], false);
        for (k, pixel) in picture.pixels().enumerate() {
            let counts = match pixel.0[3] >= threshold {
                true => &mut opaque,
                false => &mut transparent,
            };
            counts[0] += 1;
            counts[1] += usize::from(is_on_border(k, width, count));
            has_opacity |= pixel.0[3] != u8::MAX;
        }
        Self {
            picture,
            options,
            opaque,
            transparent,
            has_opacity,
        }
    }

    /// Returns whether all of the picture's border is transparent, so that the opaque pixels are
    /// the figure beyond doubt.
    fn is_opacity_clear(&self) -> bool {
        self.has_opacity && self.opaque[1] == 0
    }

    /// Returns the reading that the options request, or the first that separates the pixels.
    fn choose(&self) -> Result<Reading, SilhouetteError> {
        match self.options.reading {
            PictureReading::Opacity => return Ok(self.by_opacity()),
            PictureReading::Brightness => {
                return self.by_brightness().ok_or(SilhouetteError::OneTone);
            }
            PictureReading::Colour => return self.by_colour().ok_or(SilhouetteError::OneTone),
            PictureReading::Auto => {}
        }
        // Without an opaque pixel, nothing else can be seen.
        let is_separated = self.opaque[0] == 0
            || (self.transparent[0] > 0 && self.transparent[1] >= self.opaque[1]);
        if self.has_opacity && is_separated {
            return Ok(self.by_opacity());
        }
        let inner = self.by_visible_tone();
        if self.transparent[0] > 0 && !inner.as_ref().is_some_and(Reading::separates) {
            return Ok(self.by_opacity());
        }
        inner.ok_or(SilhouetteError::OneTone)
    }

    /// Returns the reading by brightness or, if only colour separates, by colour.
    fn by_visible_tone(&self) -> Option<Reading> {
        let brightness = self.by_brightness();
        if brightness.as_ref().is_some_and(Reading::separates) {
            return brightness;
        }
        self.by_colour().filter(Reading::separates).or(brightness)
    }

    /// Returns the readings that separate the pixels clearly, apart from `chosen` and those that
    /// have nearly the same figure.
    fn others(&self, chosen: &Reading) -> Vec<Reading> {
        let by_opacity = (self.opaque[0] > 0 && self.transparent[0] > 0).then(|| self.by_opacity());
        let all = [by_opacity, self.by_brightness(), self.by_colour()];
        let mut others: Vec<Reading> = Vec::new();
        for reading in all.into_iter().flatten() {
            let is_new = |other: &Reading| other.differs_from(&reading);
            if reading.separates() && is_new(chosen) && others.iter().all(is_new) {
                others.push(reading);
            }
        }
        others
    }

    /// Returns the tones of a reading. `bytes` begin with the lowest row, because y points up.
    fn tones(&self, bytes: Vec<u8>, threshold: u8, above_is_figure: bool) -> PictureTones {
        PictureTones {
            width: self.picture.width(),
            height: self.picture.height(),
            bytes,
            threshold,
            above_is_figure: above_is_figure != self.options.invert,
        }
    }

    /// Returns a value of each pixel, the lowest row first.
    fn bytes(&self, value: impl Fn(&Rgba<u8>) -> u8) -> Vec<u8> {
        self.picture.rows().rev().flatten().map(value).collect()
    }

    /// Reads the opaque pixels as the figure. If no pixel is opaque, the threshold is chosen by
    /// Otsu's method.
    fn by_opacity(&self) -> Reading {
        let bytes = self.bytes(|pixel| pixel.0[3]);
        let lower = (self.opaque[0] == 0).then(|| otsu(&bytes)).flatten();
        let threshold = self.options.threshold.or(lower).unwrap_or(OPAQUE);
        Reading::of(PictureReading::Opacity, self.tones(bytes, threshold, true))
    }

    /// Reads the pixels that are darker or lighter than the border as the figure; transparent
    /// pixels belong to the background. `None` if all have the same grey level.
    fn by_brightness(&self) -> Option<Reading> {
        let opaque = |pixel: &&Rgba<u8>| self.is_opaque(pixel);
        let mut bytes = self.bytes(|pixel| luminance(pixel.0));
        let width = self.picture.width() as usize;
        let threshold = self.options.threshold;
        if self.transparent[0] == 0 || self.opaque[0] == 0 {
            let threshold = threshold.or_else(|| otsu(&bytes))?;
            let is_above = border_is_above(&bytes, width, threshold);
            let tones = self.tones(bytes, threshold, !is_above);
            return Some(Reading::of(PictureReading::Brightness, tones));
        }
        let visible = self.picture.pixels().filter(opaque);
        let visible: Vec<u8> = visible.map(|pixel| luminance(pixel.0)).collect();
        let threshold = threshold.or_else(|| otsu(&visible))?;
        let count = self.picture.pixels().len();
        let on_border = self.picture.pixels().enumerate();
        let on_border =
            on_border.filter(|(k, pixel)| is_on_border(*k, width, count) && self.is_opaque(pixel));
        let border: Vec<u8> = on_border.map(|(_, pixel)| luminance(pixel.0)).collect();
        // As one row, all of it is border.
        let is_above = border_is_above(&border, border.len().max(1), threshold);
        let ground = if is_above { u8::MAX } else { 0 };
        let pixels = self.picture.rows().rev().flatten();
        for (byte, pixel) in bytes.iter_mut().zip(pixels) {
            if !self.is_opaque(pixel) {
                *byte = ground;
            }
        }
        let tones = self.tones(bytes, threshold, !is_above);
        Some(Reading::of(PictureReading::Brightness, tones))
    }

    /// Reads the pixels whose colour differs from that of the border as the figure; transparent
    /// pixels belong to the background. `None` if all have the same colour.
    fn by_colour(&self) -> Option<Reading> {
        let ground = self.border_colour()?;
        let bytes = self.bytes(|pixel| match self.is_opaque(pixel) {
            true => {
                let channels = pixel.0.iter().zip(ground);
                channels.map(|(a, b)| a.abs_diff(b)).max().unwrap_or(0)
            }
            false => 0,
        });
        let threshold = self.options.threshold.or_else(|| otsu(&bytes))?;
        let tones = self.tones(bytes, threshold, true);
        Some(Reading::of(PictureReading::Colour, tones))
    }

    /// Returns the mean of the most frequent kind of colour along the border, where colours of one
    /// kind agree in the upper four bits of each channel.
    fn border_colour(&self) -> Option<[u8; 3]> {
        let (width, count) = (self.picture.width() as usize, self.picture.pixels().len());
        let mut kinds: BTreeMap<[u8; 3], (u64, [u64; 3])> = BTreeMap::new();
        for (k, pixel) in self.picture.pixels().enumerate() {
            if is_on_border(k, width, count) && self.is_opaque(pixel) {
                let [r, g, b, _] = pixel.0;
                let (number, sums) = kinds.entry([r, g, b].map(|c| c >> 4)).or_default();
                *number += 1;
                sums.iter_mut()
                    .zip([r, g, b])
                    .for_each(|(sum, c)| *sum += u64::from(c));
            }
        }
        let (number, sums) = kinds.into_values().max_by_key(|(number, _)| *number)?;
        Some(sums.map(|sum| (sum / number) as u8))
    }

    fn is_opaque(&self, pixel: &Rgba<u8>) -> bool {
        pixel.0[3] >= self.options.threshold.unwrap_or(OPAQUE)
    }
}

impl Reading {
    fn of(kind: PictureReading, tones: PictureTones) -> Self {
        let (mut sums, mut counts) = ([0.0; 2], [0.0; 2]);
        for &tone in &tones.bytes {
            let class = usize::from(tone >= tones.threshold);
            sums[class] += f64::from(tone);
            counts[class] += 1.0;
        }
        let contrast = sums[1] / counts[1] - sums[0] / counts[0];
        Self {
            kind,
            tones,
            contrast,
        }
    }

    /// Returns whether the mean tones of figure and background differ by more than noise.
    fn separates(&self) -> bool {
        self.contrast > f64::from(SAME_COLOUR)
    }

    /// Returns whether the two readings disagree on more pixels than half of the smaller figure.
    fn differs_from(&self, other: &Self) -> bool {
        let is_figure =
            |tones: &PictureTones, tone: u8| (tone >= tones.threshold) == tones.above_is_figure;
        let pairs = self.tones.bytes.iter().zip(&other.tones.bytes);
        let (mut sizes, mut different) = ([0_usize; 2], 0_usize);
        for (&a, &b) in pairs {
            let [a, b] = [is_figure(&self.tones, a), is_figure(&other.tones, b)];
            sizes[0] += usize::from(a);
            sizes[1] += usize::from(b);
            different += usize::from(a != b);
        }
        2 * different > sizes[0].min(sizes[1])
    }
}

//! Separates a picture of flat colours into paint layers of one colour each, without the
//! background.
//!
//! A colour is flat if it has pixels whose eight neighbours have almost the same colour. The
//! background is the transparent area, or the flat colour of most pixels along the border. The
//! boundary of a colour runs where the picture is equally close to this colour and to another flat
//! colour of the neighbourhood. Anti-aliased edges therefore give sub-pixel accuracy and produce no
//! third colour between two. Colours that are enclosed by another colour are stacked on top of it,
//! so they leave no hole in it.

use super::{FigureSamples, SilhouetteError, is_on_border};
use crate::colour::Rgb;
use crate::design::options::ImportOptions;
use crate::design::paint_layer::{PaintGroup, PaintLayer, stack_by_containment};
use crate::mesh::components;
use image::{Rgba, RgbaImage};
use rayon::prelude::*;
use std::collections::HashMap;

/// Maximum number of flat colours; a picture with more of them counts as shaded (heuristic).
const MAX_COLOURS: usize = 16;

/// Difference in a channel, from 0 to 255, below which two colours count as equal (tolerance: JPEG
/// noise).
pub(super) const SAME_COLOUR: u8 = 24;

/// Minimum fraction of the picture that a colour must cover to count as a flat colour (heuristic).
const MIN_COLOUR_AREA: f64 = 0.0005;

/// Minimum fraction of the picture that flat colours must cover together; if they cover less, the
/// picture counts as shaded. In portraits in front of a plain wall they cover less than one half
/// (heuristic).
const MIN_FLAT_AREA: f64 = 0.6;

/// Width of the border zone in pixels. The background colour is determined in this zone, and pixels
/// in it without a flat pixel nearby belong to the background (heuristic).
const BORDER_WIDTH: usize = 4;

/// Number of rows and columns on each side of a pixel that are searched for its candidates, the
/// flat colours to which the pixel may belong (tolerance: an anti-aliased edge is two or three
/// pixels wide).
const NEIGHBOURHOOD: usize = 2;

/// Returns one or more paint layers per flat colour of a picture, lowest first; none if the colours
/// of the picture are not flat.
///
/// # Errors
/// [`SilhouetteError`] if a boundary has too many points.
pub(in crate::design) fn flat_colour_layers(
    picture: &RgbaImage,
    options: &ImportOptions,
) -> Result<Vec<PaintLayer>, SilhouetteError> {
    let Some(colours) = FlatColours::of(picture) else {
        return Ok(Vec::new());
    };
    let side = f64::from(picture.width().max(picture.height()));
    let mut sheets = Vec::new();
    for colour in (0..colours.flat.len()).filter(|&k| k != colours.ground) {
        let mut figure = colours.figure(colour);
        figure.remove_specks(options.specks_px);
        match figure.trace(options.tolerance * side) {
            Ok(regions) => sheets.push(PaintGroup {
                regions,
                paint: Some(Rgb(colours.flat[colour].0).into()),
                name: String::new(),
            }),
            // The colour had only islands below the speck size, which have been removed.
            Err(SilhouetteError::Empty { .. }) => {}
            Err(error) => return Err(error),
        }
    }
    Ok(stack_by_containment(&sheets))
}

/// Colour of a pixel as red, green and blue, and whether the pixel is opaque.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
struct PixelColour([u8; 3], bool);

/// Stands for the colour of every pixel whose opacity is below one half.
const TRANSPARENT: PixelColour = PixelColour([0; 3], false);

impl PixelColour {
    fn of(&Rgba([r, g, b, a]): &Rgba<u8>) -> Self {
        match a < 128 {
            true => TRANSPARENT,
            false => Self([r, g, b], true),
        }
    }

    /// Returns the largest difference between the two colours in any channel, 0 to 255; 255 if only
    /// one of the two pixels is opaque.
    fn distance(self, other: Self) -> u8 {
        if self.1 != other.1 {
            return u8::MAX;
        }
        let channels = self.0.into_iter().zip(other.0);
        channels.map(|(a, b)| a.abs_diff(b)).max().unwrap_or(0)
    }
}

/// Flat colours that best match a pixel.
#[derive(Clone, Copy)]
struct ColourMatch {
    /// Bit mask of the candidates, the flat colours in the neighbourhood of the pixel.
    candidates: u32,
    /// Index, in the list of flat colours, of the candidate closest to the pixel's colour.
    closest: u8,
    /// Distance from the pixel's colour to the closest candidate, 0 to 255.
    distance: u8,
    /// Distance from the pixel's colour to the second closest candidate; `None` if there is only
    /// one.
    second_distance: Option<u8>,
}

impl ColourMatch {
    /// Finds the closest and the second closest to a pixel's colour among the flat colours in the
    /// bit mask `candidates`.
    fn of(ink: PixelColour, candidates: u32, flat: &[PixelColour]) -> Self {
        let mut pixel = Self {
            candidates,
            closest: 0,
            distance: u8::MAX,
            second_distance: None,
        };
        let allowed = (0_u8..)
            .zip(flat)
            .filter(|(k, _)| candidates & (1 << k) != 0);
        for (count, (index, &other)) in allowed.enumerate() {
            let distance = ink.distance(other);
            if count == 0 {
                (pixel.closest, pixel.distance) = (index, distance);
            } else if distance < pixel.distance {
                pixel.second_distance = Some(pixel.distance);
                (pixel.closest, pixel.distance) = (index, distance);
            } else if pixel.second_distance.is_none_or(|second| distance < second) {
                pixel.second_distance = Some(distance);
            }
        }
        pixel
    }
}

/// Flat colours of a picture, and for each pixel the flat colours that match it.
struct FlatColours {
    /// Width and height of the picture in pixels.
    size: (u32, u32),
    /// Flat colours, largest area first.
    flat: Vec<PixelColour>,
    /// Index of the background colour in `flat`.
    ground: usize,
    /// Colours of the pixels, lowest row first.
    inks: Vec<PixelColour>,
    /// Closest flat colours of each pixel, lowest row first.
    pixels: Vec<ColourMatch>,
}

impl FlatColours {
    /// Analyses a picture; returns `None` if it has too many colours or too little flat area.
    fn of(picture: &RgbaImage) -> Option<Self> {
        let rows = picture.rows().rev();
        let inks: Vec<PixelColour> = rows.flatten().map(PixelColour::of).collect();
        let (width, count) = (picture.width() as usize, inks.len());
        let is_flat = |i: usize| {
            neighbourhood(i, width, count, 1).all(|j| inks[i].distance(inks[j]) < SAME_COLOUR)
        };
        let is_flat: Vec<bool> = (0..count).into_par_iter().map(is_flat).collect();
        let flat = flat_colours(&inks, &is_flat)?;
        let ground = background(&flat, &inks, &is_flat, width)?;
        let own_bit = |i: usize| match is_flat[i] {
            true => 1 << ColourMatch::of(inks[i], u32::MAX, &flat).closest,
            false => 0_u32,
        };
        let own_bits: Vec<u32> = (0..count).into_par_iter().map(own_bit).collect();
        let pixel = |i: usize| {
            let neighbours = neighbourhood(i, width, count, NEIGHBOURHOOD);
            let candidates = match neighbours.fold(0, |bits, j| bits | own_bits[j]) {
                0 if is_near_border(i, width, count) => 1 << ground,
                // A pixel without a flat pixel nearby, as in a very thin line, may have any of the
                // flat colours.
                0 => u32::MAX,
                some => some,
            };
            ColourMatch::of(inks[i], candidates, &flat)
        };
        Some(Self {
            size: picture.dimensions(),
            pixels: (0..count).into_par_iter().map(pixel).collect(),
            flat,
            ground,
            inks,
        })
    }

    /// Returns signed samples whose zero contour is the boundary of the flat colour with the index
    /// `colour`; they are positive inside.
    fn figure(&self, colour: usize) -> FigureSamples {
        let sample = |(pixel, ink): (&ColourMatch, &PixelColour)| {
            if pixel.candidates & (1 << colour) == 0 {
                return -1.0;
            }
            let is_own = usize::from(pixel.closest) == colour;
            let own = ink.distance(self.flat[colour]);
            let other = if is_own {
                pixel.second_distance
            } else {
                Some(pixel.distance)
            };
            let Some(other) = other.filter(|&other| own > 0 || other > 0) else {
                return 1.0;
            };
            let [own, other] = [own, other].map(f32::from);
            let share = (other - own) / (own + other);
            // Samples must not be zero: each pixel lies either inside or outside.
            if share == 0.0 { f32::EPSILON } else { share }
        };
        let (width, height) = self.size;
        let pixels = self.pixels.par_iter().zip(&self.inks);
        let mut figure = FigureSamples {
            width,
            height,
            samples: pixels.map(sample).collect(),
            threshold: 128,
        };
        self.fill_enclosed(&mut figure);
        figure
    }

    /// Fills enclosed areas that contain no background, because the colours in them are stacked on
    /// top of the figure.
    fn fill_enclosed(&self, figure: &mut FigureSamples) {
        let (count, width) = (figure.samples.len(), figure.width as usize);
        let across = (1..count).filter(|i| !i.is_multiple_of(width));
        let across = across.map(|i| [i - 1, i]);
        let upwards = (width..count).map(|i| [i - width, i]);
        let is_outside = |i: usize| figure.samples[i] < 0.0;
        let both_outside = |&[a, b]: &[usize; 2]| is_outside(a) && is_outside(b);
        let links = across.chain(upwards).filter(both_outside);
        let pieces = components(count, links.map(|ends| ends.map(|i| i as u32)));
        let mut is_open = vec![false; count];
        for (i, (pixel, &piece)) in self.pixels.iter().zip(&pieces).enumerate() {
            if usize::from(pixel.closest) == self.ground || is_on_border(i, width, count) {
                is_open[piece as usize] = true;
            }
        }
        for (sample, piece) in figure.samples.iter_mut().zip(pieces) {
            if *sample < 0.0 && !is_open[piece as usize] {
                *sample = 1.0;
            }
        }
    }
}

/// Returns the index of the background colour: the transparent one, if there is one, otherwise the
/// most frequent one in the border zone. Returns `None` if there are no flat colours.
fn background(
    flat: &[PixelColour],
    inks: &[PixelColour],
    is_flat: &[bool],
    width: usize,
) -> Option<usize> {
    if let Some(ground) = flat.iter().position(|&ink| ink == TRANSPARENT) {
        return Some(ground);
    }
    let mut counts = vec![0; flat.len()];
    // The border zone is wider than the thin line that some converters draw around a picture.
    let is_border = |&i: &usize| is_flat[i] && is_near_border(i, width, inks.len());
    for i in (0..inks.len()).filter(is_border) {
        counts[usize::from(ColourMatch::of(inks[i], u32::MAX, flat).closest)] += 1;
    }
    (0..counts.len()).max_by_key(|&k| counts[k])
}

/// Returns the flat colours, largest area first, or `None` if the picture is shaded. Similar
/// colours are merged into the most frequent one.
fn flat_colours(inks: &[PixelColour], is_flat: &[bool]) -> Option<Vec<PixelColour>> {
    let mut counts: HashMap<PixelColour, usize> = HashMap::new();
    for (&ink, _) in inks.iter().zip(is_flat).filter(|(_, is_flat)| **is_flat) {
        *counts.entry(ink).or_default() += 1;
    }
    let mut counts: Vec<(PixelColour, usize)> = counts.into_iter().collect();
    counts.sort_unstable_by_key(|&(ink, count)| (std::cmp::Reverse(count), ink));
    let mut flat: Vec<(PixelColour, usize)> = Vec::new();
    for (ink, count) in counts {
        match flat
            .iter()
            .position(|(other, _)| other.distance(ink) < SAME_COLOUR)
        {
            Some(k) => flat[k].1 += count,
            None if flat.len() <= 4 * MAX_COLOURS => flat.push((ink, count)),
            None => return None,
        }
    }
    let total = inks.len() as f64;
    flat.retain(|(_, count)| *count as f64 >= MIN_COLOUR_AREA * total);
    let covered: usize = flat.iter().map(|(_, count)| count).sum();
    let is_flat =
        (2..=MAX_COLOURS).contains(&flat.len()) && covered as f64 >= MIN_FLAT_AREA * total;
    is_flat.then(|| flat.into_iter().map(|(ink, _)| ink).collect())
}

/// Returns whether a pixel, given by its index, lies in the border zone.
fn is_near_border(i: usize, width: usize, count: usize) -> bool {
    let (x, y) = (i % width, i / width);
    x.min(y).min(width - 1 - x).min(count / width - 1 - y) < BORDER_WIDTH
}

/// Returns the indices of the pixels within `reach` rows and columns of the pixel `i`, including
/// `i`.
fn neighbourhood(
    i: usize,
    width: usize,
    count: usize,
    reach: usize,
) -> impl Iterator<Item = usize> {
    let (x, y) = (i % width, i / width);
    let rows = y.saturating_sub(reach)..(y + reach + 1).min(count / width);
    let columns = x.saturating_sub(reach)..(x + reach + 1).min(width);
    rows.flat_map(move |row| columns.clone().map(move |column| row * width + column))
}

#[cfg(test)]
mod tests {
    use super::*;

    const RED: [f64; 3] = [200.0, 30.0, 40.0];
    const BLUE: [f64; 3] = [20.0, 60.0, 180.0];
    const WHITE: [f64; 3] = [255.0; 3];

    /// Draws overlapping anti-aliased discs, given as (centre, radius, colour), on a white or
    /// transparent background.
    fn discs(discs: &[([f64; 2], f64, [f64; 3])], is_clear: bool) -> RgbaImage {
        RgbaImage::from_fn(120, 100, |x, y| {
            let (mut ink, mut alpha) = (WHITE, if is_clear { 0.0 } else { 1.0 });
            for &([cx, cy], r, colour) in discs {
                let (dx, dy) = (f64::from(x) + 0.5 - cx, f64::from(y) + 0.5 - cy);
                let share = (r + 0.5 - dx.hypot(dy)).clamp(0.0, 1.0);
                let over = if alpha == 0.0 { 1.0 } else { share };
                ink = [0, 1, 2].map(|k| ink[k] * (1.0 - over) + colour[k] * over);
                alpha = share + alpha * (1.0 - share);
            }
            let [r, g, b] = ink.map(|c| c.round() as u8);
            Rgba([r, g, b, (255.0 * alpha) as u8])
        })
    }

    /// Returns the colour, area and number of rings of each paint layer.
    fn found(picture: &RgbaImage) -> Vec<(Rgb, f64, usize)> {
        let coats = flat_colour_layers(picture, &ImportOptions::default()).expect("traced");
        let summary = |coat: &PaintLayer| {
            let colour = coat.paint.expect("a paint").colour;
            (colour, coat.regions.area(), coat.regions.rings().count())
        };
        coats.iter().map(summary).collect()
    }

    fn assert_disc_area(found: f64, radius: f64) {
        let area = std::f64::consts::PI * radius * radius;
        assert!((found - area).abs() < 0.02 * area, "{found} for {area}");
    }

    #[test]
    fn each_colour_is_a_layer_and_enclosed_colours_are_stacked() {
        let eye = [([60.0, 50.0], 40.0, RED), ([60.0, 50.0], 15.0, BLUE)];
        for is_clear in [false, true] {
            let found = found(&discs(&eye, is_clear));
            assert_eq!(found.len(), 2, "{found:?}");
            assert_eq!(found[0].0, Rgb(RED.map(|c| c as u8)));
            assert_eq!([found[0].2, found[1].2], [1, 1]);
            assert_disc_area(found[0].1, 40.0);
            assert_disc_area(found[1].1, 15.0);
        }
    }

    #[test]
    fn background_holes_stay_and_blended_edges_add_no_colour() {
        // Edge pixels between white and red are pink, and pink is a flat colour elsewhere in the
        // picture.
        let pink = [228.0, 142.0, 148.0];
        let all = [
            ([40.0, 50.0], 30.0, RED),
            ([40.0, 50.0], 12.0, WHITE),
            ([100.0, 50.0], 12.0, pink),
        ];
        let found = found(&discs(&all, false));
        assert_eq!(found.len(), 2, "{found:?}");
        assert_eq!([found[0].2, found[1].2], [2, 1]);
        assert_disc_area(found[1].1, 12.0);
    }

    #[test]
    fn a_thin_frame_is_not_the_background() {
        let mut picture = discs(&[([60.0, 50.0], 30.0, BLUE)], false);
        for x in 0..120 {
            for (y, grey) in [(0, 0), (1, 90), (2, 190)] {
                picture.put_pixel(x, y, Rgba([grey, grey, grey, 255]));
                picture.put_pixel(x, 99 - y, Rgba([grey, grey, grey, 255]));
            }
        }
        let found = found(&picture);
        assert_eq!(found.len(), 1, "{found:?}");
        assert_disc_area(found[0].1, 30.0);
    }

    #[test]
    fn pictures_without_flat_colours_have_no_layers() {
        let shades =
            RgbaImage::from_fn(80, 80, |x, y| Rgba([(3 * x) as u8, (3 * y) as u8, 90, 255]));
        assert_eq!(found(&shades), []);
        assert_eq!(found(&RgbaImage::from_pixel(9, 9, Rgba([9; 4]))), []);
        assert_eq!(
            found(&RgbaImage::from_pixel(1, 1, Rgba([9, 9, 9, 255]))),
            []
        );
    }
}

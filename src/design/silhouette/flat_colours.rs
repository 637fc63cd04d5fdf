//! A picture of flat colours as coats of paint, one for each colour.
//!
//! Flat are the colours of pixels that have their like all around. The ground is
//! what is transparent, or the flat colour along most of the border. A boundary
//! runs where a pixel is as near to a colour as to the nearest other one that is
//! flat close by, so that smooth edges give sub-pixel accuracy and no third
//! colour between two. What lies within a colour lies on it: it has no hole there.

use super::{FigureSamples, SilhouetteError, is_on_border};
use crate::colour::Rgb;
use crate::design::options::ImportOptions;
use crate::design::paint_layer::{PaintGroup, PaintLayer, stack_by_containment};
use crate::mesh::components;
use image::{Rgba, RgbaImage};
use rayon::prelude::*;
use std::collections::HashMap;

/// Most colours that are told apart: more are shades of a photograph.
const MOST: usize = 16;

/// Colours nearer to each other than this, of 255, are one: a JPEG leaves that.
const ALIKE: u8 = 24;

/// The least share of the picture that a colour covers.
const LEAST: f64 = 0.0005;

/// The least share of the picture that is flat: of photographs of people before a
/// plain wall less than half is.
const FLAT: f64 = 0.6;

/// How many pixels from the border the ground is looked for, and all that is not
/// flat is ground.
const EDGE: usize = 4;

/// How far around a pixel flat colours are looked for: a smooth edge is two or
/// three pixels wide.
const AROUND: usize = 2;

/// The coats of a picture, the lowest first; none where its colours are not
/// flat.
///
/// # Errors
/// [`SilhouetteError`] where a boundary has absurdly many points.
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
            // Its specks were all there was of it.
            Err(SilhouetteError::Empty { .. }) => {}
            Err(error) => return Err(error),
        }
    }
    Ok(stack_by_containment(&sheets))
}

/// Red, green and blue, and whether there is anything.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
struct PixelColour([u8; 3], bool);

/// Nothing.
const GROUND: PixelColour = PixelColour([0; 3], false);

impl PixelColour {
    fn of(&Rgba([r, g, b, a]): &Rgba<u8>) -> Self {
        match a < 128 {
            true => GROUND,
            false => Self([r, g, b], true),
        }
    }

    /// How far two are apart.
    fn far(self, other: Self) -> u8 {
        if self.1 != other.1 {
            return u8::MAX;
        }
        let channels = self.0.into_iter().zip(other.0);
        channels.map(|(a, b)| a.abs_diff(b)).max().unwrap_or(0)
    }
}

/// What is known of a pixel.
#[derive(Clone, Copy)]
struct ColourMatch {
    /// The flat colours that are close by, as bits.
    near: u32,
    /// The nearest of them, and how far it is.
    label: u8,
    far: u8,
    /// How far the second is; none where there is no other.
    second: Option<u8>,
}

impl ColourMatch {
    fn of(ink: PixelColour, near: u32, flat: &[PixelColour]) -> Self {
        let mut pixel = Self {
            near,
            label: 0,
            far: u8::MAX,
            second: None,
        };
        let allowed = (0_u8..).zip(flat).filter(|(k, _)| near & (1 << k) != 0);
        for (count, (label, &other)) in allowed.enumerate() {
            let far = ink.far(other);
            if count == 0 {
                (pixel.label, pixel.far) = (label, far);
            } else if far < pixel.far {
                pixel.second = Some(pixel.far);
                (pixel.label, pixel.far) = (label, far);
            } else if pixel.second.is_none_or(|second| far < second) {
                pixel.second = Some(far);
            }
        }
        pixel
    }
}

/// A picture's flat colours, and which of them each pixel may be of.
struct FlatColours {
    size: (u32, u32),
    flat: Vec<PixelColour>,
    /// The number of the ground's.
    ground: usize,
    inks: Vec<PixelColour>,
    /// The lowest row first, as the inks.
    pixels: Vec<ColourMatch>,
}

impl FlatColours {
    /// None where there are too many, or too little is flat.
    fn of(picture: &RgbaImage) -> Option<Self> {
        let rows = picture.rows().rev();
        let inks: Vec<PixelColour> = rows.flatten().map(PixelColour::of).collect();
        let (width, count) = (picture.width() as usize, inks.len());
        let is_flat = |i: usize| around(i, width, count, 1).all(|j| inks[i].far(inks[j]) < ALIKE);
        let is_flat: Vec<bool> = (0..count).into_par_iter().map(is_flat).collect();
        let flat = flat_colours(&inks, &is_flat)?;
        let ground = ground(&flat, &inks, &is_flat, width)?;
        let own = |i: usize| match is_flat[i] {
            true => 1 << ColourMatch::of(inks[i], u32::MAX, &flat).label,
            false => 0_u32,
        };
        let own: Vec<u32> = (0..count).into_par_iter().map(own).collect();
        let pixel = |i: usize| {
            let near = match around(i, width, count, AROUND).fold(0, |m, j| m | own[j]) {
                0 if is_at_edge(i, width, count) => 1 << ground,
                // A line too thin to be flat anywhere.
                0 => u32::MAX,
                some => some,
            };
            ColourMatch::of(inks[i], near, &flat)
        };
        Some(Self {
            size: picture.dimensions(),
            pixels: (0..count).into_par_iter().map(pixel).collect(),
            flat,
            ground,
            inks,
        })
    }

    /// The figure of one colour.
    fn figure(&self, colour: usize) -> FigureSamples {
        let sample = |(pixel, ink): (&ColourMatch, &PixelColour)| {
            if pixel.near & (1 << colour) == 0 {
                return -1.0;
            }
            let is_own = usize::from(pixel.label) == colour;
            let own = ink.far(self.flat[colour]);
            let other = if is_own {
                pixel.second
            } else {
                Some(pixel.far)
            };
            let Some(other) = other.filter(|&other| own > 0 || other > 0) else {
                return 1.0;
            };
            let [own, other] = [own, other].map(f32::from);
            let share = (other - own) / (own + other);
            // Never on the boundary itself.
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
        self.fill_up(&mut figure);
        figure
    }

    /// What is enclosed and shows no ground is laid on the colour, not into it.
    fn fill_up(&self, figure: &mut FigureSamples) {
        let (count, width) = (figure.samples.len(), figure.width as usize);
        let across = (1..count).filter(|i| !i.is_multiple_of(width));
        let across = across.map(|i| [i - 1, i]);
        let upwards = (width..count).map(|i| [i - width, i]);
        let is_out = |i: usize| figure.samples[i] < 0.0;
        let alike = |&[a, b]: &[usize; 2]| is_out(a) && is_out(b);
        let links = across.chain(upwards).filter(alike);
        let pieces = components(count, links.map(|ends| ends.map(|i| i as u32)));
        let mut is_open = vec![false; count];
        for (i, (pixel, &piece)) in self.pixels.iter().zip(&pieces).enumerate() {
            if usize::from(pixel.label) == self.ground || is_on_border(i, width, count) {
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

/// The number of the ground's colour.
fn ground(
    flat: &[PixelColour],
    inks: &[PixelColour],
    is_flat: &[bool],
    width: usize,
) -> Option<usize> {
    if let Some(ground) = flat.iter().position(|&ink| ink == GROUND) {
        return Some(ground);
    }
    let mut counts = vec![0; flat.len()];
    // A frame of a pixel or two, as converters leave it, is no ground.
    let is_edge = |&i: &usize| is_flat[i] && is_at_edge(i, width, inks.len());
    for i in (0..inks.len()).filter(is_edge) {
        counts[usize::from(ColourMatch::of(inks[i], u32::MAX, flat).label)] += 1;
    }
    (0..counts.len()).max_by_key(|&k| counts[k])
}

/// The colours that are flat, those that cover most first.
fn flat_colours(inks: &[PixelColour], is_flat: &[bool]) -> Option<Vec<PixelColour>> {
    let mut counts: HashMap<PixelColour, usize> = HashMap::new();
    for (&ink, _) in inks.iter().zip(is_flat).filter(|(_, is_flat)| **is_flat) {
        *counts.entry(ink).or_default() += 1;
    }
    let mut counts: Vec<(PixelColour, usize)> = counts.into_iter().collect();
    counts.sort_unstable_by_key(|&(ink, count)| (std::cmp::Reverse(count), ink));
    let mut flat: Vec<(PixelColour, usize)> = Vec::new();
    for (ink, count) in counts {
        match flat.iter().position(|(other, _)| other.far(ink) < ALIKE) {
            Some(k) => flat[k].1 += count,
            None if flat.len() <= 4 * MOST => flat.push((ink, count)),
            None => return None,
        }
    }
    let total = inks.len() as f64;
    flat.retain(|(_, count)| *count as f64 >= LEAST * total);
    let covered: usize = flat.iter().map(|(_, count)| count).sum();
    let is_flat = (2..=MOST).contains(&flat.len()) && covered as f64 >= FLAT * total;
    is_flat.then(|| flat.into_iter().map(|(ink, _)| ink).collect())
}

/// Whether a pixel is next to the border.
fn is_at_edge(i: usize, width: usize, count: usize) -> bool {
    let (x, y) = (i % width, i / width);
    x.min(y).min(width - 1 - x).min(count / width - 1 - y) < EDGE
}

/// The pixels of a square around one that are there.
fn around(i: usize, width: usize, count: usize, reach: usize) -> impl Iterator<Item = usize> {
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

    /// Discs over each other, with smooth edges, on white or on nothing.
    fn discs(discs: &[([f64; 2], f64, [f64; 3])], is_clear: bool) -> RgbaImage {
        RgbaImage::from_fn(120, 100, |x, y| {
            let (mut ink, mut there) = (WHITE, if is_clear { 0.0 } else { 1.0 });
            for &([cx, cy], r, colour) in discs {
                let (dx, dy) = (f64::from(x) + 0.5 - cx, f64::from(y) + 0.5 - cy);
                let share = (r + 0.5 - dx.hypot(dy)).clamp(0.0, 1.0);
                let over = if there == 0.0 { 1.0 } else { share };
                ink = [0, 1, 2].map(|k| ink[k] * (1.0 - over) + colour[k] * over);
                there = share + there * (1.0 - share);
            }
            let [r, g, b] = ink.map(|c| c.round() as u8);
            Rgba([r, g, b, (255.0 * there) as u8])
        })
    }

    fn found(picture: &RgbaImage) -> Vec<(Rgb, f64, usize)> {
        let coats = flat_colour_layers(picture, &ImportOptions::default()).expect("traced");
        let of = |coat: &PaintLayer| {
            let colour = coat.paint.expect("a paint").colour;
            (colour, coat.regions.area(), coat.regions.rings().count())
        };
        coats.iter().map(of).collect()
    }

    fn near(found: f64, radius: f64) {
        let area = std::f64::consts::PI * radius * radius;
        assert!((found - area).abs() < 0.02 * area, "{found} for {area}");
    }

    #[test]
    fn each_colour_is_a_coat_and_what_lies_within_lies_on_it() {
        let eye = [([60.0, 50.0], 40.0, RED), ([60.0, 50.0], 15.0, BLUE)];
        for is_clear in [false, true] {
            let found = found(&discs(&eye, is_clear));
            assert_eq!(found.len(), 2, "{found:?}");
            assert_eq!(found[0].0, Rgb(RED.map(|c| c as u8)));
            assert_eq!([found[0].2, found[1].2], [1, 1]);
            near(found[0].1, 40.0);
            near(found[1].1, 15.0);
        }
    }

    #[test]
    fn a_hole_that_shows_the_ground_stays_one_and_no_third_colour_comes_between() {
        // Half way from white to red there is nothing, though pink is flat elsewhere.
        let pink = [228.0, 142.0, 148.0];
        let all = [
            ([40.0, 50.0], 30.0, RED),
            ([40.0, 50.0], 12.0, WHITE),
            ([100.0, 50.0], 12.0, pink),
        ];
        let found = found(&discs(&all, false));
        assert_eq!(found.len(), 2, "{found:?}");
        assert_eq!([found[0].2, found[1].2], [2, 1]);
        near(found[1].1, 12.0);
    }

    #[test]
    fn a_thin_frame_is_no_ground() {
        let mut picture = discs(&[([60.0, 50.0], 30.0, BLUE)], false);
        for x in 0..120 {
            for (y, grey) in [(0, 0), (1, 90), (2, 190)] {
                picture.put_pixel(x, y, Rgba([grey, grey, grey, 255]));
                picture.put_pixel(x, 99 - y, Rgba([grey, grey, grey, 255]));
            }
        }
        let found = found(&picture);
        assert_eq!(found.len(), 1, "{found:?}");
        near(found[0].1, 30.0);
    }

    #[test]
    fn what_has_no_flat_colours_has_no_coats() {
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

//! Colour quantisation for GIF: median cut over the colours of a whole film.
//!
//! Follows Heckbert, "Color Image Quantization for Frame Buffer Display" (1982), but splits the box
//! with the largest squared error at its mean, as later practice does. Guarantees: if the colours
//! fit into the palette, each is reproduced exactly. All frames share one palette, so a still shape
//! never flickers. There is no dithering, which would shimmer in motion and enlarge the file.

use std::collections::HashMap;

/// Number of pixels of each colour, in sRGB.
pub(super) type ColourHistogram = HashMap<[u8; 3], u64>;

/// Palette of at most 256 colours with nearest-colour lookup.
#[derive(Clone, Debug)]
pub(super) struct GifPalette(Vec<[u8; 3]>);

impl GifPalette {
    /// Returns a palette of at most `limit` colours that represents the histogram; just black if
    /// the histogram is empty.
    pub fn of(histogram: ColourHistogram, limit: usize) -> Self {
        let mut colours: Vec<ColourCount> = histogram.into_iter().collect();
        // Hash maps have no stable order; sorting makes the palette reproducible.
        colours.sort_unstable();
        if colours.is_empty() {
            return Self(vec![[0; 3]]);
        }
        // Few colours need no quantisation, and the loop below would run out of boxes to split.
        if colours.len() <= limit {
            return Self(colours.into_iter().map(|(colour, _)| colour).collect());
        }
        let mut boxes = vec![ColourBox::of(colours)];
        while boxes.len() < limit {
            let error = |i: &usize| boxes[*i].error;
            let worst = (0..boxes.len()).max_by(|a, b| error(a).total_cmp(&error(b)));
            // There are more colours than boxes, so the box with the largest error holds at least
            // two colours and can be split.
            let Some((low, high)) = worst.and_then(|i| boxes.swap_remove(i).cut()) else {
                break;
            };
            boxes.extend([low, high]);
        }
        Self(boxes.iter().map(ColourBox::mean).collect())
    }

    /// Returns the colours of the palette.
    pub fn colours(&self) -> &[[u8; 3]] {
        &self.0
    }

    /// Returns the index of the colour with the smallest squared distance.
    pub fn nearest(&self, colour: [u8; 3]) -> u8 {
        // Distances are measured in sRGB values, which are closer to perceived differences than
        // linear light.
        let distance = |other: &[u8; 3]| -> i32 {
            let along = |k: usize| i32::from(colour[k]) - i32::from(other[k]);
            (0..3).map(|k| along(k) * along(k)).sum()
        };
        let nearest = (0..self.0.len()).min_by_key(|&i| distance(&self.0[i]));
        nearest.unwrap_or_default() as u8
    }
}

/// A colour and its number of pixels.
type ColourCount = ([u8; 3], u64);

/// Box of the median cut: colours that will be represented by their mean.
#[derive(Debug)]
struct ColourBox {
    colours: Vec<ColourCount>,
    mean: [f64; 3],
    /// Channel with the largest variance, along which the box is split.
    axis: usize,
    /// Sum of the squared distances of all pixels in the box from its mean colour, in sRGB values.
    error: f64,
}

impl ColourBox {
    fn of(colours: Vec<ColourCount>) -> Self {
        let total: f64 = colours.iter().map(|c| c.1 as f64).sum();
        let mean_of = |f: &dyn Fn([u8; 3]) -> f64| {
            colours.iter().map(|c| c.1 as f64 * f(c.0)).sum::<f64>() / total
        };
        let mean = [0, 1, 2].map(|k| mean_of(&|c| f64::from(c[k])));
        let variance = [0, 1, 2].map(|k| mean_of(&|c| (f64::from(c[k]) - mean[k]).powi(2)));
        let axis = (0..3).max_by(|&a, &b| variance[a].total_cmp(&variance[b]));
        Self {
            mean,
            axis: axis.unwrap_or_default(),
            error: total * variance.iter().sum::<f64>(),
            colours,
        }
    }

    /// Splits the box at its mean along `axis`; `None` if it holds a single colour.
    fn cut(self) -> Option<(Self, Self)> {
        let (axis, threshold) = (self.axis, self.mean[self.axis]);
        let is_low = |c: &ColourCount| f64::from(c.0[axis]) <= threshold;
        let (low, high): (Vec<_>, Vec<_>) = self.colours.into_iter().partition(is_low);
        let both = !low.is_empty() && !high.is_empty();
        both.then(|| (Self::of(low), Self::of(high)))
    }

    fn mean(&self) -> [u8; 3] {
        self.mean.map(|c| c.round() as u8)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn histogram(colours: impl IntoIterator<Item = ([u8; 3], u64)>) -> ColourHistogram {
        colours.into_iter().collect()
    }

    #[test]
    fn few_colours_are_reproduced_exactly() {
        let colours = (0..200u8).map(|i| ([i, 255 - i, 7], u64::from(i) + 1));
        let palette = GifPalette::of(histogram(colours), 255);
        for i in 0..200u8 {
            let index = usize::from(palette.nearest([i, 255 - i, 7]));
            assert_eq!(palette.colours()[index], [i, 255 - i, 7]);
        }
    }

    #[test]
    fn many_colours_fill_the_palette_and_stay_close() {
        let ramp = (0..=255u8).flat_map(|i| (0..8u8).map(move |j| ([i, i / 2 + 8 * j, 200], 5)));
        let palette = GifPalette::of(histogram(ramp.clone()), 64);
        assert_eq!(palette.colours().len(), 64);
        for (colour, _) in ramp {
            let near = palette.colours()[usize::from(palette.nearest(colour))];
            let distance = (0..3).map(|k| colour[k].abs_diff(near[k])).max();
            assert!(distance <= Some(16), "{colour:?} became {near:?}");
        }
    }

    #[test]
    fn an_empty_film_has_a_palette_and_two_colours_can_merge() {
        assert_eq!(
            GifPalette::of(ColourHistogram::default(), 255).colours(),
            [[0; 3]]
        );
        let two = histogram([([0, 0, 0], 1), ([255, 255, 255], 3)]);
        assert_eq!(GifPalette::of(two, 1).colours(), [[191; 3]]);
    }
}

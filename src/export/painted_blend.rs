//! Draws blends of several painted designs in the designs' own colours, as pixels.
//!
//! Each pixel of a blend shows the mean of the designs' colours there, weighted as the designs. For
//! rigid parts, the common mesh says which point of each design a pixel comes from. Distance fields
//! have no such points, so the designs' colours at the same place are used, and their mean colours
//! where no design has any. The outline is that of the blend without paints.

use std::sync::Arc;

use image::{Rgba, RgbaImage};

use super::drawing::Drawing;
use super::raster::rasterise;
use super::size::PixelSize;
use super::view::PlaneView;
use crate::colour::Rgb;
use crate::content::PictureRaster;
use crate::design::Design;
use crate::geometry::{Bounds, DVec2};
use crate::space::{DesignSpace, SpaceFrame};
use crate::transition::{TransitionStyle, VectorFigure};

/// Side of the image of each design from which colours are read, in pixels (resource limit: 1 MiB
/// per design).
const SOURCE_PX: u32 = 512;

/// Number of pixels by which colours are continued beyond the faces of the mesh, so that the smooth
/// edge of the outline has a colour.
const EDGE_PX: usize = 2;

/// The colours of all designs of a space.
#[derive(Clone, Debug)]
pub struct SpaceColours {
    sources: Vec<SourceColours>,
}

/// The colours of one design.
#[derive(Clone, Debug)]
struct SourceColours {
    image: RgbaImage,
    view: PlaneView,
    /// Mean of the visible pixels.
    mean: Rgb,
}

impl Drawing {
    /// Adds a blend of several designs seen through `view`, in the designs' own colours, as pixels.
    pub fn push_painted_blend(
        &mut self,
        blend: &SpaceFrame,
        colours: &SpaceColours,
        view: &PlaneView,
    ) {
        let places = blend.figure().rings.concat();
        self.push_pixels(&places, view, |raster| colours.picture(blend, raster));
    }
}

/// A colour with premultiplied alpha, in [0, 1].
type Premultiplied = [f64; 4];

impl SpaceColours {
    /// Draws the designs of a space; `None` if none of them has paints. Designs without paints get
    /// their colour from `style`.
    #[must_use]
    pub fn new(space: &DesignSpace, style: &TransitionStyle) -> Option<Self> {
        let designs = space.designs();
        let has_paints = designs.iter().any(|design| design.is_painted());
        if !has_paints || space.is_of_pictures() {
            return None;
        }
        let size = PixelSize::new(SOURCE_PX, SOURCE_PX).ok()?;
        let source = |(k, design): (usize, &Arc<Design>)| {
            let mut weights = vec![0.0; designs.len()];
            weights[k] = 1.0;
            let t = space.colour_fraction(&weights);
            let figure = VectorFigure::of(design, t);
            let bounds = Bounds::of(figure.rings.iter().flatten().copied())?;
            let view = PlaneView::fit(bounds, size);
            let mut drawing = Drawing::new(size, None);
            drawing.push_figure(&figure, t, style, &view);
            let image = rasterise(&drawing);
            let mean = mean_colour(&image)?;
            Some(SourceColours { image, view, mean })
        };
        let sources = designs.iter().enumerate().map(source);
        Some(Self {
            sources: sources.collect::<Option<_>>()?,
        })
    }

    /// Mean colour of the design with the index `design`.
    #[must_use]
    pub fn mean_of(&self, design: usize) -> Option<Rgb> {
        self.sources.get(design).map(|source| source.mean)
    }

    /// Draws a blend, with straight alpha on a transparent background; `None` if the image would
    /// have no pixels.
    #[must_use]
    pub fn picture(&self, blend: &SpaceFrame, raster: &PictureRaster) -> Option<RgbaImage> {
        let [width, height] = raster.size;
        let size = PixelSize::new(width, height).ok()?;
        let extent = raster.pixel_size * DVec2::new(width.into(), height.into());
        let low = raster.corner - DVec2::new(0.0, extent.y);
        let bounds = Bounds {
            min: low,
            max: low + extent,
        };
        let view = PlaneView::fit(bounds, size);
        let mut silhouette = Drawing::new(size, None);
        let style = TransitionStyle::default();
        silhouette.push_figure(&blend.figure(), 0.0, &style, &view);
        let mut image = rasterise(&silhouette);
        let colours = match (blend.space().family(), blend.places()) {
            (Some(family), Some(places)) => {
                let mut canvas = FaceCanvas::new(size, view, blend.weights(), self);
                for face in family.faces().iter() {
                    canvas.paint_face(*face, places, family.embeddings());
                }
                canvas.continue_edges();
                canvas.colours
            }
            _ => self.colours_in_place(blend.weights(), size, &view),
        };
        for (pixel, colour) in image.pixels_mut().zip(colours) {
            *pixel = covered(colour, pixel.0[3]);
        }
        Some(image)
    }

    /// Mean colour at each pixel of designs that lie still.
    fn colours_in_place(
        &self,
        weights: &[f64],
        size: PixelSize,
        view: &PlaneView,
    ) -> Vec<Option<Premultiplied>> {
        let pixels = (0..size.height()).flat_map(|y| (0..size.width()).map(move |x| (x, y)));
        let colour = |(x, y): (u32, u32)| {
            let place = view.to_plane(DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5));
            let visible = self.mixed(weights, |_| place);
            let is_visible = visible[3] > 0.0;
            Some(if is_visible {
                opaque(visible)
            } else {
                self.mean(weights)
            })
        };
        pixels.map(colour).collect()
    }

    /// Mixture of the designs' colours at the places that `place` gives for each design.
    fn mixed(&self, weights: &[f64], place: impl Fn(usize) -> DVec2) -> Premultiplied {
        let mut sum = [0.0; 4];
        for (k, (source, weight)) in self.sources.iter().zip(weights).enumerate() {
            // Extrapolated blends show the colours of the designs that they extrapolate from.
            if *weight > 0.0 {
                let colour = source.at(place(k));
                let terms = sum.iter_mut().zip(colour);
                terms.for_each(|(sum, channel)| *sum += weight * channel);
            }
        }
        sum
    }

    /// Mean colour of the whole designs, opaque.
    fn mean(&self, weights: &[f64]) -> Premultiplied {
        let mut sum = [0.0; 4];
        for (source, weight) in self.sources.iter().zip(weights) {
            let [r, g, b] = source.mean.0.map(|channel| f64::from(channel) / 255.0);
            let terms = sum.iter_mut().zip([r, g, b, 1.0]);
            terms.for_each(|(sum, channel)| *sum += weight.max(0.0) * channel);
        }
        opaque(sum)
    }
}

impl SourceColours {
    /// Colour at a point of the plane, premultiplied.
    fn at(&self, place: DVec2) -> Premultiplied {
        let px = self.view.to_px(place).floor();
        let last = DVec2::splat(f64::from(SOURCE_PX - 1));
        // Points on the outline may lie just outside the image.
        let px = px.clamp(DVec2::ZERO, last);
        let [r, g, b, a] = self.image.get_pixel(px.x as u32, px.y as u32).0;
        let alpha = f64::from(a) / 255.0;
        let [r, g, b] = [r, g, b].map(|channel| f64::from(channel) / 255.0 * alpha);
        [r, g, b, alpha]
    }
}

/// Mean of the visible pixels of an image; `None` if nothing is visible.
fn mean_colour(image: &RgbaImage) -> Option<Rgb> {
    let mut sums = [0.0; 4];
    for Rgba([r, g, b, a]) in image.pixels() {
        let alpha = f64::from(*a);
        let terms = sums.iter_mut().zip([*r, *g, *b]);
        terms.for_each(|(sum, channel)| *sum += f64::from(channel) * alpha);
        sums[3] += alpha;
    }
    let [r, g, b, alpha] = sums;
    (alpha > 0.0).then(|| Rgb([r, g, b].map(|sum| (sum / alpha).round() as u8)))
}

/// The same colour with full opacity.
fn opaque([r, g, b, a]: Premultiplied) -> Premultiplied {
    [r / a, g / a, b / a, 1.0]
}

/// Pixel with straight alpha: a colour seen where the outline covers `coverage` of the pixel.
fn covered(colour: Option<Premultiplied>, coverage: u8) -> Rgba<u8> {
    let Some([r, g, b, a]) = colour.filter(|colour| colour[3] > 0.0) else {
        return Rgba([0; 4]);
    };
    let [r, g, b] = [r, g, b].map(|channel| (channel / a * 255.0).round() as u8);
    Rgba([r, g, b, (a.min(1.0) * f64::from(coverage)).round() as u8])
}

/// Pixels onto which the faces of a common mesh are painted.
struct FaceCanvas<'a> {
    size: PixelSize,
    view: PlaneView,
    weights: &'a [f64],
    colours_of: &'a SpaceColours,
    colours: Vec<Option<Premultiplied>>,
}

impl<'a> FaceCanvas<'a> {
    fn new(
        size: PixelSize,
        view: PlaneView,
        weights: &'a [f64],
        colours_of: &'a SpaceColours,
    ) -> Self {
        Self {
            size,
            view,
            weights,
            colours_of,
            colours: vec![None; size.width() as usize * size.height() as usize],
        }
    }

    /// Paints the pixels whose centres lie in a face.
    fn paint_face(&mut self, face: [u32; 3], places: &[DVec2], embeddings: &[Vec<DVec2>]) {
        let corners = face.map(|v| self.view.to_px(places[v as usize]));
        let [a, b, c] = corners;
        let area = (b - a).perp_dot(c - a);
        let Some(bounds) = Bounds::of(corners).filter(|_| area != 0.0) else {
            return;
        };
        let limit = self.size.as_dvec2();
        let from = bounds.min.floor().clamp(DVec2::ZERO, limit);
        let to = bounds.max.ceil().clamp(DVec2::ZERO, limit);
        for y in from.y as u32..to.y as u32 {
            for x in from.x as u32..to.x as u32 {
                let p = DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5);
                let [u, v] = [(p - a).perp_dot(c - a), (b - a).perp_dot(p - a)].map(|d| d / area);
                let shares = [1.0 - u - v, u, v];
                if shares.iter().any(|share| *share < 0.0) {
                    continue;
                }
                let place = |k: usize| {
                    let corners = face.map(|v| embeddings[k][v as usize]);
                    shares.iter().zip(corners).map(|(s, p)| *s * p).sum()
                };
                let index = y as usize * self.size.width() as usize + x as usize;
                self.colours[index] = Some(self.colours_of.mixed(self.weights, place));
            }
        }
    }

    /// Gives pixels next to the faces the colour of a neighbour.
    fn continue_edges(&mut self) {
        let width = self.size.width() as usize;
        for _ in 0..EDGE_PX {
            let before = self.colours.clone();
            let neighbours = |index: usize| {
                let x = index % width;
                let left = (x > 0).then(|| index - 1);
                let right = (x + 1 < width).then_some(index + 1);
                let all = [left, right, index.checked_sub(width), Some(index + width)];
                let known = all.into_iter().flatten();
                known
                    .filter_map(|k| before.get(k).copied().flatten())
                    .next()
            };
            for (index, colour) in self.colours.iter_mut().enumerate() {
                *colour = colour.or_else(|| neighbours(index));
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::design::{ImportOptions, import};
    use crate::space::SpaceSpec;
    use crate::work::progress::Silent;

    /// A square of the given colours, the left half in the first.
    fn square(left: &str, right: &str, side: u32) -> Arc<Design> {
        let half = side / 2;
        let svg = format!(
            "<svg xmlns='http://www.w3.org/2000/svg' width='{side}' height='{side}'>\
             <rect width='{side}' height='{side}' fill='{right}'/>\
             <rect width='{half}' height='{side}' fill='{left}'/></svg>"
        );
        let design = import("a.svg", svg.as_bytes(), &ImportOptions::default());
        Arc::new(design.expect("a drawing"))
    }

    fn colours_at(weights: &[f64], places: [(f64, f64); 2]) -> [[u8; 4]; 2] {
        let designs = vec![
            square("#ff0000", "#00ff00", 100),
            square("#0000ff", "#000000", 100),
        ];
        let space = DesignSpace::build(&SpaceSpec::new(designs), &Silent).expect("a space");
        let colours = SpaceColours::new(&space, &TransitionStyle::default()).expect("paints");
        let mut frame = space.frame();
        frame.seek(weights);
        let raster = PictureRaster {
            size: [100, 100],
            corner: DVec2::new(0.0, 100.0),
            pixel_size: 1.0,
        };
        let image = colours.picture(&frame, &raster).expect("an image");
        places.map(|(x, y)| image.get_pixel(x as u32, y as u32).0)
    }

    #[test]
    fn each_design_has_its_own_colours_and_blends_mix_them() {
        let places = [(25.0, 50.0), (75.0, 50.0)];
        assert_eq!(
            colours_at(&[1.0, 0.0], places),
            [[255, 0, 0, 255], [0, 255, 0, 255]]
        );
        assert_eq!(
            colours_at(&[0.0, 1.0], places),
            [[0, 0, 255, 255], [0, 0, 0, 255]]
        );
        let [left, right] = colours_at(&[0.5, 0.5], places);
        assert!(
            left[0].abs_diff(128) <= 1 && left[2].abs_diff(128) <= 1,
            "{left:?}"
        );
        assert!(right[1].abs_diff(128) <= 1 && right[0] == 0, "{right:?}");
    }

    #[test]
    fn designs_without_paints_need_no_colours() {
        let plain = |side: f64| {
            let ring = [[0.0, 0.0], [side, 0.0], [0.0, side]];
            Arc::new(Design::from_rings("a", [ring]).expect("a triangle"))
        };
        let space = DesignSpace::build(&SpaceSpec::new(vec![plain(1.0), plain(2.0)]), &Silent);
        let space = space.expect("a space");
        assert!(SpaceColours::new(&space, &TransitionStyle::default()).is_none());
    }
}

//! Draws the contours of a measure over the map, and hatching where blends have folds or crossings.
//! The measures are sampled in the background, first coarsely, then finely.

use std::sync::Arc;

use image::{Rgba, RgbaImage};

use crate::app::jobs::job::BackgroundJob;
use crate::app::map::thumbnails::MAP_HALF_SIDE;
use crate::colour::Rgb;
use crate::geometry::DVec2;
use crate::measure::{MapLandscape, MapMeasure};
use crate::space::{DesignSpace, WeightMap};
use crate::work::progress::Cancelled;

/// Numbers of sample points along each side of the map, coarse and fine (resource limit: the fine
/// grid takes some seconds).
const SAMPLES_PER_SIDE: [usize; 2] = [16, 64];

/// Side of the square image of the contours, in pixels (heuristic).
const SIDE_PX: u32 = 704;

/// Number of contours between the smallest and the largest value of the measure on the map
/// (heuristic).
const CONTOURS: f64 = 9.0;

/// Horizontal distance from one hatching line to the next, and width of a line, both in pixels
/// (heuristic).
const HATCH_PX: (u32, u32) = (9, 2);

/// Colour of the hatching, visible on light and dark backgrounds.
const HATCH_COLOUR: Rgb = Rgb([196, 84, 40]);

/// Samples of all measures over the map, and the image of the contours drawn from them.
#[derive(Debug, Default)]
pub struct MapContours {
    landscape: Option<MapLandscape>,
    sampling: Option<BackgroundJob<MapLandscape, Cancelled>>,
    /// Whether sampling failed; it would fail again, so it is not repeated.
    is_failed: bool,
    /// Measure, colour, and number of samples per side of the map, all for the image that was
    /// started last.
    drawn: Option<(ShownMeasure, Rgb, usize)>,
    drawing: Option<BackgroundJob<Arc<RgbaImage>, Cancelled>>,
    picture: Option<Arc<RgbaImage>>,
}

/// The measure whose contours are shown, if any.
type ShownMeasure = Option<MapMeasure>;

impl MapContours {
    /// Image of the contours and hatching; `None` until it is drawn.
    #[must_use]
    pub fn picture(&self) -> Option<&Arc<RgbaImage>> {
        self.picture.as_ref()
    }

    /// Values of all measures on the finest grid sampled so far; `None` until the coarse grid is
    /// complete.
    #[must_use]
    #[cfg_attr(not(feature = "testing"), expect(dead_code, reason = "read by tests"))]
    pub fn landscape(&self) -> Option<&MapLandscape> {
        self.landscape.as_ref()
    }

    /// Whether samples are being taken or drawn.
    #[must_use]
    pub fn is_busy(&self) -> bool {
        self.sampling.is_some() || self.drawing.is_some()
    }

    /// Collects finished samples and images. Starts the background jobs that sample the map on the
    /// next finer grid and draw an outdated image again, in the colour `ink`. Returns whether the
    /// image is new.
    pub fn update(
        &mut self,
        space: &DesignSpace,
        map: &WeightMap,
        shown: ShownMeasure,
        ink: Rgb,
    ) -> bool {
        match BackgroundJob::take_result(&mut self.sampling) {
            None => {}
            Some(Ok(landscape)) => self.landscape = Some(landscape),
            Some(Err(_)) => self.is_failed = true,
        }
        let sampled = self.landscape.as_ref().map_or(0, MapLandscape::side);
        let next = SAMPLES_PER_SIDE.into_iter().find(|side| *side > sampled);
        if let Some(side) = next.filter(|_| self.sampling.is_none() && !self.is_failed) {
            let (space, map) = (space.clone(), map.clone());
            self.sampling = Some(BackgroundJob::start("measuring the map", move |progress| {
                MapLandscape::measure(&space, &map, side, MAP_HALF_SIDE, progress)
            }));
        }
        let mut is_new = false;
        if let Some(image) = BackgroundJob::take_result(&mut self.drawing) {
            self.picture = image.ok();
            is_new = true;
        }
        let drawn = (shown, ink, sampled);
        if let Some(landscape) = self
            .landscape
            .as_ref()
            .filter(|_| self.drawn != Some(drawn))
        {
            let landscape = landscape.clone();
            self.drawn = Some(drawn);
            self.drawing = Some(BackgroundJob::start("drawing the map", move |_| {
                Ok(Arc::new(draw(&landscape, shown, ink)))
            }));
        }
        is_new
    }
}

/// Draws the contours of `shown` and the hatching; straight alpha on a transparent background.
fn draw(landscape: &MapLandscape, shown: ShownMeasure, ink: Rgb) -> RgbaImage {
    let px = 2.0 * MAP_HALF_SIDE / f64::from(SIDE_PX);
    let map_point = |x: u32, y: u32| {
        let [across, down] = [x, y].map(|k| (f64::from(k) + 0.5) * px - MAP_HALF_SIDE);
        DVec2::new(across, -down)
    };
    let range = shown.and_then(|measure| Some((measure, landscape.range(measure)?)));
    // A constant measure has no contours.
    let range = range.filter(|(_, [min, max])| max - min > 1e-9 * max.abs());
    RgbaImage::from_fn(SIDE_PX, SIDE_PX, |x, y| {
        let at = map_point(x, y);
        let is_line = (x + y) % HATCH_PX.0 < HATCH_PX.1;
        if is_line && landscape.defect_fraction(at) > 0.5 {
            let Rgb([r, g, b]) = HATCH_COLOUR;
            return Rgba([r, g, b, 200]);
        }
        let shade = range.and_then(|(measure, [min, max])| {
            let height = |at: DVec2| {
                let value = landscape.value(measure, at)?;
                Some((value - min) / (max - min) * CONTOURS)
            };
            let centre_height = height(at)?;
            // Change of the height from one pixel to the next, by forward differences. The height
            // is the measure's value above its minimum, in units of the interval between contours.
            let slope = DVec2::new(
                height(at + DVec2::X * px)? - centre_height,
                height(at + DVec2::Y * px)? - centre_height,
            );
            // First-order distance to the nearest contour, in pixels.
            let distance_px =
                (centre_height - centre_height.round()).abs() / slope.length().max(1e-9);
            // Antialiased lines on top of a shade that grows with the value.
            let line = (1.3 - distance_px).clamp(0.0, 1.0);
            Some(0.22 * centre_height / CONTOURS + 0.4 * line)
        });
        let Rgb([r, g, b]) = ink;
        Rgba([r, g, b, (shade.unwrap_or(0.0).min(1.0) * 255.0) as u8])
    })
}
